// Files of the atlas: figures and tables.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <set>

#include "figure/markdown.hpp"
#include "figure/page.hpp"
#include "scenario/text_file.hpp"
#include "study/atlas/atlas.hpp"
#include "study/atlas/definition_language.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;
using definition::k_measures;

struct Measure {
  double (*value)(const BranchComparison& line);
  int digits = 3;           ///< digits in Markdown; CSV has all
  bool is_percent = false;  ///< shown in Markdown as a percentage with one decimal
};

/// The measures in the order of their names.
constexpr std::array<Measure, k_measures.size()> k_cells{{
    {[](const BranchComparison& line) { return line.reversal; }},
    {[](const BranchComparison& line) { return line.area_error; }},
    {[](const BranchComparison& line) { return line.peak_error; }},
    {[](const BranchComparison& line) { return line.slope; }},
    {[](const BranchComparison& line) { return line.reference_slope; }},
    {[](const BranchComparison& line) { return line.slope / line.reference_slope; }},
    {[](const BranchComparison& line) { return line.residual; }, 4},
    {[](const BranchComparison& line) { return line.reference_residual; }, 4},
    {[](const BranchComparison& line) { return line.residual / line.reference_residual; }},
    {[](const BranchComparison& line) { return line.coverage; }},
    {[](const BranchComparison& line) { return line.reversal; }},
    {[](const BranchComparison& line) { return line.largest; }, 3, true},
    {[](const BranchComparison& line) { return line.rms; }, 3, true},
    {[](const BranchComparison& line) { return line.unloading; }, 3, true},
}};

[[nodiscard]] std::string measured(const Measure& measure, const BranchComparison& line) {
  const double value = measure.value(line);
  if (!measure.is_percent || !std::isfinite(value)) return number_or_dash(value, measure.digits);
  return fmt::format("{:.1f}", 100.0 * value);
}

using Row = MarkdownRow;

/// Appends the headings of a quantity's measures.
void append_headings(const ComparisonRow& quantity, Row& headings) {
  for (const std::size_t measure : quantity.measures) {
    std::string heading(k_measures[measure]);
    std::ranges::replace(heading, '_', ' ');
    if (k_cells[measure].is_percent) heading += " %";
    const bool is_of_quantity = !quantity.quantity.empty() && k_measures[measure] != "up_to";
    headings.push_back(is_of_quantity ? fmt::format("{}: {}", quantity.quantity, heading) : heading);
  }
}

/// Rows of a table in Markdown. The quantities of one label stand side by side in one row.
[[nodiscard]] std::vector<Row> rows_of(const ComparisonTable& table) {
  std::vector<Row> rows{{"case"}};
  std::vector<const ComparisonRow*> quantities;  // all quantities of the table, in their order
  for (const ComparisonRow& row : table.rows) {
    const auto has_name = [&](const ComparisonRow* known) { return known->quantity == row.quantity; };
    if (std::ranges::none_of(quantities, has_name)) quantities.push_back(&row);
  }
  for (const ComparisonRow* quantity : quantities) append_headings(*quantity, rows.front());
  for (auto first = table.rows.begin(); first != table.rows.end();) {
    const auto last = quantities.size() == 1 ? first + 1 : std::find_if(first, table.rows.end(), [&](const auto& row) {
      return row.label != first->label;
    });
    for (std::size_t line = 0; line < first->lines.size(); ++line) {
      rows.push_back({first->label});
      for (const ComparisonRow* quantity : quantities) {
        const auto found =
            std::find_if(first, last, [&](const auto& row) { return row.quantity == quantity->quantity; });
        for (const std::size_t measure : quantity->measures) {
          rows.back().push_back(
              found == last || line >= found->lines.size() ? "-" : measured(k_cells[measure], found->lines[line]));
        }
      }
    }
    first = last;
  }
  return rows;
}

/// Half a unit in the last digit of a printed number: its largest distance from the value that it rounds.
[[nodiscard]] double round_off_of(const std::string& printed) {
  const std::size_t point = printed.find('.');
  const std::size_t decimals = point == std::string::npos ? 0 : printed.size() - point - 1;
  return 0.5 * std::pow(10.0, -static_cast<double>(decimals));
}

[[nodiscard]] double printed_number(const ValueRow& row) {
  double number = k_nan;
  if (!row.printed.empty()) std::from_chars(row.printed.data(), row.printed.data() + row.printed.size(), number);
  return number;
}

[[nodiscard]] bool has_references(const ValueTable& table) {
  return std::ranges::any_of(table.rows, [](const ValueRow& row) { return row.reference.has_value(); });
}

/// Rows of a table that compares values with those of a file.
[[nodiscard]] std::vector<Row> referenced_rows(const ValueTable& table) {
  std::vector<Row> rows{{"quantity", "computed", "reference", "difference", "relative", "remark"}};
  for (const ValueRow& row : table.rows) {
    const double reference = row.reference.value_or(k_nan);
    rows.push_back({row.label, fmt::format("{:.5g}", row.value), number_or_dash(reference, 5),
                    number_or_dash(row.value - reference, 3), number_or_dash((row.value - reference) / reference, 3),
                    row.remark});
  }
  return rows;
}

[[nodiscard]] std::vector<Row> rows_of(const ValueTable& table) {
  if (has_references(table)) return referenced_rows(table);
  constexpr double k_on_the_edge = 1.0 + 1e-9;  // a value of exactly half a unit may be rounded either way
  const bool has_printed = std::ranges::any_of(table.rows, [](const ValueRow& row) { return !row.printed.empty(); });
  std::vector<Row> rows;
  if (!has_printed) {
    const bool has_remarks = std::ranges::any_of(table.rows, [](const ValueRow& row) { return !row.remark.empty(); });
    rows.push_back({"quantity", "computed"});
    for (const ValueRow& row : table.rows) {
      rows.push_back({row.label, std::isfinite(row.value) ? fmt::format("{:#.10g}", row.value) : "-"});
    }
    for (std::size_t k = 0; has_remarks && k <= table.rows.size(); ++k) {
      rows[k].push_back(k == 0 ? "remark" : table.rows[k - 1].remark);
    }
    return rows;
  }
  rows.push_back({"quantity", "computed", "printed", "difference", "rounded to it", "remark"});
  for (const ValueRow& row : table.rows) {
    const double difference = row.value - printed_number(row);
    const bool is_rounded_to = std::abs(difference) <= k_on_the_edge * round_off_of(row.printed);
    rows.push_back({row.label, fmt::format("{:.8g}", row.value), row.printed.empty() ? "-" : row.printed,
                    number_or_dash(difference, 3), row.printed.empty() ? "-" : (is_rounded_to ? "yes" : "no"),
                    row.remark});
  }
  return rows;
}

constexpr const char* k_about_comparisons =
    "Loading up to each reversal: area error sqrt(int (model - reference)^2 dx)/int |reference| dx, peak error\n"
    "max |model - reference|/reference at the reversal, and the share of the loading that the model covers.\n"
    "Unloading from there: mean slope while the first 5 % of y go, residual x where y vanishes, and both over those\n"
    "of the reference. A hyphen: y does not vanish, or the curve does not turn back there.\n";
constexpr const char* k_about_bands =
    "Where a table has columns in percent: largest and root mean square of |model - reference|/reference over the\n"
    "rows of the reference's first loading within the band of x; unloading: largest |model - reference| while\n"
    "unloading and reloading from the band, over the largest reference before; coverage: share of the loading rows "
    "compared,\nwhich the curve reaches and in which the reference is not too small.\n";
constexpr const char* k_about_values =
    "Values as the laws give them; where the source prints one, whether it is the same rounded to as many digits.\n"
    "A hyphen: there is none.\n";
constexpr const char* k_about_references = "Values as the laws give them, beside the means of reference values.\n";

/// Titles and labels of a table for CSV; rows refer to them by number.
struct Words {
  Column titles{.name = "table"};
  Column labels{.name = "case"};
  Column quantities{.name = "quantity"};

  /// @param has_quantities  true if the table has the third column
  [[nodiscard]] std::vector<double> last(bool has_quantities = false) const {
    const auto place = [](const Column& column) { return static_cast<double>(column.labels.size()) - 1.0; };
    std::vector<double> places{place(titles), place(labels)};
    if (has_quantities) places.push_back(place(quantities));
    return places;
  }
};

/// Measures that any table of comparisons of a figure shows, in the order of k_measures.
[[nodiscard]] std::vector<std::size_t> measures_of(const AtlasFigure& figure) {
  std::set<std::size_t> measures;
  for (const ComparisonTable& table : figure.tables) {
    for (const ComparisonRow& row : table.rows) measures.insert(row.measures.begin(), row.measures.end());
  }
  return {measures.begin(), measures.end()};
}

}  // namespace

std::string tables_text(const AtlasFigure& figure) {
  if (figure.tables.empty() && figure.value_tables.empty()) return {};
  const bool is_referenced = std::ranges::any_of(figure.value_tables, has_references);
  const char* about = !figure.tables.empty() ? k_about_comparisons
                      : is_referenced        ? k_about_references
                                             : k_about_values;
  const bool has_bands = std::ranges::any_of(figure.tables, &ComparisonTable::has_bands);
  std::string text = fmt::format("# {}\n\n{}{}", figure.title, about, has_bands ? k_about_bands : "");
  const auto append = [&text](const auto& table) {
    text += fmt::format("\n## {}\n\n", table.title);
    append_markdown(text, rows_of(table));
  };
  std::ranges::for_each(figure.tables, append);
  std::ranges::for_each(figure.value_tables, append);
  return text;
}

Table tables_csv(const AtlasFigure& figure) {
  Words words;
  const bool is_referenced = std::ranges::any_of(figure.value_tables, has_references);
  std::vector<std::vector<double>> rows;
  const std::vector<std::size_t> measures = measures_of(figure);
  const bool has_quantities = std::ranges::any_of(figure.tables, [](const ComparisonTable& table) {
    return std::ranges::any_of(table.rows, [](const ComparisonRow& row) { return !row.quantity.empty(); });
  });
  for (const ComparisonTable& table : figure.tables) {
    words.titles.labels.push_back(table.title);
    for (const ComparisonRow& row : table.rows) {
      words.labels.labels.push_back(row.label);
      words.quantities.labels.push_back(row.quantity);
      for (const BranchComparison& line : row.lines) {
        rows.push_back(words.last(has_quantities));
        for (const std::size_t measure : measures) rows.back().push_back(k_cells[measure].value(line));
      }
    }
  }
  for (const ValueTable& table : figure.value_tables) {
    words.titles.labels.push_back(table.title);
    for (const ValueRow& row : table.rows) {
      words.labels.labels.push_back(row.label);
      rows.push_back(words.last());
      rows.back().insert(rows.back().end(), {row.value, printed_number(row)});
      if (is_referenced) rows.back().push_back(row.reference.value_or(k_nan));
    }
  }
  std::vector<Column> columns{std::move(words.titles), std::move(words.labels)};
  if (has_quantities) columns.push_back(std::move(words.quantities));
  const auto add = [&columns](const char* heading) { columns.push_back({.name = heading}); };
  if (figure.tables.empty()) {
    for (const char* heading : {"computed", "printed"}) add(heading);
    if (is_referenced) add("reference");
  } else {
    for (const std::size_t measure : measures) add(k_measures[measure].data());
  }
  Table csv(std::move(columns));
  csv.header = {{"title", figure.title}, {"source", figure.source}};
  for (const auto& row : rows) csv.append(row);
  return csv;
}

std::vector<fs::path> write_atlas(const std::vector<AtlasFigure>& figures, const fs::path& folder) {
  std::vector<fs::path> written;
  std::vector<figure::FigureFiles> files;
  for (const AtlasFigure& made : figures) {
    if (made.chart.panels.empty()) continue;
    files.emplace_back(folder / fmt::format("{}.{}", made.name, made.format));
    figure::expect_own_figure(files.back().figure());
  }
  const auto table_of = [&folder](const AtlasFigure& made) { return folder / (made.name + ".csv"); };
  std::vector<std::string> texts;
  for (const AtlasFigure& made : figures) {
    if (texts.emplace_back(tables_text(made)).empty()) continue;
    for (const char* extension : {".csv", ".md"}) expect_own_file(folder / (made.name + extension), table_of(made));
  }
  auto next = files.begin();
  auto tables = texts.begin();
  for (const AtlasFigure& made : figures) {
    if (!made.chart.panels.empty()) {
      const figure::FigureFiles& figure = *next++;
      figure.write(figure::chart_data(made.chart, fmt::format("{}; {}", made.title, made.source)),
                   figure::chart_script(made.chart, figure.format(), figure.figure_name(), figure.data_name()));
      written.push_back(figure.figure());
    }
    if (const std::string& text = *tables++; !text.empty()) {
      fs::create_directories(folder);
      write_text_file(table_of(made), csv_text(tables_csv(made)));
      write_text_file(folder / (made.name + ".md"), text);
      written.insert(written.end(), {table_of(made), folder / (made.name + ".md")});
    }
  }
  return written;
}

}  // namespace monograin
