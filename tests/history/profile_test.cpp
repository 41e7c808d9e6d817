#include "history/profile.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "catalogue.hpp"
#include "support/test_run.hpp"

namespace monograin::profile_test {
namespace {

constexpr std::size_t k_radius = 1;
constexpr std::size_t k_pressure = 2;
constexpr std::size_t k_displacement = 3;
constexpr std::size_t k_height = 4;

CheckedScenario pressed(double surface_energy = 0.0) {
  CheckedScenario scenario = mdr_scenario(Configuration::simple, 50.0, 0.3, path({0.2, 0.19}));
  scenario.material["surface_energy"] = surface_energy;
  return scenario;
}

double at_instant(const CheckedScenario& scenario, double time, const std::string& column) {
  CheckedScenario asked = scenario;
  asked.output.times = {time};
  const TestRun result = run(asked);
  return result.outputs(column).back();
}

TEST(ContactProfiles, BearTheForceOfTheHistory) {
  // At the largest overlap the pressure is uniform; on the way back the trapezoidal rule sees a root at the edge.
  for (const auto& [time, tolerance] : {std::pair(0.9, 1e-12), std::pair(1.5, 2e-3)}) {
    const Table profiles = contact_profiles(pressed(), time);
    double force = 0.0;
    for (std::size_t i = 0; i + 1 < profiles.row_count() / 2; ++i) {
      const double r0 = profiles.at(i, k_radius);
      const double r1 = profiles.at(i + 1, k_radius);
      const double p = 0.5 * (profiles.at(i, k_pressure) + profiles.at(i + 1, k_pressure));
      force += std::numbers::pi * (r1 - r0) * (r1 + r0) * p;
    }
    const double last = profiles.at(profiles.row_count() / 2 - 1, k_radius);
    const double a = at_instant(pressed(), time, "axial.contact_radius");
    force += std::numbers::pi * (a - last) * (a + last) * profiles.at(profiles.row_count() / 2 - 1, k_pressure);
    EXPECT_NEAR(force / at_instant(pressed(), time, "axial.force"), 1.0, tolerance) << "t = " << time;
  }
}

TEST(ContactProfiles, AreFlatInContactAndPulledAtAnAdhesiveEdge) {
  const Table profiles = contact_profiles(pressed(1e-4), 1.9);
  const std::size_t inside = profiles.row_count() / 2;
  const double depth = profiles.at(0, k_displacement);
  for (std::size_t i = 0; i < inside; ++i) {
    EXPECT_NEAR(profiles.at(i, k_displacement) + profiles.at(i, k_height), depth, 1e-14);
  }
  EXPECT_GT(profiles.at(0, k_pressure), 0.0);
  EXPECT_LT(profiles.at(inside - 1, k_pressure), 0.0);
  EXPECT_EQ(profiles.at(inside, k_pressure), 0.0);
}

TEST(ContactProfiles, SayWhyThereAreNone) {
  const auto message_at = [](const std::vector<double>& displacements, double time,
                             Configuration configuration = Configuration::simple) -> std::string {
    try {
      static_cast<void>(contact_profiles(mdr_scenario(configuration, 50.0, 0.3, path(displacements)), time));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message_at({0.1}, 7.0), "there is no profile at t = 7 s: the run does not come to that instant");
  EXPECT_EQ(message_at({0.1, -0.1}, 1.9), "there is no profile at t = 1.9 s: no contact is closed then");
  for (const double time : {HUGE_VAL, std::nan(""), -1.0}) {
    EXPECT_NE(message_at({0.1}, time).find("expected a finite instant, 0 or later"), std::string::npos) << time;
  }
  const std::string used_up = message_at({0.6}, 0.999, Configuration::die);
  EXPECT_NE(used_up.find("the run ended before, at step 1"), std::string::npos) << used_up;
}

TEST(ContactProfiles, AreThoseJustBeforeAnEventAtItsTime) {
  CheckedScenario scenario = mdr_scenario(Configuration::simple, 50.0, 0.3, path({0.2, 0.1}));
  scenario.material["surface_energy"] = 1e-4;
  const double pulled_off = run(scenario).time_of("pull-off");
  EXPECT_GT(contact_profiles(scenario, pulled_off).row_count(), 0U);
  EXPECT_THROW(static_cast<void>(contact_profiles(scenario, 1.001 * pulled_off)), std::runtime_error);
}

TEST(ContactProfiles, AreThereForTheModelsThatClaimThem) {
  std::size_t with_profile = 0;
  for (const Model& model : model_catalogue()) {
    const std::filesystem::path file =
        fmt::format(MONOGRAIN_SOURCE_DIR "/scenarios/{}.toml", model.name == "mdr" ? "die" : model.name);
    ASSERT_TRUE(std::filesystem::exists(file)) << file;
    const CheckedScenario ready = read_scenario(file);
    ASSERT_EQ(ready.model, model.name);
    if (model.has_profile) {
      ++with_profile;
      EXPECT_GT(contact_profiles(ready, 0.1).row_count(), 0U) << model.name;
    } else {
      EXPECT_THROW(static_cast<void>(contact_profiles(ready, 0.1)), std::runtime_error) << model.name;
    }
  }
  EXPECT_GE(with_profile, 3U);
}

}  // namespace
}  // namespace monograin::profile_test
