/// Newton's method for the state of a particle.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "cel/tangent.hpp"

namespace monograin::cel {

/// Residual, over the largest displacement, up to which a state is a solution; a contact whose yield function is as
/// near to zero is at yield.
inline constexpr double k_solved = 1e-9;

class Newton {
 public:
  /// Corrects a state for given core and dents of contacts that do not flow, and evaluates it.
  /// @param y  a state nearby
  /// @throws std::domain_error where there is no solution near that state
  void solve(Particle& p, double xi, std::span<double> y);

 private:
  [[nodiscard]] double error(const Particle& p, double xi);
  double correct(Particle& p, double xi, std::span<double> y, double bound);

  Tangent tangent_;
  Eigen::MatrixX2d residual_, correction_;  ///< first columns
  std::vector<double> before_;
};

}  // namespace monograin::cel
