#include "cel/particle.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cel/constants.hpp"
#include "elastic/nonlocal_coupling.hpp"
#include "system/limit.hpp"

namespace monograin::cel {
namespace {

namespace k = constants;

/// Sine of half the angle, and last term of the series, of the self influence: part of the law's definition.
constexpr double k_self_half_sine = 0.2;
constexpr int k_last_term = 4000;
/// Load of the core over Y R0^2 below which it has no direction.
constexpr double k_no_load = 1e-14;

/// Way of a free centre over R0 in one step of the program that is none: only the weak spring stops it.
constexpr double k_farthest = 10.0;

constexpr int k_most_corrections = 60;
constexpr int k_most_halvings = 40;
constexpr int k_most_polishings = 4;
constexpr double k_most_growth = 0.03;  ///< of a dent in one correction
/// Dents over a_Y, below which no trial goes: one that begins to flow is a_Y but for rounding.
constexpr double k_least_dent = 0.9;
constexpr double k_solved = 1e-10;  ///< residual over the largest displacement that is a solution at all
/// Residual over that from which on a correction that makes it larger is rounding.
constexpr double k_stalled = 1e-14;
constexpr double k_rounding = 4.0 * std::numeric_limits<double>::epsilon();

constexpr Eigen::Index axis(std::size_t direction) noexcept { return static_cast<Eigen::Index>(direction); }

template <int n>
constexpr double raised(double x) noexcept {
  double result = 1.0;
  for (int i = 0; i < n; ++i) result *= x;
  return result;
}

/// Influences at the angles between walls, each found once.
class Influences {
 public:
  explicit Influences(double poisson_ratio) noexcept : poisson_ratio_(poisson_ratio) {}
  double at(double angle) {
    constexpr double k_same_angle = 1e-12;
    const auto known = std::ranges::find_if(
        found_, [angle](const auto& pair) { return std::abs(pair.first - angle) <= k_same_angle; });
    if (known != found_.end()) return known->second;
    return found_.emplace_back(angle, nonlocal::sphere_influence(poisson_ratio_, angle)).second;
  }

 private:
  double poisson_ratio_;
  std::vector<std::pair<double, double>> found_;
};

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
      spreads_(spreads_of(classes)),
      shapes_(core_shapes(spreads_)),
      lines_(classes, centre_is_free),
      layout_(classes.size(), static_cast<std::size_t>(lines_.dimension()), shapes_.size()),
      classes_(classes.size()) {
  Influences influences(poisson_ratio);
  const double self = nonlocal::sphere_self_influence(poisson_ratio, k_self_half_sine, k_last_term);
  for (std::size_t i = 0; i < size(); ++i) {
    const Eigen::Vector3d& normal = classes[i].normals.front();
    counts_.push_back(classes[i].multiplicity());
    walls_.emplace_back(normal * normal.transpose());
    for (std::size_t j = 0; j < size(); ++j) {
      Coupling& sum = coupling_.emplace_back();
      for (std::size_t wall = 0; wall < classes[j].normals.size(); ++wall) {
        const Eigen::Vector3d& other = classes[j].normals[wall];
        const bool is_self = i == j && wall == 0;
        const double g = is_self ? self : influences.at(nonlocal::angle_between(normal, other));
        const double along = std::min(1.0, raised<2>(normal.dot(other)));
        sum.same += g * along * along;
        sum.mixed += g * along * (1.0 - along);
        sum.across += g * (1.0 - along) * (1.0 - along);
      }
    }
  }
  for (auto* values : {&l_by_flow_, &Om_by_zeta_, &s_by_F_}) values->resize(size());
  load_.resize(size());
  shares_.resize(lines_.size());
  choose_balance();
  F_by_.resize(size());
  rows_.resize((2 * size() + 1) * (2 * size() + 2));
  const std::size_t unknowns = layout_.core();
  active_.reserve(unknowns);
  matrix_.resize(unknowns * (unknowns + k_right_sides));
  order_.resize(unknowns);
  for (auto* values : {&solution_, &drift_, &rest_of_equations_, &before_}) values->resize(unknowns);
}

Core Particle::core_of(std::span<const double> y) const noexcept {
  Core core{.C = Eigen::Matrix3d::Identity()};
  if (!layout_.has_core()) return core;
  for (std::size_t j = 0; j < shapes_.size(); ++j) core.C += y[layout_.core() + j] * shapes_[j];
  core.e = y[layout_.size() - 1];
  return core;
}

double Particle::carried(std::size_t i, std::span<const double> y) const noexcept {
  double sum = 0.0;
  for (std::size_t d = 0; d < layout_.directions(); ++d) sum += lines_.arm(i)[axis(d)] * y[layout_.centre(d)];
  return sum;
}

void Particle::rest_centre(std::span<const double> y) noexcept {
  for (std::size_t d = 0; d < layout_.directions(); ++d) rest_[axis(d)] = y[layout_.centre(d)];
}

// --- the equations at a state

bool Particle::any_flows() const noexcept { return std::ranges::any_of(classes_, &ClassState::flows); }

void Particle::evaluate(std::span<const double> y) {
  evaluate_elastically(y);
  evaluate_yield(y);
}

/// Evaluates only the equations of elastic motion.
void Particle::evaluate_elastically(std::span<const double> y) {
  for (std::size_t d = 0; d < layout_.directions(); ++d) centre_[axis(d)] = y[layout_.centre(d)];
  evaluate_contacts(y);
  evaluate_coupling();
}

/// Dents, coverage and forces.
void Particle::evaluate_contacts(std::span<const double> y) {
  Om_ = 0.0;
  Eigen::Matrix3d flown = Eigen::Matrix3d::Zero();  // C - 1
  for (std::size_t j = 0; j + 1 < layout_.core_size(); ++j) flown += y[layout_.core() + j] * shapes_[j];
  for (std::size_t i = 0; i < size(); ++i) {
    ClassState& c = classes_[i];
    const double excess = contraction(walls_[i], flown);  // l^2 - 1, without the rounding of 1
    const double square = 1.0 + excess;
    const double zeta = y[layout_.dent(i)];
    if (!(square > 0.0) || !(zeta > 0.0)) throw std::domain_error("the core or a dent of the particle has no size");
    c.l = std::sqrt(square);
    c.per_l = 1.0 / c.l;
    if (zeta != c.dent.zeta) {
      c.dent = dent_of(material_, zeta);
      c.root_Gam = std::sqrt(c.dent.Gam);
      c.half_Gam_log = 0.5 * c.dent.Gam_zeta / c.dent.Gam;
    }
    c.advance = advance_of(excess / (1.0 + c.l));
    Om_ += 0.5 * counts_[i] * (zeta * zeta - material_.a_Y * material_.a_Y) * c.per_l * c.per_l;
  }
  shade_ = 1.0 / (1.0 + k::kap * raised<4>(Om_));
  const double m = 1.0 - k::m2 * Om_ * Om_ + k::m4 * raised<4>(Om_);
  m_by_Om_ = -2.0 * k::m2 * Om_ + 4.0 * k::m4 * raised<3>(Om_);
  for (std::size_t i = 0; i < size(); ++i) {
    ClassState& c = classes_[i];
    c.coordinate = y[layout_.coordinate(i)];
    c.contact = c.takes_force ? contact_under(material_, c.dent, c.l, m, c.coordinate)
                              : contact_at(material_, c.dent, c.l, m, c.coordinate);
  }
}

/// Load of the core, and how it flows under it.
void Particle::evaluate_core(const Core& core) {
  T_.setZero();
  flow_ = {};
  per_S_ = 1.0 / (material_.Y * (k::s0 + k::s1 * core.e));
  s_ = per_s_ = Q_ = 0.0;
  if (!layout_.has_core()) return;
  for (std::size_t i = 0; i < size(); ++i) {
    const ClassState& c = classes_[i];
    load_[i] = -c.advance.c_l * c.per_l * deviator(symmetric(core.C * spreads_[i]));
    T_ += c.contact.F * load_[i];
  }
  const double load = 0.5 * std::sqrt(1.5 * T_.squaredNorm());
  if (!(load > k_no_load * material_.Y)) return;
  s_ = load;
  per_s_ = 1.0 / s_;
  Q_ = raised<k::n2>(s_ * per_S_);
  const double pace = static_cast<double>(k::n2) / k::n1 * Q_ * per_s_;
  flow_.C = -2.0 * pace * 0.375 * per_s_ * symmetric(T_ * core.C);
  flow_.e = 0.5 * pace;
}

/// Which contacts drive the core and which it carries, how weak those are, and the yield functions.
void Particle::evaluate_yield(std::span<const double> y) {
  evaluate_core(core_of(y));
  const double use = s_ * per_S_;
  for (std::size_t i = 0; i < size(); ++i) {
    ClassState& c = classes_[i];
    c.X = c.b = c.tau = c.pace = 0.0;
    c.wk = 1.0;
    c.f = -1.0;
    if (!(c.contact.F > 0.0)) continue;
    if (s_ > 0.0) {
      c.tau = 0.75 * per_s_ * contraction(walls_[i], T_);
      const double z = std::clamp(-2.0 * c.tau, 0.0, 1.0);
      c.b = z * z * (3.0 - 2.0 * z);
      if (c.b > 0.0) c.wk = 1.0 - k::beta * raised<k::n3>(use) * c.b * std::exp(-c.contact.alpha / k::ab);
    }
    c.X = raised<k::n1>(c.contact.F_over_H / c.wk);
    if (c.X > 0.0) c.pace = counts_[i] * c.contact.F * (1.0 - c.b) / c.X * c.dent.h_zeta;
    if (c.X + Q_ > 0.0) c.f = std::pow(c.X + Q_, 1.0 / k::n1) - 1.0;
  }
}

/// Right sides of (K), and the stored energy.
void Particle::evaluate_coupling() {
  stored_ = 0.0;
  for (std::size_t i = 0; i < size(); ++i) {
    ClassState& c = classes_[i];
    double lift = 0.0;  // sum of G F
    for (std::size_t j = 0; j < size(); ++j) {
      const ClassState& other = classes_[j];
      if (other.contact.F == 0.0) continue;
      const Coupling& g = coupling_[i * size() + j];
      const double root = c.root_Gam * other.root_Gam;
      lift += (g.mixed + g.across * shade_ + root * (g.same + g.mixed * shade_)) * other.contact.F;
    }
    c.kinematic = c.dent.h + c.advance.c + c.contact.u - lift;
    stored_ += counts_[i] * (c.contact.stored - 0.5 * c.contact.F * lift);
  }
}

void Particle::residual(double xi, std::span<double> residual) const {
  for (std::size_t i = 0; i < size(); ++i) {
    const ClassState& c = classes_[i];
    residual[layout_.coordinate(i)] =
        c.takes_force ? c.coordinate - c.drive.value(xi) : c.kinematic - lines_.arm(i).dot(centre_) - c.drive.value(xi);
    residual[layout_.dent(i)] = c.flows ? -c.f : 0.0;
  }
  for (std::size_t d = 0; d < layout_.directions(); ++d) residual[layout_.centre(d)] = 0.0;
  for (std::size_t line = 0; layout_.directions() > 0 && line < lines_.size(); ++line) {
    double push = 0.0;
    for (std::size_t i = 0; i < size(); ++i) push += push_on(line, i) * classes_[i].contact.F;
    for (std::size_t d = 0; d < layout_.directions(); ++d) residual[layout_.centre(d)] += shares_[line][axis(d)] * push;
  }
  for (std::size_t d = 0; d < layout_.directions(); ++d)
    residual[layout_.centre(d)] += k_weak_spring * balance_.col(axis(d)).dot(centre_ - rest_);
}

/// Force along a line of pushes per force of a class.
double Particle::push_on(std::size_t line, std::size_t i) const noexcept {
  return lines_.line_of(i) == line ? counts_[i] * lines_.along(i) : 0.0;
}

/// Takes the balance of forces along the line of the largest ones, then across it: their round-off would be more there
/// than the weak spring.
void Particle::choose_balance() {
  if (layout_.directions() == 0) return;
  balance_ = lines_.stiffest_directions([this](std::size_t line) {
    double largest = std::numeric_limits<double>::min();
    for (std::size_t i = 0; i < size(); ++i)
      largest = std::max(largest, std::abs(push_on(line, i)) * classes_[i].contact.F);
    return largest;
  });
  // The sign of the determinant says whether a state is stable.
  const Eigen::Index n = lines_.dimension();
  if (balance_.topLeftCorner(n, n).determinant() < 0.0) balance_.col(n - 1) *= -1.0;
  for (std::size_t line = 0; line < lines_.size(); ++line) shares_[line] = lines_.components(balance_, line);
}

// --- their derivatives

Particle::Row Particle::row_of(std::size_t i, const Slopes& by) const noexcept {
  return {by.coordinate, by.zeta, by.m * m_by_Om_, by.l * l_by_flow_[i]};
}

inline void Particle::add(std::size_t i, const Row& by, double factor, std::span<double> row) const noexcept {
  const std::size_t n = size();
  row[i] += factor * by.coordinate;
  row[n + i] += factor * by.zeta;
  row[2 * n] += factor * by.Om;
  row[2 * n + 1] += factor * by.flow;
}

/// Writes the coverage as what it depends on.
void Particle::fold_coverage(std::span<double> row) const noexcept {
  const std::size_t n = size();
  const double by_Om = row[2 * n];
  for (std::size_t j = 0; j < n; ++j) row[n + j] += by_Om * Om_by_zeta_[j];
  row[2 * n + 1] += by_Om * Om_by_flow_;
}

void Particle::differentiate() {
  Om_by_flow_ = 0.0;
  for (std::size_t i = 0; i < size(); ++i) {
    const ClassState& c = classes_[i];
    const double per_square = c.per_l * c.per_l;
    const double grown = c.dent.zeta * c.dent.zeta - material_.a_Y * material_.a_Y;
    l_by_flow_[i] = 0.5 * c.per_l * contraction(walls_[i], flow_.C);
    Om_by_zeta_[i] = counts_[i] * c.dent.zeta * per_square;
    Om_by_flow_ -= counts_[i] * grown * per_square * c.per_l * l_by_flow_[i];
    F_by_[i] = row_of(i, c.contact.F_by);
  }
  for (std::size_t i = 0; i < size(); ++i) differentiate_kinematics(i, row_at(i));
  if (!any_flows()) return;
  differentiate_core();
  for (std::size_t i = 0; i < size(); ++i) {
    if (classes_[i].flows) differentiate_yield(i, row_at(size() + i));
  }
}

void Particle::differentiate_core() {
  T_by_flow_.setZero();
  s_by_flow_ = 0.0;
  std::ranges::fill(s_by_F_, 0.0);
  if (!(s_ > 0.0)) return;
  for (std::size_t i = 0; i < size(); ++i) {
    const ClassState& c = classes_[i];
    const double w = -c.advance.c_l * c.per_l;
    const double w_l = -(w + c.advance.c_ll) * c.per_l;
    s_by_F_[i] = 0.375 * per_s_ * contraction(T_, load_[i]);
    T_by_flow_ += c.contact.F * (w_l / w * l_by_flow_[i] * load_[i] + w * deviator(symmetric(flow_.C * spreads_[i])));
  }
  s_by_flow_ = 0.375 * per_s_ * contraction(T_, T_by_flow_);
}

/// Writes the derivatives of (K).
void Particle::differentiate_kinematics(std::size_t i, std::span<double> row) {
  const std::size_t n = size();
  const ClassState& c = classes_[i];
  const double shade_by_Om = -4.0 * k::kap * raised<3>(Om_) * shade_ * shade_;
  std::ranges::fill(row, 0.0);
  for (std::size_t j = 0; j < n; ++j) {
    const ClassState& other = classes_[j];
    const double F = other.contact.F;
    if (F == 0.0) continue;
    const Coupling& g = coupling_[i * n + j];
    const double root = c.root_Gam * other.root_Gam;
    const double of_root = root * (g.same + g.mixed * shade_);
    add(j, F_by_[j], -(g.mixed + g.across * shade_ + of_root), row);
    row[n + i] -= of_root * F * c.half_Gam_log;
    row[n + j] -= of_root * F * other.half_Gam_log;
    row[2 * n] -= (g.across + root * g.mixed) * shade_by_Om * F;
  }
  add(i, row_of(i, c.contact.u_by), 1.0, row);
  row[n + i] += c.dent.h_zeta;
  row[2 * n + 1] += c.advance.c_l * l_by_flow_[i];
  fold_coverage(row);
}

/// Writes the derivatives of the yield function: dX = n1 X (dF/F - dH/H - dwk/wk), dQ = n2 (s/S)^(n2-1) d(s/S).
void Particle::differentiate_yield(std::size_t i, std::span<double> row) {
  const std::size_t n = size();
  const ClassState& c = classes_[i];
  std::ranges::fill(row, 0.0);
  if (!(c.X + Q_ > 0.0) || !(c.contact.F > 0.0)) return;
  const double use = s_ * per_S_;
  const double of_X = (1.0 + c.f) * c.X / (c.X + Q_);
  add(i, F_by_[i], of_X / c.contact.F, row);
  add(i, row_of(i, c.contact.H_by), -of_X / c.contact.H, row);
  if (s_ > 0.0) {
    double of_use = (1.0 + c.f) / (c.X + Q_) * (static_cast<double>(k::n2) / k::n1) * raised<k::n2 - 1>(use);
    double of_tau = 0.0;
    if (c.b > 0.0) {
      const double of_weakness = of_X / c.wk * (1.0 - c.wk);
      of_use += of_weakness * k::n3 / use;
      const double z = std::min(-2.0 * c.tau, 1.0);
      of_tau = of_weakness / c.b * -12.0 * z * (1.0 - z);
      add(i, row_of(i, c.contact.alpha_by), -of_weakness / k::ab, row);
    }
    // By the load s, by its share tau under this wall, and by the strength S.
    const double of_s = of_use * per_S_ - of_tau * c.tau * per_s_;
    const double per_tau = 0.75 * of_tau * per_s_;
    for (std::size_t j = 0; j < n; ++j)
      add(j, F_by_[j], of_s * s_by_F_[j] + per_tau * contraction(walls_[i], load_[j]), row);
    row[2 * n + 1] += of_s * s_by_flow_ + per_tau * contraction(walls_[i], T_by_flow_) -
                      of_use * use * per_S_ * material_.Y * k::s1 * flow_.e;
  }
  fold_coverage(row);
}

// --- solving them

/// The linear equations of the unknowns up to the core that move: coordinates, the centre, and dents that grow.
/// @param takes_core_along  whether the core flows as the dents do; otherwise it stays
void Particle::assemble(bool takes_core_along) {
  differentiate();
  const std::size_t n = size();
  active_.clear();
  for (std::size_t i = 0; i < n; ++i) active_.push_back(layout_.coordinate(i));
  for (std::size_t d = 0; d < layout_.directions(); ++d) active_.push_back(layout_.centre(d));
  for (std::size_t i = 0; i < n; ++i) {
    if (classes_[i].flows) active_.push_back(layout_.dent(i));
  }
  const std::size_t dents = n + layout_.directions();
  const auto row_begin = [&](std::size_t at) {
    return order_[at] = matrix_.data() + at * (active_.size() + k_right_sides);
  };
  const auto put = [&](std::size_t at, std::span<const double> by, double sign) {
    double* const row = row_begin(at);
    for (std::size_t j = 0; j < n; ++j) row[j] = sign * by[j];
    std::fill(row + n, row + dents, 0.0);
    for (std::size_t k = dents; k < active_.size(); ++k) {
      const double pace = takes_core_along ? classes_[active_[k] - n].pace : 0.0;
      row[k] = sign * (by[active_[k]] + pace * by[2 * n + 1]);
    }
    return row;
  };
  for (std::size_t i = 0; i < n; ++i) {
    if (classes_[i].takes_force) {
      double* const row = row_begin(i);
      std::fill(row, row + active_.size(), 0.0);
      row[i] = 1.0;
    } else {
      double* const row = put(i, row_at(i), 1.0);
      for (std::size_t d = 0; d < layout_.directions(); ++d) row[n + d] = -lines_.arm(i)[axis(d)];
    }
  }
  for (std::size_t d = 0; d < layout_.directions(); ++d) {
    const auto by = row_at(2 * n);
    std::ranges::fill(by, 0.0);
    for (std::size_t i = 0; i < n; ++i)
      add(i, F_by_[i], shares_[lines_.line_of(i)][axis(d)] * counts_[i] * lines_.along(i), by);
    fold_coverage(by);
    double* const row = put(n + d, by, 1.0);
    for (std::size_t k = 0; k < layout_.directions(); ++k) row[n + k] = k_weak_spring * balance_(axis(k), axis(d));
  }
  for (std::size_t k = dents; k < active_.size(); ++k) put(k, row_at(active_[k]), -1.0);
}

/// Gauss's elimination of the linear equations, rows by their largest entries.
/// @param right  their right side, by the places in a state
/// @param drift  another one; empty: none
/// @return the sign of the determinant, which is positive at the unloaded particle
double Particle::eliminate(std::span<const double> right, std::span<const double> drift) {
  const std::size_t n = active_.size();
  const std::size_t width = n + k_right_sides;
  for (std::size_t at = 0; at < n; ++at) {
    double* const row = order_[at];
    row[n] = right[active_[at]];
    row[n + 1] = drift.empty() ? 0.0 : drift[active_[at]];
    double largest = 0.0;
    for (std::size_t c = 0; c < n; ++c) largest = std::max(largest, std::abs(row[c]));
    if (!(largest > 0.0)) throw DomainError(Limit::applicability);
    const double scale = 1.0 / largest;
    for (std::size_t c = 0; c < width; ++c) row[c] *= scale;
  }
  double sign = 1.0;
  for (std::size_t at = 0; at < n; ++at) {
    std::size_t best = at;
    for (std::size_t other = at + 1; other < n; ++other) {
      if (std::abs(order_[other][at]) > std::abs(order_[best][at])) best = other;
    }
    if (best != at) {
      std::swap(order_[best], order_[at]);
      sign = -sign;
    }
    const double* const row = order_[at];
    if (row[at] == 0.0) throw DomainError(Limit::applicability);
    if (row[at] < 0.0) sign = -sign;
    const double per_pivot = 1.0 / row[at];
    for (std::size_t other = at + 1; other < n; ++other) {
      double* const rest = order_[other];
      if (rest[at] == 0.0) continue;
      const double factor = rest[at] * per_pivot;
      for (std::size_t c = at + 1; c < width; ++c) rest[c] -= factor * row[c];
    }
  }
  for (auto [values, column] : {std::pair{&solution_, n}, {&drift_, n + 1}}) {
    std::ranges::fill(*values, 0.0);
    for (std::size_t at = n; at-- > 0;) {
      const double* const row = order_[at];
      double sum = row[column];
      for (std::size_t c = at + 1; c < n; ++c) sum -= row[c] * (*values)[active_[c]];
      (*values)[active_[at]] = sum / row[at];
    }
  }
  return sign;
}

void Particle::solve(double xi, std::span<double> y) {
  const std::span<double> rest = rest_of_equations_;
  const bool is_elastic = !any_flows();
  double largest = is_elastic ? 0.0 : material_.Y;
  for (const ClassState& c : classes_) largest = std::max(largest, std::abs(c.drive.value(xi)));
  const auto evaluate_state = [&] { is_elastic ? evaluate_elastically(y) : evaluate(y); };
  // As displacements: a yield function is known as well as the elastic displacement is, over itself.
  const auto error_of_state = [&] {
    residual(xi, rest);
    double error = 0.0;
    for (std::size_t j = 0; j < rest.size(); ++j) {
      const bool is_yield = j >= size() && j < 2 * size();
      error = std::max(error, std::abs(rest[j]) * (is_yield ? std::min(1.0, classes_[j - size()].contact.u) : 1.0));
    }
    return error;
  };
  evaluate_state();
  choose_balance();
  double error = error_of_state();
  // Where the weak spring decides, the balance of forces says more of the centre than the largest residual does.
  const bool is_free = layout_.directions() > 0;
  int polished = 0;
  for (int i = 0; i < k_most_corrections && (is_free || error > k_rounding * largest); ++i) {
    const bool is_polishing = error <= k_stalled * largest;
    assemble(false);
    eliminate(rest);
    double correction = 0.0;
    for (const std::size_t at : active_) {
      if (at < size() || at >= 2 * size()) correction = std::max(correction, std::abs(solution_[at]));
    }
    double share = 1.0;
    for (std::size_t j = 0; j < size(); ++j) {
      const double growth = std::abs(solution_[layout_.dent(j)]);
      if (growth * share > k_most_growth) share = k_most_growth / growth;
    }
    std::copy_n(y.begin(), before_.size(), before_.begin());
    double next = 0.0;
    int halvings = 0;
    for (; halvings < k_most_halvings; ++halvings, share *= 0.5) {
      for (const std::size_t at : active_) y[at] = before_[at] - share * solution_[at];
      for (std::size_t j = 0; j < size(); ++j) {
        double& dent = y[layout_.dent(j)];
        dent = std::max(dent, k_least_dent * material_.a_Y);
      }
      evaluate_state();
      next = error_of_state();
      if (next < error || is_polishing) break;
    }
    if (!(next < error) && (!is_polishing || !is_free)) {
      std::ranges::copy(before_, y.begin());
      evaluate_state();
      error = error_of_state();
      break;
    }
    error = next;
    if (is_polishing && (correction <= k_rounding * largest || ++polished == k_most_polishings)) break;
  }
  const bool takes_force = std::ranges::any_of(classes_, &ClassState::takes_force);
  if (takes_force && (centre_ - rest_).cwiseAbs().maxCoeff() > k_farthest) throw DomainError(Limit::centre_driven_away);
  if (!(error <= k_solved * std::max(largest, material_.Y))) throw DomainError(Limit::applicability);
  if (is_elastic) evaluate_yield(y);
}

double Particle::rates(std::span<double> dy, std::span<const double> drift) {
  assemble(true);
  std::ranges::fill(before_, 0.0);
  for (std::size_t i = 0; i < size(); ++i) before_[layout_.coordinate(i)] = classes_[i].drive.rate();
  const double sign = eliminate(before_, drift);
  Lam_ = flow_rate(solution_);
  for (std::size_t j = 0; j < layout_.core(); ++j) dy[j] = solution_[j] + drift_[j];
  let_core_flow(dy);
  return sign * slowness();
}

/// How fast walls go, as displacements, over how fast they and their contacts do: 0 where the equations turn back.
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

/// Rate of what a row of derivatives is of.
double Particle::rate_of(std::size_t at) const noexcept {
  const auto row = row_at(at);
  double sum = row.back() * Lam_;
  for (std::size_t j = 0; j < 2 * size(); ++j) sum += row[j] * solution_[j];
  return sum;
}

double Particle::yield_rate(std::size_t i) {
  differentiate_core();
  differentiate_yield(i, row_at(size() + i));
  return rate_of(size() + i);
}

double Particle::power() const {
  double sum = 0.0;
  for (std::size_t i = 0; i < size(); ++i) {
    const ClassState& c = classes_[i];
    const double speed = c.takes_force ? rate_of(i) - carried(i, solution_) : c.drive.rate();
    sum += counts_[i] * c.contact.F * speed;
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
  for (std::size_t j = 0; j < shapes_.size(); ++j) dy[layout_.core() + j] = Lam * contraction(shapes_[j], flow_.C);
  dy[layout_.size() - 1] = Lam * flow_.e;
}

}  // namespace monograin::cel
