/// Error estimates for steps of Boost.Odeint, and the tolerances with which they are compared.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <vector>

#include "engine/stepper.hpp"
#include "system/resolution.hpp"

namespace monograin {

/// State of zeros. @param size  of a vector; an array keeps its own
template <class State>
[[nodiscard]] State zeros(std::size_t size) {
  if constexpr (std::is_same_v<State, std::vector<double>>)
    return State(size, 0.0);
  else
    return State{};
}

/// Tolerances of the unknowns in a step, no finer than the round-off of xi times the rates. If a contact lasts hardly
/// longer than that round-off, the errors of a step's stages are of its size.
template <class State>
class Tolerated {
 public:
  Tolerated(const ScaledForm& form, const Tolerances& tolerances)
      : size_(form.size()), of_step_(of_step(tolerances)), rates_(zeros<State>(form.size())) {}

  /// Takes the rates of a step's stages in turn; the last rates are those at the step's end.
  void see(const State& rates) noexcept { rates_ = rates; }
  /// Largest error of an unknown over its tolerance.
  template <class Error>
  [[nodiscard]] double share(const State& begin, Error&& error) const noexcept {
    double largest = 0.0;
    for (std::size_t k = 0; k < size_; ++k) {
      const double tolerated =
          std::max(of_step_.atol + of_step_.rtol * std::abs(begin[k]), k_round_off * std::abs(rates_[k]));
      largest = std::max(largest, std::abs(error(k)) / tolerated);
    }
    return largest;
  }

 private:
  std::size_t size_;
  Tolerances of_step_;
  State rates_;
};

/// Error estimate of Fehlberg's method as a quadrature. The method's own estimate is zero for rates that depend on xi
/// alone, and too small if they depend on little else, as just after first touch. For such rates the method is the
/// Newton-Cotes rule with nodes 0, 1/6 ... 1; the estimate compares it with the rule of order 6 on five of these nodes.
template <class State>
class RuleErrors {
 public:
  explicit RuleErrors(std::size_t size) : size_(size), sums_(zeros<State>(size)) {}

  /// Begins a step. @param stage  index of the first stage to come: 1 if the rates at the step's beginning are known
  void begin(std::size_t stage) noexcept {
    stage_ = stage;
    for (std::size_t k = 0; k < size_; ++k) sums_[k] = 0.0;
  }
  /// Takes the rates of the method's stages, in their order.
  void see(const State& rates) noexcept {
    const double weight = k_differences[stage_];
    if (stage_ + 1 < k_differences.size()) ++stage_;
    if (weight == 0.0) return;
    for (std::size_t k = 0; k < size_; ++k) sums_[k] += weight * rates[k];
  }
  /// Error of unknown k, over the length of the step.
  [[nodiscard]] double operator[](std::size_t k) const noexcept { return sums_[k]; }

 private:
  // Differences of the weights of the two rules, by stage.
  static constexpr double k_end = 41.0 / 840.0 - 7.0 / 150.0;
  static constexpr double k_sixth = 9.0 / 35.0 - 27.0 / 100.0;
  static constexpr std::array<double, 13> k_differences{
      0.0,         0.0,         0.0, 0.0,   0.0,  34.0 / 105.0 - 11.0 / 30.0, k_sixth, k_sixth,
      9.0 / 280.0, 9.0 / 280.0, 0.0, k_end, k_end};
  std::size_t size_;
  State sums_;
  std::size_t stage_ = 0;
};

/// Error estimate of the extrapolated midpoint rule. The rule computes every second state from the rates in between,
/// which makes two sequences. The extrapolation uses their mean, and detects only errors that change with the number of
/// substeps. Where rates jump, one sequence may go on as before the jump and the other as after it, however many
/// substeps there are. The estimate is the difference of the sequences, extrapolated as the states are.
template <class State>
class SequenceErrors {
 public:
  explicit SequenceErrors(std::size_t size) : size_(size) { table_.fill(zeros<State>(size)); }

  /// Begins a step. @param rates  at the step's beginning; must outlive the step
  void begin(const State& rates) noexcept {
    first_ = &rates;
    column_ = 0;
    place_ = 0;
  }
  /// Takes the rates at the substeps of the midpoint rule, in their order: 2 of them, then 4, 6 ...
  void see(const State& rates) noexcept {
    if (column_ == k_most) return;
    State& sum = table_[column_];
    const std::size_t places = places_of(column_);
    if (place_ == 0) {
      for (std::size_t k = 0; k < size_; ++k) sum[k] = -(*first_)[k];
    }
    ++place_;
    const double weight = place_ == places ? -1.0 : place_ % 2 == 0 ? -2.0 : 2.0;
    for (std::size_t k = 0; k < size_; ++k) sum[k] += weight * rates[k];
    if (place_ < places) return;
    for (std::size_t k = 0; k < size_; ++k) sum[k] /= static_cast<double>(places);
    for (std::size_t j = column_; j-- > 0;) {
      const double ratio = static_cast<double>(places) / static_cast<double>(places_of(j));
      const double onward = 1.0 / (ratio * ratio - 1.0);
      for (std::size_t k = 0; k < size_; ++k)
        table_[j][k] = table_[j + 1][k] + onward * (table_[j + 1][k] - table_[j][k]);
    }
    ++column_;
    place_ = 0;
  }
  /// Error of unknown k, over the length of the step.
  [[nodiscard]] double operator[](std::size_t k) const noexcept { return table_[0][k]; }

 private:
  static constexpr std::size_t k_most = 9;  // columns of Odeint's extrapolation table
  static constexpr std::size_t places_of(std::size_t column) noexcept { return 2 * (column + 1); }

  std::size_t size_;
  const State* first_ = nullptr;
  std::array<State, k_most> table_;
  std::size_t column_ = 0;
  std::size_t place_ = 0;
};

}  // namespace monograin
