/// Rows that belong together in runs with neighbouring values of a number.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "history/run.hpp"
#include "history/segments.hpp"
#include "history/table.hpp"
#include "system/resolution.hpp"

namespace monograin {

/// A run with another value of the key, and its segments.
struct Variant {
  RunRecord record;
  Segments segments;

  explicit Variant(RunRecord made) : record(std::move(made)), segments(record.history) {}
  Variant(const Variant&) = delete;
  Variant& operator=(const Variant&) = delete;
};

/// Values of a column in the run with the lower value of the key, with the key's own value, and with the upper value.
struct Triple {
  double lower = k_nan;
  double centre = k_nan;
  double upper = k_nan;

  [[nodiscard]] double largest() const { return std::max({std::abs(lower), std::abs(centre), std::abs(upper)}); }
  [[nodiscard]] double signed_second_difference() const { return upper + lower - 2.0 * centre; }
  [[nodiscard]] double second_difference() const { return std::abs(signed_second_difference()); }
};

/// Runs with a smaller and a larger value of the key.
struct NeighbourPair {
  Variant lower;
  Variant upper;
  double step = 0.0;  ///< distance of their values from the key's own [SI]
};

/// Rows of the runs beside a run that belong to the rows of its history and of its events.
class Partnership {
 public:
  /// @param centre  run that the pair is compared with; null: the run of the history itself
  Partnership(const Table& history, const Segments& base, const Table& events, const NeighbourPair& pair,
              const Variant* centre);

  /// Values of a column that belong to a row of the history; none if the runs have no such row in common.
  [[nodiscard]] std::optional<Triple> at_row(std::size_t row, std::size_t column) const;

  /// Values of a column of the events at an event, which is compared with this event in the other runs.
  [[nodiscard]] std::optional<Triple> at_event(std::size_t row, std::size_t column) const;

 private:
  /// Rows of the runs that belong to a row of the history: at one corner, or at one instant in one segment.
  struct Partners {
    std::optional<std::size_t> lower, centre, upper;
  };

  void find_partners();
  /// @param corner  index of the corner at which the row is; the number of corners if it is at none
  [[nodiscard]] Partners partners_of(std::size_t row, std::size_t corner) const;
  /// Row of another run at a corner.
  /// @param are_alike  all runs have as many rows there; if not, the first or the last row of the corner counts
  [[nodiscard]] std::size_t partner_in(const Variant& other, std::size_t row, std::size_t corner, bool are_alike) const;

  const Table& history_;
  const Table& events_;
  const Segments& base_;
  const NeighbourPair& pair_;
  const Variant* centre_;
  std::size_t same_events_ = 0;     ///< number of leading events that all runs have in common
  std::size_t corners_ = 0;         ///< number of leading corners that all runs have in common
  std::vector<Partners> partners_;  ///< one for each row of the history
};

}  // namespace monograin
