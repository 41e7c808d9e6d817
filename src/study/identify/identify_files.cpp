#include "study/identify/identify_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "catalogue.hpp"
#include "figure/chart.hpp"
#include "figure/page.hpp"
#include "history/run.hpp"
#include "history/run_files.hpp"
#include "scenario/text_file.hpp"
#include "scenario/units.hpp"
#include "study/calibrate/calibration_language.hpp"
#include "study/calibrate/calibration_text.hpp"
#include "study/calibrate/text_table.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

// Okabe and Ito (2008), for readers who do not see all colours.
constexpr std::array<unsigned, 7> k_colours{0x999999, 0x0072B2, 0xE69F00, 0x009E73, 0xCC79A7, 0x56B4E9, 0xD55E00};
constexpr double k_half_bar = 0.3;

/// Standard error over the value; nan if the value is zero, as an offset may be.
double relative_error(const ExperimentPlan& plan, const ExpectedErrors& errors, std::size_t k) {
  return plan.values[k] == 0.0 ? k_nan : errors.uncertainty.standard_error(k) / std::abs(plan.values[k]);
}

/// A standard error over the value; if the value is zero, the standard error itself.
std::string shown_error(const ExperimentPlan& plan, const ExpectedErrors& errors, std::size_t k) {
  if (!errors.uncertainty.has_derivative[k]) return "no derivative: trial runs fail";
  if (!errors.uncertainty.is_determined[k]) return "not determined";
  const FreeParameter& parameter = plan.free[k];
  if (plan.values[k] == 0.0) {
    return fmt::format("{:.3g} {}", errors.uncertainty.standard_error(k) / parameter.unit_factor, parameter.unit);
  }
  return fmt::format("{:.3g} %", 100.0 * relative_error(plan, errors, k));
}

std::string_view si_unit(const FreeParameter& parameter) {
  if (parameter.key.path == calibration::k_compliance) return "m/N";
  const std::string_view si = dimension_info(parameter.key.dimension).si;
  return si.empty() ? "-" : si;
}

/// What repeats the plan.
nlohmann::ordered_json record_json(const ExperimentPlan& plan) {
  return {{"program", "monograin"},
          {"plan", plan.name},
          {"title", plan.title},
          {"citation", reference_texts(*find_model(plan.scenario.model))},
          {"versions", versions_json()},
          {"scenario", scenario_json(plan.scenario)},
          {"text", plan.text}};
}

/// Names of the planned programs, in one text.
std::string planned_names(const ExperimentPlan& plan) {
  std::vector<std::string> names;
  for (const ExperimentProgram& program : plan.programs) {
    if (program.is_planned) names.push_back(program.name);
  }
  return names.empty() ? "priors alone" : fmt::format("{}", fmt::join(names, ", "));
}

std::string planned_text(const ExperimentPlan& plan, const ExpectedErrors& errors) {
  std::vector<TextRow> rows{{"parameter", "value", "std. error", "relative"}};
  for (std::size_t k = 0; k < plan.free.size(); ++k) {
    const FreeParameter& parameter = plan.free[k];
    const auto own = [&](double si, int digits) {
      return with_unit(si / parameter.unit_factor, parameter.unit, digits);
    };
    rows.push_back({parameter.key.path, own(plan.values[k], 6), own(errors.uncertainty.standard_error(k), 2),
                    plan.values[k] == 0.0 && errors.uncertainty.is_determined[k] ? "-" : shown_error(plan, errors, k)});
  }
  std::string text = fmt::format("planned: {}\n{}", planned_names(plan), aligned(rows));
  if (plan.free.size() < 2) return text;
  return text + '\n' + aligned(correlation_rows(plan.free, errors.uncertainty));
}

std::string candidates_text(const ExperimentPlan& plan, const IdentifyResult& result) {
  std::vector<TextRow> rows{{result.planned ? "with the candidate" : "candidate"}};
  for (const FreeParameter& parameter : plan.free) rows.front().push_back(parameter.key.path);
  rows.front().insert(rows.front().end(), {"volume (D)", "sum of variances (A)"});
  for (const CandidateErrors& candidate : result.candidates) {
    rows.push_back({plan.programs[candidate.program].name});
    for (std::size_t k = 0; k < plan.free.size(); ++k) rows.back().push_back(shown_error(plan, candidate.errors, k));
    rows.back().push_back(std::isfinite(candidate.volume) ? fmt::format("{:.4g}", candidate.volume) : "-");
    rows.back().push_back(std::isfinite(candidate.errors.relative_variances)
                              ? fmt::format("{:.4g}", candidate.errors.relative_variances)
                              : "-");
  }
  std::string text = aligned(rows);
  if (!result.best_by_volume || !result.best_by_variances) {
    return text + "\nbest: none, as no candidate lets all parameters be determined\n";
  }
  const auto name = [&](std::size_t k) { return plan.programs[result.candidates[k].program].name; };
  return text + fmt::format("\nbest by the volume (D): {}\nbest by the sum of variances (A): {}\n",
                            name(*result.best_by_volume), name(*result.best_by_variances));
}

/// Errors of a set of programs: the planned ones, alone or with a candidate.
struct NamedErrors {
  std::string name;
  const ExpectedErrors* errors;
  double volume;
};

/// All sets, the planned programs first.
std::vector<NamedErrors> all_sets(const ExperimentPlan& plan, const IdentifyResult& result) {
  std::vector<NamedErrors> sets;
  if (result.planned) {
    const bool is_finite = std::isfinite(result.planned->log_determinant);
    sets.push_back({"planned", &*result.planned, is_finite ? 1.0 : std::nan("")});
  }
  for (const CandidateErrors& candidate : result.candidates) {
    sets.push_back({plan.programs[candidate.program].name, &candidate.errors, candidate.volume});
  }
  return sets;
}

figure::ChartPanel error_panel(const ExperimentPlan& plan, const std::vector<NamedErrors>& sets, std::size_t k) {
  figure::ChartPanel panel{
      .x = {.label = sets.front().name == "planned" ? "planned, and with each candidate" : "candidate",
            .lowest = 0.5,
            .highest = static_cast<double>(sets.size()) + 0.5},
      .y = {.label = "Standard error / value [%]", .lowest = 0.0},
      .note = figure::verbatim_text(plan.free[k].key.path)};
  double highest = 0.0;
  for (std::size_t s = 0; s < sets.size(); ++s) {
    const bool is_determined = sets[s].errors->uncertainty.is_determined[k];
    // The number stands in the legend, too: colours alone do not tell bars apart in grey print.
    panel.x.names.push_back(fmt::format("{}{}", s + 1, is_determined ? "" : "?"));
    figure::ChartArea bar{.legend = fmt::format("{} {}", s + 1, figure::short_text(sets[s].name)),
                          .colour = k_colours[s % k_colours.size()]};
    if (is_determined) {
      const double error = 100.0 * relative_error(plan, *sets[s].errors, k);
      const double place = static_cast<double>(s) + 1.0;
      bar.boxes.push_back({place - k_half_bar, place + k_half_bar, 0.0, error});
      highest = std::max(highest, error);
    }
    panel.areas.push_back(std::move(bar));
  }
  if (highest > 0.0) panel.y.highest = 1.15 * highest;
  return panel;
}

std::string draw(const ExperimentPlan& plan, const std::vector<NamedErrors>& sets,
                 const std::filesystem::path& figure) {
  figure::Chart chart{.area_heading = "Program"};
  for (std::size_t k = 0; k < plan.free.size(); ++k) {
    if (plan.values[k] != 0.0) chart.panels.push_back(error_panel(plan, sets, k));
  }
  chart.references = reference_texts(*find_model(plan.scenario.model));
  return figure::try_to_draw(chart, "expected errors of " + plan.name, figure);
}

}  // namespace

std::string identify_text(const ExperimentPlan& plan, const IdentifyResult& result) {
  std::string text;
  if (result.planned) text += planned_text(plan, *result.planned);
  if (result.planned && !result.candidates.empty()) text += '\n';
  if (!result.candidates.empty()) text += candidates_text(plan, result);
  return text;
}

Table identify_table(const ExperimentPlan& plan, const IdentifyResult& result) {
  const std::vector<NamedErrors> sets = all_sets(plan, result);
  std::vector<std::string> names;
  std::vector<std::string> paths;
  std::vector<std::string> units;
  for (const NamedErrors& set : sets) names.push_back(set.name);
  for (const FreeParameter& parameter : plan.free) {
    paths.push_back(parameter.key.path);
    units.emplace_back(si_unit(parameter));
  }
  std::vector<Column> columns{{"with", "", names},         {"key", "", paths},         {"SI", "", units},
                              {"value", "", {}},           {"standard_error", "", {}}, {"relative", "-", {}},
                              {"is_determined", "", {}},   {"volume", "-", {}},        {"relative_variances", "-", {}},
                              {"log_determinant", "-", {}}};
  for (const std::string& path : paths) columns.push_back({fmt::format("correlation({})", path), "-", {}});
  Table table(std::move(columns));
  table.header = {{"program", fmt::format("monograin {}", version())},
                  {"plan", plan.name},
                  {"planned", planned_names(plan)},
                  {"scenario", plan.scenario.name},
                  {"scenario_digest", scenario_digest(plan.scenario)},
                  {"model", plan.scenario.model}};
  for (std::size_t s = 0; s < sets.size(); ++s) {
    const ExpectedErrors& errors = *sets[s].errors;
    for (std::size_t k = 0; k < plan.free.size(); ++k) {
      std::vector<double> row{static_cast<double>(s),
                              static_cast<double>(k),
                              static_cast<double>(k),
                              plan.values[k],
                              errors.uncertainty.standard_error(k),
                              relative_error(plan, errors, k),
                              errors.uncertainty.is_determined[k] ? 1.0 : 0.0,
                              sets[s].volume,
                              errors.relative_variances,
                              errors.log_determinant};
      for (std::size_t j = 0; j < plan.free.size(); ++j) row.push_back(errors.uncertainty.correlation(k, j));
      table.append(row);
    }
  }
  return table;
}

std::string write_identify(const ExperimentPlan& plan, const IdentifyResult& result, StagedFolder& folder,
                           std::string_view format) {
  write_text_file(folder.path() / k_identify_marker, csv_text(identify_table(plan, result)));
  write_text_file(folder.path() / "design.json", record_text(record_json(plan)));
  const std::string problem = draw(plan, all_sets(plan, result), folder.path() / fmt::format("figure.{}", format));
  folder.publish(folder.age());
  return problem;
}

}  // namespace monograin
