#include "study/calibrate/calibration_language.hpp"

#include <string>

#include "scenario/units.hpp"

namespace monograin::calibration {
namespace {

using Kind = KeySpec::Kind;

KeySpec column_key(std::string_view name, std::string_view meaning, Kind kind, const char* example) {
  KeySpec key = required(key_of(kind, name, meaning, example));
  key.range = {.lower = 1.0, .upper = 1e6};
  if (kind == Kind::table) key.example = "{ column = \"h\", quantity = \"displacement\", unit = \"mm\" }";
  return key;
}

KeySpec bound_key(std::string_view name, std::string_view meaning, const NumberKey& number, Kind kind,
                  bool is_required) {
  KeySpec key{.name = name,
              .meaning = meaning,
              .kind = kind,
              .is_required = is_required,
              .dimension = number.dimension,
              .range = number.range,
              .knows_initial_radius = number.path != k_radius_key};
  if (number.path == k_compliance) key.example = "\"20 nm/N\"";
  return key;
}

}  // namespace

Keys root_keys(bool scenario_is_table, bool data_is_list) {
  return {
      key_of(Kind::text, "title", "what is calibrated", "\"MCC PH-200\""),
      required(key_of(scenario_is_table ? Kind::table : Kind::file, "scenario",
                      "the scenario: its file, or the scenario itself",
                      scenario_is_table ? "[scenario]" : "\"uniaxial.toml\"")),
      required(key_of(data_is_list ? Kind::tables : Kind::table, "data",
                      "what was measured: one curve, or several that are fitted together",
                      data_is_list ? "[[data]]" : "[data]")),
      {.name = "free",
       .meaning = "which numbers of the scenario are sought, and between which bounds",
       .kind = Kind::table,
       .is_required = true,
       .may_be_empty = false,
       .example = "[free]"},
      key_of(Kind::table, "prior", "what is known of sought numbers before the data are", "[prior]"),
      key_of(Kind::table, "fit", "how the fit is made", "[fit]"),
  };
}

Keys data_keys(const DataKinds& kinds) {
  KeySpec weights = first_by_default(choice_key(
      "weights",
      "of the residuals: one over the largest |y|, one over each |y|, factors in a column, or such that the sum of "
      "their squares is an integral over the path of x",
      k_weights));
  KeySpec weight_column = column_key(
      "weight_column", "column with the factors of the residuals, for example one over the standard deviations",
      kinds.weight_column, "\"weight[-]\"");
  weight_column.is_required = false;
  KeySpec units =
      choice_key("units", "whether a row of units stands below the headings [found], or a list of units", k_unit_rows);
  units.kind = kinds.units;
  if (units.kind == Kind::texts) units.example = "[\"s\", \"mm\", \"kN\"]";
  return {
      required(key_of(Kind::file, "file", "table with a row of headings", "\"measured.csv\"")),
      key_of(Kind::texts, "set", "overrides of the scenario for this curve", "[\"material.yield_stress=20 MPa\"]"),
      column_key("x", "column that drives the scenario: displacement or force, or what its steps prescribe", kinds.x,
                 "\"displacement[m]\""),
      column_key("y", "column that is fitted", kinds.y, "\"force[N]\""),
      weights,
      weight_column,
      {.name = k_noise,
       .meaning = "standard deviation of y, where it is known",
       .kind = Kind::table,
       .may_be_empty = false,
       .example = "{ absolute = \"2 N\", relative = 0.01 }"},
      key_of(Kind::text, "separator", "what stands between cells [found]", "\"semicolon\""),
      choice_key("decimal", "decimal sign [found]", k_decimals),
      {.name = "skip",
       .meaning = "lines above the headings [found]",
       .kind = Kind::integer,
       .range = {.lower = 0.0, .upper = 1e6},
       .example = "12"},
      units,
      {.name = "offset",
       .meaning = "displacement of the machine at first touch",
       .kind = Kind::quantity,
       .dimension = Dimension::length,
       .range = machine_keys().front().range,
       .example = "\"0.1 mm\""},
      {.name = "force_offset",
       .meaning = "force that the load cell shows without a load",
       .kind = Kind::quantity,
       .dimension = Dimension::force,
       .range = machine_keys()[1].range,
       .example = "\"0.8 N\""},
      {.name = "compliance",
       .meaning = "of the machine's frame: its own displacement over the force, or a table of it",
       .kind = kinds.compliance,
       .range = machine_keys().back().range,
       .example = "\"20 nm/N\""},
  };
}

Keys column_keys(Kind column) {
  return {
      column_key("column", "heading of the column, or its number", column, "\"gamma_over_2R[-]\""),
      key_of(Kind::text, "quantity", "what it holds [what its heading says]", "\"displacement\""),
      key_of(Kind::text, "unit", "its unit [that of the file]", "\"R0\""),
      quantity_key({"scale",
                    "factor of its numbers; -1 reverses their sign",
                    Dimension::none,
                    {.lower = -1e9, .upper = 1e9},
                    1.0}),
  };
}

Keys deflection_keys() {
  return {
      required(
          key_of(Kind::file, "table", "file with the machine's displacement under forces, ascending", "\"frame.csv\"")),
      required(key_of(Kind::text, "force", "its column of forces", "\"force[N]\"")),
      required(key_of(Kind::text, "displacement", "its column of displacements", "\"displacement[um]\"")),
  };
}

std::vector<NumberKey> machine_keys() {
  return {{std::string(k_offset), "displacement of the machine at first touch", Dimension::length,
           plausible_range(Dimension::length, {})},
          {std::string(k_force_offset), "force that the load cell shows without a load", Dimension::force,
           plausible_range(Dimension::force, {})},
          {std::string(k_compliance), "of the machine's frame [m/N]", Dimension::none, {.lower = 0.0, .upper = 1e6}}};
}

Keys free_keys(const std::vector<NumberKey>& numbers) {
  Keys keys;
  for (const NumberKey& number : numbers) {
    keys.push_back(key_of(Kind::table, number.path, number.meaning, "{ from = ..., to = ... }"));
  }
  return keys;
}

Keys bounds_keys(const NumberKey& number, const std::array<Kind, 3>& kinds) {
  return {
      bound_key("from", "lower bound", number, kinds[0], true),
      bound_key("to", "upper bound", number, kinds[1], true),
      bound_key("start", "a further place to begin at", number, kinds[2], false),
      choice_key("scale", "in which the parameter is sought; log where the bounds lie a factor of 100 apart", k_scales),
  };
}

std::optional<Dimension> dimension_of(std::string_view si) {
  for (const Dimension dimension : {Dimension::length, Dimension::stress, Dimension::force}) {
    if (dimension_info(dimension).si == si) return dimension;
  }
  return std::nullopt;
}

Keys prior_keys(const std::vector<std::string>& paths) {
  Keys keys;
  for (const std::string& path : paths) {
    keys.push_back(key_of(Kind::table, path, "what is known of it", "{ normal = [\"1.2 GPa\", \"0.1 GPa\"] }"));
  }
  return keys;
}

Keys distribution_keys() {
  return {
      key_of(Kind::texts, "normal", "mean and standard deviation", "[\"1.2 GPa\", \"0.1 GPa\"]"),
      key_of(Kind::texts, "lognormal", "median, and standard deviation of the natural logarithm", "[\"1.2 GPa\", 0.1]"),
      key_of(Kind::texts, "uniform", "tighter bounds", "[\"1 GPa\", \"1.5 GPa\"]"),
  };
}

Keys noise_keys(Dimension of_x, Dimension of_y, Kind column) {
  KeySpec standard_errors =
      column_key("column", "column with the standard deviation of each y", column, "\"standard_error[N]\"");
  standard_errors.is_required = false;
  return {
      {.name = "absolute",
       .meaning = "part that is the same for all",
       .kind = Kind::quantity,
       .dimension = of_y,
       .range = {.lower = 0.0, .upper = 1e300, .lower_is_open = true}},
      {.name = "relative",
       .meaning = "part in proportion to |y|",
       .kind = Kind::quantity,
       .range = {.lower = 0.0, .upper = 10.0, .lower_is_open = true},
       .example = "0.01"},
      {.name = "x",
       .meaning = "standard deviation of x",
       .kind = Kind::quantity,
       .dimension = of_x,
       .range = {.lower = 0.0, .upper = 1e300, .lower_is_open = true}},
      standard_errors,
  };
}

Keys fit_keys() {
  return {
      first_by_default(choice_key("loss", "how much large residuals count", k_losses)),
      {.name = "loss_scale",
       .meaning = "weighted residual from which on it counts less than its square",
       .kind = Kind::quantity,
       .range = {.lower = 0.0, .upper = 1e6, .lower_is_open = true},
       .example = "0.01"},
      {.name = "confidence",
       .meaning = "level of the two-sided intervals",
       .kind = Kind::quantity,
       .range = {.lower = 0.0, .upper = 1.0, .lower_is_open = true, .upper_is_open = true},
       .default_value = 0.95},
      first_by_default(
          choice_key("intervals",
                     "how intervals are found; auto: by the covariance, or the profile where that is not to be trusted",
                     k_intervals)),
  };
}

}  // namespace monograin::calibration
