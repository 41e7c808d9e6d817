#include "mdr/free_centre.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace monograin::mdr {
namespace {

// Components of unit vectors that are round-off.
constexpr double k_no_component = 1e-15;

}  // namespace

FreeCentre::FreeCentre(std::span<const ContactClass> classes, bool is_free) {
  Eigen::Matrix3Xd means(3, static_cast<Eigen::Index>(classes.size()));
  for (std::size_t i = 0; i < classes.size(); ++i) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& normal : classes[i].normals) mean += normal;
    means.col(static_cast<Eigen::Index>(i)) = mean / classes[i].multiplicity();
  }
  if (is_free) {
    Eigen::ColPivHouseholderQR<Eigen::Matrix3Xd> qr(means);
    qr.setThreshold(k_no_direction);
    count_ = static_cast<int>(qr.rank());
    const Eigen::Matrix3d q = qr.householderQ();
    basis_.leftCols(count_) = q.leftCols(count_);
  }
  for (Eigen::Index i = 0; i < means.cols(); ++i) directions_.emplace_back(basis_.transpose() * means.col(i));
  find_lines();
  for (const CentreVector& direction : directions_) acts_.push_back(direction.norm() > k_no_direction);
}

/// Walls that align are on one line, and act on the centre along that only.
void FreeCentre::find_lines() {
  for (CentreVector& direction : directions_) {
    const double size = direction.norm();
    if (!(size > k_no_direction)) {
      on_lines_.push_back({});
      continue;
    }
    const CentreVector unit = direction / size;
    std::size_t line = 0;
    while (line < lines_.size()) {
      const CentreVector& other = lines_[line].direction;
      if ((unit - std::copysign(1.0, unit.dot(other)) * other).norm() <= k_no_direction) break;
      ++line;
    }
    if (line == lines_.size()) lines_.push_back({.direction = unit});
    const double along = std::copysign(size, unit.dot(lines_[line].direction));
    direction = along * lines_[line].direction;
    on_lines_.push_back({line, along});
  }
  if (lines_.empty()) lines_.emplace_back();  // of those that do not act along any
}

void FreeCentre::sum_up(double least_stiffness) noexcept {
  const bool is_first_touch = std::ranges::all_of(lines_, [](const Line& line) { return line.stiffness == 0.0; });
  force_.setZero();
  stiffness_.setZero();
  for (Line& line : lines_) {
    if (is_first_touch) line.stiffness = line.tangent_stiffness / least_stiffness;
    force_ += line.force * line.direction;
    stiffness_ += line.stiffness * line.direction * line.direction.transpose();
  }
}

void FreeCentre::keep_stiffness() noexcept {
  for (Line& line : lines_) line.kept_stiffness = line.stiffness;
}

/// Along the line along which the centre is stiffest, across it along the one that is stiffest there, and so on: in
/// these directions what stiff contacts do is nothing, not round-off, where only soft ones constrain it.
CentreMatrix FreeCentre::stiffest_directions(double Line::*stiffness) const {
  CentreMatrix basis = CentreMatrix::Zero();
  for (int k = 0; k < count_; ++k) {
    double most = 0.0;
    CentreVector next = CentreVector::Zero();
    for (const Line& line : lines_) {
      const CentreVector across = line.direction - basis * (basis.transpose() * line.direction);
      const double strength = std::abs(line.*stiffness) * across.squaredNorm();
      if (strength <= most || across.norm() <= k_no_direction) continue;
      most = strength;
      next = across;
    }
    if (most == 0.0) break;
    next.normalize();
    basis.col(k) = (next - basis * (basis.transpose() * next)).normalized();
  }
  return basis;
}

/// Components of the direction of a line, without round-off.
CentreVector FreeCentre::components(const CentreMatrix& basis, const Line& line) {
  const CentreVector raw = basis.transpose() * line.direction;
  return (raw.array().abs() > k_no_component).select(raw, 0.0);
}

CentreVector FreeCentre::step_along(double Line::*stiffness, double Line::*force) const {
  if (lines_.size() == 1) {
    const Line& only = lines_.front();
    return only.*stiffness == 0.0 ? CentreVector::Zero()
                                  : CentreVector(-(only.*force) / only.*stiffness * only.direction);
  }
  const CentreMatrix basis = stiffest_directions(stiffness);
  CentreMatrix sum = CentreMatrix::Zero();
  CentreVector load = CentreVector::Zero();
  CentreVector magnitudes = CentreVector::Zero();
  for (const Line& line : lines_) {
    const CentreVector at = components(basis, line);
    sum += line.*stiffness * at * at.transpose();
    load += line.*force * at;
    magnitudes += std::abs(line.*stiffness) * at.cwiseAbs2();
  }
  const CentreVector scale = (magnitudes.array() > 0.0).select(magnitudes.array().rsqrt(), 0.0);
  const Eigen::SelfAdjointEigenSolver<CentreMatrix> solver(scale.asDiagonal() * sum * scale.asDiagonal());
  const double threshold = 1e-12 * solver.eigenvalues().cwiseAbs().maxCoeff();
  CentreVector step = CentreVector::Zero();
  for (int k = 0; k < 3; ++k) {
    if (std::abs(solver.eigenvalues()[k]) <= threshold) continue;
    const CentreVector direction = scale.cwiseProduct(solver.eigenvectors().col(k));
    step -= direction * (direction.dot(load) / solver.eigenvalues()[k]);
  }
  return basis * step;
}

CentreMatrix FreeCentre::unconstrained_directions() const {
  CentreMatrix unconstrained = CentreMatrix::Zero();
  for (int k = 0; k < count_; ++k) unconstrained(k, k) = 1.0;
  const CentreMatrix basis = stiffest_directions(&Line::held);
  return unconstrained - basis * basis.transpose();
}

CentreStiffness FreeCentre::softest_direction() const {
  // The stiffness of one direction is not to be lost in the rounding of another's.
  const CentreMatrix basis = stiffest_directions(&Line::unsoftened);
  CentreMatrix held = CentreMatrix::Zero();
  CentreMatrix unsoftened = CentreMatrix::Zero();
  for (const Line& line : lines_) {
    const CentreVector at = components(basis, line);
    held += line.held * at * at.transpose();
    unsoftened += line.unsoftened * at * at.transpose();
  }
  for (int k = 0; k < 3; ++k) {
    if (unsoftened(k, k) == 0.0) held(k, k) = unsoftened(k, k) = 1.0;
  }
  const CentreVector scale = unsoftened.diagonal().cwiseSqrt().cwiseInverse();
  const CentreMatrix numerator = scale.asDiagonal() * held * scale.asDiagonal();
  const CentreMatrix denominator = scale.asDiagonal() * unsoftened * scale.asDiagonal();
  const Eigen::GeneralizedSelfAdjointEigenSolver<CentreMatrix> solver(numerator, denominator);
  return {solver.eigenvalues()[0], basis * scale.cwiseProduct(solver.eigenvectors().col(0))};
}

}  // namespace monograin::mdr
