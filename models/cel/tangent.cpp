#include "cel/tangent.hpp"

#include <algorithm>

#include "system/limit.hpp"

namespace monograin::cel {

/// Eigen's PartialPivLU takes 3.4 (two equations) to 1.2 (twenty) times the instructions of this loop.
double eliminate(RowMatrix& equations) {
  const Eigen::Index n = equations.rows();
  double sign = 1.0;
  for (Eigen::Index at = 0; at < n; ++at) {
    const double largest = equations.row(at).head(n).cwiseAbs().maxCoeff();
    if (!(largest > 0.0)) throw DomainError(Limit::applicability);
    equations.row(at) *= 1.0 / largest;
  }
  for (Eigen::Index at = 0; at < n; ++at) {
    Eigen::Index below = 0;
    equations.col(at).tail(n - at).cwiseAbs().maxCoeff(&below);
    if (below > 0) {
      equations.row(at).swap(equations.row(at + below));
      sign = -sign;
    }
    const double pivot = equations(at, at);
    if (pivot == 0.0) throw DomainError(Limit::applicability);
    if (pivot < 0.0) sign = -sign;
    for (Eigen::Index other = at + 1; other < n; ++other) {
      const double factor = equations(other, at) / pivot;
      if (factor != 0.0) equations.row(other).tail(n + 1 - at) -= factor * equations.row(at).tail(n + 1 - at);
    }
  }
  for (Eigen::Index at = n; at-- > 0;) {
    for (Eigen::Index other = at + 1; other < n; ++other)
      equations.row(at).tail<2>() -= equations(at, other) * equations.row(other).tail<2>();
    equations.row(at).tail<2>() *= 1.0 / equations(at, at);
  }
  return sign;
}

void Tangent::set(const Particle& p, bool core_flows) {
  const Layout& layout = p.layout();
  om_column_ = layout.core();
  lam_column_ = om_column_ + 1;
  residual_by_.resize(om_column_, om_column_ + 2);
  Om_by_.setZero(om_column_ + 2);
  l_by_flow_.setZero(p.size());
  pushes_by_flow_.setZero();
  for (std::size_t i = 0; i < p.size(); ++i) {
    const ClassState& c = p.classes[i];
    const double per_square = c.per_l * c.per_l;
    const double grown = c.dent.zeta * c.dent.zeta - p.material().a_Y * p.material().a_Y;
    Om_by_[layout.dent(i)] = c.count * c.dent.zeta * per_square;
    if (!core_flows) continue;
    const double phi_l = -(c.phi() + c.advance.c_ll) * c.per_l;
    l_by_flow_[i] = p.l_by_flow(i);
    Om_by_[lam_column_] -= c.count * grown * per_square * c.per_l * l_by_flow_[i];
    pushes_by_flow_ += c.contact.F * phi_l * l_by_flow_[i] * c.spread;
  }

  moving_.clear();
  flow_by_.setZero(om_column_);
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
    if (core_flows) flow_by_[layout.dent(i)] = p.classes[i].flow_by_dent;
  }
  const std::size_t n = moving_.size();
  equations_.resize(n, n + 2);
  for (std::size_t row = 0; row < n; ++row) {
    const double* by = &residual_by_(moving_[row], 0);
    const double by_Lam = by[lam_column_] + by[om_column_] * Om_by_[lam_column_];
    for (std::size_t column = 0; column < n; ++column) {
      const std::size_t j = moving_[column];
      equations_(row, column) = by[j] + by[om_column_] * Om_by_[j] + by_Lam * flow_by_[j];
    }
    if (row < p.size() && p.classes[row].is_force_controlled())
      equations_.row(row) = Eigen::RowVectorXd::Unit(n + 2, row);
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

std::span<double> Tangent::new_row(std::size_t equation) noexcept {
  const std::span row(&residual_by_(equation, 0), lam_column_ + 1);
  std::ranges::fill(row, 0.0);
  return row;
}

/// Adds the derivatives of a quantity of a contact, times a factor, to a row.
inline void Tangent::add(const Particle& p, std::size_t i, const Slopes& by, double factor,
                         std::span<double> row) const noexcept {
  row[i] += factor * by.coordinate;
  row[p.layout().dent(i)] += factor * by.zeta;
  row[om_column_] += factor * by.m * p.coverage().m_Om;
  row[lam_column_] += factor * by.l * l_by_flow_[i];
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
    row[om_column_] -= coupling.by_shade(root) * coverage.shade_Om * F;
  }
  add(p, i, c.contact.u_by, 1.0, row);
  row[p.layout().dent(i)] += c.dent.h_zeta;
  row[lam_column_] += c.advance.c_l * l_by_flow_[i];
  for (std::size_t k = 0; k < p.layout().directions; ++k)
    row[p.layout().centre(k)] = -p.centre.lines().mean_normal(i)[k];
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
    add(p, j, other.contact.F_by, -other.phi() * contraction(f.by_pushes, other.spread), row);
  }
  row[lam_column_] -= f.by_flow;
}

/// Rate of a residual.
double Tangent::rate_of(std::size_t equation, std::span<const double> rates) const noexcept {
  const double* by = &residual_by_(equation, 0);
  double rate = rates[om_column_] * (by[lam_column_] + by[om_column_] * Om_by_[lam_column_]);
  for (std::size_t j = 0; j < om_column_; ++j) rate += rates[j] * (by[j] + by[om_column_] * Om_by_[j]);
  return rate;
}

double Tangent::yield_rate(const Particle& p, std::size_t i, std::span<const double> rates) {
  add_yield(p, i);
  return -rate_of(p.layout().dent(i), rates);
}

}  // namespace monograin::cel
