// Files of testing machines fitted as they are: their writing, the machine's own displacement, and what a bad fit is
// blamed on.

#include "study/calibrate/machine.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "elastic/hertz.hpp"
#include "history/run.hpp"
#include "history/table.hpp"
#include "study/calibrate/calibration.hpp"
#include "study/calibrate/calibration_text.hpp"
#include "study/calibrate/fit_notes.hpp"
#include "study/calibrate/granule.hpp"
#include "support/scenario_texts.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"

namespace monograin::machine_test {
namespace {

namespace fs = std::filesystem;

// The data of scenarios/calibrate/uniaxial.csv were made with these, and noise.
constexpr double k_modulus = 1.2e9;
constexpr double k_yield_stress = 45e6;
constexpr double k_compliance = 2e-8;  // with which compl.csv was made [m/N]

constexpr const char* k_plain_x = R"(x = "displacement[mm]")";
constexpr const char* k_plain_y = R"(y = "force[kN]")";

std::string machine_file(const std::string& name) {
  return MONOGRAIN_SOURCE_DIR "/tests/study/calibrate/machines/" + name;
}

const std::string k_uniaxial = MONOGRAIN_SOURCE_DIR "/scenarios/calibrate/uniaxial.csv";

class MachineCalibration : public ::testing::Test {
 protected:
  /// @param data  lines of [data]
  /// @param free  lines of [free] beside modulus and yield stress
  [[nodiscard]] Calibration read(const std::string& file, const std::string& data, const std::string& free = {}) const {
    write_text(folder() / "c.toml", fmt::format(R"(scenario = "{}/scenarios/uniaxial.toml"
[data]
file = "{}"
{}
[free]
"material.youngs_modulus" = {{ from = "0.1 GPa", to = "10 GPa" }}
"material.yield_stress" = {{ from = "1 MPa", to = "200 MPa" }}
{}
)",
                                                MONOGRAIN_SOURCE_DIR, file, data, free));
    return read_calibration(folder() / "c.toml");
  }

  [[nodiscard]] Calibration read_plain(const std::string& file, const std::string& free = {},
                                       const std::string& data = {}) const {
    return read(file, fmt::format("{}\n{}\n{}", k_plain_x, k_plain_y, data), free);
  }

  /// The messages with which the calibration is refused.
  template <class Call>
  [[nodiscard]] static std::vector<std::string> faults(const Call& call) {
    std::vector<std::string> messages;
    try {
      static_cast<void>(call());
    } catch (const ScenarioError& error) {
      for (const Fault& fault : error.faults()) messages.push_back(fault.message);
    }
    return messages;
  }

  [[nodiscard]] const fs::path& folder() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
};

/// Force over the displacement that the machine shows.
struct MachineRow {
  double x;
  double force;
};

bool has(const CalibrationResult& result, std::size_t k, double value) {
  const double half = result.uncertainty.half_width(k);
  return std::abs(result.solution.parameters[k] - value) <= half;
}

// --- files of testing machines

TEST_F(MachineCalibration, FitsFilesOfTestingMachinesAsThePlainOne) {
  const CalibrationResult plain = calibrate(read_plain(k_uniaxial));
  EXPECT_TRUE(has(plain, 0, k_modulus));
  EXPECT_TRUE(has(plain, 1, k_yield_stress));
  EXPECT_TRUE(plain.notes.empty());
  EXPECT_TRUE(plain.warnings.empty());
  const std::string extension = R"(column = "Extension", quantity = "displacement")";
  const std::string load = R"(column = "Load", quantity = "force")";
  const std::vector<std::pair<std::string, std::string>> ways{
      {"bluehill.csv", fmt::format("x = {{ {}, unit = \"mm\" }}\ny = {{ {}, unit = \"kN\" }}", extension, load)},
      {"bluehill.csv", fmt::format("x = {{ {} }}\ny = {{ {} }}", extension, load)},
      {"bluehill.csv", "x = { column = 2, quantity = \"displacement\" }\ny = { column = 3, quantity = \"force\" }"},
      {"bluehill.csv", fmt::format("skip = 1\nunits = \"row\"\nseparator = \"comma\"\ndecimal = \".\"\nx = {{ {} }}\ny "
                                   "= {{ {} }}",
                                   extension, load)},
      {"bluehill.csv", fmt::format("units = [\"s\", \"mm\", \"kN\"]\nx = {{ {} }}\ny = {{ {} }}", extension, load)},
      {"zwick.csv",
       R"(x = { column = "Standardweg", quantity = "displacement", unit = "mm" }
y = { column = "Standardkraft", quantity = "force", unit = "N" })"},
      {"zwick.csv", R"(separator = ";"
x = { column = "Standardweg", quantity = "displacement" }
y = { column = "Standardkraft", quantity = "force" })"}};
  for (const auto& [file, data] : ways) {
    const Calibration calibration = read(machine_file(file), data);
    const CalibrationResult result = calibrate(calibration);
    for (const std::size_t k : {0U, 1U}) {
      EXPECT_NEAR(result.solution.parameters[k] / plain.solution.parameters[k], 1.0, 1e-7) << data;
      EXPECT_NEAR(result.uncertainty.half_width(k) / plain.uncertainty.half_width(k), 1.0, 1e-5) << data;
    }
    ASSERT_EQ(result.notes.size(), 1U) << data;
    EXPECT_NE(result.notes[0].find(file[0] == 'b' ? "headings in line 2, units in line 3" : "decimal comma"),
              std::string::npos)
        << result.notes[0];
    const auto json = nlohmann::json::parse(calibration_json(calibration, result));
    EXPECT_EQ(json["data"]["unit_line"], file[0] == 'b' ? 3 : 2);
    EXPECT_EQ(json["data"]["x"]["unit"], "mm");
    EXPECT_EQ(json["data"]["rows"], 81);
  }
}

TEST_F(MachineCalibration, SaysWhichRowsWereLeftOutAndWhoseUnitWasTaken) {
  const std::string file = read_text(machine_file("zwick.csv"));
  write_text(folder() / "d.csv", file + "1,7000;\n1,7000;NaN\n");
  const Calibration calibration =
      read("d.csv", R"(x = { column = "Standardweg", quantity = "displacement", unit = "um" }
y = { column = "Standardkraft", quantity = "force", unit = "N" })");
  ASSERT_EQ(calibration.notes.size(), 3U);
  EXPECT_EQ(calibration.notes[1], "d.csv: column = \"Standardweg\" says 'um', and the file 'mm'; the first was taken");
  EXPECT_EQ(calibration.notes[2],
            "d.csv: 2 rows without a number in x, y or weights left out of 83, the first in line 84");
  EXPECT_EQ(calibration.x.values.size(), 81U);
}

TEST_F(MachineCalibration, RefusesAWritingThatThereIsNot) {
  const auto complaint = [this](const std::string& line) {
    const auto messages = faults([&] { return read_plain(k_uniaxial, "", line); });
    return messages.empty() ? std::string() : messages.front();
  };
  EXPECT_EQ(complaint("separator = \"dash\""), "separator = \"dash\": expected comma, semicolon, tab or blanks");
  EXPECT_EQ(complaint("decimal = \"point\""), "decimal = \"point\": expected one of ., ,");
  EXPECT_EQ(complaint("skip = -1"), "skip = -1: expected a whole number from 0 to 1000000");
  EXPECT_EQ(complaint("units = \"rows\""), "units = \"rows\": expected one of row, none; did you mean 'row'?");
  EXPECT_NE(complaint("units = [\"mm\"]").find("2 columns, but 1 units are given"), std::string::npos);
  EXPECT_EQ(complaint("compliance = \"20 nm\""),
            "compliance = \"20 nm\": expected a length over a force, 0 or more, for example \"20 nm/N\"");
}

TEST_F(MachineCalibration, RefusesAFrameThatYieldsByFarMoreThanWasMeasured) {
  const auto messages = faults([&] { return read_plain(k_uniaxial, "", "compliance = 2"); });
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_NE(messages.front().find("compliance: the frame would yield by "), std::string::npos) << messages.front();
  EXPECT_EQ(faults([&] { return read_plain(k_uniaxial, "", "compliance = \"20 nm/N\""); }).size(), 0U);
}

TEST_F(MachineCalibration, RefusesATomlFileAsData) {
  const auto messages = faults([&] { return read_plain("c.toml"); });
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_NE(messages.front().find("this is a TOML file, not measured data"), std::string::npos) << messages.front();
}

// --- the machine between sensor and particle

TEST(Machine, AddsOffsetComplianceAndTable) {
  Machine machine{.offset = 1e-4, .compliance = 2e-8};
  EXPECT_DOUBLE_EQ(machine.addition(1e3), 1e-4 + 2e-5);
  machine.forces = {0.0, 100.0, 300.0};
  machine.deflections = {0.0, 1e-6, 2e-6};
  EXPECT_DOUBLE_EQ(machine.addition(50.0), 1e-4 + 1e-6 + 5e-7);
  EXPECT_DOUBLE_EQ(machine.addition(200.0), 1e-4 + 4e-6 + 1.5e-6);
  // Continued by its end pieces.
  EXPECT_DOUBLE_EQ(machine.addition(500.0), 1e-4 + 1e-5 + 3e-6);
  EXPECT_DOUBLE_EQ(machine.addition(-100.0), 1e-4 - 2e-6 - 1e-6);
}

TEST(Machine, ComplianceIsALengthOverAForce) {
  EXPECT_DOUBLE_EQ(parse_compliance("20 nm/N").value.value_or(0.0), 2e-8);
  EXPECT_DOUBLE_EQ(parse_compliance("0.02 mm / kN").value.value_or(0.0), 2e-8);
  EXPECT_EQ(parse_compliance("0.02 mm / kN").unit, "mm/kN");
  EXPECT_DOUBLE_EQ(parse_compliance("0.02 mm / kN").unit_factor, 1e-6);
  for (const char* wrong : {"20", "20 nm", "20 N/nm", "nm/N", "20 nm/", "20 nm/2 N"}) {
    EXPECT_FALSE(parse_compliance(wrong).value) << wrong;
  }
}

constexpr double k_tolerance = 1e-15;

/// Displacements at a particle whose force is a function of its displacement, in series with a machine.
struct Series {
  std::vector<double> particle;
  std::vector<double> forces;
  int runs = 0;
  bool is_found = false;
};

template <class Law>
Series in_series(const Machine& machine, const std::vector<double>& x, Law law) {
  Series made{x, std::vector<double>(x.size())};
  const auto forces_of = [&](const std::vector<double>& particle, std::span<double> forces) {
    ++made.runs;
    for (std::size_t i = 0; i < particle.size(); ++i) forces[i] = law(particle[i]);
    return true;
  };
  made.is_found = put_in_series(machine, x, forces_of, k_tolerance, made.particle, made.forces);
  return made;
}

TEST(MachineInSeries, SharesTheDisplacementAsTwoSpringsDo) {
  const Machine machine{.offset = 1e-5, .compliance = 1e-7};
  const double stiffness = 3e7;
  const Series found =
      in_series(machine, {0.0, 1e-5, 2e-4, 4e-4, 3e-4}, [=](double d) { return d > 0.0 ? stiffness * d : 0.0; });
  ASSERT_TRUE(found.is_found);
  const std::vector<double> expected{-1e-5, 0.0, 1.9e-4 / 4.0, 3.9e-4 / 4.0, 2.9e-4 / 4.0};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(found.particle[i], expected[i], 1e-15) << i;
  EXPECT_NEAR(found.forces[3], stiffness * 3.9e-4 / 4.0, 1e-6);
  EXPECT_LE(found.runs, 6);
}

TEST(MachineInSeries, FindsTheParticleBehindASoftFrame) {
  // The frame takes nearly all: the stiffest contact is 200 times as stiff.
  const Machine machine{.compliance = 1e-5};
  std::vector<double> x;
  for (int i = 0; i <= 50; ++i) x.push_back(1e-3 * i);
  const auto law = [](double d) { return d > 0.0 ? 1e9 * std::pow(d, 1.5) : 0.0; };
  const Series found = in_series(machine, x, law);
  ASSERT_TRUE(found.is_found);
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_NEAR(found.particle[i] + machine.addition(law(found.particle[i])), x[i], 1e-14) << i;
  }
}

TEST(MachineInSeries, TakesTheMiddleOfAJumpOfTheForce) {
  const Machine machine{.compliance = 1e-7};
  const auto law = [](double d) { return (d > 1e-4 ? 1200.0 : 1000.0) + 1e6 * d; };
  // Shown at the jump: from 1e-4 + 1e-7 * 1100 to 1e-4 + 1e-7 * 1300.
  const Series found = in_series(machine, {2.0e-4, 2.2e-4, 2.4e-4}, law);
  ASSERT_TRUE(found.is_found);
  EXPECT_NEAR(found.particle[1], 1e-4, 1e-14);
  EXPECT_NEAR(found.forces[1], 1200.0, 1e-6);
  EXPECT_NEAR(found.forces[0], law(found.particle[0]), 1e-9);
  EXPECT_NEAR(found.forces[2], law(found.particle[2]), 1e-9);
}

TEST(MachineInSeries, FindsPointsWhoseForceFollowsFromATurnThatTheSearchStillMoves) {
  // A plastic particle that unloads steeply: the force depends on the largest displacement before.
  const auto forces_of = [](const std::vector<double>& particle, std::span<double> forces) {
    double largest = 0.0;
    for (std::size_t i = 0; i < particle.size(); ++i) {
      largest = std::max(largest, particle[i]);
      const double top = 2e8 * std::pow(largest, 1.2);
      forces[i] = std::max(top - 2e10 * std::pow(largest - particle[i], 1.1), 0.0);
    }
    return true;
  };
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> uniform;
  int failures = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Machine machine{.offset = 1e-5, .compliance = 1e-7 * uniform(generator)};
    std::vector<double> x;
    for (int i = 0; i < 60; ++i) x.push_back(7e-5 * uniform(generator));
    std::ranges::sort(x);
    for (int i = 0; i < 60; ++i) x.push_back(x[59] - 1e-5 * uniform(generator));
    std::sort(x.begin() + 60, x.end(), std::greater<>());
    std::vector<double> particle = x;
    std::vector<double> forces(x.size());
    const double tolerance = 1e-12 * x[59];
    if (!put_in_series(machine, x, forces_of, tolerance, particle, forces)) {
      ++failures;
      continue;
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
      EXPECT_NEAR(particle[i] + machine.addition(forces[i]), x[i], 3.0 * tolerance) << trial << ' ' << i;
    }
  }
  EXPECT_EQ(failures, 0);
}

TEST(MachineInSeries, SaysWhereTheParticleCannotFollow) {
  std::vector<double> particle{1.0};
  std::vector<double> forces(1);
  const auto refuse = [](const std::vector<double>&, std::span<double>) { return false; };
  EXPECT_FALSE(put_in_series({.compliance = 1.0}, particle, refuse, 1e-12, particle, forces));
}

// --- noise of the displacement

class NoisyGranule : public MachineCalibration {
 protected:
  NoisyGranule() {
    write_text(folder() / "s.toml", k_granule);
    const Table history = run_scenario(parse_scenario(k_granule, "s.toml")).record.history;
    for (std::size_t row = 0; row < history.row_count(); ++row) {
      if (history.column("row")[row] != 0.0) continue;
      const double force = history.column("axial.force")[row];
      rows_.push_back({history.column("axial.displacement")[row] + 12e-6 + 60e-9 * force, force});
    }
  }

  /// @param noise  standard deviation of the displacement [m]
  [[nodiscard]] Calibration measured(unsigned seed, double noise, const std::string& fit = {}) const {
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal;
    std::string text = "displacement[m],force[N]\n";
    for (const MachineRow& row : rows_) {
      text += fmt::format("{:.9f},{:.3f}\n", row.x + noise * normal(generator), row.force + 0.15 * normal(generator));
    }
    write_text(folder() / "d.csv", text);
    write_text(folder() / "c.toml", fmt::format(R"(scenario = "s.toml"
[data]
file = "d.csv"
x = "displacement[m]"
y = "force[N]"
offset = "12 um"
compliance = "60 nm/N"
[fit]
{}
[free]
"material.youngs_modulus" = {{ from = "0.1 GPa", to = "10 GPa" }}
"material.yield_stress" = {{ from = "1 MPa", to = "200 MPa" }}
)",
                                                fit));
    return read_calibration(folder() / "c.toml");
  }

 private:
  std::vector<MachineRow> rows_;
};

constexpr double k_noise_of_x = 2e-7;

TEST_F(NoisyGranule, HeldAtItsPeakGivesItsModulusBack) {
  double mean = 0.0;
  constexpr unsigned k_sets = 6;
  for (unsigned seed = 1; seed <= k_sets; ++seed) {
    const CalibrationResult result = calibrate(measured(seed, k_noise_of_x));
    mean += result.solution.parameters[0] / 2e9 / k_sets;
    EXPECT_EQ(result.solution.failures, 0) << seed;
    ASSERT_TRUE(result.uncertainty.is_determined[0]) << seed;
    EXPECT_LT(result.uncertainty.standard_error(0), 0.02 * 2e9) << seed;
    EXPECT_TRUE(std::ranges::any_of(result.notes, [](const std::string& note) {
      return note.starts_with("hold of ") && note.find(" rows, lines ") != std::string::npos;
    })) << seed;
  }
  EXPECT_NEAR(mean, 1.0, 0.015);
}

TEST_F(NoisyGranule, WithoutNoiseOfTheDisplacementHasNoNoteOnIt) {
  const CalibrationResult result = calibrate(measured(1, 0.0));
  for (const std::string& note : result.notes) EXPECT_EQ(note.find("hold of "), std::string::npos) << note;
  EXPECT_TRUE(has(result, 0, 2e9));
}

TEST_F(NoisyGranule, HasABootstrapAsWideAsItsStandardErrors) {
  const CalibrationResult by_covariance = calibrate(measured(2, k_noise_of_x));
  const CalibrationResult result = calibrate(measured(2, k_noise_of_x, "intervals = \"bootstrap\""));
  ASSERT_EQ(result.method, IntervalMethod::bootstrap);
  for (std::size_t k = 0; k < 2; ++k) {
    const double width = result.intervals[k].upper - result.intervals[k].lower;
    EXPECT_GT(width, 2.0 * by_covariance.uncertainty.standard_error(k)) << k << ": half of that of normal errors";
  }
}

TEST_F(NoisyGranule, WhoseTrialsFailBesideTheFitIsNotCalledUndetermined) {
  const Calibration calibration = measured(1, 0.0);
  CalibrationResult result = calibrate(calibration);
  result.uncertainty.is_determined[0] = result.uncertainty.has_derivative[0] = false;
  const std::vector<std::string> notes = notes_of(calibration, result);
  EXPECT_TRUE(std::ranges::any_of(
      notes, [](const std::string& note) { return note.find("no derivative is known") != std::string::npos; }));
  for (const std::string& note : notes) EXPECT_EQ(note.find("do not determine"), std::string::npos) << note;
}

TEST_F(MachineCalibration, AKnownComplianceGivesTheModulusBack) {
  write_text(folder() / "frame.csv", "load[kN],d[um]\n0,0\n2,40\n10,200\n");
  for (const char* compliance :
       {"\"20 nm/N\"", "2e-8", "{ table = \"frame.csv\", force = \"load\", displacement = \"d\" }"}) {
    const Calibration calibration =
        read_plain(machine_file("compl.csv"), "", fmt::format("compliance = {}", compliance));
    const CalibrationResult result = calibrate(calibration);
    EXPECT_TRUE(has(result, 0, k_modulus)) << compliance;
    EXPECT_NEAR(result.solution.parameters[0] / k_modulus, 1.0, 0.01) << compliance;
    EXPECT_EQ(result.solution.failures, 0) << compliance;
    ASSERT_EQ(result.particle.size(), 81U) << compliance;
    // The particle and the frame under its own force add up to what was measured.
    for (const std::size_t row : {8U, 40U, 80U}) {
      EXPECT_NEAR(result.particle[row] + k_compliance * result.fit.y[row], calibration.x.values[row], 1e-12) << row;
    }
    const Table fit = fit_table(calibration, result);
    EXPECT_EQ(fit.at(40, *fit.find("particle_displacement")), result.particle[40]) << compliance;
  }
}

TEST_F(MachineCalibration, ASoughtComplianceLeavesTheModulusWithinItsInterval) {
  // Without it the modulus is 30 % too low, and its interval does not know of that.
  const CalibrationResult rigid = calibrate(read_plain(machine_file("compl.csv")));
  EXPECT_LT(rigid.solution.parameters[0], 0.75 * k_modulus);
  EXPECT_FALSE(has(rigid, 0, k_modulus));
  const Calibration calibration =
      read_plain(machine_file("compl.csv"), R"("data.compliance" = { from = 0, to = "0.1 um/N" })");
  const CalibrationResult result = calibrate(calibration);
  EXPECT_TRUE(has(result, 0, k_modulus));
  EXPECT_TRUE(has(result, 1, k_yield_stress));
  EXPECT_TRUE(has(result, 2, k_compliance));
  EXPECT_LT(result.uncertainty.half_width(0), 0.05 * k_modulus);
  EXPECT_EQ(calibration.free[2].unit, "um/N");
  const CheckedScenario fitted = parse_scenario(fitted_scenario_text(calibration, result), "fitted.toml");
  EXPECT_EQ(fitted.material.at("youngs_modulus"), result.solution.parameters[0]);
}

constexpr double k_hertz_modulus = 70e9;

/// Hertz between two walls, exact.
std::vector<MachineRow> hertz_on_a_machine(double offset, double compliance) {
  std::vector<MachineRow> rows;
  for (int i = -4; i <= 20; ++i) {
    const double displacement = 4e-6 * i;
    const double plane_strain = k_hertz_modulus / (1.0 - 0.22 * 0.22);
    const double force = displacement > 0.0 ? hertz_force(plane_strain, 0.01, displacement) : 0.0;
    rows.push_back({displacement + offset + compliance * force, force});
  }
  return rows;
}

constexpr const char* k_hertz = R"(scenario = "s.toml"
[data]
file = "d.csv"
x = "displacement[um]"
y = "force[N]"
[free]
"material.youngs_modulus" = { from = "10 GPa", to = "300 GPa" }
"data.offset" = { from = "-0.1 mm", to = "0.1 mm" }
"data.compliance" = { from = 0, to = "100 nm/N" }
)";

void write_hertz(const fs::path& folder) {
  write_text(folder / "s.toml", k_hertz_text);
  std::string text = "displacement[um],force[N]\n";
  for (const MachineRow& row : hertz_on_a_machine(3e-5, 1e-8)) {
    text += fmt::format("{:.17g},{:.17g}\n", 1e6 * row.x, row.force);
  }
  write_text(folder / "d.csv", text);
}

TEST_F(MachineCalibration, FindsOffsetAndComplianceWithTheModulus) {
  write_hertz(folder());
  write_text(folder() / "h.toml", k_hertz);
  const CalibrationResult result = calibrate(read_calibration(folder() / "h.toml"));
  EXPECT_NEAR(result.solution.parameters[0] / k_hertz_modulus, 1.0, 1e-6);
  EXPECT_NEAR(result.solution.parameters[1], 3e-5, 1e-11);
  EXPECT_NEAR(result.solution.parameters[2], 1e-8, 1e-14);
}

TEST_F(MachineCalibration, NoiseOfTheForcesDoesNotBiasTheModulus) {
  // The displacements are exact and the forces are not, as of most machines. A frame that the measured forces deflect
  // would make the modulus 39 % too low.
  write_hertz(folder());
  std::string text = k_hertz;
  text.erase(text.find("\"data.offset\""), text.find("\"data.compliance\"") - text.find("\"data.offset\""));
  write_text(folder() / "h.toml", text);
  const auto rows = hertz_on_a_machine(0.0, 1e-8);
  std::mt19937 generator(5);
  std::normal_distribution<double> noise(0.0, 0.03 * rows.back().force);
  std::vector<double> moduli;
  for (int run = 0; run < 12; ++run) {
    std::string data = "displacement[um],force[N]\n";
    for (const MachineRow& row : rows)
      data += fmt::format("{:.17g},{:.17g}\n", 1e6 * row.x, row.force + noise(generator));
    write_text(folder() / "d.csv", data);
    moduli.push_back(calibrate(read_calibration(folder() / "h.toml")).solution.parameters[0]);
  }
  const auto n = static_cast<double>(moduli.size());
  const double mean = std::accumulate(moduli.begin(), moduli.end(), 0.0) / n;
  double squares = 0.0;
  for (const double modulus : moduli) squares += (modulus - mean) * (modulus - mean);
  const double three_errors = 3.0 * std::sqrt(squares / (n - 1.0) / n);
  EXPECT_NEAR(mean, k_hertz_modulus, three_errors);
  EXPECT_LT(three_errors, 0.5 * 0.39 * k_hertz_modulus) << "half the bias of measured forces";
}

TEST_F(MachineCalibration, NoiseOfTheDisplacementsIsNoUnloading) {
  const monograin::Run run =
      run_scenario(read_scenario(MONOGRAIN_SOURCE_DIR "/scenarios/uniaxial.toml", {"output.points=500"}));
  const std::vector<double> displacements = run.record.history.column("axial.displacement");
  const std::vector<double> forces = run.record.history.column("axial.force");
  const double farthest = *std::ranges::max_element(displacements);
  std::mt19937_64 generator(4);
  std::normal_distribution<double> noise(0.0, 1e-3 * farthest);
  std::string data = "displacement[m],force[N]\n";
  for (std::size_t row = 0; row < forces.size(); ++row)
    data += fmt::format("{:.17g},{:.17g}\n", displacements[row] + (row > 0 ? noise(generator) : 0.0), forces[row]);
  write_text(folder() / "noisy.csv", data);
  const CalibrationResult result =
      calibrate(read("noisy.csv", "x = \"displacement[m]\"\ny = \"force[N]\"\nweights = \"absolute\""));
  EXPECT_EQ(result.program_steps, run.scenario.loading.steps.size());
  EXPECT_NEAR(result.solution.parameters[0] / run.scenario.material.at("youngs_modulus"), 1.0, 0.01);
  EXPECT_NEAR(result.solution.parameters[1] / run.scenario.material.at("yield_stress"), 1.0, 0.005);
}

TEST_F(MachineCalibration, AMachineUnderForceControlAddsToTheDisplacement) {
  write_hertz(folder());
  std::string text = k_hertz;
  text.replace(text.find("x = "), text.find("[free]") - text.find("x = "),
               "x = \"force[N]\"\ny = \"displacement[um]\"\n");
  write_text(folder() / "h.toml", text);
  // Before the first touch a force of zero has no displacement of its own.
  std::string data = "displacement[um],force[N]\n";
  for (const MachineRow& row : hertz_on_a_machine(3e-5, 1e-8)) {
    if (row.force > 0.0) data += fmt::format("{:.17g},{:.17g}\n", 1e6 * row.x, row.force);
  }
  write_text(folder() / "d.csv", data);
  const Calibration calibration = read_calibration(folder() / "h.toml");
  const CalibrationResult result = calibrate(calibration);
  EXPECT_NEAR(result.solution.parameters[0] / k_hertz_modulus, 1.0, 1e-6);
  EXPECT_NEAR(result.solution.parameters[1], 3e-5, 1e-11);
  EXPECT_NEAR(result.solution.parameters[2], 1e-8, 1e-14);
  EXPECT_NEAR(result.particle.back(), 8e-5, 1e-11);
}

TEST_F(MachineCalibration, LeavesTheDataOfTheParticleBesideTheFit) {
  write_hertz(folder());
  for (const auto& [x, y] : {std::pair("displacement[um]", "force[N]"), std::pair("force[N]", "displacement[um]")}) {
    std::string data = "displacement[um],force[N]\n";
    for (const MachineRow& row : hertz_on_a_machine(3e-5, 1e-8)) {
      if (row.force > 0.0) data += fmt::format("{:.17g},{:.17g}\n", 1e6 * row.x, row.force + 25.0);
    }
    write_text(folder() / "d.csv", data);
    write_text(folder() / "h.toml", replaced(k_hertz, "x = \"displacement[um]\"\ny = \"force[N]\"\n",
                                             fmt::format("x = \"{}\"\ny = \"{}\"\nforce_offset = \"25 N\"\n", x, y)));
    const Calibration calibration = read_calibration(folder() / "h.toml");
    const CalibrationResult result = calibrate(calibration);
    const Table fit = fit_table(calibration, result);
    for (std::size_t row = 0; row < fit.row_count(); ++row) {
      const double displacement = 4e-6 * static_cast<double>(row + 1);
      const double force = hertz_force(k_hertz_modulus / (1.0 - 0.22 * 0.22), 0.01, displacement);
      EXPECT_NEAR(fit.at(row, *fit.find(k_particle_displacement)), displacement, 1e-10) << x;
      EXPECT_NEAR(fit.at(row, *fit.find(k_particle_force)), force, 1e-9 * force) << x;
    }
    EXPECT_NE(fitted_scenario_text(calibration, result).find(k_without_machine), std::string::npos);
  }
}

// --- scale of a column, and zero of the load cell

TEST_F(MachineCalibration, AScaleMakesAFileOfNegativeCompressionThePlainOne) {
  const CalibrationResult plain = calibrate(read_plain(k_uniaxial));
  const Calibration calibration = read(machine_file("neg.csv"), R"(x = { column = "displacement[mm]", scale = -1 }
y = { column = "force[kN]", scale = -1.0 })");
  const CalibrationResult result = calibrate(calibration);
  EXPECT_TRUE(result.warnings.empty());
  for (const std::size_t k : {0U, 1U}) {
    EXPECT_NEAR(result.solution.parameters[k] / plain.solution.parameters[k], 1.0, 1e-7);
  }
  const auto json = nlohmann::json::parse(calibration_json(calibration, result));
  EXPECT_EQ(json["data"]["x"]["scale"], -1.0);
  const auto none = [&] { return read(k_uniaxial, "x = { column = 1, scale = 0 }\ny = \"force[kN]\""); };
  EXPECT_EQ(faults(none).front(), "scale = 0: expected a factor other than zero");
}

/// Rows of hertz_on_a_machine, the force with what the load cell shows without a load.
std::string with_zero_of(double force_offset) {
  std::string text = "displacement[um],force[N]\n";
  for (const MachineRow& row : hertz_on_a_machine(3e-5, 1e-8)) {
    text += fmt::format("{:.17g},{:.17g}\n", 1e6 * row.x, row.force + force_offset);
  }
  return text;
}

TEST_F(MachineCalibration, FindsTheZeroOfTheLoadCellWithTheModulus) {
  write_hertz(folder());
  write_text(folder() / "d.csv", with_zero_of(-40.0));
  const std::string text = std::string(k_hertz) + "\"data.force_offset\" = { from = \"-100 N\", to = \"100 N\" }\n";
  write_text(folder() / "h.toml", text);
  const Calibration calibration = read_calibration(folder() / "h.toml");
  const CalibrationResult result = calibrate(calibration);
  EXPECT_NEAR(result.solution.parameters[0] / k_hertz_modulus, 1.0, 1e-6);
  EXPECT_NEAR(result.solution.parameters[1], 3e-5, 1e-11);
  EXPECT_NEAR(result.solution.parameters[2], 1e-8, 1e-14);
  EXPECT_NEAR(result.solution.parameters[3], -40.0, 1e-4);
  EXPECT_NEAR(result.particle.back(), 8e-5, 1e-10);
}

TEST_F(MachineCalibration, AKnownZeroOfTheLoadCellIsTakenOffTheForce) {
  write_hertz(folder());
  write_text(folder() / "d.csv", with_zero_of(25.0));
  for (const bool is_driven : {false, true}) {
    std::string text = replaced(k_hertz, "y = \"force[N]\"\n", "y = \"force[N]\"\nforce_offset = \"25 N\"\n");
    if (is_driven) {
      // Before the first touch a force of zero has no displacement of its own.
      std::string data = "displacement[um],force[N]\n";
      for (const MachineRow& row : hertz_on_a_machine(3e-5, 1e-8)) {
        if (row.force > 0.0) data += fmt::format("{:.17g},{:.17g}\n", 1e6 * row.x, row.force + 25.0);
      }
      write_text(folder() / "d.csv", data);
      text = replaced(text, "x = \"displacement[um]\"\ny = \"force[N]\"", "x = \"force[N]\"\ny = \"displacement[um]\"");
    }
    write_text(folder() / "h.toml", text);
    const Calibration calibration = read_calibration(folder() / "h.toml");
    const CalibrationResult result = calibrate(calibration);
    EXPECT_NEAR(result.solution.parameters[0] / k_hertz_modulus, 1.0, 1e-6) << is_driven;
    EXPECT_NEAR(result.solution.parameters[1], 3e-5, 1e-10) << is_driven;
    EXPECT_NE(calibration_report(calibration, result, "").find("; force offset 25 N"), std::string::npos) << is_driven;
    EXPECT_NEAR(result.solution.parameters[2], 1e-8, 1e-13) << is_driven;
  }
}

TEST_F(MachineCalibration, FindsTheZeroOfALoadCellThatDrivesTheParticle) {
  // At trials with a larger zero, the first rows have less force than without a load.
  write_hertz(folder());
  const double plane_strain = k_hertz_modulus / (1.0 - 0.22 * 0.22);
  write_text(folder() / "h.toml", R"(scenario = "s.toml"
[data]
file = "d.csv"
x = "force[N]"
y = "displacement[m]"
[free]
"material.youngs_modulus" = { from = "10 GPa", to = "300 GPa" }
"data.offset" = { from = "-0.1 mm", to = "0.1 mm" }
"data.force_offset" = { from = "-100 N", to = "100 N" }
)");
  constexpr unsigned k_sets = 6;
  std::size_t covered = 0;
  for (unsigned seed = 1; seed <= k_sets; ++seed) {
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> noise(0.0, 5e-8);
    std::string data = "force[N],displacement[m]\n";
    for (int row = 0; row <= 100; ++row) {
      const double displacement = 8e-7 * row;
      const double force = row > 0 ? hertz_force(plane_strain, 0.01, displacement) : 0.0;
      data += fmt::format("{:.17g},{:.17g}\n", force + 25.0, displacement + 1e-5 + noise(generator));
    }
    write_text(folder() / "d.csv", data);
    const CalibrationResult result = calibrate(read_calibration(folder() / "h.toml"));
    EXPECT_NEAR(result.solution.parameters[2], 25.0, 1.5) << seed;
    EXPECT_NEAR(result.solution.parameters[0] / k_hertz_modulus, 1.0, 2e-3) << seed;
    const Interval& interval = result.intervals[2];
    if (interval.lower <= 25.0 && interval.upper >= 25.0) ++covered;
    // The smallest force is 25 N.
    EXPECT_GT(interval.upper, 25.0 + 1e-2) << seed;
  }
  EXPECT_GE(covered, k_sets - 2);
}

TEST_F(MachineCalibration, WithoutADisplacementHasNoDisplacementAtTheParticle) {
  write_hertz(folder());
  write_text(folder() / "d.csv", "force[N],pressure[MPa]\n101,0.5\n201,0.8\n301,1.1\n401,1.3\n");
  write_text(folder() / "h.toml", R"(scenario = "s.toml"
[data]
file = "d.csv"
x = "force[N]"
y = "pressure[MPa]"
force_offset = "1 N"
[free]
"material.youngs_modulus" = { from = "10 GPa", to = "300 GPa" }
)");
  const Calibration calibration = read_calibration(folder() / "h.toml");
  const Table fit = fit_table(calibration, calibrate(calibration));
  EXPECT_FALSE(fit.find(k_particle_displacement));
  ASSERT_TRUE(fit.find(k_particle_force));
  EXPECT_DOUBLE_EQ(fit.at(2, *fit.find(k_particle_force)), 300.0);
}

TEST_F(MachineCalibration, AScaleOfTheForceIsThatOfItsDeviations) {
  const Calibration plain = read_plain(k_uniaxial);
  std::vector<std::vector<double>> weights;
  for (const double scale : {1.0, -2.0}) {
    std::string text = "displacement[mm],force[N],error[N]\n";
    for (std::size_t row = 0; row < plain.x.values.size(); ++row) {
      text += fmt::format("{:.17g},{:.17g},{:.17g}\n", 1e3 * plain.x.values[row], plain.y.values[row] / scale,
                          (1.0 + static_cast<double>(row)) / std::abs(scale));
    }
    write_text(folder() / "d.csv", text);
    weights.push_back(read("d.csv", fmt::format("x = \"displacement[mm]\"\ny = {{ column = \"force\", scale = {:.1f} "
                                                "}}\nnoise = {{ column = \"error[N]\" }}",
                                                scale))
                          .weights);
  }
  ASSERT_EQ(weights[0].size(), weights[1].size());
  for (std::size_t row = 0; row < weights[0].size(); ++row) EXPECT_DOUBLE_EQ(weights[1][row], weights[0][row]) << row;
}

TEST_F(MachineCalibration, AZeroOfTheLoadCellNeedsAForce) {
  const auto area = [&] {
    return read(k_uniaxial, "x = \"displacement[mm]\"\ny = { column = 2, quantity = \"pressure\", unit = \"MPa\" }",
                "\"data.force_offset\" = { from = \"0 N\", to = \"1 N\" }");
  };
  EXPECT_EQ(faults(area), std::vector<std::string>{
                              "a force_offset takes a force; x and y are 'axial.displacement' and 'axial.pressure'"});
}

TEST_F(MachineCalibration, AMachineNeedsADisplacementAndItsForce) {
  const std::string compliance = R"("data.compliance" = { from = 0, to = "1 um/N" })";
  const auto pressure = [&] {
    return read(k_uniaxial,
                "x = \"displacement[mm]\"\ny = { column = \"force[kN]\", quantity = \"pressure\", unit = "
                "\"MPa\" }",
                compliance);
  };
  EXPECT_EQ(faults(pressure),
            std::vector<std::string>{"a compliance takes force and displacement of the same walls; x and y are "
                                     "'axial.displacement' and 'axial.pressure'"});
  const auto twice = [&] { return read_plain(k_uniaxial, compliance, "compliance = \"1 nm/N\""); };
  EXPECT_EQ(faults(twice),
            std::vector<std::string>{"'data.compliance' is free and given in [data]; expected one of them"});
}

// --- bad fits

TEST_F(MachineCalibration, BlamesABadFitOnUnitSignOrContent) {
  struct Case {
    std::string file;
    const char* x;
    const char* begin;
    const char* cause;
  };
  for (const Case& c :
       std::vector<Case>{{"um.csv", "x = \"displacement[µm]\"", "the fit is worse than a constant: R^2 = -4.454",
                          "the unit of x: with mm instead of µm, R^2 is 0.9992"},
                         {"neg.csv", k_plain_x, "no datum touches the particle: the fit is zero in every row",
                          "the signs of x and y: with scale = -1 in x and scale = -1 in y, R^2 is 0.9992"},
                         {"consty.csv", k_plain_x, "y is the same in every row", ""}}) {
    const CalibrationResult result = calibrate(read(machine_file(c.file), fmt::format("{}\n{}", c.x, k_plain_y)));
    ASSERT_EQ(result.warnings.size(), 1U) << c.file;
    EXPECT_TRUE(result.warnings[0].starts_with(c.begin)) << result.warnings[0];
    EXPECT_NE(result.warnings[0].find(c.cause), std::string::npos) << result.warnings[0];
  }
}

/// The rows of a calibration in mm and kN, the displacement times a factor.
std::string rows_times(const Calibration& calibration, double factor) {
  std::string text = "displacement[mm],force[kN]\n";
  for (std::size_t row = 0; row < calibration.lines.size(); ++row) {
    text +=
        fmt::format("{:.17g},{:.17g}\n", 1e3 * factor * calibration.x.values[row], 1e-3 * calibration.y.values[row]);
  }
  return text;
}

TEST_F(MachineCalibration, DoubtsTheDisplacementOfTwoWallsAndOfHalfAWall) {
  for (const auto& [factor, cause] :
       {std::pair(2.0, "of one wall towards another at rest: with scale = 0.5 in x, they are 0.25 times as large"),
        std::pair(0.5, "half of that of a wall: with scale = 2 in x, they are 0.61 times as large, and noise")}) {
    write_text(folder() / "d.csv", rows_times(read_plain(k_uniaxial), factor));
    const CalibrationResult result = calibrate(read_plain("d.csv"));
    EXPECT_GT(result.goodness.explained, k_least_explained);
    ASSERT_EQ(result.warnings.size(), 1U) << factor;
    EXPECT_TRUE(result.warnings[0].starts_with("the residuals are not noise; likely cause: the displacement, "));
    EXPECT_NE(result.warnings[0].find(cause), std::string::npos) << result.warnings[0];
    const CalibrationResult mended =
        calibrate(read("d.csv", fmt::format("x = {{ column = 1, quantity = \"displacement\", scale = {} }}\n{}",
                                            1.0 / factor, k_plain_y)));
    EXPECT_TRUE(has(mended, 0, k_modulus));
    EXPECT_TRUE(mended.warnings.empty());
  }
}

TEST_F(MachineCalibration, DoesNotBlameTheFrameOnTheNumberOfWalls) {
  const CalibrationResult rigid = calibrate(read_plain(machine_file("compl.csv")));
  ASSERT_TRUE(rigid.residual_tests);
  EXPECT_FALSE(rigid.residual_tests->are_independent());
  EXPECT_TRUE(rigid.warnings.empty());
}

TEST_F(MachineCalibration, BlamesABadFitOnTheFirstTouch) {
  write_hertz(folder());
  std::string text = k_hertz;
  text.erase(text.find("\"data.offset\""));
  write_text(folder() / "h.toml", text);
  std::string data = "displacement[um],force[N]\n";
  for (const MachineRow& row : hertz_on_a_machine(3e-4, 0.0)) {
    data += fmt::format("{:.17g},{:.17g}\n", 1e6 * row.x, row.force);
  }
  write_text(folder() / "d.csv", data);
  const CalibrationResult result = calibrate(read_calibration(folder() / "h.toml"));
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_NE(result.warnings[0].find("likely cause: the first touch: with data.offset = \"300 um\", R^2 is 1.0000"),
            std::string::npos)
      << result.warnings[0];
}

TEST_F(MachineCalibration, BlamesDataThatCannotBeFollowedOnTheirUnit) {
  write_text(folder() / "d.csv", read_text(k_uniaxial));
  const Calibration calibration =
      read("d.csv", "x = { column = \"displacement\", quantity = \"displacement\", unit = \"m\" }\ny = \"force\"");
  const auto messages = faults([&] { return calibrate(calibration); });
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_NE(messages[0].find("likely cause: the unit of x: with mm instead of m, R^2 is 0.9992"), std::string::npos)
      << messages[0];
}

TEST_F(MachineCalibration, AnOutlierThatALossForgetsMakesNoBadFit) {
  write_hertz(folder());
  std::string data = read_text(folder() / "d.csv");
  data += "70,20000\n";
  write_text(folder() / "d.csv", data);
  write_text(folder() / "h.toml", std::string(k_hertz) + "[fit]\nloss = \"cauchy\"\nloss_scale = 0.001\n");
  const CalibrationResult result = calibrate(read_calibration(folder() / "h.toml"));
  EXPECT_LT(result.goodness.r_squared, k_least_explained);
  EXPECT_GT(result.goodness.explained, k_least_explained);
  EXPECT_TRUE(result.warnings.empty());
}

TEST_F(MachineCalibration, ALossWhoseScaleIsThatOfTheNoiseMakesNoBadFit) {
  write_hertz(folder());
  write_text(folder() / "h.toml", std::string(k_hertz) + "[fit]\nloss = \"cauchy\"\nloss_scale = 1e-5\n");
  const CalibrationResult result = calibrate(read_calibration(folder() / "h.toml"));
  EXPECT_GT(result.goodness.r_squared, 0.99);
  EXPECT_LT(result.goodness.explained, k_least_explained);
  EXPECT_TRUE(result.warnings.empty());
}

}  // namespace
}  // namespace monograin::machine_test
