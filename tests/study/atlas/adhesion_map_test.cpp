#include "study/atlas/adhesion_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "mdr/adhesion_map.hpp"
#include "models/accuracy.hpp"
#include "models/mdr/reference_windows.hpp"

namespace monograin::adhesion_map_test {
namespace {

using mdr::AdhesionValidity;
using mdr::flattened_indenter;
using mdr::flattened_peak_radius;

const std::vector<double> k_displacements{0.1, 0.2, 0.3, 0.4, 0.5};

std::size_t index_of(AdhesionValidity kind) { return static_cast<std::size_t>(kind); }

AdhesionValidity class_at(const AdhesionDiagram& diagram, std::size_t row, std::size_t column) {
  return static_cast<AdhesionValidity>(diagram.at(row, column));
}

class AdhesionMapReference : public ::testing::TestWithParam<Control> {};

TEST_P(AdhesionMapReference, HasTheSameContactsAndWindows) {
  const auto [modulus_over_yield, displacement, yielded, radius, contact_radius, height, peak_radius, least, greatest] =
      mdr::reference_windows(GetParam());
  ASSERT_EQ(radius.size() % k_displacements.size(), 0u);
  for (std::size_t i = 0; i < radius.size(); i += k_displacements.size()) {
    const double ratio = modulus_over_yield[i];
    const auto contacts = flatten(ratio, 0.3, k_displacements);
    ASSERT_EQ(contacts.size(), k_displacements.size());
    for (std::size_t d = 0; d < contacts.size(); ++d) {
      const FlattenedContact& c = contacts[d];
      const auto where = ::testing::Message() << "E/Y = " << ratio << ", delta_o = " << c.displacement;
      ASSERT_EQ(c.displacement, displacement[i + d]) << where;
      EXPECT_EQ(c.has_yielded, yielded[i + d] > 0.0) << where;
      EXPECT_LE(relative_error(c.apparent_radius, radius[i + d]), 1e-12) << where;
      EXPECT_LE(relative_error(flattened_indenter(c).height, height[i + d]), 1e-12) << where;
      // An elastic contact leaves the indenter of the sphere, whatever its own radius was.
      EXPECT_LE(relative_error(flattened_indenter(c).half_width, c.has_yielded ? contact_radius[i + d] : radius[i + d]),
                1e-12)
          << where;
      EXPECT_LE(relative_error(flattened_peak_radius(c), peak_radius[i + d]), 1e-12) << where;
      const double composite_modulus = 1.0 / (1.0 - 0.09);
      const auto window = mdr::adhesion_window(flattened_indenter(c), composite_modulus, 1.0 / ratio,
                                               flattened_peak_radius(c), GetParam());
      EXPECT_LE(relative_error(window.least, least[i + d]), 1e-10) << where;
      EXPECT_LE(relative_error(window.greatest, greatest[i + d]), 1e-10) << where;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Study, AdhesionMapReference, ::testing::Values(Control::displacement, Control::force),
                         [](const auto& instance) {
                           return std::string(instance.param == Control::force ? "ForceControl"
                                                                               : "DisplacementControl");
                         });

/// Of a coarse map that has points of the reference's E/Y: on a diagonal E*/Y is 50/(1 - nu^2).
AdhesionMapSettings coarse(Control control) {
  AdhesionMapSettings settings;
  settings.least_modulus = 50.0 / (1.0 - 0.09) * 3.0;
  settings.least_yield_stress = 3.0;
  settings.decades = 5.0;
  settings.points = 26;
  settings.control = control;
  return settings;
}

TEST(AdhesionMap, ClassifiesEveryPointAsTheWindowOfItsMaterialDoes) {
  for (const Control control : {Control::displacement, Control::force}) {
    const auto diagrams = adhesion_maps(coarse(control));
    ASSERT_EQ(diagrams.size(), k_displacements.size());
    for (std::size_t d = 0; d < diagrams.size(); ++d) {
      const AdhesionDiagram& diagram = diagrams[d];
      ASSERT_EQ(diagram.displacement, k_displacements[d]);
      ASSERT_EQ(diagram.classes.size(), diagram.modulus.size() * diagram.yield_stress.size());
      for (std::size_t row = 0; row < diagram.yield_stress.size(); row += 5) {
        for (std::size_t column = 0; column < diagram.modulus.size(); column += 5) {
          const double modulus = diagram.modulus[column];
          const double yield_stress = diagram.yield_stress[row];
          const auto contact = flatten(modulus / yield_stress * (1.0 - 0.09), 0.3, k_displacements)[d];
          // E* R0 = 1
          const auto window = mdr::adhesion_window(flattened_indenter(contact), 1.0, yield_stress / modulus,
                                                   flattened_peak_radius(contact), control);
          const double surface_energy = 1.0 / modulus;
          const auto expected = surface_energy <= window.least     ? AdhesionValidity::peak_failure
                                : surface_energy > window.greatest ? AdhesionValidity::yielding_failure
                                                                   : AdhesionValidity::valid;
          EXPECT_EQ(class_at(diagram, row, column), expected)
              << "delta_o = " << diagram.displacement << ", E* R0/dg = " << modulus << ", Y R0/dg = " << yield_stress;
        }
      }
    }
  }
}

TEST(AdhesionMap, TurnsWhereTheReferenceDoesAlongAnEqualMaterial) {
  const Table table = read_csv(test_file("models/mdr/reference/adhesion_validity_nu03_xi3.csv"));
  const auto modulus_over_yield = table.column("E_over_Y");
  const auto least = table.column("YR0_over_dg_max");
  const auto greatest = table.column("YR0_over_dg_min");
  const auto diagrams = adhesion_maps(coarse(Control::force));
  std::size_t compared = 0;
  for (std::size_t i = 0; i < modulus_over_yield.size(); ++i) {
    if (modulus_over_yield[i] != 50.0) continue;
    const AdhesionDiagram& diagram = diagrams[i % k_displacements.size()];
    for (std::size_t k = 0; k < diagram.yield_stress.size(); ++k) {
      const double y = diagram.yield_stress[k];
      const auto expected = y >= greatest[i] ? AdhesionValidity::peak_failure
                            : y < least[i]   ? AdhesionValidity::yielding_failure
                                             : AdhesionValidity::valid;
      EXPECT_EQ(class_at(diagram, k, k), expected) << "delta_o = " << diagram.displacement << ", Y R0/dg = " << y;
      ++compared;
    }
  }
  EXPECT_EQ(compared, 5u * 26u);
}

TEST(AdhesionMap, HasTheFullDiagramsByDefault) {
  const auto diagrams = adhesion_maps({});
  ASSERT_EQ(diagrams.size(), 5u);
  std::size_t valid_before = std::numeric_limits<std::size_t>::max();
  for (const AdhesionDiagram& diagram : diagrams) {
    EXPECT_EQ(diagram.modulus.size(), 200u);
    EXPECT_EQ(diagram.yield_stress.size(), 200u);
    EXPECT_LE(relative_error(diagram.modulus.back() / diagram.modulus.front(), 1e8), 1e-13);
    EXPECT_LE(relative_error(diagram.yield_stress.back() / diagram.yield_stress.front(), 1e8), 1e-13);
    // The more it is flattened, the more rarely the convex indenter will do.
    const auto valid = static_cast<std::size_t>(std::ranges::count(diagram.classes, index_of(AdhesionValidity::valid)));
    EXPECT_LT(valid, valid_before) << "delta_o = " << diagram.displacement;
    valid_before = valid;
    const bool has_peaks =
        std::ranges::find(diagram.classes, index_of(AdhesionValidity::peak_failure)) != diagram.classes.end();
    EXPECT_EQ(has_peaks, diagram.displacement > 0.15) << "delta_o = " << diagram.displacement;
  }
}

TEST(AdhesionMap, FlattensAnyMaterial) {
  const auto rigid = flatten(1e6, 0.3, k_displacements);
  const auto more_rigid = flatten(1e12, 0.3, k_displacements);
  const auto almost = flatten(5e5, 0.3, k_displacements);
  for (std::size_t d = 0; d < k_displacements.size(); ++d) {
    EXPECT_EQ(flattened_indenter(more_rigid[d]).half_width, flattened_indenter(rigid[d]).half_width);
    EXPECT_LE(relative_error(flattened_indenter(more_rigid[d]).height * 1e6, flattened_indenter(rigid[d]).height),
              4 * k_epsilon);
    // The elastic strain at E/Y = 1e6 is as large as the change from 5e5 to there.
    EXPECT_LE(relative_error(almost[d].apparent_radius, rigid[d].apparent_radius), 1e-6);
    EXPECT_LE(relative_error(flattened_indenter(almost[d]).half_width, flattened_indenter(rigid[d]).half_width), 1e-6);
  }
  for (const FlattenedContact& soft : flatten(0.01, 0.3, k_displacements)) {
    EXPECT_FALSE(soft.has_yielded);
    EXPECT_EQ(flattened_indenter(soft).height, 4.0 * soft.apparent_radius);
    EXPECT_EQ(flattened_peak_radius(soft), 0.0);
  }
}

TEST(AdhesionMap, RefusesSettingsOutOfRange) {
  const std::vector<double> backwards{0.2, 0.1};
  const std::vector<double> none;
  const std::vector<double> zero{0.0, 0.1};
  EXPECT_THROW(static_cast<void>(flatten(20.0, 0.3, backwards)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(flatten(20.0, 0.3, none)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(flatten(20.0, 0.3, zero)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(flatten(0.0, 0.3, k_displacements)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(flatten(std::numeric_limits<double>::infinity(), 0.3, k_displacements)),
               std::invalid_argument);
  EXPECT_THROW(static_cast<void>(flatten(20.0, 0.51, k_displacements)), std::invalid_argument);
  const AdhesionMapSettings usual;
  const auto refuses = [&usual](auto&& change) {
    AdhesionMapSettings settings = usual;
    change(settings);
    EXPECT_THROW(static_cast<void>(adhesion_maps(settings)), std::invalid_argument);
  };
  refuses([](AdhesionMapSettings& s) { s.least_modulus = 0.0; });
  refuses([](AdhesionMapSettings& s) { s.least_yield_stress = -1.0; });
  refuses([](AdhesionMapSettings& s) { s.decades = std::nan(""); });
  refuses([](AdhesionMapSettings& s) { s.points = 1; });
  refuses([](AdhesionMapSettings& s) { s.displacements.clear(); });
  refuses([](AdhesionMapSettings& s) { s.poisson_ratio = -1.0; });
}

TEST(AdhesionMap, SaysWhichMaterialTheModelDoesNotReach) {
  // A wall that has passed the centre.
  const std::vector<double> too_far{0.5, 1.5};
  EXPECT_THROW(static_cast<void>(flatten(20.0, 0.3, too_far)), std::runtime_error);
}

}  // namespace
}  // namespace monograin::adhesion_map_test
