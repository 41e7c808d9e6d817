/// Tolerances by which every room decides that a value is zero, or that two values are equal, and limits of iterations.
#pragma once

#include <limits>

namespace monograin {

/// Quiet NaN: marks a quantity that is undefined, such as the pressure of an open contact.
inline constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double k_infinity = std::numeric_limits<double>::infinity();
/// Distance from 1 to the next double.
inline constexpr double k_epsilon = std::numeric_limits<double>::epsilon();

/// Relative round-off of a value that comes from a few operations.
inline constexpr double k_round_off = 4.0 * k_epsilon;
/// Relative change of a value whose square is round-off: a quantity that is stationary there does not show it, and a
/// step of Newton's method of that size is the last one.
inline constexpr double k_root_of_round_off = 1e-8;
/// Relative difference of two computed values that are equal: their round-off adds up over some thousand operations.
inline constexpr double k_same_value = 1e-12;
/// Relative difference of two numbers of a scenario that are equal: people write them with fewer digits.
inline constexpr double k_same_number = 1e-9;

/// Overlap over R0 below which there is nothing but round-off: a wall's distance from the centre has the round-off of
/// R0, which is 1e-16, and leaves an overlap of this size four digits.
inline constexpr double k_resolution = 1e-12;

/// Angle [rad] between equal directions, or difference of their components.
inline constexpr double k_same_direction = 1e-9;
/// Component of unit normals, or length of their mean, that is none. Stiffness goes with its square, which is then at
/// the round-off of the others' stiffness.
inline constexpr double k_no_direction = 1e-6;
/// Force, or net force, over the sum or the largest of the forces, that is none.
inline constexpr double k_no_net_force = 1e-9;
/// Stiffness, over the greatest one, that is round-off.
inline constexpr double k_no_stiffness = 1e-12;
/// Rate of a wall, a contact or a force, over the largest such rate, that is none: an error of integration, or
/// round-off of a balance of forces.
inline constexpr double k_at_rest = 1e-9;
/// Margin to a fold, 1 far from it and 0 at it, at which the fold counts as reached: no state exists beyond, so that a
/// guard that is zero there could not be located. The margin is the square root of the distance, of which 1e-10 is
/// left.
inline constexpr double k_margin_of_fold = 1e-5;

/// Distance of two step coordinates that are the same instant, and largest value of a guard that is zero: guards are of
/// the order of one, and both come from some hundred operations.
inline constexpr double k_same_instant = 1e-13;
inline constexpr double k_zero_guard = 1e-13;
/// Step coordinate ahead of an instant at which the mode that begins is read.
inline constexpr double k_ahead = 1e-9;

// Limits of iterations. They bound the work where there is no solution; none decides about a result.

/// Steps of Newton's method. Quadratic convergence needs ten, halving of the error 52.
inline constexpr int k_most_newton_steps = 100;
/// Halvings of a step or of an interval, of which k_same_value is left.
inline constexpr int k_most_halvings = 40;

}  // namespace monograin
