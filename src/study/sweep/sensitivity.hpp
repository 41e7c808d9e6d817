/// Sensitivities by a sweep of design "saltelli" or "morris": which factor the spread of its results is due to.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "study/sweep/indices.hpp"
#include "study/sweep/sweep_file.hpp"

namespace monograin {

/// One result with its indices or its effects, as the design has it; the other member is empty.
struct ResultSensitivity {
  std::string result;  ///< its formula
  SobolIndices sobol{};
  MorrisEffects morris{};

  [[nodiscard]] std::size_t samples() const noexcept { return sobol.samples + morris.samples; }
};

/// @param folder      where the sweep has been run, with its results
/// @param confidence  level of the two-sided intervals, between 0 and 1
/// @throws std::runtime_error for a formula that the columns cannot answer, and what to do
/// @throws std::invalid_argument where the design of the sweep says nothing of sensitivities
[[nodiscard]] std::vector<ResultSensitivity> sensitivities_of(const Sweep& sweep, const std::filesystem::path& folder,
                                                              double confidence);

/// How many samples the design has.
[[nodiscard]] std::size_t sample_count(const Sweep& sweep);

/// For the reader.
[[nodiscard]] std::string sensitivity_text(const Sweep& sweep, const std::vector<ResultSensitivity>& found);

/// Writes sensitivity.csv, with a row for each result and factor, and sensitivity.svg: the indices with their
/// intervals, a panel for each result; of elementary effects their spread over their mean size.
/// @return why there is no figure; empty: there is one
[[nodiscard]] std::string write_sensitivities(const Sweep& sweep, const std::vector<ResultSensitivity>& found,
                                              const std::filesystem::path& folder);

}  // namespace monograin
