#include "scenario/measured_data.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scenario/cells.hpp"
#include "scenario/words.hpp"

namespace monograin {
namespace {

/// Where the unit's bracket opens; npos where there is none.
std::size_t bracket_in(std::string_view heading) noexcept {
  const std::size_t bracket = heading.rfind('[');
  const bool is_unit = bracket != std::string_view::npos && bracket > 0 && heading.ends_with(']');
  return is_unit ? bracket : std::string_view::npos;
}

class DataParser {
 public:
  DataParser(const std::string& origin, const std::vector<ColumnRequest>& wanted, FaultList& faults)
      : origin_(origin), wanted_(wanted), faults_(faults) {
    data_.columns.resize(wanted.size());
  }

  MeasuredData parse(std::string_view text) {
    data_.text = text;
    std::string_view rest = without_byte_order_mark(text);
    while (!rest.empty() && found_ < k_most_table_faults) {
      ++line_;
      const std::string_view line = take_line(rest);
      if (is_comment(line)) continue;
      if (headings_.empty()) {
        take_headings(cells_of(line));
      } else {
        take_row(cells_of(line));
      }
    }
    if (found_ >= k_most_table_faults && !rest.empty()) {
      ++line_;
      fault(1, "too many faults above; the rest of the table is not checked");
    }
    line_ = std::max<std::size_t>(line_, 1);
    if (headings_.empty()) {
      fault(1,
            "the file is empty; expected a row of headings, for example displacement[m],force[N], and rows of numbers");
    } else if (data_.lines.empty() && found_ == 0) {
      fault(1, "the file has headings but no data; expected rows of numbers");
    }
    return std::move(data_);
  }

 private:
  void take_headings(const std::vector<Cell>& cells) {
    for (const Cell& cell : cells) headings_.push_back(cell.text);
    for (const Cell& cell : cells) {
      if (number_in(cell.text)) {
        return fault(cell.column, "a number where a row of headings is expected, for example displacement[m],force[N]");
      }
    }
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const auto before = headings_.begin() + static_cast<std::ptrdiff_t>(k);
      if (std::find(headings_.begin(), before, cells[k].text) != before) {
        fault(cells[k].column, fmt::format("two columns are called '{}'", shown(cells[k].text)));
      }
    }
    for (const ColumnRequest& request : wanted_) places_.push_back(place_of(request));
  }

  /// Which column of the file a request means; the number of columns where it is none.
  std::size_t place_of(const ColumnRequest& request) {
    if (request.name.empty()) return headings_.size();  // its own fault has been reported
    auto found = std::ranges::find(headings_, request.name);
    if (found == headings_.end()) found = std::ranges::find(headings_, request.name, name_in);
    const auto place = static_cast<std::size_t>(found - headings_.begin());
    if (found == headings_.end()) {
      ++found_;
      const std::string hint = did_you_mean(request.name, headings_);
      faults_.add(request.where, fmt::format("{}: {} has no such column; expected one of {}{}", request.naming,
                                             on_one_line(origin_), on_one_line(listed(headings_)), hint));
    } else {
      data_.columns[places_.size()].heading = *found;
    }
    return place;
  }

  void take_row(const std::vector<Cell>& cells) {
    if (cells.size() != headings_.size()) {
      return fault(cells.front().column, fmt::format("{} cell{} where there are {} headings", cells.size(),
                                                     cells.size() == 1 ? "" : "s", headings_.size()));
    }
    for (std::size_t k = 0; k < places_.size(); ++k) {
      if (places_[k] >= cells.size()) continue;
      const Cell& cell = cells[places_[k]];
      const auto value = number_in(cell.text);
      if (!value) {
        fault(cell.column, fmt::format("{} = {}: expected a finite number", shown(headings_[places_[k]]),
                                       cell.text.empty() ? "(nothing)" : shown(cell.text)));
      }
      data_.columns[k].values.push_back(value.value_or(0.0));
      data_.columns[k].at.push_back(cell.column);
    }
    data_.lines.push_back(line_);
  }

  void fault(std::size_t column, std::string message) {
    ++found_;
    faults_.add({origin_, line_, column}, std::move(message));
  }

  const std::string& origin_;
  const std::vector<ColumnRequest>& wanted_;
  FaultList& faults_;
  MeasuredData data_;
  std::vector<std::string_view> headings_;
  std::vector<std::size_t> places_;  ///< of the columns that are wanted
  std::size_t line_ = 0;
  std::size_t found_ = 0;
};

}  // namespace

MeasuredData parse_measured(std::string_view text, const std::string& origin, const std::vector<ColumnRequest>& wanted,
                            FaultList& faults) {
  return DataParser(origin, wanted, faults).parse(text);
}

std::string_view unit_in(std::string_view heading) noexcept {
  const std::size_t bracket = bracket_in(heading);
  if (bracket == std::string_view::npos) return {};
  return heading.substr(bracket + 1, heading.size() - bracket - 2);
}

std::string_view name_in(std::string_view heading) noexcept { return heading.substr(0, bracket_in(heading)); }

}  // namespace monograin
