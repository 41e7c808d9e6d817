#include "cel/particle.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

namespace monograin::cel {
namespace {

/// Elastic displacement, over the program's depth, of a contact that may be idle: no integrator is exact enough to
/// show that such a contact bears.
constexpr double k_idle_touch = 1e-8;

}  // namespace

Particle::Particle(const Material& material, double poisson_ratio, std::span<const ContactClass> walls,
                   bool centre_is_free, double depth)
    : centre(walls, centre_is_free),
      material_(material),
      depth_(depth),
      couplings_(couplings_of(poisson_ratio, walls)),
      forces_(walls.size()) {
  std::vector<Eigen::Matrix3d> spreads;
  for (const ContactClass& c : walls) {
    Eigen::Matrix3d& spread = spreads.emplace_back(Eigen::Matrix3d::Zero());
    for (const Eigen::Vector3d& normal : c.normals) spread += normal * normal.transpose();
    const Eigen::Vector3d& normal = c.normals.front();
    ClassState& state = classes.emplace_back();
    state.count = c.multiplicity();
    state.wall = normal * normal.transpose();
    state.spread = spread;
  }
  shapes_ = core_shapes(spreads);
  layout_ = {size(), centre.directions(), shapes_.size()};
  along_.resize(size(), shapes_.size());
  flow_.setZero(shapes_.size());
  for (std::size_t i = 0; i < size(); ++i) {
    for (std::size_t j = 0; j < shapes_.size(); ++j) along_(i, j) = contraction(classes[i].wall, shapes_[j]);
  }
}

Core Particle::core_of(std::span<const double> y) const noexcept {
  Core core{.C = Eigen::Matrix3d::Identity()};
  for (std::size_t j = 0; j < shapes_.size(); ++j) core.C += y[layout_.core() + j] * shapes_[j];
  if (layout_.has_core()) core.e = y[layout_.size() - 1];
  return core;
}

bool Particle::is_at_rest() const noexcept {
  return std::ranges::all_of(classes, [](const ClassState& c) { return c.drive.rate() == 0.0; });
}

double Particle::slack(std::size_t i) const noexcept {
  return (layout_.directions > 0 && classes[i].touches ? k_idle_touch : k_touch) * depth_;
}

void Particle::release_wall(std::size_t i, std::span<double> y) {
  classes[i].is_released = true;
  classes[i].drive = contacts::WallDrive({0.0, 0.0, Control::force}, 1.0);
  y[i] = 0.0;
}

std::optional<std::vector<std::size_t>> Particle::leave_walls(std::span<double> y) {
  if (layout_.directions == 0) return std::nullopt;
  const auto presses = [this](const ClassState& c) { return c.touches && !is_idle(c); };
  if (std::ranges::any_of(classes, presses)) return std::nullopt;
  std::vector<std::size_t> left;
  for (std::size_t i = 0; i < size(); ++i) {
    const ClassState& c = classes[i];
    if ((c.touches || c.contact.F > 0.0) && !c.is_force_controlled() && !(c.drive.rate() > 0.0)) left.push_back(i);
  }
  if (left.empty()) return std::nullopt;
  const double gap = 10.0 * k_idle_touch * depth_;  // a guard cannot find these contacts at once
  Eigen::MatrixXd arms(left.size(), layout_.directions);
  Eigen::VectorXd distances(left.size());
  for (std::size_t k = 0; k < left.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    arms.row(row) = centre.lines().mean_normal(left[k]).head(static_cast<Eigen::Index>(layout_.directions)).transpose();
    distances[row] = -classes[left[k]].contact.u - gap;
  }
  // The displacement of the centre that leaves a gap at all of them, if there is one.
  const Eigen::VectorXd move = arms.completeOrthogonalDecomposition().solve(distances);
  if ((arms * move - distances).lpNorm<Eigen::Infinity>() > 0.5 * gap) return std::nullopt;  // walls on both sides
  for (std::size_t k = 0; k < layout_.directions; ++k) y[layout_.centre(k)] += move[static_cast<Eigen::Index>(k)];
  for (const std::size_t i : left) y[i] = -gap;
  centre.rest_at(layout_.centre_of(y));
  ++revision_;
  std::erase_if(left, [this](std::size_t i) { return !std::exchange(classes[i].touches, false); });
  return left;
}

void Particle::prescribe(double xi, std::span<double> y) const noexcept {
  for (std::size_t i = 0; i < size(); ++i) {
    if (classes[i].is_force_controlled()) y[i] = classes[i].drive.value(xi);
  }
}

void Particle::evaluate(std::span<const double> y, bool with_yield) {
  y = y.first(layout_.size());
  const auto is_in_this_mode = [](const ClassState& c) { return c == c.evaluated_mode; };
  if (!std::ranges::equal(y, y_) || !std::ranges::all_of(classes, is_in_this_mode)) {
    y_.clear();
    ++revision_;
    has_yield_ = false;
    x_ = layout_.centre_of(y);
    evaluate_contacts(y);
    evaluate_displacements();
    for (ClassState& c : classes) c.evaluated_mode = c;
    y_.assign(y.begin(), y.end());
  }
  if (!with_yield || has_yield_) return;
  evaluate_yield(y);
  has_yield_ = true;
}

/// Evaluates dents, coverage and forces.
void Particle::evaluate_contacts(std::span<const double> y) {
  const Eigen::Map<const Eigen::VectorXd> flown(y.data() + layout_.core(), along_.cols());
  double Om = 0.0;
  for (std::size_t i = 0; i < size(); ++i) {
    ClassState& c = classes[i];
    const double excess = along_.row(i).dot(flown);  // l^2 - 1, without the round-off of 1
    const double square = 1.0 + excess;
    const double zeta = y[layout_.dent(i)];
    if (!(square > 0.0) || !(zeta > 0.0)) throw std::domain_error("the core or a dent of the particle has no size");
    c.l = std::sqrt(square);
    c.per_l = 1.0 / c.l;
    if (zeta != c.dent.zeta) c.dent = dent_of(material_, zeta);
    c.advance = advance_of(excess / (1.0 + c.l));
    Om += 0.5 * c.count * (zeta * zeta - material_.a_Y * material_.a_Y) * c.per_l * c.per_l;
  }
  coverage_ = coverage_of(Om);
  for (std::size_t i = 0; i < size(); ++i) {
    ClassState& c = classes[i];
    c.coordinate = y[i];
    c.contact = contact_by(material_, c.dent, c.l, coverage_.m, c.coordinate, c.is_force_controlled());
    forces_[i] = c.contact.F;
  }
}

/// Evaluates displacements by (K), and the stored energy.
void Particle::evaluate_displacements() {
  stored_ = 0.0;
  for (std::size_t i = 0; i < size(); ++i) {
    ClassState& c = classes[i];
    double lift = 0.0;  // sum of G F
    for (std::size_t j = 0; j < size(); ++j) {
      if (forces_[j] != 0.0)
        lift += coupling(i, j).G(c.dent.root_Gam * classes[j].dent.root_Gam, coverage_.shade) * forces_[j];
    }
    c.displacement = c.dent.h + c.advance.c + c.contact.u - lift - approach_by_centre(i);
    stored_ += c.count * (c.contact.stored - 0.5 * c.contact.F * lift);
  }
}

/// Evaluates the load of the core, its flow under that load, and the yield functions.
void Particle::evaluate_yield(std::span<const double> y) {
  if (layout_.has_core()) {
    load_.core = core_of(y);
    load_.pushes.setZero();
    for (const ClassState& c : classes) load_.pushes += c.contact.F * c.phi() * c.spread;
    load_.evaluate(material_.Y);
    for (std::size_t j = 0; j < shapes_.size(); ++j) flow_[j] = contraction(shapes_[j], load_.flow.C);
  }
  for (ClassState& c : classes) {
    c.yield = yield_of(c.contact, load_, c.wall);
    c.flow_by_dent = c.yield.X > 0.0 ? c.count * c.contact.F * (1.0 - c.yield.b) / c.yield.X * c.dent.h_zeta : 0.0;
  }
}

void Particle::choose_balance() {
  centre.choose_balance(forces_);
  ++revision_;
}

void Particle::follow_walls(double xi) {
  if (std::ranges::none_of(classes, &ClassState::is_force_controlled)) return;
  std::vector<std::optional<double>> speeds;
  for (const ClassState& c : classes) {
    const bool leads = c.touches && !is_idle(c) && !c.is_force_controlled();
    speeds.push_back(leads ? std::optional(c.drive.rate()) : std::nullopt);
  }
  centre.follow(xi, speeds);
  ++revision_;
}

void Particle::residual(double xi, std::span<double> residual) const {
  for (std::size_t i = 0; i < size(); ++i) {
    const ClassState& c = classes[i];
    residual[i] = (c.is_force_controlled() ? c.coordinate : c.displacement) - c.drive.value(xi);
    residual[layout_.dent(i)] = c.flows ? -c.yield.f : 0.0;
  }
  if (layout_.directions == 0) return;
  std::copy_n(centre.net_force(xi, x_, forces_).begin(), layout_.directions, &residual[layout_.centre(0)]);
}

double Particle::l_by_flow(std::size_t i) const noexcept { return 0.5 * classes[i].per_l * along_.row(i).dot(flow_); }

double Particle::flow_rate(std::span<const double> dy) const noexcept {
  double Lam = 0.0;
  for (std::size_t i = 0; i < size(); ++i) {
    if (classes[i].flows) Lam += classes[i].flow_by_dent * dy[layout_.dent(i)];
  }
  return Lam;
}

void Particle::write_core_rates(std::span<double> dy) const noexcept {
  if (!layout_.has_core()) return;
  const double Lam = flow_rate(dy);
  for (std::size_t j = 0; j < shapes_.size(); ++j) dy[layout_.core() + j] = Lam * flow_[j];
  dy[layout_.size() - 1] = Lam * load_.flow.e;
}

}  // namespace monograin::cel
