/// Results of a plan of an experiment: text, CSV and a figure.
#pragma once

#include <string>
#include <string_view>

#include "figure/figure.hpp"
#include "history/staged_folder.hpp"
#include "history/table.hpp"
#include "study/identify/identify.hpp"

namespace monograin {

/// Text for the terminal: errors and correlations of the planned programs, errors with each candidate, the best ones.
[[nodiscard]] std::string identify_text(const ExperimentPlan& plan, const IdentifyResult& result);

/// Content of errors.csv: a row for each parameter of the planned programs and of each candidate. Values and errors are
/// in SI.
[[nodiscard]] Table identify_table(const ExperimentPlan& plan, const IdentifyResult& result);

/// The file that marks a folder of these results.
inline constexpr const char* k_identify_marker = "errors.csv";

/// Writes errors.csv; design.json, which repeats the plan; and a figure, a bar of the relative error for each candidate
/// and a panel for each parameter, with its script and data; all of them or none.
/// @param folder  made with k_identify_marker
/// @param format  of the figure, one of figure::k_formats
/// @return why there is no figure; empty: there is
/// @throws std::runtime_error naming what could not be written
[[nodiscard]] std::string write_identify(const ExperimentPlan& plan, const IdentifyResult& result, StagedFolder& folder,
                                         std::string_view format = figure::k_usual_format);

}  // namespace monograin
