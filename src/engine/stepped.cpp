// Integrators around codes without root finding: `Stepped` locates events along their interpolated steps, `FixedStep`
// locates none.

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "engine/event_locator.hpp"
#include "engine/stepper.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

// Pieces of a leg in which events are located one after the other: they end at multiples of 1/k_pieces. Events do not
// depend on this number as long as a guard crosses zero once between two evaluations.
constexpr double k_pieces = 32.0;
// A piece that begins closer than this to a multiple (in pieces) ends at the one after it.
constexpr double k_at_end_of_piece = 1e-9;

class Stepped final : public EventLocator {
 public:
  template <class Make>
  Stepped(Equations& system, GuardSet& guard_set, const Tolerances& tolerances, Make&& make)
      : EventLocator(system, guard_set),
        tolerances_(tolerances),
        form_(system),
        stepper_(make(form_)),
        z_(form_.size()),
        slope_(form_.size()) {}

  void begin(double xi, std::span<const double> y) override {
    form_.begin(y, z_);
    stepper_->begin(xi, z_);
    step_end_ = xi;
    begin_segment(xi, y);
  }

  Advance advance() override {
    begin_piece();
    if (begin_.xi >= step_end_) {
      form_.begin_step(begin_.xi, begin_.state);
      correct();
      step_end_ = stepper_->step();
      ++statistics_.steps;
      statistics_.last_step = step_end_ - begin_.xi;
    }
    const double next_multiple = (std::floor(begin_.xi * k_pieces + k_at_end_of_piece) + 1.0) / k_pieces;
    move_end(std::min(std::min(1.0, next_multiple), step_end_));
    if (guard_set_.size() > 0) sample_middle();
    locate_event();
    return {.xi = end_.xi, .hit_guard = !fired_.empty()};
  }

  void dense_output(double xi, std::span<double> y) override {
    if (xi == end_.xi)
      std::ranges::copy(end_.state, y.begin());
    else
      state_at(xi, y);
  }

  [[nodiscard]] double guard_tolerance() const noexcept override { return guard_tolerance_of(tolerances_); }

  [[nodiscard]] Statistics statistics() const override {
    Statistics now = statistics_;
    now.rhs_evaluations = form_.evaluations();
    now.jacobian_evaluations = stepper_->jacobian_evaluations;
    now.error_test_failures = stepper_->rejections;
    now.last_order = stepper_->order;
    return now;
  }

 private:
  /// Lets the next step begin at the complete state. Errors across the solution curve would add up from step to step,
  /// until completing finds another state than the rates have led to.
  void correct() {
    if (!form_.has_corrections()) return;
    stepper_->state_at(begin_.xi, z_);
    if (form_.take_correction(begin_.state, z_)) stepper_->correct(z_);
  }

  void state_at(double xi, std::span<double> y) override {
    stepper_->state_at(xi, z_);
    form_.complete(xi, z_, y);
  }

  /// Extrapolates along the tangent at the beginning of the segment.
  void state_ahead(double xi, std::span<double> y) override {
    stepper_->state_at(end_.xi, z_);
    form_.rates(end_.xi, z_, slope_);
    for (std::size_t k = 0; k < z_.size(); ++k) z_[k] += (xi - end_.xi) * slope_[k];
    form_.complete(xi, z_, y);
  }

  /// Evaluates the guards at the middle of the piece. If a long step leads beyond an event, the middle may have no
  /// state although the end has one: the piece then ends before its middle.
  void sample_middle() {
    while (end_.xi - begin_.xi > k_shortest_sampled) {
      const double middle = std::midpoint(begin_.xi, end_.xi);
      try {
        return sample_inside(middle);
      } catch (const std::domain_error&) {
        move_end(std::midpoint(begin_.xi, middle));
      }
    }
  }

  /// Ends the piece at xi, or nearer to its beginning until a state exists: a step may lead beyond an event, to where
  /// this mode has no state.
  void move_end(double xi) override {
    for (;;) {
      try {
        return evaluate(xi, end_);
      } catch (const std::domain_error&) {
        if (xi - begin_.xi < least_progress(begin_.xi)) throw;
        xi = 0.5 * (begin_.xi + xi);
      }
    }
  }

  Tolerances tolerances_;
  ScaledForm form_;
  std::unique_ptr<Stepper> stepper_;
  std::vector<double> z_, slope_;
  double step_end_ = 0.0;
};

/// Forward Euler with a fixed step, as in explicit discrete-element codes: a transition takes effect at the end of the
/// step that passes it.
class FixedStep final : public Integrator {
 public:
  FixedStep(Equations& system, GuardSet& guard_set, const Tolerances& tolerances)
      : guard_set_(guard_set),
        form_(system),
        complete_(system.unknowns().size()),
        begin_state_(form_.size()),
        end_state_(form_.size()),
        rates_(form_.size()),
        z_(form_.size()) {
    step_ = 1.0 / std::ceil(1.0 / std::max(tolerances.rtol, k_least_step));
  }

  void begin(double xi, std::span<const double> y) override {
    ++statistics_.segments;
    begin_ = end_ = xi;
    form_.begin(y, end_state_);
    values_.resize(guard_set_.size());
    before_.resize(guard_set_.size());
    fired_.reserve(guard_set_.size());
    guard_set_.values(xi, y, values_);
  }

  /// Takes one step. The rates at its end are evaluated only when the next step begins: the mode may end there, and
  /// integration errors may have led out of its domain.
  Advance advance() override {
    std::swap(begin_state_, end_state_);
    std::swap(before_, values_);
    begin_ = end_;
    end_ = begin_ + step_ > 1.0 - 0.5 * step_ ? 1.0 : begin_ + step_;
    form_.rates(begin_, begin_state_, rates_);
    for (std::size_t k = 0; k < rates_.size(); ++k) end_state_[k] = begin_state_[k] + (end_ - begin_) * rates_[k];
    ++statistics_.steps;
    ++statistics_.guard_evaluations;
    statistics_.last_step = end_ - begin_;
    form_.complete(end_, end_state_, complete_);
    guard_set_.values(end_, complete_, values_);
    fired_.clear();
    for (std::size_t g = 0; g < values_.size(); ++g) {
      if (crosses(guard_set_.directions()[g], before_[g], values_[g])) fired_.push_back(g);
    }
    return {.xi = end_, .hit_guard = !fired_.empty()};
  }

  [[nodiscard]] std::span<const std::size_t> fired() const noexcept override { return fired_; }

  void dense_output(double xi, std::span<double> y) override {
    const double share = end_ > begin_ ? (xi - begin_) / (end_ - begin_) : 1.0;
    for (std::size_t k = 0; k < z_.size(); ++k) z_[k] = std::lerp(begin_state_[k], end_state_[k], share);
    form_.complete(xi, z_, y);
  }

  [[nodiscard]] double guard_tolerance() const noexcept override { return 0.0; }

  [[nodiscard]] Statistics statistics() const override {
    Statistics now = statistics_;
    now.rhs_evaluations = form_.evaluations();
    now.last_order = 1;
    return now;
  }

  /// rtol prescribes the number of steps; the usual limit is a margin.
  [[nodiscard]] long most_steps() const noexcept override { return std::lround(1.0 / step_) + k_most_internal_steps; }

 private:
  static constexpr double k_least_step = 1e-7;  // step coordinates

  GuardSet& guard_set_;
  ScaledForm form_;
  double step_;
  double begin_ = 0.0;
  double end_ = 0.0;
  std::vector<double> complete_;
  std::vector<double> begin_state_, end_state_, rates_, z_;
  std::vector<double> values_, before_;
  std::vector<std::size_t> fired_;
  Statistics statistics_;
};

}  // namespace

std::unique_ptr<Integrator> make_stepped(OdeintMethod method, Equations& system, GuardSet& guard_set,
                                         const Tolerances& tolerances) {
  return std::make_unique<Stepped>(system, guard_set, tolerances,
                                   [&](ScaledForm& form) { return make_odeint(method, form, tolerances); });
}

std::unique_ptr<Integrator> make_stepped(GslMethod method, Equations& system, GuardSet& guard_set,
                                         const Tolerances& tolerances) {
  return std::make_unique<Stepped>(system, guard_set, tolerances,
                                   [&](ScaledForm& form) { return make_gsl(method, form, tolerances); });
}

std::unique_ptr<Integrator> make_fixed_step(Equations& system, GuardSet& guard_set, const Tolerances& tolerances) {
  return std::make_unique<FixedStep>(system, guard_set, tolerances);
}

}  // namespace monograin
