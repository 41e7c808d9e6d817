/// Definitions of figures: TOML files that say which curves go where, and what they are held against.
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
#include "study/atlas/adhesion_map.hpp"
#include "study/formula/expression.hpp"

namespace monograin {

/// A formula and where it stands, for what can only be found wrong when it is evaluated.
struct PlacedExpression {
  Expression expression{"0"};
  SourceLocation where;  ///< of the formula's first character
};

/// Which way of x: all, only beyond the largest so far, only back.
enum class RowChoice { all, load, unload };

/// Curves from runs: one, or one for each value that is varied; or of parameters that a model derives from a swept key;
/// or a formula of the parameter t.
struct CurveSpec {
  struct Parameter {
    double from = 0.0;
    double to = 1.0;
  };

  std::vector<CheckedScenario> scenarios;  ///< at least one, but for a formula that needs none
  std::size_t sweep = 0;                   ///< so many scenarios in a row are one curve of derived parameters; 0: runs
  std::vector<std::string> legends;        ///< one for each curve, or one
  std::vector<std::string> variants{};     ///< names of the curves of a key that is varied; empty: none is
  PlacedExpression x;
  PlacedExpression y;
  RowChoice rows = RowChoice::all;
  std::vector<figure::ChartSeries::Style> styles{figure::ChartSeries::Style::phases};  ///< likewise
  std::optional<std::size_t> colour;
  /// One for each scenario: y is then its distance from the reference's y, which is evaluated over the same rows.
  std::vector<CheckedScenario> references{};
  std::optional<double> profile_at;  ///< [s]; then columns are those of contact profiles at that instant
  std::string at_event;  ///< then rows are the states just after events of this name; empty: those of the history
  std::optional<Parameter> parameter;
};

/// Points from a file.
struct PointsSpec {
  Table table;
  PlacedExpression x;
  PlacedExpression y;
  RowChoice rows = RowChoice::all;
  std::optional<PlacedExpression> where;  ///< only rows in which this is zero
  std::size_t every = 1;                  ///< only each so manieth row
  std::string legend;
  std::optional<std::size_t> colour;
};

struct PanelSpec {
  figure::ChartAxis x;
  figure::ChartAxis y;
  std::string note;
  std::optional<figure::ChartRange> fitted;
  std::vector<CurveSpec> curves;
  std::vector<PointsSpec> points;
};

/// Curves that are held against points, which are the reference.
struct ComparisonSpec {
  std::string label;
  std::string quantity;                   ///< what y is; empty where the table names none
  std::vector<std::size_t> measures;      ///< that are shown, places among k_measures
  std::optional<PlacedExpression> least;  ///< loading with smaller y is not measured; a formula of the run's numbers
  CurveSpec curve;
  PointsSpec points;
};

struct TableSpec {
  std::string title;
  std::vector<double> bands;         ///< ends of the bands of x that are measured; empty: loading up to each reversal
  std::vector<ComparisonSpec> rows;  ///< those of one label follow each other
};

/// A value made of what a model derives from a scenario, and what it is held against: what the source prints for it, or
/// the mean of rows of a file.
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
  std::vector<ValueSpec> rows;
};

struct Definition {
  std::string name;  ///< of the file, without folder and extension
  std::string title;
  std::string source;
  std::string format;                               ///< svg, pdf, png
  std::optional<AdhesionMapSettings> adhesion_map;  ///< its panels come before the others
  std::vector<PanelSpec> panels;
  std::vector<TableSpec> tables;
  std::vector<ValueTableSpec> value_tables;  ///< instead of `tables`: both would be written to the same files
};

/// Reads and checks a definition with its scenarios and files, which are sought from the definition's folder. What
/// comes back is only meaningful if nothing was added to `faults`.
[[nodiscard]] Definition read_definition(const std::filesystem::path& file, FaultList& faults);

}  // namespace monograin
