#include "history/differences.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "system/resolution.hpp"

namespace monograin {
namespace {

constexpr std::array<double, 2> k_at_no_distance{k_infinity, k_infinity};  // no event comes to the instant of the row

/// Truncation of a central difference next to a singularity.
struct PowerTruncation {
  double value = 0.0;
  double error = k_infinity;
};

/// Truncation of a curve that is a power n of the distance from an event, if the bend shows one near n = 1/2 or 3/2.
/// @param slope     f', the central difference
/// @param bend      f'' h
/// @param step      h, of the central difference
/// @param distance  x, of the key's value from the one at which the event comes to the row
PowerTruncation truncation_of_power(double slope, double bend, double step, double distance) {
  constexpr double k_least = 0.3;  // |n - 1| of such a curve; that of a smooth one is smaller
  constexpr double k_greatest = 1.0;
  constexpr double k_nearest = 10.0;     // steps from the event; nearer to it, further terms of the series count
  constexpr double k_least_error = 0.1;  // of the truncation, relative
  const double order = distance * bend / (step * slope);  // n - 1
  const bool is_power = std::abs(order) > k_least && std::abs(order) < k_greatest;
  if (!is_power || !(std::abs(distance) > k_nearest * step)) return {};
  const double truncation = step / distance * bend * (order - 1.0) / 6.0;
  return {truncation, std::abs(truncation) * std::max(k_least_error, std::abs(std::abs(order) - 0.5))};
}

}  // namespace

Differences::Differences(const Table& history, const Segments& base, const Table& events,
                         std::span<const std::size_t> columns, double noise, double share, double value,
                         const Variant* centre)
    : history_(history),
      base_(base),
      events_(events),
      columns_(columns),
      noise_(noise),
      share_(share),
      value_(std::abs(value)),
      centre_(centre),
      magnitudes_(history.columns().size()),
      distances_(history.row_count(), k_at_no_distance) {}

bool Differences::make_pairs(const RunPair& run_pair, bool may_refine) {
  if (!add_pair(run_pair, step(), base_.output_instants())) return false;
  find_distances();
  for (const std::size_t column : columns_) {
    magnitudes_[column].value = largest_of(history_.row_count(), [&](std::size_t r) { return history_.at(r, column); });
    magnitudes_[column].derivative = largest_derivative(column);
  }
  find_kink(run_pair);
  if (may_refine && kink_ == 0.0) refine(run_pair);
  return true;
}

Quotient Differences::in_row(std::size_t row, std::size_t column) const {
  return best([&](const Partnership& of) { return of.at_row(row, column); }, magnitudes_[column],
              base_.side(row) != RowSide::output, distances_[row]);
}

double Differences::at_event(std::size_t row, std::size_t column) const {
  const auto in_history = history_.find(events_.columns()[column].name);
  if (!in_history) return k_nan;
  return best([&](const Partnership& of) { return of.at_event(row, column); }, magnitudes_[*in_history], true,
              k_at_no_distance)
      .value;
}

double Differences::error() const {
  double error = 0.0;
  for (const std::size_t column : columns_) {
    if (!depends(column)) continue;
    double largest = 0.0;
    double of_column = 0.0;
    for (std::size_t row = 0; row < history_.row_count(); ++row) {
      const Quotient here = in_row(row, column);
      largest = std::fmax(largest, std::abs(here.value));
      of_column = std::fmax(of_column, here.error());
    }
    error = std::max(error, of_column / largest);
  }
  return error;
}

bool Differences::add_pair(const RunPair& run_pair, double step, const std::vector<double>& instants) {
  std::unique_ptr<NeighbourPair> pair = run_pair(step, instants);
  if (!pair) return false;
  partnerships_.emplace_back(history_, base_, events_, *pair, centre_);
  pairs_.push_back(std::move(pair));
  return true;
}

double Differences::largest_derivative(std::size_t column) const {
  return largest_of(history_.row_count(), [&](std::size_t row) { return at_row(row, column); });
}

bool Differences::depends(std::size_t column) const {
  return magnitudes_[column].derivative > 10.0 * noise_ * magnitudes_[column].value / step();
}

void Differences::find_distances() {
  const auto& corners = base_.corners();
  std::vector<double> shifts(corners.size(), k_nan);  // d(time)/d(key)
  for (std::size_t corner = 0; corner < corners.size(); ++corner) {
    const auto times = partnerships_[0].at_row(corners[corner].front(), k_time_column);
    if (times) shifts[corner] = (times->upper - times->lower) / (2.0 * step());
  }
  for (std::size_t row = 0; row < history_.row_count(); ++row) {
    if (base_.side(row) != RowSide::output) continue;
    const auto distance = [&](std::size_t corner) {
      return (base_.time(corners[corner].front()) - base_.time(row)) / shifts[corner];
    };
    const std::size_t end = base_.segment(row);  // corner at which the segment of the row ends
    if (end > 0) distances_[row][0] = distance(end - 1);
    if (end < corners.size()) distances_[row][1] = distance(end);
  }
}

void Differences::find_kink(const RunPair& run_pair) {
  constexpr double k_smaller = 0.1;       // step at which the sides are compared again, over the first one
  constexpr std::size_t k_compared = 20;  // rows, about, that are compared there
  std::vector<std::size_t> suspected;     // columns
  for (const std::size_t column : columns_) {
    if (depends(column) && kink_in(column, partnerships_[0], step()) > 0.0) suspected.push_back(column);
  }
  if (suspected.empty()) return;
  const std::size_t stride = history_.row_count() / k_compared + 1;
  const auto nearer =
      run_pair(k_smaller * step(), base_.output_instants([&](std::size_t row) { return row % stride == 0; }));
  if (!nearer) return;
  const Partnership of_nearer(history_, base_, events_, *nearer, centre_);
  for (const std::size_t column : suspected) {
    kink_ = std::max(kink_, kink_in(column, of_nearer, k_smaller * step()));
  }
}

double Differences::kink_in(std::size_t column, const Partnership& other, double other_step) const {
  constexpr double k_sharp = 1e-2;     // difference of the sides, over the largest derivative
  constexpr double k_change = 0.3;     // of the difference in the other pair, over that in the first one
  constexpr std::size_t k_least = 10;  // rows, of which one shows the kink
  const auto difference = [&](const Partnership& in, std::size_t row, double step) {
    const auto values = in.at_row(row, column);
    return values ? values->second_difference() / step : k_nan;
  };
  const double least = k_sharp * magnitudes_[column].derivative + noise_ * magnitudes_[column].value / step();
  std::size_t rows = 0;
  std::size_t sharp_rows = 0;
  double largest = 0.0;
  for (std::size_t row = 0; row < history_.row_count(); ++row) {
    if (base_.side(row) != RowSide::output) continue;
    const double first = difference(partnerships_[0], row, step());
    const double here = difference(other, row, other_step);
    if (std::isnan(first) || std::isnan(here)) continue;
    ++rows;
    const bool is_kept = std::abs(here - first) <= k_change * first;
    if (!is_kept || first <= least) continue;
    ++sharp_rows;
    largest = std::max(largest, first);
  }
  return sharp_rows * k_least < rows ? 0.0 : largest / magnitudes_[column].derivative;
}

void Differences::refine(const RunPair& run_pair) {
  constexpr double k_too_large = 1e-7;  // over the largest derivative of the column
  double share = 1.0;
  std::vector<bool> is_coarse(history_.row_count(), false);
  for (const std::size_t column : columns_) {
    if (!depends(column)) continue;
    for (std::size_t row = 0; row < history_.row_count(); ++row) {
      const auto values = partnerships_[0].at_row(row, column);
      if (!values) continue;
      const Quotient of =
          quotient(*values, magnitudes_[column], step(), base_.side(row) != RowSide::output, distances_[row]);
      const double size = magnitudes_[column].derivative;
      if (!(of.truncation > std::max(k_too_large * size, of.round_off))) continue;  // NaN is not coarse
      is_coarse[row] = true;
      share = std::min(share, std::cbrt(of.round_off / of.truncation));
    }
  }
  if (share == 1.0) return;
  const std::vector<double> instants = base_.output_instants([&](std::size_t row) { return is_coarse[row]; });
  add_pair(run_pair, share * step(), instants);
}

Quotient Differences::quotient(const Triple& of, const Magnitudes& magnitudes, double step, bool is_at_event,
                               const Distances& distances) const {
  constexpr double k_as_large = 1e-3;  // second difference that is round-off, over the largest value
  constexpr double k_counts = 1e-6;    // half a bend that matters, over the largest derivative of the column
  constexpr double k_smooth = 5e-5;    // bend of a smooth curve at most, over the largest derivative of the column
  Quotient result{(of.upper - of.lower) / (2.0 * step), 0.0, noise_ * magnitudes.value / step};
  const double size = magnitudes.derivative;
  const double slope = std::abs(result.value);
  const double bend = of.second_difference() / step;
  const bool is_round_off = is_at_event && of.second_difference() > k_as_large * of.largest();
  if (is_round_off && 0.5 * bend > k_counts * size) return {k_nan, 0.0, 0.0};
  result.truncation = step / value_ * bend / 6.0;
  if (kink_ > 0.0) {
    result.truncation = std::max(result.truncation, 0.5 * bend);
  } else {
    PowerTruncation of_power;
    for (const double distance : distances) {
      const PowerTruncation here =
          truncation_of_power(result.value, of.signed_second_difference() / step, step, distance);
      if (here.error < of_power.error) of_power = here;
    }
    result.value -= of_power.value;
    const double elsewhere = bend > k_smooth * size ? 0.5 * bend * std::min(1.0, bend / slope) : k_infinity;
    const double error = std::min(of_power.error, elsewhere);
    if (std::isfinite(error)) result.truncation = std::max(result.truncation, error);
  }
  return result;
}

Quotient Differences::best(const std::function<std::optional<Triple>(const Partnership&)>& values,
                           const Magnitudes& magnitudes, bool is_at_event, const Distances& distances) const {
  std::array<Quotient, 2> of_pairs;
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    if (const std::optional<Triple> of = values(partnerships_[k])) {
      of_pairs[k] = quotient(*of, magnitudes, pairs_[k]->step, is_at_event, distances);
    }
  }
  auto& [coarse, fine] = of_pairs;
  if (std::isnan(coarse.value) || std::isnan(fine.value)) return coarse;
  const double difference = std::abs(fine.value - coarse.value);
  if (difference > coarse.round_off + fine.round_off) {
    coarse.truncation = difference;
    fine.truncation = difference * std::pow(pairs_[1]->step / pairs_[0]->step, 2);
  }
  return fine.error() < coarse.error() ? fine : coarse;
}

}  // namespace monograin
