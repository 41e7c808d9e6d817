#include "study/sweep/factor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>

#include "scenario/cells.hpp"
#include "scenario/units.hpp"
#include "scenario/words.hpp"

namespace monograin {
namespace {

using Kind = KeySpec::Kind;

constexpr double k_most_points = 1e6;
constexpr std::array<std::string_view, 2> k_scales{"linear", "log"};

/// The keys that say over what a key is varied.
std::vector<KeySpec> level_keys(const KeySpec& varied) {
  const auto bound = [&](std::string_view name, std::string_view meaning) {
    return KeySpec{.name = name,
                   .meaning = meaning,
                   .kind = Kind::quantity,
                   .dimension = varied.dimension,
                   .knows_initial_radius = varied.knows_initial_radius};
  };
  return {
      bound("from", "one end of a range"),
      bound("to", "the other end"),
      {.name = "points",
       .meaning = "number of points of a grid",
       .kind = Kind::integer,
       .range = {.lower = 2.0, .upper = k_most_points},
       .default_value = 5.0},
      {.name = "scale",
       .meaning = "how the range is divided",
       .kind = Kind::choice,
       .choices = {k_scales.begin(), k_scales.end()},
       .default_value = k_scales.front()},
      {.name = "values", .meaning = "these values", .kind = Kind::texts, .example = "[0.2, 0.3, 0.4]"},
  };
}

/// Whether a quantity is given in initial radii: it cannot be read without them.
[[nodiscard]] bool is_in_radii(std::string_view text, Dimension dimension) {
  return !parse_quantity(text, dimension, std::nullopt).value && parse_quantity(text, dimension, 1.0).value;
}

[[nodiscard]] ReadValue read_number(const KeySpec& spec, const std::string& text, const std::string& unit) {
  const std::optional<double> bare = number_in(text);
  if (bare && unit.empty()) return {FactorValue{.number = *bare}, {}};
  if (spec.dimension == Dimension::none) return {{}, "expected a number"};
  const std::string quantity = bare ? fmt::format("{} {}", text, unit) : text;
  const ParsedQuantity read =
      parse_quantity(quantity, spec.dimension, spec.knows_initial_radius ? std::optional(1.0) : std::nullopt);
  if (!read.value) return {{}, read.problem};
  return {FactorValue{.number = *read.value, .is_in_radii = is_in_radii(quantity, spec.dimension)}, {}};
}

/// Reads the table of one factor.
class LevelReader {
 public:
  LevelReader(Reading& reading, const toml::table& table, const SourceLocation& place, bool is_grid, Factor& factor)
      : faults_(reading.faults),
        table_(table),
        label_("\"" + factor.key + "\""),
        is_grid_(is_grid),
        factor_(factor),
        keys_(level_keys(factor.spec)),
        section_(reading, {&table, place, label_}, keys_) {}

  void read() {
    const bool has_range = section_.has_or_misspells("from") || section_.has_or_misspells("to");
    if (has_range == section_.has_or_misspells("values")) {
      return fault_at(section_.place(), fmt::format("expected either {} or {{ values = [...] }}", k_example_range));
    }
    has_range ? read_range() : read_list();
  }

 private:
  void fault_at(const SourceLocation& where, std::string_view problem) {
    faults_.add(where, fmt::format("{}: {}", label_, problem));
  }

  void read_range() {
    if (factor_.spec.kind != Kind::quantity) {
      return fault_at(section_.place(), "its values form no range; expected { values = [...] }");
    }
    if (section_.has("points") && !is_grid_) {
      fault_at(section_.key_place("points"), "key 'points' goes with design = \"grid\" only");
    }
    const auto from = bound("from");
    const auto to = bound("to");
    if (!from || !to) return;
    factor_.range = FactorRange{*from, *to, section_.text("scale") == "log",
                                static_cast<int>(section_.number("points").value_or(0.0))};
    if (*from == *to) fault_at(section_.value_place("to"), "from and to are equal; expected two values");
    if (from->is_in_radii != to->is_in_radii) {
      fault_at(section_.value_place("to"), "expected from and to both in R0, or neither");
    }
    if (factor_.range->is_logarithmic && !(from->number > 0.0 && to->number > 0.0)) {
      fault_at(section_.value_place("scale"), "a logarithmic range has no place for 0; expected from and to above 0");
    }
  }

  [[nodiscard]] std::optional<FactorValue> bound(std::string_view key) {
    if (!section_.has_or_misspells(key)) {
      fault_at(section_.place(), fmt::format("key '{}' is missing; expected for example {}", key, k_example_range));
    }
    const std::optional<double> number = section_.number(key);
    if (!number) return std::nullopt;
    const auto text = table_[key].value<std::string>();
    return FactorValue{.number = *number, .is_in_radii = text && is_in_radii(*text, factor_.spec.dimension)};
  }

  void read_list() {
    for (const std::string_view key : {"points", "scale"}) {
      if (section_.has(key)) fault_at(section_.key_place(key), fmt::format("key '{}' goes with a range only", key));
    }
    const std::vector<std::string> texts = section_.texts("values");
    std::set<FactorValue> seen;
    for (std::size_t i = 0; i < texts.size(); ++i) {
      const auto report = [&](std::string_view problem) {
        faults_.add(section_.value_place("values", i),
                    fmt::format("{} = {}: {}", factor_.key, shown(texts[i]), problem));
      };
      const auto [value, problem] = read_value(factor_.spec, texts[i], {});
      if (!value) {
        report(problem);
      } else if (!seen.insert(*value).second) {
        report("is there twice; expected different values");
      } else {
        factor_.values.push_back(*value);
      }
    }
  }

  FaultList& faults_;
  const toml::table& table_;
  std::string label_;
  bool is_grid_;
  Factor& factor_;
  std::vector<KeySpec> keys_;
  Section section_;
};

}  // namespace

FactorValue FactorRange::at(double share) const {
  if (share == 0.0) return from;
  if (share == 1.0) return to;
  FactorValue value = from;
  value.number = is_logarithmic ? from.number * std::pow(to.number / from.number, share)
                                : std::lerp(from.number, to.number, share);
  return value;
}

double FactorRange::share_of(double number) const {
  if (is_logarithmic) return std::log(number / from.number) / std::log(to.number / from.number);
  return (number - from.number) / (to.number - from.number);
}

bool Factor::is_number() const noexcept { return spec.kind == Kind::quantity || spec.kind == Kind::integer; }

bool Factor::is_toggle() const noexcept { return spec.kind == Kind::toggle || spec.kind == Kind::mark; }

std::string Factor::unit() const {
  if (!is_number()) return {};
  const std::string_view si = dimension_info(spec.dimension).si;
  return si.empty() ? "-" : std::string(si);
}

bool Factor::admits(const FactorValue& value) const {
  if (!range) return values.empty() || std::ranges::find(values, value) != values.end();
  const double share = range->share_of(value.number);
  return value.is_in_radii == range->from.is_in_radii && share >= 0.0 && share <= 1.0;
}

bool can_be_varied(Kind kind) noexcept {
  constexpr std::array k_kinds{Kind::text,   Kind::identifier, Kind::toggle,  Kind::mark,
                               Kind::choice, Kind::file,       Kind::integer, Kind::quantity};
  return std::ranges::find(k_kinds, kind) != k_kinds.end();
}

ReadValue read_value(const KeySpec& spec, const std::string& text, const std::string& unit) {
  switch (spec.kind) {
    case Kind::quantity:
    case Kind::integer:
      return read_number(spec, text, unit);
    case Kind::choice:
      // What is reserved is refused run by run: another model or configuration may have it.
      if (std::ranges::find(spec.choices, text) == spec.choices.end() &&
          std::ranges::find(spec.reserved, text) == spec.reserved.end()) {
        return {{}, fmt::format("expected {}{}", expectation(spec), did_you_mean(text, spec.choices))};
      }
      break;
    case Kind::toggle:
    case Kind::mark:
      if (text != "true" && text != "false") return {{}, "expected true or false"};
      break;
    case Kind::text:
    case Kind::identifier:
    case Kind::file:
    case Kind::pair:
    case Kind::instants:
    case Kind::direction:
    case Kind::texts:
    case Kind::table:
    case Kind::tables:
      // It will be a cell of the results, where nothing is quoted.
      if (text.empty() || text.find_first_of(",\"\r\n") != std::string::npos) {
        return {{}, "expected a text without commas, quotes and line breaks"};
      }
      break;
  }
  return {FactorValue{.word = text}, {}};
}

std::string unit_problem(const KeySpec& spec, const std::string& unit) {
  if (unit.empty()) return {};
  const DimensionInfo& info = dimension_info(spec.dimension);
  if (info.si.empty()) return fmt::format("'{}' has no unit; expected the key alone", spec.name);
  const auto radius = spec.knows_initial_radius ? std::optional(1.0) : std::nullopt;
  return parse_quantity("1 " + unit, info.dimension, radius).problem;
}

void read_levels(Reading& reading, const toml::table& table, const SourceLocation& place, bool is_grid,
                 Factor& factor) {
  LevelReader(reading, table, place, is_grid, factor).read();
}

}  // namespace monograin
