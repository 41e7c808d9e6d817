/// Controlled quantity of a step, a packing fraction, strain or stress, as a function of the packing fraction.
#pragma once

#include "packing/law.hpp"
#include "system/regimes.hpp"

namespace monograin::packing {

/// Branch of jammed states from jamming on, over which the controlled quantity grows.
class ControlledBranch {
 public:
  ControlledBranch(const Law& law, Control control);

  [[nodiscard]] const Law& law() const noexcept { return law_; }
  [[nodiscard]] Control control() const noexcept { return control_; }
  [[nodiscard]] const Branch& range() const noexcept { return range_; }
  /// True if the branch ends before the packing is full.
  [[nodiscard]] bool is_limited() const noexcept { return range_.end < 1.0; }
  /// Phi up to which the closed form is used at the start, where rates are singular.
  [[nodiscard]] double end_of_start() const noexcept { return end_of_start_; }
  /// Least Phi of an integrated state, in the middle of the closed start.
  [[nodiscard]] double least_integrated() const noexcept;

  [[nodiscard]] double value_at(double packing_fraction) const;
  /// Value at jamming, a packing fraction or a strain.
  [[nodiscard]] double value_at_jamming() const noexcept;
  /// Value at which a run stops short of the end of the branch, where the rates are infinite.
  [[nodiscard]] double last_value() const noexcept;
  [[nodiscard]] double strain_at_jamming() const noexcept { return strain_at_jamming_; }
  /// Phi at a value within the branch.
  [[nodiscard]] double packing_fraction_at(double value) const;

  /// Derivative of the controlled quantity with respect to the packing fraction.
  [[nodiscard]] double growth(const Slopes& slopes) const noexcept;

  [[nodiscard]] Limit limit() const noexcept;
  [[nodiscard]] DomainEnd domain_end() const;
  /// @throws DomainError beyond a greatest strain or stress, where no state exists, although neighbouring states have
  /// finite rates
  void require_state(double value) const;

  /// Ends the branch at jamming. The strain falls at first and never grows back to its value at jamming, or the branch
  /// ends there up to round-off: the packing has no state to move on to.
  void end_at_jamming() noexcept;

 private:
  Law law_;
  Control control_;
  Branch range_;
  double strain_at_jamming_;
  double end_of_start_ = 0.0;
};

}  // namespace monograin::packing
