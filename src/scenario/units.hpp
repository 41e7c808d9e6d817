/// Unit strings: which units each dimension knows, and what a text such as "10 mm" is in SI.
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

/// A dimension as users meet it in files and messages.
struct DimensionInfo {
  Dimension dimension = Dimension::none;
  std::string_view noun;      ///< with its article: "a stress"
  std::string_view si;        ///< SI unit; empty for a pure number
  std::string_view example;   ///< as written in a file
  std::string_view relative;  ///< unit that contains the initial radius ("R0", "R0/s"); empty where there is none
  double smallest = 0.0;      ///< the least, where zero is out, and
  double largest = 0.0;       ///< the greatest magnitude [SI] that is taken for meant
  std::span<const Unit> units;
};

[[nodiscard]] const DimensionInfo& dimension_info(Dimension dimension) noexcept;

/// Whether a text is a unit of the dimension.
[[nodiscard]] bool is_unit_of(std::string_view text, Dimension dimension) noexcept;

/// The part of `range` that is physically plausible; bounds are finite.
///
/// Huge and tiny values come from slips of unit or sign and would only fail later, far from the line that caused them.
[[nodiscard]] Range plausible_range(Dimension dimension, Range range) noexcept;

/// "a length from 1e-12 m to 1e+06 m"
[[nodiscard]] std::string describe(Dimension dimension, const Range& range);

struct ParsedQuantity {
  std::optional<double> value;  ///< SI; none where the text is not a quantity of that dimension
  std::string problem;          ///< then: what is wrong and what is expected
  std::string unit{};           ///< as it was given
};

/// Reads a number followed by a unit, independently of the locale.
///
/// @param initial_radius  length of the unit R0 [m]; none where R0 cannot be used
[[nodiscard]] ParsedQuantity parse_quantity(std::string_view text, Dimension dimension,
                                            std::optional<double> initial_radius);

}  // namespace monograin
