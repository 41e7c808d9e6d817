#include "study/sweep/factor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/distributions/lognormal.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/triangular.hpp>
#include <cmath>
#include <initializer_list>
#include <set>
#include <string_view>

#include "scenario/cells.hpp"
#include "scenario/document.hpp"
#include "scenario/overrides.hpp"
#include "scenario/units.hpp"
#include "scenario/words.hpp"

namespace monograin {
namespace {

using Kind = KeySpec::Kind;

constexpr double k_most_values = 1e6;
constexpr std::array<std::string_view, 2> k_scales{"linear", "log"};

/// Keys of the table that gives the values of a varied key.
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
       .range = {.lower = 2.0, .upper = k_most_values},
       .default_value = 5.0},
      first_by_default(choice_key("scale", "how the range is divided", k_scales)),
      key_of(Kind::texts, "values", "these values", "[0.2, 0.3, 0.4]"),
      bound("mean", "mean of a normal distribution"),
      bound("std", "its standard deviation"),
      key_of(Kind::texts, "lognormal", "median and standard deviation of the logarithm of a log-normal distribution",
             "[0.3, 0.1]"),
      key_of(Kind::texts, "triangular", "lowest, likeliest and highest value of a triangular distribution",
             "[0.2, 0.3, 0.4]"),
  };
}

/// True if a quantity is given in initial radii, without which it cannot be read.
[[nodiscard]] bool is_in_radii(std::string_view text, Dimension dimension) {
  return !parse_quantity(text, dimension, std::nullopt).value && parse_quantity(text, dimension, 1.0).value;
}

/// A value as `--set` takes it.
[[nodiscard]] std::string text_of(const toml::node& node) {
  const auto text = node.value_exact<std::string>();
  return text ? in_quotes(*text) : shown(node);
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
  LevelReader(Reading& reading, const toml::table& table, const SourceLocation& place, Levels levels, Factor& factor)
      : faults_(reading.faults),
        table_(table),
        label_("\"" + factor.key + "\""),
        levels_(levels),
        factor_(factor),
        keys_(level_keys(factor.spec)),
        section_(reading, {&table, place, label_}, keys_) {}

  void read() {
    const auto has_any = [this](std::initializer_list<std::string_view> keys) {
      return std::ranges::any_of(keys, [this](std::string_view key) { return section_.has_or_misspells(key); });
    };
    const bool has_range = has_any({"from", "to"});
    const bool has_list = has_any({"values"});
    const std::array is_distribution{has_any({"mean", "std"}), has_any({"lognormal"}), has_any({"triangular"})};
    const auto distributions = std::ranges::count(is_distribution, true);
    if ((has_range ? 1 : 0) + (has_list ? 1 : 0) + distributions != 1) {
      return fault_at(section_.place(),
                      fmt::format("expected one of {}, {{ values = [...] }}, {{ mean, std }}, {{ lognormal = [median, "
                                  "standard deviation of the logarithm] }}, {{ triangular = [lowest, likeliest, "
                                  "highest] }}",
                                  k_example_range));
    }
    take_ends();
    if (has_range) return read_range();
    if (has_list) return read_list();
    if (!is_quantity()) return;
    if (levels_ != Levels::shares) {
      return fault_at(section_.place(),
                      "a distribution goes with design = \"sobol\", \"halton\", \"lhs\", \"random\", \"saltelli\" or "
                      "\"morris\" only");
    }
    refuse_keys_of_ranges();
    factor_.distribution.emplace();
    if (is_distribution[0]) return read_normal();
    read_parameters(is_distribution[1]);
  }

 private:
  void fault_at(const SourceLocation& where, std::string_view problem) {
    faults_.add(where, fmt::format("{}: {}", label_, problem));
  }

  /// Takes the first and the last value as they are written.
  void take_ends() {
    for (const std::string_view key : {"from", "to", "mean", "values", "lognormal", "triangular"}) {
      const toml::node* node = table_.get(key);
      if (node == nullptr) continue;
      const toml::array* list = node->as_array();
      if (list == nullptr) {
        factor_.ends.push_back(text_of(*node));
      } else if (!list->empty()) {
        factor_.ends.push_back(text_of(list->front()));
        if (key != "lognormal") factor_.ends.push_back(text_of(list->back()));
      }
    }
  }

  [[nodiscard]] bool is_quantity() {
    if (factor_.spec.kind == Kind::quantity) return true;
    fault_at(section_.place(), "its values form no range; expected { values = [...] }");
    return false;
  }

  void refuse_keys_of_ranges() {
    for (const std::string_view key : {"points", "scale"}) {
      if (section_.has(key)) fault_at(section_.key_place(key), fmt::format("key '{}' goes with a range only", key));
    }
  }

  void read_normal() {
    const auto mean = bound("mean");
    const auto deviation = bound("std");
    if (!mean || !deviation) return;
    if (mean->is_in_radii != deviation->is_in_radii) {
      fault_at(section_.value_place("std"), "expected mean and std both in R0, or neither");
    } else {
      section_.expect_like_units({"mean", "std"});
    }
    if (!(deviation->number > 0.0)) fault_at(section_.value_place("std"), "expected std above 0");
    *factor_.distribution = {
        FactorDistribution::Shape::normal, {mean->number, deviation->number, 0.0}, mean->is_in_radii};
  }

  /// Reads a log-normal or a triangular distribution.
  void read_parameters(bool is_lognormal) {
    const std::string_view key = is_lognormal ? "lognormal" : "triangular";
    const std::vector<std::string> texts = section_.texts(key);
    FactorDistribution& distribution = *factor_.distribution;
    distribution.shape = is_lognormal ? FactorDistribution::Shape::lognormal : FactorDistribution::Shape::triangular;
    const std::size_t count = is_lognormal ? 2 : 3;
    if (texts.size() != count) {
      return fault_at(section_.value_place(key), fmt::format("expected {} values", count));
    }
    std::array<FactorValue, 3> values{};
    KeySpec number{.name = key, .meaning = "a number", .kind = Kind::quantity};
    for (std::size_t k = 0; k < count; ++k) {
      const auto [value, problem] = read_value(is_lognormal && k == 1 ? number : factor_.spec, texts[k], {});
      if (!value) return fault_at(section_.value_place(key, k), fmt::format("{}: {}", shown(texts[k]), problem));
      values[k] = *value;
      distribution.parameters[k] = value->number;
    }
    if (!is_lognormal) section_.expect_like_units({key});
    distribution.is_in_radii = values[0].is_in_radii;
    const auto& [first, second, third] = distribution.parameters;
    if (is_lognormal) {
      if (!(first > 0.0 && second > 0.0)) fault_at(section_.value_place(key), "expected both values above 0");
    } else if (values[1].is_in_radii != values[0].is_in_radii || values[2].is_in_radii != values[0].is_in_radii) {
      fault_at(section_.value_place(key), "expected all values in R0, or none");
    } else if (!(first <= second && second <= third && first < third)) {
      fault_at(section_.value_place(key), "expected the lowest, the likeliest and the highest value in this order");
    }
  }

  void read_range() {
    if (!is_quantity()) return;
    if (section_.has("points") && levels_ != Levels::points) {
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
    } else {
      section_.expect_like_units({"from", "to"});
    }
    if (factor_.range->is_logarithmic && !(from->number > 0.0 && to->number > 0.0)) {
      fault_at(section_.value_place("scale"), "a logarithmic range has no place for 0; expected from and to above 0");
    }
  }

  [[nodiscard]] std::optional<FactorValue> bound(std::string_view key) {
    if (!section_.has_or_misspells(key)) {
      const bool is_of_range = key == "from" || key == "to";
      fault_at(section_.place(), fmt::format("key '{}' is missing; expected for example {}", key,
                                             is_of_range ? k_example_range : "{ mean = 0.3, std = 0.01 }"));
    }
    const std::optional<double> number = section_.number(key);
    if (!number) return std::nullopt;
    const auto text = table_[key].value<std::string>();
    return FactorValue{.number = *number, .is_in_radii = text && is_in_radii(*text, factor_.spec.dimension)};
  }

  void read_list() {
    refuse_keys_of_ranges();
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
  Levels levels_;
  Factor& factor_;
  std::vector<KeySpec> keys_;
  Section section_;
};

}  // namespace

FactorValue FactorRange::at(double share) const {
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

FactorValue FactorDistribution::at(double share) const {
  const auto& [first, second, third] = parameters;
  FactorValue value{.is_in_radii = is_in_radii};
  switch (shape) {
    case Shape::normal:
      value.number = boost::math::quantile(boost::math::normal(first, second), share);
      break;
    case Shape::lognormal:
      value.number = boost::math::quantile(boost::math::lognormal(std::log(first), second), share);
      break;
    case Shape::triangular:
      value.number = boost::math::quantile(boost::math::triangular(first, second, third), share);
      break;
  }
  return value;
}

FactorValue Factor::at(double share) const {
  if (range) return range->at(share);
  if (distribution) return distribution->at(share);
  const auto place = static_cast<std::size_t>(share * static_cast<double>(values.size()));
  return values[std::min(place, values.size() - 1)];
}

bool Factor::is_number() const noexcept { return spec.kind == Kind::quantity || spec.kind == Kind::integer; }

bool Factor::is_toggle() const noexcept { return spec.kind == Kind::toggle || spec.kind == Kind::mark; }

std::string Factor::unit() const {
  if (!is_number()) return {};
  const std::string_view si = dimension_info(spec.dimension).si;
  return si.empty() ? "-" : std::string(si);
}

bool Factor::admits(const FactorValue& value) const {
  if (distribution) return true;
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
      // A reserved choice is accepted here and refused run by run: another model or configuration may have it.
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
    case Kind::column:
    case Kind::pair:
    case Kind::instants:
    case Kind::direction:
    case Kind::texts:
    case Kind::table:
    case Kind::tables:
    case Kind::any:
      // The text becomes a cell of the results, where nothing is quoted.
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

void read_levels(Reading& reading, const toml::table& table, const SourceLocation& place, Levels levels,
                 Factor& factor) {
  LevelReader(reading, table, place, levels, factor).read();
}

std::vector<std::string> doubts_about(const ScenarioTemplate& scenario, std::span<const Factor> factors) {
  std::vector<std::string> first;
  std::vector<std::string> last;
  for (const Factor& factor : factors) {
    if (factor.ends.empty()) continue;
    first.push_back(fmt::format("{}={}", factor.key, factor.ends.front()));
    last.push_back(fmt::format("{}={}", factor.key, factor.ends.back()));
  }
  for (const auto& values : {last, first}) {
    try {
      if (std::vector<std::string> doubts = scenario.with(values).doubts; !doubts.empty()) return doubts;
    } catch (const ScenarioError&) {
      // These values do not go together, and need not.
    }
  }
  return {};
}

}  // namespace monograin
