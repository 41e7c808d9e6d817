/// Shared by the tests of the scenario language.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace monograin {

/// A small valid scenario; every line of it is known to the tests by its number.
inline constexpr std::string_view k_good_scenario =
    "title = \"t\"\n"       // 1
    "model = \"mdr\"\n"     // 2
    "[particle]\n"          // 3
    "radius = \"10 mm\"\n"  // 4
    "[material]\n"          // 5
    "youngs_modulus = \"1 GPa\"\n"
    "poisson_ratio = 0.3\n"
    "yield_stress = \"50 MPa\"\n"
    "[loading]\n"  // 9
    "configuration = \"simple\"\n"
    "[[loading.steps]]\n"  // 11
    "displacement = \"0.1 R0\"\n"
    "duration = \"1 s\"\n";  // 13

/// The small scenario with this line (counted from 1) put in place of its own.
[[nodiscard]] std::string with_line(std::size_t number, std::string_view line);

/// The small scenario with these lines at its end.
[[nodiscard]] std::string with_more(std::string_view lines);

/// The small scenario without its `[loading]`, and these lines instead.
[[nodiscard]] std::string with_loading(std::string_view lines);

/// The messages with which a text is refused, one string each; none if it is accepted.
[[nodiscard]] std::vector<std::string> faults_of(std::string_view text, const std::vector<std::string>& overrides = {});

/// The TOML files of a folder of the source tree, sorted.
[[nodiscard]] std::vector<std::filesystem::path> toml_files(std::string_view folder);

}  // namespace monograin
