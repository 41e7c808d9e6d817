// Fits of the compressible law: the stored curves, exact ones, noise, unloadings.

#include "compressible/curve_fit.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "history/table.hpp"
#include "models/accuracy.hpp"
#include "support/text_file.hpp"

namespace monograin::compressible::curve_fit_test {
namespace {

struct Data {
  std::vector<double> d, f;
  std::string header;
};

Data reference(const std::string& file, const char* line) {
  const Table table = read_csv(MONOGRAIN_SOURCE_DIR "/" + file + ".csv");
  return {table.column("delta_over_R0"), table.column("F_over_pi_R0^2_sigma_y0"),
          std::string(table.header_value(line))};
}

double number_in(const std::string& text, const std::string& name) {
  return std::stod(text.substr(text.find(name + "=") + name.size() + 1));
}

class StoredFit : public ::testing::TestWithParam<const char*> {};

TEST_P(StoredFit, IsNotMissedByEitherProcedure) {
  const std::string file = std::string("plots/fe/compressible_") + GetParam();
  const Data data = reference(file, "fit_nested");
  const Data joint_data = reference(file, "fit_joint_least_squares");
  const auto nested = fit_nested(data.d, data.f);
  ASSERT_TRUE(nested);
  const LoadingFit joint = fit_jointly(data.d, data.f, *nested);
  const auto compare = [](const char* name, const LoadingFit& fit, const std::string& stored) {
    fmt::print("{}: k = {:.8f} delta_t = {:.6f} a = {:.8f} e_a = {:.8f} e_p = {:.8f}; stored {}\n", name,
               fit.law.stiffness, fit.law.transition, fit.law.exponent, fit.errors.area, fit.errors.peak, stored);
    EXPECT_LE(fit.errors.area, number_in(stored, "area_error") + 1e-6);
    EXPECT_NEAR(fit.law.transition, number_in(stored, "delta_t"), 2e-3);
  };
  compare("nested", *nested, data.header);
  compare("joint", joint, joint_data.header);
  EXPECT_LE(joint.errors.area, nested->errors.area);
  // The figure that shows this fit has its numbers.
  const std::string text = read_text(MONOGRAIN_SOURCE_DIR "/plots/compressible-12-fits.toml");
  for (const char* key : {"k", "delta_t", "a"}) {
    const std::string words = " " + joint_data.header + " ";
    const std::size_t begin = words.find(std::string(" ") + key + "=") + 1;
    const std::string setting = "compressible." + words.substr(begin, words.find(' ', begin) - begin);
    EXPECT_NE(text.find(setting), std::string::npos) << setting;
  }
}

INSTANTIATE_TEST_SUITE_P(Compressible, StoredFit,
                         ::testing::Values("E100_G1_L0.01", "E12_G0.5_L1", "E4.5_G1_L0.01", "E500_G0.25_L1"),
                         [](const auto& name) {
                           std::string words = name.param;
                           std::ranges::replace(words, '.', 'p');
                           return words;
                         });

TEST(CompressibleFit, RecoversAnExactCurve) {
  const Data data = reference("tests/models/compressible/reference/fit_synthetic_exact", "parameters");
  const auto nested = fit_nested(data.d, data.f);
  ASSERT_TRUE(nested);
  const LoadingFit joint = fit_jointly(data.d, data.f, *nested);
  for (const LoadingFit& fit : {*nested, joint}) {
    EXPECT_LT(relative_error(fit.law.stiffness, 3.9), 1e-8);
    EXPECT_LT(relative_error(fit.law.transition, 0.113), 1e-7);
    EXPECT_LT(relative_error(fit.law.exponent, 3.65), 1e-7);
    EXPECT_LT(fit.errors.area, 1e-8);
  }
}

TEST(CompressibleFit, FindsTheLawBehindNoiseWhateverItsNumbers) {
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::normal_distribution<double> noise(0.0, 1e-3);
  for (int i = 0; i < 40; ++i) {
    const LoadingLaw law{0.5 + 5.0 * share(generator), 0.06 + 0.25 * share(generator), 1.0 + 4.0 * share(generator)};
    std::vector<double> d, f;
    for (int k = 0; k <= 100; ++k) {
      d.push_back(0.005 * k);
      f.push_back(loading_force(law, d.back()) + noise(generator) * loading_force(law, 0.5));
    }
    const auto nested = fit_nested(d, f);
    ASSERT_TRUE(nested);
    const LoadingFit joint = fit_jointly(d, f, *nested);
    const double own = fit_errors(law, d, f).area;
    EXPECT_LE(joint.errors.area, own * (1.0 + 1e-9)) << i << ": the law itself fits better";
    EXPECT_LE(joint.errors.area, nested->errors.area * (1.0 + 1e-9)) << i;
  }
}

TEST(CompressibleFit, MeasuresErrorsByTheTrapezoidalRule) {
  // A straight line with a uniform error r: e_a = 2 r/sqrt(3 d_max), e_p = r.
  std::vector<double> d, f;
  for (int k = 0; k <= 1000; ++k) {
    d.push_back(0.0005 * k);
    f.push_back(2.0 * d.back());
  }
  const FitErrors errors = fit_errors({2.2, 0.5, 1.0}, d, f);
  EXPECT_NEAR(errors.area, 0.2 / std::sqrt(1.5), 1e-6);
  EXPECT_NEAR(errors.peak, 0.1, 1e-14);
  // A fit below the data counts like one above: the absolute value was added.
  EXPECT_NEAR(fit_errors({1.8, 0.5, 1.0}, d, f).peak, 0.1, 1e-14);
}

TEST(CompressibleFit, IsNoneForTooFewPoints) {
  const std::vector<double> d{0.0, 0.1, 0.2};
  const std::vector<double> f{0.0, 0.2, 0.4};
  EXPECT_FALSE(fit_nested(d, f));
  EXPECT_FALSE(fit_nested(std::vector{0.0, 0.1, 0.2, 0.3}, std::vector{0.0, 0.0, 0.0, 0.0}));
}

TEST(CompressibleUnloadingFit, RecoversAnExactUnloading) {
  const LoadingLaw law{3.9, 0.113, 3.65};
  const double hertz = 46.6;
  for (const UnloadingShape& shape : {UnloadingShape{1.3, 1.6}, UnloadingShape{1.5, 1.0}, UnloadingShape{2.2, 5.0}}) {
    const UnloadingCurve curve = unloading_from(law, hertz, UnloadingRule(shape), 0.4);
    std::vector<double> d, f;
    for (int k = 0; k <= 60; ++k) {
      d.push_back(0.4 - curve.length * 1.1 * k / 60);
      f.push_back(d.back() > curve.separation() ? unloading_force(curve, d.back()) : 0.0);
    }
    const auto fit = fit_unloading(d, f, hertz);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->shape.exponent, shape.exponent, 1e-5);
    EXPECT_NEAR(fit->separation, curve.separation(), 1e-6);
    EXPECT_NEAR(fit->shape.stiffness_ratio, shape.stiffness_ratio, 1e-4);
  }
}

TEST(CompressibleUnloadingFit, CountsPointsBelowTheReversalFromAFiftiethOfItsForceOn) {
  const std::vector<double> d{0.4, 0.39, 0.38};
  EXPECT_TRUE(fit_unloading(d, std::vector{1.0, 0.5, 0.021}, 46.6));
  EXPECT_FALSE(fit_unloading(d, std::vector{1.0, 0.5, 0.019}, 46.6)) << "two points are too few";
  const auto fit = fit_unloading(d, std::vector{1.0, 0.5, 0.1}, 46.6);
  const auto overshot = fit_unloading(std::vector{0.4, 0.401, 0.39, 0.38}, std::vector{1.0, 0.7, 0.5, 0.1}, 46.6);
  ASSERT_TRUE(fit && overshot);
  EXPECT_EQ(overshot->shape.exponent, fit->shape.exponent);
  EXPECT_EQ(overshot->separation, fit->separation);
}

}  // namespace
}  // namespace monograin::compressible::curve_fit_test
