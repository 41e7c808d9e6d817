/// The language of definitions of figures: every key with its kind, range, default and meaning.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "scenario/language.hpp"

namespace monograin::definition {

using Keys = std::vector<KeySpec>;

/// Words in the order of their enumerators.
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

/// Keys of the definition as a whole.
[[nodiscard]] Keys root_keys();
/// Keys of a panel.
[[nodiscard]] Keys panel_keys();
/// Keys of the curves of a panel, and of the curve of a comparison.
[[nodiscard]] Keys curve_keys();
/// Keys of `vary`, which gives a curve for each value of a scenario's key.
[[nodiscard]] Keys vary_keys();
/// Keys of `sweep`, in which a scenario's key passes a range within one curve.
[[nodiscard]] Keys sweep_keys();
/// Keys of the range of t in a formula.
[[nodiscard]] Keys parameter_keys();
/// Keys of the part of the abscissa to which a law was fitted.
[[nodiscard]] Keys fitted_keys();
/// Keys of the points of a panel, and of those of a comparison.
[[nodiscard]] Keys points_keys();
/// Keys of the phase diagrams of adhesion.
[[nodiscard]] Keys adhesion_map_keys();
/// Keys of a table of comparisons.
[[nodiscard]] Keys comparison_table_keys();
/// Keys of one row of a table of comparisons.
[[nodiscard]] Keys comparison_keys();
/// Keys of a quantity that every row of a table of comparisons has.
[[nodiscard]] Keys quantity_keys();
/// Keys of a table of values.
[[nodiscard]] Keys value_table_keys();
/// Keys of one row of a table of values.
[[nodiscard]] Keys value_keys();
/// Keys of the file with which a value is compared.
[[nodiscard]] Keys reference_keys();

}  // namespace monograin::definition
