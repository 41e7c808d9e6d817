// Runs of packings in all forms and under all controls.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "models/packing/cases.hpp"
#include "support/deviation.hpp"
#include "support/test_run.hpp"

namespace monograin::packing::runs_test {
namespace {

std::string option(const char* key, double value) { return fmt::format("{} = {:.17g}\n", key, value); }

/// A scenario with given parameters.
CheckedScenario scenario_of(const Parameters& p, std::vector<Step> steps,
                            std::optional<double> initial = std::nullopt) {
  std::string text = "model = \"packing\"\n[material]\n";
  text += option("youngs_modulus", p.youngs_modulus) + option("poisson_ratio", p.poisson_ratio);
  if (p.plasticity) {
    text += option("yield_stress", p.plasticity->yield_stress) +
            option("hardening_modulus", p.plasticity->hardening_modulus);
  }
  text += "[packing]\n";
  text += option("f_E", p.stretch_exponent) + option("f_G", p.shear_exponent) + option("c1", p.coupling_factor);
  if (!p.has_continuous_jamming)
    text += option("critical_porosity", p.critical_porosity) + option("c2", p.strain_offset);
  text += option("alpha", p.plastic_growth) + option("jamming_fraction", p.jamming_fraction);
  text += option("Z_c", p.coordination_at_jamming) + option("Z_1", p.coordination_at_reference) +
          option("Phi_1", p.reference_fraction);
  if (p.coupling == Coupling::consistent) text += "coupling = \"consistent\"\n";
  if (p.has_continuous_jamming) text += "continuous_jamming = true\n";
  if (initial) text += option("initial_packing_fraction", *initial);
  text += "[loading]\n[[loading.steps]]\nhold = true\nduration = 1\n";
  CheckedScenario scenario = parse_scenario(text, "packing.toml");
  scenario.loading.steps = std::move(steps);
  scenario.output.points = 50;
  return scenario;
}

Step to(Step::Kind kind, double target, double duration = 1.0) {
  return {.kind = kind, .target = target, .duration = duration, .rate = {}, .until = {}, .where = {}};
}
Step to_fraction(double target, double duration = 1.0) { return to(Step::Kind::packing_fraction, target, duration); }
Step to_stress(double target) { return to(Step::Kind::stress, target); }
Step to_strain(double target) { return to(Step::Kind::strain, target); }

constexpr Tolerances k_default{};

/// Largest error of the columns over the rows of a run, each over its largest magnitude. The reference is the printed
/// equations at the prescribed packing fraction.
double error_of(const TestRun& run, const Parameters& p) {
  const Printed printed{p};
  const auto phi = run.outputs("packing_fraction");
  double worst = 0.0;
  const auto compare = [&](const char* column, auto&& expected) {
    const auto values = run.outputs(column);
    double error = 0.0;
    double scale = 0.0;
    for (std::size_t k = 0; k < phi.size(); ++k) {
      const auto value = static_cast<double>(expected(Precise(phi[k])));
      // By the round-off of Phi the printed power of Phi - Phi_c may be undefined where the packing jams.
      if (k == 0 && std::isnan(value)) continue;
      error = std::max(error, deviation(values[k], value));
      scale = std::max(scale, std::abs(value));
    }
    worst = std::max(worst, error / scale);
  };
  compare("stress_elastic", [&](const Precise& at) { return printed.elastic(at); });
  compare("stress", [&](const Precise& at) { return printed.stress(at); });
  compare("strain", [&](const Precise& at) { return printed.strain(at); });
  compare("coordination_number", [&](const Precise& at) { return printed.coordination(at); });
  return worst;
}

class PackingRun : public ::testing::TestWithParam<Curve> {
 protected:
  PackingRun() : table_(reference(GetParam().file)) {}

  /// The run through the packing fractions of the curve, or through its strains or stresses.
  TestRun run_through(Step::Kind kind, const char* integrator, const Tolerances& tolerances) {
    std::vector<double> values = table_.column(kind == Step::Kind::packing_fraction ? "packing_fraction"
                                               : kind == Step::Kind::strain         ? "elastic_excess_strain"
                                                                                    : "stress");
    // The strain has its greatest value before Phi = 1; next to it, an error of the strain is one of the fraction.
    rows_ = 0;
    is_inverse_ = kind != Step::Kind::packing_fraction;
    const auto phi = table_.column("packing_fraction");
    while (rows_ < values.size() && (kind != Step::Kind::strain || phi[rows_] < 0.98)) ++rows_;
    values.resize(rows_);
    if (kind == Step::Kind::stress) std::ranges::transform(values, values.begin(), [](double v) { return v * k_mega; });
    CheckedScenario scenario = scenario_of(GetParam().parameters, {to(kind, values.back(), values.back())});
    if (kind == Step::Kind::packing_fraction) {
      scenario.loading.steps[0].duration = values.back() - 0.8;
      for (const double v : values) scenario.output.times.push_back(v - 0.8);
    } else {
      start_ = kind == Step::Kind::strain ? values.front() : 0.0;
      scenario.loading.steps[0].duration = values.back() - start_;
      for (const double v : values) scenario.output.times.push_back(v - start_);
    }
    std::erase_if(scenario.output.times, [](double t) { return t <= 0.0; });
    return run(scenario, integrator, tolerances);
  }

  [[nodiscard]] double error(const TestRun& run) const {
    double worst = 0.0;
    const auto compare = [&](const char* column, const char* expected, double unit) {
      const auto values = run.outputs(column);
      auto reference = table_.column(expected);
      reference.resize(rows_);
      // Under stress control the run begins before the first row, at zero stress.
      ASSERT_LE(rows_, values.size()) << column;
      const std::size_t skipped = values.size() - rows_;
      EXPECT_LE(skipped, 1U) << column;
      const double scale = *std::ranges::max_element(reference);
      // With the consistent coupling, two packings next to jamming have equal strain and equal stress.
      const bool is_ambiguous = GetParam().parameters.coupling == Coupling::consistent && is_inverse_;
      for (std::size_t k = is_ambiguous ? 1 : 0; k < rows_; ++k) {
        worst = std::max(worst, deviation(values[k + skipped] / unit, reference[k]) / scale);
      }
    };
    compare("packing_fraction", "packing_fraction", 1.0);
    compare("stress", "stress", k_mega);
    compare("stress_elastic", "stress_elastic", k_mega);
    compare("strain", "elastic_excess_strain", 1.0);
    compare("coordination_number", "coordination_number", 1.0);
    return worst;
  }

  Table table_;
  std::size_t rows_ = 0;
  bool is_inverse_ = false;
  double start_ = 0.0;
};

TEST_P(PackingRun, FollowsTheReferenceInAllFormsAndControls) {
  for (const Step::Kind kind : {Step::Kind::packing_fraction, Step::Kind::strain, Step::Kind::stress}) {
    for (const char* integrator : k_integrators) {
      const bool is_direct = integrator == std::string("direct");
      const double at_default = error(run_through(kind, integrator, k_default));
      EXPECT_LT(at_default, is_direct ? 1e-12 : 1e-6) << integrator << ", control " << static_cast<int>(kind);
      if (is_direct) continue;
      const double tight = error(run_through(kind, integrator, {.rtol = 1e-11}));
      EXPECT_LT(tight, 1e-9) << integrator << ", control " << static_cast<int>(kind);
      RecordProperty(fmt::format("{}_{}", integrator, static_cast<int>(kind)),
                     fmt::format("{:.1e} at default, {:.1e} at 1e-11", at_default, tight));
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Packing, PackingRun, ::testing::ValuesIn(curves()),
                         [](const auto& curve) { return std::string(curve.param.file); });

TEST(PackingEvents, LieWhereTheReferenceHasThem) {
  const Table table = reference("pack05_crossings");
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const double place = table.at(row, *table.find("packing_fraction"));
    const double stress = table.at(row, *table.find("stress")) * k_mega;
    const Parameters p = published(table.at(row, 0));
    for (const char* integrator : k_integrators) {
      const TestRun by_fraction = run(scenario_of(p, {to_fraction(0.96)}), integrator);
      EXPECT_EQ(by_fraction.events(), (std::vector<std::string>{"jamming", "plastic-softening"}));
      EXPECT_NEAR(by_fraction.time_of("plastic-softening"), (place - 0.8) / 0.16, 1e-12);
      const TestRun by_stress = run(scenario_of(p, {to_stress(2.0 * stress)}), integrator);
      EXPECT_EQ(by_stress.events(), (std::vector<std::string>{"jamming", "plastic-softening"}));
      EXPECT_NEAR(by_stress.time_of("plastic-softening"), 0.5, 1e-12) << integrator;
      const double strain = static_cast<double>(Printed{p}.strain(place));
      const TestRun by_strain = run(scenario_of(p, {to_strain(0.18)}), integrator);
      const double start = static_cast<double>(Printed{p}.strain(0.8));
      EXPECT_NEAR(by_strain.time_of("plastic-softening"), (strain - start) / (0.18 - start), 1e-12) << integrator;
    }
  }
}

TEST(PackingEvents, FullPlasticityKinksTheStressAndNotTheState) {
  Parameters p = published(1.0);
  p.plastic_growth = 8.0;
  const double place = 0.8 * std::exp(1.0 / 8.0);
  for (const char* integrator : k_integrators) {
    const TestRun by_fraction = run(scenario_of(p, {to_fraction(0.95)}), integrator);
    EXPECT_NEAR(by_fraction.time_of("fully-plastic"), (place - 0.8) / 0.15, 1e-12) << integrator;
    EXPECT_EQ(by_fraction.record.history.word(by_fraction.record.history.row_count() - 1,
                                              *by_fraction.record.history.find("regime")),
              "fully-plastic");
    EXPECT_EQ(by_fraction.last("plastic_fraction"), 1.0);
    EXPECT_LT(error_of(by_fraction, p), integrator == std::string("direct") ? 1e-13 : 1e-6);
    const TestRun by_strain = run(scenario_of(p, {to_strain(0.17)}), integrator);
    EXPECT_NEAR(by_strain.at_event("fully-plastic", "packing_fraction"), place, 1e-6);
    EXPECT_LT(error_of(by_strain, p), integrator == std::string("direct") ? 1e-12 : 1e-6);
  }
}

TEST(PackingRuns, FollowThePrintedEquationsForAnyParameters) {
  int counted = 0;
  for (const Parameters& p : random_parameters(6)) {
    const Law law = make_law(p);
    try {
      static_cast<void>(state(law, law.jamming));
    } catch (const std::domain_error&) {
      continue;  // no state where it jams
    }
    const double end = std::lerp(law.jamming, law.end, 0.97);
    Parameters written = p;
    for (const char* integrator : k_integrators) {
      const bool is_direct = integrator == std::string("direct");
      const TestRun run_ = run(scenario_of(written, {to_fraction(end)}), integrator);
      ASSERT_EQ(run_.record.status, RunStatus::complete) << run_.record.message << "\n" << p;
      // Next to jamming the round-off of Phi is large against everything that begins there.
      EXPECT_LT(error_of(run_, p), is_direct ? 1e-11 : 1e-6) << integrator << ": " << p;
      if (is_direct) continue;
      const TestRun tight = run(scenario_of(written, {to_fraction(end)}), integrator, {.rtol = 1e-11});
      EXPECT_LT(error_of(tight, p), 1e-9) << integrator << ": " << p;
      ++counted;
    }
  }
  EXPECT_GT(counted, 12);
}

TEST(PackingRuns, ErrAsTheirToleranceSays) {
  // No event resets the state during this program.
  const Parameters p = published();
  const double exact = static_cast<double>(Printed{p}.elastic(Precise(0.99)));
  for (const char* integrator : {"cvode-adams", "cvode-bdf", "ida"}) {
    double first = 0.0;
    double last = 0.0;
    for (const double rtol : {1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11}) {
      const double end = run(scenario_of(p, {to_fraction(0.99)}), integrator, relative(rtol)).last("stress_elastic");
      const double error = std::abs(end / exact - 1.0);
      RecordProperty(fmt::format("{}_{:.0e}", integrator, rtol), fmt::format("{:.2e}", error));
      EXPECT_LT(error, 5.0 * rtol) << integrator << ", rtol " << rtol;
      if (rtol == 1e-5) first = error;
      last = error;
    }
    EXPECT_LT(last, 1e-4 * first) << integrator;
  }
}

TEST(PackingRuns, DoNotDependOnTheRate) {
  const Parameters p = published(1.0);
  for (const char* integrator : k_integrators) {
    const TestRun slow = run(scenario_of(p, {to_fraction(0.95, 1e6)}), integrator);
    const TestRun fast = run(scenario_of(p, {to_fraction(0.95, 1e-6)}), integrator);
    CheckedScenario rated = scenario_of(p, {to_fraction(0.95)});
    rated.loading.steps[0].duration.reset();
    rated.loading.steps[0].rate = 0.3;
    const TestRun with_rate = run(rated, integrator);
    EXPECT_NEAR(with_rate.column("time").back(), 0.5, 1e-15);
    EXPECT_EQ(slow.column("stress"), fast.column("stress")) << integrator;
    EXPECT_EQ(slow.column("stress"), with_rate.column("stress")) << integrator;
  }
}

TEST(PackingRuns, BeginLooseAndJam) {
  const Parameters p = published();
  for (const char* integrator : k_integrators) {
    const TestRun by_fraction = run(scenario_of(p, {to_fraction(0.9)}, 0.7), integrator);
    EXPECT_NEAR(by_fraction.time_of("jamming"), 0.5, 1e-12);
    EXPECT_NEAR(by_fraction.at_event("jamming", "stress"), 10772.02222939747, 1e-6);
    const Table& history = by_fraction.record.history;
    for (std::size_t row = 0; row < history.row_count(); ++row) {
      const double phi = history.at(row, *history.find("packing_fraction"));
      const bool is_loose = history.word(row, *history.find("regime")) == "unjammed";
      EXPECT_EQ(is_loose, history.at(row, *history.find("stress")) == 0.0);
      EXPECT_EQ(is_loose, std::isnan(history.at(row, *history.find("coordination_number"))));
      if (is_loose) {
        EXPECT_NEAR(history.at(row, *history.find("strain")), 0.0067588272343363 + std::log(phi / 0.8), 1e-14);
      }
    }
    // Strain from the start to jamming.
    const double to_jamming = std::log(0.8 / 0.7);
    const double begin = 0.0067588272343363 - to_jamming;
    const TestRun by_strain = run(scenario_of(p, {to_strain(0.1)}, 0.7), integrator);
    EXPECT_NEAR(by_strain.time_of("jamming"), to_jamming / (0.1 - begin), 1e-12);
    EXPECT_NEAR(by_strain.column("strain").front(), begin, 1e-14);
    EXPECT_NEAR(by_strain.last("strain"), 0.1, 1e-7);
  }
}

TEST(PackingRuns, JamAtOnceUnderStressAndStayUntilItIsBorne) {
  const Parameters p = published();
  for (const char* integrator : k_integrators) {
    const TestRun run_ = run(scenario_of(p, {to_stress(21544.04445879494)}, 0.7), integrator);
    EXPECT_EQ(run_.events(), (std::vector<std::string>{"jamming"}));
    EXPECT_EQ(run_.time_of("jamming"), 0.0);
    const auto time = run_.column("time");
    const auto phi = run_.column("packing_fraction");
    const auto stress = run_.column("stress");
    for (std::size_t k = 0; k < time.size(); ++k) {
      EXPECT_NEAR(stress[k], time[k] * 21544.04445879494, 1e-2) << integrator;
      if (time[k] <= 0.5) {
        EXPECT_EQ(phi[k], 0.8);
      } else {
        EXPECT_GT(phi[k], 0.8);
      }
    }
  }
}

TEST(PackingRuns, OfElasticParticlesAreReversible) {
  const Parameters p = published();
  for (const char* integrator : k_integrators) {
    const double bound = integrator == std::string("direct") ? 1e-13 : 1e-6;
    for (const Step& there : {to_fraction(0.93), to_strain(0.15), to_stress(0.9e6)}) {
      const TestRun run_ = run(scenario_of(p, {there, to_fraction(0.82), to_stress(0.5e6), to_strain(0.02),
                                               to_fraction(0.7), to_fraction(0.9)}),
                               integrator);
      ASSERT_EQ(run_.record.status, RunStatus::complete) << run_.record.message;
      const auto phi = run_.column("packing_fraction");
      const auto stress = run_.column("stress");
      for (std::size_t k = 0; k < phi.size(); ++k) {
        const double expected = phi[k] < 0.8 || stress[k] == 0.0 ? 0.0 : state(make_law(p), phi[k]).stress;
        EXPECT_NEAR(stress[k], expected, bound * 0.9e6) << integrator << ", Phi " << phi[k];
      }
      // The packing comes loose when it is unloaded, and jams again.
      EXPECT_EQ(run_.events(), (std::vector<std::string>{"jamming", "jamming", "jamming"})) << integrator;
    }
  }
}

TEST(PackingRuns, HoldAndEndAtEvents) {
  CheckedScenario scenario = scenario_of(published(1.0), {to_fraction(0.95), to_fraction(0.96)});
  scenario.loading.steps[0] = until_event(scenario.loading.steps[0], "plastic-softening");
  scenario.loading.steps.insert(scenario.loading.steps.begin() + 1, hold(2.0));
  for (const char* integrator : k_integrators) {
    const TestRun run_ = run(scenario, integrator);
    EXPECT_EQ(run_.events(), (std::vector<std::string>{"jamming", "plastic-softening", "until-met"}));
    EXPECT_NEAR(run_.at_event("until-met", "packing_fraction"), 0.87974314844118963, 1e-12);
    EXPECT_NEAR(run_.last("packing_fraction"), 0.96, 1e-15);
  }
}

/// A packing whose strain falls at first from jamming on, where its modulus begins.
Parameters falls_at_first(double coupling_factor) {
  Parameters p = published(0.0);
  p.poisson_ratio = 0.3;
  p.plasticity->yield_stress = 2e-5;
  p.plastic_growth = 20.0;
  p.coupling_factor = coupling_factor;
  p.strain_offset = 0.24;
  p.critical_porosity = 0.18;
  return p;
}

TEST(PackingJamming, PassesWithItWhatLiesBeforeTheGrowingStrain) {
  const Parameters p = falls_at_first(0.1);
  const Law law = make_law(p);
  const double jamming_strain = state(law, law.jamming).strain;
  const double found = packing_fraction_at(law, growing_branch(law, Measure::strain), jamming_strain);
  ASSERT_GT(found, full_plasticity(law));
  for (const char* integrator : k_integrators) {
    const TestRun run_ = run(scenario_of(p, {to_strain(0.08)}, 0.81), integrator);
    EXPECT_EQ(run_.record.status, RunStatus::complete) << run_.record.message;
    const double time = run_.time_of("jamming");
    EXPECT_GT(time, 0.0);
    EXPECT_EQ(run_.time_of("plastic-softening"), time) << integrator;
    EXPECT_EQ(run_.time_of("fully-plastic"), time) << integrator;
    const auto regime = *run_.record.history.find("regime");
    const auto fraction = *run_.record.history.find("packing_fraction");
    for (std::size_t row = 0; row < run_.record.history.row_count(); ++row) {
      const bool is_jammed = run_.record.history.at(row, fraction) > law.jamming;
      EXPECT_EQ(run_.record.history.word(row, regime), is_jammed ? "fully-plastic" : "unjammed") << integrator;
    }
  }
}

TEST(PackingEnds, AtJammingWhereTheStrainNeverGrowsToThatAgain) {
  for (const double coupling_factor : {0.02, 0.03}) {
    const Parameters p = falls_at_first(coupling_factor);
    const Law law = make_law(p);
    const State at_jamming = state(law, law.jamming);
    ASSERT_LT(growing_branch(law, Measure::strain).greatest, at_jamming.strain);
    for (const char* integrator : k_integrators) {
      const TestRun run_ = run(scenario_of(p, {to_strain(0.08)}, 0.81), integrator);
      EXPECT_EQ(run_.record.status, RunStatus::stopped);
      EXPECT_NE(run_.record.message.find("does not grow"), std::string::npos) << run_.record.message;
      EXPECT_EQ(run_.time_of("limit"), run_.time_of("jamming")) << integrator;
      EXPECT_EQ(run_.last("packing_fraction"), law.jamming) << integrator;
      EXPECT_NEAR(run_.last("strain"), at_jamming.strain, 1e-15) << integrator;
      EXPECT_EQ(run_.last("stress"), at_jamming.stress) << integrator;
    }
  }
}

TEST(PackingEnds, WhereNoPoresAreLeft) {
  for (const char* integrator : k_integrators) {
    const TestRun beyond = run(scenario_of(published(1.0), {to_fraction(1.2)}), integrator);
    EXPECT_EQ(beyond.record.status, RunStatus::stopped);
    EXPECT_NEAR(beyond.time_of("full"), 0.5, 1e-12);
    EXPECT_NE(beyond.record.message.find("no pores are left"), std::string::npos);
    EXPECT_NEAR(beyond.last("stress"), 3.8567265914597967e6, 10.0) << integrator;
    const TestRun by_stress = run(scenario_of(published(), {to_stress(14.745021855269548e6)}), integrator);
    EXPECT_EQ(by_stress.record.status, RunStatus::stopped);
    EXPECT_NEAR(by_stress.time_of("full"), 0.5, 1e-12);
    // A run whose program ends there is complete.
    const TestRun exact = run(scenario_of(published(1.0), {to_fraction(1.0)}), integrator);
    EXPECT_EQ(exact.record.status, RunStatus::complete);
    EXPECT_EQ(exact.time_of("full"), 1.0);
    const TestRun again = run(scenario_of(published(1.0), {to_fraction(1.0), to_fraction(1.1)}), integrator);
    EXPECT_EQ(again.record.status, RunStatus::stopped);
  }
}

TEST(PackingEnds, WhereTheStrainIsGreatest) {
  for (const char* integrator : k_integrators) {
    const TestRun run_ = run(scenario_of(published(), {to_strain(0.25)}), integrator);
    EXPECT_EQ(run_.record.status, RunStatus::stopped);
    EXPECT_TRUE(run_.has_event("limit")) << integrator;
    EXPECT_NE(run_.record.message.find("does not grow"), std::string::npos) << run_.record.message;
    EXPECT_NEAR(run_.last("strain"), 0.202776535690545133, 1e-6) << integrator;
  }
}

TEST(PackingEnds, WhereTheStressIsGreatest) {
  // So plastic that the stress falls before the packing is full.
  Parameters p = published(0.0);
  p.plastic_growth = 8.0;
  p.plasticity->yield_stress = 0.1e6;
  const Branch branch = growing_branch(make_law(p), Measure::stress);
  ASSERT_LT(branch.end, 0.95);
  for (const char* integrator : k_integrators) {
    const TestRun run_ = run(scenario_of(p, {to_stress(1e6)}), integrator);
    EXPECT_EQ(run_.record.status, RunStatus::stopped);
    EXPECT_TRUE(run_.has_event("limit")) << integrator;
    EXPECT_NEAR(run_.last("stress"), branch.greatest, 1e-6 * branch.greatest) << integrator;
    // The packing fraction passes the greatest stress and goes on.
    const TestRun passing = run(scenario_of(p, {to_fraction(0.97)}), integrator);
    EXPECT_EQ(passing.record.status, RunStatus::complete);
  }
}

TEST(PackingEnds, WhereTheParticlesGiveWayAsMuch) {
  Parameters p = published();
  p.coupling = Coupling::consistent;
  p.coupling_factor = 0.1;
  for (const char* integrator : k_integrators) {
    const TestRun run_ = run(scenario_of(p, {to_fraction(1.0)}), integrator);
    EXPECT_EQ(run_.record.status, RunStatus::stopped) << integrator;
    EXPECT_TRUE(run_.has_event("limit")) << integrator;
  }
}

TEST(PackingUnloading, OfPlasticParticlesThatOnlyTheRunFindsStopsIt) {
  CheckedScenario scenario =
      scenario_of(published(1.0), {until_event(to_fraction(0.95), "plastic-softening"), to_fraction(0.86)});
  const TestRun run_ = run(scenario, "direct");
  EXPECT_EQ(run_.record.status, RunStatus::stopped);
  EXPECT_EQ(run_.record.limit, Limit::no_unloading_law) << run_.record.message;
}

TEST(PackingUnloading, IsNoneIfATargetIsThePresentValueButForRoundOff) {
  const Parameters p = published(1.0);
  const std::vector<Step> steps{to_fraction(0.9), to_stress(1e6)};
  for (const char* integrator : k_integrators) {
    const double reached = run(scenario_of(p, steps), integrator).last("packing_fraction");
    std::vector<Step> longer = steps;
    longer.push_back(to_fraction(reached * (1.0 - 1e-14)));
    const TestRun run_ = run(scenario_of(p, longer), integrator);
    EXPECT_EQ(run_.record.status, RunStatus::complete) << integrator << ": " << run_.record.message;
    EXPECT_NEAR(run_.last("packing_fraction"), reached, 1e-6) << integrator;
  }
}

}  // namespace
}  // namespace monograin::packing::runs_test
