// Segments whose states depend on no history are solved for directly. The others are integrated by an explicit method
// until it takes too many steps, then by an implicit one.

#include <array>

#include "engine/integrator.hpp"

namespace monograin {
namespace {

// Explicit steps of one segment after which the equations are taken for stiff: some ten times as many as smooth
// equations need.
constexpr long k_most_explicit_steps = 400;

class Switching final : public Integrator {
 public:
  Switching(Equations& system, GuardSet& guard_set, const Tolerances& tolerances)
      : system_(system),
        direct_(make_direct(system, tolerances.rtol, guard_set, 0)),
        explicit_(make_stepped(OdeintMethod::dopri5, system, guard_set, tolerances)),
        implicit_(make_sundials_ode(OdeMethod::cvode_bdf, system, guard_set, tolerances)),
        state_(system.unknowns().size()) {}

  void begin(double xi, std::span<const double> y) override {
    segment_steps_ = explicit_->statistics().steps;
    active_ = system_.is_solvable_here() ? direct_.get() : path_integrator_;
    active_->begin(xi, y);
  }

  Advance advance() override {
    if (active_ == explicit_.get() && explicit_->statistics().steps - segment_steps_ > k_most_explicit_steps) {
      // Equations that are stiff once are taken for stiff in all later segments.
      explicit_->dense_output(end_, state_);
      active_ = path_integrator_ = implicit_.get();
      active_->begin(end_, state_);
    }
    const Advance step = active_->advance();
    end_ = step.xi;
    return step;
  }

  [[nodiscard]] std::span<const std::size_t> fired() const noexcept override { return active_->fired(); }
  void dense_output(double xi, std::span<double> y) override { active_->dense_output(xi, y); }
  [[nodiscard]] double guard_tolerance() const noexcept override { return active_->guard_tolerance(); }

  [[nodiscard]] Statistics statistics() const override {
    Statistics sum = active_->statistics();
    for (const Integrator* other : parts()) {
      if (other != active_) sum += other->statistics();
    }
    return sum;
  }
  [[nodiscard]] long rhs_evaluations() const override {
    long sum = 0;
    for (const Integrator* part : parts()) sum += part->rhs_evaluations();
    return sum;
  }

 private:
  [[nodiscard]] std::array<const Integrator*, 3> parts() const noexcept {
    return {direct_.get(), explicit_.get(), implicit_.get()};
  }

  Equations& system_;
  std::unique_ptr<Integrator> direct_;
  std::unique_ptr<Integrator> explicit_;
  std::unique_ptr<Integrator> implicit_;
  Integrator* path_integrator_ = explicit_.get();  ///< integrator of segments that are not solved for
  Integrator* active_ = explicit_.get();
  std::vector<double> state_;
  double end_ = 0.0;
  long segment_steps_ = 0;
};

}  // namespace

std::unique_ptr<Integrator> make_switching(Equations& system, GuardSet& guard_set, const Tolerances& tolerances) {
  return std::make_unique<Switching>(system, guard_set, tolerances);
}

}  // namespace monograin
