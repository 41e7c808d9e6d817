#include "study/calibrate/parameter_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "scenario/cells.hpp"
#include "scenario/document.hpp"
#include "scenario/edit.hpp"
#include "scenario/plain_paths.hpp"
#include "scenario/text_file.hpp"
#include "scenario/units.hpp"
#include "scenario/words.hpp"
#include "study/calibrate/calibration_language.hpp"
#include "study/calibrate/data_section.hpp"

namespace monograin::calibration {
namespace {

constexpr double k_farthest_prior = 5.0;   // from the bounds, in standard deviations
constexpr double k_ratio_for_log = 100.0;  // of bounds; from this ratio on the logarithm of the parameter is sought

/// Keys of a table that are no free numbers of the scenario, or that TOML splits because they lack quotes.
std::vector<ForeignKey> foreign_keys(const toml::table* table, const std::vector<NumberKey>& numbers) {
  std::vector<ForeignKey> foreign;
  for (const auto& [key, node] : *table) {
    const std::string_view name = key.str();
    const toml::table* inner = node.as_table();
    if (std::ranges::find(numbers, name, &NumberKey::path) != numbers.end()) continue;
    if (name.starts_with("loading.") && name.find("steps") != std::string_view::npos) {
      foreign.push_back({name, "cannot be free: steps are what a test prescribes"});
    } else if (name.starts_with("loading.wall")) {
      foreign.push_back({name,
                         "cannot be free; expected the gap of a wall of configuration = \"walls\", counted from 0, for "
                         "example \"loading.wall[1].gap\", or one gap of several walls, \"loading.wall[2-5].gap\""});
    } else if (inner != nullptr && !inner->contains("from") && name.find('.') == std::string_view::npos) {
      foreign.push_back({name,
                         "is a table; expected the whole path in quotes, for example "
                         "\"material.youngs_modulus\" = { from = ..., to = ... }"});
    }
  }
  return foreign;
}

/// Sets the unit of a parameter to that of a bound; a bare number is in SI.
void set_unit(FreeParameter& parameter, const toml::node& bound, double initial_radius) {
  const Dimension dimension = parameter.key.dimension;
  parameter.unit = dimension_info(dimension).si;
  const auto* text = bound.as_string();
  if (parameter.key.path == k_compliance) {
    const ParsedCompliance parsed = text == nullptr ? ParsedCompliance{.unit = "m/N"} : parse_compliance(text->get());
    parameter.unit = parsed.unit;
    parameter.unit_factor = parsed.unit_factor;
  } else if (text != nullptr) {
    parameter.unit = parse_quantity(text->get(), dimension, initial_radius).unit;
    parameter.unit_factor = parse_quantity("1 " + parameter.unit, dimension, initial_radius).value.value_or(1.0);
  }
}

using Values = std::vector<std::pair<std::string_view, double>>;  // of numbers, by their paths

/// Why the scenario does not take values; none if it does.
/// @throws std::runtime_error if its text has no place for one of them
std::optional<std::string> refusal_of(const ScenarioText& scenario, const Values& values) {
  std::vector<TextEdit> edits;
  for (const auto& [path, value] : values) edits.push_back({std::string(path), fmt::format("{:e}", value)});
  const std::string text = with_values(scenario.text, edits);
  try {
    static_cast<void>(parse_scenario(text, scenario.file));
  } catch (const ScenarioError& error) {
    return on_one_line(error.faults().front().message);
  }
  return std::nullopt;
}

double middle_of(const FreeParameter& parameter) {
  return parameter.is_logarithmic ? std::sqrt(parameter.lower * parameter.upper)
                                  : std::midpoint(parameter.lower, parameter.upper);
}

/// A number that the scenario takes nowhere within its bounds, as far as it was tried with its other numbers as given.
struct RefusedNumber {
  const FreeParameter& parameter;
  std::string problem;
};

/// Checks that the scenario takes a number, so that the fitted scenario can be run. A law may end within the bounds:
/// then the search passes over such values.
std::optional<RefusedNumber> refused(Reading& reading, const Section& free, const ScenarioText& scenario,
                                     const FreeParameter& parameter) {
  const std::string& path = parameter.key.path;
  if (parameter.is_of_machine()) return {};
  std::optional<std::string> problem;
  try {
    for (const double value :
         {parameter.start.value_or(parameter.lower), middle_of(parameter), parameter.upper, parameter.lower}) {
      problem = refusal_of(scenario, {{path, value}});
      if (!problem) return {};
    }
  } catch (const std::runtime_error&) {
    reading.faults.add(
        free.key_place(path),
        fmt::format("the scenario does not give '{}', and has no table with a header to put it in; expected "
                    "it there, with any value",
                    path));
    return {};
  }
  return RefusedNumber{parameter, *problem};
}

/// Reports numbers that the scenario takes nowhere: neither alone nor with all others at their bounds or in the middle.
/// Only if a number is refused, this reads the scenario up to 2^n + 1 times for n numbers; n <= k_most_parameters.
void report_refused(Reading& reading, const Section& free, const ScenarioText& scenario,
                    const std::vector<FreeParameter>& parameters, const std::vector<RefusedNumber>& refused_numbers) {
  if (refused_numbers.empty()) return;
  for (std::size_t corner = 0; corner <= std::size_t{1} << parameters.size(); ++corner) {
    Values values;
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      const FreeParameter& parameter = parameters[k];
      if (parameter.is_of_machine()) continue;
      const double bound = ((corner >> k) & 1U) != 0 ? parameter.upper : parameter.lower;
      values.emplace_back(parameter.key.path, corner >> parameters.size() != 0 ? middle_of(parameter) : bound);
    }
    if (!refusal_of(scenario, values)) return;
  }
  for (const RefusedNumber& number : refused_numbers) {
    const FreeParameter& parameter = number.parameter;
    reading.faults.add(free.key_place(parameter.key.path),
                       fmt::format("the scenario does not take {}: {}", parameter.bounds_text(), number.problem));
  }
}

std::optional<FreeParameter> read_bounds(Reading& reading, const Section& free, const NumberKey& number) {
  const Section::Origin origin = free.table(number.path, fmt::format("\"{}\"", number.path));
  const bool is_compliance = number.path == k_compliance;
  const auto kind_of_bound = [&](std::string_view key) {
    const toml::node* node = origin.table->get(key);
    return is_compliance && node != nullptr && node->is_string() ? KeySpec::Kind::text : KeySpec::Kind::quantity;
  };
  const Keys keys = bounds_keys(number, {kind_of_bound("from"), kind_of_bound("to"), kind_of_bound("start")});
  Section bounds(reading, origin, keys);
  const auto bound = [&](std::string_view key) {
    return kind_of_bound(key) == KeySpec::Kind::text ? compliance_in(reading, bounds, key).value : bounds.number(key);
  };
  const auto from = bound("from");
  const auto to = bound("to");
  FreeParameter parameter;
  parameter.key = number;
  if (!from || !to) return {};
  if (!(*from < *to)) {
    reading.faults.add(bounds.value_place("to"),
                       fmt::format("to = {} is not above from = {}; expected bounds the other way round",
                                   shown(*origin.table->get("to")), shown(*origin.table->get("from"))));
    return {};
  }
  parameter.lower = *from;
  parameter.upper = *to;
  parameter.start = bound("start");
  bounds.expect_like_units({"from", "to", "start"});
  if (parameter.start && (*parameter.start < *from || *parameter.start > *to)) {
    reading.faults.add(bounds.value_place("start"),
                       fmt::format("start = {} is not between the bounds", shown(*origin.table->get("start"))));
  }
  const std::string scale = bounds.text("scale");
  parameter.is_logarithmic = scale.empty() ? *from > 0.0 && *to >= k_ratio_for_log * *from : scale == "log";
  if (parameter.is_logarithmic && *from <= 0.0) {
    reading.faults.add(bounds.value_place("scale"), "scale = \"log\" needs bounds above zero");
  }
  // A bound of zero may lack a unit; the upper bound then gives it.
  const bool is_bare_zero = number.path.starts_with(k_data) && !origin.table->get("from")->is_string();
  set_unit(parameter, *origin.table->get(is_bare_zero ? "to" : "from"), reading.initial_radius);
  return parameter;
}

std::optional<double> plain_number(Reading& reading, const Section& section, std::string_view key, std::size_t entry,
                                   const std::string& text) {
  const auto number = number_in(text);
  if (!number) {
    reading.faults.add(
        section.value_place(key, entry),
        fmt::format("{}: '{}' is no number; expected the standard deviation of the natural logarithm, for example 0.1",
                    key, shown(text)));
  }
  return number;
}

/// A value of a parameter in a list: a number in SI, or a text with a unit.
std::optional<double> value_in(Reading& reading, const Section& section, std::string_view key, std::size_t entry,
                               const NumberKey& number, const std::string& text) {
  if (const auto bare = number_in(text)) return bare;
  if (number.path == k_compliance) {
    const ParsedCompliance parsed = parse_compliance(text);
    if (!parsed.value) {
      reading.faults.add(
          section.value_place(key, entry),
          fmt::format("{}: '{}': expected a length over a force, for example \"20 nm/N\"", key, shown(text)));
    }
    return parsed.value;
  }
  const auto radius = number.path == k_radius_key ? std::nullopt : std::optional(reading.initial_radius);
  const ParsedQuantity parsed = parse_quantity(text, number.dimension, radius);
  if (!parsed.value) reading.faults.add(section.value_place(key, entry), fmt::format("{}: {}", key, parsed.problem));
  return parsed.value;
}

void check_prior(Reading& reading, const Section& distribution, const Prior& prior, FreeParameter& parameter,
                 const std::vector<std::string>& values) {
  const std::string_view word = word_of(prior.kind);
  if (prior.kind != Prior::Kind::uniform && !(prior.second > 0.0)) {
    return reading.faults.add(
        distribution.value_place(word, 1),
        fmt::format("{}: the standard deviation is {}; expected one above zero", word, shown(values[1])));
  }
  if (prior.kind == Prior::Kind::lognormal && !(prior.first > 0.0 && parameter.lower > 0.0)) {
    return reading.faults.add(distribution.value_place(word, 0),
                              "lognormal: expected a median above zero, and bounds in [free] above zero");
  }
  if (prior.kind == Prior::Kind::uniform) {
    if (!(prior.first < prior.second)) {
      return reading.faults.add(distribution.value_place(word, 1),
                                fmt::format("uniform: {} is not above {}; expected the bounds the other way round",
                                            shown(values[1]), shown(values[0])));
    }
    const double lower = std::max(parameter.lower, prior.first);
    const double upper = std::min(parameter.upper, prior.second);
    if (!(lower < upper) || (parameter.start && !(*parameter.start >= lower && *parameter.start <= upper))) {
      return reading.faults.add(
          distribution.value_place(word, 0),
          "uniform: expected an interval that shares values, and the start, with the bounds in [free]");
    }
    parameter.lower = lower;
    parameter.upper = upper;
  }
  const double nearest = std::clamp(prior.first, parameter.lower, parameter.upper);
  if (const double distance = std::abs(prior.deviation(nearest)); distance > k_farthest_prior) {
    return reading.faults.add(
        distribution.value_place(word, 0),
        fmt::format("{}: {} is outside of the bounds in [free], by {:.3g} standard deviations; expected bounds that "
                    "contain it, or a larger standard deviation",
                    word, shown(values[0]), distance));
  }
  parameter.prior = prior;
}

void read_prior(Reading& reading, const Section& priors, FreeParameter& parameter) {
  const Section::Origin origin = priors.table(parameter.key.path, fmt::format("\"{}\"", parameter.key.path));
  const Keys keys = distribution_keys();
  const std::size_t before = reading.faults.size();
  Section distribution(reading, origin, keys);
  if (reading.faults.size() > before) return;
  constexpr std::array k_kinds{Prior::Kind::normal, Prior::Kind::lognormal, Prior::Kind::uniform};
  std::vector<Prior::Kind> given;
  for (const Prior::Kind kind : k_kinds) {
    if (distribution.has(word_of(kind))) given.push_back(kind);
  }
  if (given.size() != 1) {
    return reading.faults.add(
        distribution.place(),
        fmt::format("a prior with {} distributions; expected one of normal, lognormal, uniform", given.size()));
  }
  Prior prior{.kind = given.front()};
  const std::string_view word = word_of(prior.kind);
  const std::vector<std::string> values = distribution.texts(word);
  if (values.size() != 2) {
    return reading.faults.add(
        distribution.value_place(word),
        fmt::format("{} = {} value{}; expected two", word, values.size(), values.size() == 1 ? "" : "s"));
  }
  const bool is_lognormal = prior.kind == Prior::Kind::lognormal;
  const auto first = value_in(reading, distribution, word, 0, parameter.key, values[0]);
  const auto second = is_lognormal ? plain_number(reading, distribution, word, 1, values[1])
                                   : value_in(reading, distribution, word, 1, parameter.key, values[1]);
  if (!first || !second) return;
  if (!is_lognormal) distribution.expect_like_units({word});
  prior.first = *first;
  prior.second = *second;
  check_prior(reading, distribution, prior, parameter, values);
}

}  // namespace

std::vector<FreeParameter> free_in(Reading& reading, const Section& root, const ScenarioText& scenario) {
  std::vector<NumberKey> numbers = number_keys(scenario.checked);
  std::ranges::move(machine_keys(), std::back_inserter(numbers));
  const toml::table* table = root.table("free", "").table;
  for (const auto& entry : *table) {
    if (auto number = number_of_range(numbers, entry.first.str())) numbers.push_back(*std::move(number));
  }
  const Keys keys = free_keys(numbers);
  const std::vector<ForeignKey> foreign = foreign_keys(table, numbers);
  const Section free(reading, root.table("free", "[free]"), keys, foreign);
  std::vector<std::pair<SourceLocation, const NumberKey*>> found;
  for (const NumberKey& number : numbers) {
    if (free.has(number.path)) found.emplace_back(free.key_place(number.path), &number);
  }
  // The parameters are in the order of the file, not of the model.
  std::ranges::sort(found, {}, [](const auto& entry) { return std::pair(entry.first.line, entry.first.column); });
  if (found.size() > k_most_parameters) {
    reading.faults.add(found[k_most_parameters].first,
                       fmt::format("{} parameters are free; expected at most {}", found.size(), k_most_parameters));
  }
  const std::size_t before = reading.faults.size();
  std::set<std::string> free_paths;
  std::vector<FreeParameter> parameters;
  for (const auto& [where, number] : found) {
    for (std::string& path : plain_paths(number->path)) {
      if (const auto [same, is_new] = free_paths.insert(std::move(path)); !is_new)
        reading.faults.add(where, fmt::format("'{}' is free already; expected it once", *same));
    }
    if (auto parameter = read_bounds(reading, free, *number)) parameters.push_back(std::move(*parameter));
  }
  if (reading.faults.size() > before) return parameters;
  std::vector<RefusedNumber> refused_numbers;
  for (const FreeParameter& parameter : parameters) {
    if (auto number = refused(reading, free, scenario, parameter)) refused_numbers.push_back(std::move(*number));
  }
  if (reading.faults.size() == before) report_refused(reading, free, scenario, parameters, refused_numbers);
  return parameters;
}

void read_priors(Reading& reading, const Section& root, const CheckedScenario& scenario,
                 std::vector<FreeParameter>& free) {
  std::vector<std::string> paths;
  for (const FreeParameter& parameter : free) paths.push_back(parameter.key.path);
  const Keys keys = prior_keys(paths);
  const Section::Origin origin = root.table("prior", "[prior]");
  std::vector<NumberKey> numbers = number_keys(scenario);
  std::ranges::move(machine_keys(), std::back_inserter(numbers));
  std::vector<ForeignKey> foreign;
  for (const NumberKey& number : numbers) {
    if (std::ranges::find(paths, number.path) == paths.end()) {
      foreign.push_back({number.path, "is not free; expected it in [free], too"});
    }
  }
  const Section priors(reading, origin, keys, foreign);
  for (FreeParameter& parameter : free) {
    if (priors.has(parameter.key.path)) read_prior(reading, priors, parameter);
  }
}

}  // namespace monograin::calibration
