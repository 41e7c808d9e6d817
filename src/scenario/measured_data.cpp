#include "scenario/measured_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <utility>

#include "scenario/cells.hpp"
#include "scenario/text_encoding.hpp"
#include "scenario/units.hpp"
#include "scenario/words.hpp"

namespace monograin {
namespace {

// Those with '#' are errors of spreadsheets, in English and in German.
constexpr std::array<std::string_view, 18> k_missing{"",        "nan",    "na",    "n/a",     "-",      "--",
                                                     "---",     "-----",  "#n/a",  "#nv",     "#wert!", "#value!",
                                                     "#div/0!", "#zahl!", "#num!", "#bezug!", "#ref!",  "#name?"};

/// True if a cell marks a missing number.
bool is_missing(std::string_view text) {
  std::string word(text);
  std::ranges::transform(word, word.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::ranges::find(k_missing, word) != k_missing.end();
}

/// True for a text that begins with a digit, or with one after a sign, a decimal sign or both.
bool begins_as_a_number(std::string_view text) {
  if (text.starts_with(k_minus_sign))
    text.remove_prefix(k_minus_sign.size());
  else if (text.starts_with('+') || text.starts_with('-'))
    text.remove_prefix(1);
  if (text.starts_with('.') || text.starts_with(',')) text.remove_prefix(1);
  return !text.empty() && text.front() >= '0' && text.front() <= '9';
}

/// True for a time of day or a duration such as "00:01:30".
bool is_clock_time(std::string_view text) {
  const auto is_part_of_it = [](char c) { return (c >= '0' && c <= '9') || c == ':' || c == '.' || c == ','; };
  return text.find(':') != std::string_view::npos && begins_a_number(text) && std::ranges::all_of(text, is_part_of_it);
}

/// Advice on a cell that is no number: its likely meaning, and a remedy. Empty if the meaning is unclear.
std::string advice_for(std::string_view text, char decimal) {
  if (is_clock_time(text)) return "; clock times are not understood, expected times in one unit, such as seconds";
  const char other = decimal == '.' ? ',' : '.';
  if (text.find(other) == std::string_view::npos) return {};
  if (text.find(decimal) != std::string_view::npos)
    return "; expected no thousands separators, or groups of three digits";
  const std::size_t mark = text.find(other);
  if (text.size() == mark + 4 && mark > 0 && mark < 4 && number_in(text, other)) {
    return fmt::format("; '{}' may mark thousands or decimals; expected such numbers without it", other);
  }
  if (number_in(text, other)) return fmt::format("; the decimal sign of the rows above is '{}'", decimal);
  return {};
}

class DataParser {
 public:
  DataParser(const std::string& origin, const std::vector<ColumnRequest>& wanted, const TableFormat& format,
             FaultList& faults)
      : origin_(origin), wanted_(wanted), format_(format), faults_(faults) {
    data_.columns.resize(wanted.size());
  }

  MeasuredData parse(std::string_view bytes) {
    DecodedText decoded = decode_text(bytes);
    if (!decoded.problem.empty()) {
      line_ = 1;
      fault(1, decoded.problem);
      return std::move(data_);
    }
    find_columns(decoded);
    take_rows(decoded.text);
    check_missing();
    check_length();
    const bool is_utf_8 = decoded.encoding.starts_with("UTF-8");
    data_.text = is_utf_8 ? std::string(bytes) : std::move(decoded.text);
    return std::move(data_);
  }

 private:
  void find_columns(const DecodedText& decoded) {
    std::vector<std::string_view> names;
    for (const ColumnRequest& request : wanted_) {
      if (!request.name.empty()) names.push_back(request.name);
    }
    data_.layout = find_layout(decoded.text, format_, names);
    data_.layout.encoding = decoded.encoding;
    const std::vector<std::string>& headings = data_.layout.headings;
    if (headings.empty()) return;
    if (data_.layout.heading_line == 0 && !names.empty()) {
      line_ = data_.layout.first_line;
      return fault(1,
                   "a number where a row of headings is expected, for example displacement[m],force[N]; or give the "
                   "columns by their numbers, from 1, without quotes");
    }
    if (data_.layout.splits_decimals) {
      line_ = data_.layout.first_line;
      return fault(1, fmt::format("{} cells below {} headings: commas seem to separate the cells and to mark decimals; "
                                  "expected another separator, or cells in quotes",
                                  headings.size(), headings.size() / 2));
    }
    if (!format_.unit_of.empty() && format_.unit_of.size() != headings.size()) {
      line_ = std::max(data_.layout.heading_line, data_.layout.first_line);
      fault(1, fmt::format("{} columns, but {} units are given; expected a unit for each, in the order of the columns",
                           headings.size(), format_.unit_of.size()));
    }
    for (std::size_t k = 0; k < wanted_.size(); ++k) {
      const std::optional<std::size_t> place = place_of(wanted_[k]);
      if (!place && found_ > 0 && !doubt_of_separator().empty()) return;  // which hides the other columns, too
      if (!place) continue;
      data_.columns[k].number = *place + 1;
      data_.columns[k].heading = headings[*place];
      data_.columns[k].unit = data_.layout.units[*place];
    }
  }

  /// Index of the requested column in the file.
  std::optional<std::size_t> place_of(const ColumnRequest& request) {
    const std::vector<std::string>& headings = data_.layout.headings;
    if (request.number > headings.size()) {
      return no_column(request, fmt::format("{} has {} columns", on_one_line(origin_), headings.size()));
    }
    if (request.number > 0) return request.number - 1;
    if (request.name.empty()) return std::nullopt;  // its own fault has been reported
    auto found = std::ranges::find(headings, request.name);
    const bool is_whole = found != headings.end();
    const auto is_meant = [&](const std::string& heading) {
      return is_whole ? heading == request.name : name_in(heading) == request.name;
    };
    if (!is_whole) found = std::ranges::find_if(headings, is_meant);
    if (found == headings.end()) {
      const std::vector<std::string_view> known(headings.begin(), headings.end());
      return no_column(
          request, fmt::format("{} has no such column; expected one of {}{}{}", on_one_line(origin_),
                               on_one_line(listed(known)), did_you_mean(request.name, known), doubt_of_separator()));
    }
    if (const auto again = std::find_if(found + 1, headings.end(), is_meant); again != headings.end()) {
      return no_column(request,
                       fmt::format("columns {} and {} of {} are both called so; expected the number of one",
                                   found - headings.begin() + 1, again - headings.begin() + 1, on_one_line(origin_)));
    }
    return static_cast<std::size_t>(found - headings.begin());
  }

  /// Names the separator that was found, where the cells seem to be separated otherwise.
  [[nodiscard]] std::string doubt_of_separator() const {
    const std::vector<std::string>& headings = data_.layout.headings;
    const auto has_bar = [](const std::string& heading) { return heading.find('|') != std::string::npos; };
    if (headings.size() > 1 && std::ranges::none_of(headings, has_bar)) return {};
    return fmt::format("; the cells were read with {} between them, and expected is comma, semicolon, tab or blanks",
                       separator_word(data_.layout.separator));
  }

  std::nullopt_t no_column(const ColumnRequest& request, const std::string& problem) {
    ++found_;
    faults_.add(request.where, fmt::format("{}: {}", request.naming, problem));
    return std::nullopt;
  }

  void take_rows(std::string_view rest) {
    line_ = 0;
    std::vector<TextLine> texts;  // since the last row with a number
    while (!rest.empty() && found_ < k_most_shown_faults) {
      ++line_;
      const std::string_view line = take_line(rest);
      if (line_ < data_.layout.first_line) continue;
      std::vector<Cell> cells = cells_of(line, data_.layout.separator);
      const auto is_empty = [](const Cell& cell) { return cell.text.empty(); };
      if (std::ranges::all_of(cells, is_empty) || (is_comment(line) && !is_missing(cells.front().text))) continue;
      if (is_text(cells)) {
        texts.push_back({line_, std::move(cells)});
        continue;
      }
      take_texts(texts);
      take_row(cells);
    }
    const bool has_rows = !data_.lines.empty() || !data_.left_out.empty();
    if (!has_rows || !format_.may_have_trailer) take_texts(texts);
    for (const TextLine& line : texts) data_.trailer.push_back(line.number);
    if (found_ >= k_most_shown_faults && !rest.empty()) {
      ++line_;
      fault(1, "too many faults above; the rest of the table is not checked");
    }
  }

  struct TextLine {
    std::size_t number;
    std::vector<Cell> cells;
  };

  /// True for cells that hold a text and nothing that begins as a number does.
  [[nodiscard]] static bool is_text(const std::vector<Cell>& cells) {
    const auto is_number = [](const Cell& cell) { return begins_as_a_number(cell.text); };
    return std::ranges::none_of(cells, is_number) &&
           !std::ranges::all_of(cells, [](const Cell& cell) { return is_missing(cell.text); });
  }

  /// Takes lines of texts as rows, which they are no ends of.
  void take_texts(std::vector<TextLine>& texts) {
    const std::size_t last = line_;
    for (const TextLine& line : texts) {
      if (found_ >= k_most_shown_faults) break;
      line_ = line.number;
      take_row(line.cells);
    }
    texts.clear();
    line_ = last;
  }

  void take_row(const std::vector<Cell>& cells) {
    const std::size_t width = data_.layout.headings.size();
    const auto is_empty = [](const Cell& cell) { return cell.text.empty(); };
    const bool has_surplus = cells.size() > width;
    if (cells.size() < width ||
        (has_surplus && !std::all_of(cells.begin() + static_cast<std::ptrdiff_t>(width), cells.end(), is_empty))) {
      return fault(cells.front().column,
                   fmt::format("{} cell{} where there are {} {}; expected a cell for each, and nothing below the table",
                               cells.size(), cells.size() == 1 ? "" : "s", width,
                               data_.layout.heading_line > 0 ? "headings" : "columns"));
    }
    std::vector<double> values;
    bool is_left_out = false;
    for (const MeasuredColumn& column : data_.columns) {
      values.push_back(0.0);
      if (column.number == 0) continue;
      const Cell& cell = cells[column.number - 1];
      if (const auto value = number_in(cell.text, data_.layout.decimal)) {
        values.back() = *value;
      } else if (is_missing(cell.text)) {
        is_left_out = true;
        if (missing_.size() < k_most_shown_faults) missing_.push_back({line_, cell.column, no_number(column, cell)});
      } else {
        fault(cell.column, no_number(column, cell) + advice_for(cell.text, data_.layout.decimal));
      }
    }
    if (is_left_out) return data_.left_out.push_back(line_);
    for (std::size_t k = 0; k < data_.columns.size(); ++k) {
      MeasuredColumn& column = data_.columns[k];
      if (column.number == 0) continue;
      column.values.push_back(values[k]);
      column.at.push_back(cells[column.number - 1].column);
    }
    data_.lines.push_back(line_);
  }

  static std::string no_number(const MeasuredColumn& column, const Cell& cell) {
    const std::string name = column.heading.empty() ? fmt::format("column {}", column.number) : shown(column.heading);
    return fmt::format("{} = {}: expected a finite number", name, cell.text.empty() ? "(nothing)" : shown(cell.text));
  }

  void check_missing() {
    const std::size_t rows = data_.lines.size() + data_.left_out.size();
    if (static_cast<double>(data_.left_out.size()) <= format_.most_missing * static_cast<double>(rows)) return;
    const std::string why = format_.most_missing > 0.0
                                ? fmt::format("; {} of {} rows have none, and no more than {:g} % may be left out",
                                              data_.left_out.size(), rows, 100.0 * format_.most_missing)
                                : "";
    const std::size_t last = line_;
    for (const MissingCell& cell : missing_) {
      line_ = cell.line;
      if (found_ < k_most_shown_faults) fault(cell.column, cell.message + why);
    }
    line_ = last;
  }

  void check_length() {
    line_ = std::max<std::size_t>(line_, 1);
    if (data_.layout.headings.empty()) {
      fault(1,
            "the file is empty; expected a row of headings, for example displacement[m],force[N], and rows of numbers");
    } else if (data_.lines.empty() && found_ == 0) {
      fault(1, "the file has headings but no data; expected rows of numbers");
    }
  }

  void fault(std::size_t column, std::string message) {
    ++found_;
    faults_.add({origin_, line_, column}, std::move(message));
  }

  struct MissingCell {
    std::size_t line;
    std::size_t column;
    std::string message;
  };

  const std::string& origin_;
  const std::vector<ColumnRequest>& wanted_;
  const TableFormat& format_;
  FaultList& faults_;
  MeasuredData data_;
  std::vector<MissingCell> missing_;  ///< the first ones
  std::size_t line_ = 0;
  std::size_t found_ = 0;
};

}  // namespace

MeasuredData parse_measured(std::string_view bytes, const std::string& origin, const std::vector<ColumnRequest>& wanted,
                            FaultList& faults, const TableFormat& format) {
  if (format.separator || format.decimal) {
    FaultList as_given;
    MeasuredData data = DataParser(origin, wanted, format, as_given).parse(bytes);
    if (as_given.size() == 0) return data;
    TableFormat open = format;
    open.separator.reset();
    open.decimal.reset();
    FaultList as_found;
    data = DataParser(origin, wanted, open, as_found).parse(bytes);
    if (as_found.size() == 0) {
      const std::string_view separator = separator_word(data.layout.separator);
      const char* given = !format.decimal ? "separator" : format.separator ? "separator and decimal" : "decimal";
      faults.add(
          {origin, data.layout.first_line, 1},
          fmt::format("the table cannot be read with the given {2}; it has {0} between the cells and the decimal "
                      "sign '{1}': expected separator = \"{0}\" and decimal = \"{1}\", or neither key",
                      separator, data.layout.decimal, given));
      return data;
    }
  }
  return DataParser(origin, wanted, format, faults).parse(bytes);
}

}  // namespace monograin
