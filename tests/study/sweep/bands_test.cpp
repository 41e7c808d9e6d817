#include "study/sweep/bands.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "history/table.hpp"
#include "study/sweep/sweep.hpp"
#include "study/sweep/sweep_file_test.hpp"
#include "support/scenario_texts.hpp"
#include "support/text_file.hpp"

namespace monograin::bands_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_spread = R"toml(design = "random"
runs = 40
[vary]
"material.youngs_modulus" = { mean = "2 GPa", std = "0.2 GPa" }
[bands]
x = "axial.displacement"
y = ["axial.force", "axial.contact_radius"]
points = 11
[scenario]
model = "hertz"
[scenario.particle]
radius = "10 mm"
[scenario.material]
poisson_ratio = 0.0
[scenario.loading]
configuration = "simple"
steps = [{ displacement = "0.02 R0", duration = "1 s" }, { displacement = "0.01 R0", duration = "1 s" }]
[scenario.output]
points = 2000
)toml";

class Bands : public SweepFileTest {
 protected:
  [[nodiscard]] HistoryBands bands(const Sweep& sweep, const std::string& name) const {
    EXPECT_EQ(run_sweep(sweep, {.folder = folder() / name, .threads = 2, .shard = {}, .progress = {}}).runs_missing,
              0U);
    return bands_of(sweep, folder() / name);
  }
};

TEST_F(Bands, OfAForceInProportionToTheModulusAreThoseOfTheModulus) {
  const Sweep sweep = read(k_spread);
  const HistoryBands found = bands(sweep, "out");
  const Table results = read_csv(folder() / "out/results.csv");
  std::vector<double> moduli = results.column("material.youngs_modulus");
  std::ranges::sort(moduli);
  ASSERT_EQ(found.steps.size(), 2U);
  // The p-th percentile of n values in their order lies at p (n - 1), from 0 on.
  const auto percentile = [&moduli](double share) {
    const double place = share * 39.0;
    const auto below = static_cast<std::size_t>(place);
    return moduli[below] + (place - static_cast<double>(below)) * (moduli[below + 1] - moduli[below]);
  };
  for (const StepBands& step : found.steps) {
    ASSERT_EQ(step.x.size(), 11U);
    EXPECT_NEAR(step.x.front(), step.step == 1 ? 0.0 : 2e-4, 1e-18);
    EXPECT_NEAR(step.x.back(), step.step == 1 ? 2e-4 : 1e-4, 1e-18);
    for (std::size_t i = 0; i < step.x.size(); ++i) {
      EXPECT_EQ(step.runs[i], 40U);
      for (std::size_t p = 0; p < 3; ++p) {
        const double modulus = percentile(0.01 * sweep.bands->percentiles[p]);
        const double force = 4.0 / 3.0 * modulus * std::sqrt(0.01) * std::pow(step.x[i], 1.5);
        // 2000 rows: straight lines between them are off by 1e-6 of the largest force at most.
        EXPECT_NEAR(step.percentiles[0][p][i], force, 1e-6 * 4.0 / 3.0 * 3e9 * 0.1 * std::pow(2e-4, 1.5));
      }
      // The contact radius knows nothing of the modulus.
      EXPECT_NEAR(step.percentiles[1][0][i], step.percentiles[1][2][i], 1e-12);
    }
  }
}

TEST_F(Bands, AreNotGivenWhereRunsAreMissing) {
  // Forces hold the walls: a soft particle goes further than a stiff one.
  const Sweep sweep = read(replaced(replaced(k_spread, "displacement = \"0.02 R0\"", "force = \"100 N\""),
                                    "displacement = \"0.01 R0\"", "force = \"10 N\""));
  const HistoryBands found = bands(sweep, "out");
  const StepBands& step = found.steps.at(0);
  EXPECT_EQ(step.runs.front(), 40U);
  EXPECT_EQ(step.runs.back(), 1U);
  for (std::size_t i = 0; i < step.x.size(); ++i) {
    EXPECT_EQ(std::isnan(step.percentiles[0][1][i]), step.runs[i] < 38U) << step.runs[i];
  }
}

TEST_F(Bands, CountRunsThatWereRefused) {
  // One modulus in 40 may be missing, three may not.
  for (const auto& [lowest, is_given] : {std::pair("-0.02 GPa", true), {"-0.2 GPa", false}}) {
    std::string text = replaced(k_spread, "design = \"random\"\nruns = 40\n", "design = \"grid\"\n");
    text = replaced(text, "{ mean = \"2 GPa\", std = \"0.2 GPa\" }",
                    std::string("{ from = \"") + lowest + "\", to = \"2 GPa\", points = 40 }");
    const Sweep sweep = read(text);
    const HistoryBands found = bands(sweep, lowest);
    EXPECT_EQ(std::isfinite(found.steps.at(0).percentiles[0][1][5]), is_given) << lowest;
  }
}

TEST_F(Bands, ReachTheEndOfAStepWhereRunsDifferByRoundOff) {
  std::string text = k_spread;
  const auto replace = [&text](const std::string& old, const std::string& by) {
    text.replace(text.find(old), old.size(), by);
  };
  replace("\"material.youngs_modulus\" = { mean = \"2 GPa\", std = \"0.2 GPa\" }",
          "\"particle.radius\" = { mean = \"10 mm\", std = \"0.3 mm\" }");
  replace("poisson_ratio = 0.0", "poisson_ratio = 0.0\nyoungs_modulus = \"2 GPa\"");
  replace("0.02 R0", "0.1 mm");
  replace("0.01 R0", "0.07 mm");
  const HistoryBands found = bands(read(text), "out");
  ASSERT_EQ(found.steps.size(), 2U);
  for (const StepBands& step : found.steps) {
    for (const std::size_t runs : step.runs) EXPECT_EQ(runs, 40U) << step.step;
  }
}

TEST_F(Bands, TakeEveryStepForItself) {
  const HistoryBands found = bands(read(k_spread), "out");
  EXPECT_LT(found.steps[0].x[0], found.steps[0].x[1]) << "loading";
  EXPECT_GT(found.steps[1].x[0], found.steps[1].x[1]) << "unloading";
}

TEST_F(Bands, AreATableAndAFigureTheSameForAnyThreadsAndShards) {
  const Sweep sweep = read(k_spread);
  EXPECT_EQ(write_bands(sweep, bands(sweep, "one"), folder() / "one"), "");
  for (const std::size_t shard : {2U, 1U}) {
    static_cast<void>(
        run_sweep(sweep, {.folder = folder() / "two", .threads = 1, .shard = {shard, 2}, .progress = {}}));
  }
  EXPECT_EQ(write_bands(sweep, bands(sweep, "two"), folder() / "two"), "");
  const std::string table = read_text(folder() / "one/bands.csv");
  EXPECT_NE(table.find("step,axial.displacement[m],runs,p5.axial.force[N],p50.axial.force[N],p95.axial.force[N],"
                       "p5.axial.contact_radius[m]"),
            std::string::npos)
      << table.substr(0, 400);
  EXPECT_EQ(read_csv(folder() / "one/bands.csv").row_count(), 22U);
  EXPECT_EQ(table, read_text(folder() / "two/bands.csv"));
  EXPECT_GT(fs::file_size(folder() / "one/bands.svg"), 300U);
}

TEST_F(Bands, AskedForLaterNeedNoNewRuns) {
  const std::string only_histories = replaced(
      k_spread, "[bands]\nx = \"axial.displacement\"\ny = [\"axial.force\", \"axial.contact_radius\"]\npoints = 11\n",
      "");
  const Sweep before = read("histories = true\n" + only_histories);
  static_cast<void>(run_sweep(before, {.folder = folder() / "out", .threads = 2, .shard = {}, .progress = {}}));
  const SweepOutcome outcome =
      run_sweep(read(k_spread), {.folder = folder() / "out", .threads = 2, .shard = {}, .progress = {}});
  EXPECT_EQ(outcome.runs_before, 40U);
}

TEST_F(Bands, OfAColumnThatIsNotThereAreRefusedBeforeTheFirstRun) {
  const std::string found = fault(replaced(k_spread, "\"axial.force\"", "\"axial.farce\""));
  EXPECT_NE(found.find("s.toml:7:6: 'axial.farce' is no column of the histories; expected one of time, "),
            std::string::npos)
      << found;
  EXPECT_NE(found.find("did you mean 'axial.force'?"), std::string::npos) << found;
}

TEST_F(Bands, NeedPercentilesInTheirOrder) {
  for (const char* bad : {"[50, 5]", "[5, 5]", "[-1]", "[101]", "[\"x\"]"}) {
    const std::string text = replaced(k_spread, "points = 11", fmt::format("points = 11\npercentiles = {}", bad));
    EXPECT_NE(fault(text).find("expected ascending numbers between 0 and 100"), std::string::npos)
        << bad << fault(text);
  }
  EXPECT_NE(fault(replaced(k_spread, "x = \"axial.displacement\"\n", "")).find("'x'"), std::string::npos);
}

}  // namespace
}  // namespace monograin::bands_test
