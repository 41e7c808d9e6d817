/// Fits of the contact law to a force-displacement curve: the source's nested procedure, made exact; a joint fit of all
/// three parameters; and a fit of the unloading curve.
/// Source: Edmans and Sinka (n.d.), section 6.1 and eqs. 7, 8, 11 and 13.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "compressible/law.hpp"

namespace monograin::compressible {

/// Distance of a law from a curve; integrals are trapezoidal sums over the curve's own points.
struct FitErrors {
  double area = 0.0;  ///< sqrt( int (f_model - f)^2 dd ) / int f dd (eq. 7)
  double peak = 0.0;  ///< max |f_model - f| / f(d_max) (eq. 8, the absolute value added)
};

/// @param displacements  over R0, ascending; as many as forces
[[nodiscard]] FitErrors fit_errors(const LoadingLaw& law, std::span<const double> displacements,
                                   std::span<const double> forces);

struct LoadingFit {
  LoadingLaw law;
  FitErrors errors;
};

/// Fits a law by the nested procedure of the source. The area error determines delta_t; the points of the linear part
/// alone determine k; a is the best for these two. The source's Newton iteration fails where the area error has kinks,
/// at every point of the data; this function searches every interval of the data instead.
///
/// None for fewer than three points beyond d = 0, or if no point has a force above 0.
/// @param displacements  over R0, ascending, from 0 on;  @param forces  any unit
[[nodiscard]] std::optional<LoadingFit> fit_nested(std::span<const double> displacements,
                                                   std::span<const double> forces);

/// Fits all three parameters at once by the area error. The law is linear in k, so that only delta_t and a are searched
/// for. Returns `start` unless the new fit is better.
[[nodiscard]] LoadingFit fit_jointly(std::span<const double> displacements, std::span<const double> forces,
                                     const LoadingFit& start);

/// alpha and d0 of eq. 13 by least squares over the points above 2 % of fm; fm itself is not fitted.
struct UnloadingFit {
  double separation = 0.0;  ///< d0
  UnloadingShape shape;     ///< beta by eq. 11
};

/// @param displacements  of the unloading, over R0; the first is the largest, with force fm > 0
/// @param hertz_stiffness  k_H in the units of the forces
/// @return none for fewer than three points above 2 % of fm
[[nodiscard]] std::optional<UnloadingFit> fit_unloading(std::span<const double> displacements,
                                                        std::span<const double> forces, double hertz_stiffness);

}  // namespace monograin::compressible
