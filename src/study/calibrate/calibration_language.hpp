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

/// Words in the order of their enumerators.
inline constexpr std::array<std::string_view, 4> k_weights{"absolute", "relative", "column", "area"};
inline constexpr std::array<std::string_view, 4> k_losses{"linear", "huber", "soft-l1", "cauchy"};
inline constexpr std::array<std::string_view, 2> k_scales{"linear", "log"};
inline constexpr std::array<std::string_view, 4> k_intervals{"auto", "covariance", "profile", "bootstrap"};
inline constexpr std::string_view k_noise = "noise";  ///< weighting by the given noise
inline constexpr std::array<std::string_view, 2> k_decimals{".", ","};
inline constexpr std::array<std::string_view, 2> k_unit_rows{"row", "none"};
inline constexpr std::string_view k_data = "data.";          ///< prefix of the machine's keys among the free parameters
inline constexpr std::string_view k_offset = "data.offset";  ///< as a free parameter
inline constexpr std::string_view k_force_offset = "data.force_offset";  ///< as a free parameter
inline constexpr std::string_view k_compliance = "data.compliance";      ///< as a free parameter

/// Keys of the calibration as a whole. @param scenario_is_table  true if the scenario stands in the file itself
[[nodiscard]] Keys root_keys(bool scenario_is_table, bool data_is_list);
/// Kinds of the keys of measured data that may be written in several forms.
struct DataKinds {
  KeySpec::Kind x = KeySpec::Kind::text;  ///< text, integer, table
  KeySpec::Kind y = KeySpec::Kind::text;
  KeySpec::Kind weight_column = KeySpec::Kind::text;  ///< text, integer
  KeySpec::Kind units = KeySpec::Kind::choice;        ///< choice, texts
  KeySpec::Kind compliance = KeySpec::Kind::text;     ///< text, quantity, table
};
/// Keys of the measured data.
[[nodiscard]] Keys data_keys(const DataKinds& kinds);
/// Keys of a table of the machine's own deflection.
[[nodiscard]] Keys deflection_keys();
/// Keys of a column whose heading does not name its quantity. @param column  text or integer
[[nodiscard]] Keys column_keys(KeySpec::Kind column);
/// Keys of the free parameters, out of a scenario's numbers.
[[nodiscard]] Keys free_keys(const std::vector<NumberKey>& numbers);
/// Numbers of the machine, which may be free, too: first touch, zero of the load cell, compliance of its frame.
[[nodiscard]] std::vector<NumberKey> machine_keys();
/// Keys of one free parameter. @param from, to, start  quantity; text for a compliance with its unit
[[nodiscard]] Keys bounds_keys(const NumberKey& number, const std::array<KeySpec::Kind, 3>& kinds);
/// Dimension of a measured column, by its SI unit; none for columns of pure numbers.
[[nodiscard]] std::optional<Dimension> dimension_of(std::string_view si);
/// Keys of the priors of free parameters. @param paths  of the free parameters
[[nodiscard]] Keys prior_keys(const std::vector<std::string>& paths);
/// Keys of one prior: one of three distributions.
[[nodiscard]] Keys distribution_keys();
/// Keys of the noise. @param of_x, of_y  dimensions  @param column  text or integer
[[nodiscard]] Keys noise_keys(Dimension of_x, Dimension of_y, KeySpec::Kind column);
/// Keys of the method of the fit.
[[nodiscard]] Keys fit_keys();

}  // namespace monograin::calibration
