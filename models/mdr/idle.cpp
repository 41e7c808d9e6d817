#include "mdr/idle.hpp"

#include <algorithm>
#include <cmath>

#include "elastic/hertz.hpp"
#include "system/resolution.hpp"

namespace monograin::mdr {
namespace {

/// True if an overlap is below the resolution; cheaper than comparing it with resolution().
bool is_below_resolution(const Particle& p, double overlap) {
  return overlap < k_resolution || hertz_force(p.law().material.composite_modulus, 1.0, overlap) < p.force_round_off();
}

}  // namespace

double resolution(const Particle& p) {
  return std::max(k_resolution, hertz_overlap(p.law().material.composite_modulus, 1.0, p.force_round_off()));
}

bool is_idle(const Particle& p, std::size_t i) {
  if (!p.centre().acts(i) || p.is_force_controlled(i)) return false;
  const ContactBranch& branch = p.branch(i);
  const bool may_be_idle = branch.regime == Regime::elastic ? branch.is_on_primary_branch || !p.law().adheres()
                                                            : branch.regime == Regime::unloading && !p.law().adheres();
  return may_be_idle && is_below_resolution(p, p.contact(i).overlap - branch.touching_overlap(p.law(), p.at().growth));
}

}  // namespace monograin::mdr
