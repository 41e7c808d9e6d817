/// Derivatives of a history as differences of runs with neighbouring values of a number.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "history/partnership.hpp"

namespace monograin {

/// Largest magnitude of a value that rows have. @param value  row -> value
template <class Value>
[[nodiscard]] double largest_of(std::size_t rows, Value&& value) {
  double largest = 0.0;
  for (std::size_t row = 0; row < rows; ++row) largest = std::fmax(largest, std::abs(value(row)));
  return largest;
}

/// Magnitudes of a column of the history.
struct Magnitudes {
  double value = 0.0;
  double derivative = 0.0;
};

/// A derivative and its absolute errors.
struct Quotient {
  double value = k_nan;
  double truncation = 0.0;
  double round_off = 0.0;

  [[nodiscard]] double error() const noexcept { return truncation + round_off; }
};

/// Derivatives of history and events with respect to one key, as central differences. Near an event that moves with the
/// key, curves may be a power of the distance from it, as next to a square root: their truncation is computed and
/// removed. Rows where the runs show that truncation still exceeds what round-off allows get their derivatives from a
/// second pair of runs, which writes no other rows.
class Differences {
 public:
  using RunPair = std::function<std::unique_ptr<NeighbourPair>(double step, const std::vector<double>& instants)>;

  /// @param columns  of the history, that have derivatives
  /// @param noise    relative error of the computed values, over the largest one of the column
  /// @param share    step of the first pair, over the value
  /// @param value    of the key
  /// @param centre   run that the pairs are compared with; null: the run of the history itself
  Differences(const Table& history, const Segments& base, const Table& events, std::span<const std::size_t> columns,
              double noise, double share, double value, const Variant* centre);

  /// Makes the pairs of runs. @return false if one of the key's values is not admissible
  bool make_pairs(const RunPair& run_pair, bool may_refine);

  [[nodiscard]] double step() const noexcept { return share_ * value_; }

  [[nodiscard]] double at_row(std::size_t row, std::size_t column) const { return in_row(row, column).value; }
  /// @param column  of the events
  [[nodiscard]] double at_event(std::size_t row, std::size_t column) const;
  /// Largest estimated error of a column over its largest derivative.
  [[nodiscard]] double error() const;
  /// Largest difference of the derivatives on the two sides of a kink, over the largest derivative of the column; 0 if
  /// the curves have no kink at the key's value. Derivatives are the means of the two sides at a kink.
  [[nodiscard]] double kink() const noexcept { return kink_; }

 private:
  /// Distances of the key's value from those for which the beginning and the end of the segment come to the instant of
  /// a row; positive if the key's value is larger, not finite without such a value.
  using Distances = std::array<double, 2>;

  [[nodiscard]] Quotient in_row(std::size_t row, std::size_t column) const;
  bool add_pair(const RunPair& run_pair, double step, const std::vector<double>& instants);
  [[nodiscard]] double largest_derivative(std::size_t column) const;
  /// False if a column does not depend on the number.
  [[nodiscard]] bool depends(std::size_t column) const;
  /// Finds the distances of all rows by the first pair.
  void find_distances();
  /// Finds out whether the curves have a kink at the key's value: the derivatives on its two sides then differ, in many
  /// rows and as much with a smaller step. Next to a singularity they differ in few rows, and in proportion to the
  /// step.
  void find_kink(const RunPair& run_pair);
  /// Largest difference of a column's derivatives on the two sides of the key's value, over the largest derivative. 0
  /// unless at least one output row in ten has a difference above 1 % and its round-off that stays within 30 % in
  /// another pair of runs.
  /// @param other       another pair, which may have fewer rows
  /// @param other_step  its step
  [[nodiscard]] double kink_in(std::size_t column, const Partnership& other, double other_step) const;
  /// Makes a second pair of runs if truncation is too large in some rows. Its step balances the two errors in the worst
  /// of them.
  void refine(const RunPair& run_pair);
  /// Central difference without its truncation next to an event, and its errors. Truncation f''' h^2/6 follows from the
  /// bend f'' h, with
  /// - f''' = f''/p in a smooth curve,
  /// - f''' = (n - 2) f''/x where the bend shows that the curve is a power n of the distance x from an event; this
  ///   truncation is subtracted,
  /// - f''' = 3 f''^2/f', as next to another square root, where the bend exceeds that of a smooth curve. The error is
  ///   f'' h/2 at most: half the difference of the two sides of a kink within the step.
  ///
  /// In a row at an event, a column may be nothing but round-off; its values then differ as much as they are large, and
  /// it has no derivative.
  [[nodiscard]] Quotient quotient(const Triple& of, const Magnitudes& magnitudes, double step, bool is_at_event,
                                  const Distances& distances) const;
  /// The more accurate quotient of the two pairs. Where they differ by more than round-off, their difference is the
  /// truncation of the first one.
  [[nodiscard]] Quotient best(const std::function<std::optional<Triple>(const Partnership&)>& values,
                              const Magnitudes& magnitudes, bool is_at_event, const Distances& distances) const;

  const Table& history_;
  const Segments& base_;
  const Table& events_;
  std::span<const std::size_t> columns_;
  double noise_;
  double share_;
  double value_;
  const Variant* centre_;
  std::vector<Magnitudes> magnitudes_;  ///< of all columns of the history
  std::vector<std::unique_ptr<NeighbourPair>> pairs_;
  std::vector<Partnership> partnerships_;  ///< one for each pair
  std::vector<Distances> distances_;       ///< one for each row; infinite in rows at corners
  double kink_ = 0.0;
};

}  // namespace monograin
