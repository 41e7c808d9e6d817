#include "mdr/free_centre.hpp"

#include <Eigen/Eigenvalues>

namespace monograin::mdr {

void FreeCentre::sum_up() noexcept {
  force_.setZero();
  stiffness_.setZero();
  for (std::size_t line = 0; line < loads_.size(); ++line) {
    Load& load = loads_[line];
    const CentreVector& direction = lines_.line_direction(line);
    if (load.stiffness == 0.0) load.stiffness = load.regularized_stiffness;
    force_ += load.force * direction;
    stiffness_ += load.stiffness * direction * direction.transpose();
  }
}

void FreeCentre::keep_stiffness() noexcept {
  for (Load& load : loads_) load.stiffness_at_last_step = load.stiffness;
}

CentreVector FreeCentre::step_along(double Load::*stiffness, double Load::*force) const {
  if (loads_.size() == 1) {
    const Load& only = loads_.front();
    return only.*stiffness == 0.0 ? CentreVector::Zero()
                                  : CentreVector(-(only.*force) / only.*stiffness * lines_.line_direction(0));
  }
  return lines_.displacement_that_balances(
      stiffest_directions(stiffness), [&](std::size_t line) { return loads_[line].*stiffness; },
      [&](std::size_t line) { return loads_[line].*force; });
}

CentreMatrix FreeCentre::unconstrained_directions() const {
  CentreMatrix unconstrained = CentreMatrix::Zero();
  for (int k = 0; k < free_directions(); ++k) unconstrained(k, k) = 1.0;
  const CentreMatrix basis = stiffest_directions(&Load::present);
  return unconstrained - basis * basis.transpose();
}

CentreStiffness FreeCentre::softest_direction() const {
  // In this basis the stiffness of a soft direction is not lost in the round-off of a stiff one.
  const CentreMatrix basis = stiffest_directions(&Load::reference);
  CentreMatrix present = CentreMatrix::Zero();
  CentreMatrix reference = CentreMatrix::Zero();
  for (std::size_t line = 0; line < loads_.size(); ++line) {
    const CentreVector at = lines_.components(basis, line);
    present += loads_[line].present * at * at.transpose();
    reference += loads_[line].reference * at * at.transpose();
  }
  for (int k = 0; k < 3; ++k) {
    if (reference(k, k) == 0.0) present(k, k) = reference(k, k) = 1.0;
  }
  const CentreVector scale = reference.diagonal().cwiseSqrt().cwiseInverse();
  const CentreMatrix numerator = scale.asDiagonal() * present * scale.asDiagonal();
  const CentreMatrix denominator = scale.asDiagonal() * reference * scale.asDiagonal();
  const Eigen::GeneralizedSelfAdjointEigenSolver<CentreMatrix> solver(numerator, denominator);
  return {solver.eigenvalues()[0], basis * scale.cwiseProduct(solver.eigenvectors().col(0))};
}

}  // namespace monograin::mdr
