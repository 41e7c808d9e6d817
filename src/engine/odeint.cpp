// Steppers of Boost.Odeint. Small states are arrays of fixed size, padded with zeros.

#include <algorithm>
#include <array>
#include <boost/numeric/odeint/stepper/bulirsch_stoer.hpp>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <cmath>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "engine/odeint_errors.hpp"
#include "engine/stepper.hpp"
#include "numerics/rosenbrock.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

namespace odeint = boost::numeric::odeint;

// First step of the linearly implicit method if rates may be singular: its difference quotients do not show a
// singularity, and now and then two errors cancel in its estimate. The error is proportional to the square of the step.
constexpr double k_first_step_with_dependents = 1e-9;
constexpr double k_smallest_step = 2e-3;  // over least_progress(): still above the round-off of xi
constexpr int k_most_tries = 500;         // for one step
// Largest difference between the two sequences of the midpoint rule, over the tolerance of a step, if both approximate
// the same solution.
constexpr double k_most_between_sequences = 100.0;
constexpr double k_shorter = 0.25;  // factor on the length of a step that failed
constexpr double k_stretch = 1.1;   // most for the last step, so that no remainder of the size of round-off is left

/// Takes one step that does not end beyond xi = 1; shortens it if its error is too large or the equations end in it.
/// @param step        length to try first; receives the length of the next step
/// @param rejections  counts failed tries
/// @param attempt     (end, length): tries a step as Odeint's try_step() does
/// @return where the step ends
/// @throws std::domain_error where the equations end; SolverError if no step succeeds
template <class Try>
double controlled_step(double xi, double& step, long& rejections, Try&& attempt) {
  for (int tries = 0; tries < k_most_tries; ++tries) {
    const bool is_last = xi + k_stretch * step >= 1.0;
    double now = is_last ? 1.0 - xi : step;
    double end = xi;
    try {
      const double tried = now;
      if (attempt(end, now) == odeint::success) {
        step = now;
        return is_last ? 1.0 : xi + tried;
      }
      // Odeint compares steps to within epsilon, and would try a step of about that length again and again.
      step = now < tried ? now : k_shorter * tried;
    } catch (const std::domain_error&) {
      step = k_shorter * std::min(step, 1.0 - xi);
      if (step < least_progress(xi)) throw;
    }
    ++rejections;
    if (step < k_smallest_step * least_progress(xi)) break;
  }
  throw SolverError(Failure::no_step, xi, step, {});
}

/// Gives Odeint the error of a step over its tolerance.
template <class State>
class ErrorChecker {
 public:
  explicit ErrorChecker(const Tolerated<State>& tolerated, const RuleErrors<State>* rule_errors = nullptr)
      : tolerated_(&tolerated), rule_errors_(rule_errors) {}

  template <class Algebra, class Rates, class Time>
  double error(Algebra& /*algebra*/, const State& old, const Rates& /*rates*/, const State& error, Time step) const {
    const double own = tolerated_->share(old, [&](std::size_t k) { return error[k]; });
    if (rule_errors_ == nullptr) return own;
    return std::max(own, tolerated_->share(old, [&](std::size_t k) { return step * (*rule_errors_)[k]; }));
  }

 private:
  const Tolerated<State>* tolerated_;
  const RuleErrors<State>* rule_errors_;
};

template <class State>
using DormandPrince = odeint::controlled_runge_kutta<odeint::runge_kutta_dopri5<State>, ErrorChecker<State>>;
template <class State>
using Fehlberg = odeint::controlled_runge_kutta<odeint::runge_kutta_fehlberg78<State>, ErrorChecker<State>>;

/// Tolerances as in `Tolerated` for the extrapolation, which accepts no error checker. Uses the rates at the step's
/// beginning.
struct RoundedOperations : odeint::default_operations {
  template <class Value>
  struct rel_error : odeint::default_operations::rel_error<Value> {
    using Base = odeint::default_operations::rel_error<Value>;
    using Base::Base;

    void operator()(double& error, double old, double rate) const {
      const double tolerated =
          std::max(this->m_eps_abs + this->m_eps_rel * std::abs(old), k_round_off * std::abs(rate));
      error = std::abs(error) / tolerated;
    }
  };
};
template <class State>
using Extrapolation =
    odeint::bulirsch_stoer<State, double, State, double, typename odeint::algebra_dispatcher<State>::algebra_type,
                           RoundedOperations>;

/// Explicit methods. The method of order 5 has an interpolation of its own. Within a step of the others, a state is
/// found by integrating to it with the method of order 8.
template <class State, class Controlled>
class ExplicitStepper final : public Stepper {
 public:
  static constexpr bool has_interpolation = std::is_same_v<Controlled, DormandPrince<State>>;
  static constexpr bool has_rule_errors = std::is_same_v<Controlled, Fehlberg<State>>;
  static constexpr bool has_sequences = std::is_same_v<Controlled, Extrapolation<State>>;

  /// @param make  makes the controlled method from its tolerances and its error estimate as a quadrature
  template <class Make>
  ExplicitStepper(ScaledForm& form, const Tolerances& tolerances, int method_order, Make&& make)
      : form_(form),
        tolerated_(form, tolerances),
        rule_errors_(form.size()),
        sequence_errors_(form.size()),
        controlled_(make(tolerated_, rule_errors_)),
        reaching_(ErrorChecker<State>(tolerated_, &rule_errors_)) {
    order = method_order;
    for (State* state : {&old_, &old_rates_, &now_, &now_rates_, &between_}) *state = zeros<State>(form.size());
  }

  void begin(double xi, std::span<const double> z) override {
    std::ranges::copy(z, now_.begin());
    begin_ = end_ = xi;
    step_ = std::min(k_first_step, 1.0 - xi);
    has_rates_ = false;
  }

  void correct(std::span<const double> z) override { std::ranges::copy(z, now_.begin()); }

  double step() override {
    if (!has_rates_) rates(now_, now_rates_, end_);
    has_rates_ = true;
    std::swap(old_, now_);
    std::swap(old_rates_, now_rates_);
    begin_ = end_;
    end_ = controlled_step(begin_, step_, rejections, [&](double& end, double& step) {
      if constexpr (has_interpolation) {
        return controlled_.try_step(system<false>(), old_, old_rates_, end, now_, now_rates_, step);
      } else {
        const double length = step;
        rule_errors_.begin(1);
        sequence_errors_.begin(old_rates_);
        const auto result =
            controlled_.try_step(system<has_rule_errors, has_sequences>(), old_, old_rates_, end, now_, step);
        if constexpr (has_sequences) {
          const auto difference = [&](std::size_t k) { return length * sequence_errors_[k]; };
          if (result == odeint::success && tolerated_.share(old_, difference) > k_most_between_sequences) {
            step = k_shorter * length;
            return odeint::fail;
          }
        }
        // A step is accepted only if the equations hold at its end, however small its error.
        if (result == odeint::success) rates(now_, now_rates_, end);
        return result;
      }
    });
    return end_;
  }

  void state_at(double xi, std::span<double> z) override {
    if (xi == end_)
      std::copy_n(now_.begin(), z.size(), z.begin());
    else if (xi == begin_)
      std::copy_n(old_.begin(), z.size(), z.begin());
    else
      interpolate(xi, z);
  }

 private:
  void interpolate(double xi, std::span<double> z) {
    if constexpr (has_interpolation) {
      controlled_.stepper().calc_state(xi, between_, old_, old_rates_, begin_, now_, now_rates_, end_);
    } else {
      between_ = old_;
      double at = begin_;
      double step = xi - begin_;
      for (int tries = 0; xi - at > k_smallest_step * least_progress(at); ++tries) {
        if (tries == k_most_tries)
          throw SolverError(Failure::no_step, at, step, "a state within the step is not reached");
        step = std::min(step, xi - at);
        rule_errors_.begin(0);
        try {
          const auto result = reaching_.try_step(system<true>(), between_, at, step);
          // The state reached guides the next one: of several solutions, the one sought need not be the nearest to the
          // step's beginning.
          if (result == odeint::success && at < xi) form_.complete_on_path(at, {between_.data(), form_.size()});
        } catch (const std::domain_error&) {
          // Stages may lie outside of the domain of the equations although the step does not.
          step *= k_shorter;
          if (step < least_progress(at)) throw;
        }
      }
    }
    std::copy_n(between_.begin(), z.size(), z.begin());
  }

  void rates(const State& z, State& dz, double xi) {
    form_.rates(xi, {z.data(), form_.size()}, {dz.data(), form_.size()});
    std::fill(dz.begin() + static_cast<std::ptrdiff_t>(form_.size()), dz.end(), 0.0);
  }
  template <bool sees_rates, bool sees_sequences = false>
  auto system() {
    return [this](const State& z, State& dz, double xi) {
      rates(z, dz, xi);
      tolerated_.see(dz);
      if constexpr (sees_rates) rule_errors_.see(dz);
      if constexpr (sees_sequences) sequence_errors_.see(dz);
    };
  }

  ScaledForm& form_;
  Tolerated<State> tolerated_;
  RuleErrors<State> rule_errors_;
  SequenceErrors<State> sequence_errors_;
  Controlled controlled_;
  Fehlberg<State> reaching_;
  State old_, old_rates_, now_, now_rates_, between_;
  double begin_ = 0.0, end_ = 0.0, step_ = k_first_step;
  bool has_rates_ = false;
};

/// The linearly implicit method of order 4. xi is one more unknown: Boost 1.74 integrates equations that contain xi
/// explicitly with order 1.
class RosenbrockStepper final : public Stepper {
 public:
  RosenbrockStepper(ScaledForm& form, const Tolerances& tolerances)
      : form_(form),
        jacobian_(form),
        size_(form.size()),
        method_({size_ + 1, rates, jacobian, this}, of_step(tolerances, k_share_of_many).atol,
                of_step(tolerances, k_share_of_many).rtol, k_round_off),
        start_(size_ + 1),
        by_z_(size_ * size_),
        by_xi_(size_) {
    order = 4;
  }

  void begin(double xi, std::span<const double> z) override {
    std::ranges::copy(z, start_.begin());
    start_[size_] = xi;
    method_.begin(start_.data());
    begin_ = end_ = xi;
    step_ = std::min(form_.has_dependent_unknowns() ? k_first_step_with_dependents : k_first_step, 1.0 - xi);
  }

  void correct(std::span<const double> z) override {
    std::ranges::copy(z, start_.begin());
    start_[size_] = end_;
    method_.begin(start_.data());
  }

  double step() override {
    begin_ = end_;
    method_.begin_step();
    end_ = controlled_step(begin_, step_, rejections, [&](double& end, double& step) {
      length_ = step;
      return method_.try_step(end, step) ? odeint::success : odeint::fail;
    });
    return end_;
  }

  void state_at(double xi, std::span<double> z) override {
    const double* state = xi == end_     ? method_.end_state()
                          : xi == begin_ ? method_.begin_state()
                                         : method_.state_at(xi, begin_);
    std::copy_n(state, size_, z.begin());
  }

 private:
  static void rates(void* self, double, const double* z, double* dz) {
    auto& stepper = *static_cast<RosenbrockStepper*>(self);
    // As an unknown, xi may pass the end of the leg by round-off, where the prescribed force may be tensile.
    stepper.form_.rates(std::min(z[stepper.size_], 1.0), {z, stepper.size_}, {dz, stepper.size_});
    dz[stepper.size_] = 1.0;
  }

  static void jacobian(void* self, double, const double* z, double* matrix, double* by_time) {
    auto& stepper = *static_cast<RosenbrockStepper*>(self);
    const std::size_t size = stepper.size_;
    ++stepper.jacobian_evaluations;
    stepper.jacobian_.at(z[size], {z, size}, stepper.length_, stepper.by_z_, stepper.by_xi_);
    std::fill_n(by_time, size + 1, 0.0);
    for (std::size_t i = 0; i < size; ++i) {
      double* const row = std::copy_n(stepper.by_z_.data() + i * size, size, matrix + i * (size + 1));
      *row = stepper.by_xi_[i];
    }
    std::fill_n(matrix + size * (size + 1), size + 1, 0.0);
  }

  ScaledForm& form_;
  DifferenceJacobian jacobian_;
  std::size_t size_;
  Rosenbrock4 method_;
  std::vector<double> start_, by_z_, by_xi_;
  double begin_ = 0.0, end_ = 0.0, step_ = k_first_step;
  double length_ = k_first_step;  ///< length of the step that is tried
};

template <class State>
std::unique_ptr<Stepper> make_method(OdeintMethod method, ScaledForm& form, const Tolerances& tolerances) {
  const auto [rtol, atol] = of_step(tolerances);
  switch (method) {
    case OdeintMethod::dopri5:
      return std::make_unique<ExplicitStepper<State, DormandPrince<State>>>(
          form, tolerances, 5, [](const Tolerated<State>& tolerated, const RuleErrors<State>&) {
            return DormandPrince<State>(ErrorChecker<State>(tolerated));
          });
    case OdeintMethod::fehlberg78:
      return std::make_unique<ExplicitStepper<State, Fehlberg<State>>>(
          form, tolerances, 8, [](const Tolerated<State>& tolerated, const RuleErrors<State>& rule_errors) {
            return Fehlberg<State>(ErrorChecker<State>(tolerated, &rule_errors));
          });
    case OdeintMethod::bulirsch_stoer: {
      using Controlled = Extrapolation<State>;
      return std::make_unique<ExplicitStepper<State, Controlled>>(
          form, tolerances, 0,
          [atol = atol, rtol = rtol](const auto&, const auto&) { return Controlled(atol, rtol, 1.0, 0.0); });
    }
    case OdeintMethod::rosenbrock4:
      return std::make_unique<RosenbrockStepper>(form, tolerances);
  }
  return nullptr;
}

}  // namespace

std::unique_ptr<Stepper> make_odeint(OdeintMethod method, ScaledForm& form, const Tolerances& tolerances) {
  if (form.size() <= 2) return make_method<std::array<double, 2>>(method, form, tolerances);
  if (form.size() <= 8) return make_method<std::array<double, 8>>(method, form, tolerances);
  return make_method<std::vector<double>>(method, form, tolerances);
}

}  // namespace monograin
