#include "study/sweep/sweep.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "history/run.hpp"
#include "history/table.hpp"
#include "study/sweep/factor.hpp"
#include "support/refusal.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"

namespace monograin::sweep_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_scenario = R"toml(model = "mdr"
[particle]
radius = "2 mm"
[material]
youngs_modulus = "1 GPa"
poisson_ratio = 0.3
yield_stress = "20 MPa"
[loading]
configuration = "simple"
steps = [{ displacement = "0.1 R0", duration = "1 s" }, { force = "0 N", duration = "1 s" }]
[output]
points = 4
)toml";

constexpr const char* k_grid = R"toml(scenario = "small.toml"
[vary]
"material.poisson_ratio" = { from = 0.2, to = 0.6, points = 5 }
"loading.configuration" = { values = ["simple", "die", "hydrostatic"] }
)toml";

class SweepFiles : public ::testing::Test {
 protected:
  SweepFiles() { write("small.toml", k_scenario); }

  void write(const std::string& file, const std::string& text) const { write_text(path(file), text); }
  [[nodiscard]] fs::path path(const std::string& name) const { return folder_.path() / name; }

  [[nodiscard]] Sweep read(const std::string& text) const {
    write("sweep.toml", text);
    return read_sweep(path("sweep.toml"));
  }

  /// Every fault of the file, without its folder.
  [[nodiscard]] std::vector<std::string> faults_of(const std::string& text) const {
    std::vector<std::string> faults;
    try {
      static_cast<void>(read(text));
    } catch (const ScenarioError& error) {
      for (const Fault& fault : error.faults()) {
        faults.push_back(fs::path(fault.where.file).filename().string() + ":" + std::to_string(fault.where.line) + ":" +
                         std::to_string(fault.where.column) + ": " + fault.message);
      }
    }
    return faults;
  }

  /// The results of a sweep in a folder of that name.
  [[nodiscard]] std::string results(const Sweep& sweep, const std::string& name, int threads = 1) const {
    static_cast<void>(run_sweep(sweep, {.folder = path(name), .threads = threads, .shard = {}, .progress = {}}));
    return read_text(path(name) / "results.csv");
  }

 private:
  TemporaryFolder folder_;
};

/// Names of the files and folders in a folder.
std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
  return names;
}

/// Words first, then numbers.
std::vector<std::string> overrides_of(const Sweep& sweep, std::size_t run) { return scenario_of(sweep, run).overrides; }

/// Columns of results.csv that are values of histories.
std::size_t all_result_count(const Table& results) {
  return static_cast<std::size_t>(std::ranges::count_if(results.columns(), [](const Column& column) {
    return column.name.starts_with("end.") || column.name.starts_with("max.");
  }));
}

double number(const Sweep& sweep, std::size_t run, std::size_t factor) {
  return std::get<double>(sweep.runs[run][factor]);
}

// --- designs

TEST_F(SweepFiles, AreDoubtedWhereNumbersLackAUnit) {
  using Lines = std::vector<std::string>;
  const auto doubts = [this](const std::string& vary) {
    return read("scenario = \"small.toml\"\n[vary]\n" + vary + '\n').doubts;
  };
  const Lines doubt{
      "yield_stress = 80 has no unit and is taken as 80 Pa; if another unit is meant, write it: \"80 MPa\""};
  EXPECT_EQ(doubts("\"material.yield_stress\" = { from = 20, to = 80, points = 3 }"), doubt);
  EXPECT_EQ(doubts("\"material.yield_stress\" = { values = [\"20 MPa\", 80] }"), doubt);
  EXPECT_EQ(doubts("\"material.yield_stress\" = { values = [80, \"20 MPa\"] }"), doubt);
  EXPECT_EQ(doubts("\"material.yield_stress\" = { from = \"20 Pa\", to = \"80 Pa\", points = 3 }"), Lines());
  EXPECT_EQ(doubts("\"loading.steps[0].displacement\" = { from = \"0.1 R0\", to = \"40 R0\" }"), Lines());
  EXPECT_EQ(doubts("\"loading.steps[0].displacement\" = { from = 0, to = 0.4 }").size(), 1U);
  const std::string own = std::string(k_scenario).replace(std::string(k_scenario).find("\"20 MPa\""), 8, "80");
  write("small.toml", own);
  EXPECT_EQ(doubts("\"material.poisson_ratio\" = { from = 0.2, to = 0.3 }"), doubt) << "of the scenario's own";
  write("small.toml", k_scenario);
  write("runs.csv", "material.yield_stress\n20\n80\n");
  const std::string table = "scenario = \"small.toml\"\ndesign = \"table\"\ntable = \"runs.csv\"\n";
  EXPECT_EQ(read(table).doubts, doubt);
  write("runs.csv", "material.yield_stress[MPa]\n20\n80\n");
  EXPECT_EQ(read(table).doubts, Lines());
}

TEST_F(SweepFiles, AGridTakesAllCombinationsTheLastKeyFastest) {
  const Sweep sweep = read(R"toml(scenario = "small.toml"
[vary]
"material.yield_stress" = { from = "1 MPa", to = "100 MPa", points = 3, scale = "log" }
"loading.configuration" = { values = ["die", "simple"] }
)toml");
  ASSERT_EQ(sweep.runs.size(), 6U);
  EXPECT_EQ(sweep.factors[0].heading(), "material.yield_stress[Pa]");
  EXPECT_EQ(sweep.factors[1].heading(), "loading.configuration");
  EXPECT_EQ(number(sweep, 0, 0), 1e6);
  EXPECT_NEAR(number(sweep, 2, 0), 1e7, 1e-8);
  EXPECT_EQ(number(sweep, 4, 0), 1e8);
  EXPECT_EQ(overrides_of(sweep, 1)[0], "loading.configuration=\"simple\"");
}

TEST_F(SweepFiles, AGridLeavesOutWhatTheConstraintsExclude) {
  const Sweep sweep = read(R"toml(scenario = "small.toml"
constraints = ["material.youngs_modulus / material.yield_stress >= 50"]
[vary]
"material.youngs_modulus" = { values = ["1 GPa", "2 GPa"] }
"material.yield_stress" = { values = ["10 MPa", 30e6] }
)toml");
  ASSERT_EQ(sweep.runs.size(), 3U);
  EXPECT_EQ(sweep.left_out, 1U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_GE(number(sweep, i, 0) / number(sweep, i, 1), 50.0);
}

TEST_F(SweepFiles, ATableTakesAnyUnitTheProjectKnows) {
  write("runs.csv",
        "# a comment\nmaterial.youngs_modulus[GPa], material.poisson_ratio[-] ,loading.steps[0].displacement[R0],"
        "particle.radius,mdr.strict\n\n2,0.25,0.1,1 mm,true\n3,+0.3,0.2,0.004,false\n");
  const Sweep sweep = read("scenario = \"small.toml\"\ndesign = \"table\"\ntable = \"runs.csv\"\n");
  ASSERT_EQ(sweep.runs.size(), 2U);
  EXPECT_EQ(number(sweep, 1, 0), 3e9);
  EXPECT_EQ(number(sweep, 1, 1), 0.3);
  EXPECT_EQ(number(sweep, 0, 2), 0.1 * 0.001) << "R0 is that of the run";
  EXPECT_EQ(number(sweep, 1, 2), 0.2 * 0.004);
  EXPECT_EQ(overrides_of(sweep, 0)[0], "mdr.strict=true");
  for (std::size_t run = 0; run < 2; ++run) EXPECT_NO_THROW(static_cast<void>(scenario_of(sweep, run)));
}

TEST_F(SweepFiles, ATableMayComeFromASpreadsheet) {
  for (const char separator : {';', '\t'}) {
    std::string table = "material.youngs_modulus[GPa];particle.radius;mdr.strict\n2,5;1,5 mm;true\n3;0,004;false\n";
    std::ranges::replace(table, ';', separator);
    write("runs.csv", table);
    const Sweep sweep = read("scenario = \"small.toml\"\ndesign = \"table\"\ntable = \"runs.csv\"\n");
    ASSERT_EQ(sweep.runs.size(), 2U);
    EXPECT_EQ(number(sweep, 0, 0), 2.5e9);
    EXPECT_EQ(number(sweep, 0, 1), 1.5e-3);
    EXPECT_EQ(number(sweep, 1, 1), 0.004);
  }
}

constexpr const char* k_space_filling = R"toml(scenario = "small.toml"
design = "maxpro"
runs = 24
constraints = ["100 <= material.youngs_modulus / material.yield_stress <= 200"]
[vary]
"material.youngs_modulus" = { from = "1 GPa", to = "10 GPa", scale = "log" }
"loading.configuration" = { values = ["simple", "die"] }
"material.yield_stress" = { from = "10 MPa", to = "100 MPa" }
"loading.centre" = { values = ["fixed", "equilibrium"] }
)toml";

TEST_F(SweepFiles, ASpaceFillingDesignMeetsItsConstraintsAndSharesOutAllCombinations) {
  const Sweep sweep = read(k_space_filling);
  ASSERT_EQ(sweep.runs.size(), 24U);
  std::multiset<std::pair<std::string, std::string>> combinations;
  for (std::size_t i = 0; i < 24; ++i) {
    const double ratio = number(sweep, i, 0) / number(sweep, i, 2);
    EXPECT_TRUE(ratio >= 100.0 && ratio <= 200.0) << "run " << i + 1 << ": " << ratio;
    combinations.emplace(cell_of(sweep.runs[i][1]), cell_of(sweep.runs[i][3]));
  }
  for (const char* configuration : {"simple", "die"}) {
    for (const char* centre : {"fixed", "equilibrium"}) EXPECT_EQ(combinations.count({configuration, centre}), 6U);
  }
}

TEST_F(SweepFiles, ADesignThatWasWrittenIsReadBackBitByBit) {
  const Sweep made = read(k_space_filling);
  write("design.csv", design_text(made));
  const Sweep sweep = read("scenario = \"small.toml\"\ndesign = \"table\"\ntable = \"design.csv\"\n");
  EXPECT_EQ(sweep.runs, made.runs);
  EXPECT_EQ(design_text(read(k_space_filling)), design_text(made)) << "the same file, the same design";
}

TEST_F(SweepFiles, AScenarioMayBePartOfTheSweep) {
  std::string text =
      "[vary]\n\"material.poisson_ratio\" = { values = [0.2, 0.3] }\n[scenario]\n" + std::string(k_scenario);
  for (const char* table : {"particle", "material", "loading", "output"}) {
    text.replace(text.find("[" + std::string(table) + "]"), 1, "[scenario.");
  }
  const Sweep sweep = read(text);
  EXPECT_EQ(scenario_of(sweep, 0).material.at("poisson_ratio"), 0.2);
}

constexpr const char* k_uncertain = R"toml(scenario = "small.toml"
design = "sobol"
runs = 2000
[vary]
"material.youngs_modulus" = { mean = "1 GPa", std = "0.1 GPa" }
"material.yield_stress" = { lognormal = ["20 MPa", 0.2] }
"material.poisson_ratio" = { triangular = [0.2, 0.25, 0.4] }
"loading.steps[0].displacement" = { mean = "0.1 R0", std = "0.01 R0" }
"loading.configuration" = { values = ["simple", "die"] }
)toml";

TEST_F(SweepFiles, DistributionsHaveTheirMoments) {
  const Sweep sweep = read(k_uncertain);
  ASSERT_EQ(sweep.runs.size(), 2000U);
  const auto moments = [&](std::size_t factor, auto value_of) {
    double sum = 0.0;
    double squares = 0.0;
    for (std::size_t run = 0; run < 2000; ++run) {
      const double value = value_of(number(sweep, run, factor));
      sum += value / 2000.0;
      squares += value * value / 2000.0;
    }
    return std::pair(sum, std::sqrt(squares - sum * sum));
  };
  const auto as_it_is = [](double value) { return value; };
  const auto [modulus, modulus_spread] = moments(0, [](double value) { return value / 1e9; });
  EXPECT_NEAR(modulus, 1.0, 1e-3);
  EXPECT_NEAR(modulus_spread, 0.1, 1e-3);
  const auto [log_stress, log_spread] = moments(1, [](double value) { return std::log(value / 20e6); });
  EXPECT_NEAR(log_stress, 0.0, 1e-3);
  EXPECT_NEAR(log_spread, 0.2, 2e-3);
  const auto [ratio, ratio_spread] = moments(2, as_it_is);
  EXPECT_NEAR(ratio, 0.85 / 3.0, 1e-4);
  const double triangle = (0.04 + 0.0625 + 0.16 - 0.05 - 0.08 - 0.1) / 18.0;
  EXPECT_NEAR(ratio_spread, std::sqrt(triangle), 1e-4);
  const auto [depth, depth_spread] = moments(3, [](double value) { return value / 0.002; });
  EXPECT_NEAR(depth, 0.1, 1e-4);
  EXPECT_NEAR(depth_spread, 0.01, 1e-4);
  std::size_t dies = 0;
  for (std::size_t run = 0; run < 2000; ++run) dies += cell_of(sweep.runs[run][4]) == "die" ? 1 : 0;
  EXPECT_NEAR(static_cast<double>(dies), 1000.0, 10.0);
}

TEST(SweepDistributions, HaveTheirQuantilesInClosedForm) {
  using Shape = FactorDistribution::Shape;
  const double z = 1.959963984540054;  // of the normal distribution, at 0.975
  const double q = 0.025;
  EXPECT_NEAR((FactorDistribution{Shape::normal, {3.0, 0.2, 0.0}}.at(1.0 - q).number), 3.0 + 0.2 * z, 1e-12);
  EXPECT_NEAR((FactorDistribution{Shape::normal, {3.0, 0.2, 0.0}}.at(q).number), 3.0 - 0.2 * z, 1e-12);
  EXPECT_NEAR((FactorDistribution{Shape::lognormal, {3.0, 0.2, 0.0}}.at(q).number), 3.0 * std::exp(-0.2 * z), 1e-12);
  const FactorDistribution triangular{Shape::triangular, {1.0, 2.0, 5.0}};
  EXPECT_NEAR(triangular.at(0.25).number, 2.0, 1e-12);
  EXPECT_NEAR(triangular.at(q).number, 1.0 + std::sqrt(q * 4.0 * 1.0), 1e-12);
  EXPECT_NEAR(triangular.at(1.0 - q).number, 5.0 - std::sqrt(q * 4.0 * 3.0), 1e-12);
}

TEST_F(SweepFiles, SamplesLeaveOutWhatTheConstraintsExclude) {
  const std::string text = k_uncertain;
  const Sweep sweep = read("constraints = [\"material.youngs_modulus / material.yield_stress > 50\"]\n" + text);
  EXPECT_EQ(sweep.runs.size() + sweep.left_out, 2000U);
  EXPECT_GT(sweep.left_out, 500U);
  for (std::size_t run = 0; run < sweep.runs.size(); ++run) {
    EXPECT_GT(number(sweep, run, 0) / number(sweep, run, 1), 50.0);
  }
}

TEST_F(SweepFiles, WhatIsAskedOfResultsDoesNotDecideOnTheRuns) {
  const std::string head = "scenario = \"small.toml\"\ndesign = \"saltelli\"\nsamples = 4\n";
  const std::string vary = "[vary]\n\"material.poisson_ratio\" = { from = 0.2, to = 0.3 }\n";
  const Sweep one = read(head + "results = [\"end.work\"]\n" + vary);
  const Sweep other = read("# a comment\n" + head + "results = [\"max.axial.force\", \"end.work^2\"]\n" + vary);
  EXPECT_EQ(one.runs.size(), 12U);
  EXPECT_EQ(one.digest, other.digest);
  EXPECT_EQ(other.results, (std::vector<std::string>{"max.axial.force", "end.work^2"}));
  EXPECT_NE(read(head + "seed = 2\nresults = [\"end.work\"]\n" + vary).digest, one.digest);
}

// --- faults

TEST_F(SweepFiles, FaultsOfDistributionsAreAtTheirPlaces) {
  const std::string head = "scenario = \"small.toml\"\ndesign = \"lhs\"\nruns = 10\n";
  EXPECT_EQ(
      faults_of(head + R"toml([vary]
"material.youngs_modulus" = { mean = "1 GPa" }
"material.yield_stress" = { lognormal = ["20 MPa"] }
"material.poisson_ratio" = { triangular = [0.4, 0.3, 0.2] }
"particle.radius" = { mean = "1 mm", std = "0 mm" }
"loading.configuration" = { mean = 1, std = 2 }
"loading.steps[0].displacement" = { lognormal = ["0.1 R0", "1 mm"], scale = "log" }
)toml"),
      (std::vector<std::string>{
          "sweep.toml:5:29: \"material.youngs_modulus\": key 'std' is missing; expected for example { mean = 0.3, "
          "std = 0.01 }",
          "sweep.toml:6:41: \"material.yield_stress\": expected 2 values",
          "sweep.toml:7:43: \"material.poisson_ratio\": expected the lowest, the likeliest and the highest value "
          "in this order",
          "sweep.toml:8:44: \"particle.radius\": expected std above 0",
          "sweep.toml:9:27: \"loading.configuration\": its values form no range; expected { values = [...] }",
          "sweep.toml:10:60: \"loading.steps[0].displacement\": 1 mm: expected a number",
          "sweep.toml:10:69: \"loading.steps[0].displacement\": key 'scale' goes with a range only",
      }));
  EXPECT_EQ(faults_of("scenario = \"small.toml\"\n[vary]\n\"material.poisson_ratio\" = { mean = 0.3, std = 0.01 }\n"),
            (std::vector<std::string>{"sweep.toml:3:28: \"material.poisson_ratio\": a distribution goes with design = "
                                      "\"sobol\", \"halton\", \"lhs\", \"random\", \"saltelli\" or \"morris\" only"}));
}

TEST_F(SweepFiles, NumbersInRadiiAndInMetresDoNotMix) {
  const auto fault_of = [&](const std::string& design, const std::string& levels) {
    const auto faults = faults_of("scenario = \"small.toml\"\n" + design +
                                  "[vary]\n\"loading.steps[0].displacement\" = " + levels + "\n");
    return faults.size() == 1 ? faults[0].substr(faults[0].rfind(": ") + 2) : fmt::format("{} faults", faults.size());
  };
  const std::string sampled = "design = \"lhs\"\nruns = 10\n";
  EXPECT_EQ(fault_of(sampled, "{ mean = \"0.1 R0\", std = \"0.01 mm\" }"),
            "expected mean and std both in R0, or neither");
  EXPECT_EQ(fault_of("", "{ from = \"0.1 R0\", to = \"0.3 mm\" }"), "expected from and to both in R0, or neither");
  EXPECT_EQ(fault_of(sampled, "{ triangular = [\"0.1 mm\", \"0.2 mm\", \"0.2 R0\"] }"),
            "expected all values in R0, or none");
}

TEST_F(SweepFiles, ALogarithmicRangeHasNoPlaceForZero) {
  const std::string head = "scenario = \"small.toml\"\n[vary]\n\"material.poisson_ratio\" = ";
  EXPECT_EQ(
      faults_of(head + "{ from = 0, to = 0.3, scale = \"log\" }\n"),
      (std::vector<std::string>{"sweep.toml:3:58: \"material.poisson_ratio\": a logarithmic range has no place for "
                                "0; expected from and to above 0"}));
}

TEST_F(SweepFiles, ATableStaysWithinTheRangesThatAreVaried) {
  write("runs.csv", "material.poisson_ratio\n0.2\n0.19\n0.3\n0.31\n");
  const std::string problem = ": is outside of what [vary] gives for this key";
  EXPECT_EQ(faults_of("scenario = \"small.toml\"\ndesign = \"table\"\ntable = \"runs.csv\"\n[vary]\n"
                      "\"material.poisson_ratio\" = { from = 0.2, to = 0.3 }\n"),
            (std::vector<std::string>{"runs.csv:3:1: material.poisson_ratio = 0.19" + problem,
                                      "runs.csv:5:1: material.poisson_ratio = 0.31" + problem}));
}

TEST_F(SweepFiles, AllFaultsAreReportedAtOnceAndAtTheirPlaces) {
  EXPECT_EQ(
      faults_of(R"toml(scenario = "small.toml"
histories = 3
runs = 5
constraints = ["1 <"]
[vary]
"material.poison_ratio" = { from = 0.2, to = 0.6 }
"loading.configuration" = { values = ["simple", "dia"] }
"material.yield_stress" = { from = "10 MPA", to = "100 MPa" }
"material.youngs_modulus" = { from = "1 GPa", to = "2 GPa", values = ["3 GPa"] }
"loading.steps[0].displacment" = { values = ["0.1 R0"] }
"loading.steps[7].displacement" = { values = ["0.1 R0"] }
"loading.centre" = "fixed"
material.surface_energy = { values = [1] }
)toml"),
      (std::vector<std::string>{
          "sweep.toml:2:13: histories = 3: expected true or false",
          "sweep.toml:3:1: key 'runs' goes with design = maxpro, sobol, halton, lhs, random only",
          "sweep.toml:4:20: \"1 <\": expected a number or a name",
          "sweep.toml:6:1: unknown key 'poison_ratio'; did you mean 'poisson_ratio'?",
          "sweep.toml:7:49: loading.configuration = dia: expected one of simple, die, hydrostatic, oblique-die, "
          "walls; did you mean 'die'?",
          "sweep.toml:8:36: from = \"10 MPA\": unknown unit 'MPA'; expected a stress, for example \"50 MPa\"; did you "
          "mean 'MPa'?",
          "sweep.toml:9:29: \"material.youngs_modulus\": expected one of { from = 0.2, to = 0.48 }, { values = [...] "
          "}, "
          "{ mean, std }, { lognormal = [median, standard deviation of the logarithm] }, { triangular = [lowest, "
          "likeliest, highest] }",
          "sweep.toml:10:1: unknown key 'displacment'; did you mean 'displacement'?",
          "sweep.toml:11:1: the scenario has nothing at 'loading.steps[7].displacement'",
          "sweep.toml:12:20: loading.centre = \"fixed\": expected { from = 0.2, to = 0.48 } or { values = [...] }",
          "sweep.toml:13:1: 'material' is a table; expected the path of one of its keys in quotes, such as "
          "\"material.KEY\"",
      }));
}

TEST_F(SweepFiles, ATablesFaultsBearItsPlaces) {
  write("runs.csv", "material.yield_stress[MPA],material.poison_ratio,loading.configuration\n1,0.3,simple\n");
  const std::string text = "scenario = \"small.toml\"\ndesign = \"table\"\ntable = \"runs.csv\"\n";
  EXPECT_EQ(faults_of(text), (std::vector<std::string>{
                                 "runs.csv:1:1: material.yield_stress[MPA]: unknown unit 'MPA'; expected a stress, for "
                                 "example \"50 MPa\"; did "
                                 "you mean 'MPa'?",
                                 "runs.csv:1:28: unknown key 'poison_ratio'; did you mean 'poisson_ratio'?",
                             }));
  write("runs.csv", "material.yield_stress[MPa],loading.configuration\n1,simple\nmuch,simple\n3\n4,dei\n");
  EXPECT_EQ(faults_of(text), (std::vector<std::string>{"runs.csv:4:1: the row has 1 cells, but there are 2 headings"}));
  write("runs.csv", "material.yield_stress[MPa],loading.configuration\n1,simple\nmuch,simple\n 4 , dei\n");
  EXPECT_EQ(faults_of(text),
            (std::vector<std::string>{
                "runs.csv:3:1: material.yield_stress = much: it does not begin with a number; expected a stress, for "
                "example \"50 MPa\"",
                "runs.csv:4:6: loading.configuration = dei: expected one of simple, die, hydrostatic, oblique-die, "
                "walls; did you mean 'die'?",
            }));
  write("runs.csv", "material.yield_stress[MPa]\n10\n30\n");
  EXPECT_EQ(faults_of(text + "constraints = [\"material.yield_stress < 2e7\"]\n"),
            (std::vector<std::string>{"runs.csv:3:1: the row breaks the constraint \"material.yield_stress < 2e7\""}));
}

TEST_F(SweepFiles, ASpaceFillingDesignNeedsARangeAndAMultipleOfItsLevels) {
  const std::string head = "scenario = \"small.toml\"\ndesign = \"maxpro\"\nruns = 10\n";
  EXPECT_EQ(
      faults_of(head + "[vary]\n\"loading.configuration\" = { values = [\"simple\", \"die\", \"hydrostatic\"] }\n")
          .size(),
      2U);
  const auto impossible = faults_of(head +
                                    "constraints = [\"material.poisson_ratio > 1\"]\n[vary]\n"
                                    "\"material.poisson_ratio\" = { from = 0.2, to = 0.3 }\n");
  ASSERT_EQ(impossible.size(), 1U);
  EXPECT_NE(impossible[0].find("sweep.toml:4:15: "), std::string::npos) << impossible[0];
}

TEST_F(SweepFiles, AFaultOfTheScenarioItselfIsAFault) {
  std::string broken = k_scenario;
  broken.replace(broken.find("youngs_modulus"), 14, "yuongs_modulus");
  broken.replace(broken.find("20 MPa"), 6, "20 MPA");
  write("small.toml", broken);
  EXPECT_EQ(faults_of(k_grid), (std::vector<std::string>{
                                   "small.toml:5:1: unknown key 'yuongs_modulus' in [material]; did you mean "
                                   "'youngs_modulus'?",
                                   "small.toml:7:16: yield_stress = \"20 MPA\": unknown unit 'MPA'; expected a stress, "
                                   "for example \"50 MPa\"; did you mean 'MPa'?"}));
}

TEST_F(SweepFiles, AnUnknownModelIsTheOnlyFault) {
  const std::string vary = "[vary]\n\"material.yield_stress\" = { values = [\"1 MPa\", \"2 MPa\"] }\n";
  const std::vector<std::string> in_sweep = faults_of(vary + "[scenario]\nmodel = \"mdx\"\n");
  write("small.toml", "model = \"mdx\"\n");
  const std::vector<std::string> in_file = faults_of("scenario = \"small.toml\"\n" + vary);
  ASSERT_EQ(in_sweep.size(), 1U);
  ASSERT_EQ(in_file.size(), 1U);
  EXPECT_TRUE(in_sweep[0].starts_with("sweep.toml:4:9: model = \"mdx\": expected one of ")) << in_sweep[0];
  EXPECT_TRUE(in_file[0].starts_with("small.toml:1:9: model = \"mdx\": expected one of ")) << in_file[0];
  for (const std::string& fault : {in_sweep[0], in_file[0]}) {
    EXPECT_TRUE(fault.ends_with("did you mean 'mdr'?")) << fault;
  }
}

TEST_F(SweepFiles, AnUnknownModelAmongVariedOnesListsEachModelOnce) {
  const std::vector<std::string> faults =
      faults_of("scenario = \"small.toml\"\n[vary]\nmodel = { values = [\"mdr\", \"mdx\", \"hertz\"] }\n");
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0].find("nonlocal"), faults[0].rfind("nonlocal")) << faults[0];
}

TEST_F(SweepFiles, AScenarioNeedNotHaveWhatIsVaried) {
  std::string incomplete = k_scenario;
  incomplete.replace(incomplete.find("poisson_ratio = 0.3"), 19, "");
  write("small.toml", incomplete);
  EXPECT_EQ(read(k_grid).runs.size(), 15U);
}

// --- runs

TEST_F(SweepFiles, EveryRunIsARowWithEndAndLargestValues) {
  const Sweep sweep = read(k_grid);
  static_cast<void>(results(sweep, "out"));
  const Table table = read_csv(path("out") / "results.csv");
  ASSERT_EQ(table.row_count(), 15U);
  EXPECT_EQ(table.header_value("sweep_digest"), sweep.digest);
  const auto run =
      run_scenario(read_scenario(path("small.toml"), {"material.poisson_ratio=0.3", "loading.configuration=die"}));
  const std::vector<double> force = run.record.history.column("axial.force");
  const std::size_t row = 4;  // second ratio, second configuration
  EXPECT_EQ(table.column("material.poisson_ratio")[row], 0.3);
  EXPECT_EQ(table.word(row, *table.find("status")), "complete");
  EXPECT_EQ(table.column("max.axial.force")[row], *std::ranges::max_element(force));
  EXPECT_EQ(table.column("end.axial.force")[row], force.back());
  EXPECT_GT(table.column("max.lateral.force")[row], 0.0);
  EXPECT_TRUE(std::isnan(table.column("max.lateral.force")[3])) << "configuration simple has no lateral walls";
  EXPECT_EQ(table.word(3, *table.find("end.lateral.regime")), "nan");
}

TEST_F(SweepFiles, ColumnsThatAreAskedForAreThoseOfAllColumns) {
  static_cast<void>(results(read(k_grid), "all"));
  const Table all = read_csv(path("all") / "results.csv");
  const std::vector<std::string> names{"end.work", "end.lateral.regime", "max.axial.force", "max.lateral.force"};
  // With work, without it, and of ends alone: less is computed each time.
  for (const std::size_t first : {0U, 1U}) {
    for (const std::size_t count : {4U, 2U, 1U}) {
      const std::vector<std::string> some(names.begin() + first,
                                          names.begin() + std::min<std::size_t>(4, first + count));
      const std::string columns = fmt::format("columns = [\"{}\"]\n", fmt::join(some, "\", \""));
      const std::string folder = fmt::format("{}-{}", first, count);
      static_cast<void>(results(read(columns + std::string(k_grid)), folder));
      const Table table = read_csv(path(folder) / "results.csv");
      EXPECT_EQ(table.columns().size(), all.columns().size() - (all_result_count(all) - some.size())) << columns;
      for (const std::string& name : some) {
        for (std::size_t row = 0; row < all.row_count(); ++row) {
          if (name == "end.lateral.regime") {
            EXPECT_EQ(table.word(row, *table.find(name)), all.word(row, *all.find(name)));
          } else if (std::isnan(all.column(name)[row])) {
            EXPECT_TRUE(std::isnan(table.column(name)[row]));
          } else {
            EXPECT_NEAR(table.column(name)[row], all.column(name)[row], 1e-12 * std::abs(all.column(name)[row]));
          }
        }
      }
    }
  }
}

// An elastic adhesive sphere is pulled off a wall by 3/2 pi R dg (Johnson, Kendall and Roberts 1971).
TEST_F(SweepFiles, SmallestValuesAreThoseOfTheHistories) {
  write("adhesive.toml", R"toml(model = "mdr"
particle.radius = "10 um"
material = { youngs_modulus = "1 GPa", poisson_ratio = 0.3, yield_stress = "10 GPa", surface_energy = "0.1 J/m^2" }
[loading]
configuration = "simple"
steps = [{ displacement = "0.05 R0", duration = "1 s" }, { rate = "1 um/s", detach = true }]
[output]
points = 20
)toml");
  static_cast<void>(results(read(R"toml(scenario = "adhesive.toml"
columns = ["min.axial.force", "max.axial.force"]
histories = true
[vary]
"material.surface_energy" = { values = [0.1, 0.2, 0.4] }
)toml"),
                            "out"));
  const Table table = read_csv(path("out") / "results.csv");
  ASSERT_EQ(table.row_count(), 3U);
  for (std::size_t row = 0; row < 3; ++row) {
    const std::vector<double> force =
        read_csv(path("out") / "histories" / fmt::format("{}.csv", row + 1)).column("axial.force");
    const double smallest = table.column("min.axial.force")[row];
    EXPECT_EQ(smallest, *std::ranges::min_element(force));
    const double pull_off = -1.5 * std::numbers::pi * 10e-6 * table.column("material.surface_energy")[row];
    EXPECT_NEAR(smallest, pull_off, 0.02 * std::abs(pull_off));
  }
}

TEST_F(SweepFiles, FaultsOfColumnsAreAtTheirPlaces) {
  const std::string head = "scenario = \"small.toml\"\n";
  const std::string vary = "[vary]\n\"material.poisson_ratio\" = { from = 0.2, to = 0.3 }\n";
  EXPECT_EQ(faults_of(head + "columns = [\"axial.force\"]\n" + vary),
            (std::vector<std::string>{"sweep.toml:2:12: 'axial.force': expected end.COLUMN, the value at the end of a "
                                      "run, max.COLUMN or min.COLUMN, its extremes, for example max.axial.force"}));
  const auto unknown = faults_of(head + "columns = [\"end.time\", \"max.axial.forse\", \"max.axial.regime\"]\n" + vary);
  ASSERT_EQ(unknown.size(), 2U);
  EXPECT_TRUE(unknown[0].starts_with("sweep.toml:2:24: 'axial.forse' is no column of the histories")) << unknown[0];
  EXPECT_TRUE(unknown[1].starts_with("sweep.toml:2:43: 'axial.regime' is no column of the histories")) << unknown[1];
  const auto of_a_map =
      faults_of(head + "design = \"saltelli\"\nsamples = 4\nresults = [\"max(axial.force)\"]\n" + vary);
  ASSERT_EQ(of_a_map.size(), 1u);
  EXPECT_TRUE(
      of_a_map[0].starts_with("sweep.toml:4:12: \"max(axial.force)\": 'axial.force' is no column of the results"))
      << of_a_map[0];
  const auto formula = faults_of(head + "design = \"saltelli\"\nsamples = 4\nresults = [\"end.wrok / 2\"]\n" + vary);
  ASSERT_EQ(formula.size(), 1U);
  EXPECT_TRUE(formula[0].starts_with("sweep.toml:4:12: 'wrok' is no column of the histories")) << formula[0];
  EXPECT_TRUE(formula[0].ends_with("did you mean 'work'?")) << formula[0];
  EXPECT_EQ(faults_of(head + "design = \"saltelli\"\nsamples = 4\nresults = [\"min.axial.force\"]\n" + vary),
            (std::vector<std::string>{"sweep.toml:4:12: \"min.axial.force\": 'min.axial.force' is a result only if "
                                      "columns lists it; expected for example columns = [\"min.axial.force\"]"}));
  EXPECT_EQ(faults_of(head +
                      "design = \"saltelli\"\nsamples = 4\ncolumns = [\"end.work\"]\n"
                      "results = [\"end.work + max.axial.force\"]\n" +
                      vary),
            (std::vector<std::string>{"sweep.toml:5:12: \"end.work + max.axial.force\": 'max.axial.force' is not in "
                                      "columns, which leaves out all others"}));
}

TEST_F(SweepFiles, WhatCannotBeRunIsARowWithTheReason) {
  write("small.toml", std::string(k_scenario).replace(std::string(k_scenario).find("0.1 R0"), 6, "0.4 R0"));
  static_cast<void>(results(read(k_grid), "out"));
  const Table table = read_csv(path("out") / "results.csv");
  const auto status = *table.find("status");
  const auto reason = *table.find("reason");
  EXPECT_EQ(table.word(2, status), "stopped") << "hydrostatic, beyond the domain of the model";
  EXPECT_NE(table.word(2, reason).find("free surface"), std::string_view::npos) << table.word(2, reason);
  EXPECT_GT(table.column("end.time")[2], 0.0) << "values up to there are kept";
  for (std::size_t row = 12; row < 15; ++row) {
    EXPECT_EQ(table.word(row, status), "refused");
    EXPECT_EQ(table.word(row, reason), "poisson_ratio = 0.6: out of range; expected a number above -1 and up to 0.5");
    EXPECT_TRUE(std::isnan(table.column("max.axial.force")[row]));
  }
}

TEST_F(SweepFiles, NothingOfAnEarlierSweepStaysBesideTheResultsOfAnother) {
  const std::string bands = "\n[bands]\nx = \"time\"\ny = [\"axial.force\"]\n";
  const Sweep first = read(k_grid + bands);
  static_cast<void>(results(first, "out"));
  ASSERT_EQ(std::distance(fs::directory_iterator(path("out") / "histories"), {}), 12);
  for (const char* name : {"bands.csv", "sensitivity.csv"}) write(std::string("out/") + name, "# title: a\n");
  write("out/bands.gp", "# Draws './bands.svg'. To be run in its own folder, as gnuplot ./NAME.gp\n");
  write("out/bands.svg", "<svg/>");
  write("out/bands.dat", "# percentiles\n");
  write("out/histories/notes.txt", "of the user");
  write("out/plan.txt", "of the user");
  const std::string only = "scenario = \"small.toml\"\n[vary]\n\"material.poisson_ratio\" = { values = [0.2, 0.3] }\n";
  static_cast<void>(results(read(only + bands), "out"));
  EXPECT_EQ(names_in(path("out")), (std::set<std::string>{"histories", "plan.txt", "results.csv", "sweep.json"}));
  EXPECT_EQ(names_in(path("out") / "histories"), (std::set<std::string>{"1.csv", "2.csv", "notes.txt"}));
  static_cast<void>(results(read(only), "out"));
  EXPECT_EQ(names_in(path("out") / "histories"), std::set<std::string>{"notes.txt"});
}

TEST_F(SweepFiles, TheOutcomeCountsRunsThatEndedEarly) {
  write("small.toml", std::string(k_scenario).replace(std::string(k_scenario).find("0.1 R0"), 6, "0.4 R0"));
  const Sweep sweep = read(k_grid);
  const SweepOutcome outcome = run_sweep(sweep, {.folder = path("out"), .threads = 2, .shard = {}, .progress = {}});
  const Table table = read_csv(path("out") / "results.csv");
  std::size_t complete = 0;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    if (table.word(row, *table.find("status")) == "complete") ++complete;
  }
  EXPECT_GE(outcome.runs_ended_early, 4U) << "three refused ones, and a stopped one";
  EXPECT_EQ(outcome.runs_now, complete + outcome.runs_ended_early);
}

// E/Y is 50 and 500; semimech was fitted from 117 (1 - nu^2) on.
TEST_F(SweepFiles, TheOutcomeSaysHowManyRunsWarnAndOfWhat) {
  std::string scenario(k_scenario);
  scenario.replace(scenario.find("mdr"), 3, "semimech");
  scenario.erase(scenario.find(", { force"), std::string(R"(, { force = "0 N", duration = "1 s" })").size());
  write("small.toml", scenario);
  const std::string text = R"toml(scenario = "small.toml"
[vary]
"material.yield_stress" = { values = ["2 MPa", "20 MPa"] }
)toml";
  const SweepOptions options{.folder = path("out"), .threads = 2, .shard = {}, .progress = {}};
  const std::vector<std::string> warnings = run_sweep(read(text), options).warnings;
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(warnings[0].starts_with("1 of 2 runs warn; run 2: E/((1-nu^2) Y) is outside")) << warnings[0];
  EXPECT_TRUE(run_sweep(read(text), options).warnings.empty()) << "nothing was run";
}

TEST_F(SweepFiles, TheResultsDoNotDependOnTheNumberOfThreads) {
  const Sweep sweep = read(k_grid);
  const std::string one = results(sweep, "one", 1);
  EXPECT_FALSE(one.empty());
  EXPECT_EQ(one, results(sweep, "two", 2));
  EXPECT_EQ(one, results(sweep, "eight", 8));
}

TEST_F(SweepFiles, HistoriesAreKeptIfAskedFor) {
  const Sweep sweep = read("histories = true\n" + std::string(k_grid));
  static_cast<void>(results(sweep, "out"));
  const Table history = read_csv(path("out") / "histories" / "5.csv");
  EXPECT_EQ(history.column("axial.force").back(), read_csv(path("out") / "results.csv").column("end.axial.force")[4]);
  EXPECT_FALSE(fs::exists(path("out") / "histories" / "15.csv")) << "a run that was refused has no history";
}

// --- going on

/// The journal of a sweep that was stopped after all runs but before its results were written.
class StoppedSweep : public SweepFiles {
 protected:
  StoppedSweep() {
    static_cast<void>(run_sweep(sweep_, {.folder = path("shard"), .threads = 1, .shard = {1, 2}, .progress = {}}));
    journal_ = read_text(path("shard") / "sweep-1-of-2.journal");
  }

  Sweep sweep_ = read(k_grid);
  std::string whole_ = results(sweep_, "whole");
  std::string journal_;
};

TEST_F(StoppedSweep, GoesOnFromAJournalThatWasCutAtAnyByte) {
  ASSERT_GT(journal_.size(), 1000U);
  for (std::size_t length = 0; length <= journal_.size(); length += length < 200 ? 1 : 97) {
    fs::remove_all(path("cut"));
    fs::create_directory(path("cut"));
    write("cut/sweep.journal", journal_.substr(0, length));
    ASSERT_EQ(results(sweep_, "cut"), whole_) << "cut after " << length << " of " << journal_.size() << " bytes";
    ASSERT_FALSE(fs::exists(path("cut/sweep.journal")));
  }
}

TEST_F(StoppedSweep, DoesNotDoAgainWhatIsDone) {
  fs::create_directory(path("cut"));
  write("cut/sweep.journal", journal_);
  const SweepOutcome outcome = run_sweep(sweep_, {.folder = path("cut"), .threads = 1, .shard = {}, .progress = {}});
  EXPECT_EQ(outcome.runs_before, 8U);
  EXPECT_EQ(outcome.runs_now, 7U);
  EXPECT_EQ(run_sweep(sweep_, {.folder = path("cut"), .threads = 1, .shard = {}, .progress = {}}).runs_now, 0U);
}

TEST_F(StoppedSweep, RefusesTheJournalOfAnotherSweep) {
  for (const char* file : {"sweep.journal", "sweep-2-of-2.journal"}) {
    fs::create_directories(path("cut"));
    write(std::string("cut/") + file, journal_);
    const Sweep changed = read("histories = true\n" + std::string(k_grid));
    try {
      static_cast<void>(results(changed, "cut"));
      ADD_FAILURE() << "the journal was taken";
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("remove it to begin anew"), std::string::npos) << error.what();
    }
    EXPECT_EQ(read_text(path("cut") / file), journal_) << "it is left as it was";
    fs::remove_all(path("cut"));
  }
}

TEST_F(StoppedSweep, RefusesAFileThatIsNoJournal) {
  fs::create_directory(path("cut"));
  write("cut/sweep.journal", "dear diary\n");
  EXPECT_THROW(static_cast<void>(results(sweep_, "cut")), std::runtime_error);
  EXPECT_EQ(read_text(path("cut/sweep.journal")), "dear diary\n");
}

TEST_F(StoppedSweep, RepeatsARowThatWasDamaged) {
  fs::create_directory(path("cut"));
  std::string damaged = journal_;
  damaged[damaged.rfind("complete")] = 'C';
  write("cut/sweep.journal", damaged);
  EXPECT_EQ(results(sweep_, "cut"), whole_);
}

TEST_F(StoppedSweep, RefusesResultsThatWereChanged) {
  const auto edited = [&](std::string_view old, std::string_view text) {
    const std::size_t at = whole_.rfind(old);
    EXPECT_NE(at, std::string::npos) << old;
    return at == std::string::npos ? whole_ : std::string(whole_).replace(at, old.size(), text);
  };
  const std::size_t third = whole_.find("\n3,") + 1;
  const std::string row = whole_.substr(third, whole_.find('\n', third) + 1 - third);
  const std::size_t number = row.find(",complete,,") + 11;
  const std::string another = std::string(row).replace(number, row.find(',', number) - number, "1.5");
  const std::size_t digest = whole_.find("# rows_digest: ");
  const std::string without_digest = std::string(whole_).erase(digest, whole_.find('\n', digest) + 1 - digest);
  std::string with_returns;
  for (const char c : whole_) with_returns += c == '\n' ? std::string("\r\n") : std::string(1, c);
  fs::create_directory(path("edited"));
  for (const std::string& text :
       {edited(row, ""), edited(row, row + row), edited(row, another), edited("end.axial.force[N],", ""),
        edited("end.axial", "final.axial"), edited(",complete,", ",done,"), whole_.substr(0, third),
        whole_.substr(0, whole_.size() - 5), whole_ + "16\n", with_returns, without_digest}) {
    write("edited/results.csv", text);
    try {
      static_cast<void>(results(sweep_, "edited"));
      ADD_FAILURE() << "the results were taken";
    } catch (const std::runtime_error& error) {
      EXPECT_TRUE(contains(error.what(), "results.csv: is damaged or edited")) << error.what();
    }
    EXPECT_EQ(read_text(path("edited/results.csv")), text) << "they are left as they were";
  }
  write("edited/results.csv", whole_);
  EXPECT_EQ(run_sweep(sweep_, {.folder = path("edited"), .threads = 1, .shard = {}, .progress = {}}).runs_now, 0U);
  write("edited/results.csv", edited(row, ""));
  EXPECT_THROW(static_cast<void>(results(read("histories = true\n" + std::string(k_grid)), "edited")),
               std::runtime_error)
      << "another sweep does not replace them either";
}

TEST_F(StoppedSweep, ChangedScenariosAndTablesChangeTheDigest) {
  const std::string digest = sweep_.digest;
  write("small.toml", std::string(k_scenario) + "# changed\n");
  EXPECT_NE(read(k_grid).digest, digest);
}

TEST_F(StoppedSweep, ShardsMergeToTheSameBytesInWhateverOrder) {
  for (const std::vector<std::size_t>& order : {std::vector<std::size_t>{1, 2, 3, 4}, {4, 2, 1, 3}}) {
    fs::remove_all(path("shards"));
    for (const std::size_t index : order) {
      EXPECT_FALSE(fs::exists(path("shards/results.csv")));
      const SweepOutcome outcome =
          run_sweep(sweep_, {.folder = path("shards"), .threads = 1, .shard = {index, 4}, .progress = {}});
      EXPECT_EQ(outcome.runs_missing == 0, index == order.back());
    }
    EXPECT_EQ(read_text(path("shards/results.csv")), whole_);
    EXPECT_EQ(std::distance(fs::directory_iterator(path("shards")), fs::directory_iterator{}), 2)
        << "results.csv and sweep.json";
  }
}

TEST_F(StoppedSweep, ACallWithoutShardDoesWhatShardsHaveLeft) {
  static_cast<void>(run_sweep(sweep_, {.folder = path("left"), .threads = 1, .shard = {2, 3}, .progress = {}}));
  EXPECT_EQ(results(sweep_, "left"), whole_);
}

TEST_F(StoppedSweep, TellsOfItsProgress) {
  std::size_t calls = 0;
  std::size_t last = 0;
  static_cast<void>(
      run_sweep(sweep_, {.folder = path("told"), .threads = 2, .shard = {}, .progress = [&](auto done, auto of) {
                           EXPECT_EQ(done, ++calls);
                           EXPECT_EQ(of, 15U);
                           last = done;
                         }}));
  EXPECT_EQ(last, 15U);
}

TEST_F(StoppedSweep, RefusesTheFolderOfARun) {
  fs::create_directory(path("run"));
  write("run/run.json", "{}");
  EXPECT_THROW(static_cast<void>(results(sweep_, "run")), std::runtime_error);
}

}  // namespace
}  // namespace monograin::sweep_test
