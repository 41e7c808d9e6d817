#include "packing/controlled_branch.hpp"

#include <algorithm>
#include <numeric>

namespace monograin::packing {
namespace {

// Extent of the ends of a branch that are not integrated: of the closed start, over Phi and over the first half of the
// controlled quantity's range, and of the end, over the whole range. The start is larger for a branch that begins at a
// minimum of the controlled quantity, where Phi goes like the root of an error.
constexpr double k_start = 1e-6;
constexpr double k_start_of_fold = 1e-3;
// Distance of Phi from a pole at which every branch ends: nearer to the pole, strains and rates are round-off.
constexpr double k_margin_of_pole = 1e-7;

Branch range_of(const Law& law, Control control) {
  const double last = law.end < 1.0 ? std::max(law.jamming, law.end - k_margin_of_pole) : 1.0;
  if (control == Control::packing_fraction) {
    return {.measure = Measure::strain, .begin = law.jamming, .end = last, .least = law.jamming, .greatest = last};
  }
  Branch branch = growing_branch(law, control == Control::strain ? Measure::strain : Measure::stress);
  if (branch.end > last) {
    branch.end = std::max(branch.begin, last);
    branch.greatest = measured(law, branch.measure, branch.end);
  }
  return branch;
}

}  // namespace

ControlledBranch::ControlledBranch(const Law& law, Control control)
    : law_(law),
      control_(control),
      range_(range_of(law, control)),
      strain_at_jamming_(state(law, law.jamming).strain),
      end_of_start_(std::min(std::max(law.jamming, range_.begin) * (1.0 + k_start), range_.end)) {
  if (control == Control::packing_fraction) return;
  const double middle = std::midpoint(range_.begin, range_.end);
  const double share = range_.begin > law_.jamming ? k_start_of_fold : k_start;
  const double end = std::lerp(range_.least, value_at(middle), share);
  end_of_start_ = std::max(end_of_start_, packing_fraction_at(end));
}

double ControlledBranch::least_integrated() const noexcept { return law_.jamming * (1.0 + 0.5 * k_start); }

double ControlledBranch::value_at(double packing_fraction) const {
  if (control_ == Control::packing_fraction) return packing_fraction;
  return measured(law_, range_.measure, packing_fraction);
}

double ControlledBranch::value_at_jamming() const noexcept {
  return control_ == Control::strain ? strain_at_jamming_ : law_.jamming;
}

double ControlledBranch::last_value() const noexcept {
  return range_.greatest - k_start * (range_.greatest - range_.least);
}

double ControlledBranch::packing_fraction_at(double value) const {
  if (control_ == Control::packing_fraction) return value;
  return packing::packing_fraction_at(law_, range_, value);
}

double ControlledBranch::growth(const Slopes& slopes) const noexcept {
  if (control_ == Control::packing_fraction) return 1.0;
  return control_ == Control::strain ? slopes.strain : slopes.stress;
}

Limit ControlledBranch::limit() const noexcept {
  if (control_ == Control::strain) return Limit::greatest_strain;
  return control_ == Control::stress ? Limit::greatest_stress : Limit::infinite_stress;
}

DomainEnd ControlledBranch::domain_end() const { return {{"limit"}, {limit(), -1, "greatest value", range_.greatest}}; }

void ControlledBranch::require_state(double value) const {
  if (is_limited() && value > range_.greatest) throw DomainError(limit());
}

void ControlledBranch::end_at_jamming() noexcept {
  range_.begin = range_.end = law_.jamming;
  range_.least = range_.greatest = value_at_jamming();
}

}  // namespace monograin::packing
