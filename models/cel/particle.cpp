#include "cel/particle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cel/constants.hpp"
#include "elastic/nonlocal_coupling.hpp"
#include "system/limit.hpp"

namespace monograin::cel {
namespace {

namespace k = constants;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Sine of half the angle, and last term of the series, of the self influence: part of the law's definition.
constexpr double k_self_half_sine = 0.2;
constexpr int k_last_term = 4000;
/// Of the spring at a free centre, over E R0: settles directions in which no contact is stiff.
constexpr double k_weak_spring = 1e-9;
/// Load of the core over Y R0^2 below which it has no direction.
constexpr double k_no_load = 1e-14;
/// Walls whose spreads differ from those of all directions alike by less than that load the core by no deviator.
constexpr double k_isotropic = 1e-9;

constexpr int k_most_corrections = 60;
constexpr int k_most_halvings = 40;
constexpr double k_most_growth = 0.03;  ///< of a dent in one correction
/// Dents over a_Y, below which no trial goes: one that begins to flow is a_Y but for rounding.
constexpr double k_least_dent = 0.9;
constexpr double k_solved = 1e-10;  ///< residual over the largest displacement that is a solution at all

template <int n>
constexpr double raised(double x) noexcept {
  double result = 1.0;
  for (int i = 0; i < n; ++i) result *= x;
  return result;
}

Matrix3d symmetric(const Matrix3d& a) { return 0.5 * (a + a.transpose()); }
Matrix3d deviator(const Matrix3d& a) { return a - a.trace() / 3.0 * Matrix3d::Identity(); }
double contraction(const Matrix3d& a, const Matrix3d& b) { return a.cwiseProduct(b).sum(); }

bool loads_alike(std::span<const Matrix3d> spreads) {
  return std::ranges::all_of(spreads, [](const Matrix3d& spread) {
    return deviator(spread).cwiseAbs().maxCoeff() <= k_isotropic * spread.trace();
  });
}

std::vector<Matrix3d> spreads_of(std::span<const ContactClass> classes) {
  std::vector<Matrix3d> spreads;
  for (const ContactClass& c : classes) {
    Matrix3d sum = Matrix3d::Zero();
    for (const Vector3d& normal : c.normals) sum += normal * normal.transpose();
    spreads.push_back(sum);
  }
  return spreads;
}

}  // namespace

Particle::Particle(const Material& material, double poisson_ratio, std::span<const ContactClass> classes,
                   bool centre_is_free)
    : material_(material),
      spreads_(spreads_of(classes)),
      lines_(classes, centre_is_free),
      layout_(classes.size(), static_cast<std::size_t>(lines_.dimension()), !loads_alike(spreads_)),
      classes_(classes.size()) {
  for (const ContactClass& c : classes) {
    counts_.push_back(c.multiplicity());
    normals_.push_back(c.normals.front());
  }
  const double self = nonlocal::sphere_self_influence(poisson_ratio, k_self_half_sine, k_last_term);
  for (const Vector3d& normal : normals_) {
    for (const ContactClass& other : classes) {
      Coupling& sum = coupling_.emplace_back();
      for (const Vector3d& neighbour : other.normals) {
        const bool is_self = &neighbour == &other.normals.front() && neighbour == normal;
        const double g =
            is_self ? self : nonlocal::sphere_influence(poisson_ratio, nonlocal::angle_between(normal, neighbour));
        const double along = std::min(1.0, std::pow(normal.dot(neighbour), 2));
        sum.same += g * along * along;
        sum.mixed += g * along * (1.0 - along);
        sum.across += g * (1.0 - along) * (1.0 - along);
      }
    }
  }
  const auto n = ix(size());
  const Eigen::Index columns = 2 * n + 1;
  const Eigen::Index unknowns = columns + lines_.dimension();
  l_by_flow_.resize(size());
  load_.resize(size());
  push_.resize(size());
  Om_by_ = s_by_ = Eigen::RowVectorXd::Zero(columns);
  F_by_ = tau_by_ = f_by_ = kinematic_by_ = Matrix::Zero(n, columns);
  tau_ = Eigen::VectorXd::Zero(n);
  matrix_ = Matrix::Zero(unknowns, unknowns + 1);
  solution_ = Eigen::VectorXd::Zero(unknowns);
}

Core Particle::core_of(std::span<const double> y) const noexcept {
  Core core;
  if (!layout_.has_core()) return core;
  const auto at = y.subspan(layout_.core(), Layout::k_core_size);
  core.C << at[0], at[3], at[4], at[3], at[1], at[5], at[4], at[5], at[2];
  core.e = at[6];
  return core;
}

double Particle::carried(std::size_t i, std::span<const double> y) const noexcept {
  double sum = 0.0;
  for (std::size_t d = 0; d < layout_.directions(); ++d) sum += lines_.arm(i)[ix(d)] * y[layout_.centre(d)];
  return sum;
}

void Particle::rest_centre(std::span<const double> y) noexcept {
  for (std::size_t d = 0; d < layout_.directions(); ++d) rest_[ix(d)] = y[layout_.centre(d)];
}

// --- the equations at a state

void Particle::evaluate(std::span<const double> y) {
  const Core core = core_of(y);
  for (std::size_t d = 0; d < layout_.directions(); ++d) centre_[ix(d)] = y[layout_.centre(d)];
  evaluate_contacts(y, core);
  evaluate_core(core);
  evaluate_yield();
  evaluate_coupling();
}

/// Dents, coverage and forces; derivatives by the flow of the core are added with its direction.
void Particle::evaluate_contacts(std::span<const double> y, const Core& core) {
  Om_ = 0.0;
  for (std::size_t i = 0; i < size(); ++i) {
    ClassState& c = classes_[i];
    const double square = normals_[i].dot(core.C * normals_[i]);
    const double zeta = y[layout_.dent(i)];
    if (!(square > 0.0) || !(zeta > 0.0)) throw std::domain_error("the core or a dent of the particle has no size");
    c.l = std::sqrt(square);
    if (zeta != c.dent.zeta) c.dent = dent_of(material_, zeta);
    c.advance = advance_of(c.l);
    Om_ += 0.5 * counts_[i] * (zeta * zeta - material_.a_Y * material_.a_Y) / square;
  }
  const double m = 1.0 - k::m2 * Om_ * Om_ + k::m4 * raised<4>(Om_);
  m_by_Om_ = -2.0 * k::m2 * Om_ + 4.0 * k::m4 * raised<3>(Om_);
  for (std::size_t i = 0; i < size(); ++i) {
    ClassState& c = classes_[i];
    c.coordinate = y[layout_.coordinate(i)];
    c.contact = c.takes_force ? contact_under(material_, c.dent, c.l, m, c.coordinate)
                              : contact_at(material_, c.dent, c.l, m, c.coordinate);
  }
}

/// Adds a quantity's derivatives to a row, in all of which its surroundings have a part.
void Particle::add(std::size_t i, const Slopes& by, Eigen::Ref<Eigen::RowVectorXd> row, double factor) const {
  const auto n = ix(size());
  row[ix(i)] += factor * by.coordinate;
  row[n + ix(i)] += factor * by.zeta;
  row[2 * n] += factor * by.l * l_by_flow_[i];
  row += factor * by.m * m_by_Om_ * Om_by_;
}

/// Load of the core, its direction, and with it derivatives of the forces.
void Particle::evaluate_core(const Core& core) {
  const auto n = ix(size());
  Matrix3d T = Matrix3d::Zero();
  for (std::size_t i = 0; i < size(); ++i) {
    load_[i] = deviator(symmetric(core.C * spreads_[i])) * (-classes_[i].advance.c_l / classes_[i].l);
    T += classes_[i].contact.F * load_[i];
  }
  const double size_of_T = 0.5 * std::sqrt(1.5 * contraction(T, T));
  const bool is_loaded = layout_.has_core() && size_of_T > k_no_load * material_.Y;
  S_ = material_.Y * (k::s0 + k::s1 * core.e);
  s_ = is_loaded ? size_of_T : 0.0;
  const double use = s_ / S_;
  Q_ = raised<k::n2>(use);
  flow_ = {Matrix3d::Zero(), 0.0};
  if (is_loaded) {
    const double pace = static_cast<double>(k::n2) / k::n1 * Q_ / s_;
    const Matrix3d M = pace * 0.375 / s_ * T;
    flow_.C = -(M * core.C + core.C * M);
    flow_.e = 0.5 * pace;
  }

  Om_by_.setZero();
  for (std::size_t i = 0; i < size(); ++i) {
    const ClassState& c = classes_[i];
    l_by_flow_[i] = normals_[i].dot(flow_.C * normals_[i]) / (2.0 * c.l);
    const double square = c.l * c.l;
    const double grown = c.dent.zeta * c.dent.zeta - material_.a_Y * material_.a_Y;
    Om_by_[n + ix(i)] = counts_[i] * c.dent.zeta / square;
    Om_by_[2 * n] -= counts_[i] * grown / (square * c.l) * l_by_flow_[i];
  }
  F_by_.setZero();
  for (std::size_t i = 0; i < size(); ++i) add(i, classes_[i].contact.F_by, F_by_.row(ix(i)), 1.0);

  s_by_.setZero();
  tau_by_.setZero();
  tau_.setZero();
  if (!is_loaded) return;
  Matrix3d T_by_flow = Matrix3d::Zero();
  for (std::size_t i = 0; i < size(); ++i) {
    const ClassState& c = classes_[i];
    const double w = -c.advance.c_l / c.l;
    const double w_l = (c.advance.c_l / c.l - c.advance.c_ll) / c.l;
    push_[i] = 0.375 / s_ * contraction(T, load_[i]);
    s_by_ += push_[i] * F_by_.row(ix(i));
    T_by_flow += c.contact.F * (w_l / w * l_by_flow_[i] * load_[i] + w * deviator(symmetric(flow_.C * spreads_[i])));
  }
  s_by_[2 * n] += 0.375 / s_ * contraction(T, T_by_flow);
  const double unit = 1.0 / (4.0 / 3.0 * s_);
  for (std::size_t i = 0; i < size(); ++i) {
    const Vector3d& normal = normals_[i];
    tau_[ix(i)] = unit * normal.dot(T * normal);
    auto row = tau_by_.row(ix(i));
    for (std::size_t j = 0; j < size(); ++j) row += unit * normal.dot(load_[j] * normal) * F_by_.row(ix(j));
    row[2 * n] += unit * normal.dot(T_by_flow * normal);
    row -= tau_[ix(i)] / s_ * s_by_;
  }
}

/// Which contacts drive the core and which it carries, how weak those are, and the yield functions.
void Particle::evaluate_yield() {
  const auto n = ix(size());
  const double use = s_ / S_;
  const double S_by_flow = material_.Y * k::s1 * flow_.e;
  // d(s/S)
  Eigen::RowVectorXd use_by = s_by_ / S_;
  use_by[2 * n] -= use * S_by_flow / S_;
  f_by_.setZero();
  for (std::size_t i = 0; i < size(); ++i) {
    ClassState& c = classes_[i];
    const double z = std::clamp(-2.0 * tau_[ix(i)], 0.0, 1.0);
    const double b = z * z * (3.0 - 2.0 * z);
    c.driving = 1.0 - b;
    c.X = 0.0;
    c.f = -1.0;
    if (!(c.contact.F > 0.0)) continue;
    const double small = std::exp(-c.contact.alpha / k::ab);
    const double weakness = k::beta * raised<k::n3>(use) * b * small;
    const double wk = 1.0 - weakness;
    const double ratio = c.contact.F_over_H / wk;
    c.X = raised<k::n1>(ratio);
    const double sum = c.X + Q_;
    if (!(sum > 0.0)) continue;
    c.f = std::pow(sum, 1.0 / k::n1) - 1.0;
    // Derivatives: dX = n1 X (dF/F - dH/H - dwk/wk), dQ = n2 (s/S)^(n2-1) d(s/S).
    const double outer = (1.0 + c.f) / (k::n1 * sum);
    const double of_X = outer * k::n1 * c.X;
    auto row = f_by_.row(ix(i));
    row += of_X / c.contact.F * F_by_.row(ix(i));
    add(i, c.contact.H_by, row, -of_X / c.contact.H);
    row += outer * k::n2 * raised<k::n2 - 1>(use) * use_by;
    if (weakness == 0.0) continue;
    const double of_weakness = of_X / wk;
    row += of_weakness * k::beta * b * small * k::n3 * raised<k::n3 - 1>(use) * use_by;
    if (z < 1.0)
      row += of_weakness * k::beta * raised<k::n3>(use) * small * (-12.0 * z * (1.0 - z)) * tau_by_.row(ix(i));
    add(i, c.contact.alpha_by, row, -of_weakness * weakness / k::ab);
  }
}

/// Right sides of (K), and the stored energy.
void Particle::evaluate_coupling() {
  const auto n = ix(size());
  const double Om3 = raised<3>(Om_);
  const double shade = 1.0 / (1.0 + k::kap * Om3 * Om_);
  const double shade_by_Om = -4.0 * k::kap * Om3 * shade * shade;
  kinematic_by_.setZero();
  stored_ = 0.0;
  for (std::size_t i = 0; i < size(); ++i) {
    ClassState& c = classes_[i];
    auto row = kinematic_by_.row(ix(i));
    double lift = 0.0;
    double lift_by_Om = 0.0;
    for (std::size_t j = 0; j < size(); ++j) {
      const ClassState& other = classes_[j];
      const Coupling& g = coupling_[i * size() + j];
      const double root = std::sqrt(c.dent.Gam * other.dent.Gam);
      const double of_root = g.same + g.mixed * shade;
      const double G = g.mixed + g.across * shade + root * of_root;
      const double F = other.contact.F;
      lift += G * F;
      lift_by_Om += (g.across + root * g.mixed) * shade_by_Om * F;
      row -= G * F_by_.row(ix(j));
      const double by_root = 0.5 * root * of_root * F;
      row[n + ix(i)] -= by_root * c.dent.Gam_zeta / c.dent.Gam;
      row[n + ix(j)] -= by_root * other.dent.Gam_zeta / other.dent.Gam;
    }
    row -= lift_by_Om * Om_by_;
    add(i, c.contact.u_by, row, 1.0);
    row[n + ix(i)] += c.dent.h_zeta;
    row[2 * n] += c.advance.c_l * l_by_flow_[i];
    c.kinematic = c.dent.h + c.advance.c + c.contact.u - lift;
    stored_ += counts_[i] * (c.contact.stored - 0.5 * c.contact.F * lift);
  }
}

// --- solving them

void Particle::residual(double xi, std::span<double> residual) const {
  for (std::size_t i = 0; i < size(); ++i) {
    const ClassState& c = classes_[i];
    residual[layout_.coordinate(i)] =
        c.takes_force ? c.coordinate - c.drive.value(xi) : c.kinematic - lines_.arm(i).dot(centre_) - c.drive.value(xi);
    residual[layout_.dent(i)] = c.flows ? -c.f : 0.0;
  }
  for (std::size_t d = 0; d < layout_.directions(); ++d) {
    double sum = k_weak_spring * (centre_ - rest_)[ix(d)];
    for (std::size_t i = 0; i < size(); ++i) sum += counts_[i] * lines_.arm(i)[ix(d)] * classes_[i].contact.F;
    residual[layout_.centre(d)] = sum;
  }
}

/// The linear equations of all unknowns up to the core, and of Lam in the last place, without right side.
void Particle::assemble() {
  const auto n = ix(size());
  const Eigen::Index lambda = matrix_.rows() - 1;
  matrix_.setZero();
  for (std::size_t i = 0; i < size(); ++i) {
    const ClassState& c = classes_[i];
    auto first = matrix_.row(ix(i));
    if (c.takes_force) {
      first[ix(i)] = 1.0;
    } else {
      first.head(2 * n) = kinematic_by_.row(ix(i)).head(2 * n);
      first[lambda] = kinematic_by_(ix(i), 2 * n);
      for (Eigen::Index d = 0; d < lambda - 2 * n; ++d) first[2 * n + d] = -lines_.arm(i)[d];
    }
    auto second = matrix_.row(n + ix(i));
    if (c.flows) {
      second.head(2 * n) = -f_by_.row(ix(i)).head(2 * n);
      second[lambda] = -f_by_(ix(i), 2 * n);
    } else {
      second[n + ix(i)] = 1.0;
    }
    for (Eigen::Index d = 0; d < lambda - 2 * n; ++d) {
      auto balance = matrix_.row(2 * n + d);
      const double weight = counts_[i] * lines_.arm(i)[d];
      balance.head(2 * n) += weight * F_by_.row(ix(i)).head(2 * n);
      balance[lambda] += weight * F_by_(ix(i), 2 * n);
    }
    if (c.flows) matrix_(lambda, n + ix(i)) = -pace_of_core(i);
  }
  for (Eigen::Index d = 2 * n; d < lambda; ++d) matrix_(d, d) += k_weak_spring;
  matrix_(lambda, lambda) = 1.0;
}

/// Lam per rate of a dent that flows.
double Particle::pace_of_core(std::size_t i) const noexcept {
  const ClassState& c = classes_[i];
  return c.X > 0.0 ? counts_[i] * c.contact.F * c.driving / c.X * c.dent.h_zeta : 0.0;
}

/// Gauss's elimination of the first unknowns, with the right side in the last column. The matrix is near one with a
/// positive diagonal, so that rows keep their order.
/// @return the least pivot of the walls and the core; not positive if any other pivot is not
double Particle::eliminate(Eigen::Index count) {
  const Eigen::Index right = matrix_.cols() - 1;
  const auto n = ix(size());
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index c = 0; c < count; ++c) {
    const double pivot = matrix_(c, c);
    const bool is_order_one = c < n || c == right - 1;
    if (is_order_one || !(pivot > 0.0)) least = std::min(least, pivot);
    if (pivot == 0.0) throw DomainError(Limit::applicability);
    for (Eigen::Index r = c + 1; r < count; ++r) {
      const double factor = matrix_(r, c) / pivot;
      if (factor == 0.0) continue;
      for (Eigen::Index j = c + 1; j < count; ++j) matrix_(r, j) -= factor * matrix_(c, j);
      matrix_(r, right) -= factor * matrix_(c, right);
    }
  }
  for (Eigen::Index r = count - 1; r >= 0; --r) {
    double sum = matrix_(r, right);
    for (Eigen::Index c = r + 1; c < count; ++c) sum -= matrix_(r, c) * solution_[c];
    solution_[r] = sum / matrix_(r, r);
  }
  return least;
}

void Particle::solve(double xi, std::span<double> y) {
  const auto count = static_cast<std::size_t>(matrix_.rows() - 1);
  const Eigen::Index right = matrix_.cols() - 1;
  std::vector<double> rest(count), before(y.begin(), y.end());
  double largest = 0.0;
  for (const ClassState& c : classes_) {
    if (!c.takes_force) largest = std::max(largest, std::abs(c.drive.value(xi)));
  }
  const auto error_at = [&] {
    evaluate(y);
    residual(xi, rest);
    double error = 0.0;
    for (const double value : rest) error = std::max(error, std::abs(value));
    return error;
  };
  double error = error_at();
  for (int i = 0; i < k_most_corrections && error > 0.0; ++i) {
    assemble();
    for (std::size_t r = 0; r < count; ++r) matrix_(ix(r), right) = -rest[r];
    eliminate(ix(count));
    double share = 1.0;
    for (std::size_t j = 0; j < size(); ++j) {
      const double growth = std::abs(solution_[ix(layout_.dent(j))]);
      if (growth * share > k_most_growth) share = k_most_growth / growth;
    }
    std::ranges::copy(y, before.begin());
    double next = 0.0;
    int halvings = 0;
    for (; halvings < k_most_halvings; ++halvings, share *= 0.5) {
      for (std::size_t r = 0; r < count; ++r) y[r] = before[r] + share * solution_[ix(r)];
      for (std::size_t j = 0; j < size(); ++j)
        y[layout_.dent(j)] = std::max(y[layout_.dent(j)], k_least_dent * material_.a_Y);
      next = error_at();
      if (next < error) break;
    }
    if (halvings == k_most_halvings) {
      std::ranges::copy(before, y.begin());
      error = error_at();
      break;
    }
    error = next;
  }
  if (!(error <= k_solved * std::max(largest, material_.Y))) throw DomainError(Limit::no_solution);
}

double Particle::rates(std::span<double> dy) {
  assemble();
  const Eigen::Index right = matrix_.cols() - 1;
  for (std::size_t i = 0; i < size(); ++i) matrix_(ix(i), right) = classes_[i].drive.rate();
  for (Eigen::Index r = ix(size()); r < right; ++r) matrix_(r, right) = 0.0;
  const double least = eliminate(right);
  for (std::size_t r = 0; r < layout_.core(); ++r) dy[r] = solution_[ix(r)];
  if (layout_.has_core()) {
    const double Lam = solution_[right - 1];
    const Matrix3d C = Lam * flow_.C;
    const std::array<double, Layout::k_core_size> core{C(0, 0), C(1, 1), C(2, 2),      C(0, 1),
                                                       C(0, 2), C(1, 2), Lam * flow_.e};
    std::ranges::copy(core, dy.begin() + static_cast<std::ptrdiff_t>(layout_.core()));
  }
  return least;
}

double Particle::rate_of(Eigen::Ref<const Eigen::RowVectorXd> row) const {
  const Eigen::Index n = 2 * ix(size());
  return row.head(n).dot(solution_.head(n).transpose()) + row[n] * solution_[solution_.size() - 1];
}

double Particle::yield_rate(std::size_t i) const { return rate_of(f_by_.row(ix(i))); }

double Particle::power() const {
  const Eigen::Index first = 2 * ix(size());
  double sum = 0.0;
  for (std::size_t i = 0; i < size(); ++i) {
    const ClassState& c = classes_[i];
    double speed = c.drive.rate();
    if (c.takes_force) {
      speed = rate_of(kinematic_by_.row(ix(i)));
      for (Eigen::Index d = 0; d < lines_.dimension(); ++d) speed -= lines_.arm(i)[d] * solution_[first + d];
    }
    sum += counts_[i] * c.contact.F * speed;
  }
  return sum;
}

double Particle::flow_rate(std::span<const double> dy) const noexcept {
  double Lam = 0.0;
  for (std::size_t i = 0; i < size(); ++i) {
    if (classes_[i].flows) Lam += pace_of_core(i) * dy[layout_.dent(i)];
  }
  return Lam;
}

}  // namespace monograin::cel
