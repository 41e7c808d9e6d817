#include "scenario/key_path.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace monograin::key_path_test {
namespace {

constexpr const char* k_scenario = R"toml(model = "hardening"
[loading]
steps = [
  { displacement = "0.1 R0", rate = "1 mm/s", until = { force = "1 N" } },
  { cycle = 2, steps = [{ force = "1 N", rate = "1 N/s" }, { hold = true, duration = "1 s" }] },
]
[[loading.wall]]
name = "top"
normal = [0, 0, 1]
steps = [{ displacement = "0.1 R0", duration = "1 s" }]
)toml";

KeyAnswer ask(std::string_view path, std::string_view model = "hardening") {
  return key_at(path, toml::parse(k_scenario), model);
}

TEST(KeyPaths, LeadToTheKeyThatTheLanguageHasThere) {
  const std::vector<std::pair<const char*, Dimension>> quantities{
      {"particle.radius", Dimension::length},
      {"material.strength", Dimension::stress},
      {"material.hardening_exponent", Dimension::none},
      {"material.ludwik.strength", Dimension::stress},
      {"numerics.rtol", Dimension::none},
      {"loading.angle", Dimension::angle},
      {"loading.steps[0].displacement", Dimension::length},
      {"loading.steps[0].rate", Dimension::velocity},
      {"loading.steps[0].until.force", Dimension::force},
      {"loading.steps[1].steps[0].rate", Dimension::force_rate},
      {"loading.steps[1].steps[1].duration", Dimension::time},
      {"loading.wall[0].gap", Dimension::length},
      {"loading.wall[0].steps[0].duration", Dimension::time},
  };
  for (const auto& [path, dimension] : quantities) {
    const KeyAnswer answer = ask(path);
    ASSERT_TRUE(answer.spec) << path << ": " << answer.problem;
    EXPECT_EQ(answer.spec->kind, KeySpec::Kind::quantity) << path;
    EXPECT_EQ(answer.spec->dimension, dimension) << path;
  }
  EXPECT_EQ(ask("model").spec->kind, KeySpec::Kind::choice);
  EXPECT_EQ(ask("output.points").spec->kind, KeySpec::Kind::integer);
  EXPECT_EQ(ask("hardening.unloading").spec->kind, KeySpec::Kind::choice);
}

TEST(KeyPaths, ThatLeadNowhereAreToldWhy) {
  const std::vector<std::pair<const char*, const char*>> wrong{
      {"", "'' is not the path of a key"},
      {"material..strength", "is not the path of a key"},
      {"material.strenght", "unknown key 'strenght'; did you mean 'strength'?"},
      {"material.surface_energy", "is not used by model 'hardening'"},
      {"materiel.strength", "did you mean 'material'?"},
      {"mdr.radius_rule", "is the table of another model"},
      {"loading.steps[2].displacement", "the scenario has nothing at"},
      {"loading.steps[0].force", "key 'force' does not go with 'displacement' in one step"},
      {"material.radius", "key 'radius' belongs in [particle]"},
      {"particle.radius.value", "has nothing at"},
      {"loading.wall[3].gap", "has nothing at"},
      {"loading.wall[0-3].gap", "the scenario has nothing at 'loading.wall[1].gap'"},
      {"loading.wall[0-].gap", "is not the path of a key"},
  };
  for (const auto& [path, problem] : wrong) {
    const KeyAnswer answer = ask(path);
    EXPECT_FALSE(answer.spec) << path;
    EXPECT_NE(answer.problem.find(problem), std::string::npos) << path << ": " << answer.problem;
  }
}

}  // namespace
}  // namespace monograin::key_path_test
