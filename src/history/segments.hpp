/// Decomposition of a history into the segments between its events and ends of steps.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "engine/drive.hpp"
#include "history/table.hpp"

namespace monograin {

/// Columns with which every history begins.
inline constexpr std::size_t k_time_column = 0;
inline constexpr std::size_t k_step_column = 1;
inline constexpr std::size_t k_side_column = 2;

[[nodiscard]] RowSide side_of(const Table& history, std::size_t row);

/// Rows of a history just before and just after all events at one instant; the end of a step is an event, too. Events
/// at one instant may have rows of their own, or share them. Never empty.
using Corner = std::vector<std::size_t>;

/// Segments of a history between its corners. The history has to outlive them.
class Segments {
 public:
  explicit Segments(const Table& history);

  [[nodiscard]] double time(std::size_t row) const { return history_.at(row, k_time_column); }
  [[nodiscard]] RowSide side(std::size_t row) const { return side_of(history_, row); }
  [[nodiscard]] std::size_t segment(std::size_t row) const { return of_row_[row]; }
  [[nodiscard]] const std::vector<Corner>& corners() const noexcept { return corners_; }
  [[nodiscard]] double duration() const { return history_.row_count() == 0 ? 0.0 : time(history_.row_count() - 1); }

  /// Output row of a segment at an instant [s]; none if the segment has no such row.
  [[nodiscard]] std::optional<std::size_t> row_at(double instant, std::size_t segment) const;

  /// Instants of the output rows that a predicate takes [s], ascending, without t = 0. The end if there are none: a run
  /// without instants writes every step of its integrator.
  [[nodiscard]] std::vector<double> output_instants(const std::function<bool(std::size_t row)>& is_wanted =
                                                        [](std::size_t) { return true; }) const;

 private:
  const Table& history_;
  std::vector<std::size_t> of_row_;
  std::vector<Corner> corners_;
};

/// Number of leading events that two runs have in common, in equal order.
[[nodiscard]] std::size_t same_events(const Table& one, const Table& other);

}  // namespace monograin
