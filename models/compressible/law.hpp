/// Contact law of a compressible plastic particle: first loading by a wall, and unloading.
///
/// d is the displacement of a wall over R0 and f its force over pi R0^2 sigma_y0, sigma_y0 the hydrostatic yield
/// pressure at the reference density; work is over pi R0^3 sigma_y0. Every contact depends on its own wall alone.
/// Source: Edmans and Sinka (n.d.), eqs. 6 and 9 to 14.
#pragma once

#include <span>
#include <utility>
#include <vector>

namespace monograin::compressible {

/// Displacement over R0 at which the source's data end, and the law with them.
inline constexpr double k_largest_displacement = 0.5;

/// First loading (Edmans and Sinka, n.d., eq. 6):
///
///   f = k d                           up to delta_t
///   f = k delta_t exp(a (d - delta_t))  beyond
///
/// Continuous; the slope jumps by k (a delta_t - 1) at delta_t.
struct LoadingLaw {
  double stiffness = 1.0;   ///< k > 0
  double transition = 0.1;  ///< delta_t > 0, over R0; from 0.5 on there is no second part
  double exponent = 1.0;    ///< a > 0
};

/// @throws std::invalid_argument naming the number that is not above zero, or not finite
[[nodiscard]] LoadingLaw make_loading_law(double stiffness, double transition, double exponent);

/// The two parts of the law.
enum class Part { linear, exponential };

/// Force by the formula of one part, also outside of that part; slope_in() gives its derivative with respect to d.
[[nodiscard]] double force_in(const LoadingLaw& law, Part part, double displacement) noexcept;
[[nodiscard]] double slope_in(const LoadingLaw& law, Part part, double displacement) noexcept;
/// Work from first touch to a displacement, by the formula of one part, also outside of that part.
[[nodiscard]] double work_in(const LoadingLaw& law, Part part, double displacement) noexcept;

/// Part of the law that holds at a displacement; at delta_t the exponential one.
[[nodiscard]] Part part_at(const LoadingLaw& law, double displacement) noexcept;
[[nodiscard]] double loading_force(const LoadingLaw& law, double displacement) noexcept;
[[nodiscard]] double loading_work(const LoadingLaw& law, double displacement) noexcept;
/// Displacement of the first loading under a force >= 0.
[[nodiscard]] double displacement_under(const LoadingLaw& law, double force) noexcept;

/// Stiffness k_H of Hertz's law f = k_H d^(3/2) for the same material (eq. 10).
/// @param stiffness_ratio  E0/sigma_y0 > 0
/// @param poisson_ratio    nu0 in (-1, 1)
[[nodiscard]] double hertz_stiffness(double stiffness_ratio, double poisson_ratio) noexcept;

// --- unloading

/// Shape of the unloading curve from a largest displacement.
struct UnloadingShape {
  double exponent = 1.5;         ///< alpha >= 1
  double stiffness_ratio = 1.0;  ///< beta > 0: secant stiffness of the unloading over that of Hertz (eq. 11)
};

/// A shape and the largest displacement over R0 it belongs to.
struct UnloadingNode {
  double largest = 0.0;
  UnloadingShape shape;
};

/// The shape as a function of the largest displacement: linear between nodes, constant outside of them.
class UnloadingRule {
 public:
  /// Hertz's shape everywhere.
  UnloadingRule() : UnloadingRule(UnloadingShape{}) {}
  /// One shape everywhere.
  explicit UnloadingRule(UnloadingShape shape) : nodes_{{0.0, shape}} {}
  /// @param nodes  with ascending largest displacements; at least one
  explicit UnloadingRule(std::vector<UnloadingNode> nodes) : nodes_(std::move(nodes)) {}

  [[nodiscard]] UnloadingShape at(double largest) const noexcept;
  [[nodiscard]] std::span<const UnloadingNode> nodes() const noexcept { return nodes_; }

 private:
  std::vector<UnloadingNode> nodes_;
};

/// A row of a table of unloadings: material, largest displacement, shape.
struct UnloadingRow {
  double stiffness_over_shear = 1.0;  ///< E0/Gamma0 > 0, the number that governs the shape (source, section 6.3)
  UnloadingNode node;
};

/// Unloading rule of one material: bilinear in ln(E0/Gamma0) and the largest displacement, constant outside the rows.
/// Materials of the table need not have the same displacements.
/// @throws std::invalid_argument without rows
[[nodiscard]] UnloadingRule interpolated_rule(std::span<const UnloadingRow> rows, double stiffness_over_shear);

/// Curve of unloading, and of reloading, from a largest displacement (eq. 13):
///
///   f = fm ((d - d0)/(dm - d0))^alpha,   d0 = dm - h/beta,   h = (fm/k_H)^(2/3)
///
/// This law keeps d0 at or above 0 (added to the source). At small d its linear part is stiffer than Hertz's law, so
/// that the surface would otherwise recover beyond its original position.
struct UnloadingCurve {
  double largest = 0.0;     ///< dm
  double force = 0.0;       ///< fm > 0
  double length = 1.0;      ///< dm - d0 > 0
  double exponent = 1.5;    ///< alpha
  bool is_clipped = false;  ///< d0 would have been below 0

  [[nodiscard]] double separation() const noexcept { return largest - length; }  ///< d0
};

/// @param largest  dm > 0
[[nodiscard]] UnloadingCurve unloading_from(const LoadingLaw& law, double hertz_stiffness, const UnloadingRule& rule,
                                            double largest) noexcept;

/// Force on the curve. Below d0 the curve continues as an odd function of d - d0. Where (d - d0)/(dm - d0) exceeds 2 in
/// magnitude, it continues along its tangent.
[[nodiscard]] double unloading_force(const UnloadingCurve& curve, double displacement) noexcept;
[[nodiscard]] double unloading_slope(const UnloadingCurve& curve, double displacement) noexcept;
/// Work that the contact returns from a displacement d >= d0 to its opening.
[[nodiscard]] double recoverable_work(const UnloadingCurve& curve, double displacement) noexcept;
/// Displacement under a force from 0 to fm.
[[nodiscard]] double unloading_displacement(const UnloadingCurve& curve, double force) noexcept;

/// Slope of the unloading over that of the loading at dm. A cycle certainly dissipates if the ratio is at least 1.
[[nodiscard]] double slope_ratio(const LoadingLaw& law, const UnloadingCurve& curve) noexcept;

}  // namespace monograin::compressible
