#include "study/calibrate/calibration_language.hpp"

#include <string>

namespace monograin::calibration {
namespace {

using Kind = KeySpec::Kind;

template <std::size_t N>
KeySpec choice_key(std::string_view name, std::string_view meaning, const std::array<std::string_view, N>& choices) {
  return {.name = name, .meaning = meaning, .kind = Kind::choice, .choices = {choices.begin(), choices.end()}};
}

KeySpec text_key(std::string_view name, std::string_view meaning, std::string example) {
  return {.name = name, .meaning = meaning, .kind = Kind::text, .is_required = true, .example = std::move(example)};
}

KeySpec column_key(std::string_view name, std::string_view meaning, bool is_table, const char* example) {
  KeySpec key = text_key(name, meaning, example);
  if (is_table) {
    key.kind = Kind::table;
    key.example = "{ column = \"h\", quantity = \"displacement\", unit = \"mm\" }";
  }
  return key;
}

KeySpec bound_key(std::string_view name, std::string_view meaning, const NumberKey& number, bool is_required) {
  return {.name = name,
          .meaning = meaning,
          .kind = Kind::quantity,
          .is_required = is_required,
          .dimension = number.dimension,
          .range = number.range,
          .knows_initial_radius = false};
}

}  // namespace

Keys root_keys(bool scenario_is_table, bool data_is_list) {
  return {
      {.name = "title", .meaning = "what is calibrated", .kind = Kind::text, .example = "\"MCC PH-200\""},
      {.name = "scenario",
       .meaning = "the scenario: its file, or the scenario itself",
       .kind = scenario_is_table ? Kind::table : Kind::file,
       .is_required = true,
       .example = scenario_is_table ? "[scenario]" : "\"uniaxial.toml\""},
      {.name = "data",
       .meaning = "what was measured: one curve, or several that are fitted together",
       .kind = data_is_list ? Kind::tables : Kind::table,
       .is_required = true,
       .example = data_is_list ? "[[data]]" : "[data]"},
      {.name = "free",
       .meaning = "which numbers of the scenario are sought, and between which bounds",
       .kind = Kind::table,
       .is_required = true,
       .may_be_empty = false,
       .example = "[free]"},
      {.name = "fit", .meaning = "how the fit is made", .kind = Kind::table, .example = "[fit]"},
  };
}

Keys data_keys(bool x_is_table, bool y_is_table) {
  KeySpec weights = choice_key(
      "weights",
      "of the residuals: one over the largest |y|, one over each |y|, factors in a column, or such that the sum of "
      "their squares is an integral over the path of x",
      k_weights);
  weights.default_value = "absolute";
  return {
      {.name = "file",
       .meaning = "CSV with one row of headings",
       .kind = Kind::file,
       .is_required = true,
       .example = "\"measured.csv\""},
      {.name = "set",
       .meaning = "overrides of the scenario for this curve",
       .kind = Kind::texts,
       .example = "[\"material.yield_stress=20 MPa\"]"},
      column_key("x", "column that drives the scenario: displacement or force, or what its steps prescribe", x_is_table,
                 "\"displacement[m]\""),
      column_key("y", "column that is fitted", y_is_table, "\"force[N]\""),
      weights,
      {.name = "weight_column",
       .meaning = "column with the factors of the residuals, for example one over the standard deviations",
       .kind = Kind::text,
       .example = "\"weight[-]\""},
  };
}

Keys column_keys() {
  return {
      text_key("column", "heading of the column", "\"gamma_over_2R[-]\""),
      text_key("quantity", "what it holds", "\"displacement\""),
      text_key("unit", "its unit", "\"R0\""),
  };
}

Keys free_keys(const std::vector<NumberKey>& numbers) {
  Keys keys;
  for (const NumberKey& number : numbers) {
    keys.push_back(
        {.name = number.path, .meaning = number.meaning, .kind = Kind::table, .example = "{ from = ..., to = ... }"});
  }
  return keys;
}

Keys bounds_keys(const NumberKey& number) {
  return {
      bound_key("from", "lower bound", number, true),
      bound_key("to", "upper bound", number, true),
      bound_key("start", "a further place to begin at", number, false),
      choice_key("scale", "in which the parameter is sought; log where the bounds lie a factor of 100 apart", k_scales),
  };
}

Keys fit_keys() {
  KeySpec loss = choice_key("loss", "how much large residuals count", k_losses);
  loss.default_value = k_losses.front();
  return {
      loss,
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
  };
}

}  // namespace monograin::calibration
