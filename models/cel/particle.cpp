#include "cel/particle.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "cel/constants.hpp"
#include "elastic/nonlocal_coupling.hpp"
#include "system/limit.hpp"

namespace monograin::cel {
namespace {

namespace k = constants;

/// Sine of half the angle, and last term of the series, of the self influence: part of the law's definition.
constexpr double k_self_half_sine = 0.2;
constexpr int k_last_term = 4000;
constexpr double k_same_angle = 1e-12;
/// Load of the core over Y R0^2 below which it has no direction.
constexpr double k_no_load = 1e-14;

/// Displacement of a free centre (over R0) from which on forces drive it away: only the weak spring holds it there.
constexpr double k_farthest = 10.0;

constexpr int k_most_corrections = 60;
constexpr int k_most_halvings = 40;
constexpr int k_most_polishings = 4;
constexpr double k_most_growth = 0.03;  ///< largest growth of a dent in one correction
/// Smallest dent of a trial, over a_Y: a dent that begins to flow is a_Y to within round-off.
constexpr double k_least_dent = 0.9;
constexpr double k_solved = 1e-10;  ///< residual, over the largest displacement, up to which a state is a solution
/// Residual, over the largest displacement, below which corrections only polish: round-off may make it larger.
constexpr double k_stalled = 1e-14;
constexpr double k_rounding = 4.0 * std::numeric_limits<double>::epsilon();

constexpr Eigen::Index index(std::size_t i) noexcept { return static_cast<Eigen::Index>(i); }

template <int n>
constexpr double raised(double x) noexcept {
  double result = 1.0;
  for (int i = 0; i < n; ++i) result *= x;
  return result;
}

std::vector<Eigen::Matrix3d> spreads_of(std::span<const ContactClass> classes) {
  std::vector<Eigen::Matrix3d> spreads;
  for (const ContactClass& c : classes) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const Eigen::Vector3d& normal : c.normals) sum += normal * normal.transpose();
    spreads.push_back(sum);
  }
  return spreads;
}

}  // namespace

Particle::Particle(const Material& material, double poisson_ratio, std::span<const ContactClass> classes,
                   bool centre_is_free)
    : material_(material),
      shapes_(core_shapes(spreads_of(classes))),
      lines_(classes, centre_is_free),
      layout_(classes.size(), static_cast<std::size_t>(lines_.dimension()), shapes_.size()),
      classes_(classes.size()) {
  const std::vector<Eigen::Matrix3d> spreads = spreads_of(classes);
  flow_components_.setZero(index(shapes_.size()));
  along_.resize(index(size()), index(shapes_.size()));
  // Influences at the angles between walls, each computed once.
  std::map<double, double> influences;
  const auto influence_at = [&](double angle) {
    const auto [at, is_new] = influences.try_emplace(std::round(angle / k_same_angle));
    if (is_new) at->second = nonlocal::sphere_influence(poisson_ratio, angle);
    return at->second;
  };
  const double self = nonlocal::sphere_self_influence(poisson_ratio, k_self_half_sine, k_last_term);
  for (std::size_t i = 0; i < size(); ++i) {
    const Eigen::Vector3d& normal = classes[i].normals.front();
    ClassState& c = classes_[i];
    c.count = classes[i].multiplicity();
    c.wall = normal * normal.transpose();
    c.spread = spreads[i];
    for (std::size_t j = 0; j < shapes_.size(); ++j) along_(index(i), index(j)) = contraction(c.wall, shapes_[j]);
    for (std::size_t j = 0; j < size(); ++j) {
      Coupling& sum = coupling_.emplace_back();
      for (const Eigen::Vector3d& other : classes[j].normals) {
        const double g = &other == &normal ? self : influence_at(nonlocal::angle_between(normal, other));
        const double along = std::min(1.0, raised<2>(normal.dot(other)));
        sum.same += g * along * along;
        sum.mixed += g * along * (1.0 - along);
        sum.across += g * (1.0 - along) * (1.0 - along);
      }
    }
  }
  Om_by_zeta_.resize(size());
  shares_.resize(lines_.size());
  choose_balance();
  residual_by_.resize(layout_.core() * row_width());
  evaluated_.resize(layout_.size());
  for (auto* values : {&solution_, &drift_, &rest_of_equations_, &before_}) values->resize(layout_.core());
}

Core Particle::core_of(std::span<const double> y) const noexcept {
  Core core{.C = Eigen::Matrix3d::Identity()};
  for (std::size_t j = 0; j < shapes_.size(); ++j) core.C += y[layout_.core() + j] * shapes_[j];
  if (layout_.has_core()) core.e = y[layout_.size() - 1];
  return core;
}

// --- the equations at a state

bool Particle::evaluate(std::span<const double> y) {
  if (is_known_ && std::ranges::equal(y.first(layout_.size()), evaluated_)) return false;
  evaluate_elastically(y);
  evaluate_flow(y);
  return true;
}

/// Evaluates the equations of elastic motion only.
void Particle::evaluate_elastically(std::span<const double> y) {
  forget();
  centre_ = layout_.centre_of(y);
  evaluate_contacts(y);
  evaluate_coupling();
}

/// Evaluates the core and the yield functions, after evaluate_elastically().
void Particle::evaluate_flow(std::span<const double> y) {
  core_ = core_of(y);
  evaluate_core();
  evaluate_yield();
  std::ranges::copy(y.first(layout_.size()), evaluated_.begin());
  is_known_ = true;
}

/// Evaluates dents, coverage and forces.
void Particle::evaluate_contacts(std::span<const double> y) {
  const Eigen::Map<const Eigen::VectorXd> flown(y.data() + layout_.core(), along_.cols());
  Om_ = 0.0;
  for (std::size_t i = 0; i < size(); ++i) {
    ClassState& c = classes_[i];
    const double excess = along_.row(index(i)).dot(flown);  // l^2 - 1, without the round-off of 1
    const double square = 1.0 + excess;
    const double zeta = y[layout_.dent(i)];
    if (!(square > 0.0) || !(zeta > 0.0)) throw std::domain_error("the core or a dent of the particle has no size");
    c.l = std::sqrt(square);
    c.per_l = 1.0 / c.l;
    if (zeta != c.dent.zeta) c.dent = dent_of(material_, zeta);
    c.advance = advance_of(excess / (1.0 + c.l));
    Om_ += 0.5 * c.count * (zeta * zeta - material_.a_Y * material_.a_Y) * c.per_l * c.per_l;
  }
  shade_ = 1.0 / (1.0 + k::kap * raised<4>(Om_));
  const double m = 1.0 - k::m2 * Om_ * Om_ + k::m4 * raised<4>(Om_);
  m_by_Om_ = -2.0 * k::m2 * Om_ + 4.0 * k::m4 * raised<3>(Om_);
  for (std::size_t i = 0; i < size(); ++i) {
    ClassState& c = classes_[i];
    c.coordinate = y[layout_.coordinate(i)];
    c.contact = contact_by(material_, c.dent, c.l, m, c.coordinate, c.takes_force);
  }
}

/// Evaluates influences, displacements by (K), and the stored energy.
void Particle::evaluate_coupling() {
  stored_ = 0.0;
  for (std::size_t i = 0; i < size(); ++i) {
    ClassState& c = classes_[i];
    double lift = 0.0;  // sum of G F
    for (std::size_t j = 0; j < size(); ++j) {
      if (classes_[j].contact.F == 0.0) continue;
      Coupling& g = coupling_[i * size() + j];
      g.G = g.mixed + g.across * shade_ + c.dent.root_Gam * classes_[j].dent.root_Gam * (g.same + g.mixed * shade_);
      lift += g.G * classes_[j].contact.F;
    }
    c.displacement = c.dent.h + c.advance.c + c.contact.u - lift - lines_.arm(i).dot(centre_);
    stored_ += c.count * (c.contact.stored - 0.5 * c.contact.F * lift);
  }
}

/// Evaluates the load of the core and its flow under that load.
void Particle::evaluate_core() {
  flow_ = {};
  flow_components_.setZero();
  per_S_ = 1.0 / (material_.Y * (k::s0 + k::s1 * core_.e));
  s_ = per_s_ = Q_ = 0.0;
  if (!layout_.has_core()) return;
  pushes_.setZero();
  for (const ClassState& c : classes_) pushes_ += c.contact.F * c.w() * c.spread;
  T_ = deviator(symmetric(core_.C * pushes_));
  const double load = 0.5 * std::sqrt(1.5 * T_.squaredNorm());
  if (!(load > k_no_load * material_.Y)) return;
  s_ = load;
  per_s_ = 1.0 / s_;
  Q_ = raised<k::n2>(s_ * per_S_);
  const double pace = static_cast<double>(k::n2) / k::n1 * Q_ * per_s_;
  flow_ = {.C = -2.0 * pace * 0.375 * per_s_ * symmetric(T_ * core_.C), .e = 0.5 * pace};
  for (std::size_t j = 0; j < shapes_.size(); ++j) flow_components_[index(j)] = contraction(shapes_[j], flow_.C);
}

/// Evaluates how far each contact drives the core or is carried by it, how weak carried ones are, and yield functions.
void Particle::evaluate_yield() {
  const double use = s_ * per_S_;
  for (ClassState& c : classes_) {
    c.X = c.b = c.tau = c.pace = 0.0;
    c.wk = 1.0;
    c.f = -1.0;
    if (!(c.contact.F > 0.0)) continue;
    if (s_ > 0.0) {
      c.tau = 0.75 * per_s_ * contraction(c.wall, T_);
      const double z = std::clamp(-2.0 * c.tau, 0.0, 1.0);
      c.b = z * z * (3.0 - 2.0 * z);
      if (c.b > 0.0) c.wk = 1.0 - k::beta * raised<k::n3>(use) * c.b * std::exp(-c.contact.alpha / k::ab);
    }
    c.X = raised<k::n1>(c.contact.F_over_H / c.wk);
    if (c.X > 0.0) c.pace = c.count * c.contact.F * (1.0 - c.b) / c.X * c.dent.h_zeta;
    if (c.X + Q_ > 0.0) c.f = std::pow(c.X + Q_, 1.0 / k::n1) - 1.0;
  }
}

void Particle::residual(double xi, std::span<double> residual) const {
  for (std::size_t i = 0; i < size(); ++i) {
    const ClassState& c = classes_[i];
    residual[layout_.coordinate(i)] = (c.takes_force ? c.coordinate : c.displacement) - c.drive.value(xi);
    residual[layout_.dent(i)] = c.flows ? -c.f : 0.0;
  }
  if (layout_.directions() == 0) return;
  Eigen::Vector3d net = k_weak_spring * balance_.transpose() * (centre_ - rest_);
  for (std::size_t line = 0; line < lines_.size(); ++line) {
    double push = 0.0;
    for (std::size_t i = 0; i < size(); ++i) push += push_on(line, i) * classes_[i].contact.F;
    net += push * shares_[line];
  }
  std::copy_n(net.begin(), layout_.directions(), &residual[layout_.centre(0)]);
}

/// Push of all walls of a class along a line, per force of one wall.
double Particle::push_on(std::size_t line, std::size_t i) const noexcept {
  return lines_.line_of(i) == line ? classes_[i].count * lines_.along(i) : 0.0;
}

/// Chooses the directions of the equations (E): along the line of the largest forces, then across it, where the
/// round-off of these forces would otherwise exceed the weak spring.
void Particle::choose_balance() {
  if (layout_.directions() == 0) return;
  balance_ = lines_.stiffest_directions([this](std::size_t line) {
    double largest = std::numeric_limits<double>::min();
    for (std::size_t i = 0; i < size(); ++i)
      largest = std::max(largest, std::abs(push_on(line, i)) * classes_[i].contact.F);
    return largest;
  });
  // Keeps the orientation of the basis, because the sign of the equations' determinant says whether a state is stable.
  const Eigen::Index n = lines_.dimension();
  if (balance_.topLeftCorner(n, n).determinant() < 0.0) balance_.col(n - 1) *= -1.0;
  for (std::size_t line = 0; line < lines_.size(); ++line) shares_[line] = lines_.components(balance_, line);
}

// --- their derivatives

/// Adds the derivatives of a quantity of a contact, times a factor, to a row.
inline void Particle::add(std::size_t i, const Slopes& by, double factor, std::span<double> row) const noexcept {
  row[layout_.coordinate(i)] += factor * by.coordinate;
  row[layout_.dent(i)] += factor * by.zeta;
  row[by_Om()] += factor * by.m * m_by_Om_;
  row[by_flow()] += factor * by.l * classes_[i].l_by_flow;
}

/// Turns the derivative by the coverage, by the chain rule, into derivatives by dents and flow of the core.
void Particle::fold_coverage(std::span<double> row) const noexcept {
  const double by = row[by_Om()];
  for (std::size_t j = 0; j < size(); ++j) row[layout_.dent(j)] += by * Om_by_zeta_[j];
  row[by_flow()] += by * Om_by_flow_;
}

void Particle::differentiate() {
  Om_by_flow_ = 0.0;
  pushes_by_flow_.setZero();
  for (std::size_t i = 0; i < size(); ++i) {
    ClassState& c = classes_[i];
    const double per_square = c.per_l * c.per_l;
    const double grown = c.dent.zeta * c.dent.zeta - material_.a_Y * material_.a_Y;
    c.l_by_flow = 0.5 * c.per_l * along_.row(index(i)).dot(flow_components_);
    Om_by_zeta_[i] = c.count * c.dent.zeta * per_square;
    Om_by_flow_ -= c.count * grown * per_square * c.per_l * c.l_by_flow;
    const double w_l = -(c.w() + c.advance.c_ll) * c.per_l;
    pushes_by_flow_ += c.contact.F * w_l * c.l_by_flow * c.spread;
  }
  for (std::size_t i = 0; i < size(); ++i) {
    differentiate_kinematics(i);
    if (classes_[i].flows) differentiate_yield(i);
  }
  for (std::size_t d = 0; d < layout_.directions(); ++d) differentiate_balance(d);
}

/// Derivatives of (K).
void Particle::differentiate_kinematics(std::size_t i) {
  const std::span<double> row = new_row(layout_.coordinate(i));
  const ClassState& c = classes_[i];
  const double shade_by_Om = -4.0 * k::kap * raised<3>(Om_) * shade_ * shade_;
  for (std::size_t j = 0; j < size(); ++j) {
    const ClassState& other = classes_[j];
    const double F = other.contact.F;
    if (F == 0.0) continue;
    const Coupling& g = coupling_[i * size() + j];
    add(j, other.contact.F_by, -g.G, row);
    const double lift = (g.same + g.mixed * shade_) * F;
    row[layout_.dent(i)] -= c.dent.root_Gam_zeta * other.dent.root_Gam * lift;
    row[layout_.dent(j)] -= c.dent.root_Gam * other.dent.root_Gam_zeta * lift;
    row[by_Om()] -= (g.across + c.dent.root_Gam * other.dent.root_Gam * g.mixed) * shade_by_Om * F;
  }
  add(i, c.contact.u_by, 1.0, row);
  row[layout_.dent(i)] += c.dent.h_zeta;
  row[by_flow()] += c.advance.c_l * c.l_by_flow;
  fold_coverage(row);
  for (std::size_t d = 0; d < layout_.directions(); ++d) row[layout_.centre(d)] = -lines_.arm(i)[index(d)];
}

/// Derivatives of a component of (E).
void Particle::differentiate_balance(std::size_t direction) {
  const std::span<double> row = new_row(layout_.centre(direction));
  for (std::size_t i = 0; i < size(); ++i)
    add(i, classes_[i].contact.F_by, shares_[lines_.line_of(i)][index(direction)] * classes_[i].count * lines_.along(i),
        row);
  fold_coverage(row);
  for (std::size_t d = 0; d < layout_.directions(); ++d)
    row[layout_.centre(d)] = k_weak_spring * balance_(index(d), index(direction));
}

/// Derivatives of -f: dX = n1 X (dF/F - dH/H - dwk/wk), dQ = n2 (s/S)^(n2-1) d(s/S).
void Particle::differentiate_yield(std::size_t i) {
  const std::span<double> row = new_row(layout_.dent(i));
  const ClassState& c = classes_[i];
  if (!(c.X + Q_ > 0.0) || !(c.contact.F > 0.0)) return;
  const double use = s_ * per_S_;
  const double of_X = (1.0 + c.f) * c.X / (c.X + Q_);
  add(i, c.contact.F_by, -of_X / c.contact.F, row);
  add(i, c.contact.H_by, of_X / c.contact.H, row);
  if (s_ > 0.0) {
    double of_use = (1.0 + c.f) / (c.X + Q_) * (static_cast<double>(k::n2) / k::n1) * raised<k::n2 - 1>(use);
    double of_tau = 0.0;
    if (c.b > 0.0) {
      const double of_weakness = of_X / c.wk * (1.0 - c.wk);
      of_use += of_weakness * k::n3 / use;
      const double z = std::min(-2.0 * c.tau, 1.0);
      of_tau = of_weakness / c.b * -12.0 * z * (1.0 - z);
      add(i, c.contact.alpha_by, of_weakness / k::ab, row);
    }
    // Derivatives by the load, whose size is s and whose share under this wall is tau, and by the strength S.
    const double of_s = of_use * per_S_ - of_tau * c.tau * per_s_;
    Eigen::Matrix3d by_T = 0.375 * of_s * per_s_ * T_;
    if (of_tau != 0.0) by_T += 0.75 * of_tau * per_s_ * deviator(c.wall);
    const Eigen::Matrix3d by_pushes = core_.C * by_T;
    for (std::size_t j = 0; j < size(); ++j)
      add(j, classes_[j].contact.F_by, -classes_[j].w() * contraction(by_pushes, classes_[j].spread), row);
    row[by_flow()] -= contraction(by_T, flow_.C * pushes_) + contraction(by_pushes, pushes_by_flow_) -
                      of_use * use * per_S_ * material_.Y * k::s1 * flow_.e;
  }
  fold_coverage(row);
}

// --- solving them

/// Sets up the linear equations of those unknowns up to the core that move: coordinates, centre, and dents that grow.
/// @param takes_core_along  true: the core flows as the dents grow; false: it stays
void Particle::assemble(bool takes_core_along) {
  differentiate();
  active_.clear();
  for (std::size_t i = 0; i < size(); ++i) active_.push_back(layout_.coordinate(i));
  for (std::size_t d = 0; d < layout_.directions(); ++d) active_.push_back(layout_.centre(d));
  for (std::size_t i = 0; i < size(); ++i) {
    if (classes_[i].flows) active_.push_back(layout_.dent(i));
  }
  const std::size_t n = active_.size();
  matrix_.resize(index(n), index(n) + 2);
  for (std::size_t row = 0; row < n; ++row) {
    const std::span<const double> by = row_at(active_[row]);
    for (std::size_t column = 0; column < n; ++column) matrix_(index(row), index(column)) = by[active_[column]];
    for (std::size_t column = size() + layout_.directions(); takes_core_along && column < n; ++column)
      matrix_(index(row), index(column)) += classes_[active_[column] - size()].pace * by[by_flow()];
  }
  for (std::size_t i = 0; i < size(); ++i) {
    if (!classes_[i].takes_force) continue;
    matrix_.row(index(i)).setZero();
    matrix_(index(i), index(i)) = 1.0;
  }
}

/// Solves the linear equations by Gaussian elimination with row scaling and pivoting, into solution_ and drift_.
/// @param right  right side, in the order of the unknowns
/// @param drift  second right side
/// @return the sign of the determinant, which is positive at the unloaded particle
double Particle::eliminate(std::span<const double> right, std::span<const double> drift) {
  const Eigen::Index n = matrix_.rows();
  double sign = 1.0;
  for (Eigen::Index at = 0; at < n; ++at) {
    const std::size_t place = active_[static_cast<std::size_t>(at)];
    matrix_(at, n) = right[place];
    matrix_(at, n + 1) = drift[place];
    const double largest = matrix_.row(at).head(n).cwiseAbs().maxCoeff();
    if (!(largest > 0.0)) throw DomainError(Limit::applicability);
    matrix_.row(at) *= 1.0 / largest;
  }
  for (Eigen::Index at = 0; at < n; ++at) {
    Eigen::Index below = 0;
    matrix_.col(at).tail(n - at).cwiseAbs().maxCoeff(&below);
    if (below > 0) {
      matrix_.row(at).swap(matrix_.row(at + below));
      sign = -sign;
    }
    const double pivot = matrix_(at, at);
    if (pivot == 0.0) throw DomainError(Limit::applicability);
    if (pivot < 0.0) sign = -sign;
    for (Eigen::Index other = at + 1; other < n; ++other) {
      const double factor = matrix_(other, at) / pivot;
      if (factor != 0.0) matrix_.row(other).tail(n + 1 - at) -= factor * matrix_.row(at).tail(n + 1 - at);
    }
  }
  for (Eigen::Index at = n; at-- > 0;) {
    for (Eigen::Index other = at + 1; other < n; ++other)
      matrix_.row(at).tail<2>() -= matrix_(at, other) * matrix_.row(other).tail<2>();
    matrix_.row(at).tail<2>() *= 1.0 / matrix_(at, at);
  }
  std::ranges::fill(solution_, 0.0);
  std::ranges::fill(drift_, 0.0);
  for (Eigen::Index at = 0; at < n; ++at) {
    const std::size_t place = active_[static_cast<std::size_t>(at)];
    solution_[place] = matrix_(at, n);
    drift_[place] = matrix_(at, n + 1);
  }
  return sign;
}

/// Largest residual of the state that was evaluated, as a displacement. A yield function counts times the elastic
/// displacement, because it has the relative accuracy of that.
double Particle::error(double xi) {
  residual(xi, rest_of_equations_);
  double largest = 0.0;
  for (std::size_t place = 0; place < layout_.core(); ++place) {
    const double unit = layout_.is_dent(place) ? std::min(1.0, classes_[place - size()].contact.u) : 1.0;
    largest = std::max(largest, unit * std::abs(rest_of_equations_[place]));
  }
  return largest;
}

void Particle::prescribe(double xi, std::span<double> y) const noexcept {
  for (std::size_t i = 0; i < size(); ++i) {
    if (classes_[i].takes_force) y[layout_.coordinate(i)] = classes_[i].drive.value(xi);
  }
}

/// Corrects a state by a Newton step, halved until the error is less than a bound.
/// @return the error of the corrected state
double Particle::correct(double xi, std::span<double> y, double bound) {
  assemble(false);
  eliminate(rest_of_equations_, rest_of_equations_);
  std::copy_n(y.begin(), before_.size(), before_.begin());
  double growth = 0.0;
  for (std::size_t i = 0; i < size(); ++i) growth = std::max(growth, std::abs(solution_[layout_.dent(i)]));
  double share = std::min(1.0, k_most_growth / growth);
  double now = 0.0;
  for (int halvings = 0; halvings < k_most_halvings; ++halvings, share *= 0.5) {
    for (const std::size_t place : active_) {
      y[place] = before_[place] - share * solution_[place];
      if (layout_.is_dent(place)) y[place] = std::max(y[place], k_least_dent * material_.a_Y);
    }
    if (any_flows())
      evaluate(y);
    else
      evaluate_elastically(y);
    now = error(xi);
    if (now < bound) break;
  }
  return now;
}

void Particle::solve(double xi, std::span<double> y) {
  constexpr double k_infinity = std::numeric_limits<double>::infinity();
  prescribe(xi, y);
  double largest = any_flows() ? material_.Y : 0.0;
  for (const ClassState& c : classes_) largest = std::max(largest, std::abs(c.drive.value(xi)));
  evaluate(y);
  choose_balance();
  double now = error(xi);
  // A free centre is corrected further: where only the weak spring holds it, a tiny net force still moves it far.
  const bool is_free = layout_.directions() > 0;
  int polished = 0;
  for (int i = 0; i < k_most_corrections && (is_free || now > k_rounding * largest); ++i) {
    const bool is_polishing = now <= k_stalled * largest;
    const double next = correct(xi, y, is_polishing ? k_infinity : now);
    if (!(next < now) && (!is_polishing || !is_free)) {
      std::ranges::copy(before_, y.begin());
      evaluate(y);
      now = error(xi);
      break;
    }
    now = next;
    double correction = 0.0;
    for (std::size_t j = 0; j < solution_.size(); ++j) {
      if (!layout_.is_dent(j)) correction = std::max(correction, std::abs(solution_[j]));
    }
    if (is_polishing && (correction <= k_rounding * largest || ++polished == k_most_polishings)) break;
  }
  const bool takes_force = std::ranges::any_of(classes_, &ClassState::takes_force);
  if (takes_force && (centre_ - rest_).cwiseAbs().maxCoeff() > k_farthest) throw DomainError(Limit::centre_driven_away);
  if (!(now <= k_solved * std::max(largest, material_.Y))) throw DomainError(Limit::applicability);
  if (!is_known_) evaluate_flow(y);
}

double Particle::rates(std::span<double> dy, double xi, double pull) {
  assemble(true);
  std::ranges::fill(before_, 0.0);
  for (std::size_t i = 0; i < size(); ++i) before_[layout_.coordinate(i)] = classes_[i].drive.rate();
  residual(xi, rest_of_equations_);
  for (double& rest : rest_of_equations_) rest *= -pull;
  const double sign = eliminate(before_, rest_of_equations_);
  Lam_ = flow_rate(solution_);
  for (std::size_t j = 0; j < layout_.core(); ++j) dy[j] = solution_[j] + drift_[j];
  let_core_flow(dy);
  return sign * slowness();
}

/// Speed of the walls, over the sum of that and the speed of their contacts: 0 at a fold.
double Particle::slowness() const noexcept {
  double speed = 0.0;
  double fastest = 0.0;
  for (std::size_t i = 0; i < size(); ++i) {
    const ClassState& c = classes_[i];
    const double rate = solution_[layout_.coordinate(i)];
    const double u_rate = c.contact.u_by.coordinate * rate;
    speed = std::max(speed, std::abs(c.takes_force ? u_rate : c.drive.rate()));
    fastest = std::max({fastest, std::abs(u_rate), std::abs(c.dent.h_zeta * solution_[layout_.dent(i)])});
  }
  return speed > 0.0 ? speed / (speed + fastest) : 1.0;
}

/// Rate of a residual, by the last rates().
double Particle::rate_of(std::size_t place) const noexcept {
  const std::span<const double> row = row_at(place);
  return std::inner_product(solution_.begin(), solution_.end(), row.begin(), Lam_ * row[by_flow()]);
}

double Particle::yield_rate(std::size_t i) {
  differentiate_yield(i);
  return -rate_of(layout_.dent(i));
}

double Particle::power() const {
  double sum = 0.0;
  for (std::size_t i = 0; i < size(); ++i) {
    const ClassState& c = classes_[i];
    const double speed = c.takes_force ? rate_of(layout_.coordinate(i)) : c.drive.rate();
    sum += c.count * c.contact.F * speed;
  }
  return sum;
}

double Particle::flow_rate(std::span<const double> dy) const noexcept {
  double Lam = 0.0;
  for (std::size_t i = 0; i < size(); ++i) {
    if (classes_[i].flows) Lam += classes_[i].pace * dy[layout_.dent(i)];
  }
  return Lam;
}

void Particle::let_core_flow(std::span<double> dy) const noexcept {
  if (!layout_.has_core()) return;
  const double Lam = flow_rate(dy);
  for (std::size_t j = 0; j < shapes_.size(); ++j) dy[layout_.core() + j] = Lam * flow_components_[index(j)];
  dy[layout_.size() - 1] = Lam * flow_.e;
}

}  // namespace monograin::cel
