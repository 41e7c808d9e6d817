/// The atlas: figures and tables computed anew from their definitions.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/drive.hpp"
#include "figure/chart.hpp"
#include "history/branches.hpp"
#include "history/table.hpp"

namespace monograin {

/// A row of comparisons in a table of the atlas, with its name.
struct ComparisonRow {
  std::string label;
  std::vector<BranchComparison> lines;
  std::string quantity{};               ///< compared quantity; empty if the table names none
  std::vector<std::size_t> measures{};  ///< measures in the table, as indices of definition::k_measures
};

struct ComparisonTable {
  std::string title;
  bool has_bands = false;  ///< lines are bands of x instead of loadings up to reversals
  std::vector<ComparisonRow> rows{};
};

/// A computed value in a table of the atlas, and its reference.
struct ValueRow {
  std::string label;
  double value = 0.0;
  std::string printed;              ///< the number printed in the source; empty: none
  std::optional<double> reference;  ///< mean over the rows of a file
  std::string remark;
};

struct ValueTable {
  std::string title;
  std::vector<ValueRow> rows{};
};

/// A definition whose contents have been computed; nothing is written yet.
struct AtlasFigure {
  std::string name;
  std::string title;
  std::string source;
  std::string format;
  figure::Chart chart{};  ///< without panels if there are only tables
  std::vector<ComparisonTable> tables{};
  std::vector<ValueTable> value_tables{};  ///< a figure has tables of one kind only
  std::vector<std::string> stops{};        ///< runs that did not reach their end, with the reason
  RunStatus status = RunStatus::complete;  ///< the worst of all runs
};

struct AtlasEntry {
  std::string name;
  std::string title;
};

/// Definitions in a folder, by name. @throws ScenarioError for a definition that cannot be read
[[nodiscard]] std::vector<AtlasEntry> list_atlas(const std::filesystem::path& definitions);

/// Reads definitions (NAME.toml) of a folder and computes their curves.
/// @param names  empty: all definitions of the folder
/// @param progress  called after each figure with the numbers of figures made and in all; may be empty
/// @throws ScenarioError with the faults of all of them
/// @throws std::runtime_error when there is no such folder, or no definition of that name in it
[[nodiscard]] std::vector<AtlasFigure> make_atlas(const std::filesystem::path& folder,
                                                  const std::vector<std::string>& names,
                                                  const std::function<void(std::size_t, std::size_t)>& progress = {});

/// Writes the figures with their scripts and data, and the tables as NAME.csv and NAME.md. Each file is written as a
/// whole or not at all. @return the files with results: figures and tables
/// @throws FigureError; if gnuplot is missing, before anything is written
std::vector<std::filesystem::path> write_atlas(const std::vector<AtlasFigure>& figures,
                                               const std::filesystem::path& folder);

/// Tables of a figure as Markdown; empty if it has none.
[[nodiscard]] std::string tables_text(const AtlasFigure& figure);

/// All of a figure's tables as one table for CSV.
[[nodiscard]] Table tables_csv(const AtlasFigure& figure);

}  // namespace monograin
