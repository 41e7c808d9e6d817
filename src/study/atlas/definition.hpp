/// Definitions of figures: TOML files that describe the curves of each panel, and their references.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "figure/chart.hpp"
#include "history/table.hpp"
#include "scenario/faults.hpp"
#include "scenario/scenario.hpp"
#include "scenario/text_file.hpp"
#include "study/atlas/adhesion_map.hpp"
#include "study/formula/expression.hpp"

namespace monograin {

/// A formula with its position in the file, for faults that only its evaluation finds.
struct PlacedExpression {
  Expression expression{"0"};
  SourceLocation where;  ///< of the formula's first character
};

/// Rows by the direction of x: all, only beyond the largest x so far, only backwards.
enum class RowChoice { all, load, unload };

/// Curves of a panel, from runs: one, or one for each value of a varied key. Or curves of parameters that a model
/// derives over a swept key, or of a formula of the parameter t.
struct CurveSpec {
  struct Parameter {
    double from = 0.0;
    double to = 1.0;
  };

  std::vector<CheckedScenario> scenarios{};  ///< at least one, except for a formula that needs none
  std::size_t sweep = 0;                     ///< number of consecutive scenarios that make one curve of derived
                                             ///< parameters; 0: runs
  std::vector<std::string> legends;          ///< one for each curve, or one
  std::vector<std::string> variants{};       ///< names of the curves of a varied key; empty: no key is varied
  PlacedExpression x;
  PlacedExpression y;
  RowChoice rows = RowChoice::all;
  std::vector<figure::ChartSeries::Style> styles{figure::ChartSeries::Style::phases};  ///< one for each curve, or one
  std::optional<std::size_t> colour;
  /// One for each scenario: y is then its distance from the y of the reference, evaluated over the same rows.
  std::vector<CheckedScenario> references{};
  std::optional<double> profile_at;  ///< [s]; if given, columns are those of contact profiles at that instant
  std::string at_event;              ///< if given, rows are the states just after events of this name
  std::optional<Parameter> parameter{};
};

/// Points from a file.
struct PointsSpec {
  Table table{};
  PlacedExpression x;
  PlacedExpression y;
  RowChoice rows = RowChoice::all;
  std::optional<PlacedExpression> where;  ///< only rows in which this formula is zero
  std::size_t every = 1;                  ///< only every n-th row
  std::string legend;
  std::optional<std::size_t> colour;
};

struct PanelSpec {
  figure::ChartAxis x;
  figure::ChartAxis y;
  std::string note;
  std::optional<figure::ChartRange> fitted;
  std::vector<CurveSpec> curves{};
  std::vector<PointsSpec> points{};
};

/// Curves that are compared with points, which are the reference.
struct ComparisonSpec {
  std::string label;
  std::string quantity;                   ///< name of y; empty if the table names no quantities
  std::vector<std::size_t> measures;      ///< measures in the table, as indices of k_measures
  std::optional<PlacedExpression> least;  ///< loading with smaller y is not measured; a formula of the run's numbers
  CurveSpec curve;
  PointsSpec points;
};

struct TableSpec {
  std::string title;
  std::vector<double> bands;           ///< ends of the bands of x to measure; empty: loading up to each reversal
  std::vector<ComparisonSpec> rows{};  ///< rows with one label are consecutive
};

/// A value made of the parameters that a model derives from a scenario, and its reference: the number printed in the
/// source, or the mean over rows of a file.
struct ValueSpec {
  std::string label;
  std::optional<CheckedScenario> scenario;  ///< absent only with a fault
  PlacedExpression value;
  std::string printed;                  ///< a number; empty: none
  std::optional<PointsSpec> reference;  ///< its y are the rows
  std::string remark;
};

struct ValueTableSpec {
  std::string title;
  std::vector<ValueSpec> rows{};
};

struct Definition {
  std::string name;  ///< of the file, without folder and extension
  std::string title;
  std::string source;
  std::string format;                                 ///< svg, pdf, png
  std::optional<AdhesionMapSettings> adhesion_map{};  ///< its panels come first
  std::vector<PanelSpec> panels{};
  std::vector<TableSpec> tables{};
  std::vector<ValueTableSpec> value_tables{};  ///< alternative to `tables`: both would be written to the same files
};

/// Reads and checks a definition with its scenarios and files, whose paths are relative to the definition's folder. The
/// result is only meaningful if nothing was added to `faults`.
[[nodiscard]] Definition read_definition(const std::filesystem::path& file, FaultList& faults);
/// Reads a definition from its text. Files that it names lie beside its file.
[[nodiscard]] Definition parse_definition(NamedText source, FaultList& faults);

}  // namespace monograin
