/// Units of each dimension, and the conversion of texts such as "10 mm" to SI.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "catalogue.hpp"

namespace monograin {

struct Unit {
  std::string_view symbol;
  double factor = 1.0;  ///< SI value of one unit
};

/// Names, limits and units of a dimension, for files and messages.
struct DimensionInfo {
  Dimension dimension = Dimension::none;
  std::string_view noun;      ///< with its article: "a stress"
  std::string_view si;        ///< SI unit; empty for a pure number
  std::string_view example;   ///< as written in a file
  std::string_view relative;  ///< unit that contains the initial radius ("R0", "R0/s"); empty if there is none
  double smallest = 0.0;      ///< least plausible magnitude [SI], except zero
  double largest = 0.0;       ///< largest plausible magnitude [SI]
  std::span<const Unit> units;
};

/// All dimensions, a pure number first.
[[nodiscard]] std::span<const DimensionInfo> dimensions() noexcept;

[[nodiscard]] const DimensionInfo& dimension_info(Dimension dimension) noexcept;

/// SI unit of a dimension as headings and lists have it: "-" for a pure number.
[[nodiscard]] std::string si_unit(Dimension dimension);

/// True if a text is a unit of the dimension.
[[nodiscard]] bool is_unit_of(std::string_view text, Dimension dimension) noexcept;

/// The part of `range` that is physically plausible; bounds are finite.
///
/// Huge and tiny values result from mistakes in unit or sign, and would only fail later, far from their line.
[[nodiscard]] Range plausible_range(Dimension dimension, Range range) noexcept;

/// "a length from 1e-12 m to 1e+06 m"
[[nodiscard]] std::string describe(Dimension dimension, const Range& range);

/// True if a text begins with a decimal number, with or without a sign.
[[nodiscard]] bool begins_a_number(std::string_view text);

struct ParsedQuantity {
  std::optional<double> value;  ///< SI; none if the text is not a quantity of that dimension
  std::string problem;          ///< without a value: the fault, and what is expected
  std::string unit{};           ///< as it was given
};

/// Reads a number followed by a unit, independently of the locale.
///
/// @param initial_radius  length of the unit R0 [m]; none if R0 cannot be used
[[nodiscard]] ParsedQuantity parse_quantity(std::string_view text, Dimension dimension,
                                            std::optional<double> initial_radius);

}  // namespace monograin
