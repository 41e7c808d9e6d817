#include "nonlocal/contacts.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "elastic/hertz.hpp"
#include "system/resolution.hpp"

namespace monograin::nonlocal {
namespace {

double require_poisson_ratio(double nu) {
  if (nu >= 0.0 && nu <= 0.5) return nu;
  throw std::invalid_argument("Poisson's ratio must be in [0, 0.5], but is " + std::to_string(nu));
}

/// Orthonormal basis of the span of the mean normals; the coordinate axes if they span all directions.
Eigen::Matrix3Xd basis_of(const Eigen::Matrix3Xd& normals, double least) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(normals, Eigen::ComputeThinU);
  const auto rank = (svd.singularValues().array() > least).count();
  if (rank == 3) return Eigen::Matrix3d::Identity();
  return svd.matrixU().leftCols(rank);
}

}  // namespace

Contacts::Contacts(const Formulation& model, std::span<const ContactClass> classes, Centre centre)
    : poisson_ratio_(require_poisson_ratio(model.poisson_ratio)),
      law_(model.terms),
      modulus_(monograin::composite_modulus(1.0, poisson_ratio_)),
      mean_normals_(classes.size(), Eigen::Vector3d::Zero()),
      at_(classes.size()),
      seen_(classes.size(), k_nan) {
  for (const ContactClass& c : classes) weights_.push_back(c.multiplicity());
  const std::vector<Wall> walls = walls_of(classes);
  const Eigen::MatrixXd influence = influence_of(model.influence, poisson_ratio_, walls, classes);
  coupling_ = coupling_of(influence, walls, classes);
  neighbours_ = neighbours_of(poisson_ratio_, walls, classes.size());
  rivalry_ = rivalry_of(influence, modulus_, walls, classes.size());
  has_modes_of_walls_ = walls.size() > classes.size() && has_negative_coupling(influence);
  std::vector<std::size_t> class_of;
  for (const Wall& wall : walls) class_of.push_back(wall.contact_class);
  // With positive couplings the critical mode is positive (Perron), hence one of the classes. Classes of one wall each
  // have all modes of the walls.
  modes_ = Modes(influence, class_of, !has_modes_of_walls_);

  const Eigen::Matrix3Xd mean_normals = mean_normals_of(classes);
  directions_ = centre == Centre::free ? basis_of(mean_normals, k_same_direction) : Eigen::Matrix3Xd(3, 0);
  const Eigen::MatrixXd components = mean_normals.transpose() * directions_;
  for (std::size_t j = 0; j < classes.size(); ++j)
    mean_normals_[j].head(components.cols()) = components.row(as_index(j)).transpose();
}

Eigen::Vector3d Contacts::centre_of(std::span<const double> y) const {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  std::copy_n(y.begin() + static_cast<std::ptrdiff_t>(class_count()), free_count(), centre.begin());
  return centre;
}

double Contacts::approach_by_centre(std::size_t j, std::span<const double> y) const noexcept {
  double sum = 0.0;
  for (std::size_t k = 0; k < free_count(); ++k) sum += mean_normals_[j][as_index(k)] * y[class_count() + k];
  return sum;
}

const Evaluation& Contacts::evaluate(std::span<const double> y) {
  const auto squares = y.first(class_count());
  if (std::ranges::equal(squares, seen_)) return at_;
  seen_[0] = k_nan;  // if an evaluation throws, none is kept
  // Zeros of both signs are equal and share an evaluation: the sum with zero makes both positive.
  for (std::size_t j = 0; j < class_count(); ++j) at_.set(j, law_, modulus_, y[j] + 0.0);
  std::ranges::copy(squares, seen_.begin());
  return at_;
}

double Contacts::lift_by_forces(std::size_t j, std::span<const double> forces) const noexcept {
  double sum = 0.0;
  for (std::size_t h = 0; h < class_count(); ++h) sum += coupling_(as_index(j), as_index(h)) * forces[h];
  return sum;
}

double Contacts::lift(std::size_t j, std::span<const double> forces, std::span<const double> y) const noexcept {
  double sum = lift_by_forces(j, forces);
  for (std::size_t k = 0; k < free_count(); ++k) sum += mean_normals_[j][as_index(k)] * y[class_count() + k];
  return sum;
}

Eigen::Vector3d Contacts::net_force(std::span<const double> forces) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t j = 0; j < class_count(); ++j) sum += weights_[j] * forces[j] * mean_normals_[j];
  return sum;
}

double Contacts::margin(std::span<const double> y) { return modes_.margin(evaluate(y).stiffness); }

double Contacts::least_pivot(std::span<const double> y, double shift) {
  return modes_.least_pivot(evaluate(y).stiffness, shift);
}

double Contacts::branch_reach(std::size_t index, double signed_square) const noexcept {
  // A quarter of the s at which walls push each other off, or half of the present one.
  return std::max(0.25 * rivalry_[index], 0.5 * std::abs(signed_square));
}

void Contacts::contacts(std::span<const double> y, std::span<ContactState> states) {
  evaluate(y);
  for (std::size_t j = 0; j < class_count(); ++j) {
    states[j] = {.displacement = at_.local[j].approach - lift(j, at_.forces, y),
                 .approach = at_.local[j].approach,
                 .signed_square = y[j],
                 .contact_radius = at_.local[j].contact_radius,
                 .force = at_.forces[j],
                 .stiffness = at_.stiffness[j]};
  }
}

double Contacts::deformed_radius(RadiusRule rule, std::size_t index, std::span<const double> y) {
  evaluate(y);
  const double a = at_.local[index].contact_radius;
  if (a == 0.0 || rule == RadiusRule::none) return a;
  double sum = a + at_.forces[index] * local_radius_influence(poisson_ratio_, a);
  const RadiusInfluence influence(rule, poisson_ratio_, a);
  for (const Neighbours& alike : neighbours_[index]) {
    const double force = at_.forces[alike.contact_class];
    if (force > 0.0) sum += alike.count * force * influence(alike.angle, alike.quotient);
  }
  return sum;
}

double Contacts::energy(std::span<const double> y) {
  evaluate(y);
  double sum = 0.0;
  for (std::size_t j = 0; j < class_count(); ++j) {
    sum += weights_[j] * (modulus_ * law_.energy(y[j]) - 0.5 * at_.forces[j] * lift_by_forces(j, at_.forces));
  }
  return sum;
}

}  // namespace monograin::nonlocal
