// The equations of a coupled elastic-plastic particle: derivatives and symmetries in random states.

#include "cel/particle.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cel/motion.hpp"
#include "cel/newton.hpp"
#include "models/accuracy.hpp"
#include "models/cel/cases.hpp"
#include "support/deviation.hpp"

namespace monograin::cel::particle_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

using Generator = std::mt19937_64;
double uniform(Generator& generator, double from, double to) {
  return std::uniform_real_distribution(from, to)(generator);
}

/// Walls at angles that their influence allows; no class contains two opposite walls.
std::vector<ContactClass> single_walls(const std::vector<Vector3d>& normals) {
  std::vector<ContactClass> classes;
  for (const Vector3d& normal : normals)
    classes.push_back({.name = std::to_string(classes.size()), .normals = {normal.normalized()}});
  return classes;
}

std::vector<ContactClass> tetrahedron() { return single_walls({{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}); }
std::vector<ContactClass> oblique() {
  return single_walls({{0, 0, 1}, {0.1, 0, -1}, {1, 0.2, 0}, {-1, 0, 0.1}, {0.1, 1, 0.7}});
}
std::vector<ContactClass> die() {
  return {
      {.name = "axial", .normals = {Vector3d::UnitZ(), -Vector3d::UnitZ()}},
      {.name = "lateral", .normals = {Vector3d::UnitX(), -Vector3d::UnitX(), Vector3d::UnitY(), -Vector3d::UnitY()}}};
}

std::vector<Matrix3d> spreads_of(std::span<const ContactClass> classes) {
  std::vector<Matrix3d> spreads;
  for (const ContactClass& c : classes) {
    Matrix3d& sum = spreads.emplace_back(Matrix3d::Zero());
    for (const Vector3d& normal : c.normals) sum += normal * normal.transpose();
  }
  return spreads;
}

/// A core of unit determinant that walls could have produced: a polynomial of their load tensor.
Matrix3d random_core(Generator& generator, std::span<const ContactClass> classes) {
  Matrix3d C = Matrix3d::Identity();
  for (int n = 0; n < 2; ++n) {
    for (const Matrix3d& spread : spreads_of(classes)) {
      const Matrix3d product = C * spread;
      C += uniform(generator, -0.15, 0.15) * (product + product.transpose()) / spread.norm();
    }
  }
  return C / std::cbrt(C.determinant());
}

/// A material, walls, and a state that need not solve the equations: forces below the limits, dents, a deformed core, a
/// displaced centre.
struct RandomCase {
  double poisson_ratio;
  Material material;
  std::vector<ContactClass> classes;
  bool centre_is_free;
  Particle particle;
  Motion motion{};
  std::vector<double> y;

  RandomCase(Generator& generator, std::vector<ContactClass> walls, bool is_free)
      : poisson_ratio(uniform(generator, 0.0, 0.49)),
        material(1.0 / uniform(generator, 6.25, 200.0), poisson_ratio),
        classes(std::move(walls)),
        centre_is_free(is_free),
        particle(material, poisson_ratio, classes, is_free),
        y(particle.layout().size()) {
    const Layout& layout = particle.layout();
    for (std::size_t i = 0; i < classes.size(); ++i) {
      const double zeta = std::min(0.7, material.a_Y * uniform(generator, 1.02, 3.0));
      y[layout.dent(i)] = zeta;
      const Dent dent = dent_of(material, zeta);
      const double H = contact_at(material, dent, 1.0, 1.0, 0.0).H;
      y[i] = contact_by(material, dent, 1.0, 1.0, uniform(generator, 0.3, 1.0) * H, true).u;
    }
    for (std::size_t d = 0; d < layout.directions; ++d) y[layout.centre(d)] = uniform(generator, -0.02, 0.02);
    set_core(y, particle, classes, random_core(generator, classes), uniform(generator, 0.0, 0.4));
  }

  static void set_core(std::vector<double>& state, const Particle& of, std::span<const ContactClass> among,
                       const Matrix3d& C, double e) {
    std::size_t at = of.layout().core();
    for (const Matrix3d& shape : core_shapes(spreads_of(among)))
      state[at++] = contraction(shape, C - Matrix3d::Identity());
    state[at] = e;
  }

  [[nodiscard]] Matrix3d core_at(std::span<const double> state) const { return particle.core_of(state).C; }

  /// Ramps of all walls, and which dents grow.
  void drive(Generator& generator) {
    for (std::size_t i = 0; i < classes.size(); ++i) {
      ClassState& c = particle.classes[i];
      c.drive = contacts::WallDrive({0.0, uniform(generator, -1.0, 1.0), Control::displacement}, 1.0);
      c.flows = uniform(generator, 0.0, 1.0) < 0.6;
    }
  }

  std::vector<double> rates() {
    motion.evaluate(particle, 0.0, y);
    std::vector<double> dy(y.size());
    std::ranges::copy(motion.rates().first(particle.layout().core()), dy.begin());
    particle.write_core_rates(dy);
    return dy;
  }

  /// Largest rate of the state's unknowns, each over the magnitude over which the equations change with it.
  [[nodiscard]] double pace(const std::vector<double>& dy) const {
    double largest = 0.0;
    for (std::size_t j = 0; j < y.size(); ++j) {
      const double scale = j < 2 * classes.size() ? std::abs(y[j]) : 0.2;
      largest = std::max(largest, deviation(dy[j], 0.0) / scale);
    }
    return largest;
  }

  /// Slope of what a particle says of itself, along the rates. The error of the differences is of the pace.
  template <class Value>
  double slope_along(const std::vector<double>& dy, const Value& value) {
    const auto at = [&](double s) {
      std::vector<double> moved = y;
      for (std::size_t j = 0; j < y.size(); ++j) moved[j] += s * dy[j];
      particle.evaluate(moved);
      return value(particle, moved);
    };
    const double slope = central_difference(at, 0.0, 1e-3 / pace(dy));
    particle.evaluate(y);
    return slope;
  }
};

template <class Check>
void for_random_cases(const Check& check) {
  Generator generator(20260101);
  for (int n = 0; n < 40; ++n) {
    SCOPED_TRACE(::testing::Message() << "case " << n);
    const bool is_free = n % 2 == 0;
    RandomCase now(generator, n % 3 == 0 ? die() : n % 3 == 1 ? tetrahedron() : oblique(), is_free);
    now.drive(generator);
    check(now, generator);
  }
}

// --- rates

TEST(CelParticleRates, MoveTheWallsAsTheirProgramDoes) {
  for_random_cases([](RandomCase& now, Generator&) {
    const std::vector<double> dy = now.rates();
    for (std::size_t i = 0; i < now.classes.size(); ++i) {
      const double slope =
          now.slope_along(dy, [i](const Particle& p, std::span<const double>) { return p.classes[i].displacement; });
      EXPECT_NEAR(slope, now.particle.classes[i].drive.rate(), 1e-12 * now.pace(dy)) << "wall " << i;
    }
  });
}

TEST(CelParticleRates, KeepContactsThatFlowOnTheirYieldFunction) {
  int flowing = 0;
  for_random_cases([&](RandomCase& now, Generator&) {
    const std::vector<double> dy = now.rates();
    for (std::size_t i = 0; i < now.classes.size(); ++i) {
      const double slope =
          now.slope_along(dy, [i](const Particle& p, std::span<const double>) { return p.classes[i].yield.f; });
      now.rates();
      const double rate = now.motion.yield_rate(now.particle, i);
      EXPECT_NEAR(rate, slope, 4e-12 * now.pace(dy)) << "wall " << i;
      if (!now.particle.classes[i].flows) continue;
      ++flowing;
      EXPECT_NEAR(rate, 0.0, 1e-13 * now.pace(dy)) << "wall " << i;
    }
  });
  EXPECT_GE(flowing, 40);
}

TEST(CelParticleRates, MoveTheDentsThatFlowAndNoOthers) {
  for_random_cases([](RandomCase& now, Generator&) {
    const std::vector<double> dy = now.rates();
    for (std::size_t i = 0; i < now.classes.size(); ++i) {
      const bool flows = now.particle.classes[i].flows;
      EXPECT_EQ(dy[now.particle.layout().dent(i)] != 0.0, flows) << "wall " << i;
    }
  });
}

TEST(CelParticleRates, KeepTheVolumeOfTheCore) {
  for_random_cases([](RandomCase& now, Generator&) {
    const std::vector<double> dy = now.rates();
    const double slope =
        now.slope_along(dy, [&](const Particle&, std::span<const double> y) { return now.core_at(y).determinant(); });
    EXPECT_NEAR(slope, 0.0, 4e-12 * now.pace(dy));
  });
}

TEST(CelParticleRates, LetTheCoreFlowAsTheDentsThatDriveItGrow) {
  int flowing = 0;
  for_random_cases([&](RandomCase& now, Generator&) {
    const std::vector<double> dy = now.rates();
    const double Lam = now.particle.flow_rate(dy);
    const Matrix3d flow = now.particle.load().flow.C;
    const double strain = now.particle.load().flow.e;
    EXPECT_LE((now.core_at(dy) - Matrix3d::Identity() - Lam * flow).norm(), 1e-12 * (1.0 + std::abs(Lam)));
    EXPECT_NEAR(now.particle.core_of(dy).e, Lam * strain, 1e-12 * (1.0 + std::abs(Lam)));
    // The equivalent strain of the flow, by the logarithm of the metric: C' = -(L C + C L).
    const Matrix3d C = now.core_at(now.y);
    Eigen::Matrix<double, 9, 9> sylvester = Eigen::Matrix<double, 9, 9>::Zero();
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        for (int k = 0; k < 3; ++k) {
          sylvester(3 * a + b, 3 * k + b) -= C(a, k);
          sylvester(3 * a + b, 3 * a + k) -= C(k, b);
        }
    Eigen::Matrix<double, 9, 1> right;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) right[3 * a + b] = flow(a, b);
    const Eigen::Matrix<double, 9, 1> L = sylvester.fullPivLu().solve(right);
    EXPECT_NEAR(strain, std::sqrt(2.0 / 3.0) * L.norm(), 1e-12 * (1.0 + strain));
    if (Lam != 0.0) ++flowing;
  });
  EXPECT_GE(flowing, 20);
}

TEST(CelParticleRates, KeepTheBalanceOfAFreeCentre) {
  for_random_cases([](RandomCase& now, Generator&) {
    const std::vector<double> dy = now.rates();
    for (std::size_t d = 0; d < now.particle.layout().directions; ++d) {
      const auto row = static_cast<std::size_t>(now.particle.layout().centre(d));
      const double slope = now.slope_along(dy, [row](const Particle& p, std::span<const double>) {
        std::vector<double> residual(p.layout().core());
        p.residual(0.0, residual);
        return residual[row];
      });
      EXPECT_NEAR(slope, 0.0, 1e-12 * now.pace(dy)) << "direction " << d;
    }
  });
}

TEST(CelParticleRates, StoreAllWorkWhereNothingFlows) {
  for_random_cases([](RandomCase& now, Generator&) {
    if (now.centre_is_free) return;  // the state does not solve the balance, which the walls' work is by
    for (std::size_t i = 0; i < now.classes.size(); ++i) now.particle.classes[i].flows = false;
    const std::vector<double> dy = now.rates();
    const double slope =
        now.slope_along(dy, [](const Particle& p, std::span<const double>) { return p.stored_energy(); });
    now.rates();
    double work = 0.0;
    for (std::size_t i = 0; i < now.classes.size(); ++i)
      work += now.classes[i].multiplicity() * now.particle.classes[i].contact.F * now.particle.classes[i].drive.rate();
    EXPECT_NEAR(now.motion.power(), work, 1e-14 * (1.0 + std::abs(work)));
    EXPECT_NEAR(slope, work, 1e-12 * now.pace(dy));
  });
}

TEST(CelParticleRates, UnderPrescribedForcesAreThoseOfTheirDisplacements) {
  for_random_cases([](RandomCase& now, Generator&) {
    const std::vector<double> by_displacement = now.rates();
    // The first wall's force is prescribed, with the rate that its displacement gave it.
    ClassState& first = now.particle.classes[0];
    const double force = first.contact.F;
    const double displacement_rate = first.drive.rate();
    const double force_rate = now.slope_along(
        by_displacement, [](const Particle& p, std::span<const double>) { return p.classes[0].contact.F; });
    first.drive = contacts::WallDrive({force, force + force_rate, Control::force}, 1.0);
    now.y[0] = force;
    const std::vector<double> by_force = now.rates();
    EXPECT_NEAR(by_force[0], force_rate, 1e-12 * (1.0 + std::abs(force_rate)));
    for (std::size_t j = 1; j < by_force.size(); ++j) {
      const double scale = *std::ranges::max_element(by_displacement, {}, [](double v) { return std::abs(v); });
      EXPECT_NEAR(by_force[j], by_displacement[j], 1e-7 * (1.0 + std::abs(scale))) << "unknown " << j;
    }
    double work = force * displacement_rate * now.classes[0].multiplicity();
    for (std::size_t i = 1; i < now.classes.size(); ++i)
      work += now.classes[i].multiplicity() * now.particle.classes[i].contact.F * now.particle.classes[i].drive.rate();
    EXPECT_NEAR(now.motion.power(), work, 1e-8 * (1.0 + std::abs(work)));
  });
}

// --- symmetries

/// Values of the equations at a state, class by class.
struct Said {
  std::vector<double> overlap, f, force, driving;
  double coverage, stored;
};
Said said_by(Particle& particle, std::span<const double> y) {
  particle.evaluate(y);
  Said said{{}, {}, {}, {}, particle.coverage().Om, particle.stored_energy()};
  for (std::size_t i = 0; i < particle.size(); ++i) {
    said.overlap.push_back(particle.classes[i].displacement + particle.approach_by_centre(i));
    said.f.push_back(particle.classes[i].yield.f);
    said.force.push_back(particle.classes[i].contact.F);
    said.driving.push_back(1.0 - particle.classes[i].yield.b);
  }
  return said;
}

void expect_same(const Said& actual, const Said& expected, double tolerance) {
  for (std::size_t i = 0; i < expected.force.size(); ++i) {
    EXPECT_NEAR(actual.overlap[i], expected.overlap[i], tolerance) << i;
    EXPECT_NEAR(actual.f[i], expected.f[i], 10.0 * tolerance) << i;
    EXPECT_NEAR(actual.force[i], expected.force[i], tolerance) << i;
    EXPECT_NEAR(actual.driving[i], expected.driving[i], 100.0 * tolerance) << i;
  }
  EXPECT_NEAR(actual.coverage, expected.coverage, 10.0 * tolerance);
  EXPECT_NEAR(actual.stored, expected.stored, tolerance);
}

TEST(CelParticle, IsTheSameInAnyOrderOfItsWalls) {
  for_random_cases([](RandomCase& now, Generator& generator) {
    const Said expected = said_by(now.particle, now.y);
    const std::size_t n = now.classes.size();
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::shuffle(order, generator);
    std::vector<ContactClass> classes;
    for (const std::size_t i : order) classes.push_back(now.classes[i]);
    Particle other(now.material, now.poisson_ratio, classes, false);
    std::vector<double> y(other.layout().size());
    for (std::size_t i = 0; i < n; ++i) {
      y[i] = now.y[order[i]];
      y[other.layout().dent(i)] = now.y[now.particle.layout().dent(order[i])];
    }
    RandomCase::set_core(y, other, classes, now.core_at(now.y), now.particle.core_of(now.y).e);
    const Said shuffled = said_by(other, y);
    Said sorted = shuffled;
    for (std::size_t i = 0; i < n; ++i) {
      sorted.overlap[order[i]] = shuffled.overlap[i];
      sorted.f[order[i]] = shuffled.f[i];
      sorted.force[order[i]] = shuffled.force[i];
      sorted.driving[order[i]] = shuffled.driving[i];
    }
    expect_same(sorted, expected, 1e-13);
  });
}

TEST(CelParticle, IsTheSameInAnyOrientation) {
  for_random_cases([](RandomCase& now, Generator& generator) {
    const Said expected = said_by(now.particle, now.y);
    const Eigen::Quaterniond turn = Eigen::Quaterniond(uniform(generator, -1, 1), uniform(generator, -1, 1),
                                                       uniform(generator, -1, 1), uniform(generator, -1, 1))
                                        .normalized();
    RandomCase turned = now;
    for (ContactClass& c : turned.classes) {
      for (Vector3d& normal : c.normals) normal = turn * normal;
    }
    turned.particle = Particle(now.material, now.poisson_ratio, turned.classes, now.centre_is_free);
    const Matrix3d R = turn.toRotationMatrix();
    RandomCase::set_core(turned.y, turned.particle, turned.classes, R * now.core_at(now.y) * R.transpose(),
                         now.particle.core_of(now.y).e);
    expect_same(said_by(turned.particle, turned.y), expected, 1e-12);
  });
}

TEST(CelParticle, DoesNotFeelAWallThatNeverTouched) {
  for_random_cases([](RandomCase& now, Generator&) {
    if (now.classes.size() != 4) return;  // of the tetrahedron, with room between its walls
    const Said expected = said_by(now.particle, now.y);
    std::vector<ContactClass> classes = now.classes;
    classes.push_back({.name = "open", .normals = {Vector3d(-1, -1, -1).normalized()}});
    Particle other(now.material, now.poisson_ratio, classes, false);
    std::vector<double> y(other.layout().size());
    for (std::size_t i = 0; i < now.classes.size(); ++i) {
      y[i] = now.y[i];
      y[other.layout().dent(i)] = now.y[now.particle.layout().dent(i)];
    }
    y[4] = -0.1;
    y[other.layout().dent(4)] = now.material.a_Y;
    RandomCase::set_core(y, other, classes, now.core_at(now.y), now.particle.core_of(now.y).e);
    expect_same(said_by(other, y), expected, 1e-14);
  });
}

// --- solving

TEST(CelParticle, IsSolvedFromStatesNearby) {
  int solved = 0;
  for_random_cases([&](RandomCase& now, Generator& generator) {
    // Displacements of which the state is the solution.
    if (now.centre_is_free) return;
    now.particle.evaluate(now.y);
    for (ClassState& c : now.particle.classes) {
      c.flows = false;
      c.hold(c.displacement);
    }
    std::vector<double> y = now.y;
    for (std::size_t i = 0; i < now.classes.size(); ++i) y[i] *= uniform(generator, 0.9, 1.1);
    Newton().solve(now.particle, 0.0, y);
    for (std::size_t i = 0; i < now.classes.size(); ++i) EXPECT_LE(relative_error(y[i], now.y[i]), 1e-12) << i;
    ++solved;
  });
  EXPECT_EQ(solved, 20);
}

}  // namespace
}  // namespace monograin::cel::particle_test
