#include "semimech/wall_law.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <string>
#include <utility>

#include "system/number_text.hpp"
#include "system/resolution.hpp"

namespace monograin::semimech {
namespace {

// gamma/2R from which on the axial force is within 17 % of finite elements of E/Y = 100 to 200.
constexpr double k_least_trusted = 0.03;

/// Warning of a run that stays below k_least_trusted: the force against finite elements (at gamma/2R = 0.02 and 0.005;
/// plots/fe: lambda = 123.41 between two walls, E/Y = 200 in a die, E/Y = 50 under hydrostatic compression), and D1^2
/// over the range of lambda to which the source fitted the law.
std::string early_stiffness_warning(Configuration configuration) {
  struct Excess {
    const char *over_finite_elements, *over_hertz;
  };
  // In the order of Configuration.
  constexpr std::array<Excess, 3> k_excess{
      {{"19 to 55", "2.20 to 3.06"}, {"27 to 66", "2.30 to 3.21"}, {"35 to 78", "2.57 to 3.58"}}};
  const Excess& excess = k_excess[static_cast<std::size_t>(configuration)];
  return "the whole run lies where the law is too stiff: below displacement/R0 = 0.03 its force (" +
         std::string(name(configuration)) + ") is " + excess.over_finite_elements +
         " % above finite elements, and in the elastic regime " + excess.over_hertz +
         " times that of Hertz over the fitted materials";
}

}  // namespace

WallLaw::WallLaw(const Law& law, const plastic::Settings& settings, std::vector<OutOfRange> out_of_range)
    : Base(law, settings), out_of_range_(std::move(out_of_range)) {
  if (law.configuration != Configuration::die) return;
  lateral_law_ = make_lateral(law);
  lateral_boundaries_ = boundaries(law, *lateral_law_);
}

const Boundary* WallLaw::lateral_ahead(const Branch& b) const {
  if (b.next_lateral == lateral_boundaries_.size()) return nullptr;
  const Boundary& lateral = lateral_boundaries_[b.next_lateral];
  return lateral.approach < Base::next(b).position ? &lateral : nullptr;
}

contacts::Boundary WallLaw::next(const Branch& b) const {
  const Boundary* lateral = lateral_ahead(b);
  return lateral != nullptr ? contacts::Boundary{lateral->approach, lateral->event, {}, true} : Base::next(b);
}

void WallLaw::pass(Branch& b) const {
  if (lateral_ahead(b) != nullptr)
    ++b.next_lateral;
  else
    Base::pass(b);
}

/// The lateral contacts follow the axial contacts until those unload from a plastic state; then there is no law.
contacts::VisibleContact WallLaw::follower(const Branch& leader, bool touches, double x) {
  const Regime regime = leader.is_on_indenter      ? Regime::undefined
                        : !touches                 ? Regime::open
                        : leader.next_lateral == 0 ? Regime::elastic
                                                   : lateral_boundaries_[leader.next_lateral - 1].beyond;
  if (regime == Regime::undefined) return undefined_follower();
  contacts::VisibleContact shown{.regime = static_cast<double>(regime)};
  if (regime == Regime::open) return shown;
  // The overlap is that of an equivalent primary contact.
  const bool is_in_small_range = regime == Regime::elastic || regime == Regime::elastic_plastic;
  if (!is_in_small_range) shown.overlap = k_nan;
  if (!(x > 0.0)) return shown;
  if (is_in_small_range) shown.overlap = lateral_approach(*lateral_law_, x).value;
  const ContactState state = lateral_state_in(law(), *lateral_law_, regime, x);
  shown.force = state.force;
  shown.contact_radius = state.contact_radius;
  shown.pressure = state.pressure;
  return shown;
}

std::vector<Diagnostic> WallLaw::warnings(double walls) const {
  std::vector<Diagnostic> result;
  for (const OutOfRange& out : out_of_range_) {
    result.push_back({std::string(out.quantity) + " is outside " + number_text(out.lower) + " to " +
                          number_text(out.upper) + ", over which the source fitted the law",
                      out.quantity, out.value});
  }
  if (farthest() > 0.0 && farthest() < k_least_trusted) {
    result.push_back({early_stiffness_warning(law().configuration), "largest displacement/R0", farthest()});
  }
  if (lateral_law_ && farthest() > k_least_trusted) {
    result.push_back(
        {"forces of the lateral contacts are 1 to 3 times those of finite elements of E/Y = 200 for axial "
         "displacement/R0 from 0.03 to 0.1",
         "largest displacement/R0", farthest()});
  }
  if (lateral_law_) {
    const double lambda = law().material.modulus_over_yield;
    if (!is_in_fitted_range(lambda, k_least_lateral_modulus_over_yield, k_greatest_lateral_modulus_over_yield)) {
      result.push_back({"outside the range over which the lateral contacts were fitted, 163.08 to 4954.4",
                        "E/((1-nu^2) Y)", lambda});
    }
  }
  std::ranges::move(Base::warnings(walls), std::back_inserter(result));
  return result;
}

}  // namespace monograin::semimech
