/// Keys of a sweep file, and the designs that use them. For readers of TOML files: includes the library.
#pragma once

#include <toml++/toml.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/language.hpp"

namespace monograin::sweep {

inline constexpr double k_most_runs = 1e6;
inline constexpr std::array<std::string_view, 9> k_designs{"grid", "table",  "maxpro",   "sobol", "halton",
                                                           "lhs",  "random", "saltelli", "morris"};
/// Lists of designs, as messages name them: those that take a number of runs, a seed, correlated inputs, and a number
/// of samples.
inline constexpr std::string_view k_filling_designs = "maxpro, sobol, halton, lhs, random";
inline constexpr std::string_view k_random_designs = "maxpro, sobol, halton, lhs, random, saltelli, morris";
inline constexpr std::string_view k_correlated_designs = "sobol, halton, lhs, random";
inline constexpr std::string_view k_index_designs = "saltelli, morris";

[[nodiscard]] bool is_one_of(std::string_view design, std::string_view listed);

/// Keys of the sweep as a whole. @param contains_scenario  true if the scenario stands in the file itself
[[nodiscard]] std::vector<KeySpec> root_keys(bool contains_scenario);

/// Keys of the percentile bands of histories.
[[nodiscard]] std::vector<KeySpec> band_keys();

/// Text of the part of a sweep file that determines the runs: without the evaluation of results, comments and layout.
[[nodiscard]] std::string text_of_runs(const toml::table& tree);

}  // namespace monograin::sweep
