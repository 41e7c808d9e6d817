#include "study/atlas/definition_language.hpp"

#include <string>
#include <utility>

#include "figure/figure.hpp"
#include "study/atlas/adhesion_map.hpp"

namespace monograin::definition {
namespace {

using Kind = KeySpec::Kind;

KeySpec number_key(std::string_view name, std::string_view meaning) {
  return {.name = name,
          .meaning = meaning,
          .kind = Kind::quantity,
          .range = {.lower = -1e100, .upper = 1e100},
          .example = "0.5"};
}

KeySpec count_key(std::string_view name, std::string_view meaning, double upper) {
  return {
      .name = name, .meaning = meaning, .kind = Kind::integer, .range = {.lower = 1.0, .upper = upper}, .example = "1"};
}

KeySpec measures_key() {
  return key_of(Kind::texts, "measures", "what is shown of each comparison", "[\"largest\", \"rms\"]");
}

KeySpec overrides_key(std::string_view meaning) {
  return key_of(Kind::texts, "set", meaning, "[\"material.yield_stress=20 MPa\"]");
}

/// Appends the keys of axes and runs, which may be given once for all panels, or for all curves of a panel.
void append_shared_keys(Keys& keys) {
  keys.push_back(key_of(Kind::table, "vary", "one curve for each value of a key", "{ key = \"...\", values = [...] }"));
  keys.push_back(key_of(Kind::texts, "against", "y is the distance from y of a run with these overrides besides",
                        "[\"numerics.rtol=1e-13\"]"));
  keys.push_back(key_of(Kind::text, "x", "formula of the abscissa", k_example_x));
  keys.push_back(key_of(Kind::text, "y", "formula of the ordinate", k_example_y));
  keys.push_back(key_of(Kind::text, "x_label", "label of the abscissa", "\"Displacement\""));
  keys.push_back(key_of(Kind::text, "y_label", "label of the ordinate", "\"Force\""));
  keys.push_back(number_key("x_min", "left end of the abscissa"));
  keys.push_back(number_key("x_max", "right end of the abscissa"));
  keys.push_back(number_key("y_min", "lower end of the ordinate"));
  keys.push_back(number_key("y_max", "upper end of the ordinate"));
  keys.push_back(key_of(Kind::table, "fitted",
                        "part of the abscissa to which a law was fitted or in which it holds; beyond is shaded",
                        "{ from = 0.03, to = 0.5 }"));
  keys.push_back({.name = "x_log", .meaning = "logarithmic abscissa", .kind = Kind::toggle});
  keys.push_back({.name = "y_log", .meaning = "logarithmic ordinate", .kind = Kind::toggle});
}

}  // namespace

Keys root_keys() {
  Keys keys{required(key_of(Kind::text, "title", "what the figure shows", "\"Force over displacement\"")),
            required(key_of(Kind::text, "source", "figure and document that show it too", "\"Fig. 8 of ...\"")),
            first_by_default(choice_key("format", "format of the figure", figure::k_formats)),
            key_of(Kind::table, "scenario", "the scenario of curves that name no file", "[scenario]"),
            key_of(Kind::table, "adhesion_map", "phase diagrams of adhesion as panels", "[adhesion_map]"),
            key_of(Kind::tables, "panel", "panels of the figure", "[[panel]]"),
            key_of(Kind::tables, "curve", "curves of every panel, before its own", "[[curve]]"),
            key_of(Kind::tables, "table", "tables of how far curves are from points", "[[table]]"),
            key_of(Kind::tables, "values", "tables of single values", "[[values]]")};
  append_shared_keys(keys);
  return keys;
}

Keys panel_keys() {
  Keys keys{key_of(Kind::text, "note", "text above the panel", "\"E/Y = 200\""),
            overrides_key("overrides of the scenario of every curve"),
            key_of(Kind::tables, "curve", "curves from runs", "[[panel.curve]]"),
            key_of(Kind::tables, "points", "points from files", "[[panel.points]]")};
  append_shared_keys(keys);
  return keys;
}

Keys curve_keys() {
  return {
      key_of(Kind::text, "scenario", "scenario file, sought from the definition's folder", "\"../scenarios/die.toml\""),
      overrides_key("overrides of the scenario"),
      key_of(Kind::table, "vary", "one curve for each value of a key", "{ key = \"...\", values = [...] }"),
      key_of(Kind::texts, "against", "y is the distance from y of a run with these overrides besides",
             "[\"numerics.rtol=1e-13\"]"),
      key_of(Kind::table, "sweep", "instead of a history: the parameters that the model derives, over a key's values",
             "{ key = \"...\", from = 1, to = 2 }"),
      number_key("profile_at", "instead of a history: contact profiles of the first class at this instant [s]"),
      key_of(Kind::text, "at_event", "instead of a history: the states just after events of this name",
             "\"impingement\""),
      key_of(Kind::table, "parameter", "instead of a history: range of t in the formulas", "{ from = 0, to = 1 }"),
      key_of(Kind::text, "x", "formula of the abscissa", k_example_x),
      key_of(Kind::text, "y", "formula of the ordinate", k_example_y),
      key_of(Kind::text, "legend", "text in the legend", "\"model\""),
      first_by_default(choice_key("rows", "which way of x is shown", k_rows)),
      first_by_default(choice_key("style", "how the line is drawn", k_styles)),
      count_key("colour", "place among the colours", 6.0)};
}

Keys vary_keys() {
  return {required(key_of(Kind::text, "key", "key of the scenario", "\"material.poisson_ratio\"")),
          required(key_of(Kind::texts, "values", "its values", "[0, 0.3]")),
          key_of(Kind::texts, "legends", "a text for each value", "[\"low\"]"),
          key_of(Kind::texts, "styles", "how the line of each value is drawn", "[\"solid\"]")};
}

Keys sweep_keys() {
  Keys keys{required(key_of(Kind::text, "key", "key of the scenario", "\"material.youngs_modulus\"")),
            required(number_key("from", "its first value, in SI")),
            required(number_key("to", "its last value, in SI")),
            count_key("points", "how many values", 10000.0),
            {.name = "log", .meaning = "values in equal ratios", .kind = Kind::toggle}};
  keys[3].range.lower = 2.0;
  keys[3].default_value = 101.0;
  return keys;
}

Keys parameter_keys() {
  return {required(number_key("from", "first value of t")), required(number_key("to", "last value of t"))};
}

Keys fitted_keys() {
  Keys keys{number_key("from", "its lower end"), number_key("to", "its upper end"),
            key_of(Kind::text, "label", "text in the legend for what lies beyond", "\"beyond the fitted range\"")};
  keys[2].default_value = std::string_view("beyond the fitted range");
  return keys;
}

Keys points_keys() {
  return {required(key_of(Kind::text, "file", "CSV file, sought from the definition's folder", "\"fe/points.csv\"")),
          required(key_of(Kind::text, "x", "formula of its columns", "\"displacement\"")),
          key_of(Kind::text, "y", "formula of its columns; a table may give it for all rows", "\"force\""),
          key_of(Kind::text, "legend", "text in the legend", "\"finite elements\""),
          first_by_default(choice_key("rows", "which way of x is shown", k_rows)),
          key_of(Kind::text, "where", "only rows in which this formula of the columns is zero", "\"shear_ratio - 1\""),
          count_key("every", "only each so manieth row", 1000.0),
          count_key("colour", "place among the colours", 6.0)};
}

Keys adhesion_map_keys() {
  static constexpr std::array<std::string_view, 2> controls{"displacement", "force"};
  const AdhesionMapSettings defaults;
  const auto positive = [](std::string_view name, std::string_view meaning, double value) {
    KeySpec spec = number_key(name, meaning);
    spec.range = {.lower = 0.0, .upper = 1e30, .lower_is_open = true};
    spec.default_value = value;
    return spec;
  };
  Keys keys{positive("least_modulus", "E* R0/dg at the left end", defaults.least_modulus),
            positive("least_yield_stress", "Y R0/dg at the lower end", defaults.least_yield_stress),
            positive("decades", "length of both axes", defaults.decades),
            count_key("points", "points on each axis", 1000.0),
            number_key("poisson_ratio", "Poisson's ratio"),
            first_by_default(choice_key("control", "what is controlled at pull-off", controls))};
  keys[3].range.lower = 2.0;
  keys[3].default_value = static_cast<double>(defaults.points);
  keys[4].range = {.lower = -1.0, .upper = 0.5, .lower_is_open = true};
  keys[4].default_value = defaults.poisson_ratio;
  return keys;
}

Keys comparison_table_keys() {
  return {required(key_of(Kind::text, "title", "what is compared", "\"Force\"")),
          key_of(Kind::text, "x", "formula of the abscissa", k_example_x),
          key_of(Kind::text, "y", "formula of the ordinate", k_example_y),
          key_of(Kind::table, "vary", "one line for each value of a key, in every row",
                 "{ key = \"model\", values = [...] }"),
          {.name = "bands",
           .meaning = "ends of bands of x to measure instead of the loading up to each reversal",
           .kind = Kind::instants,
           .example = "[0.05, 0.5]"},
          measures_key(),
          key_of(Kind::tables, "quantity", "quantities that every row is asked for", "[[table.quantity]]"),
          required(key_of(Kind::tables, "row", "comparisons", "[[table.row]]"))};
}

Keys quantity_keys() {
  return {required(key_of(Kind::text, "name", "name of the quantity", "\"axial force\"")),
          required(key_of(Kind::text, "y", "formula of the ordinate", k_example_y)),
          required(key_of(Kind::text, "reference", "formula of the columns of the points", "\"force\"")),
          key_of(Kind::text, "least",
                 "loading rows of the reference up to this are not compared in bands; a formula of the run's numbers",
                 "\"1e-3 * Y / E\""),
          measures_key()};
}

Keys comparison_keys() {
  return {required(key_of(Kind::text, "label", "name of the row", "\"E/Y = 200\"")),
          required(key_of(Kind::table, "curve", "the curve", "curve = { ... }")),
          required(key_of(Kind::table, "points", "what it is held against", "points = { ... }"))};
}

Keys value_table_keys() {
  return {required(key_of(Kind::text, "title", "what the values are", "\"Coefficients\"")),
          required(key_of(Kind::tables, "row", "values", "[[values.row]]"))};
}

Keys value_keys() {
  return {
      required(key_of(Kind::text, "label", "name of the row", "\"D1\"")),
      key_of(Kind::text, "scenario", "scenario file, sought from the definition's folder", "\"../scenarios/die.toml\""),
      overrides_key("overrides of the scenario"),
      required(key_of(Kind::text, "value", "formula of the parameters that the model derives", "\"radius_first\"")),
      key_of(Kind::text, "printed", "the value as the source prints it", "\"1.7527\""),
      key_of(Kind::table, "reference", "instead: rows of a file, whose mean it is held against",
             "{ file = \"...\", y = \"...\" }"),
      key_of(Kind::text, "remark", "what is to be said of it", "\"...\"")};
}

Keys reference_keys() {
  return {required(key_of(Kind::text, "file", "CSV file, sought from the definition's folder", "\"fe/points.csv\"")),
          required(key_of(Kind::text, "y", "formula of its columns", "\"force\"")),
          key_of(Kind::text, "where", "only rows in which this formula of the columns is zero", "\"shear_ratio - 1\"")};
}

}  // namespace monograin::definition
