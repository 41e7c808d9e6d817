// Runs against an independent implementation: the printed formulas in long double, differentiated by a complex step,
// integrated by an explicit method of eighth order with fixed steps.

#include <gtest/gtest.h>

#include <array>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <cmath>
#include <complex>
#include <iostream>
#include <vector>

#include "models/material-point/cases.hpp"
#include "support/deviation.hpp"

namespace monograin::material_point::independent_test {
namespace {

using Real = long double;
using Complex = std::complex<Real>;
using State = std::array<Real, 2>;  // phi, g^p

constexpr Real k_step = 1e-40L;  // of the complex step

/// Equations 3 to 5 and Table 3.
template <class T>
struct Law {
  T E, nu, K, G, yield, shear, tensile, eps, centre;
  Law(const Parameters& m, T phi) {
    using std::exp;
    const bool densifies = m.model != YieldModel::vm;
    const T x = densifies ? T(Real(m.relative_density)) * exp(phi) - Real(m.reference_density) : phi;
    yield = exp(Real(m.eta) * x);
    E = Real(m.stiffness_ratio) * exp(Real(m.xi) * x);
    shear = Real(m.shear_ratio) * exp(Real(densifies ? m.zeta : m.eta) * x);
    tensile = Real(m.tensile_ratio) * exp(Real(m.omega) * x);
    nu = Real(m.nu0) + Real(m.xi1) * x;
    eps = Real(m.eps0) + Real(m.xi2) * x;
    K = E / (Real(3) * (Real(1) - Real(2) * nu));
    G = E / (Real(2) * (Real(1) + nu));
    centre = yield - eps * shear;
  }
};

enum class Piece { tension, shear, arc, cap };

/// Yield function and potential of Table 2; `q` has the sign of `side`.
template <class T>
T f_of(const Parameters& m, Piece piece, Real side, T p, T s, T phi, bool is_potential) {
  using std::sqrt;
  const Law<T> at(m, phi);
  const T y = p + at.centre;
  const T q = side * s;
  if (m.model == YieldModel::dpc) {
    const T tangent = at.shear / (at.tensile + at.centre);
    const T cosine = Real(1) / sqrt(Real(1) + tangent * tangent);
    const Real width = m.transition_width;
    const T a = width / cosine;
    const T b = Real(1) / (Real(1) + width - a);
    if (piece == Piece::cap) return sqrt(y * y + b * b * at.eps * at.eps * q * q) - at.eps * at.shear;
    if (is_potential) return sqrt(y * y * tangent * tangent + b * b * q * q) - at.shear;
    if (piece == Piece::arc) {
      const T w = q - (Real(1) - a) * at.shear;
      return sqrt(y * y + w * w) - width * at.shear;
    }
    return q + p * tangent - at.tensile * tangent;
  }
  const T c = q / at.shear;
  if (piece == Piece::tension) return p / at.tensile * (p / at.tensile) + c * c - Real(1);
  if (piece == Piece::cap) {
    const T e = y / (at.yield - at.centre);
    return e * e + c * c - Real(1);
  }
  return c * c - Real(1);
}

class Marcher {
 public:
  explicit Marcher(const Parameters& m) : m_(m) {}

  /// Integrates along a straight part of the strain path.
  void go(Real axial, Real lateral, int steps) {
    from_ = to_;
    to_ = {axial, lateral};
    x_ = 0;
    if (!is_plastic_ || loading() <= 0) {
      is_plastic_ = false;
      if (!find_yield()) return;
    }
    boost::numeric::odeint::runge_kutta_fehlberg78<State, Real> stepper;
    const auto rates = [this](const State& y, State& dy, Real x) { flow(y, dy, x); };
    const Real h = (1 - x_) / steps;
    while (x_ < 1 - 1e-17L) {
      const auto reached = [&](Real size) {
        State next = y_;
        stepper.do_step(rates, next, x_, size);
        return next;
      };
      Real size = std::min(h, 1 - x_);
      if (piece_at(reached(size), x_ + size) != piece_) {  // to just beyond the end of the piece
        Real inside = 0;
        for (int i = 0; i < 70; ++i) {
          const Real middle = (inside + size) / 2;
          (piece_at(reached(middle), x_ + middle) == piece_ ? inside : size) = middle;
        }
      }
      y_ = reached(size);
      x_ += size;
      piece_ = piece_at(y_, x_);
    }
  }

  [[nodiscard]] Real phi() const { return y_[0]; }
  [[nodiscard]] Real plastic_deviator() const { return y_[1]; }
  [[nodiscard]] std::array<Real, 2> stress() const { return stress_at(y_, 1); }
  [[nodiscard]] Real yield() const {
    const auto [p, s] = stress();
    return f_of<Real>(m_, piece_, s < 0 ? -1 : 1, p, s, y_[0], false);
  }

 private:
  [[nodiscard]] std::array<Real, 2> stress_at(const State& y, Real x) const {
    const Law<Real> at(m_, y[0]);
    const Real a = from_[0] + x * (to_[0] - from_[0]);
    const Real l = from_[1] + x * (to_[1] - from_[1]);
    const Real swelling = m_.model == YieldModel::vm ? 0 : -y[0];
    return {at.K * (a + 2 * l - swelling), 3 * at.G * ((a - l) * 2 / 3 - y[1])};
  }

  [[nodiscard]] Piece piece_at(const State& y, Real x) const {
    if (m_.model == YieldModel::vm) return Piece::shear;
    const Law<Real> at(m_, y[0]);
    const Real p = stress_at(y, x)[0];
    if (p < -at.centre) return Piece::cap;
    if (m_.model == YieldModel::vmdc) return p > 0 ? Piece::tension : Piece::shear;
    const Real tangent = at.shear / (at.tensile + at.centre);
    const Real sine = tangent / std::sqrt(1 + tangent * tangent);
    return p > -(at.centre - Real(m_.transition_width) * at.shear * sine) ? Piece::shear : Piece::arc;
  }

  struct Slopes {
    Real f_p, f_s, f_phi, Psi_p, Psi_s, p, s, N, D;
  };
  [[nodiscard]] Slopes slopes(const State& y, Real x) const {
    const auto [p, s] = stress_at(y, x);
    const Real side = s < 0 ? -1 : 1;
    const auto by = [&](int which, bool is_potential) {
      const Complex i(0, k_step);
      return f_of<Complex>(m_, piece_, side, Complex(p) + (which == 0 ? i : Complex(0)),
                           Complex(s) + (which == 1 ? i : Complex(0)), Complex(y[0]) + (which == 2 ? i : Complex(0)),
                           is_potential)
                 .imag() /
             k_step;
    };
    Slopes now{by(0, false), by(1, false), by(2, false), by(0, true), by(1, true), p, s, 0, 0};
    const Law<Complex> moved(m_, Complex(y[0], k_step));
    const Law<Real> at(m_, y[0]);
    const Real K1 = moved.K.imag() / k_step;
    const Real G1 = moved.G.imag() / k_step;
    const Real volumetric = to_[0] - from_[0] + 2 * (to_[1] - from_[1]);
    const Real deviatoric = (to_[0] - from_[0] - (to_[1] - from_[1])) * 2 / 3;
    now.N = now.f_p * at.K * volumetric + 3 * at.G * now.f_s * deviatoric;
    const Real coupling = now.f_phi + now.f_p * p * K1 / at.K + now.f_s * s * G1 / at.G;
    now.D = m_.model == YieldModel::vm
                ? 3 * at.G * now.f_s * now.Psi_s - std::abs(now.Psi_s) * coupling
                : at.K * now.f_p * now.Psi_p + 3 * at.G * now.f_s * now.Psi_s + now.Psi_p * coupling;
    return now;
  }

  void flow(const State& y, State& dy, Real x) const {
    const Slopes now = slopes(y, x);
    const Real multiplier = now.N / now.D;
    dy[0] = multiplier * (m_.model == YieldModel::vm ? std::abs(now.Psi_s) : -now.Psi_p);
    dy[1] = multiplier * now.Psi_s;
  }

  [[nodiscard]] Real loading() const { return slopes(y_, 0).N; }

  /// Finds the yield point on the elastic part of the path by bisection.
  bool find_yield() {
    const auto yields = [this](Real x) {
      const auto [p, s] = stress_at(y_, x);
      const Piece piece = piece_at(y_, x);
      const Real side = s < 0 ? -1 : 1;
      const Law<Real> at(m_, y_[0]);
      if (piece == Piece::arc && std::abs(s) < at.shear / 2) return false;
      return f_of<Real>(m_, piece, side, p, s, y_[0], false) > 0;
    };
    // The search starts inside: a point on the surface that unloads may be outside by round-off.
    Real inside = 1e-9L;
    Real outside = 1;
    if (!yields(1)) return false;
    for (int i = 0; i < 80; ++i) {
      const Real middle = (inside + outside) / 2;
      (yields(middle) ? outside : inside) = middle;
    }
    x_ = outside;
    is_plastic_ = true;
    piece_ = piece_at(y_, x_);
    return true;
  }

  Parameters m_;
  State y_{0, 0};
  std::array<Real, 2> from_{0, 0}, to_{0, 0};
  Real x_ = 0;
  bool is_plastic_ = false;
  Piece piece_ = Piece::shear;
};

struct Case {
  const char* name;
  Parameters parameters;
  std::vector<std::array<double, 2>> corners;  ///< axial and lateral strain
};

/// Materials and paths that no reference file has.
std::vector<Case> cases() {
  Parameters fujicalin = base_case();
  fujicalin.stiffness_ratio = 36.0;
  fujicalin.tensile_ratio = 0.0759;
  fujicalin.shear_ratio = 0.944;
  fujicalin.xi2 = 1.0222;
  fujicalin.eps0 = 0.645;
  fujicalin.eta = 8.25;
  fujicalin.xi = 9.92;
  fujicalin.omega = 5.91;
  fujicalin.zeta = 4.86;
  fujicalin.xi1 = 0.362;
  fujicalin.nu0 = 0.147;
  fujicalin.reference_density = 0.4;
  fujicalin.relative_density = 0.55;
  Parameters as_drucker_prager = fujicalin;
  as_drucker_prager.model = YieldModel::dpc;
  as_drucker_prager.transition_width = 0.02;
  Parameters with_corner = as_drucker_prager;
  with_corner.transition_width = 0.0;
  Parameters mises = von_mises(2.0);
  mises.xi = 1.5;
  mises.xi1 = 0.2;
  return {
      {"VmdcDieAndBack", fujicalin, {{{-0.2, 0.0}}, {{-0.185, 0.0}}, {{-0.3, 0.0}}}},
      {"VmdcTriaxialExtension", fujicalin, {{{0.03, -0.05}}, {{-0.05, 0.01}}}},
      {"VmdcSoftMaterial", base_case(12.0, 0.5, 0.3), {{{-0.15, 0.01}}, {{0.05, 0.02}}}},
      {"DpcDieAndBack", as_drucker_prager, {{{-0.2, 0.0}}, {{-0.19, 0.0}}, {{-0.25, 0.0}}}},
      {"DpcShearAndDilation", as_drucker_prager, {{{-0.05, 0.03}}, {{-0.08, 0.02}}}},
      {"DpcSharpCorner", with_corner, {{{-0.02, 0.012}}, {{-0.15, 0.0}}}},
      {"VmWithGrowingModuli", mises, {{{-0.1, 0.04}}, {{0.05, -0.02}}}},
  };
}

class Independent : public ::testing::TestWithParam<Case> {};

TEST_P(Independent, RunAgrees) {
  const Case& c = GetParam();
  Marcher marcher(c.parameters);
  Marcher coarse(c.parameters);
  std::vector<Step> steps;
  for (const auto& [axial, lateral] : c.corners) {
    steps.push_back(strains(axial, lateral));
    marcher.go(axial, lateral, 2000);
    coarse.go(axial, lateral, 1000);
  }
  const double own_error = static_cast<double>(std::abs(marcher.phi() - coarse.phi()) +
                                               std::abs(marcher.plastic_deviator() - coarse.plastic_deviator()));
  ASSERT_LT(own_error, 1e-12) << "the marching itself";
  const auto [p, s] = marcher.stress();
  const CheckedScenario scenario = point(c.parameters, Configuration::strain_path, steps);
  for (const char* integrator : k_integrators) {
    if (!is_offered(integrator, scenario)) continue;
    for (const auto& [rtol, bound] : {std::pair(1e-8, 1e-7), std::pair(1e-11, 2e-10)}) {
      const TestRun actual = run(scenario, integrator, relative(rtol));
      ASSERT_EQ(actual.record.status, RunStatus::complete) << integrator << ": " << actual.record.message;
      const double strain_scale = 0.1;
      const double strain_error = std::max(std::abs(actual.last("phi") - static_cast<double>(marcher.phi())),
                                           std::abs(actual.last("plastic_strain_deviatoric") -
                                                    static_cast<double>(marcher.plastic_deviator()))) /
                                  strain_scale;
      const double stress_scale = std::max(largest(actual.column("p")), largest(actual.column("s")));
      const double stress_error = std::max(std::abs(actual.last("p") - static_cast<double>(p)),
                                           std::abs(actual.last("s") - static_cast<double>(s))) /
                                  stress_scale;
      std::cout << c.name << ", " << integrator << ", rtol " << rtol << ": strains " << strain_error << ", stresses "
                << stress_error << '\n';
      EXPECT_LT(strain_error, integrator == std::string_view("direct") ? 1e-13 : bound) << integrator;
      EXPECT_LT(stress_error, integrator == std::string_view("direct") ? 1e-12 : 10.0 * bound) << integrator;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Paths, Independent, ::testing::ValuesIn(cases()),
                         [](const auto& path) { return std::string(path.param.name); });

// --- closed forms

/// Rows in a regime whose name begins with "plastic".
std::vector<std::size_t> plastic_rows(const TestRun& run) {
  std::vector<std::size_t> rows;
  const Table& table = run.record.history;
  for (std::size_t i = 0; i < table.row_count(); ++i) {
    if (table.word(i, *table.find("regime")).starts_with("plastic")) rows.push_back(i);
  }
  EXPECT_FALSE(rows.empty());
  return rows;
}

TEST(ClosedForm, HydrostaticCompressionAndTension) {
  for (Parameters m : {base_case(20.0, 0.8, 0.05), lactose(0.03)}) {
    for (const double target : {-0.09, 0.03}) {
      const CheckedScenario scenario = point(m, Configuration::hydrostatic, {strain(target)});
      const TestRun actual = run(scenario, "direct");
      ASSERT_EQ(actual.record.status, RunStatus::complete) << actual.record.message;
      const auto rows = plastic_rows(actual);
      ASSERT_GT(rows.size(), 10u);
      double worst = 0.0;
      for (const std::size_t i : rows) {
        const double phi = actual.column("phi")[i];
        const Properties at = properties_at(m, phi);
        const double p = target < 0.0 ? -at.yield_pressure.value : at.tensile_strength.value;
        worst = std::max(worst, deviation(actual.column("p")[i] / p, 1.0));
        const double volumetric = p / at.bulk_modulus.value - phi;
        worst = std::max(worst, deviation(3.0 * actual.column("strain_axial")[i] / volumetric, 1.0));
      }
      EXPECT_LT(worst, 1e-12);
      const Properties start = properties_at(m, 0.0);
      const double yield = target < 0.0 ? -start.yield_pressure.value : start.tensile_strength.value;
      EXPECT_NEAR(actual.time_of("yield"), yield / start.bulk_modulus.value / 3.0 / target, 1e-14);
    }
  }
}

TEST(ClosedForm, UniaxialStressOfVonMises) {
  Parameters m = von_mises(2.5);
  const TestRun actual = run(point(m, Configuration::simple, {strain(-0.15)}), "direct");
  for (const std::size_t i : plastic_rows(actual)) {
    const double phi = actual.column("phi")[i];
    const double strength = m.shear_ratio * std::exp(m.eta * phi);
    EXPECT_NEAR(actual.column("stress_axial")[i], -strength, 1e-13);
    EXPECT_NEAR(actual.column("strain_axial")[i], -strength / m.stiffness_ratio - phi, 1e-14);
  }
}

// Where Gamma <= 3 pi3, a bar of the double cap yields on the shear segment and stays there.
TEST(ClosedForm, UniaxialStressOnTheShearSegmentIsPerfectlyPlastic) {
  const Parameters m = base_case(100.0, 0.5, 0.01);
  const CheckedScenario scenario = point(m, Configuration::simple, {strain(-0.1)});
  for (const char* integrator : {"cvode-adams", "cvode-bdf", "ida"}) {
    const TestRun actual = run(scenario, integrator);
    EXPECT_NEAR(actual.time_of("yield"), 0.5 / 100.0 / 0.1, 1e-14);
    EXPECT_NEAR(actual.last("stress_axial"), -0.5, 1e-12) << integrator;
    EXPECT_LT(std::abs(actual.last("phi")), 1e-30) << "ida's linear algebra leaves that much";
    EXPECT_EQ(actual.events(), (std::vector<std::string>{"yield"}));
  }
}

TEST(ClosedForm, FirstYieldOfTheBaseCase) {
  const TestRun die = run(point(base_case(), Configuration::die, {strain(-0.02)}), "ida");
  EXPECT_NEAR(die.at_event("yield", "strain_axial"), -9.401459688064995e-3, 1e-16);
  EXPECT_NEAR(die.at_event("yield", "p"), -0.7834549740054, 1e-13);
  EXPECT_NEAR(die.at_event("yield", "s"), -0.7231892067742, 1e-13);
  const TestRun bar = run(point(base_case(), Configuration::simple, {strain(-0.02)}), "ida");
  EXPECT_NEAR(bar.at_event("yield", "stress_axial"), -0.99889061438090, 1e-13);
}

/// g^p of compression at constant lateral stress c. The stress is a function of the position b = (p + pi3)/A on the
/// cap, and g^p is the integral of Psi_s/Psi_p over phi, taken over ln(-b), in which it has no singularity at the
/// critical state.
double plastic_deviator_to(const Parameters& m, double c, double b_start, double b_end, double first_guess) {
  const auto phi_at = [&](double b) {
    double phi = first_guess;
    for (int i = 0; i < 60; ++i) {
      const auto miss = [&](double x) {
        const Properties at = properties_at(m, x);
        const double axis = at.axis_ratio.value * at.shear_strength.value;
        return -at.cap_centre.value + axis * b - c + at.shear_strength.value * std::sqrt(1.0 - b * b) / 3.0;
      };
      const double h = 1e-7;
      const double step = miss(phi) / ((miss(phi + h) - miss(phi - h)) / (2.0 * h));
      phi -= step;
      if (std::abs(step) < 1e-15) break;
    }
    return phi;
  };
  const auto integrand = [&](double log_b) {
    const double b = -std::exp(log_b);
    const double h = 1e-5;
    // d(phi)/d(ln(-b)) by a formula of fourth order.
    const auto at_log = [&](double x) { return phi_at(-std::exp(x)); };
    const double slope =
        (8.0 * (at_log(log_b + h) - at_log(log_b - h)) - (at_log(log_b + 2 * h) - at_log(log_b - 2 * h))) / (12.0 * h);
    const Properties at = properties_at(m, phi_at(b));
    const double strength = at.shear_strength.value;
    const double axis = at.axis_ratio.value * strength;
    const double s = -strength * std::sqrt(1.0 - b * b);
    // Psi_s/Psi_p = (2 s/Gamma^2)/(2 b/A), and d(phi) = -Psi_p dl.
    return -(s / (strength * strength)) * (axis / b) * slope;
  };
  return boost::math::quadrature::gauss_kronrod<double, 31>::integrate(integrand, std::log(-b_start), std::log(-b_end),
                                                                       6, 1e-12);
}

TEST(ClosedForm, CompressionAtConstantLateralStress) {
  struct Row {
    Parameters parameters;
    double lateral;
    double axial;
  };
  for (const Row& row : {Row{base_case(), 0.0, -0.2}, Row{base_case(60.0, 1.1, 0.05), -0.4, -0.15},
                         Row{base_case(300.0, 0.9, 0.02), -0.7, -0.2}}) {
    const Parameters& m = row.parameters;
    std::vector<Step> steps;
    if (row.lateral != 0.0) steps.push_back(stresses(row.lateral, row.lateral));
    steps.push_back(strain(row.axial));
    const auto configuration = row.lateral == 0.0 ? Configuration::simple : Configuration::triaxial;
    const TestRun actual = run(point(m, configuration, steps), "ida", relative(1e-11));
    ASSERT_EQ(actual.record.status, RunStatus::complete) << actual.record.message;
    const auto place = [&](double p, double phi) {
      const Properties at = properties_at(m, phi);
      return (p + at.cap_centre.value) / (at.axis_ratio.value * at.shear_strength.value);
    };
    const double phi = actual.last("phi");
    const double p = actual.last("p");
    const Properties at = properties_at(m, phi);
    EXPECT_NEAR(p - actual.last("s") / 3.0, row.lateral, 1e-12);
    const double expected =
        plastic_deviator_to(m, row.lateral, place(actual.at_event("yield", "p"), 0.0), place(p, phi), phi);
    const double error = std::abs(actual.last("plastic_strain_deviatoric") / expected - 1.0);
    std::cout << "constant lateral stress " << row.lateral << ": g^p " << expected << ", error " << error << '\n';
    EXPECT_LT(error, 1e-9);
    EXPECT_NEAR(actual.last("strain_axial"),
                (p / at.bulk_modulus.value - phi) / 3.0 + actual.last("s") / (3.0 * at.shear_modulus.value) + expected,
                1e-10);
  }
}

}  // namespace
}  // namespace monograin::material_point::independent_test
