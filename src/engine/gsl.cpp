// Steppers of the GNU Scientific Library. They have no interpolation: a state within a step is found by integrating to
// it from the step's beginning with the Runge-Kutta method of order 8.

#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_odeiv2.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <optional>

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

/// An end of a step, with the scaled state and rates there.
struct StepEnd {
  double xi = 0.0;
  std::vector<double> z, rates;
};

/// Finds steps of BDF that have left the curve along which the rates lead. The library takes corrections for small if
/// it uses the Jacobian of an earlier step that is far larger than the present one. Where d(rates)/dz exceeds 1/step,
/// as before a fold, the implicit equation has no solution, or one that leads back.
class BdfCheck {
 public:
  explicit BdfCheck(std::size_t size)
      : by_z_(size * size), by_xi_(size), excess_(size), tolerated_(size), permutation_(gsl_permutation_alloc(size)) {
    if (!permutation_) throw std::bad_alloc();
  }

  /// @param length    of the step; the end need not have its xi
  /// @param control   gives the tolerances of the step
  /// @param jacobian  (by_z, by_xi): puts both derivatives of the rates at the end there, and returns GSL's code
  template <class Jacobian>
  [[nodiscard]] bool leads_elsewhere(const StepEnd& begin, const StepEnd& end, double length,
                                     gsl_odeiv2_control* control, Jacobian&& jacobian) {
    const std::size_t size = excess_.size();
    bool is_doubtful = false;
    for (std::size_t k = 0; k < size; ++k) {
      const double change = end.z[k] - begin.z[k];
      const auto [least, most] = std::minmax({length * begin.rates[k], length * end.rates[k]});
      const double slack = 0.5 * (most - least);
      excess_[k] = change - std::clamp(change, least - slack, most + slack);
      gsl_odeiv2_control_errlevel(control, end.z[k], end.rates[k], length, k, &tolerated_[k]);
      is_doubtful = is_doubtful || std::abs(excess_[k]) > k_doubtful * tolerated_[k];
    }
    if (!is_doubtful) return false;
    if (jacobian(by_z_.data(), by_xi_.data()) != GSL_SUCCESS) return true;
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

 private:
  std::vector<double> by_z_, by_xi_, excess_, tolerated_;
  Handle<gsl_permutation*, gsl_permutation_free> permutation_;
};

class GslStepper final : public Stepper {
 public:
  GslStepper(GslMethod method, ScaledForm& form, const Tolerances& tolerances)
      : form_(form),
        jacobian_(form),
        system_{rates, jacobian, form.size(), this},
        driver_(make_driver(type_of(method), tolerances)),
        reaching_(make_driver(gsl_odeiv2_step_rk8pd, tolerances)),
        between_(form.size()) {
    for (StepEnd* end : {&begin_, &end_}) {
      end->z.resize(form.size());
      end->rates.resize(form.size());
    }
    if (driver_->s->type == gsl_odeiv2_step_msbdf) bdf_check_.emplace(form.size());
    // Without a limit the driver would never end where the rates jump: its steps become ever smaller.
    gsl_odeiv2_driver_set_nmax(reaching_.get(), static_cast<unsigned long>(k_most_internal_steps));
  }

  void begin(double xi, std::span<const double> z) override {
    std::ranges::copy(z, end_.z.begin());
    begin_.xi = end_.xi = xi;
    are_rates_known_ = false;
    step_ = std::min(k_first_step, 1.0 - xi);
    gsl_odeiv2_driver_reset(driver_.get());
  }

  void correct(std::span<const double> z) override {
    if (driver_->s->type == gsl_odeiv2_step_rk8pd) std::ranges::copy(z, end_.z.begin());
  }

  double step() override {
    begin_ = end_;
    pending_.forget();
    for (;;) {
      double at = begin_.xi;
      const unsigned long rejected = driver_->e->failed_steps;
      const int status =
          gsl_odeiv2_evolve_apply(driver_->e, driver_->c, driver_->s, &system_, &at, 1.0, &step_, end_.z.data());
      rejections += static_cast<long>(driver_->e->failed_steps - rejected);
      pending_.rethrow();
      // GSL itself halves a step in which the equations end. A step this short has reached their end; later steps
      // would approach it without ever arriving.
      const bool has_arrived = at - begin_.xi < least_progress(begin_.xi) && pending_.domain_end();
      // A step is accepted only if the equations hold at its end, however small its error.
      const bool is_accepted = status == GSL_SUCCESS && at > begin_.xi && !has_arrived &&
                               rates(at, end_.z.data(), end_.rates.data(), this) == GSL_SUCCESS && !leads_elsewhere(at);
      pending_.rethrow();
      if (is_accepted) {
        end_.xi = at;
        are_rates_known_ = true;
        order = static_cast<int>(gsl_odeiv2_step_order(driver_->s));
        return at;
      }
      // The history of a multistep method may contain states from beyond the end of the equations.
      end_.z = begin_.z;
      gsl_odeiv2_driver_reset(driver_.get());
      step_ = 0.1 * std::min(step_, 1.0 - begin_.xi);
      ++rejections;
      if (step_ >= least_progress(begin_.xi)) continue;
      if (pending_.domain_end()) throw *pending_.domain_end();
      if (step_ < k_smallest_step * least_progress(begin_.xi))
        throw SolverError(Failure::no_step, begin_.xi, step_, {});
    }
  }

  void state_at(double xi, std::span<double> z) override {
    if (xi == end_.xi) {
      std::ranges::copy(end_.z, z.begin());
      return;
    }
    std::ranges::copy(begin_.z, between_.begin());
    double at = begin_.xi;
    reaching_->h = xi - begin_.xi;
    gsl_odeiv2_evolve_reset(reaching_->e);
    gsl_odeiv2_step_reset(reaching_->s);
    pending_.forget();
    if (xi > begin_.xi) {
      const int status = gsl_odeiv2_driver_apply(reaching_.get(), &at, xi, between_.data());
      pending_.rethrow();
      if (status != GSL_SUCCESS && pending_.domain_end()) throw *pending_.domain_end();
      if (status != GSL_SUCCESS) throw SolverError(Failure::no_step, at, 0.0, "a state within the step is not reached");
    }
    std::ranges::copy(between_, z.begin());
  }

 private:
  [[nodiscard]] bool leads_elsewhere(double end) {
    const auto jacobian_at_end = [&](double* by_z, double* by_xi) {
      return jacobian(end, end_.z.data(), by_z, by_xi, this);
    };
    return bdf_check_ && are_rates_known_ &&
           bdf_check_->leads_elsewhere(begin_, end_, end - begin_.xi, driver_->c, jacobian_at_end);
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
  StepEnd begin_, end_;  ///< of the last step
  std::vector<double> between_;
  bool are_rates_known_ = false;  ///< at the beginning of the step
  std::optional<BdfCheck> bdf_check_;
  double step_ = k_first_step;
};

}  // namespace

std::unique_ptr<Stepper> make_gsl(GslMethod method, ScaledForm& form, const Tolerances& tolerances) {
  return std::make_unique<GslStepper>(method, form, tolerances);
}

}  // namespace monograin
