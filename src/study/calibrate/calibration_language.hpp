/// The language of calibration files: every key with its kind, range, default and meaning.
#pragma once

#include <array>
#include <optional>
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
inline constexpr std::array<std::string_view, 4> k_intervals{"auto", "covariance", "profile", "bootstrap"};
inline constexpr std::string_view k_noise = "noise";  ///< weighting by a known noise
inline constexpr std::array<std::string_view, 2> k_decimals{".", ","};
inline constexpr std::array<std::string_view, 2> k_unit_rows{"row", "none"};
inline constexpr std::string_view k_data = "data.";  ///< begins the keys of the machine among the free parameters
inline constexpr std::string_view k_offset = "data.offset";          ///< as a free parameter
inline constexpr std::string_view k_compliance = "data.compliance";  ///< as a free parameter

/// The calibration as a whole. @param scenario_is_table  whether the scenario stands in the file itself
[[nodiscard]] Keys root_keys(bool scenario_is_table, bool data_is_list);
/// How keys of the measured data are written that may be written in several ways.
struct DataKinds {
  KeySpec::Kind x = KeySpec::Kind::text;  ///< text, integer, table
  KeySpec::Kind y = KeySpec::Kind::text;
  KeySpec::Kind weight_column = KeySpec::Kind::text;  ///< text, integer
  KeySpec::Kind units = KeySpec::Kind::choice;        ///< choice, texts
  KeySpec::Kind compliance = KeySpec::Kind::text;     ///< text, quantity, table
};
/// The measured data.
[[nodiscard]] Keys data_keys(const DataKinds& kinds);
/// A table of the machine's own deflection.
[[nodiscard]] Keys deflection_keys();
/// A column whose heading does not tell what it holds. @param column  text or integer
[[nodiscard]] Keys column_keys(KeySpec::Kind column);
/// The parameters that are sought among a scenario's numbers.
[[nodiscard]] Keys free_keys(const std::vector<NumberKey>& numbers);
/// Numbers of the machine, which may be sought, too: first touch and the give of its frame.
[[nodiscard]] std::vector<NumberKey> machine_keys();
/// One of the parameters. @param from, to, start  quantity; text for a compliance with its unit
[[nodiscard]] Keys bounds_keys(const NumberKey& number, const std::array<KeySpec::Kind, 3>& kinds);
/// The dimension of a measured column, by its SI unit; none for columns of pure numbers.
[[nodiscard]] std::optional<Dimension> dimension_of(std::string_view si);
/// The free parameters of which something is known beforehand. @param paths  of the free parameters
[[nodiscard]] Keys prior_keys(const std::vector<std::string>& paths);
/// The knowledge of one of them: one of three distributions.
[[nodiscard]] Keys distribution_keys();
/// The noise of y. @param dimension  of y  @param column  text or integer
[[nodiscard]] Keys noise_keys(Dimension dimension, KeySpec::Kind column);
/// How the fit is made.
[[nodiscard]] Keys fit_keys();

}  // namespace monograin::calibration
