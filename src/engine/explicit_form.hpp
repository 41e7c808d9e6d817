/// The explicit form of a system as integrators of ordinary differential equations see it: differential unknowns and
/// quadratures only.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "engine/integrator.hpp"

namespace monograin {

/// Share of a curve's tolerance that a step may take. Work and radius only ever grow, so the errors of the steps have
/// one sign and add up; a tenth keeps the curve's error within a few rtol over some hundred steps.
inline constexpr double k_usual_share = 0.1;
/// Share for methods whose global error exceeds the local one by more (variable order): keeps it within some ten rtol.
inline constexpr double k_share_of_many = 0.01;

/// What is tolerated of one step. Finer than that of an rtol of 1e-13, round-off keeps a corrector from converging.
[[nodiscard]] inline Tolerances of_step(const Tolerances& of_curve, double share = k_usual_share) noexcept {
  constexpr double k_finest = 1e-13;
  return {.rtol = share * std::max(of_curve.rtol, k_finest), .atol = std::max(of_curve.atol, share * k_finest)};
}
/// How near to zero a guard counts as fired together with another, where both carry an integrator's error.
[[nodiscard]] inline double guard_tolerance_of(const Tolerances& tolerances) noexcept { return 1e-2 * tolerances.rtol; }

[[nodiscard]] inline bool all_finite(std::span<const double> values) noexcept {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

/// A difference quotient's increment: made smaller until `shift` finds the equations there. Where they end nearer than
/// it reaches, a regime is as short, and its own scale so much smaller.
/// @return the increment that was taken
/// @throws std::domain_error where the equations have no state as near as that
template <class Shift>
double shift_within_domain(double increment, Shift&& shift) {
  constexpr double k_nearer = 1e-2;
  constexpr int k_most_nearer = 8;
  for (int nearer = 0;; ++nearer, increment *= k_nearer) {
    try {
      shift(increment);
      return increment;
    } catch (const std::domain_error&) {
      if (nearer == k_most_nearer) throw;
    }
  }
}

/// Largest change of rates beside the largest of them.
/// @param scale_of  of an unknown, by its place
template <class ScaleOf>
double change_of_rates(std::span<const double> before, std::span<const double> after, ScaleOf&& scale_of) {
  double largest = 0.0;
  double change = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    largest = std::max(largest, std::abs(before[i]) / scale_of(i));
    change = std::max(change, std::abs(after[i] - before[i]) / scale_of(i));
  }
  return change > 0.0 ? change / largest : 0.0;
}
/// Rates that change by more over a difference quotient's increment may jump within it, where a contact opens or is no
/// longer taken along. Then the side counts on which they change less.
inline constexpr double k_jump = 1e-2;

/// Quadratures counted anew from every segment's start: their relative tolerance then refers to the segment's own
/// share, and a hundred cycles of loading and unloading do not wear the total away.
class SegmentQuadratures {
 public:
  explicit SegmentQuadratures(std::span<const Unknown> unknowns) : offsets_(unknowns.size(), 0.0) {
    for (std::size_t k = 0; k < unknowns.size(); ++k) {
      if (unknowns[k].kind == Unknown::Kind::quadrature) places_.push_back(k);
    }
  }
  /// Takes the quadratures out of a segment's first state.
  void begin(std::span<double> y) {
    for (const std::size_t k : places_) offsets_[k] = std::exchange(y[k], 0.0);
  }
  void add_to(std::span<double> y) const {
    for (const std::size_t k : places_) y[k] += offsets_[k];
  }

 private:
  std::vector<std::size_t> places_;
  std::vector<double> offsets_;
};

class ExplicitForm {
 public:
  explicit ExplicitForm(HybridSystem& system)
      : system_(system),
        quadratures_(system.unknowns()),
        complete_(system.unknowns().size()),
        trial_(system.unknowns().size()) {
    size_ = static_cast<std::size_t>(std::ranges::count_if(
        system.unknowns(), [](const Unknown& unknown) { return unknown.kind != Unknown::Kind::algebraic; }));
  }

  /// Number of unknowns that are integrated: the first ones of the system.
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] const Unknown& unknown(std::size_t k) const noexcept { return system_.unknowns()[k]; }

  [[nodiscard]] bool has_dependent_unknowns() const noexcept { return system_.has_dependent_unknowns(); }
  [[nodiscard]] bool has_corrections() const noexcept { return system_.has_corrections(); }

  /// Takes up a segment's first complete state; the integrated part of it goes to `integrated`.
  void begin(std::span<const double> complete, std::span<double> integrated) {
    std::ranges::copy(complete, complete_.begin());
    std::ranges::copy(complete.first(size_), integrated.begin());
    quadratures_.begin(integrated);
  }

  /// Takes over what completing has moved by more than rounding. @return whether that is anything
  [[nodiscard]] bool take_correction(std::span<const double> complete, std::span<double> integrated) const {
    constexpr double k_rounding = 4.0 * std::numeric_limits<double>::epsilon();
    bool is_moved = false;
    for (std::size_t k = 0; k < size_; ++k) {
      if (unknown(k).kind != Unknown::Kind::differential) continue;
      if (std::abs(integrated[k] - complete[k]) <= k_rounding * std::abs(complete[k])) continue;
      integrated[k] = complete[k];
      is_moved = true;
    }
    return is_moved;
  }

  /// What the next complete state is sought from.
  void guess(std::span<const double> complete) { std::ranges::copy(complete, complete_.begin()); }
  [[nodiscard]] std::span<const double> guess() const noexcept { return complete_; }

  /// The complete state of an integrated one; valid until the next call of this object. Where there is none, the last
  /// one stays the first guess: what a failed search has left behind would lead astray from a smaller step too.
  [[nodiscard]] std::span<const double> complete(double xi, std::span<const double> integrated) {
    complete(xi, integrated, trial_);
    std::swap(complete_, trial_);
    return complete_;
  }

  /// The same for a state that is only looked at: what was last completed stays the first guess.
  void complete(double xi, std::span<const double> integrated, std::span<double> complete) {
    std::ranges::copy(complete_, complete.begin());
    std::ranges::copy(integrated, complete.begin());
    quadratures_.add_to(complete);
    system_.complete(xi, complete);
  }

  /// @param rates  as many as there are integrated unknowns
  /// @throws std::domain_error where the equations end
  void rates(double xi, std::span<const double> integrated, std::span<double> rates) {
    system_.rates(xi, complete(xi, integrated), rates);
  }

 private:
  HybridSystem& system_;
  SegmentQuadratures quadratures_;
  std::vector<double> complete_, trial_;
  std::size_t size_ = 0;
};

}  // namespace monograin
