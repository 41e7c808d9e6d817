// What the atlas leaves: figures and tables.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "figure/page.hpp"
#include "study/atlas.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

struct Cell {
  const char* heading;
  double (*value)(const BranchComparison& line);
  int digits;  ///< in Markdown; CSV has all
};

/// What a line of a table says after its label.
constexpr Cell k_cells[] = {
    {"reversal", [](const BranchComparison& line) { return line.reversal; }, 3},
    {"area_error", [](const BranchComparison& line) { return line.area_error; }, 3},
    {"peak_error", [](const BranchComparison& line) { return line.peak_error; }, 3},
    {"slope", [](const BranchComparison& line) { return line.slope; }, 3},
    {"reference_slope", [](const BranchComparison& line) { return line.reference_slope; }, 3},
    {"slope_ratio", [](const BranchComparison& line) { return line.slope / line.reference_slope; }, 3},
    {"residual", [](const BranchComparison& line) { return line.residual; }, 4},
    {"reference_residual", [](const BranchComparison& line) { return line.reference_residual; }, 4},
    {"residual_ratio", [](const BranchComparison& line) { return line.residual / line.reference_residual; }, 3},
    {"coverage", [](const BranchComparison& line) { return line.coverage; }, 3},
};

[[nodiscard]] std::string shown_number(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : std::string("-");
}

using Row = std::vector<std::string>;

[[nodiscard]] std::vector<Row> rows_of(const ComparisonTable& table) {
  std::vector<Row> rows{{"case"}};
  for (const Cell& cell : k_cells) rows.front().emplace_back(cell.heading);
  std::ranges::for_each(rows.front(), [](std::string& heading) { std::ranges::replace(heading, '_', ' '); });
  for (const ComparisonRow& row : table.rows) {
    for (const BranchComparison& line : row.lines) {
      rows.push_back({row.label});
      for (const Cell& cell : k_cells) rows.back().push_back(shown_number(cell.value(line), cell.digits));
    }
  }
  return rows;
}

void append_markdown(std::string& text, const std::vector<Row>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 3);
  for (const Row& row : rows) {
    for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], row[k].size());
  }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t k = 0; k < widths.size(); ++k) {
      text +=
          k == 0 ? fmt::format("| {:<{}} ", rows[r][k], widths[k]) : fmt::format("| {:>{}} ", rows[r][k], widths[k]);
    }
    text += "|\n";
    if (r > 0) continue;
    for (std::size_t k = 0; k < widths.size(); ++k) {
      text += fmt::format("| {}{} ", std::string(widths[k] - 1, '-'), k == 0 ? '-' : ':');
    }
    text += "|\n";
  }
}

[[nodiscard]] std::string csv_text(const AtlasFigure& figure) {
  std::ostringstream out;
  write_csv(comparison_csv(figure), out);
  return out.str();
}

}  // namespace

std::string comparison_text(const AtlasFigure& figure) {
  std::string text = fmt::format("# {}\n\n", figure.title);
  text +=
      "Loading up to each reversal: area error sqrt(int (model - reference)^2 dx)/int |reference| dx, peak error\n"
      "max |model - reference|/reference at the reversal, and the share of the loading that the model covers.\n"
      "Unloading from there: mean slope while the first 5 % of y go, residual x where y vanishes, and both over those\n"
      "of the reference. A hyphen: y does not vanish, or the curve does not turn back there.\n";
  for (const ComparisonTable& table : figure.tables) {
    text += fmt::format("\n## {}\n\n", table.title);
    append_markdown(text, rows_of(table));
  }
  return text;
}

Table comparison_csv(const AtlasFigure& figure) {
  Column titles{.name = "table", .unit = {}, .labels = {}};
  Column labels{.name = "case", .unit = {}, .labels = {}};
  std::vector<std::vector<double>> rows;
  for (const ComparisonTable& table : figure.tables) {
    titles.labels.push_back(table.title);
    for (const ComparisonRow& row : table.rows) {
      labels.labels.push_back(row.label);
      for (const BranchComparison& line : row.lines) {
        rows.push_back({static_cast<double>(titles.labels.size() - 1), static_cast<double>(labels.labels.size() - 1)});
        for (const Cell& cell : k_cells) rows.back().push_back(cell.value(line));
      }
    }
  }
  std::vector<Column> columns{std::move(titles), std::move(labels)};
  for (const Cell& cell : k_cells) columns.push_back({.name = cell.heading, .unit = {}, .labels = {}});
  Table csv(std::move(columns));
  csv.header = {{"title", figure.title}, {"source", figure.source}};
  for (const auto& row : rows) csv.append(row);
  return csv;
}

std::vector<fs::path> write_atlas(const std::vector<AtlasFigure>& figures, const fs::path& folder) {
  std::vector<fs::path> written;
  std::vector<figure::FigureFiles> files;
  for (const AtlasFigure& made : figures) {
    if (!made.chart.panels.empty()) files.emplace_back(folder / fmt::format("{}.{}", made.name, made.format));
  }
  auto next = files.begin();
  for (const AtlasFigure& made : figures) {
    if (!made.chart.panels.empty()) {
      const figure::FigureFiles& figure = *next++;
      figure.write(figure::chart_data(made.chart, fmt::format("{}; {}", made.title, made.source)),
                   figure::chart_script(made.chart, figure.format(), figure.figure_name(), figure.data_name()));
      written.push_back(figure.figure());
    }
    if (!made.tables.empty()) {
      fs::create_directories(folder);
      figure::write_whole(folder / (made.name + ".csv"), csv_text(made));
      figure::write_whole(folder / (made.name + ".md"), comparison_text(made));
      written.insert(written.end(), {folder / (made.name + ".csv"), folder / (made.name + ".md")});
    }
  }
  return written;
}

}  // namespace monograin
