#include "study/sweep/sweep_language.hpp"

#include <algorithm>
#include <cstddef>
#include <sstream>

namespace monograin::sweep {

using Kind = KeySpec::Kind;

bool is_one_of(std::string_view design, std::string_view listed) {
  for (std::size_t begin = 0; begin < listed.size();) {
    const std::size_t end = std::min(listed.find(", ", begin), listed.size());
    if (listed.substr(begin, end - begin) == design) return true;
    begin = end + 2;
  }
  return false;
}

std::vector<KeySpec> root_keys(bool contains_scenario) {
  return {
      key_of(Kind::text, "title", "what is varied", "\"granules, batch 12\""),
      required(key_of(contains_scenario ? Kind::table : Kind::file, "scenario",
                      "scenario that is varied, or the name of its file",
                      contains_scenario ? "[scenario]" : "\"die.toml\"")),
      first_by_default(choice_key("design", "how the runs are chosen", k_designs)),
      {.name = "runs",
       .meaning = "number of runs of a design that fills the space",
       .kind = Kind::integer,
       .range = {.lower = 2.0, .upper = k_most_runs},
       .example = "100",
       .only_with = k_filling_designs},
      {.name = "samples",
       .meaning = "of saltelli: points whose changes are followed; of morris: trajectories",
       .kind = Kind::integer,
       .range = {.lower = 2.0, .upper = k_most_runs},
       .example = "512",
       .only_with = k_index_designs},
      {.name = "seed",
       .meaning = "seed of a design that is drawn",
       .kind = Kind::integer,
       .range = {.lower = 0.0, .upper = 1e15},
       .default_value = 1.0,
       .only_with = k_random_designs},
      {.name = "results",
       .meaning = "formulas over columns of the results, for which indices are estimated",
       .kind = Kind::texts,
       .example = "[\"max.axial.force\"]",
       .only_with = k_index_designs},
      {.name = "table",
       .meaning = "file with one column per key",
       .kind = Kind::file,
       .example = "\"runs.csv\"",
       .only_with = "table"},
      key_of(Kind::table, "bands", "percentiles of the histories over common abscissae", "[bands]"),
      {.name = "histories", .meaning = "keep the history of every run", .kind = Kind::toggle, .default_value = false},
      key_of(Kind::texts, "columns",
             "columns of the results; what they do not need is not computed [all end. and max.]",
             "[\"end.apparent_radius\", \"max.axial.force\"]"),
      {.name = "vary",
       .meaning = "the keys that are varied, and over what",
       .kind = Kind::table,
       .may_be_empty = false,
       .example = "[vary]"},
      {.name = "calibration",
       .meaning =
           "result of a calibration whose numbers are varied, with their covariance: its folder or calibration.json",
       .kind = Kind::file,
       .example = "\"runs/fit\"",
       .only_with = k_correlated_designs},
      key_of(Kind::texts, "constraints", "inequalities between varied keys, in SI",
             "[\"100 <= material.youngs_modulus / material.yield_stress\"]"),
  };
}

std::vector<KeySpec> band_keys() {
  return {
      required(key_of(Kind::text, "x", "column of the histories: the abscissa", "\"axial.displacement\"")),
      required(key_of(Kind::texts, "y", "columns of the histories whose spread is asked for", "[\"axial.force\"]")),
      key_of(Kind::texts, "percentiles", "ascending, between 0 and 100", "[5, 50, 95]"),
      {.name = "points",
       .meaning = "abscissae in each step of the program",
       .kind = Kind::integer,
       .range = {.lower = 2.0, .upper = 10000.0},
       .default_value = 51.0},
  };
}

std::string text_of_runs(const toml::table& tree) {
  toml::table runs = tree;
  runs.erase("title");
  runs.erase("results");
  if (runs.erase("bands") > 0) runs.insert_or_assign("histories", true);
  std::ostringstream text;
  text.exceptions(std::ios::badbit);  // an allocation that fails must not cut the text
  text << runs;
  return text.str();
}

}  // namespace monograin::sweep
