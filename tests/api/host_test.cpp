// What a program that uses the library may do to it, and the library not to the program.

#include <fenv.h>
#include <gsl/gsl_errno.h>
#include <gtest/gtest.h>

#include <cfenv>
#include <filesystem>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "api/ready.hpp"
#include "monograin/monograin.hpp"
#include "monograin/study.hpp"
#include "support/temporary_folder.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

constexpr int k_traps = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW;

/// Traps floating-point exceptions, as simulation codes do.
class Traps {
 public:
  Traps() {
    std::feclearexcept(FE_ALL_EXCEPT);
    feenableexcept(k_traps);
  }
  ~Traps() {
    fedisableexcept(FE_ALL_EXCEPT);
    std::feclearexcept(FE_ALL_EXCEPT);
  }
  Traps(const Traps&) = delete;
  Traps& operator=(const Traps&) = delete;
};

TEST(Host, MayTrapFloatingPointExceptions) {
  const TemporaryFolder folder;
  const fs::path calibration = fs::path(MONOGRAIN_SOURCE_DIR) / "scenarios" / "calibrate" / "compressible.toml";
  const Traps traps;
  for (const char* const name : {"cel.toml", "die.toml", "nonlocal.toml", "late-wall.toml"}) {
    EXPECT_EQ(run(ready_scenario(name)).status, RunStatus::complete) << name;
  }
  const RunResult of_packing = run(ready_scenario("packing.toml"));
  EXPECT_EQ(compare(of_packing.history, of_packing.history).gaps.size(), 0U);
  const RunResult of_nonlocal = run(ready_scenario("nonlocal.toml"));
  EXPECT_GT(of_nonlocal.force_table().row_count(), 0U);
  of_nonlocal.save(folder.path() / "nonlocal");
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(History({{"word", "", {"a"}, {none, 0.0}}}).words("word"), (std::vector<std::string>{"", "a"}));
  const PreparedScenario prepared(ready_scenario("hertz.toml"), {"material.poisson_ratio"});
  const MapResult mapped =
      prepared.map(std::vector{0.2, 0.3}, std::vector<std::string>{"1 / (end(work) - end(work))"}, {.threads = 2});
  EXPECT_EQ(mapped.values.size(), 2U);
  EXPECT_TRUE(study::calibrate({.file = calibration}).warnings.empty());
  EXPECT_EQ(fegetexcept(), k_traps);
  EXPECT_EQ(std::fetestexcept(k_traps), 0) << "no flag of the library's own is left";
}

TEST(Host, MayReadResultsAndPreparedScenariosThatItHasMoved) {
  RunResult result = run(ready_scenario("hertz.toml"));
  const RunResult taken = std::move(result);
  EXPECT_EQ(result.json(), taken.json());  // NOLINT(bugprone-use-after-move)
  EXPECT_EQ(result.history.row_count(), taken.history.row_count());
  PreparedScenario prepared(ready_scenario("hertz.toml"), {"material.poisson_ratio"});
  const PreparedScenario other = std::move(prepared);
  EXPECT_EQ(prepared.keys(), other.keys());  // NOLINT(bugprone-use-after-move)
}

TEST(Host, MayChangeTheFilesOfAPreparedScenario) {
  const TemporaryFolder folder;
  const fs::path ready = fs::path(MONOGRAIN_SOURCE_DIR) / "scenarios";
  for (const char* const name : {"hollomon.toml", "hollomon-pressure.csv"})
    fs::copy_file(ready / name, folder.path() / name);
  const PreparedScenario prepared(read_scenario(folder.path() / "hollomon.toml"), {"material.poisson_ratio"});
  const std::vector<double> value{0.3};
  const double before = prepared.run(value).history["axial.force"].back();
  fs::remove(folder.path() / "hollomon-pressure.csv");
  EXPECT_EQ(prepared.run(value).history["axial.force"].back(), before);
}

void handler(const char*, const char*, int, int) {}

TEST(Host, KeepsItsErrorHandlerOfGsl) {
  gsl_error_handler_t* const before = gsl_set_error_handler(handler);
  Scenario scenario = ready_scenario("hertz.toml");
  scenario.set("numerics.integrator", "gsl-rk8pd");
  std::vector<std::jthread> threads;
  for (int k = 0; k < 4; ++k) threads.emplace_back([&scenario] { static_cast<void>(run(scenario)); });
  threads.clear();
  EXPECT_EQ(gsl_set_error_handler(before), handler);
}

}  // namespace
}  // namespace monograin
