#include "study/sweep/column_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "history/recorder.hpp"
#include "scenario/words.hpp"
#include "scene/scene.hpp"

namespace monograin::sweep {
namespace {

constexpr std::size_t k_place = 4;  ///< length of "end.", "max." and "min."

/// True for a column of the results that is a value of a history.
bool is_of_history(std::string_view name) {
  return name.starts_with("end.") || name.starts_with("max.") || name.starts_with("min.");
}

}  // namespace

std::vector<PlacedColumn> columns_of_results(Reading& reading, const Section& root) {
  std::vector<PlacedColumn> columns;
  const std::vector<std::string> texts = root.texts("columns");
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const SourceLocation where = root.value_place("columns", i);
    if (is_of_history(texts[i])) {
      columns.push_back({texts[i].substr(k_place), where, texts[i].starts_with("end.")});
    } else {
      reading.faults.add(where, fmt::format("'{}': expected end.COLUMN, the value at the end of a run, max.COLUMN or "
                                            "min.COLUMN, its extremes, for example max.axial.force",
                                            shown(texts[i])));
    }
  }
  return columns;
}

void add_formula_fault(FaultList& faults, SourceLocation where, const std::string& formula,
                       const ExpressionError& error, const std::string& advice) {
  where.column += 1 + error.offset();  // after the quote
  faults.add(where, fmt::format("\"{}\": {}{}", shown(formula), error.what(), advice));
}

std::vector<PlacedColumn> columns_of_formulas(Reading& reading, const Section& root,
                                              std::span<const std::string> keys) {
  std::vector<PlacedColumn> needed;
  const std::vector<std::string> columns = root.texts("columns");
  const std::vector<std::string> texts = root.texts("results");
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const SourceLocation where = root.value_place("results", i);
    try {
      const Expression formula(texts[i]);
      for (const std::string_view name : formula.names()) {
        if (is_of_history(name)) {
          needed.push_back({std::string(name.substr(k_place)), where});
        } else if (std::ranges::find(keys, name) == keys.end()) {
          reading.faults.add(where, fmt::format("\"{}\": '{}' is no column of the results; expected end.COLUMN, the "
                                                "value at the end of a run, max.COLUMN or min.COLUMN, its extremes, or "
                                                "a varied key",
                                                shown(texts[i]), shown(name)));
          continue;
        }
        if (std::ranges::find(columns, name) != columns.end()) continue;
        if (!columns.empty()) {
          reading.faults.add(where, fmt::format("\"{}\": '{}' is not in columns, which leaves out all others",
                                                shown(texts[i]), shown(name)));
        } else if (name.starts_with("min.")) {
          reading.faults.add(where, fmt::format("\"{0}\": '{1}' is a result only if columns lists it; expected for "
                                                "example columns = [\"{1}\"]",
                                                shown(texts[i]), shown(name)));
        }
      }
    } catch (const ExpressionError& error) {
      add_formula_fault(reading.faults, where, texts[i], error);
    }
  }
  return needed;
}

void check_columns(std::span<const PlacedColumn> columns, const CheckedScenario& scenario, FaultList& faults) {
  if (columns.empty()) return;
  const Scene scene = make_scene(scenario);
  const Table history = Recorder(*scene.system).take_history();
  std::vector<std::string_view> all;
  std::vector<std::string_view> of_numbers;
  for (const Column& column : history.columns()) {
    all.push_back(column.name);
    if (!column.holds_words()) of_numbers.push_back(column.name);
  }
  for (const auto& [name, where, may_hold_words] : columns) {
    const std::vector<std::string_view>& names = may_hold_words ? all : of_numbers;
    if (std::ranges::find(names, name) != names.end()) continue;
    faults.add(where, fmt::format("'{}' is no column of the histories; expected one of {}{}", shown(name),
                                  listed(names), did_you_mean(name, names)));
  }
}

}  // namespace monograin::sweep
