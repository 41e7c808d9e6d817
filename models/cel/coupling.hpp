/// Influence of contacts on each other through the elastic sphere (docs/theory/cel.md, section 4).
#pragma once

#include <span>
#include <vector>

#include "system/walls.hpp"

namespace monograin::cel {

/// Influence of the forces on all walls of one class on a wall of another:
///   G = sum g(theta) [1 + c2 (root - 1)] [c2 + (1 - c2) shade],   c2 = cos^2 theta
/// with the product of the roots of both compliances and the factor of neighbours (Coverage::shade).
struct Coupling {
  double same = 0.0, mixed = 0.0, across = 0.0;  ///< sums of g c2^2, g c2 (1 - c2), g (1 - c2)^2

  [[nodiscard]] double G(double root, double shade) const noexcept {
    return mixed + across * shade + root * by_root(shade);
  }
  [[nodiscard]] double by_root(double shade) const noexcept { return same + mixed * shade; }
  [[nodiscard]] double by_shade(double root) const noexcept { return across + root * mixed; }
};

/// Couplings of every class to every other, row by row.
[[nodiscard]] std::vector<Coupling> couplings_of(double poisson_ratio, std::span<const ContactClass> classes);

}  // namespace monograin::cel
