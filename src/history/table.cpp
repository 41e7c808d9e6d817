#include "history/table.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <unordered_map>
#include <unordered_set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenario/text_encoding.hpp"
#include "scenario/text_file.hpp"
#include "scenario/words.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

/// Buffer for the text of one number: sign, 17 digits, point and exponent such as e-308 fit [bytes].
constexpr std::size_t k_longest_number = 32;
// Bounds of files that are read: bytes of a file, bytes of a line, cells. The largest file holds about two million rows
// of the history of a die.
constexpr std::size_t k_largest_csv = std::size_t{1} << 30U;
constexpr std::size_t k_longest_line = std::size_t{1} << 20U;
constexpr std::size_t k_most_cells = 100'000'000;

// --- writing

[[nodiscard]] bool prints_as_integer(double value) noexcept {
  return std::abs(value) < k_end_of_integers && value == std::trunc(value) && !(value == 0.0 && std::signbit(value));
}

}  // namespace

void append_csv_number(std::string& text, double value, int digits) {
  if (std::isnan(value)) {
    text += "nan";  // to_chars may print the sign of a NaN, which has no meaning
    return;
  }
  std::array<char, k_longest_number> cell;
  char* const end = cell.data() + cell.size();
  std::to_chars_result printed{};
  if (prints_as_integer(value)) {
    printed = std::to_chars(cell.data(), end, static_cast<long long>(value));
  } else if (digits >= k_all_digits) {
    printed = std::to_chars(cell.data(), end, value);  // the shortest text that restores the value
  } else {
    printed = std::to_chars(cell.data(), end, value, std::chars_format::general, digits);
  }
  text.append(cell.data(), printed.ptr);
}

namespace {

/// Words and headings are written without quotes, so that they must not contain separators of cells and rows.
/// @throws std::invalid_argument if a cell contains a comma, a quote or a line break
void require_plain(std::string_view cell) {
  if (cell.find_first_of(",\"\r\n") != std::string_view::npos) {
    throw std::invalid_argument(
        fmt::format("'{}' cannot be a cell of a CSV file: it contains a comma, a quote or a line break", cell));
  }
}

void append_header(std::string& text, const Table& table) {
  for (const auto& [key, value] : table.header) {
    std::string line = value.empty() ? fmt::format("# {}", key) : fmt::format("# {}: {}", key, value);
    std::ranges::replace_if(
        line, [](char c) { return static_cast<unsigned char>(c) < 0x20U || c == 0x7F; }, ' ');
    text += line + '\n';
  }
}

void append_headings(std::string& text, const std::vector<Column>& columns) {
  for (const Column& column : columns) {
    require_plain(column.heading());
    std::ranges::for_each(column.labels, require_plain);
    if (&column != &columns.front()) text += ',';
    text += column.heading();
  }
  text += '\n';
}

void append_row(std::string& text, const Table& table, std::size_t row, int digits) {
  const auto& columns = table.columns();
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (k > 0) text += ',';
    if (columns[k].holds_words()) {
      text += table.word(row, k);
    } else {
      append_csv_number(text, table.at(row, k), digits);
    }
  }
  text += '\n';
}

// --- reading

constexpr std::string_view k_blanks = " \t\r";

/// Value of a number beyond the range of double, as strtod gives it: zero or infinity with its sign.
[[nodiscard]] double out_of_range_value(std::string_view cell) noexcept {
  const bool is_tiny = cell.find("e-") != std::string_view::npos || cell.find("E-") != std::string_view::npos;
  const double magnitude = is_tiny ? 0.0 : k_infinity;
  return cell.starts_with('-') ? -magnitude : magnitude;
}

}  // namespace

std::optional<double> parsed_number(std::string_view cell) noexcept {
  if (cell.starts_with('+')) cell.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (end != cell.data() + cell.size()) return std::nullopt;
  if (error == std::errc::result_out_of_range) return out_of_range_value(cell);
  if (error != std::errc{}) return std::nullopt;
  return value;
}

Column parsed_heading(std::string_view heading) {
  const std::size_t bracket = heading.rfind('[');
  const bool has_unit =
      bracket != std::string_view::npos && bracket > 0 && heading.ends_with(']') && heading.size() > bracket + 2;
  if (!has_unit) return {.name = std::string(heading)};
  return {.name = std::string(heading.substr(0, bracket)),
          .unit = std::string(heading.substr(bracket + 1, heading.size() - bracket - 2))};
}

std::pair<std::string, std::string> parsed_header_line(std::string_view line) {
  line = trimmed(line.substr(1), k_blanks);
  const std::size_t colon = line.ends_with(':') ? std::min(line.find(": "), line.size() - 1) : line.find(": ");
  if (colon == std::string_view::npos) return {std::string(line), {}};
  return {std::string(line.substr(0, colon)), std::string(trimmed(line.substr(colon + 1), k_blanks))};
}

namespace {

/// Parser of a CSV text. It keeps cells as text until all rows are read: only then columns of numbers are known.
class CsvText {
 public:
  CsvText(std::string name, std::string_view text) : name_(std::move(name)) {
    if (text.size() > k_largest_csv) {
      fail(fmt::format("the file is too large; expected at most {} MiB", k_largest_csv >> 20U));
    }
    constexpr std::string_view k_byte_order_mark = "\xEF\xBB\xBF";
    if (text.starts_with(k_byte_order_mark)) text.remove_prefix(k_byte_order_mark.size());
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      ++line_;
      if (end > k_longest_line) {
        fail(fmt::format("the line is too long; expected at most {} MiB", k_longest_line >> 20U), k_longest_line + 1);
      }
      take_line(trimmed(text.substr(0, end), separator_ == '\t' ? " \r" : k_blanks));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    if (columns_.empty()) fail("no row of headings");
  }

  [[nodiscard]] Table table() && {
    std::vector<double> values(cells_.size());
    for (std::size_t k = 0; k < columns_.size(); ++k) fill_column(k, values);
    const std::size_t width = columns_.size();
    Table table(std::move(columns_));
    table.header = std::move(header_);
    table.reserve_rows(values.size() / width);
    for (std::size_t first = 0; first < values.size(); first += width) {
      table.append(std::span(values).subspan(first, width));
    }
    return table;
  }

 private:
  [[noreturn]] void fail(const std::string& fault, std::size_t column = 1) const {
    throw std::runtime_error(fmt::format("{}:{}:{}: {}", name_, std::max<std::size_t>(line_, 1), column, fault));
  }

  void take_line(std::string_view line) {
    if (line.empty()) return;
    if (line.starts_with('#')) {
      header_.push_back(parsed_header_line(line));
    } else if (columns_.empty()) {
      take_headings(line);
    } else {
      take_row(line);
    }
  }

  void take_headings(std::string_view line) {
    const std::size_t other = line.find_first_of(k_other_separators);
    if (other != std::string_view::npos && line.find(',') == std::string_view::npos) separator_ = line[other];
    std::unordered_set<std::string_view> seen;
    for_each_cell(line, [&](std::string_view heading) {
      if (heading.empty()) fail(fmt::format("column {} has no heading", columns_.size() + 1));
      if (!seen.insert(heading).second) fail(fmt::format("two columns are called '{}'", heading));
      columns_.push_back(parsed_heading(heading));
    });
    if (std::ranges::any_of(seen, [](std::string_view heading) { return parsed_number(heading).has_value(); })) {
      fail("numbers where a row of headings is expected");
    }
  }

  void take_row(std::string_view line) {
    const std::size_t before = cells_.size();
    for_each_cell(line, [&](std::string_view cell) { cells_.push_back(cell); });
    const std::size_t width = cells_.size() - before;
    if (width != columns_.size()) {
      fail(fmt::format("the row has {} cells, but there are {} headings", width, columns_.size()));
    }
    if (cells_.size() > k_most_cells) {
      fail(fmt::format("the table is too large; expected at most {} million cells", k_most_cells / 1'000'000));
    }
  }

  template <class Visit>
  void for_each_cell(std::string_view line, Visit visit) const {
    for (;;) {
      const std::size_t end = line.find(separator_);
      visit(trimmed(line.substr(0, end), k_blanks));
      if (end == std::string_view::npos) return;
      line.remove_prefix(end + 1);
    }
  }

  /// Number in a cell; where commas do not separate cells, they mark decimals.
  [[nodiscard]] std::optional<double> number_of(std::string_view cell) const {
    if (separator_ == ',' || cell.find(',') == std::string_view::npos) return parsed_number(cell);
    std::string with_point(cell);
    std::ranges::replace(with_point, ',', '.');
    return parsed_number(with_point);
  }

  void fill_column(std::size_t column, std::vector<double>& values) {
    bool has_numbers = false;
    bool has_words = false;
    for (std::size_t k = column; k < cells_.size() && !has_words; k += columns_.size()) {
      const auto number = number_of(cells_[k]);
      has_numbers = has_numbers || number;
      has_words = !number && !cells_[k].empty();
      values[k] = number.value_or(std::numeric_limits<double>::quiet_NaN());
    }
    if (has_words || !has_numbers) fill_words(column, values);
  }

  void fill_words(std::size_t column, std::vector<double>& values) {
    std::unordered_map<std::string_view, std::size_t> indices;
    auto& labels = columns_[column].labels;
    for (std::size_t k = column; k < cells_.size(); k += columns_.size()) {
      const auto [entry, is_new] = indices.try_emplace(cells_[k], labels.size());
      if (is_new) labels.emplace_back(cells_[k]);
      values[k] = static_cast<double>(entry->second);
    }
  }

  static constexpr std::string_view k_other_separators = ";\t";

  std::string name_;
  std::size_t line_ = 0;
  char separator_ = ',';
  std::vector<std::pair<std::string, std::string>> header_;
  std::vector<Column> columns_;
  std::vector<std::string_view> cells_;  ///< row by row, pointing into the text
};

/// True if a column has that name, alone or with its unit. Comparing in place avoids strings, so that nothing throws.
[[nodiscard]] bool is_called(const Column& column, std::string_view name) noexcept {
  if (!name.starts_with(column.name)) return false;
  name.remove_prefix(column.name.size());
  if (name.empty()) return true;
  return !column.unit.empty() && name.starts_with('[') && name.ends_with(']') &&
         name.substr(1, name.size() - 2) == column.unit;
}

}  // namespace

bool is_counter(const Column& column) noexcept { return column.name == "step" || column.name == "row"; }

std::string Column::heading() const { return unit.empty() ? name : name + '[' + unit + ']'; }

std::span<const double> Table::row(std::size_t index) const {
  return std::span(values_).subspan(index * columns_.size(), columns_.size());
}

void Table::append(std::span<const double> row) {
  if (row.size() != columns_.size()) {
    throw std::logic_error(
        fmt::format("a row of {} values does not fit a table of {} columns", row.size(), columns_.size()));
  }
  values_.insert(values_.end(), row.begin(), row.end());
}

void Table::reserve_rows(std::size_t count) { values_.reserve(values_.size() + count * columns_.size()); }

std::optional<std::size_t> Table::find(std::string_view name) const noexcept {
  const auto found = std::ranges::find_if(columns_, [name](const Column& column) { return is_called(column, name); });
  if (found == columns_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - columns_.begin());
}

std::vector<double> Table::column(std::string_view name) const {
  const auto index = find(name);
  if (!index) {
    std::vector<std::string> headings;
    for (const Column& column : columns_) headings.push_back(column.heading());
    throw std::out_of_range(fmt::format("no column '{}'; there are: {}", name, fmt::join(headings, ", ")));
  }
  std::vector<double> values;
  values.reserve(row_count());
  for (std::size_t k = *index; k < values_.size(); k += columns_.size()) values.push_back(values_[k]);
  return values;
}

std::string_view Table::word(std::size_t row, std::size_t column) const {
  const double index = at(row, column);
  if (!(index >= 0.0)) throw std::out_of_range(fmt::format("row {}, column {} holds no word", row, column));
  return columns_.at(column).labels.at(static_cast<std::size_t>(index));
}

std::string_view Table::header_value(std::string_view key) const noexcept {
  const auto found = std::ranges::find(header, key, &std::pair<std::string, std::string>::first);
  return found == header.end() ? std::string_view{} : std::string_view(found->second);
}

std::optional<double> Table::header_number(std::string_view key) const noexcept {
  return parsed_number(header_value(key));
}

std::string csv_number(double value) {
  std::string text;
  append_csv_number(text, value);
  return text;
}

void for_each_csv_part(const Table& table, const TextSink& sink, int digits) {
  // An output stream would swallow an allocation that fails, and the text would end there.
  std::string text;
  append_header(text, table);
  append_headings(text, table.columns());
  sink(text);
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    text.clear();
    append_row(text, table, row, digits);
    sink(text);
  }
}

std::string csv_text(const Table& table, int digits) {
  std::string text;
  for_each_csv_part(
      table, [&text](std::string_view part) { text += part; }, digits);
  return text;
}

void write_csv(const std::filesystem::path& file, const Table& table) {
  write_text_file(file, [&table](const TextSink& sink) { for_each_csv_part(table, sink); });
}

Table read_csv(const std::filesystem::path& file, FileKind kind) {
  const std::string name = name_of_file(file, kind).string();
  auto [text, problem] = read_text_file(file, k_largest_csv, kind);
  if (has_wide_mark(text)) {
    DecodedText decoded = decode_text(text);
    text = std::move(decoded.text);
    problem = std::move(decoded.problem);
  }
  if (!problem.empty()) throw std::runtime_error(fmt::format("{}:1:1: {}; expected a table (CSV)", name, problem));
  return CsvText(name, text).table();
}

}  // namespace monograin
