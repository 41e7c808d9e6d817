#include "elastic/line_contact.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "history/table.hpp"

namespace monograin::line_contact_test {
namespace {

constexpr double k_modulus = 10.0 / (1.0 - 0.45 * 0.45);  // MPa

Table curve(const char* file) {
  return read_csv(std::string(MONOGRAIN_SOURCE_DIR "/tests/models/elastic/reference/") + file);
}

TEST(LineContact, IsTheClosedFormInBothDirections) {
  const Table table = curve("disc01_elastic_line_contact.csv");
  ASSERT_EQ(table.row_count(), 100U);
  const auto stress = table.column("nominal_stress_P_over_D");
  const auto width = table.column("half_width_over_R");
  const auto strain = table.column("strain_delta_over_D");
  const auto tangent = table.column("d_stress_d_strain");
  for (std::size_t k = 0; k < stress.size(); ++k) {
    for (const LineContact& c :
         {line_contact_under_stress(k_modulus, stress[k]), line_contact_at_strain(k_modulus, strain[k])}) {
      EXPECT_NEAR(c.stress, stress[k], 1e-14 * stress[k] * 4.0);
      EXPECT_NEAR(c.half_width, width[k], 1e-14 * width[k] * 4.0);
      EXPECT_NEAR(c.strain, strain[k], 1e-14 * strain[k] * 4.0);
      EXPECT_NEAR(c.tangent, tangent[k], 1e-14 * tangent[k] * 4.0);
    }
  }
}

TEST(LineContact, HasTheTangentOfItsDifferences) {
  for (const double strain : {1e-8, 1e-4, 0.02, 0.17, 0.4}) {
    const double step = 1e-5 * strain;
    const double slope =
        (line_contact_at_strain(1.0, strain + step).stress - line_contact_at_strain(1.0, strain - step).stress) /
        (2.0 * step);
    EXPECT_NEAR(line_contact_at_strain(1.0, strain).tangent, slope, 1e-8 * slope) << strain;
  }
}

TEST(LineContact, InvertsItselfOverItsWholeDomain) {
  for (double strain = 1e-30; strain < 0.443; strain *= 1.7) {
    const LineContact c = line_contact_at_strain(k_modulus, strain);
    EXPECT_NEAR(line_contact_under_stress(k_modulus, c.stress).strain, strain, 1e-13 * strain);
  }
}

TEST(LineContact, IsWithinAPercentOfFiniteElementsWhileItIsSmall) {
  const Table table = curve("disc02_fe.csv");
  const auto strain = table.column("strain_delta_over_D");
  const auto stress = table.column("elastic_P_over_D");
  double small = 0.0;
  double large = 0.0;
  for (std::size_t k = 0; k < strain.size(); ++k) {
    const double error =
        stress[k] / line_contact_at_strain(k_modulus, strain[k] > 0.0 ? strain[k] : 1.0e-9).stress - 1.0;
    if (strain[k] >= 0.01 && strain[k] <= 0.05) small = std::max(small, std::abs(error));
    if (strain[k] > 0.05) large = std::max(large, std::abs(error));
  }
  EXPECT_LT(small, 0.015);  // the calculation's own accuracy, and its noise
  EXPECT_GT(large, 0.02);   // the half space is left behind
  EXPECT_LT(large, 0.055);
}

TEST(LineContact, EndsWhereItIsAsWideAsTheRadius) {
  EXPECT_EQ(line_contact_at_strain(1.0, 0.0).stress, 0.0);
  EXPECT_EQ(line_contact_under_stress(1.0, 0.0).strain, 0.0);
  EXPECT_THROW(static_cast<void>(line_contact_at_strain(1.0, 0.45)), std::domain_error);
  EXPECT_THROW(static_cast<void>(line_contact_at_strain(1.0, -0.01)), std::domain_error);
  EXPECT_THROW(static_cast<void>(line_contact_under_stress(1.0, 1.0)), std::domain_error);
  EXPECT_THROW(static_cast<void>(line_contact_under_stress(1.0, -1.0)), std::domain_error);
}

}  // namespace
}  // namespace monograin::line_contact_test
