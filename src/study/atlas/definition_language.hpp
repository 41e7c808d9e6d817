/// The language of definitions of figures: every key with its kind, range, default and meaning.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "scenario/language.hpp"

namespace monograin::definition {

using Keys = std::vector<KeySpec>;

/// Words in the order of the enumerators they stand for.
inline constexpr std::array<std::string_view, 6> k_styles{"phases", "solid",       "dashed",
                                                          "dotted", "dash-dotted", "points"};
inline constexpr std::array<std::string_view, 3> k_rows{"all", "load", "unload"};

/// Measures by which a table compares a curve with its reference. A table without `measures` has the first
/// k_default_measures of them.
inline constexpr std::array<std::string_view, 14> k_measures{
    "reversal",           "area_error",     "peak_error", "slope", "reference_slope", "slope_ratio", "residual",
    "reference_residual", "residual_ratio", "coverage",   "up_to", "largest",         "rms",         "unloading"};
inline constexpr std::size_t k_default_measures = 10;

inline constexpr const char* k_example_x = "\"axial.displacement / R0\"";
inline constexpr const char* k_example_y = "\"axial.force / (E * R0^2)\"";

/// The definition as a whole.
[[nodiscard]] Keys root_keys();
/// A panel.
[[nodiscard]] Keys panel_keys();
/// Curves of a panel, and the curve of a comparison.
[[nodiscard]] Keys curve_keys();
/// What a key of the scenario is varied over.
[[nodiscard]] Keys vary_keys();
/// What a key of the scenario runs through within one curve.
[[nodiscard]] Keys sweep_keys();
/// The range of t in a formula.
[[nodiscard]] Keys parameter_keys();
/// The part of the abscissa to which a law was fitted.
[[nodiscard]] Keys fitted_keys();
/// Points of a panel, and those of a comparison.
[[nodiscard]] Keys points_keys();
/// The phase diagrams of adhesion.
[[nodiscard]] Keys adhesion_map_keys();
/// A table of comparisons.
[[nodiscard]] Keys comparison_table_keys();
/// One row of such a table.
[[nodiscard]] Keys comparison_keys();
/// A quantity that every row of such a table is asked for.
[[nodiscard]] Keys quantity_keys();
/// A table of values.
[[nodiscard]] Keys value_table_keys();
/// One row of such a table.
[[nodiscard]] Keys value_keys();
/// What such a value is held against.
[[nodiscard]] Keys reference_keys();

}  // namespace monograin::definition
