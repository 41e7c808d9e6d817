/// Sensitivities from a sweep of design "saltelli" or "morris": which factors cause the spread of its results.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "figure/figure.hpp"
#include "study/sweep/indices.hpp"
#include "study/sweep/sweep_file.hpp"

namespace monograin {

/// Table of the sensitivities in the folder of a sweep.
inline constexpr const char* k_sensitivities_file = "sensitivity.csv";

/// One result with its indices or its effects, depending on the design; the other member is empty.
struct ResultSensitivity {
  std::string result;       ///< its formula
  std::string unit{};       ///< of a result that is a column; empty: none, or unknown
  double confidence = 0.0;  ///< level of the two-sided intervals
  SobolIndices sobol{};
  MorrisEffects morris{};
  std::vector<std::string> warnings{};  ///< why they are not to be trusted, a sentence each

  [[nodiscard]] std::size_t samples() const noexcept { return sobol.samples + morris.samples; }
};

/// Why the design of a sweep gives no sensitivities, with a remedy; empty: it gives them. To be asked before the runs.
[[nodiscard]] std::string why_no_sensitivities(const Sweep& sweep);

/// @param sweep       of a design that gives sensitivities
/// @param file        results of the sweep, as SweepOutcome names them
/// @param confidence  level of the two-sided intervals, between 0 and 1
/// @throws std::runtime_error for a formula that the columns cannot answer, with a remedy
[[nodiscard]] std::vector<ResultSensitivity> sensitivities_of(const Sweep& sweep, const std::filesystem::path& file,
                                                              double confidence);

/// Sensitivities as text for the terminal.
[[nodiscard]] std::string sensitivity_text(const Sweep& sweep, const std::vector<ResultSensitivity>& found);

/// Writes sensitivity.csv, with a row for each result and factor, and a figure with a panel for each result:
/// indices with their intervals, or the spread of elementary effects over their mean size.
/// @param format  of the figure, one of figure::k_formats
/// @return why there is no figure; empty: there is one
[[nodiscard]] std::string write_sensitivities(const Sweep& sweep, const std::vector<ResultSensitivity>& found,
                                              const std::filesystem::path& folder,
                                              std::string_view format = figure::k_usual_format);

}  // namespace monograin
