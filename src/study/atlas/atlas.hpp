/// The atlas: figures and tables made anew from their definitions.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/drive.hpp"
#include "figure/chart.hpp"
#include "history/branches.hpp"
#include "history/table.hpp"

namespace monograin {

/// A comparison that a table of the atlas shows, with the name of its row.
struct ComparisonRow {
  std::string label;
  std::vector<BranchComparison> lines;
  std::string quantity{};               ///< what was compared; empty where the table names none
  std::vector<std::size_t> measures{};  ///< that the table shows, places among definition::k_measures
};

struct ComparisonTable {
  std::string title;
  bool has_bands = false;  ///< lines are bands of x, not loadings up to reversals
  std::vector<ComparisonRow> rows;
};

/// A value that a table of the atlas shows, and what it is held against.
struct ValueRow {
  std::string label;
  double value = 0.0;
  std::string printed;              ///< by the source, a number; empty: none
  std::optional<double> reference;  ///< the mean of a file's rows
  std::string remark;
};

struct ValueTable {
  std::string title;
  std::vector<ValueRow> rows;
};

/// A definition with everything in it computed; nothing is written yet.
struct AtlasFigure {
  std::string name;
  std::string title;
  std::string source;
  std::string format;
  figure::Chart chart;  ///< without panels where there are only tables
  std::vector<ComparisonTable> tables;
  std::vector<ValueTable> value_tables;    ///< there are only tables of one kind
  std::vector<std::string> stops;          ///< runs that did not come to their end, and why
  RunStatus status = RunStatus::complete;  ///< the worst of all runs
};

struct AtlasEntry {
  std::string name;
  std::string title;
};

/// What there is in a folder of definitions, by name. @throws ScenarioError for a definition that cannot be read
[[nodiscard]] std::vector<AtlasEntry> list_atlas(const std::filesystem::path& definitions);

/// Reads definitions (NAME.toml) and computes their curves.
/// @param names  empty: all there are
/// @throws ScenarioError with the faults of all of them
/// @throws std::runtime_error when there is no such folder, or no definition of that name in it
[[nodiscard]] std::vector<AtlasFigure> make_atlas(const std::filesystem::path& definitions,
                                                  const std::vector<std::string>& names);

/// Writes the figures with their scripts and data, and the tables as NAME.csv and NAME.md. Each file is written whole
/// or not at all. @return the files that carry results: figures and tables
/// @throws FigureError; if gnuplot is missing, before anything is written
std::vector<std::filesystem::path> write_atlas(const std::vector<AtlasFigure>& figures,
                                               const std::filesystem::path& folder);

/// The tables of a figure as Markdown; nothing where it has none.
[[nodiscard]] std::string tables_text(const AtlasFigure& figure);

/// All of a figure's tables as one table for CSV.
[[nodiscard]] Table tables_csv(const AtlasFigure& figure);

}  // namespace monograin
