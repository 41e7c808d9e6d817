#include "cel/motion.hpp"

#include <algorithm>
#include <cmath>

#include "system/equations.hpp"
#include "system/resolution.hpp"

namespace monograin::cel {
namespace {

/// Next to the beginning of flow, an overlap may be near the resolution. The rate of stabilization is there
/// k_first_stabilization over the distance from the beginning. Times the length of a first step it is below one, so
/// that correctors converge.
constexpr double k_first_stabilization = 0.5;

/// Distance from a fold, without its sign: speed of the walls that touch, over the sum of that and the speed of their
/// contacts; 0 at a fold. Where a force begins, contacts have no stiffness yet, which is no fold.
double distance_from_fold(const Particle& p, std::span<const double> rates) noexcept {
  double speed = 0.0;
  double fastest = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const ClassState& c = p.classes[i];
    if (!c.touches) continue;
    if (c.is_force_controlled() && !(c.contact.F > 0.0)) return 1.0;
    const double u_rate = c.contact.u_by.coordinate * rates[i];
    speed = std::max(speed, std::abs(c.is_force_controlled() ? u_rate : c.drive.rate()));
    fastest = std::max({fastest, std::abs(u_rate), std::abs(c.dent.h_zeta * rates[p.layout().dent(i)])});
  }
  return speed > 0.0 ? speed / (speed + fastest) : 1.0;
}

}  // namespace

double Motion::evaluate(Particle& p, double xi, std::span<const double> y) {
  p.evaluate(y);
  if (xi == xi_ && p.revision() == revision_) return margin_;
  tangent_.set(p, p.any_flows());
  const std::size_t size = p.layout().core();
  right_.setZero(size, 2);
  for (std::size_t i = 0; i < p.size(); ++i) right_(i, 0) = p.classes[i].drive.rate();
  if (p.layout().directions > 0)
    right_.col(0).segment(p.layout().centre(0), p.layout().directions) =
        -p.centre.net_force_rate().head(p.layout().directions);
  p.residual(xi, {right_.col(1).data(), size});
  const double since = xi - flow_begin_;
  // k_ahead bounds the rate in the shortest steps.
  right_.col(1) *=
      -(since > 0.0 ? std::max(k_stabilization, k_first_stabilization / (since + k_ahead)) : k_stabilization);
  const double sign = tangent_.solve(right_, solutions_);

  rates_.assign(solutions_.data(), solutions_.data() + size);
  rates_.push_back(p.flow_rate(rates_));
  drawn_rates_.resize(p.layout().size());
  Eigen::Map<Eigen::VectorXd>(drawn_rates_.data(), size) = solutions_.rowwise().sum();
  p.write_core_rates(drawn_rates_);
  margin_ = sign * distance_from_fold(p, rates_);
  power_ = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const ClassState& c = p.classes[i];
    power_ +=
        c.count * c.contact.F * (c.is_force_controlled() ? tangent_.displacement_rate(i, rates_) : c.drive.rate());
  }
  xi_ = xi;
  revision_ = p.revision();
  return margin_;
}

}  // namespace monograin::cel
