/// The explicit form of a system as integrators of ordinary differential equations see it: differential unknowns and
/// quadratures only.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "engine/integrator.hpp"
#include "system/resolution.hpp"

namespace monograin {

/// Share of a curve's tolerance that one step may use. Work and radius only grow, so the errors of steps have one sign
/// and add up; a tenth keeps the curve's error within a few rtol over some hundred steps.
inline constexpr double k_usual_share = 0.1;
/// Share for methods whose global error exceeds the local one by more (variable order): keeps it within some ten rtol.
inline constexpr double k_share_of_many = 0.01;

/// Tolerances of one step. Below those for a curve with rtol = 1e-13, round-off keeps a corrector from converging.
[[nodiscard]] inline Tolerances of_step(const Tolerances& of_curve, double share = k_usual_share) noexcept {
  constexpr double k_finest = 1e-13;
  return {.rtol = share * std::max(of_curve.rtol, k_finest), .atol = std::max(of_curve.atol, share * k_finest)};
}
/// Largest distance from zero at which a guard fires together with another, if both carry an integrator's error.
[[nodiscard]] inline double guard_tolerance_of(const Tolerances& tolerances) noexcept { return 1e-2 * tolerances.rtol; }

[[nodiscard]] inline bool all_finite(std::span<const double> values) noexcept {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

/// Finds an increment for a difference quotient: makes it smaller until `shift` stays within the domain of the
/// equations. If the domain ends nearer than the increment, the regime is that short, and so is its own scale.
/// @param shift  evaluates the equations beside the point; throws std::domain_error outside of their domain
/// @return the increment with which `shift` succeeded
/// @throws std::domain_error if `shift` fails even with 1e-16 times the increment
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

/// Largest change of a rate over the largest rate before, each over its unknown's scale.
/// @param scale_of  gives the scale of an unknown from its index
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
/// Largest change_of_rates() over the increment of a difference quotient. Rates that change by more may jump within it,
/// as where a contact opens; the quotient is then taken on the side where they change less.
inline constexpr double k_jump = 1e-2;

/// Counts quadratures from zero in every segment. Their relative tolerance then refers to the segment's own share, and
/// their errors stay small over a hundred cycles of loading and unloading.
class SegmentQuadratures {
 public:
  explicit SegmentQuadratures(std::span<const Unknown> unknowns) : offsets_(unknowns.size(), 0.0) {
    for (std::size_t k = 0; k < unknowns.size(); ++k) {
      if (unknowns[k].kind == Unknown::Kind::quadrature) places_.push_back(k);
    }
  }
  /// Keeps the quadratures of a segment's first state as offsets, and sets them to zero in y.
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

/// Completes integrated states and gives their rates; keeps the last complete state as the first guess of the next one.
class ExplicitForm {
 public:
  explicit ExplicitForm(Equations& system)
      : system_(system),
        quadratures_(system.unknowns()),
        complete_(system.unknowns().size()),
        trial_(system.unknowns().size()) {
    size_ = static_cast<std::size_t>(std::ranges::count_if(
        system.unknowns(), [](const Unknown& unknown) { return unknown.kind != Unknown::Kind::algebraic; }));
  }

  /// Number of unknowns that are integrated: the first ones of the system.
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] std::span<const Unknown> unknowns() const noexcept { return system_.unknowns(); }
  [[nodiscard]] const Unknown& unknown(std::size_t k) const noexcept { return unknowns()[k]; }

  [[nodiscard]] bool has_dependent_unknowns() const noexcept { return system_.has_dependent_unknowns(); }
  [[nodiscard]] bool has_corrections() const noexcept { return system_.has_corrections(); }

  /// Starts a segment at a complete state and puts the integrated part of that state into `integrated`.
  void begin(std::span<const double> complete, std::span<double> integrated) {
    std::ranges::copy(complete, complete_.begin());
    std::ranges::copy(complete.first(size_), integrated.begin());
    quadratures_.begin(integrated);
  }

  /// Copies to `integrated` the differential unknowns that completing has moved by more than round-off.
  /// @return true if there are any
  [[nodiscard]] bool take_correction(std::span<const double> complete, std::span<double> integrated) const {
    bool is_moved = false;
    for (std::size_t k = 0; k < size_; ++k) {
      if (unknown(k).kind != Unknown::Kind::differential) continue;
      if (std::abs(integrated[k] - complete[k]) <= k_round_off * std::abs(complete[k])) continue;
      integrated[k] = complete[k];
      is_moved = true;
    }
    return is_moved;
  }

  /// Sets the first guess of the next complete state.
  void guess(std::span<const double> complete) { std::ranges::copy(complete, complete_.begin()); }
  [[nodiscard]] std::span<const double> guess() const noexcept { return complete_; }

  /// Completes an integrated state; the result is valid until the next call of this object, and is the next first
  /// guess. If completing throws, the last complete state stays the first guess: the remains of a failed search would
  /// mislead the next, shorter step as well.
  [[nodiscard]] std::span<const double> complete(double xi, std::span<const double> integrated) {
    complete(xi, integrated, trial_);
    std::swap(complete_, trial_);
    return complete_;
  }

  /// Completes an integrated state without changing the first guess, as for a row of output.
  void complete(double xi, std::span<const double> integrated, std::span<double> complete) {
    std::ranges::copy(complete_, complete.begin());
    std::ranges::copy(integrated, complete.begin());
    quadratures_.add_to(complete);
    system_.complete(xi, complete);
  }

  /// Completes an integrated state and gives d/dxi of the integrated unknowns.
  /// @throws std::domain_error where the equations end
  void rates(double xi, std::span<const double> integrated, std::span<double> rates) {
    system_.rates(xi, complete(xi, integrated), rates);
  }

  /// Does what rates() does without changing the first guess.
  void rates_aside(double xi, std::span<const double> integrated, std::span<double> rates) {
    complete(xi, integrated, trial_);
    system_.rates(xi, trial_, rates);
  }

 private:
  Equations& system_;
  SegmentQuadratures quadratures_;
  std::vector<double> complete_, trial_;
  std::size_t size_ = 0;
};

}  // namespace monograin
