#include "packing/law.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "models/accuracy.hpp"
#include "models/packing/cases.hpp"
#include "support/deviation.hpp"

namespace monograin::packing::law_test {
namespace {

double largest_error(const std::vector<double>& expected, const std::vector<double>& actual, double unit) {
  double error = 0.0;
  double scale = 0.0;
  for (std::size_t k = 0; k < expected.size(); ++k) {
    error = std::max(error, deviation(actual[k] / unit, expected[k]));
    scale = std::max(scale, std::abs(expected[k]));
  }
  return error / scale;
}

class PackingCurve : public ::testing::TestWithParam<Curve> {};

TEST_P(PackingCurve, IsThatOfTheReference) {
  const Table table = reference(GetParam().file);
  const Law law = make_law(GetParam().parameters);
  std::vector<double> modulus, strain, elastic, stress, coordination, share;
  for (const double phi : table.column("packing_fraction")) {
    const State s = state(law, phi);
    modulus.push_back(s.modulus);
    strain.push_back(s.strain);
    elastic.push_back(s.stress_elastic);
    stress.push_back(s.stress);
    coordination.push_back(coordination_number(law, phi));
    share.push_back(plastic_fraction(law, phi));
  }
  // The modulus has its nearest pole at x = 1.04 (nu = 0.45): ten round-offs of x at Phi = 1.
  const double bound = 1e-13;
  EXPECT_LT(largest_error(table.column("M_eff"), modulus, k_mega), bound);
  EXPECT_LT(largest_error(table.column("elastic_excess_strain"), strain, 1.0), bound);
  EXPECT_LT(largest_error(table.column("stress_elastic"), elastic, k_mega), bound);
  EXPECT_LT(largest_error(table.column("stress"), stress, k_mega), bound);
  EXPECT_LT(largest_error(table.column("coordination_number"), coordination, 1.0), bound);
  if (!law.given.plasticity) return;  // the file has the fraction of a plastic packing
  EXPECT_LT(largest_error(table.column("plastic_fraction"), share, 1.0), bound);
}
INSTANTIATE_TEST_SUITE_P(Packing, PackingCurve, ::testing::ValuesIn(curves()),
                         [](const auto& curve) { return std::string(curve.param.file); });

/// Hardening modulus in a row; none if the column has a word there.
std::optional<double> hardening_of(const Table& table, std::size_t row) {
  const std::size_t column = *table.find("H");
  if (!table.columns()[column].holds_words()) return table.at(row, column);
  const std::string word(table.word(row, column));
  return word == "elastic" ? std::nullopt : std::optional(std::stod(word));
}

TEST(PackingInverse, FindsTheFractionUnderAStress) {
  const Table table = reference("pack04_points");
  ASSERT_GE(table.row_count(), 20U);
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const Law law = make_law(published(hardening_of(table, row)));
    const double stress = table.at(row, *table.find("stress")) * k_mega;
    const double phi = packing_fraction_at(law, growing_branch(law, Measure::stress), stress);
    EXPECT_NEAR(phi, table.at(row, *table.find("packing_fraction")), 1e-14) << "stress " << stress;
    const double slope = slopes(law, phi, state(law, phi).strain).stress / k_mega;
    const double expected = table.at(row, *table.find("d_stress_d_Phi"));
    EXPECT_NEAR(slope, expected, 1e-12 * std::abs(expected)) << "stress " << stress;
  }
}

TEST(PackingLaw, CrossesTheElasticCurveWhereTheReferenceDoes) {
  const Table table = reference("pack05_crossings");
  ASSERT_EQ(table.row_count(), 3U);
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const Law law = make_law(published(table.at(row, 0)));
    const double phi = table.at(row, *table.find("packing_fraction"));
    const State s = state(law, phi);
    const double expected = table.at(row, *table.find("stress")) * k_mega;
    EXPECT_NEAR(s.stress, expected, 4e-15 * expected / 0.1);
    EXPECT_NEAR(s.stress_elastic, expected, 4e-14 * expected);
  }
}

TEST(PackingLaw, IsWhatIsPrintedForAnyParameters) {
  double worst = 0.0;
  int compared = 0;
  for (const Parameters& p : random_parameters(40)) {
    const Law law = make_law(p);
    const Printed printed{p};
    for (int k = 0; k <= 40; ++k) {
      const double phi = std::lerp(law.jamming, 1.0, std::pow(k / 40.0, 2.0));
      State s;
      try {
        s = state(law, phi);
      } catch (const std::domain_error&) {
        ASSERT_EQ(p.coupling, Coupling::consistent) << p;  // the other denominators have no zero
        break;
      }
      // Near the zero of x or of ln Phi + c2, these have no more digits than the round-off of Phi leaves.
      const double x = 1.0 - (1.0 - phi) / p.critical_porosity;
      const double span = std::log(phi) + p.strain_offset;
      if (k == 0 || x < 1e-6 || span < 1e-6) continue;
      const Precise at = phi;
      // Poles of 3 - r and of 1 - m within the round-off of Phi belong to the law.
      const double room = 3.0 - 2.0 * (1.0 + p.poisson_ratio) * std::pow(x, p.stretch_exponent - p.shear_exponent);
      const double give = std::log(phi) / s.strain + p.strain_offset / s.strain;
      const double scale = (1.0 + p.shear_exponent / x + 1.0 / room) / give / std::min(1.0, span);
      const auto error = [&](double actual, const Precise& expected) {
        return std::abs(static_cast<double>((actual - expected) / expected)) / scale;
      };
      worst = std::max({worst, error(s.modulus, printed.effective(printed.moduli(false), at)),
                        error(s.strain, printed.strain(at)), error(s.stress_elastic, printed.elastic(at)),
                        error(s.stress, printed.stress(at))});
      EXPECT_LT(error(s.stress, printed.stress(at)), 100 * k_epsilon) << p << ", Phi " << phi;
      ++compared;
    }
  }
  EXPECT_LT(worst, 100 * k_epsilon);
  EXPECT_GT(compared, 1200);
  RecordProperty("worst", std::to_string(worst));
}

TEST(PackingLaw, HasTheSlopesOfWhatIsPrinted) {
  for (const Parameters& p : random_parameters(100)) {
    const Law law = make_law(p);
    const Printed printed{p};
    for (const double share : {0.01, 0.1, 0.37, 0.61, 0.93}) {
      const double phi = std::lerp(law.jamming, 1.0, share);
      State s;
      try {
        s = state(law, phi);
      } catch (const std::domain_error&) {
        break;
      }
      const Precise step = 1e-15;
      const auto slope = [&](auto&& function) {
        return static_cast<double>((function(phi + step) - function(phi - step)) / (2 * step));
      };
      const Slopes found = slopes(law, phi, s.strain);
      const double elastic = slope([&](const Precise& at) { return printed.elastic(at); });
      const double strain = slope([&](const Precise& at) { return printed.strain(at); });
      const double stress = slope([&](const Precise& at) { return printed.stress(at); });
      // Over the sum of the magnitudes of their terms, which cancel where the strain has its greatest value.
      const double bound = 1e-9;
      EXPECT_NEAR(found.stress_elastic, elastic, bound * std::abs(elastic)) << p << ", Phi " << phi;
      EXPECT_NEAR(found.strain, strain, bound * std::abs(elastic) / s.modulus) << p << ", Phi " << phi;
      EXPECT_NEAR(found.stress, stress, bound * (std::abs(elastic) + std::abs(stress))) << p << ", Phi " << phi;
    }
  }
}

TEST(PackingLaw, BeginsAndEndsWithItsLimits) {
  const Law law = make_law(published());
  EXPECT_NEAR(state(law, 1.0).modulus, law.modulus_at_one, 1e-13 * law.modulus_at_one);
  EXPECT_NEAR(law.modulus_at_one, 37.931034482758621 * k_mega, 1e-6);
  EXPECT_NEAR(law.bulk_modulus, 34.482758620689655 * k_mega, 1e-6);
  EXPECT_NEAR(law.shear_modulus, 3.4482758620689655 * k_mega, 1e-7);
  EXPECT_EQ(law.jamming, 0.8);
  EXPECT_EQ(coordination_number(law, 0.8), 4.0);
  EXPECT_EQ(coordination_number(law, 1.0), 6.0);

  Parameters p = published();
  p.jamming_fraction = 0.75;  // the moduli begin later: at 0.799
  const Law late = make_law(p);
  EXPECT_DOUBLE_EQ(late.jamming, 0.799);
  for (const double x : {1e-6, 1e-9}) {
    const double modulus = state(late, late.jamming + p.critical_porosity * x).modulus;
    const double limit = 4.0 / 3.0 * late.shear_modulus * std::pow(x, p.shear_exponent);
    // The next term is r/12 = 0.24 x.
    EXPECT_NEAR(modulus / limit, 1.0, x + 4e-17 / x * 10.0);
  }
}

TEST(PackingLaw, BeginsWithoutStressWhereJammingIsContinuous) {
  Parameters p = published(1.0);
  p.has_continuous_jamming = true;
  for (const double phi : {0.64, 0.8, 0.83, 0.9}) {
    p.jamming_fraction = phi;
    const Law law = make_law(p);
    EXPECT_EQ(law.jamming, phi);
    const State s = state(law, phi);
    EXPECT_EQ(s.modulus, 0.0);
    EXPECT_EQ(s.strain, 0.0);
    EXPECT_EQ(s.stress, 0.0);
  }
}

TEST(PackingLaw, IsContinuousWhereEverythingIsPlastic) {
  Parameters p = published(1.0);
  p.plastic_growth = 8.0;
  const Law law = make_law(p);
  const double place = full_plasticity(law);
  EXPECT_NEAR(place, 0.8 * std::exp(1.0 / 8.0), 1e-15);
  const double step = 1e-9;
  const State before = state(law, place - step);
  const State after = state(law, place + step);
  EXPECT_LT(plastic_fraction(law, place - step), 1.0);
  EXPECT_EQ(plastic_fraction(law, place + step), 1.0);
  const double slope_before = slopes(law, place - step, before.strain).stress;
  const double slope_after = slopes(law, place + step, after.strain).stress;
  EXPECT_NEAR(after.stress, before.stress, 1.01 * step * (std::abs(slope_before) + std::abs(slope_after)));
  // The kink: f_p' (sigma_p - sigma_e) of eq. 10 is lost.
  const double plastic = 0.4 * k_mega + state(law, place).stress_elastic * law.hardening_share;
  EXPECT_NEAR(slope_before - slope_after, 8.0 / place * (plastic - state(law, place).stress_elastic),
              1e-6 * std::abs(slope_after));
}

TEST(PackingLaw, ScalesWithItsStresses) {
  const Law law = make_law(published(1.0));
  Parameters p = published(1.0);
  const double factor = 3.7e4;
  p.youngs_modulus *= factor;
  p.plasticity->yield_stress *= factor;
  p.plasticity->hardening_modulus *= factor;
  const Law scaled = make_law(p);
  for (const double phi : {0.81, 0.9, 0.99}) {
    EXPECT_NEAR(state(scaled, phi).stress, factor * state(law, phi).stress, 1e-14 * factor * state(law, phi).stress);
    EXPECT_NEAR(state(scaled, phi).strain, state(law, phi).strain, 1e-15);
  }
}

TEST(PackingBranch, EndsWhereTheStrainIsGreatest) {
  // Expected values by Newton's method with 30 digits.
  const Law law = make_law(published());
  const Branch branch = growing_branch(law, Measure::strain);
  EXPECT_EQ(branch.begin, 0.8);
  EXPECT_NEAR(branch.end, 0.991754408075151855, 1e-9);  // the slope is zero there: half the digits
  EXPECT_NEAR(branch.greatest, 0.202776535690545133, 1e-15);
  EXPECT_THROW(static_cast<void>(packing_fraction_at(law, branch, 0.2028)), std::domain_error);
  EXPECT_THROW(static_cast<void>(packing_fraction_at(law, branch, 0.0067)), std::domain_error);
}

TEST(PackingBranch, BeginsBeyondTheDipOfTheConsistentCoupling) {
  Parameters p = published();
  p.coupling = Coupling::consistent;
  const Law law = make_law(p);
  const Branch branch = growing_branch(law, Measure::stress);
  EXPECT_GT(branch.begin, 0.8);
  EXPECT_LT(branch.begin, 0.8 + 1e-9);
  EXPECT_LT(branch.least, state(law, 0.8).stress);
  EXPECT_NEAR(branch.least, state(law, 0.8).stress, 2e-7 * branch.least);
  EXPECT_EQ(branch.end, 1.0);
}

TEST(PackingBranch, GrowsAndIsInvertedForAnyParameters) {
  for (const Parameters& p : random_parameters(60)) {
    const Law law = make_law(p);
    for (const Measure measure : {Measure::strain, Measure::stress_elastic, Measure::stress}) {
      Branch branch;
      try {
        branch = growing_branch(law, measure);
      } catch (const std::domain_error&) {
        continue;  // no state where it jams
      }
      double before = branch.least;
      for (int k = 1; k < 50; ++k) {
        const double phi = std::lerp(branch.begin, branch.end, k / 50.0);
        const double value = measured(law, measure, phi);
        EXPECT_GT(value, before) << p << ", Phi " << phi;
        before = value;
        if (k < 45) {
          const double found = packing_fraction_at(law, branch, value);
          EXPECT_NEAR(measured(law, measure, found), value, 1e-13 * std::abs(branch.greatest)) << p << ", Phi " << phi;
        }
      }
    }
  }
}

TEST(PackingLaw, RefusesParametersOutsideItsDomain) {
  const auto refuses = [](auto&& change, const std::string& word) {
    Parameters p = published(1.0);
    change(p);
    try {
      static_cast<void>(make_law(p));
    } catch (const std::invalid_argument& error) {
      return std::string(error.what()).find(word) != std::string::npos;
    }
    return false;
  };
  EXPECT_TRUE(refuses([](Parameters& p) { p.stretch_exponent = 0.1; }, "f_E"));
  EXPECT_TRUE(refuses([](Parameters& p) { p.shear_exponent = 0.0; }, "f_G"));
  EXPECT_TRUE(refuses([](Parameters& p) { p.poisson_ratio = 0.5; }, "Poisson"));
  EXPECT_TRUE(refuses([](Parameters& p) { p.poisson_ratio = -1.0; }, "Poisson"));
  EXPECT_TRUE(refuses([](Parameters& p) { p.critical_porosity = 1.0; }, "porosity"));
  EXPECT_TRUE(refuses([](Parameters& p) { p.coupling_factor = 0.0; }, "c1"));
  EXPECT_TRUE(refuses([](Parameters& p) { p.strain_offset = 0.0; }, "c2"));
  EXPECT_TRUE(refuses([](Parameters& p) { p.plastic_growth = -1.0; }, "alpha"));
  EXPECT_TRUE(refuses([](Parameters& p) { p.jamming_fraction = 1.0; }, "jamming"));
  EXPECT_TRUE(refuses([](Parameters& p) { p.jamming_fraction = 1.0 - 9e-6; }, "no pores are left"));
  EXPECT_TRUE(refuses([](Parameters& p) { p.coordination_at_reference = 3.0; }, "Z_1"));
  EXPECT_TRUE(refuses([](Parameters& p) { p.reference_fraction = 0.8; }, "Phi_1"));
  EXPECT_TRUE(refuses([](Parameters& p) { p.plasticity->yield_stress = 0.0; }, "yield"));
  EXPECT_TRUE(refuses([](Parameters& p) { p.plasticity->hardening_modulus = -1.0; }, "hardening"));
  EXPECT_TRUE(refuses([](Parameters& p) { p.youngs_modulus = std::nan(""); }, "Young"));
}

TEST(PackingLaw, HasNoStateOutsideItsDomain) {
  const Law law = make_law(published());
  EXPECT_THROW(static_cast<void>(state(law, 0.7999)), std::domain_error);
  EXPECT_THROW(static_cast<void>(coordination_number(law, 0.7999)), std::domain_error);
  EXPECT_THROW(static_cast<void>(slopes(law, 0.7999, 0.01)), std::domain_error);
  EXPECT_THROW(static_cast<void>(state(law, 1.01)), std::domain_error);  // 3 G_eff < E_eff
  Parameters p = published();
  p.coupling = Coupling::consistent;
  p.coupling_factor = 0.1;  // m = 1.8 at Phi = 1
  const Law ending = make_law(p);
  EXPECT_THROW(static_cast<void>(state(ending, 1.0)), std::domain_error);
  const double place = ending.end;
  EXPECT_LT(place, 1.0);
  EXPECT_NEAR(effective_modulus(ending, place), 0.1 * ending.bulk_modulus * coordination_number(ending, place) * place,
              1e-12 * ending.bulk_modulus);
  EXPECT_EQ(law.end, 1.0);
}

}  // namespace
}  // namespace monograin::packing::law_test
