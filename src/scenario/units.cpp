#include "scenario/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <numbers>
#include <string_view>
#include <system_error>

#include "scenario/words.hpp"

namespace monograin {
namespace {

constexpr double k_standard_gravity = 9.80665;                     // [m/s^2], exact by definition
constexpr double k_pound_force = 0.45359237 * k_standard_gravity;  // [N]

// The micro sign has two code points: U+00B5 (keyboards) and U+03BC (Greek letter).
constexpr std::array k_lengths{
    Unit{"m", 1.0},   Unit{"cm", 1e-2}, Unit{"mm", 1e-3}, Unit{"um", 1e-6},   Unit{"µm", 1e-6},
    Unit{"μm", 1e-6}, Unit{"nm", 1e-9}, Unit{"km", 1e3},  Unit{"in", 0.0254},
};
constexpr std::array k_stresses{Unit{"Pa", 1.0},
                                Unit{"kPa", 1e3},
                                Unit{"MPa", 1e6},
                                Unit{"GPa", 1e9},
                                Unit{"N/mm^2", 1e6},
                                Unit{"N/mm²", 1e6},
                                Unit{"psi", k_pound_force / (0.0254 * 0.0254)}};
constexpr std::array k_surface_energies{
    Unit{"J/m^2", 1.0},  Unit{"J/m²", 1.0}, Unit{"mJ/m^2", 1e-3},
    Unit{"mJ/m²", 1e-3}, Unit{"N/m", 1.0},  Unit{"mN/m", 1e-3},
};
constexpr std::array k_stiffnesses{
    Unit{"N/m", 1.0},  Unit{"kN/m", 1e3},  Unit{"MN/m", 1e6},  Unit{"GN/m", 1e9},  Unit{"mN/m", 1e-3},
    Unit{"N/mm", 1e3}, Unit{"kN/mm", 1e6}, Unit{"MN/mm", 1e9}, Unit{"nN/nm", 1.0}, Unit{"uN/um", 1.0},
};
constexpr std::array k_forces{
    Unit{"N", 1.0},
    Unit{"kN", 1e3},
    Unit{"MN", 1e6},
    Unit{"mN", 1e-3},
    Unit{"uN", 1e-6},
    Unit{"µN", 1e-6},
    Unit{"μN", 1e-6},
    Unit{"nN", 1e-9},
    Unit{"kgf", k_standard_gravity},
    Unit{"gf", 1e-3 * k_standard_gravity},
    Unit{"lbf", k_pound_force},
};
constexpr std::array k_times{
    Unit{"s", 1.0},   Unit{"ms", 1e-3}, Unit{"us", 1e-6},  Unit{"µs", 1e-6},
    Unit{"μs", 1e-6}, Unit{"ns", 1e-9}, Unit{"min", 60.0}, Unit{"h", 3600.0},
};
constexpr std::array k_velocities{
    Unit{"m/s", 1.0},   Unit{"cm/s", 1e-2}, Unit{"mm/s", 1e-3}, Unit{"um/s", 1e-6},          Unit{"µm/s", 1e-6},
    Unit{"μm/s", 1e-6}, Unit{"nm/s", 1e-9}, Unit{"km/s", 1e3},  Unit{"mm/min", 1e-3 / 60.0},
};
constexpr std::array k_force_rates{
    Unit{"N/s", 1.0},   Unit{"kN/s", 1e3},  Unit{"MN/s", 1e6},  Unit{"mN/s", 1e-3},
    Unit{"uN/s", 1e-6}, Unit{"µN/s", 1e-6}, Unit{"μN/s", 1e-6}, Unit{"nN/s", 1e-9},
};
constexpr std::array k_strain_rates{Unit{"1/s", 1.0}, Unit{"%/s", 1e-2}, Unit{"1/min", 1.0 / 60.0}};
constexpr std::array k_stress_rates{Unit{"Pa/s", 1.0}, Unit{"kPa/s", 1e3}, Unit{"MPa/s", 1e6}, Unit{"GPa/s", 1e9}};
constexpr std::array k_frequencies{Unit{"Hz", 1.0}, Unit{"mHz", 1e-3}, Unit{"kHz", 1e3}, Unit{"MHz", 1e6}};
constexpr std::array k_angles{Unit{"deg", std::numbers::pi / 180.0}, Unit{"rad", 1.0}};

// The limits admit grains from a nanometre to a kilometre, gels and diamond, and durations over 24 decades.
const std::array<DimensionInfo, 13> k_dimensions{{
    {Dimension::none, "a number", "", "0.3", "", 0.0, 1e100, {}},
    {Dimension::length, "a length", "m", "\"10 mm\"", "R0", 1e-12, 1e6, k_lengths},
    {Dimension::stress, "a stress", "Pa", "\"50 MPa\"", "", 1e-6, 1e18, k_stresses},
    {Dimension::surface_energy, "a surface energy", "J/m^2", "\"0.1 J/m^2\"", "", 1e-24, 1e24, k_surface_energies},
    {Dimension::stiffness, "a stiffness", "N/m", "\"100 kN/m\"", "", 1e-24, 1e24, k_stiffnesses},
    {Dimension::force, "a force", "N", "\"10 N\"", "", 1e-30, 1e30, k_forces},
    {Dimension::time, "a time", "s", "\"1 s\"", "", 1e-15, 1e18, k_times},
    {Dimension::velocity, "a velocity", "m/s", "\"1 mm/s\"", "R0/s", 1e-30, 1e24, k_velocities},
    {Dimension::force_rate, "a force rate", "N/s", "\"1 N/s\"", "", 1e-48, 1e45, k_force_rates},
    {Dimension::angle, "an angle", "rad", "\"37.5 deg\"", "", 1e-9, 1e3, k_angles},
    {Dimension::strain_rate, "a strain rate", "1/s", "\"0.1 1/s\"", "", 1e-30, 1e30, k_strain_rates},
    {Dimension::stress_rate, "a stress rate", "Pa/s", "\"1 MPa/s\"", "", 1e-24, 1e33, k_stress_rates},
    {Dimension::frequency, "a frequency", "Hz", "\"2 Hz\"", "", 1e-18, 1e15, k_frequencies},
}};

struct LeadingNumber {
  double value = 1.0;
  bool is_there = false;
  bool is_out_of_range = false;
  std::string_view rest{};
};

LeadingNumber split_number(std::string_view text) {
  // from_chars would also take "inf" and "nan", and refuses a leading plus.
  if (!begins_a_number(text)) return {.rest = text};
  if (text.front() == '+') text.remove_prefix(1);
  LeadingNumber number{.is_there = true};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number.value);
  number.is_out_of_range = error != std::errc{};
  number.rest = trimmed(text.substr(static_cast<std::size_t>(end - text.data())));
  return number;
}

std::string with_expectation(std::string problem, const DimensionInfo& info) {
  return fmt::format("{}; expected {}, for example {}", problem, info.noun, info.example);
}

std::optional<double> unit_factor(std::string_view symbol, const DimensionInfo& info,
                                  std::optional<double> initial_radius) {
  if (symbol == info.relative && !info.relative.empty()) return initial_radius;
  const auto found = std::ranges::find(info.units, symbol, &Unit::symbol);
  return found == info.units.end() ? std::nullopt : std::optional(found->factor);
}

/// A unit without what is often written otherwise: "n/mm2" of "N/mm^2".
std::string plain(std::string_view symbol) {
  std::string result;
  for (const char c : symbol) {
    if (c != '^') result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return result;
}

std::string unknown_unit(std::string_view symbol, const DimensionInfo& info) {
  if (symbol.empty()) return with_expectation("the unit is missing", info);
  if (symbol == info.relative) return with_expectation("the initial radius cannot be given in itself", info);
  if (symbol.starts_with(',')) return with_expectation("a decimal comma", info) + ", with a decimal point";
  const auto has_unit = [&](const DimensionInfo& other) { return is_unit_of(symbol, other.dimension); };
  if (const auto other = std::ranges::find_if(k_dimensions, has_unit); other != k_dimensions.end()) {
    const std::string_view noun = other->noun.substr(other->noun.find(' ') + 1);
    return with_expectation(fmt::format("'{}' is a unit of {}", shown(symbol), noun), info);
  }
  const auto meant =
      std::ranges::find_if(info.units, [&](const Unit& unit) { return plain(unit.symbol) == plain(symbol); });
  const std::string hint = meant != info.units.end() ? fmt::format("; did you mean '{}'?", meant->symbol) : "";
  return with_expectation(fmt::format("unknown unit '{}'", shown(symbol)), info) + hint;
}

}  // namespace

std::span<const DimensionInfo> dimensions() noexcept { return k_dimensions; }

const DimensionInfo& dimension_info(Dimension dimension) noexcept {
  return *std::ranges::find(k_dimensions, dimension, &DimensionInfo::dimension);
}

std::string si_unit(Dimension dimension) {
  const std::string_view si = dimension_info(dimension).si;
  return std::string(si.empty() ? "-" : si);
}

bool is_unit_of(std::string_view text, Dimension dimension) noexcept {
  const auto& units = dimension_info(dimension).units;
  return std::ranges::find(units, text, &Unit::symbol) != units.end();
}

bool begins_a_number(std::string_view text) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (!text.empty() && (text.front() == '+' || text.front() == '-')) text.remove_prefix(1);
  if (!text.empty() && text.front() == '.') text.remove_prefix(1);
  return !text.empty() && is_digit(text.front());
}

Range plausible_range(Dimension dimension, Range range) noexcept {
  const DimensionInfo& info = dimension_info(dimension);
  if (range.lower == 0.0 && range.lower_is_open && info.smallest > 0.0) {
    range.lower = info.smallest;
    range.lower_is_open = false;
  }
  range.lower = std::max(range.lower, -info.largest);
  range.upper = std::min(range.upper, info.largest);
  return range;
}

std::string describe(Dimension dimension, const Range& range) {
  const DimensionInfo& info = dimension_info(dimension);
  const std::string_view space = info.si.empty() ? "" : " ";
  const std::string lower = fmt::format("{:.6g}{}{}", range.lower, space, info.si);
  const std::string upper = fmt::format("{:.6g}{}{}", range.upper, space, info.si);
  if (!range.lower_is_open && !range.upper_is_open) return fmt::format("{} from {} to {}", info.noun, lower, upper);
  return fmt::format("{} {} {} and {} {}", info.noun, range.lower_is_open ? "above" : "of at least", lower,
                     range.upper_is_open ? "below" : "up to", upper);
}

ParsedQuantity parse_quantity(std::string_view text, Dimension dimension, std::optional<double> initial_radius) {
  const DimensionInfo& info = dimension_info(dimension);
  const std::string_view content = trimmed(text);
  const LeadingNumber number = split_number(content);
  if (number.is_out_of_range) {
    return {{}, with_expectation("the number is too large or too small", info)};
  }
  if (!number.is_there && (content.empty() || content != info.relative)) {
    return {{}, with_expectation("it does not begin with a number", info)};
  }
  const std::optional<double> factor = unit_factor(number.rest, info, initial_radius);
  if (!factor) return {{}, unknown_unit(number.rest, info)};
  return {number.value * *factor, {}, std::string(number.rest)};
}

}  // namespace monograin
