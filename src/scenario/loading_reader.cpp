#include "scenario/loading_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "scenario/program_reader.hpp"
#include "scenario/program_rules.hpp"
#include "scenario/shared_times.hpp"
#include "scenario/words.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

using Configuration = Loading::Configuration;

/// Contact classes of a preset configuration.
std::vector<std::string_view> classes_of(std::string_view configuration) {
  if (configuration == "die") return {"axial", "lateral"};
  if (configuration == "oblique-die") return {"axial", "lateral-x", "lateral-y", "oblique"};
  if (configuration == "simple" || configuration == "hydrostatic") return {"axial"};
  return {};
}

/// Reads one `[loading]` table.
class LoadingReader {
 public:
  LoadingReader(Reading& reading, Section::Origin table, const Language& language)
      : reading_(reading),
        language_(language),
        section_(reading, std::move(table), language.loading, language.foreign_loading),
        programs_(reading, language) {}

  Loading read() {
    const std::string configuration = section_.text("configuration");
    check_keys_of_configurations(configuration);
    if (const auto word = std::ranges::find(k_configurations, configuration); word != k_configurations.end()) {
      loading_.configuration = static_cast<Configuration>(word - k_configurations.begin());
    }
    loading_.centre_is_free = section_.text("centre") == "equilibrium";
    loading_.oblique_angle = section_.number("angle").value_or(0.0);
    loading_.oblique_walls = static_cast<int>(section_.number("oblique_walls").value_or(0.0));
    loading_.steps = programs_.read(section_, "steps", "[[loading.steps]]");
    for (const Section::Origin& wall : section_.tables("wall", "[[loading.wall]]")) read_wall(wall);
    loading_.files = programs_.files();
    check_named_walls(configuration);
    if (configuration == "walls") {
      check_walls();
    } else if (!section_.has_or_misspells("steps")) {
      report_missing("steps");
    }
    // With faults in the programs, differences between them could be mere consequences.
    if (reading_.faults.size() == faults_before_) check_programs(programs_of_walls(), reading_.faults);
    if (reading_.faults.size() == faults_before_) share_times_of_walls();
    return std::move(loading_);
  }

 private:
  void check_keys_of_configurations(const std::string& configuration) {
    if (configuration.empty()) return;
    for (const KeySpec& spec : language_.loading) {
      if (spec.only_with.empty() || spec.only_with == configuration || !section_.has(spec.name)) continue;
      reading_.faults.add(section_.key_place(spec.name),
                          fmt::format("key '{}' goes with configuration = \"{}\" only", spec.name, spec.only_with));
    }
  }

  void report_missing(std::string_view key) {
    reading_.faults.add(section_.place(), fmt::format("key '{}' is missing in [loading]; expected for example {}", key,
                                                      example_line(*find_key(language_.loading, key))));
  }

  void read_wall(const Section::Origin& table) {
    const Section section(reading_, table, language_.wall);
    WallSpec wall;
    wall.where = section.place();
    wall.name = section.text("name");
    if (const auto normal = section.numbers("normal"); normal.size() == 3)
      std::ranges::copy(normal, wall.normal.begin());
    wall.gap = section.number("gap").value_or(0.0);
    wall.is_fixed = section.toggle("fixed").value_or(false);
    wall.steps = programs_.read(section, "steps", "[[loading.wall.steps]]");
    if (wall.is_fixed && section.has("steps")) {
      reading_.faults.add(section.key_place("steps"),
                          "key 'steps' does not go with fixed = true; expected one of them");
    }
    const bool follows = !wall.is_fixed && !section.has_or_misspells("steps");
    if (follows) followers_.push_back(loading_.walls.size());
    loading_.walls.push_back(std::move(wall));
  }

  // --- rules between the walls

  void check_walls() {
    if (!section_.has_or_misspells("wall")) return report_missing("wall");
    if (loading_.walls.size() > static_cast<std::size_t>(k_most_walls)) {
      reading_.faults.add(loading_.walls[k_most_walls].where,
                          fmt::format("there are {} walls; expected at most {}", loading_.walls.size(), k_most_walls));
      return;
    }
    check_names();
    check_directions();
    check_driven();
  }

  /// Reports conditions on walls that the scene does not have.
  void check_named_walls(const std::string& configuration) {
    std::vector<std::string_view> names = classes_of(configuration);
    for (const WallSpec& wall : loading_.walls) names.emplace_back(wall.name);
    if (names.empty()) return;
    for (const auto& [name, where] : programs_.named_walls()) {
      if (std::ranges::find(names, name) != names.end()) continue;
      reading_.faults.add(where, fmt::format("wall = \"{}\": there is no such wall; expected one of {}{}", shown(name),
                                             listed(names), did_you_mean(name, names)));
    }
  }

  void check_names() {
    std::set<std::string_view> names;
    for (const WallSpec& wall : loading_.walls) {
      if (wall.name.empty() || names.insert(wall.name).second) continue;
      reading_.faults.add(wall.where,
                          fmt::format("wall '{}' bears the name of an earlier wall; expected unique names", wall.name));
    }
  }

  void check_directions() {
    for (std::size_t i = 0; i < loading_.walls.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const WallSpec& wall = loading_.walls[i];
        const WallSpec& earlier = loading_.walls[j];
        if (angle_between(wall.normal, earlier.normal) < k_same_direction) {
          reading_.faults.add(
              wall.where, fmt::format("walls '{}' and '{}' have the same normal; expected different ones", earlier.name,
                                      wall.name));
        }
      }
    }
  }

  void check_driven() {
    const auto is_fixed = [](const WallSpec& wall) { return wall.is_fixed; };
    if (!loading_.walls.empty() && std::ranges::all_of(loading_.walls, is_fixed)) {
      reading_.faults.add(section_.key_place("wall"), "no wall is driven; expected steps for one wall at least");
    } else if (section_.has("steps") && followers_.empty()) {
      reading_.faults.add(section_.key_place("steps"),
                          "no wall follows the steps of [loading]: each is fixed or has steps of its own");
    }
    if (section_.has_or_misspells("steps")) return;
    for (const std::size_t follower : followers_) {
      const WallSpec& wall = loading_.walls[follower];
      reading_.faults.add(wall.where, fmt::format("wall '{}' has neither steps nor fixed = true, and [loading] has no "
                                                  "steps for it to follow",
                                                  wall.name));
    }
  }

  [[nodiscard]] std::vector<WallProgram> programs_of_walls() const {
    if (loading_.configuration != Configuration::walls) return {{{}, {}, 0.0, loading_.steps}};
    std::vector<WallProgram> programs;
    for (const WallSpec& wall : loading_.walls) {
      const std::vector<Step>& steps = wall.steps.empty() ? loading_.steps : wall.steps;
      if (!wall.is_fixed && !steps.empty()) programs.push_back({wall.name, wall.where, wall.gap, steps});
    }
    return programs;
  }

  void share_times_of_walls() {
    std::vector<std::vector<Step>*> programs;
    if (!loading_.steps.empty()) programs.push_back(&loading_.steps);
    for (WallSpec& wall : loading_.walls) {
      if (!wall.steps.empty()) programs.push_back(&wall.steps);
    }
    if (programs.size() < 2) return;
    const std::size_t ramps = share_times(programs, k_most_steps);
    if (ramps <= static_cast<std::size_t>(k_most_steps)) return;
    reading_.faults.add(section_.key_place("wall"),
                        fmt::format("the programs of the walls have {} ramps, each divided at the times of all tables "
                                    "and sines; expected at most {}",
                                    ramps, k_most_steps));
  }

  Reading& reading_;
  const Language& language_;
  std::size_t faults_before_ = reading_.faults.size();
  Section section_;
  ProgramReader programs_;
  Loading loading_;
  std::vector<std::size_t> followers_;  ///< walls that are not fixed and have no steps of their own
};

}  // namespace

Loading read_loading(Reading& reading, Section::Origin table, const Language& language) {
  return LoadingReader(reading, std::move(table), language).read();
}

}  // namespace monograin
