#include "material-point/properties.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "material-point/presets.hpp"
#include "models/material-point/cases.hpp"
#include "support/reference_case.hpp"

namespace monograin::material_point::properties_test {
namespace {

struct Named {
  const char* name;
  Evolving Properties::*member;
};
constexpr Named k_members[] = {
    {"youngs_modulus", &Properties::youngs_modulus},
    {"poisson_ratio", &Properties::poisson_ratio},
    {"bulk_modulus", &Properties::bulk_modulus},
    {"shear_modulus", &Properties::shear_modulus},
    {"yield_pressure", &Properties::yield_pressure},
    {"shear_strength", &Properties::shear_strength},
    {"tensile_strength", &Properties::tensile_strength},
    {"axis_ratio", &Properties::axis_ratio},
    {"cap_centre", &Properties::cap_centre},
};

TEST(MaterialPointProperties, SlopesAreDerivatives) {
  for (const Parameters& m : {base_case(), lactose(0.03), von_mises(3.0)}) {
    for (const double phi : {-0.05, 0.0, 0.1, 0.2}) {
      const double step = 1e-6;
      const Properties before = properties_at(m, phi - step);
      const Properties now = properties_at(m, phi);
      const Properties after = properties_at(m, phi + step);
      for (const auto& [name, member] : k_members) {
        const double quotient = ((after.*member).value - (before.*member).value) / (2.0 * step);
        // Truncation of the quotient, with exponents of up to 12.
        EXPECT_NEAR((now.*member).slope, quotient, 1e-8 * (1.0 + std::abs(quotient))) << name << " at phi = " << phi;
      }
    }
  }
}

TEST(MaterialPointProperties, AreTheGivenOnesAtTheReferenceDensity) {
  const Parameters m = lactose(0.0);
  const Properties at = properties_at(m, std::log(m.reference_density / m.relative_density));
  EXPECT_DOUBLE_EQ(at.relative_density, m.reference_density);
  EXPECT_DOUBLE_EQ(at.yield_pressure.value, 1.0);
  EXPECT_DOUBLE_EQ(at.youngs_modulus.value, m.stiffness_ratio);
  EXPECT_DOUBLE_EQ(at.shear_strength.value, m.shear_ratio);
  EXPECT_DOUBLE_EQ(at.tensile_strength.value, m.tensile_ratio);
  EXPECT_DOUBLE_EQ(at.cap_centre.value, 1.0 - m.eps0 * m.shear_ratio);
}

// Strengths that grow with one exponent preserve the surface's shape if the axis ratio is constant as well (corrected:
// the source omits the last condition).
TEST(MaterialPointProperties, MakeSelfSimilarSurfacesOnlyWithAConstantAxisRatio) {
  Parameters m = base_case();
  const auto shape = [&](double phi) {
    const Properties at = properties_at(m, phi);
    return at.cap_centre.value / at.yield_pressure.value;
  };
  EXPECT_GT(std::abs(shape(0.2) - shape(0.0)), 0.1);
  m.xi2 = 0.0;
  EXPECT_NEAR(shape(0.2), shape(0.0), 1e-15);
}

TEST(MaterialPointProperties, OfVonMisesKeepTheDensity) {
  EXPECT_EQ(properties_at(von_mises(3.0), 0.3).relative_density, von_mises(3.0).relative_density);
}

TEST(MaterialPointProperties, DissipationClosesTheBalanceOfWork) {
  const Parameters m = base_case();
  // p and s over a small plastic increment at given elastic strains: work = d(stored) + dissipation to first order.
  const double phi = 0.1;
  const double elastic_volumetric = -0.01;
  const double elastic_deviatoric = -0.004;
  const auto stored = [&](double at_phi, double ev, double g) {
    const Properties at = properties_at(m, at_phi);
    return stored_energy(at, at.bulk_modulus.value * ev, 3.0 * at.shear_modulus.value * g);
  };
  const Properties at = properties_at(m, phi);
  const double p = at.bulk_modulus.value * elastic_volumetric;
  const double s = 3.0 * at.shear_modulus.value * elastic_deviatoric;
  const double step = 1e-6;
  const double plastic_volumetric = -step;  // phi grows by `step`
  const double plastic_deviatoric = -0.3 * step;
  const double work = p * (plastic_volumetric + 2e-7) + s * (plastic_deviatoric + 1e-7);
  const double gained = stored(phi + step, elastic_volumetric + 2e-7, elastic_deviatoric + 1e-7) -
                        stored(phi, elastic_volumetric, elastic_deviatoric);
  EXPECT_NEAR(work - gained, dissipation(at, p, s, plastic_volumetric, plastic_deviatoric, step), 1e-4 * work);
}

// --- presets

const Preset& preset(std::string_view name) {
  for (const Preset& candidate : presets()) {
    if (candidate.name == name) return candidate;
  }
  throw std::out_of_range(std::string(name));
}

double value_of(const Preset& material, std::string_view key) {
  for (const auto& [name, value] : material.values) {
    if (name == key) return value;
  }
  return std::nan("");
}

TEST(MaterialPointPresets, AreTheRowsOfTheTables) {
  std::size_t rows = 0;
  for (const char* file : {"table4_materials", "table6_base_case"}) {
    const Table table = read_csv(test_file(std::string("models/material-point/reference/") + file + ".csv"));
    for (std::size_t row = 0; row < table.row_count(); ++row, ++rows) {
      const Preset& material = preset(table.word(row, 0));
      EXPECT_EQ(material.values.size(), 13u) << material.name;
      for (const auto& [key, value] : material.values) {
        const double unit = key == "yield_pressure" ? 1e6 : 1.0;
        EXPECT_DOUBLE_EQ(value, unit * table.at(row, *table.find(key))) << material.name << ", " << key;
      }
    }
  }
  EXPECT_EQ(rows, 8u);
  // The names of Table 5 hold commas, which the reader of tables does not take.
  EXPECT_EQ(presets().size(), rows + 10);
  EXPECT_EQ(value_of(preset("Starch, dry"), "stiffness_ratio"), 174.3);
  EXPECT_EQ(value_of(preset("Silica sand w/ PVP binder"), "stiffness_ratio"), 32.0);
}

}  // namespace
}  // namespace monograin::material_point::properties_test
