#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "mdr/contact.hpp"
#include "models/accuracy.hpp"
#include "models/mdr/grains.hpp"

namespace monograin::mdr::derivatives_test {
namespace {

/// Compares a derivative with differences of its function over a small share of the length over which the function
/// changes.
template <class Function>
void expect_derivative(double derivative, Function&& function, double x, double length) {
  constexpr double share = 5e-3;       // truncation below 1e-13
  constexpr double tolerance = 1e-12;  // rounding: some ten eps of the function over the share
  const double difference = central_difference(function, x, share * length);
  EXPECT_LE(std::abs(derivative - difference), tolerance * (std::abs(derivative) + std::abs(function(x)) / length))
      << "derivative = " << derivative << ", difference = " << difference << ", x = " << x;
}

constexpr double k_modulus = 1.3;

TEST(MdrDerivatives, OfTheElasticContactAreExact) {
  for (const auto profile : {ElasticProfile::ellipse, ElasticProfile::parabola}) {
    for (const double overlap : {1e-8, 1e-3, 0.1, 0.4, 0.9}) {
      for (const double radius : {1.0, 1.1}) {
        SCOPED_TRACE(::testing::Message() << "R = " << radius << ", delta = " << overlap);
        const Contact contact = elastic_contact(profile, k_modulus, radius, overlap);
        const auto force = [&](double R, double delta) { return elastic_contact(profile, k_modulus, R, delta).force; };
        expect_derivative(
            contact.by_overlap, [&](double x) { return force(radius, x); }, overlap, overlap);
        expect_derivative(
            contact.by_radius, [&](double x) { return force(x, overlap); }, radius, radius);
        expect_derivative(
            contact.force, [&](double x) { return elastic_energy(profile, k_modulus, radius, x); }, overlap, overlap);
      }
    }
  }
}

/// A dent, with the lengths of its largest overlap and radius over which its contact area vanishes.
struct ScaledDent : Dent {
  double area = std::pow(shape().contact_radius_max, 2);
  double overlap_length = area / (2.0 * grain.radius);
  double radius_length = area / (2.0 * overlap_max);

  explicit ScaledDent(const Dent& dent) : Dent(dent) {}
};

TEST(MdrDerivatives, OfThePlasticContactAreExact) {
  for (const Dent& each : dents()) {
    SCOPED_TRACE(each);
    const ScaledDent dent(each);
    const double R = dent.grain.radius;
    const double m = dent.overlap_max;
    const Contact contact = dent.plastic(R, m);
    expect_derivative(
        contact.by_overlap, [&](double x) { return dent.plastic(R, x).force; }, m, dent.overlap_length);
    expect_derivative(
        contact.by_radius, [&](double x) { return dent.plastic(x, m).force; }, R, dent.radius_length);
  }
}

TEST(MdrDerivatives, OfTheUnloadingShapeAreExact) {
  using S = UnloadingShape;
  for (const Dent& each : dents()) {
    SCOPED_TRACE(each);
    const ScaledDent dent(each);
    const double R = dent.grain.radius;
    const double m = dent.overlap_max;
    const auto expect_derivatives = [&](double S::*value, double by_max, double by_radius) {
      expect_derivative(
          by_max, [&](double x) { return dent.shape_of(R, x).*value; }, m, dent.overlap_length);
      expect_derivative(
          by_radius, [&](double x) { return dent.shape_of(x, m).*value; }, R, dent.radius_length);
    };
    const S shape = dent.shape();
    expect_derivatives(&S::pressure, shape.pressure * shape.log_pressure_by_max,
                       shape.pressure * shape.log_pressure_by_radius);
    expect_derivatives(&S::contact_radius_max, shape.contact_radius_max * shape.log_contact_radius_by_max,
                       shape.contact_radius_max * shape.log_contact_radius_by_radius);
    expect_derivatives(&S::rho, shape.rho_by_max, shape.rho_by_radius);
  }
}

TEST(MdrDerivatives, OfTheUnloadingContactAreExactAlsoAboveTheLargestOverlap) {
  for (const Dent& each : dents()) {
    const ScaledDent dent(each);
    const double R = dent.grain.radius;
    const double m = dent.overlap_max;
    const UnloadingShape shape = dent.shape();
    for (const double u : {-0.1, 0.0, 0.3, 0.8}) {
      SCOPED_TRACE(::testing::Message() << dent << ", u = " << u);
      const double overlap = dent.overlap_at(u);
      const Contact contact = dent.unloading(R, m, overlap);
      const double to_opening = (1.0 - u) * shape.recovery;
      expect_derivative(
          contact.by_overlap, [&](double x) { return dent.unloading(R, m, x).force; }, overlap, to_opening);
      expect_derivative(
          contact.by_overlap_max, [&](double x) { return dent.unloading(R, x, overlap).force; }, m,
          std::min(to_opening, dent.overlap_length));
      expect_derivative(
          contact.by_radius, [&](double x) { return dent.unloading(x, m, overlap).force; }, R,
          (1.0 - u) * dent.radius_length);
      expect_derivative(
          contact.force, [&](double x) { return unloading_energy(shape, x); }, overlap, to_opening);
    }
  }
}

}  // namespace
}  // namespace monograin::mdr::derivatives_test
