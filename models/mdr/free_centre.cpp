#include "mdr/free_centre.hpp"

#include <Eigen/Eigenvalues>

namespace monograin::mdr {

void FreeCentre::sum_up() noexcept {
  force_.setZero();
  stiffness_.setZero();
  for (std::size_t line = 0; line < loads_.size(); ++line) {
    Load& load = loads_[line];
    const CentreVector& direction = lines_.direction(line);
    if (load.stiffness == 0.0) load.stiffness = load.tangent_stiffness;
    force_ += load.force * direction;
    stiffness_ += load.stiffness * direction * direction.transpose();
  }
}

void FreeCentre::keep_stiffness() noexcept {
  for (Load& load : loads_) load.kept_stiffness = load.stiffness;
}

CentreVector FreeCentre::step_along(double Load::*stiffness, double Load::*force) const {
  if (loads_.size() == 1) {
    const Load& only = loads_.front();
    return only.*stiffness == 0.0 ? CentreVector::Zero()
                                  : CentreVector(-(only.*force) / only.*stiffness * lines_.direction(0));
  }
  return lines_.step(
      stiffest_directions(stiffness), [&](std::size_t line) { return loads_[line].*stiffness; },
      [&](std::size_t line) { return loads_[line].*force; });
}

CentreMatrix FreeCentre::unconstrained_directions() const {
  CentreMatrix unconstrained = CentreMatrix::Zero();
  for (int k = 0; k < count(); ++k) unconstrained(k, k) = 1.0;
  const CentreMatrix basis = stiffest_directions(&Load::held);
  return unconstrained - basis * basis.transpose();
}

CentreStiffness FreeCentre::softest_direction() const {
  // In this basis the stiffness of a soft direction is not lost in the round-off of a stiff one.
  const CentreMatrix basis = stiffest_directions(&Load::unsoftened);
  CentreMatrix held = CentreMatrix::Zero();
  CentreMatrix unsoftened = CentreMatrix::Zero();
  for (std::size_t line = 0; line < loads_.size(); ++line) {
    const CentreVector at = lines_.components(basis, line);
    held += loads_[line].held * at * at.transpose();
    unsoftened += loads_[line].unsoftened * at * at.transpose();
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
