#include "scenario/table_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "scenario/cells.hpp"
#include "scenario/units.hpp"
#include "scenario/words.hpp"

namespace monograin {
namespace {

constexpr std::size_t k_sampled_lines = 1000;

struct Dialect {
  char separator;
  char decimal;
};

// The order decides between equal scores: "1;2" has decimal points, "1,2" is no decimal number.
constexpr std::array k_dialects{Dialect{'\t', '.'}, Dialect{';', '.'}, Dialect{',', '.'}, Dialect{' ', '.'},
                                Dialect{'\t', ','}, Dialect{';', ','}, Dialect{',', ','}, Dialect{' ', ','}};

constexpr std::array<Dimension, 9> k_measured_dimensions{
    Dimension::length, Dimension::stress,   Dimension::surface_energy, Dimension::force,      Dimension::time,
    Dimension::angle,  Dimension::velocity, Dimension::force_rate,     Dimension::strain_rate};
constexpr std::array<std::string_view, 9> k_other_units{"-", "1", "%", "sec", "Hz", "V", "°C", "C", "R0"};

bool is_in(std::string_view text, char opening, char closing) {
  return text.size() > 2 && text.front() == opening && text.back() == closing;
}

bool is_in_brackets(std::string_view text) { return is_in(text, '[', ']') || is_in(text, '(', ')'); }

/// "mm" of "mm", "[mm]" and "(mm)".
std::string_view bare_unit(std::string_view text) {
  return trimmed(is_in_brackets(text) ? text.substr(1, text.size() - 2) : text);
}

/// A heading taken apart.
struct Heading {
  std::string_view name;
  std::string_view unit;
};

Heading taken_apart(std::string_view heading) {
  const auto split = [heading](std::size_t at, std::size_t length, std::size_t behind) -> Heading {
    const std::size_t begin = at + length;
    return {trimmed(heading.substr(0, at)), trimmed(heading.substr(begin, heading.size() - begin - behind))};
  };
  const std::size_t square = heading.rfind('[');
  if (square != std::string_view::npos && square > 0 && heading.ends_with(']')) return split(square, 1, 1);
  if (const std::size_t round = heading.rfind('('); round != std::string_view::npos && round > 0) {
    if (const Heading parts = split(round, 1, 1); heading.ends_with(')') && is_known_unit(parts.unit)) return parts;
  }
  for (const std::string_view word : {" / ", " in ", ", "}) {
    const std::size_t at = heading.rfind(word);
    if (at == std::string_view::npos || at == 0) continue;
    if (const Heading parts = split(at, word.size(), 0); is_known_unit(parts.unit)) return parts;
  }
  return {heading, {}};
}

struct Line {
  std::size_t number;  ///< from 1
  std::string_view text;
};

/// A line with its cells.
struct SampledRow {
  std::size_t number = 0;
  std::vector<Cell> cells;
  std::size_t numbers = 0;  ///< of its cells that are numbers
  std::size_t filled = 0;   ///< of its cells that are not empty
};

SampledRow row_of(const Line& line, const Dialect& dialect) {
  SampledRow row{.number = line.number, .cells = cells_of(line.text, dialect.separator)};
  for (const Cell& cell : row.cells) {
    if (!cell.text.empty()) ++row.filled;
    if (number_in(cell.text, dialect.decimal)) ++row.numbers;
  }
  return row;
}

/// Sums of the squared shares of numbers among the cells: of rows with several numbers, and of rows with one number,
/// which may be chance and only decides if there are no others. The square favours few rows of pure numbers.
using Score = std::pair<double, double>;

Score score_of(const std::vector<Line>& lines, const Dialect& dialect) {
  Score score;
  for (const Line& line : lines) {
    const SampledRow row = row_of(line, dialect);
    if (row.numbers == 0 || row.filled < 2) continue;
    const double share = static_cast<double>(row.numbers) / static_cast<double>(row.filled);
    (row.numbers > 1 ? score.first : score.second) += share * share;
  }
  if (score.first > 0.0) score.second = 0.0;
  return score;
}

Dialect dialect_of(const std::vector<Line>& lines, const TableFormat& given) {
  Dialect best{given.separator.value_or(','), given.decimal.value_or('.')};
  Score best_score;
  for (const Dialect& dialect : k_dialects) {
    if (given.separator.value_or(dialect.separator) != dialect.separator) continue;
    if (given.decimal.value_or(dialect.decimal) != dialect.decimal) continue;
    const Score score = score_of(lines, dialect);
    if (!(score > best_score)) continue;
    best_score = score;
    best = dialect;
  }
  return best;
}

std::vector<Line> sampled_lines(std::string_view text, std::size_t skip) {
  std::vector<Line> lines;
  for (std::size_t number = 1; !text.empty() && lines.size() < k_sampled_lines; ++number) {
    const std::string_view line = take_line(text);
    if (number > skip && !is_comment(line)) lines.push_back({number, line});
  }
  return lines;
}

/// Number of cells up to the last one that is not empty.
std::size_t filled_width(const SampledRow& row) {
  const auto last = std::find_if(row.cells.rbegin(), row.cells.rend(), [](const Cell& c) { return !c.text.empty(); });
  return static_cast<std::size_t>(row.cells.rend() - last);
}

class LayoutFinder {
 public:
  LayoutFinder(std::string_view text, const TableFormat& given, const std::vector<std::string_view>& names)
      : given_(given), names_(names) {
    const std::vector<Line> lines = sampled_lines(text, given.skip.value_or(0));
    dialect_ = dialect_of(lines, given);
    for (const Line& line : lines) {
      SampledRow row = row_of(line, dialect_);
      if (row.filled > 0) rows_.push_back(std::move(row));  // a line of separators has no content
    }
  }

  TableLayout find() {
    TableLayout layout{.separator = dialect_.separator, .decimal = dialect_.decimal};
    if (rows_.empty()) return layout;
    find_width();
    const std::size_t first = first_of_data();
    const std::optional<std::size_t> headings = heading_row(first);
    std::size_t next = headings ? *headings + 1 : given_.skip ? 0 : first;
    std::vector<std::string> row_units;
    if (headings) {
      layout.heading_line = rows_[*headings].number;
      layout.headings = texts_of(headings_of(*headings));
      layout.preamble = *headings;
      if (has_units_at(next, first)) {
        layout.unit_line = rows_[next].number;
        for (const Cell& cell : headings_of(next)) row_units.emplace_back(bare_unit(cell.text));
        ++next;
      }
    } else {
      layout.headings.resize(width_);
      layout.preamble = next;
      layout.splits_decimals = splits_decimals(first);
      if (first > 0 && rows_[first - 1].numbers == 0 && rows_[first - 1].filled > 1) {
        layout.unmatched_line = rows_[first - 1].number;
      }
    }
    layout.first_line = next < rows_.size() ? rows_[next].number : rows_.back().number + 1;
    take_units(row_units, layout);
    std::vector<const SampledRow*> data;
    for (std::size_t row = next; row < rows_.size(); ++row) data.push_back(&rows_[row]);
    layout.is_numeric = columns_of_numbers(layout.headings.size(), data);
    return layout;
  }

 private:
  /// Number of columns: that of most rows of numbers, without columns at the end that are always empty.
  void find_width() {
    const bool has_rows = std::ranges::any_of(rows_, [](const SampledRow& row) { return row.numbers > 1; });
    least_numbers_ = has_rows ? 2 : 1;
    std::map<std::size_t, std::size_t> counts;
    for (const SampledRow& row : rows_) {
      if (row.numbers >= least_numbers_) ++counts[row.cells.size()];
    }
    if (counts.empty()) return;
    cell_count_ = std::ranges::max_element(counts, {}, [](const auto& entry) { return entry.second; })->first;
    std::vector<const SampledRow*> rows;
    for (const SampledRow& row : rows_) {
      if (!is_of_table(row)) continue;
      width_ = std::max(width_, filled_width(row));
      rows.push_back(&row);
    }
    holds_numbers_ = columns_of_numbers(cell_count_, rows);
  }

  /// For each column: true if most of its cells in these rows are numbers.
  [[nodiscard]] std::vector<bool> columns_of_numbers(std::size_t columns,
                                                     const std::vector<const SampledRow*>& rows) const {
    std::vector<bool> result;
    for (std::size_t k = 0; k < columns; ++k) {
      std::size_t numbers = 0;
      std::size_t filled = 0;
      for (const SampledRow* row : rows) {
        if (k >= row->cells.size()) continue;
        if (!row->cells[k].text.empty()) ++filled;
        if (number_in(row->cells[k].text, dialect_.decimal)) ++numbers;
      }
      result.push_back(numbers > 0 && 2 * numbers >= filled);
    }
    return result;
  }

  [[nodiscard]] bool is_of_table(const SampledRow& row) const {
    return row.numbers >= least_numbers_ && row.cells.size() == cell_count_;
  }

  /// First row with numbers only in the columns of numbers; the number of rows if there is none.
  [[nodiscard]] std::size_t first_of_data() const {
    const auto first = std::ranges::find_if(rows_, [this](const SampledRow& row) {
      if (cell_count_ == 0 || !is_of_table(row)) return false;
      for (std::size_t k = 0; k < cell_count_; ++k) {
        const std::string_view text = row.cells[k].text;
        if (holds_numbers_[k] && !text.empty() && !number_in(text, dialect_.decimal)) return false;
      }
      return true;
    });
    return static_cast<std::size_t>(first - rows_.begin());
  }

  /// Cells of a row of headings or units. With blanks as separators, a unit in brackets is a cell of its own; it joins
  /// the cell before it if the row has too many cells.
  [[nodiscard]] std::vector<Cell> headings_of(std::size_t row) const {
    std::vector<Cell> cells;
    const bool has_too_many = dialect_.separator == ' ' && rows_[row].cells.size() > width_;
    for (const Cell& cell : rows_[row].cells) {
      if (has_too_many && !cells.empty() && is_in_brackets(cell.text)) {
        Cell& before = cells.back();
        before.text = {before.text.data(),
                       static_cast<std::size_t>(cell.text.data() + cell.text.size() - before.text.data())};
      } else {
        cells.push_back(cell);
      }
    }
    while (cells.size() > std::max<std::size_t>(width_, 1) && cells.back().text.empty()) cells.pop_back();
    return cells;
  }

  static std::vector<std::string> texts_of(const std::vector<Cell>& cells) {
    std::vector<std::string> texts;
    for (const Cell& cell : cells) {
      std::string text(cell.text);
      for (std::size_t at = 0; (at = text.find("\"\"", at)) != std::string::npos; ++at) text.erase(at, 1);
      texts.push_back(std::move(text));
    }
    return texts;
  }

  [[nodiscard]] bool has_all_names(std::size_t row) const {
    const std::vector<std::string> headings = texts_of(headings_of(row));
    return std::ranges::all_of(names_, [&headings](std::string_view name) {
      return std::ranges::any_of(headings, [name](const std::string& h) { return h == name || name_in(h) == name; });
    });
  }

  /// True for a row of texts that has a cell for each column. Columns that are always empty may have one, too.
  [[nodiscard]] bool may_be_headings(std::size_t row) const {
    if (rows_[row].numbers > 0 || !(rows_[row].filled > 1 || width_ == 1)) return false;
    const std::size_t cells = headings_of(row).size();
    return width_ == 0 || (cells >= width_ && cells <= std::max(width_, cell_count_));
  }

  /// Index of the row of headings. @param first  index of the first row of data
  [[nodiscard]] std::optional<std::size_t> heading_row(std::size_t first) const {
    const auto has_numbers = [this](std::size_t row) { return rows_[row].numbers == rows_[row].filled; };
    if (given_.skip) return has_numbers(0) ? std::nullopt : std::optional<std::size_t>(0);
    for (std::size_t row = 0; row < rows_.size() && !names_.empty(); ++row) {
      if (has_all_names(row)) return row;
    }
    if (first == rows_.size()) return 0;  // no data: the first row must be the headings
    for (std::size_t row = first; row-- > 0;) {
      if (!may_be_headings(row)) continue;
      const bool is_below_headings = names_units(row) && row > 0 && may_be_headings(row - 1);
      return is_below_headings ? row - 1 : row;
    }
    return std::nullopt;
  }

  /// True if the row above the data has texts only, half as many as the data have cells, and these have no decimal
  /// points: "s,N" above "0,5,1,25".
  /// @param first  index of the first row of data
  [[nodiscard]] bool splits_decimals(std::size_t first) const {
    if (given_.decimal || dialect_.separator != ',' || first == 0 || first == rows_.size()) return false;
    const auto has_point = [](const Cell& cell) { return cell.text.find('.') != std::string_view::npos; };
    if (std::ranges::any_of(rows_[first].cells, has_point)) return false;
    const SampledRow& above = rows_[first - 1];
    return above.numbers == 0 && above.filled > 1 && 2 * above.filled == width_;
  }

  [[nodiscard]] bool names_units(std::size_t row) const {
    if (rows_[row].numbers > 0) return false;
    return std::ranges::any_of(rows_[row].cells, [](const Cell& cell) { return is_known_unit(bare_unit(cell.text)); });
  }

  /// True if a row is one of units. @param first  index of the first row of data
  [[nodiscard]] bool has_units_at(std::size_t row, std::size_t first) const {
    if (given_.units == TableFormat::Units::none || row >= rows_.size()) return false;
    return given_.units == TableFormat::Units::row || (row < first && names_units(row));
  }

  void take_units(const std::vector<std::string>& row_units, TableLayout& layout) const {
    for (const std::string& heading : layout.headings) layout.units.emplace_back(unit_in(heading));
    for (const auto& units : {row_units, given_.unit_of}) {
      for (std::size_t k = 0; k < std::min(units.size(), layout.units.size()); ++k) {
        if (!units[k].empty()) layout.units[k] = units[k];
      }
    }
  }

  const TableFormat& given_;
  const std::vector<std::string_view>& names_;
  Dialect dialect_{};
  std::vector<SampledRow> rows_;
  std::size_t least_numbers_ = 1;    ///< least count of numbers in a row of data
  std::size_t cell_count_ = 0;       ///< cells in a row of data, with empty ones at its end; 0: there are no such rows
  std::size_t width_ = 0;            ///< columns of the table, without those at its end that are always empty
  std::vector<bool> holds_numbers_;  ///< true if most cells of the column are numbers
};

}  // namespace

TableLayout find_layout(std::string_view text, const TableFormat& given, const std::vector<std::string_view>& names) {
  return LayoutFinder(text, given, names).find();
}

bool is_plain(const TableLayout& layout) noexcept {
  return layout.encoding.starts_with("UTF-8") && layout.separator == ',' && layout.decimal == '.' &&
         layout.heading_line > 0 && layout.unit_line == 0 && layout.preamble == 0;
}

std::string describe(const TableLayout& layout) {
  std::string text = fmt::format("{}, {} between cells, decimal {}", layout.encoding, separator_word(layout.separator),
                                 layout.decimal == '.' ? "point" : "comma");
  text += layout.heading_line > 0 ? fmt::format(", headings in line {}", layout.heading_line) : ", no headings";
  if (layout.unit_line > 0) text += fmt::format(", units in line {}", layout.unit_line);
  return text;
}

std::string_view separator_word(char separator) noexcept {
  switch (separator) {
    case ',':
      return "comma";
    case ';':
      return "semicolon";
    case '\t':
      return "tab";
    default:
      return "blanks";
  }
}

bool is_known_unit(std::string_view text) {
  if (text.empty()) return false;
  if (std::ranges::find(k_other_units, text) != k_other_units.end()) return true;
  return std::ranges::any_of(k_measured_dimensions,
                             [text](Dimension dimension) { return is_unit_of(text, dimension); });
}

std::string_view unit_in(std::string_view heading) noexcept { return taken_apart(heading).unit; }

std::string_view name_in(std::string_view heading) noexcept { return taken_apart(heading).name; }

}  // namespace monograin
