#include "history/partnership.hpp"

namespace monograin {

Partnership::Partnership(const Table& history, const Segments& base, const Table& events, const NeighbourPair& pair,
                         const Variant* centre)
    : history_(history), events_(events), base_(base), pair_(pair), centre_(centre) {
  std::vector<const Variant*> others{&pair.lower, &pair.upper};
  if (centre != nullptr) others.push_back(centre);
  same_events_ = events.row_count();
  for (const Variant* other : others) same_events_ = std::min(same_events_, same_events(events, other->record.events));
  const double end = same_events_ < events.row_count() ? events.at(same_events_, k_time_column) : k_infinity;
  const auto& corners = base.corners();
  const auto has_corner = [&](const Variant* other) {
    if (corners_ >= other->segments.corners().size()) return false;
    const Corner& of_other = other->segments.corners()[corners_];
    return other->segments.side(of_other.front()) == base.side(corners[corners_].front()) &&
           other->segments.side(of_other.back()) == base.side(corners[corners_].back());
  };
  while (corners_ < corners.size() && base.time(corners[corners_].front()) < end &&
         std::ranges::all_of(others, has_corner)) {
    ++corners_;
  }
  find_partners();
}

std::optional<Triple> Partnership::at_row(std::size_t row, std::size_t column) const {
  const auto& [lower, centre, upper] = partners_[row];
  if (!lower || !centre || !upper) return std::nullopt;
  const Table& of_centre = centre_ != nullptr ? centre_->record.history : history_;
  return Triple{pair_.lower.record.history.at(*lower, column), of_centre.at(*centre, column),
                pair_.upper.record.history.at(*upper, column)};
}

std::optional<Triple> Partnership::at_event(std::size_t row, std::size_t column) const {
  if (row >= same_events_) return std::nullopt;
  const Table& of_centre = centre_ != nullptr ? centre_->record.events : events_;
  return Triple{pair_.lower.record.events.at(row, column), of_centre.at(row, column),
                pair_.upper.record.events.at(row, column)};
}

void Partnership::find_partners() {
  const auto& corners = base_.corners();
  std::vector<std::size_t> corner_of_row(history_.row_count(), corners.size());
  std::size_t begun = 0;  // last segment that begins at a corner of all runs
  for (std::size_t corner = 0; corner < corners.size(); ++corner) {
    for (const std::size_t row : corners[corner]) {
      corner_of_row[row] = corner;
      // An output row at the instant of a corner follows the row just before the event.
      const bool is_shared = base_.side(row) == RowSide::before && row + 1 < history_.row_count() &&
                             base_.side(row + 1) == RowSide::output && base_.time(row + 1) == base_.time(row);
      if (is_shared) corner_of_row[row + 1] = corner;
    }
    if (corner < corners_ && base_.side(corners[corner].back()) == RowSide::after) begun = corner + 1;
  }
  for (std::size_t row = 0; row < history_.row_count(); ++row) {
    partners_.push_back(base_.segment(row) > begun ? Partners() : partners_of(row, corner_of_row[row]));
  }
}

Partnership::Partners Partnership::partners_of(std::size_t row, std::size_t corner) const {
  if (corner < corners_) {
    const auto count = [corner](const Segments& run) { return run.corners()[corner].size(); };
    const auto is_alike = [&](const Variant& other) { return count(other.segments) == count(base_); };
    const bool are_alike = is_alike(pair_.lower) && is_alike(pair_.upper) && (centre_ == nullptr || is_alike(*centre_));
    return {partner_in(pair_.lower, row, corner, are_alike),
            centre_ != nullptr ? partner_in(*centre_, row, corner, are_alike) : row,
            partner_in(pair_.upper, row, corner, are_alike)};
  }
  if (corner < base_.corners().size()) return {};
  const auto row_in = [&](const Variant& other) { return other.segments.row_at(base_.time(row), base_.segment(row)); };
  return {row_in(pair_.lower), centre_ != nullptr ? row_in(*centre_) : row, row_in(pair_.upper)};
}

std::size_t Partnership::partner_in(const Variant& other, std::size_t row, std::size_t corner, bool are_alike) const {
  const Corner& here = base_.corners()[corner];
  const Corner& there = other.segments.corners()[corner];
  if (!are_alike) return base_.side(row) == RowSide::after ? there.back() : there.front();
  const auto place = std::ranges::upper_bound(here, row) - here.begin();
  return there[static_cast<std::size_t>(place) - 1];
}

}  // namespace monograin
