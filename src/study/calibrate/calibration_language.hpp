/// The language of calibration files: every key with its kind, range, default and meaning.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "scenario/language.hpp"
#include "scenario/numbers.hpp"

namespace monograin::calibration {

using Keys = std::vector<KeySpec>;

/// Words in the order of the enumerators they stand for.
inline constexpr std::array<std::string_view, 4> k_weights{"absolute", "relative", "column", "area"};
inline constexpr std::array<std::string_view, 4> k_losses{"linear", "huber", "soft-l1", "cauchy"};
inline constexpr std::array<std::string_view, 2> k_scales{"linear", "log"};

/// The calibration as a whole. @param scenario_is_table  whether the scenario stands in the file itself
[[nodiscard]] Keys root_keys(bool scenario_is_table, bool data_is_list);
/// The measured data. @param x_is_table, y_is_table  whether a column is described by a table
[[nodiscard]] Keys data_keys(bool x_is_table, bool y_is_table);
/// A column whose heading does not tell what it holds.
[[nodiscard]] Keys column_keys();
/// The parameters that are sought among a scenario's numbers.
[[nodiscard]] Keys free_keys(const std::vector<NumberKey>& numbers);
/// One of them.
[[nodiscard]] Keys bounds_keys(const NumberKey& number);
/// How the fit is made.
[[nodiscard]] Keys fit_keys();

}  // namespace monograin::calibration
