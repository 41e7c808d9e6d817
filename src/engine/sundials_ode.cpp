// The explicit form integrated by CVODE and ARKODE, which share everything but the names of their functions.

#include <arkode/arkode_arkstep.h>
#include <cvodes/cvodes.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "engine/forward_sensitivities.hpp"
#include "engine/sundials.hpp"
#include "engine/sundials_sensitivities.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

using namespace sundials_boundary;

// Longest step of the implicit method. Its estimate of a quadrature's error is too small for long steps: without this
// bound the work of an elastic sphere has an error of 500 rtol, with it 55 rtol.
constexpr double k_longest_implicit_step = 1.0 / 32.0;

// If states within a step come from a polynomial through the last steps, a step of that longest length keeps the rtol
// k_interpolated_rtol. The error estimate does not include the polynomial's error, which is proportional to the length
// to the power k_order_between_steps. Stiff equations keep steps short by themselves: few corrections do not converge.
constexpr double k_interpolated_rtol = 1e-6;
constexpr double k_order_between_steps = 6.0;

// Least factor between successive estimates of the rate at which the implicit method's corrections converge. By itself
// the estimate falls with every stage while steps are alike. After a change of their length, a first correction far
// above the tolerance is then taken for the last one, and the error estimate does not show it. With 1, the last
// correction itself is below the tolerance. If the Jacobian is that of an earlier step, the library's limit of 3
// corrections may be too small.
constexpr double k_least_convergence_rate = 1.0;
constexpr int k_most_corrections = 10;

/// CVODE's functions under the names that SundialsOde uses.
struct CvodeLibrary {
  static constexpr const char* name = "CVode";
  static constexpr int root_return = CV_ROOT_RETURN;
  static constexpr int stop_return = CV_TSTOP_RETURN;
  static constexpr int one_step = CV_ONE_STEP;
  static constexpr auto free = CVodeFree;
  static constexpr auto set_error_handler = CVodeSetErrHandlerFn;
  static constexpr auto set_user_data = CVodeSetUserData;
  static constexpr auto set_weights = CVodeWFtolerances;
  static constexpr auto set_most_steps = CVodeSetMaxNumSteps;
  static constexpr auto set_most_failures = CVodeSetMaxErrTestFails;
  static constexpr auto set_linear_solver = CVodeSetLinearSolver;
  static constexpr auto set_jacobian = CVodeSetJacFn;
  static constexpr auto set_jacobian_frequency = CVodeSetJacEvalFrequency;
  static constexpr auto set_stop_time = CVodeSetStopTime;
  static constexpr auto set_first_step = CVodeSetInitStep;
  static constexpr auto init_roots = CVodeRootInit;
  static constexpr auto set_root_direction = CVodeSetRootDirection;
  static constexpr auto set_no_inactive_root_warning = CVodeSetNoInactiveRootWarn;
  static constexpr auto evolve = CVode;
  static constexpr auto root_info = CVodeGetRootInfo;
  static constexpr auto derivative = CVodeGetDky;
  static constexpr auto steps = CVodeGetNumSteps;
  static constexpr auto jacobian_evaluations = CVodeGetNumJacEvals;
  static constexpr auto error_test_failures = CVodeGetNumErrTestFails;
  static constexpr auto convergence_failures = CVodeGetNumNonlinSolvConvFails;
  static constexpr auto last_step = CVodeGetLastStep;
  static constexpr auto current_step = CVodeGetCurrentStep;
  static constexpr auto current_gamma = CVodeGetCurrentGamma;
  static constexpr auto error_weights = CVodeGetErrWeights;
  static constexpr auto local_errors = CVodeGetEstLocalErrors;
  static constexpr auto flag_name = CVodeGetReturnFlagName;

  static int reinit(void* memory, OdeMethod, CVRhsFn, realtype xi, N_Vector y) { return CVodeReInit(memory, xi, y); }
  static long rhs_evaluations(void* memory) {
    long count = 0;
    CVodeGetNumRhsEvals(memory, &count);
    return count;
  }
  static int last_order(void* memory) {
    int order = 0;
    CVodeGetLastOrder(memory, &order);
    return order;
  }
};

/// ARKODE's functions under the names that SundialsOde uses: its additive Runge-Kutta module with one of the two parts.
struct ArkodeLibrary {
  static constexpr const char* name = "ARKStepEvolve";
  static constexpr int root_return = ARK_ROOT_RETURN;
  static constexpr int stop_return = ARK_TSTOP_RETURN;
  static constexpr int one_step = ARK_ONE_STEP;
  static constexpr auto free = ARKStepFree;
  static constexpr auto set_error_handler = ARKStepSetErrHandlerFn;
  static constexpr auto set_user_data = ARKStepSetUserData;
  static constexpr auto set_weights = ARKStepWFtolerances;
  static constexpr auto set_most_steps = ARKStepSetMaxNumSteps;
  static constexpr auto set_most_failures = ARKStepSetMaxErrTestFails;
  static constexpr auto set_linear_solver = ARKStepSetLinearSolver;
  static constexpr auto set_jacobian = ARKStepSetJacFn;
  static constexpr auto set_jacobian_frequency = ARKStepSetJacEvalFrequency;
  static constexpr auto set_stop_time = ARKStepSetStopTime;
  static constexpr auto set_first_step = ARKStepSetInitStep;
  static constexpr auto init_roots = ARKStepRootInit;
  static constexpr auto set_root_direction = ARKStepSetRootDirection;
  static constexpr auto set_no_inactive_root_warning = ARKStepSetNoInactiveRootWarn;
  static constexpr auto evolve = ARKStepEvolve;
  static constexpr auto root_info = ARKStepGetRootInfo;
  static constexpr auto derivative = ARKStepGetDky;
  static constexpr auto steps = ARKStepGetNumSteps;
  static constexpr auto jacobian_evaluations = ARKStepGetNumJacEvals;
  static constexpr auto error_test_failures = ARKStepGetNumErrTestFails;
  static constexpr auto convergence_failures = ARKStepGetNumNonlinSolvConvFails;
  static constexpr auto last_step = ARKStepGetLastStep;
  static constexpr auto current_step = ARKStepGetCurrentStep;
  static constexpr auto current_gamma = ARKStepGetCurrentGamma;
  static constexpr auto error_weights = ARKStepGetErrWeights;
  static constexpr auto local_errors = ARKStepGetEstLocalErrors;
  static constexpr auto flag_name = ARKStepGetReturnFlagName;
  static constexpr int order = 5;  // highest order that the interpolation keeps

  static int reinit(void* memory, OdeMethod method, ARKRhsFn rates, realtype xi, N_Vector y) {
    const bool is_implicit = method == OdeMethod::arkode_dirk;
    return ARKStepReInit(memory, is_implicit ? nullptr : rates, is_implicit ? rates : nullptr, xi, y);
  }
  static long rhs_evaluations(void* memory) {
    long of_explicit = 0;
    long of_implicit = 0;
    ARKStepGetNumRhsEvals(memory, &of_explicit, &of_implicit);
    return of_explicit + of_implicit;
  }
  static int last_order(void*) { return order; }
};

/// Error weights of the explicit form: one over the tolerance of each unknown, which is no finer than the round-off of
/// xi times the rates. If a contact lasts hardly longer than that round-off, the errors of stages are of its size, and
/// no step would keep finer tolerances.
class ErrorWeights {
 public:
  /// @param tolerances  of a step
  ErrorWeights(const Tolerances& tolerances, const ExplicitForm& form, SUNContext context)
      : rtol_(tolerances.rtol),
        atol_(N_VNew_Serial(static_cast<sunindextype>(form.size()), context)),
        rates_(form.size()),
        first_rates_(form.size()) {
    for (std::size_t k = 0; k < form.size(); ++k) view(atol_.get())[k] = tolerances.atol * form.unknown(k).scale;
  }

  /// Starts at xi. The rates one round-off of xi after the start count for the first step: if a contact is as shallow
  /// as that round-off, its rates at first touch are negligible beside those at the next representable xi.
  void start(ExplicitForm& form, double xi, std::span<const double> y) {
    std::ranges::fill(rates_, 0.0);  // rates of an earlier mode do not count
    start_end_ = std::min(1.0, xi * (1.0 + k_round_off));
    try {
      form.rates_aside(start_end_, y, first_rates_);
      if (all_finite(first_rates_)) return;
    } catch (const std::domain_error&) {
    }
    std::ranges::fill(first_rates_, 0.0);
  }

  /// Takes the rates for which the library has asked last.
  void take_rates(std::span<const double> rates) { std::ranges::copy(rates, rates_.begin()); }

  /// Round-off of unknown k that comes from the round-off of xi.
  [[nodiscard]] double round_off(std::size_t k) const noexcept { return k_round_off * std::abs(rates_[k]); }

  /// Puts the weights at y. @param end  step coordinate where the last step has ended
  void put(std::span<const double> y, double end, std::span<double> weights) const {
    const bool is_first = end <= start_end_;
    for (std::size_t k = 0; k < y.size(); ++k) {
      const double tolerated = rtol_ * std::abs(y[k]) + view(atol_.get())[k];
      const double first = is_first ? std::abs(first_rates_[k]) : 0.0;
      weights[k] = 1.0 / std::max(tolerated, k_round_off * std::max(first, std::abs(rates_[k])));
    }
  }

  [[nodiscard]] double rtol() const noexcept { return rtol_; }
  [[nodiscard]] N_Vector atol() const noexcept { return atol_.get(); }

 private:
  double rtol_;
  NVector atol_;
  double start_end_ = 0.0;  ///< one round-off of xi beyond the start
  std::vector<double> rates_;
  std::vector<double> first_rates_;  ///< at start_end_
};

template <class Library>
class SundialsOde final : public Integrator {
 public:
  SundialsOde(OdeMethod method, Equations& system, GuardSet& guard_set, const Tolerances& tolerances,
              ForwardSensitivities* sensitivities)
      : method_(method),
        tolerances_(tolerances),
        form_(system),
        roots_(guard_set, tolerances),
        weights_(of_step(tolerances, method == OdeMethod::cvode_bdf ? k_share_of_many : k_usual_share), form_,
                 context_) {
    for (NVector* vector : {&y_, &step_begin_.y, &between_}) vector->reset(N_VClone(weights_.atol()));
    N_VConst(0.0, y_.get());
    if (method_ == OdeMethod::cvode_bdf || method_ == OdeMethod::arkode_dirk)
      newton_ = make_dense_solver(y_.get(), context_);
    if (sensitivities != nullptr) {
      carried_.emplace(*sensitivities, weights_.rtol(), weights_.atol(), method_ == OdeMethod::cvode_adams, context_);
    }
    set_up();
  }

  void begin(double xi, std::span<const double> y) override {
    form_.begin(y, view(y_.get()));
    segment_begin_.xi = xi;
    segment_begin_.state.assign(y.begin(), y.end());
    if (carried_) carried_->take_state(xi, y);
    start(xi, 0.0);
    last_length_ = 0.0;
    ++past_.segments;
  }

  Advance advance() override {
    roots_.forget_fired();
    const double begin = end_;
    N_VScale(1.0, y_.get(), step_begin_.y.get());
    if (carried_) carried_->keep();
    // Trials of a failed step may leave a first guess from which other solutions are found.
    step_begin_.guess.assign(form_.guess().begin(), form_.guess().end());
    const auto restart = [&](double step) {
      N_VScale(1.0, step_begin_.y.get(), y_.get());
      if (carried_) carried_->restore();
      form_.guess(step_begin_.guess);
      start(begin, step);
    };
    if (corrects_begin()) {
      restart(0.0);
      last_length_ = 0.0;
    }
    const int flag = step_within_domain(
        pending_, begin, [this] { return evolve(); },
        [this](double* step) { return Library::current_step(memory_.get(), step); }, restart);
    check(Library::name, flag);
    if (flag != Library::root_return && is_stuck_at_end(pending_, begin, end_, last_length_)) {
      throw *pending_.nearest_domain_end();
    }
    last_length_ = end_ - begin;
    if (flag == Library::root_return) {
      check("GetRootInfo", roots_.template collect<Library>(memory_.get()));
      find_root(begin);
    } else if (flag == Library::stop_return) {
      end_ = 1.0;
    }
    if (carried_) check("GetSens", carried_->get(memory_.get(), end_));
    return {.xi = end_, .hit_guard = flag == Library::root_return};
  }

  [[nodiscard]] std::span<const std::size_t> fired() const noexcept override { return roots_.fired(); }

  void dense_output(double xi, std::span<double> y) override {
    // Interpolation may evaluate rates beside the curve, where they may not exist: the end of the step needs none.
    const bool is_at_end = xi == end_;
    if (!is_at_end) check("GetDky", Library::derivative(memory_.get(), xi, 0, between_.get()));
    form_.complete(xi, view((is_at_end ? y_ : between_).get()), y);
  }

  void dense_sensitivities(double xi) override {
    if (carried_) check("GetSens", carried_->put(memory_.get(), xi, end_));
  }

  [[nodiscard]] double guard_tolerance() const noexcept override { return roots_.tolerance(); }

  [[nodiscard]] Statistics statistics() const override {
    if (past_.segments == 0) return past_;
    Statistics now = counts_since_start<Library>(memory_.get(), newton_.solver != nullptr);
    now += past_;
    now.rhs_evaluations = rhs_evaluations();
    return now;
  }

  [[nodiscard]] long rhs_evaluations() const override {
    if (past_.segments == 0) return 0;
    return past_.rhs_evaluations + Library::rhs_evaluations(memory_.get());
  }

 private:
  struct Deleter {
    void operator()(void* memory) const noexcept { Library::free(&memory); }
  };

  void create();

  void set_up() {
    create();
    check("SetErrHandlerFn", Library::set_error_handler(memory_.get(), ignore_message, nullptr));
    check("SetUserData", Library::set_user_data(memory_.get(), this));
    check("WFtolerances", Library::set_weights(memory_.get(), error_weights));
    check("SetMaxNumSteps", Library::set_most_steps(memory_.get(), k_most_internal_steps));
    check("SetMaxErrTestFails", Library::set_most_failures(memory_.get(), k_most_failures));
    if (!newton_.solver) return;
    check("SetLinearSolver", Library::set_linear_solver(memory_.get(), newton_.solver.get(), newton_.matrix.get()));
    check("SetJacFn", Library::set_jacobian(memory_.get(), jacobian));
    // With a Jacobian from a singular start, Newton's corrections are far too small and are taken for convergence.
    check("SetJacEvalFrequency", Library::set_jacobian_frequency(memory_.get(), 1));
  }

  /// Restarts the library at xi with the state in y_. @param step  first step to try; 0: the library's choice
  void start(double xi, double step) {
    past_ = statistics();  // counters are reset with the state
    end_ = xi;
    ++past_.rhs_evaluations;
    weights_.start(form_, xi, view(y_.get()));
    check("ReInit", Library::reinit(memory_.get(), method_, right_hand_side, xi, y_.get()));
    check("SetInitStep", Library::set_first_step(memory_.get(), step));
    check("SetStopTime", Library::set_stop_time(memory_.get(), 1.0));
    if (carried_) check("SensInit", carried_->start(memory_.get(), rates_of_sensitivity));
    check("RootInit", roots_.template list<Library>(memory_.get(), guards));
  }

  /// Moves the end of the step to where a guard crosses zero.
  void find_root(double begin) {
    const auto values_at = [this](double xi, std::span<double> values) {
      // Interpolation may evaluate rates beside the curve, where they may not exist.
      pending_.forget();
      const int flag = Library::derivative(memory_.get(), xi, 0, between_.get());
      if (flag < 0 && pending_.domain_end()) throw *pending_.domain_end();
      check("GetDky", flag);
      ++past_.guard_evaluations;
      roots_.values(xi, form_.complete(xi, view(between_.get())), values.data());
    };
    const double root = roots_.locate(begin, end_, values_at);
    if (root == end_) return;
    end_ = root;
    check("GetDky", Library::derivative(memory_.get(), end_, 0, y_.get()));
  }

  int evolve() {
    const int flag = Library::evolve(memory_.get(), 1.0, y_.get(), &end_, Library::one_step);
    pending_.rethrow();
    return flag;
  }

  static int right_hand_side(realtype xi, N_Vector y, N_Vector dy, void* self) noexcept {
    auto& ode = *static_cast<SundialsOde*>(self);
    return ode.pending_.guard([&] {
      ode.form_.rates(xi, view(y), view(dy));
      if (!all_finite(view(dy))) return false;
      ode.weights_.take_rates(view(dy));
      return true;
    });
  }

  static int rates_of_sensitivity(int, realtype xi, N_Vector y, N_Vector, int number, N_Vector s, N_Vector ds,
                                  void* self, N_Vector, N_Vector) noexcept {
    auto& ode = *static_cast<SundialsOde*>(self);
    return ode.pending_.guard([&] {
      ode.carried_->of().rates(static_cast<std::size_t>(number), xi, view(y), ode.form_.guess(), view(s), view(ds));
      return all_finite(view(ds));
    });
  }

  /// Moves the end of a step to the completed state, where the next step begins.
  static int corrected(realtype xi, N_Vector y, void* self) noexcept {
    auto& ode = *static_cast<SundialsOde*>(self);
    return ode.pending_.guard([&] {
      static_cast<void>(ode.form_.take_correction(ode.form_.complete(xi, view(y)), view(y)));
      return true;
    });
  }

  /// Corrects the beginning of a step of BDF, once its error exceeds the tolerance of the curve. The method restarts
  /// after a correction, with the errors of first steps, and smaller corrections would restart it all the time. Adams'
  /// method is not corrected: it gains nothing where it is slow, at the stiff ends of segments on a yield surface.
  /// @return true if step_begin_.y has changed
  bool corrects_begin() {
    if (method_ != OdeMethod::cvode_bdf || !form_.has_corrections()) return false;
    N_VScale(1.0, step_begin_.y.get(), between_.get());
    if (corrected(end_, between_.get(), this) != 0) return false;
    const auto state = view(step_begin_.y.get());
    const auto better = view(between_.get());
    bool is_off = false;
    for (std::size_t k = 0; k < state.size(); ++k) {
      const double size = std::max(std::abs(state[k]), form_.unknown(k).scale);
      // Where the round-off of xi is the tolerance of a step, the limit is the same multiple of it as elsewhere.
      const double tolerated = std::max(tolerances_.rtol * size, weights_.round_off(k) / k_share_of_many);
      is_off = is_off || std::abs(better[k] - state[k]) > tolerated;
    }
    if (is_off) std::ranges::copy(better, state.begin());
    return is_off;
  }

  [[nodiscard]] double change_of_rates(std::span<const double> before, std::span<const double> after) const {
    return monograin::change_of_rates(before, after, [this](std::size_t i) { return form_.unknown(i).scale; });
  }

  /// Evaluates the rates with the opposite increment and keeps the side on which they change less.
  /// @return the increment of that side
  template <class Shift>
  double take_gentler_side(double increment, std::span<const double> before, N_Vector shifted, Shift&& shift) const {
    const double change = change_of_rates(before, view(shifted));
    try {
      shift(-increment);
      if (change_of_rates(before, view(shifted)) < change) return -increment;
    } catch (const std::domain_error&) {
    }
    shift(increment);
    return increment;
  }

  /// d(rates)/dy by difference quotients, like the library's own except for two kinds of increments: those that leave
  /// the domain are shortened, and that of an unknown that begins at zero is as large as its change in the step, up to
  /// its tolerance. Rates of the work may rise there like a square root, and a much smaller increment shows no slope
  /// that the step could use.
  static int jacobian(realtype xi, N_Vector y, N_Vector dy, SUNMatrix matrix, void* self, N_Vector shifted,
                      N_Vector weights, N_Vector) noexcept {
    static const double k_root = std::sqrt(k_epsilon);
    auto& ode = *static_cast<SundialsOde*>(self);
    double gamma = 0.0;  // step length times the coefficient of the method
    if (Library::current_gamma(ode.memory_.get(), &gamma) != 0 ||
        Library::error_weights(ode.memory_.get(), weights) != 0) {
      return -1;
    }
    const auto values = view(y);
    const auto before = view(dy);
    const double norm = N_VWrmsNorm(dy, weights);
    constexpr double k_increment_ratio = 1e3;  // over the round-off, as in the library
    const double round_off =
        k_increment_ratio * k_epsilon * static_cast<double>(values.size()) * std::abs(gamma) * norm;
    const double least = norm > 0.0 ? round_off : 1.0;
    for (std::size_t j = 0; j < values.size(); ++j) {
      const double value = values[j];
      const double tolerated = 1.0 / view(weights)[j];
      const double in_step = std::min(std::abs(gamma * before[j]), tolerated);
      double increment = std::max({k_root * std::abs(value), least * tolerated, in_step});
      const int flag = ode.pending_.guard([&] {
        const auto shift = [&](double by) {
          values[j] = value + by;
          ++ode.past_.rhs_evaluations;
          ode.pending_.beside([&] { ode.form_.rates(xi, values, view(shifted)); });
        };
        increment = shift_within_domain(increment, shift);
        if (ode.change_of_rates(before, view(shifted)) > k_jump)
          increment = ode.take_gentler_side(increment, before, shifted, shift);
        return all_finite(view(shifted));
      });
      values[j] = value;
      if (flag != 0) return flag;
      realtype* const column = SUNDenseMatrix_Column(matrix, static_cast<sunindextype>(j));
      for (std::size_t i = 0; i < before.size(); ++i) column[i] = (view(shifted)[i] - before[i]) / increment;
    }
    return 0;
  }

  static int error_weights(N_Vector y, N_Vector weights, void* self) noexcept {
    const auto& ode = *static_cast<SundialsOde*>(self);
    ode.weights_.put(view(y), ode.end_, view(weights));
    return 0;
  }

  /// Evaluates the guards. At the beginning of the segment they get the state that begin() was given. Completing it
  /// again, from a guess that trial steps have moved, would give an idle contact an overlap of round-off, and miss a
  /// condition that is met exactly there.
  static int guards(realtype xi, N_Vector y, realtype* values, void* self) noexcept {
    auto& ode = *static_cast<SundialsOde*>(self);
    ++ode.past_.guard_evaluations;
    return ode.pending_.guard([&] {
      const SegmentBegin& begin = ode.segment_begin_;
      ode.roots_.values(xi, xi == begin.xi ? begin.state : ode.form_.complete(xi, view(y)), values);
      return true;
    });
  }

  void check(const char* call, int flag) {
    if (flag < 0) give_up<Library>(call, flag, memory_.get(), y_.get(), form_.unknowns(), end_);
  }

  struct SegmentBegin {
    double xi = 0.0;
    std::vector<double> state;  ///< complete
  };
  struct StepBegin {
    NVector y;
    std::vector<double> guess;  ///< first guess of complete states
  };

  OdeMethod method_;
  Tolerances tolerances_;
  ExplicitForm form_;
  Pending pending_;
  RootFunctions roots_;
  double end_ = 0.0;
  double last_length_ = 0.0;  ///< length of the last step of this segment; 0 before the first
  Statistics past_;           ///< counts up to the last start, and those that the library does not keep
  SegmentBegin segment_begin_;

  sundials::Context context_;  // first in, last out
  NVector y_;
  StepBegin step_begin_;  ///< where the last step began
  NVector between_;       ///< a state within the last step
  ErrorWeights weights_;
  DenseSolver newton_;         ///< of implicit methods with Newton's corrector
  NonlinearSolver nonlinear_;  ///< of Adams' method
  std::optional<SundialsSensitivities<CvodesCalls>> carried_;
  std::unique_ptr<void, Deleter> memory_;
};

template <>
void SundialsOde<CvodeLibrary>::create() {
  const bool is_adams = method_ == OdeMethod::cvode_adams;
  memory_.reset(CVodeCreate(is_adams ? CV_ADAMS : CV_BDF, context_));
  check("CVodeInit", CVodeInit(memory_.get(), right_hand_side, 0.0, y_.get()));
  if (!is_adams) return;
  nonlinear_.reset(SUNNonlinSol_FixedPoint(y_.get(), 0, context_));
  check("CVodeSetNonlinearSolver", CVodeSetNonlinearSolver(memory_.get(), nonlinear_.get()));
}

template <>
void SundialsOde<ArkodeLibrary>::create() {
  const bool is_implicit = method_ == OdeMethod::arkode_dirk;
  memory_.reset(ARKStepCreate(is_implicit ? nullptr : right_hand_side, is_implicit ? right_hand_side : nullptr, 0.0,
                              y_.get(), context_));
  if (!memory_) throw SolverError(Failure::set_up, end_, 0.0, {}, "ARKStepCreate: no memory");
  check("ARKStepSetOrder", ARKStepSetOrder(memory_.get(), ArkodeLibrary::order));
  if (form_.has_corrections()) {
    check("ARKStepSetPostprocessStepFn", ARKStepSetPostprocessStepFn(memory_.get(), corrected));
    // Rates at a corrected state contain the correction times a stiffness that may be large: the implicit method
    // interpolates without rates.
    const int type = is_implicit ? ARK_INTERP_LAGRANGE : ARK_INTERP_HERMITE;
    check("ARKStepSetInterpolantType", ARKStepSetInterpolantType(memory_.get(), type));
  }
  if (!is_implicit) return;
  check("ARKStepSetNonlinCRDown", ARKStepSetNonlinCRDown(memory_.get(), k_least_convergence_rate));
  double longest = k_longest_implicit_step;
  if (form_.has_corrections()) {
    longest *= std::min(1.0, std::pow(tolerances_.rtol / k_interpolated_rtol, 1.0 / k_order_between_steps));
  } else {
    check("ARKStepSetMaxNonlinIters", ARKStepSetMaxNonlinIters(memory_.get(), k_most_corrections));
  }
  check("ARKStepSetMaxStep", ARKStepSetMaxStep(memory_.get(), longest));
}

}  // namespace

std::unique_ptr<Integrator> make_sundials_ode(OdeMethod method, Equations& system, GuardSet& guard_set,
                                              const Tolerances& tolerances, ForwardSensitivities* sensitivities) {
  if (method == OdeMethod::cvode_adams || method == OdeMethod::cvode_bdf) {
    return std::make_unique<SundialsOde<CvodeLibrary>>(method, system, guard_set, tolerances, sensitivities);
  }
  return std::make_unique<SundialsOde<ArkodeLibrary>>(method, system, guard_set, tolerances, nullptr);
}

}  // namespace monograin
