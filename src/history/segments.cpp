#include "history/segments.hpp"

#include <algorithm>

#include "system/resolution.hpp"

namespace monograin {

RowSide side_of(const Table& history, std::size_t row) {
  return static_cast<RowSide>(static_cast<int>(history.at(row, k_side_column)));
}

Segments::Segments(const Table& history) : history_(history) {
  const double slack = k_same_instant * duration();
  std::size_t segment = 0;
  for (std::size_t row = 0; row < history.row_count(); ++row) {
    if (side(row) != RowSide::output) {
      const bool is_same = !corners_.empty() && time(row) - time(corners_.back().front()) <= slack;
      if (!is_same) corners_.emplace_back();
      corners_.back().push_back(row);
      if (side(row) == RowSide::after) segment = corners_.size();
    }
    of_row_.push_back(segment);
  }
}

std::optional<std::size_t> Segments::row_at(double instant, std::size_t segment) const {
  const double slack = k_same_instant * duration();
  std::size_t low = 0;
  std::size_t high = of_row_.size();
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    (time(middle) < instant - slack ? low : high) = time(middle) < instant - slack ? middle + 1 : middle;
  }
  for (std::size_t row = low; row < of_row_.size() && time(row) <= instant + slack; ++row) {
    if (side(row) == RowSide::output && of_row_[row] == segment) return row;
  }
  return std::nullopt;
}

std::vector<double> Segments::output_instants(const std::function<bool(std::size_t row)>& is_wanted) const {
  std::vector<double> instants;
  for (std::size_t row = 0; row < history_.row_count(); ++row) {
    const bool is_new = time(row) > (instants.empty() ? 0.0 : instants.back());
    if (side(row) == RowSide::output && is_new && is_wanted(row)) instants.push_back(time(row));
  }
  if (instants.empty()) instants.push_back(duration());
  return instants;
}

std::size_t same_events(const Table& one, const Table& other) {
  const std::size_t event = *one.find("event");
  const std::size_t of_class = *one.find("class");
  std::size_t row = 0;
  for (; row < std::min(one.row_count(), other.row_count()); ++row) {
    if (one.word(row, event) != other.word(row, event) || one.word(row, of_class) != other.word(row, of_class)) break;
  }
  return row;
}

}  // namespace monograin
