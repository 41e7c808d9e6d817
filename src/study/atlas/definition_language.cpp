#include "study/atlas/definition_language.hpp"

#include <string>
#include <utility>

#include "study/atlas/adhesion_map.hpp"

namespace monograin::definition {
namespace {

using Kind = KeySpec::Kind;

KeySpec text_key(std::string_view name, std::string_view meaning, std::string example, bool is_required = false) {
  return {
      .name = name, .meaning = meaning, .kind = Kind::text, .is_required = is_required, .example = std::move(example)};
}

KeySpec number_key(std::string_view name, std::string_view meaning, bool is_required = false) {
  return {.name = name,
          .meaning = meaning,
          .kind = Kind::quantity,
          .is_required = is_required,
          .range = {.lower = -1e100, .upper = 1e100},
          .example = "0.5"};
}

template <std::size_t N>
KeySpec choice_key(std::string_view name, std::string_view meaning, const std::array<std::string_view, N>& choices) {
  return {.name = name,
          .meaning = meaning,
          .kind = Kind::choice,
          .choices = {choices.begin(), choices.end()},
          .default_value = choices.front()};
}

KeySpec count_key(std::string_view name, std::string_view meaning, double upper) {
  return {
      .name = name, .meaning = meaning, .kind = Kind::integer, .range = {.lower = 1.0, .upper = upper}, .example = "1"};
}

KeySpec tables_key(std::string_view name, std::string_view meaning, std::string example, bool is_required = false) {
  return {.name = name,
          .meaning = meaning,
          .kind = Kind::tables,
          .is_required = is_required,
          .example = std::move(example)};
}

KeySpec table_key(std::string_view name, std::string_view meaning, std::string example, bool is_required = false) {
  return {
      .name = name, .meaning = meaning, .kind = Kind::table, .is_required = is_required, .example = std::move(example)};
}

KeySpec measures_key() {
  return {.name = "measures",
          .meaning = "what is shown of each comparison",
          .kind = Kind::texts,
          .example = "[\"largest\", \"rms\"]"};
}

KeySpec overrides_key(std::string_view meaning) {
  return {.name = "set", .meaning = meaning, .kind = Kind::texts, .example = "[\"material.yield_stress=20 MPa\"]"};
}

/// Appends the keys of axes and runs, which may be given once for all panels, or for all curves of a panel.
void append_shared_keys(Keys& keys) {
  keys.push_back(table_key("vary", "one curve for each value of a key", "{ key = \"...\", values = [...] }"));
  keys.push_back({.name = "against",
                  .meaning = "y is the distance from y of a run with these overrides besides",
                  .kind = Kind::texts,
                  .example = "[\"numerics.rtol=1e-13\"]"});
  keys.push_back(text_key("x", "formula of the abscissa", k_example_x));
  keys.push_back(text_key("y", "formula of the ordinate", k_example_y));
  keys.push_back(text_key("x_label", "label of the abscissa", "\"Displacement\""));
  keys.push_back(text_key("y_label", "label of the ordinate", "\"Force\""));
  keys.push_back(number_key("x_min", "left end of the abscissa"));
  keys.push_back(number_key("x_max", "right end of the abscissa"));
  keys.push_back(number_key("y_min", "lower end of the ordinate"));
  keys.push_back(number_key("y_max", "upper end of the ordinate"));
  keys.push_back(table_key("fitted",
                           "part of the abscissa to which a law was fitted or in which it holds; beyond is shaded",
                           "{ from = 0.03, to = 0.5 }"));
  keys.push_back({.name = "x_log", .meaning = "logarithmic abscissa", .kind = Kind::toggle});
  keys.push_back({.name = "y_log", .meaning = "logarithmic ordinate", .kind = Kind::toggle});
}

}  // namespace

Keys root_keys() {
  static constexpr std::array<std::string_view, 3> formats{"svg", "pdf", "png"};
  Keys keys{text_key("title", "what the figure shows", "\"Force over displacement\"", true),
            text_key("source", "figure and document that show it too", "\"Fig. 8 of ...\"", true),
            choice_key("format", "format of the figure", formats),
            table_key("scenario", "the scenario of curves that name no file", "[scenario]"),
            table_key("adhesion_map", "phase diagrams of adhesion as panels", "[adhesion_map]"),
            tables_key("panel", "panels of the figure", "[[panel]]"),
            tables_key("curve", "curves of every panel, before its own", "[[curve]]"),
            tables_key("table", "tables of how far curves are from points", "[[table]]"),
            tables_key("values", "tables of single values", "[[values]]")};
  append_shared_keys(keys);
  return keys;
}

Keys panel_keys() {
  Keys keys{text_key("note", "text above the panel", "\"E/Y = 200\""),
            overrides_key("overrides of the scenario of every curve"),
            tables_key("curve", "curves from runs", "[[panel.curve]]"),
            tables_key("points", "points from files", "[[panel.points]]")};
  append_shared_keys(keys);
  return keys;
}

Keys curve_keys() {
  return {text_key("scenario", "scenario file, sought from the definition's folder", "\"../scenarios/die.toml\""),
          overrides_key("overrides of the scenario"),
          table_key("vary", "one curve for each value of a key", "{ key = \"...\", values = [...] }"),
          {.name = "against",
           .meaning = "y is the distance from y of a run with these overrides besides",
           .kind = Kind::texts,
           .example = "[\"numerics.rtol=1e-13\"]"},
          table_key("sweep", "instead of a history: the parameters that the model derives, over a key's values",
                    "{ key = \"...\", from = 1, to = 2 }"),
          number_key("profile_at", "instead of a history: contact profiles of the first class at this instant [s]"),
          text_key("at_event", "instead of a history: the states just after events of this name", "\"impingement\""),
          table_key("parameter", "instead of a history: range of t in the formulas", "{ from = 0, to = 1 }"),
          text_key("x", "formula of the abscissa", k_example_x),
          text_key("y", "formula of the ordinate", k_example_y),
          text_key("legend", "text in the legend", "\"model\""),
          choice_key("rows", "which way of x is shown", k_rows),
          choice_key("style", "how the line is drawn", k_styles),
          count_key("colour", "place among the colours", 6.0)};
}

Keys vary_keys() {
  return {text_key("key", "key of the scenario", "\"material.poisson_ratio\"", true),
          {.name = "values", .meaning = "its values", .kind = Kind::texts, .is_required = true, .example = "[0, 0.3]"},
          {.name = "legends", .meaning = "a text for each value", .kind = Kind::texts, .example = "[\"low\"]"},
          {.name = "styles",
           .meaning = "how the line of each value is drawn",
           .kind = Kind::texts,
           .example = "[\"solid\"]"}};
}

Keys sweep_keys() {
  Keys keys{text_key("key", "key of the scenario", "\"material.youngs_modulus\"", true),
            number_key("from", "its first value, in SI", true),
            number_key("to", "its last value, in SI", true),
            count_key("points", "how many values", 10000.0),
            {.name = "log", .meaning = "values in equal ratios", .kind = Kind::toggle}};
  keys[3].range.lower = 2.0;
  keys[3].default_value = 101.0;
  return keys;
}

Keys parameter_keys() {
  return {number_key("from", "first value of t", true), number_key("to", "last value of t", true)};
}

Keys fitted_keys() {
  Keys keys{number_key("from", "its lower end"), number_key("to", "its upper end"),
            text_key("label", "text in the legend for what lies beyond", "\"beyond the fitted range\"")};
  keys[2].default_value = std::string_view("beyond the fitted range");
  return keys;
}

Keys points_keys() {
  return {text_key("file", "CSV file, sought from the definition's folder", "\"fe/points.csv\"", true),
          text_key("x", "formula of its columns", "\"displacement\"", true),
          text_key("y", "formula of its columns; a table may give it for all rows", "\"force\""),
          text_key("legend", "text in the legend", "\"finite elements\""),
          choice_key("rows", "which way of x is shown", k_rows),
          text_key("where", "only rows in which this formula of the columns is zero", "\"shear_ratio - 1\""),
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
            choice_key("control", "what is controlled at pull-off", controls)};
  keys[3].range.lower = 2.0;
  keys[3].default_value = static_cast<double>(defaults.points);
  keys[4].range = {.lower = -1.0, .upper = 0.5, .lower_is_open = true};
  keys[4].default_value = defaults.poisson_ratio;
  return keys;
}

Keys comparison_table_keys() {
  return {text_key("title", "what is compared", "\"Force\"", true),
          text_key("x", "formula of the abscissa", k_example_x),
          text_key("y", "formula of the ordinate", k_example_y),
          table_key("vary", "one line for each value of a key, in every row", "{ key = \"model\", values = [...] }"),
          {.name = "bands",
           .meaning = "ends of bands of x to measure instead of the loading up to each reversal",
           .kind = Kind::instants,
           .example = "[0.05, 0.5]"},
          measures_key(),
          tables_key("quantity", "quantities that every row is asked for", "[[table.quantity]]"),
          tables_key("row", "comparisons", "[[table.row]]", true)};
}

Keys quantity_keys() {
  return {text_key("name", "name of the quantity", "\"axial force\"", true),
          text_key("y", "formula of the ordinate", k_example_y, true),
          text_key("reference", "formula of the columns of the points", "\"force\"", true),
          text_key("least", "loading with y up to this is not measured in bands; a formula of the run's numbers",
                   "\"1e-3 * Y / E\""),
          measures_key()};
}

Keys comparison_keys() {
  return {text_key("label", "name of the row", "\"E/Y = 200\"", true),
          table_key("curve", "the curve", "curve = { ... }", true),
          table_key("points", "what it is held against", "points = { ... }", true)};
}

Keys value_table_keys() {
  return {text_key("title", "what the values are", "\"Coefficients\"", true),
          tables_key("row", "values", "[[values.row]]", true)};
}

Keys value_keys() {
  return {text_key("label", "name of the row", "\"D1\"", true),
          text_key("scenario", "scenario file, sought from the definition's folder", "\"../scenarios/die.toml\""),
          overrides_key("overrides of the scenario"),
          text_key("value", "formula of the parameters that the model derives", "\"radius_first\"", true),
          text_key("printed", "the value as the source prints it", "\"1.7527\""),
          table_key("reference", "instead: rows of a file, whose mean it is held against",
                    "{ file = \"...\", y = \"...\" }"),
          text_key("remark", "what is to be said of it", "\"...\"")};
}

Keys reference_keys() {
  return {text_key("file", "CSV file, sought from the definition's folder", "\"fe/points.csv\"", true),
          text_key("y", "formula of its columns", "\"force\"", true),
          text_key("where", "only rows in which this formula of the columns is zero", "\"shear_ratio - 1\"")};
}

}  // namespace monograin::definition
