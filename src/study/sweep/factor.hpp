/// Keys that are varied and the values they take. For readers of TOML files: includes the library.
#pragma once

#include <toml++/toml.h>

#include <array>
#include <compare>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenario/language.hpp"
#include "scenario/section.hpp"

namespace monograin {

inline constexpr std::string_view k_example_range = "{ from = 0.2, to = 0.48 }";

/// Value of a key that may be given in R0, whose length is not known yet.
struct FactorValue {
  double number = 0.0;       ///< in SI, or in initial radii
  bool is_in_radii = false;  ///< the number counts initial radii
  std::string word{};        ///< value of a key that is no number

  bool operator==(const FactorValue&) const = default;
  auto operator<=>(const FactorValue&) const = default;
};

/// All values between two.
struct FactorRange {
  FactorValue from;
  FactorValue to;
  bool is_logarithmic = false;
  int points = 2;  ///< of a grid

  /// The value at a share of the range, from 0 to 1; the ends are met exactly.
  [[nodiscard]] FactorValue at(double share) const;
  /// The share of the range at which a number lies.
  [[nodiscard]] double share_of(double number) const;
};

/// Values distributed by a probability distribution.
struct FactorDistribution {
  enum class Shape { normal, lognormal, triangular };

  Shape shape = Shape::normal;
  /// Mean and standard deviation; median and standard deviation of the logarithm; lowest, likeliest and highest value.
  std::array<double, 3> parameters{};
  bool is_in_radii = false;

  /// The quantile of a share. @param share  between 0 and 1
  [[nodiscard]] FactorValue at(double share) const;
};

/// A key with a range, a distribution or a list of values; with none of them if a table gives the values.
struct Factor {
  std::string key;  ///< path as of `--set`
  KeySpec spec;
  SourceLocation where;
  std::optional<FactorRange> range{};
  std::optional<FactorDistribution> distribution{};
  std::vector<FactorValue> values{};
  std::vector<std::string> ends{};  ///< some first and last value as `--set` takes it; empty: no text gives them

  /// The value at a share, between 0 and 1, of the range, the distribution or the list.
  [[nodiscard]] FactorValue at(double share) const;

  [[nodiscard]] bool is_number() const noexcept;
  [[nodiscard]] bool is_toggle() const noexcept;
  /// Unit of the values: SI, "-" for a pure number, empty for words.
  [[nodiscard]] std::string unit() const;
  /// True if the range or the list contains the value, or if there is neither.
  [[nodiscard]] bool admits(const FactorValue& value) const;
};

/// True if keys of a kind have a single value, which may differ between runs.
[[nodiscard]] bool can_be_varied(KeySpec::Kind kind) noexcept;

struct ReadValue {
  std::optional<FactorValue> value;
  std::string problem;  ///< if there is no value: what is expected instead
};

/// Reads a value as it is written in a list or a table; also a value out of range.
/// @param unit  of a bare number; empty: SI
[[nodiscard]] ReadValue read_value(const KeySpec& spec, const std::string& text, const std::string& unit);

/// Problem with the unit in a column's heading; empty: none. No unit means SI.
[[nodiscard]] std::string unit_problem(const KeySpec& spec, const std::string& unit);

/// Levels that a design needs of its factors.
enum class Levels {
  points,  ///< a grid: ranges are divided
  whole,   ///< ranges as they are
  shares,  ///< shares of a range, a list or a distribution
};

/// Sets the values over which a factor is varied from `{ from, to, points, scale }`, `{ mean, std }`, `{ lognormal }`,
/// `{ triangular }` or `{ values }`.
void read_levels(Reading& reading, const toml::table& table, const SourceLocation& place, Levels levels,
                 Factor& factor);

/// Doubts about the scenario with the last values that are written, or else with the first: numbers without a unit.
[[nodiscard]] std::vector<std::string> doubts_about(const ScenarioTemplate& scenario, std::span<const Factor> factors);

}  // namespace monograin
