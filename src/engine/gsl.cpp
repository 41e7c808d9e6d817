// Steppers of the GNU Scientific Library. They have no interpolation: a state within a step is found by integrating to
// it from the step's beginning with the Runge-Kutta method of order 8.

#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_odeiv2.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include "engine/c_library.hpp"
#include "engine/stepper.hpp"
#include "numerics/quiet_gsl.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

using Driver = Handle<gsl_odeiv2_driver*, gsl_odeiv2_driver_free>;

constexpr double k_smallest_step = 1e-2;  // over least_progress()
// The change over an implicit step should lie between the changes that the rates at its two ends give. Largest distance
// from that range, over the tolerance of the step. Beyond k_doubtful the distance is corrected for the dependence of
// the rates on the state, and may then be k_wrong: the tolerance of the curve.
constexpr double k_doubtful = 2.0;
constexpr double k_wrong = 1.0 / k_share_of_many;

const gsl_odeiv2_step_type* type_of(GslMethod method) {
  switch (method) {
    case GslMethod::rk8pd:
      return gsl_odeiv2_step_rk8pd;
    case GslMethod::msadams:
      return gsl_odeiv2_step_msadams;
    case GslMethod::msbdf:
      return gsl_odeiv2_step_msbdf;
  }
  return nullptr;
}

/// Error control of a step and choice of the next one: the library's standard, but with tolerances no finer than the
/// round-off of xi times the rates. If a contact lasts hardly longer than that round-off, the errors of the stages are
/// of its size.
class ErrorControl {
 public:
  [[nodiscard]] static gsl_odeiv2_control* make(double atol, double rtol) {
    static const gsl_odeiv2_control_type type{"rounding", alloc, init, adjust, level, set_driver, free};
    gsl_odeiv2_control* control = gsl_odeiv2_control_alloc(&type);
    if (control != nullptr) gsl_odeiv2_control_init(control, atol, rtol, 1.0, 0.0);
    return control;
  }

 private:
  static void* alloc() { return new (std::nothrow) ErrorControl; }
  static void free(void* self) { delete static_cast<ErrorControl*>(self); }
  static int set_driver(void*, const gsl_odeiv2_driver*) { return GSL_SUCCESS; }
  static int init(void* self, double atol, double rtol, double, double) {
    *static_cast<ErrorControl*>(self) = ErrorControl{atol, rtol};
    return GSL_SUCCESS;
  }

  [[nodiscard]] double tolerated(double value, double rate) const noexcept {
    return std::max(rtol_ * std::abs(value) + atol_, k_round_off * std::abs(rate));
  }

  static int level(void* self, const double value, const double rate, const double, const size_t, double* tolerated) {
    *tolerated = static_cast<const ErrorControl*>(self)->tolerated(value, rate);
    return GSL_SUCCESS;
  }

  static int adjust(void* self, size_t size, unsigned order, const double values[], const double errors[],
                    const double rates[], double* step) {
    double largest = std::numeric_limits<double>::min();
    for (size_t k = 0; k < size; ++k) {
      largest = std::max(largest,
                         std::abs(errors[k]) / static_cast<const ErrorControl*>(self)->tolerated(values[k], rates[k]));
    }
    if (largest > k_refused) {
      *step *= std::max(k_safety / std::pow(largest, 1.0 / order), 1.0 / k_most_growth);
      return GSL_ODEIV_HADJ_DEC;
    }
    if (largest >= k_kept) return GSL_ODEIV_HADJ_NIL;
    *step *= std::clamp(k_safety / std::pow(largest, 1.0 / (order + 1.0)), 1.0, k_most_growth);
    return GSL_ODEIV_HADJ_INC;
  }

  // The library's own numbers.
  static constexpr double k_refused = 1.1;
  static constexpr double k_kept = 0.5;
  static constexpr double k_safety = 0.9;
  static constexpr double k_most_growth = 5.0;

  ErrorControl() = default;
  ErrorControl(double atol, double rtol) : atol_(atol), rtol_(rtol) {}
  double atol_ = 0.0, rtol_ = 0.0;
};

class GslStepper final : public Stepper {
 public:
  GslStepper(GslMethod method, ScaledForm& form, const Tolerances& tolerances)
      : form_(form),
        jacobian_(form),
        system_{rates, jacobian, form.size(), this},
        driver_(make_driver(type_of(method), tolerances)),
        reaching_(make_driver(gsl_odeiv2_step_rk8pd, tolerances)),
        old_(form.size()),
        now_(form.size()),
        between_(form.size()),
        old_rates_(form.size()),
        rates_(form.size()) {
    if (driver_->s->type == gsl_odeiv2_step_msbdf) {
      by_z_.resize(form.size() * form.size());
      for (auto* values : {&by_xi_, &excess_, &tolerated_}) values->resize(form.size());
      permutation_.reset(gsl_permutation_alloc(form.size()));
      if (!permutation_) throw std::bad_alloc();
    }
    // Without a limit the driver would never end where the rates jump: its steps become ever smaller.
    gsl_odeiv2_driver_set_nmax(reaching_.get(), static_cast<unsigned long>(k_most_internal_steps));
  }

  void begin(double xi, std::span<const double> z) override {
    std::ranges::copy(z, now_.begin());
    begin_ = end_ = xi;
    are_rates_known_ = false;
    step_ = std::min(k_first_step, 1.0 - xi);
    gsl_odeiv2_driver_reset(driver_.get());
  }

  void correct(std::span<const double> z) override {
    if (driver_->s->type == gsl_odeiv2_step_rk8pd) std::ranges::copy(z, now_.begin());
  }

  double step() override {
    std::ranges::copy(now_, old_.begin());
    begin_ = end_;
    pending_.forget();
    for (;;) {
      double at = begin_;
      const unsigned long rejected = driver_->e->failed_steps;
      const int status =
          gsl_odeiv2_evolve_apply(driver_->e, driver_->c, driver_->s, &system_, &at, 1.0, &step_, now_.data());
      rejections += static_cast<long>(driver_->e->failed_steps - rejected);
      pending_.rethrow();
      // GSL itself halves a step in which the equations end. A step this short has reached their end; later steps
      // would approach it without ever arriving.
      const bool has_arrived = at - begin_ < least_progress(begin_) && pending_.domain_end();
      // A step is accepted only if the equations hold at its end, however small its error.
      const bool is_accepted = status == GSL_SUCCESS && at > begin_ && !has_arrived &&
                               rates(at, now_.data(), rates_.data(), this) == GSL_SUCCESS && !leads_elsewhere(at);
      pending_.rethrow();
      if (is_accepted) {
        end_ = at;
        std::swap(old_rates_, rates_);
        are_rates_known_ = true;
        order = static_cast<int>(gsl_odeiv2_step_order(driver_->s));
        return end_;
      }
      // The history of a multistep method may contain states from beyond the end of the equations.
      std::ranges::copy(old_, now_.begin());
      gsl_odeiv2_driver_reset(driver_.get());
      step_ = 0.1 * std::min(step_, 1.0 - begin_);
      ++rejections;
      if (step_ >= least_progress(begin_)) continue;
      if (pending_.domain_end()) throw *pending_.domain_end();
      if (step_ < k_smallest_step * least_progress(begin_)) throw SolverError(Failure::no_step, begin_, step_, {});
    }
  }

  void state_at(double xi, std::span<double> z) override {
    if (xi == end_) {
      std::ranges::copy(now_, z.begin());
      return;
    }
    std::ranges::copy(old_, between_.begin());
    double at = begin_;
    reaching_->h = xi - begin_;
    gsl_odeiv2_evolve_reset(reaching_->e);
    gsl_odeiv2_step_reset(reaching_->s);
    pending_.forget();
    if (xi > begin_) {
      const int status = gsl_odeiv2_driver_apply(reaching_.get(), &at, xi, between_.data());
      pending_.rethrow();
      if (status != GSL_SUCCESS && pending_.domain_end()) throw *pending_.domain_end();
      if (status != GSL_SUCCESS) throw SolverError(Failure::no_step, at, 0.0, "a state within the step is not reached");
    }
    std::ranges::copy(between_, z.begin());
  }

 private:
  /// True if a step of BDF has left the curve along which the rates lead. The library takes corrections for small if it
  /// uses the Jacobian of an earlier step that is far larger than the present one. Where d(rates)/dz exceeds 1/step, as
  /// before a fold, the implicit equation has no solution, or one that leads back.
  [[nodiscard]] bool leads_elsewhere(double end) {
    if (by_z_.empty() || !are_rates_known_) return false;
    const std::size_t size = now_.size();
    const double length = end - begin_;
    bool is_doubtful = false;
    for (std::size_t k = 0; k < size; ++k) {
      const double change = now_[k] - old_[k];
      const auto [least, most] = std::minmax({length * old_rates_[k], length * rates_[k]});
      const double slack = 0.5 * (most - least);
      excess_[k] = change - std::clamp(change, least - slack, most + slack);
      gsl_odeiv2_control_errlevel(driver_->c, now_[k], rates_[k], length, k, &tolerated_[k]);
      is_doubtful = is_doubtful || std::abs(excess_[k]) > k_doubtful * tolerated_[k];
    }
    if (!is_doubtful) return false;
    if (jacobian(end, now_.data(), by_z_.data(), by_xi_.data(), this) != GSL_SUCCESS) return true;
    for (double& value : by_z_) value *= -length;
    for (std::size_t k = 0; k < size; ++k) by_z_[k * size + k] += 1.0;
    gsl_matrix_view matrix = gsl_matrix_view_array(by_z_.data(), size, size);
    gsl_vector_view correction = gsl_vector_view_array(excess_.data(), size);
    int sign = 0;
    gsl_linalg_LU_decomp(&matrix.matrix, permutation_.get(), &sign);
    if (gsl_linalg_LU_sgndet(&matrix.matrix, sign) <= 0) return true;
    gsl_linalg_LU_svx(&matrix.matrix, permutation_.get(), &correction.vector);
    for (std::size_t k = 0; k < size; ++k) {
      if (std::abs(excess_[k]) > k_wrong * tolerated_[k]) return true;
    }
    return false;
  }

  [[nodiscard]] Driver make_driver(const gsl_odeiv2_step_type* type, const Tolerances& tolerances) {
    const double share = type == gsl_odeiv2_step_rk8pd ? k_usual_share : k_share_of_many;
    const auto [rtol, atol] = of_step(tolerances, share);
    Driver driver(gsl_odeiv2_driver_alloc_y_new(&system_, type, k_first_step, atol, rtol));
    if (!driver) throw std::bad_alloc();
    gsl_odeiv2_control* control = ErrorControl::make(atol, rtol);
    if (control == nullptr) throw std::bad_alloc();
    gsl_odeiv2_control_free(driver->c);
    driver->c = control;
    return driver;
  }

  /// GSL's code for a result of Pending::guard(). After a domain error GSL tries a smaller step.
  static int answer(int pending) { return pending == 0 ? GSL_SUCCESS : pending > 0 ? GSL_EDOM : GSL_EBADFUNC; }

  static int rates(double xi, const double* z, double* dz, void* self) noexcept {
    auto& stepper = *static_cast<GslStepper*>(self);
    const std::size_t size = stepper.form_.size();
    return answer(stepper.pending_.guard([&] {
      stepper.form_.rates(xi, {z, size}, {dz, size});
      return true;
    }));
  }

  static int jacobian(double xi, const double* z, double* by_z, double* by_xi, void* self) noexcept {
    auto& stepper = *static_cast<GslStepper*>(self);
    const std::size_t size = stepper.form_.size();
    ++stepper.jacobian_evaluations;
    return answer(stepper.pending_.guard([&] {
      stepper.jacobian_.at(xi, {z, size}, stepper.step_, {by_z, size * size}, {by_xi, size});
      return true;
    }));
  }

  QuietGsl quiet_{};  // every return value is checked
  ScaledForm& form_;
  DifferenceJacobian jacobian_;
  gsl_odeiv2_system system_;
  Driver driver_;
  Driver reaching_;
  Pending pending_;
  std::vector<double> old_, now_, between_;
  std::vector<double> old_rates_, rates_;
  bool are_rates_known_ = false;  ///< at the beginning of the step
  std::vector<double> by_z_, by_xi_, excess_, tolerated_;
  Handle<gsl_permutation*, gsl_permutation_free> permutation_;
  double begin_ = 0.0, end_ = 0.0, step_ = k_first_step;
};

}  // namespace

std::unique_ptr<Stepper> make_gsl(GslMethod method, ScaledForm& form, const Tolerances& tolerances) {
  return std::make_unique<GslStepper>(method, form, tolerances);
}

}  // namespace monograin
