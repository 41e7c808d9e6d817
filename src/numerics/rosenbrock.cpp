#include "numerics/rosenbrock.hpp"

#include <algorithm>
#include <boost/numeric/odeint/stepper/rosenbrock4.hpp>
#include <boost/numeric/odeint/stepper/rosenbrock4_controller.hpp>
#include <boost/numeric/ublas/matrix.hpp>
#include <boost/numeric/ublas/vector.hpp>
#include <cmath>
#include <utility>
#include <vector>

namespace monograin {

namespace odeint = boost::numeric::odeint;

namespace {

using Method = odeint::rosenbrock4<double>;

// Safety factor and largest growth of a step, as in the library.
constexpr double k_safety = 0.9;
constexpr double k_most_growth = 5.0;

class Controlled : public odeint::rosenbrock4_controller<Method> {
 public:
  Controlled(double atol, double rtol, double round_off)
      : odeint::rosenbrock4_controller<Method>(atol, rtol), round_off_(round_off) {}

  /// Largest error in a step that the library has refused, over tolerances no finer than the round-off of xi times the
  /// rate.
  [[nodiscard]] double largest_error(const Method::state_type& begin, const Method::state_type& end,
                                     double step) const {
    double largest = 0.0;
    for (std::size_t i = 0; i < begin.size(); ++i) {
      const double size = std::max(std::abs(begin[i]), std::abs(end[i]));
      const double rate = std::abs(end[i] - begin[i]) / step;
      largest = std::max(largest, std::abs(m_xerr.m_v[i]) / std::max(m_atol + m_rtol * size, round_off_ * rate));
    }
    return largest;
  }

 private:
  double round_off_;
};

}  // namespace

struct Rosenbrock4::Implementation {
  using State = Method::state_type;
  using Matrix = Method::matrix_type;

  Implementation(const Equations& equations_, double atol, double rtol, double round_off)
      : equations(equations_),
        controlled(atol, rtol, round_off),
        old(equations.size, 0.0),
        now(equations.size, 0.0),
        between(equations.size, 0.0),
        by_z(equations.size * equations.size),
        by_xi_of_step(equations.size) {}

  /// Rates and their derivatives as the library takes them.
  /// @param is_known  the derivatives that were computed last are those at the step's beginning
  auto system(bool is_known = false) {
    const auto rates = [this](const State& z, State& dz, double at) {
      equations.rates(equations.self, at, &z[0], &dz[0]);
    };
    const auto jacobian = [this, is_known](const State& z, Matrix& matrix, double at, State& by_xi) {
      if (!is_known) equations.jacobian(equations.self, at, &z[0], by_z.data(), by_xi_of_step.data());
      std::copy(by_xi_of_step.begin(), by_xi_of_step.end(), by_xi.begin());
      for (std::size_t i = 0; i < equations.size; ++i) {
        for (std::size_t j = 0; j < equations.size; ++j) matrix(i, j) = by_z[i * equations.size + j];
      }
    };
    return std::make_pair(rates, jacobian);
  }

  Equations equations;
  Controlled controlled;
  State old, now, between;
  std::vector<double> by_z, by_xi_of_step;
};

Rosenbrock4::Rosenbrock4(const Equations& equations, double atol, double rtol, double round_off)
    : implementation_(std::make_unique<Implementation>(equations, atol, rtol, round_off)) {}

Rosenbrock4::~Rosenbrock4() = default;

void Rosenbrock4::begin(const double* z) {
  std::copy_n(z, implementation_->equations.size, implementation_->now.begin());
}

void Rosenbrock4::begin_step() { implementation_->old.swap(implementation_->now); }

bool Rosenbrock4::try_step(double& xi, double& step) {
  Implementation& own = *implementation_;
  const double tried = step;
  if (own.controlled.try_step(own.system(), own.old, xi, own.now, step) == odeint::success) return true;
  // If a contact lasts hardly longer than the round-off of xi, the errors of the stages are of its size.
  const double error = own.controlled.largest_error(own.old, own.now, tried);
  if (!(error <= 1.0)) return false;
  xi += tried;
  step = tried * std::clamp(k_safety * std::pow(error, -0.25), 1.0, k_most_growth);
  return true;
}

const double* Rosenbrock4::begin_state() const noexcept { return &implementation_->old[0]; }

const double* Rosenbrock4::end_state() const noexcept { return &implementation_->now[0]; }

const double* Rosenbrock4::state_at(double xi, double begin) {
  Implementation& own = *implementation_;
  own.controlled.stepper().do_step(own.system(true), own.old, begin, own.between, xi - begin);
  return &own.between[0];
}

}  // namespace monograin
