#include "nonlocal/limit.hpp"

#include <array>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "models/accuracy.hpp"
#include "models/nonlocal/cases.hpp"

namespace monograin::nonlocal::nonlocal_limit_test {
namespace {

using std::numbers::pi;

/// d/R of the first class at the limit, the other walls at first touch.
double limit_of(const Formulation& model, const std::vector<ContactClass>& classes, double longest = 0.9) {
  Contacts contacts(model, classes, Centre::fixed);
  std::vector<double> y(classes.size(), 0.0);
  const double displacement =
      longest * limit_of_step(contacts, compression(classes.size(), longest), 1.0, y).value_or(std::nan(""));
  EXPECT_NEAR(contacts.margin(y), 0.0, 1e-14);
  EXPECT_NEAR(states_of(contacts, y)[0].displacement, displacement, 1e-15);
  return displacement;
}

TEST(NonlocalLimit, IsThatOfThirtyDigits) {
  struct Row {
    std::vector<ContactClass> classes;
    std::array<double, 5> displacement;
    double last_digit;  // of those that are printed with fewer
  };
  for (const auto& [classes, displacement, last_digit] :
       {Row{die(), {0.39468111182905091, 0.44294493510301924, 0.45538108733201166, 0.45965445411161659, 0.46298916}, 0},
        Row{hydrostatic(),
            {0.15608197601797136, 0.17069892596057612, 0.17363220908537291, 0.1743952634626037, 0.17473615},
            0},
        Row{oblique_die(),
            {0.38361690423844441, 0.42805549400697784, 0.43901080782042684, 0.44264072116489067, 0.44529519},
            0},
        Row{oblique_die(37.5, 4), {0.367953129, 0.406690577, 0.415499795, 0.418232019, 0.42001749}, 5.1e-10}}) {
    for (std::size_t i = 0; i < 5; ++i) {
      const double found = limit_of({k_rubber, k_all_terms[i]}, classes);
      const double tolerance = i == 4 ? 5.1e-9 : std::max(last_digit, 1e-14);  // largest error found: 6e-16
      EXPECT_NEAR(found, displacement[i], tolerance) << classes.size() << " classes, " << i + 1 << " terms";
    }
  }
}

TEST(NonlocalLimit, HasAClosedFormForEqualContacts) {
  for (const double nu : {0.1, 0.3, 0.48, 0.5}) {
    for (const auto& classes : {simple(), hydrostatic()}) {
      for (const Terms terms : {Terms::one, Terms::two, Terms::three, Terms::four}) {
        Contacts contacts({nu, terms}, classes, Centre::fixed);
        const double compliance = contacts.coupling()(0, 0);
        const double radius = 1.0 / (2.0 * contacts.composite_modulus() * compliance);
        const LocalContact contact = contacts.law().at(radius * radius);
        const double displacement = contact.approach - compliance * contacts.composite_modulus() * contact.force;
        std::vector<double> y{0.0};
        const auto found = limit_of_step(contacts, compression(1, 2.0 * displacement), 1.0, y);
        ASSERT_TRUE(found.has_value());
        EXPECT_LE(relative_error(*found, 0.5), 1e-14);
        // At the limit the path turns back: its arc length has the round-off of the margin.
        EXPECT_LE(relative_error(std::sqrt(y[0]), radius), 1e-13);
      }
    }
  }
  Contacts contacts({k_rubber}, hydrostatic(), Centre::fixed);
  EXPECT_NEAR(1.0 / (2.0 * contacts.composite_modulus() * contacts.coupling()(0, 0)), 0.68428498, 5.1e-9);
  EXPECT_NEAR(limit_of({k_rubber, Terms::one}, simple()), 0.8550368544, 5.1e-11);
}

TEST(NonlocalLimit, DependsOnPoissonsRatio) {
  // Digits as printed.
  EXPECT_NEAR(limit_of({0.45, Terms::one}, die()), 0.45185, 5.1e-6);
  EXPECT_NEAR(limit_of({0.45, Terms::four}, die()), 0.54279, 5.1e-6);
  EXPECT_NEAR(limit_of({0.499, Terms::one}, die()), 0.36091, 5.1e-6);
  EXPECT_NEAR(limit_of({0.499, Terms::four}, die()), 0.41319, 5.1e-6);
}

TEST(NonlocalLimit, IsNotThereForAllTermsUnderSimpleCompression) {
  Contacts contacts({k_rubber, Terms::all}, simple(), Centre::fixed);
  std::vector<double> y{0.0};
  EXPECT_FALSE(limit_of_step(contacts, compression(1, 1.5), 1.0, y).has_value());
  EXPECT_LT(y[0], 1.0);
}

TEST(NonlocalLimit, IsNotThereBeforeIt) {
  Contacts contacts({k_rubber, Terms::four}, die(), Centre::fixed);
  std::vector<double> y{0.0, 0.0};
  EXPECT_FALSE(limit_of_step(contacts, compression(2, 0.4596), 1.0, y).has_value());
  EXPECT_NEAR(states_of(contacts, y)[0].displacement, 0.4596, 1e-14);
  y = {0.0, 0.0};
  EXPECT_FALSE(limit_of_step(contacts, compression(2, 0.9), 0.5, y).has_value());
  EXPECT_NEAR(states_of(contacts, y)[0].displacement, 0.45, 1e-14);
}

TEST(NonlocalLimit, IsTheSameUnderForceControl) {
  Contacts contacts({k_rubber, Terms::four}, die(), Centre::fixed);
  std::vector<double> at_limit{0.0, 0.0};
  ASSERT_TRUE(limit_of_step(contacts, compression(2, 0.9), 1.0, at_limit).has_value());
  const double force = states_of(contacts, at_limit)[0].force;
  auto ramps = compression(2, 2.0 * force);
  ramps[0].control = Control::force;
  std::vector<double> y{0.0, 0.0};
  const auto found = limit_of_step(contacts, ramps, 1.0, y);
  ASSERT_TRUE(found.has_value());
  // Under force control the force is a regular coordinate, and has the error of the margin.
  EXPECT_NEAR(*found, 0.5, 1e-13);
  EXPECT_NEAR(states_of(contacts, y)[0].displacement, 0.45965445411161659, 1e-14);
}

TEST(NonlocalLimit, CountsModesThatBreakTheSymmetry) {
  // Two pairs of close walls, which push each other away: one wall of a pair prevails before the symmetric mode turns
  // back.
  const double half = 8.0 * k_degree;
  const double c = std::cos(half);
  const double s = std::sin(half);
  const std::vector<ContactClass> pairs{
      {.name = "pairs", .normals = {{0.0, c, s}, {0.0, c, -s}, {0.0, -c, s}, {0.0, -c, -s}}}};
  const auto influence = [](double angle) { return half_space_influence(k_rubber, angle); };
  Contacts contacts({k_rubber, Terms::four}, pairs, Centre::fixed);
  const double winning = -influence(2.0 * half) + std::abs(influence(pi) - influence(pi - 2.0 * half));
  const double radius = 1.0 / (2.0 * contacts.composite_modulus() * winning);
  const LocalContact contact = contacts.law().at(radius * radius);
  const double displacement =
      contact.approach - contacts.coupling()(0, 0) * contacts.composite_modulus() * contact.force;
  EXPECT_LT(contacts.coupling()(0, 0), 0.0);  // all together never turn back

  EXPECT_NEAR(limit_of({k_rubber, Terms::four}, pairs), displacement, 1e-14);
  std::vector<double> y{0.0};
  solve(contacts, compression(1, displacement * (1.0 - 1e-9)), 1.0, y);
  EXPECT_GT(contacts.margin(y), 0.0);
  EXPECT_THROW(solve(contacts, compression(1, displacement * (1.0 + 1e-9)), 1.0, y), std::domain_error);
}

TEST(NonlocalLimit, IsTheSameForSingleWalls) {
  const auto classes = oblique_die(8.0);
  Contacts single({k_rubber, Terms::four}, single_walls(classes), Centre::free);
  std::vector<Ramp> ramps(8);
  ramps[0].end = ramps[1].end = 0.9;
  std::vector<double> y(single.unknown_count(), 0.0);
  const auto found = limit_of_step(single, ramps, 1.0, y);
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(0.9 * *found, limit_of({k_rubber, Terms::four}, classes), 1e-14);
}

TEST(NonlocalLimit, PivotHasTheSignOfTheMargin) {
  for (const auto& classes : {die(), oblique_die(), oblique_die(8.0)}) {
    Contacts contacts({k_rubber, Terms::four}, classes, Centre::fixed);
    std::vector<double> y(classes.size(), 0.0);
    EXPECT_EQ(contacts.least_pivot(y), 1.0);
    ASSERT_TRUE(limit_of_step(contacts, compression(classes.size(), 0.9), 1.0, y).has_value());
    EXPECT_NEAR(contacts.least_pivot(y), 0.0, 1e-13);
    for (double& s : y) s *= 0.999;
    EXPECT_GT(contacts.least_pivot(y), 0.0);
    for (double& s : y) s *= 1.003;
    EXPECT_LT(contacts.least_pivot(y), 0.0);
  }
}

// --- events

/// Root of a function of the state along a compression.
template <class Function>
double event_at(Contacts& contacts, double lower, double upper, const Function& guard) {
  std::vector<double> y(contacts.unknown_count(), 0.0);
  const auto value = [&](double displacement) {
    solve(contacts, compression(contacts.class_count(), displacement), 1.0, y);
    return guard(y);
  };
  std::uintmax_t iterations = 100;
  const auto [below, above] =
      boost::math::tools::toms748_solve(value, lower, upper, boost::math::tools::eps_tolerance<double>(), iterations);
  return 0.5 * (below + above);
}

TEST(NonlocalEvents, AreThoseOfThirtyDigits) {
  const Table table = reference("events");
  const auto word = [&](std::size_t row, std::string_view column) {
    return std::string(table.word(row, table.find(column).value()));
  };
  const auto terms = table.column("terms");
  const auto expected = table.column("gamma_over_2R");
  int compared = 0;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const std::string configuration = word(row, "configuration");
    const bool has_close_walls = contains(configuration, "8 deg");
    const auto classes = has_close_walls ? oblique_die(8.0) : wall_set(configuration);
    Contacts contacts({k_rubber, static_cast<Terms>(terms[row])}, classes, Centre::fixed);
    const std::string event = word(row, "event");
    ++compared;
    if (event == "limit") {
      EXPECT_NEAR(limit_of({k_rubber, static_cast<Terms>(terms[row])}, classes), expected[row], 1e-14);
      continue;
    }
    // All brackets lie below the limit, close to it where the event does.
    double upper = has_close_walls ? 0.45 : 0.0;
    if (!has_close_walls) {
      std::vector<double> y(classes.size(), 0.0);
      upper = 0.9 * limit_of_step(contacts, compression(classes.size(), 0.9), 1.0, y).value() - 1e-6;
    }
    if (event == "contact-lost") {
      EXPECT_NEAR(event_at(contacts, 0.1, upper, [](const auto& y) { return y[3]; }), expected[row], 1e-14);
      continue;
    }
    ASSERT_EQ(event, "impingement");
    const std::string rule_name = word(row, "rule");
    const RadiusRule rule = rule_name == "eq14"  ? RadiusRule::closed
                            : rule_name == "eq8" ? RadiusRule::integral
                                                 : RadiusRule::none;
    const std::string pair = word(row, "classes");
    const auto index_of = [&](const std::string& name) {
      return static_cast<std::size_t>(
          std::find_if(classes.begin(), classes.end(), [&](const auto& group) { return group.name == name; }) -
          classes.begin());
    };
    const std::size_t first = index_of(pair.substr(0, pair.find('/')));
    const std::size_t second = index_of(pair.substr(pair.find('/') + 1));
    const double angle = std::stod(word(row, "angle[deg]")) * k_degree;
    const double found = event_at(contacts, 0.01, upper, [&](const auto& y) {
      const auto states = states_of(contacts, y);
      const auto edge = [&](std::size_t i) {
        return edge_angle(contacts.deformed_radius(rule, i, y), states[i].displacement);
      };
      return angle - edge(first) - edge(second);
    });
    // Largest errors found: 5e-16, with eq. 8 2.5e-15.
    EXPECT_NEAR(found, expected[row], 1e-14) << configuration << ", " << pair << ", " << rule_name;
  }
  EXPECT_EQ(compared, 48);
}

TEST(NonlocalEvents, AreThoseOfThirtyDigitsWithGaps) {
  const Table table = reference("events_general");
  const auto expected = table.column("t");
  ASSERT_EQ(table.row_count(), 10u);
  const std::vector<ContactClass> classes{both_sides("z", Eigen::Vector3d::UnitZ()),
                                          both_sides("x", Eigen::Vector3d::UnitX()),
                                          both_sides("y", Eigen::Vector3d::UnitY())};
  Contacts contacts({k_rubber, Terms::four}, classes, Centre::fixed);
  const auto instant = [&](std::size_t index, double lower, double upper) {
    std::vector<double> y{0.0, -0.03, -0.05};
    const auto square_at = [&](double t) {
      const double axial = t < 1.0 ? 0.35 * t : std::lerp(0.35, -0.02, t - 1.0);
      solve(contacts, held(std::vector{axial, -0.03, -0.05}), 1.0, y);
      return y[index];
    };
    std::uintmax_t iterations = 100;
    const auto [below, above] = boost::math::tools::toms748_solve(
        square_at, lower, upper, boost::math::tools::eps_tolerance<double>(), iterations);
    return 0.5 * (below + above);
  };
  EXPECT_NEAR(instant(1, 0.1, 1.0), expected[0], 1e-14);
  EXPECT_NEAR(instant(2, 0.1, 1.0), expected[2], 1e-14);
  EXPECT_NEAR(instant(2, 1.0, 2.0), expected[4], 1e-14);
  EXPECT_NEAR(instant(1, 1.0, 2.0), expected[6], 1e-14);
  EXPECT_NEAR(instant(0, 1.0, 2.0), expected[8], 1e-14);
}

}  // namespace
}  // namespace monograin::nonlocal::nonlocal_limit_test
