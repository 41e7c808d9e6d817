#include "cel/tangent.hpp"

#include <algorithm>
#include <cmath>

#include "system/limit.hpp"

namespace monograin::cel {

double eliminate(RowMatrix& equations) {
  const std::size_t n = equations.rows();
  const std::size_t end = n + 2;
  const auto row = [&](std::size_t i) { return &equations(i, 0); };
  double sign = 1.0;
  for (std::size_t i = 0; i < n; ++i) {
    double largest = 0.0;
    for (std::size_t j = 0; j < n; ++j) largest = std::max(largest, std::abs(row(i)[j]));
    if (!(largest > 0.0)) throw DomainError(Limit::applicability);
    const double scale = 1.0 / largest;
    for (std::size_t j = 0; j < end; ++j) row(i)[j] *= scale;
  }
  for (std::size_t at = 0; at < n; ++at) {
    std::size_t pivot = at;
    for (std::size_t i = at + 1; i < n; ++i) {
      if (std::abs(row(i)[at]) > std::abs(row(pivot)[at])) pivot = i;
    }
    double* const upper = row(at);
    if (pivot != at) {
      std::swap_ranges(upper + at, upper + end, row(pivot) + at);
      sign = -sign;
    }
    if (upper[at] == 0.0) throw DomainError(Limit::applicability);
    if (upper[at] < 0.0) sign = -sign;
    for (std::size_t i = at + 1; i < n; ++i) {
      double* const lower = row(i);
      const double factor = lower[at] / upper[at];
      if (factor == 0.0) continue;
      for (std::size_t j = at + 1; j < end; ++j) lower[j] -= factor * upper[j];
    }
  }
  for (std::size_t at = n; at-- > 0;) {
    for (std::size_t i = at + 1; i < n; ++i) {
      for (std::size_t j = n; j < end; ++j) row(at)[j] -= row(at)[i] * row(i)[j];
    }
    const double scale = 1.0 / row(at)[at];
    for (std::size_t j = n; j < end; ++j) row(at)[j] *= scale;
  }
  return sign;
}

void Tangent::set(const Particle& p, bool core_flows) {
  const Layout& layout = p.layout();
  Om_ = layout.core();
  Lam_ = Om_ + 1;
  residual_by_.resize(Om_, Om_ + 2);
  Om_by_.assign(Om_ + 2, 0.0);
  l_by_flow_.assign(p.size(), 0.0);
  pushes_by_flow_.setZero();
  for (std::size_t i = 0; i < p.size(); ++i) {
    const ClassState& c = p.classes[i];
    const double per_square = c.per_l * c.per_l;
    const double grown = c.dent.zeta * c.dent.zeta - p.material().a_Y * p.material().a_Y;
    Om_by_[layout.dent(i)] = c.count * c.dent.zeta * per_square;
    if (!core_flows) continue;
    const double w_l = -(c.w() + c.advance.c_ll) * c.per_l;
    l_by_flow_[i] = p.l_by_flow(i);
    Om_by_[Lam_] -= c.count * grown * per_square * c.per_l * l_by_flow_[i];
    pushes_by_flow_ += c.contact.F * w_l * l_by_flow_[i] * c.spread;
  }

  moving_.clear();
  pace_.assign(Om_, 0.0);
  for (std::size_t i = 0; i < p.size(); ++i) {
    add_kinematics(p, i);
    moving_.push_back(i);
  }
  for (std::size_t k = 0; k < layout.directions; ++k) {
    add_balance(p, k);
    moving_.push_back(layout.centre(k));
  }
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!p.classes[i].flows) continue;
    add_yield(p, i);
    moving_.push_back(layout.dent(i));
    if (core_flows) pace_[layout.dent(i)] = p.classes[i].pace;
  }
  const std::size_t n = moving_.size();
  equations_.resize(n, n + 2);
  for (std::size_t row = 0; row < n; ++row) {
    const double* by = &residual_by_(moving_[row], 0);
    const double by_Lam = by[Lam_] + by[Om_] * Om_by_[Lam_];
    for (std::size_t column = 0; column < n; ++column) {
      const std::size_t j = moving_[column];
      equations_(row, column) = by[j] + by[Om_] * Om_by_[j] + by_Lam * pace_[j];
    }
    if (row < p.size() && p.classes[row].takes_force()) equations_.row(row) = Eigen::RowVectorXd::Unit(n + 2, row);
  }
}

double Tangent::solve(const Eigen::MatrixX2d& right, Eigen::MatrixX2d& solutions) {
  const std::size_t n = moving_.size();
  for (std::size_t i = 0; i < n; ++i) equations_.row(i).tail<2>() = right.row(moving_[i]);
  const double sign = eliminate(equations_);
  solutions.setZero(right.rows(), 2);
  for (std::size_t i = 0; i < n; ++i) solutions.row(moving_[i]) = equations_.row(i).tail<2>();
  return sign;
}

std::span<double> Tangent::new_row(std::size_t place) noexcept {
  const std::span row(&residual_by_(place, 0), Lam_ + 1);
  std::ranges::fill(row, 0.0);
  return row;
}

/// Adds the derivatives of a quantity of a contact, times a factor, to a row.
inline void Tangent::add(const Particle& p, std::size_t i, const Slopes& by, double factor,
                         std::span<double> row) const noexcept {
  row[i] += factor * by.coordinate;
  row[p.layout().dent(i)] += factor * by.zeta;
  row[Om_] += factor * by.m * p.coverage().m_Om;
  row[Lam_] += factor * by.l * l_by_flow_[i];
}

/// Adds the derivatives of (K).
void Tangent::add_kinematics(const Particle& p, std::size_t i) {
  const std::span<double> row = new_row(i);
  const ClassState& c = p.classes[i];
  const Coverage& coverage = p.coverage();
  for (std::size_t j = 0; j < p.size(); ++j) {
    const ClassState& other = p.classes[j];
    const double F = other.contact.F;
    if (F == 0.0) continue;
    const Coupling& coupling = p.coupling(i, j);
    const double root = c.dent.root_Gam * other.dent.root_Gam;
    const double by_root = coupling.by_root(coverage.shade) * F;
    add(p, j, other.contact.F_by, -coupling.G(root, coverage.shade), row);
    row[p.layout().dent(i)] -= c.dent.root_Gam_zeta * other.dent.root_Gam * by_root;
    row[p.layout().dent(j)] -= c.dent.root_Gam * other.dent.root_Gam_zeta * by_root;
    row[Om_] -= coupling.by_shade(root) * coverage.shade_Om * F;
  }
  add(p, i, c.contact.u_by, 1.0, row);
  row[p.layout().dent(i)] += c.dent.h_zeta;
  row[Lam_] += c.advance.c_l * l_by_flow_[i];
  for (std::size_t k = 0; k < p.layout().directions; ++k) row[p.layout().centre(k)] = -p.centre.lines().arm(i)[k];
}

/// Adds the derivatives of an equation (E).
void Tangent::add_balance(const Particle& p, std::size_t equation) {
  const std::span<double> row = new_row(p.layout().centre(equation));
  for (std::size_t i = 0; i < p.size(); ++i) add(p, i, p.classes[i].contact.F_by, p.centre.by_force(equation, i), row);
  const Eigen::Vector3d by_centre = p.centre.by_centre(equation);
  for (std::size_t k = 0; k < p.layout().directions; ++k) row[p.layout().centre(k)] = by_centre[k];
}

/// Adds the derivatives of -f.
void Tangent::add_yield(const Particle& p, std::size_t i) {
  const std::span<double> row = new_row(p.layout().dent(i));
  const ClassState& c = p.classes[i];
  const YieldSlopes f = slopes_of(c.yield, c.contact, p.load(), c.wall, pushes_by_flow_);
  add(p, i, c.contact.F_by, -f.by_F, row);
  add(p, i, c.contact.H_by, -f.by_H, row);
  add(p, i, c.contact.alpha_by, -f.by_alpha, row);
  for (std::size_t j = 0; j < p.size(); ++j) {
    const ClassState& other = p.classes[j];
    add(p, j, other.contact.F_by, -other.w() * contraction(f.by_pushes, other.spread), row);
  }
  row[Lam_] -= f.by_flow;
}

/// Rate of a residual.
double Tangent::rate_of(std::size_t place, std::span<const double> rates) const noexcept {
  const double* by = &residual_by_(place, 0);
  double rate = rates[Om_] * (by[Lam_] + by[Om_] * Om_by_[Lam_]);
  for (std::size_t j = 0; j < Om_; ++j) rate += rates[j] * (by[j] + by[Om_] * Om_by_[j]);
  return rate;
}

double Tangent::yield_rate(const Particle& p, std::size_t i, std::span<const double> rates) {
  add_yield(p, i);
  return -rate_of(p.layout().dent(i), rates);
}

}  // namespace monograin::cel
