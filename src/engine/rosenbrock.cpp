#include "engine/rosenbrock.hpp"

#include <algorithm>
#include <boost/numeric/odeint/stepper/rosenbrock4.hpp>
#include <boost/numeric/odeint/stepper/rosenbrock4_controller.hpp>
#include <boost/numeric/ublas/matrix.hpp>
#include <boost/numeric/ublas/vector.hpp>
#include <utility>
#include <vector>

namespace monograin {

namespace odeint = boost::numeric::odeint;

struct Rosenbrock4::Implementation {
  using Method = odeint::rosenbrock4<double>;
  using State = Method::state_type;
  using Matrix = Method::matrix_type;

  Implementation(const Equations& equations_, double atol, double rtol)
      : equations(equations_),
        controlled(atol, rtol),
        old(equations.size, 0.0),
        now(equations.size, 0.0),
        between(equations.size, 0.0),
        by_z(equations.size * equations.size) {}

  /// Rates and their derivatives as the library wants them.
  auto system() {
    const auto rates = [this](const State& z, State& dz, double at) {
      equations.rates(equations.self, at, &z[0], &dz[0]);
    };
    const auto jacobian = [this](const State& z, Matrix& matrix, double at, State& by_xi) {
      equations.jacobian(equations.self, at, &z[0], by_z.data(), &by_xi[0]);
      for (std::size_t i = 0; i < equations.size; ++i) {
        for (std::size_t j = 0; j < equations.size; ++j) matrix(i, j) = by_z[i * equations.size + j];
      }
    };
    return std::make_pair(rates, jacobian);
  }

  Equations equations;
  odeint::rosenbrock4_controller<Method> controlled;
  State old, now, between;
  std::vector<double> by_z;
};

Rosenbrock4::Rosenbrock4(const Equations& equations, double atol, double rtol)
    : implementation_(std::make_unique<Implementation>(equations, atol, rtol)) {}

Rosenbrock4::~Rosenbrock4() = default;

void Rosenbrock4::begin(const double* z) {
  std::copy_n(z, implementation_->equations.size, implementation_->now.begin());
}

void Rosenbrock4::begin_step() { implementation_->old.swap(implementation_->now); }

bool Rosenbrock4::try_step(double& xi, double& step) {
  Implementation& own = *implementation_;
  return own.controlled.try_step(own.system(), own.old, xi, own.now, step) == odeint::success;
}

const double* Rosenbrock4::begin_state() const noexcept { return &implementation_->old[0]; }

const double* Rosenbrock4::end_state() const noexcept { return &implementation_->now[0]; }

const double* Rosenbrock4::state_at(double xi, double begin) {
  Implementation& own = *implementation_;
  own.controlled.stepper().do_step(own.system(), own.old, begin, own.between, xi - begin);
  return &own.between[0];
}

}  // namespace monograin
