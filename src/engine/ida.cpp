// The implicit form integrated by IDA.

#include <idas/idas.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "engine/sundials.hpp"
#include "engine/sundials_sensitivities.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

using namespace sundials_boundary;

struct IdaDeleter {
  void operator()(void* memory) const noexcept { IDAFree(&memory); }
};
using IdaMemory = std::unique_ptr<void, IdaDeleter>;

// Tolerance of dependent unknowns: loose, but small enough for difference quotients.
constexpr double k_dependent_tolerance = 1e-4;
// Share of a step's tolerance that the corrector may leave as an error: k_left_by_corrector, or up to
// k_most_left_by_corrector (the library's own) if round-off leaves more than the former. With the library's share, the
// differences of many steps show nothing but these errors: the order stays low, and steps do not become longer.
constexpr double k_left_by_corrector = 0.1;
constexpr double k_most_left_by_corrector = 0.33;
constexpr double k_left_by_round_off = 3e-14;
// Steps of order 1 in a row, each after a failed error test, after which the method is restarted: it would not rise to
// a higher order by itself. While steps are alike, differences of fast-changing unknowns do not show their errors; in a
// longer step they show all of them, and it fails.
constexpr int k_most_failing_steps = 10;

/// IDA's functions under the names that the parts shared with SundialsOde use.
struct IdaLibrary {
  static constexpr auto init_roots = IDARootInit;
  static constexpr auto set_root_direction = IDASetRootDirection;
  static constexpr auto set_no_inactive_root_warning = IDASetNoInactiveRootWarn;
  static constexpr auto root_info = IDAGetRootInfo;
  static constexpr auto steps = IDAGetNumSteps;
  static constexpr auto jacobian_evaluations = IDAGetNumJacEvals;
  static constexpr auto error_test_failures = IDAGetNumErrTestFails;
  static constexpr auto convergence_failures = IDAGetNumNonlinSolvConvFails;
  static constexpr auto last_step = IDAGetLastStep;
  static constexpr auto current_step = IDAGetCurrentStep;
  static constexpr auto error_weights = IDAGetErrWeights;
  static constexpr auto local_errors = IDAGetEstLocalErrors;
  static constexpr auto flag_name = IDAGetReturnFlagName;

  static int last_order(void* memory) {
    int order = 0;
    IDAGetLastOrder(memory, &order);
    return order;
  }
};

/// A state and its rates, as IDA integrates them.
struct DaeState {
  NVector y, dy;

  void take(const DaeState& other) {
    N_VScale(1.0, other.y.get(), y.get());
    N_VScale(1.0, other.dy.get(), dy.get());
  }
};

/// Tolerances of the unknowns in a step. The absolute ones rise in a segment to the round-off of xi times the rates: no
/// unknown is known better. Without this, tolerances are finer for an unknown that changes fast through zero, or ever
/// faster towards the end of the equations.
class RisingTolerances {
 public:
  /// @param tolerances  of a step
  RisingTolerances(const Tolerances& tolerances, std::span<const Unknown> unknowns, SUNContext context)
      : rtol_(tolerances.rtol),
        least_atol_(N_VNew_Serial(static_cast<sunindextype>(unknowns.size()), context)),
        atol_(unknowns.size()) {
    for (std::size_t k = 0; k < unknowns.size(); ++k) {
      // A dependent unknown has no error of its own: it has little weight, and is completed wherever it is used.
      const double absolute = unknowns[k].is_dependent ? k_dependent_tolerance : tolerances.atol;
      view(least_atol())[k] = std::max(absolute * unknowns[k].scale, k_above_round_off * unknowns[k].sum_scale);
    }
  }

  /// Starts a segment.
  void begin() { std::ranges::copy(view(least_atol()), atol_.begin()); }

  /// Residuals have the round-off of xi times the rates, too: it is divided by the share of a tolerance that the
  /// corrector may leave.
  void raise(std::span<const double> rates) {
    for (std::size_t k = 0; k < rates.size(); ++k) {
      const double round_off = k_round_off / k_left_by_corrector * std::abs(rates[k]);
      if (std::isfinite(round_off)) atol_[k] = std::max(atol_[k], round_off);
    }
  }

  /// Puts one over the tolerance of each unknown.
  void put_weights(std::span<const double> y, std::span<double> weights) const {
    for (std::size_t k = 0; k < y.size(); ++k) weights[k] = 1.0 / (rtol_ * std::abs(y[k]) + atol_[k]);
  }

  [[nodiscard]] N_Vector least_atol() const noexcept { return least_atol_.get(); }

 private:
  double rtol_;
  NVector least_atol_;
  std::vector<double> atol_;
};

/// Residuals that need no evaluation with sensitivities. The staggered method asks for the residual of a corrected
/// state, which only a new Jacobian may need. If such a residual had no value, the library would begin its next trial
/// without undoing this one (6.4.1).
class StaggeredResiduals {
 public:
  /// Notes that the library asks for a residual.
  /// @param end  step coordinate where the last step has ended
  /// @return true if the corrector has changed the state at the end of a trial since the last call
  bool ask(void* memory, double xi, double end) noexcept {
    long corrections = 0;
    IDAGetNumNonlinSolvIters(memory, &corrections);
    const bool is_asked_again = xi == xi_ && xi > end;
    xi_ = xi;
    is_left_out_ = std::exchange(corrections_, corrections) < corrections && is_asked_again;
    return is_left_out_;
  }
  /// True if the last residual needed no evaluation.
  [[nodiscard]] bool is_left_out() const noexcept { return is_left_out_; }

 private:
  double xi_ = 0.0;       ///< of the last call
  long corrections_ = 0;  ///< of states, up to that call
  bool is_left_out_ = false;
};

class Ida final : public Integrator {
 public:
  Ida(Equations& system, GuardSet& guard_set, const Tolerances& tolerances, ForwardSensitivities* sensitivities)
      : system_(system),
        quadratures_(system.unknowns()),
        complete_(system.unknowns().size()),
        roots_(guard_set, tolerances),
        tolerances_(of_step(tolerances), system.unknowns(), context_) {
    for (NVector* vector : {&state_.y, &state_.dy, &begin_.y, &begin_.dy, &between_}) {
      vector->reset(N_VClone(tolerances_.least_atol()));
      N_VConst(0.0, vector->get());
    }
    if (sensitivities != nullptr)
      carried_.emplace(*sensitivities, of_step(tolerances).rtol, tolerances_.least_atol(), false, context_);
    memory_.reset(IDACreate(context_));
    check("IDASetErrHandlerFn", IDASetErrHandlerFn(memory_.get(), ignore_message, nullptr));
    check("IDAInit", IDAInit(memory_.get(), residual, 0.0, state_.y.get(), state_.dy.get()));
    check("IDASetUserData", IDASetUserData(memory_.get(), this));
    check("IDAWFtolerances", IDAWFtolerances(memory_.get(), error_weights));
    check("IDASetMaxNumSteps", IDASetMaxNumSteps(memory_.get(), k_most_internal_steps));
    // If a segment starts at zero force, its first steps are smaller than IDA's guess by many orders of magnitude.
    check("IDASetMaxErrTestFails", IDASetMaxErrTestFails(memory_.get(), k_most_failures));
    const double left =
        std::clamp(k_left_by_round_off / tolerances.rtol, k_left_by_corrector, k_most_left_by_corrector);
    check("IDASetNonlinConvCoef", IDASetNonlinConvCoef(memory_.get(), left));
    check("IDASetMaxConvFails", IDASetMaxConvFails(memory_.get(), k_most_failures));
    std::ranges::transform(system.unknowns(), view(between_.get()).begin(),
                           [](const Unknown& unknown) { return unknown.is_algebraic_in_residual ? 0.0 : 1.0; });
    check("IDASetId", IDASetId(memory_.get(), between_.get()));  // the library copies it
    newton_ = make_dense_solver(state_.y.get(), context_);
    check("IDASetLinearSolver", IDASetLinearSolver(memory_.get(), newton_.solver.get(), newton_.matrix.get()));
    check("IDASetJacFn", IDASetJacFn(memory_.get(), jacobian));
  }

  void begin(double xi, std::span<const double> y) override {
    std::ranges::copy(y, view(state_.y.get()).begin());
    quadratures_.begin(view(state_.y.get()));
    system_.all_rates(xi, y, view(state_.dy.get()));
    tolerances_.begin();
    tolerances_.raise(view(state_.dy.get()));
    if (carried_) carried_->take_state(xi, y);
    start(xi, 0.0);
    last_length_ = 0.0;
    failing_steps_ = 0;
    ++past_.segments;
    // The system's own rates are consistent; IDACalcIC brings state and rates within the tolerance. If it cannot,
    // because the balance is singular (first touch), the first step shows whether they were consistent. IDACalcIC loses
    // vectors of sensitivities if a residual has no value: with them, the segment begins at the system's own state.
    if (!system_.is_semi_explicit() || carried_) return;
    pending_.forget();
    const int flag = IDACalcIC(memory_.get(), IDA_YA_YDP_INIT, 1.0);
    pending_.rethrow();
    if (flag < 0) start(xi, 0.0);
  }

  Advance advance() override {
    roots_.forget_fired();
    const double begin = end_;
    begin_.take(state_);
    if (carried_) carried_->keep();
    tolerances_.raise(view(state_.dy.get()));
    const auto restart = [&](double step) {
      state_.take(begin_);
      if (carried_) carried_->restore();
      start(begin, step);
    };
    const auto step_once = [&] {
      return step_within_domain(
          pending_, begin, [this] { return evolve(); },
          [this](double* step) { return IDAGetCurrentStep(memory_.get(), step); }, restart);
    };
    if (failing_steps_ == k_most_failing_steps) {
      failing_steps_ = 0;
      try {
        correct_begin(begin);
        restart(last_length_);
      } catch (const std::domain_error&) {
        // Next to the end of the equations the method goes on without a restart.
        N_VScale(1.0, state_.dy.get(), begin_.dy.get());
      }
    }
    const long failures = error_test_failures();
    int flag = step_once();
    if (flag < 0) {
      correct_begin(begin);
      restart(0.0);
      last_length_ = 0.0;
      flag = step_once();
    }
    check("IDASolve", flag);
    if (flag != IDA_ROOT_RETURN && is_stuck_at_end(pending_, begin, end_, last_length_)) {
      throw *pending_.nearest_domain_end();
    }
    last_length_ = end_ - begin;
    const bool is_failing = IdaLibrary::last_order(memory_.get()) == 1 && error_test_failures() > failures;
    failing_steps_ = is_failing ? failing_steps_ + 1 : 0;
    if (flag == IDA_ROOT_RETURN) {
      check("IDAGetRootInfo", roots_.collect<IdaLibrary>(memory_.get()));
      find_root(begin);
    } else if (flag == IDA_TSTOP_RETURN) {
      end_ = 1.0;
    }
    if (carried_) check("IDAGetSensDky", carried_->get(memory_.get(), end_));
    return {.xi = end_, .hit_guard = flag == IDA_ROOT_RETURN};
  }

  [[nodiscard]] std::span<const std::size_t> fired() const noexcept override { return roots_.fired(); }

  void dense_output(double xi, std::span<double> y) override {
    check("IDAGetDky", IDAGetDky(memory_.get(), xi, 0, between_.get()));
    std::ranges::copy(view(between_.get()), y.begin());
    quadratures_.add_to(y);
    system_.complete(xi, y);
  }

  void dense_sensitivities(double xi) override {
    if (carried_) check("IDAGetSensDky", carried_->put(memory_.get(), xi, end_));
  }

  [[nodiscard]] double guard_tolerance() const noexcept override { return roots_.tolerance(); }

  [[nodiscard]] Statistics statistics() const override {
    if (past_.segments == 0) return past_;
    Statistics now = counts_since_start<IdaLibrary>(memory_.get(), true);
    now += past_;
    now.rhs_evaluations = rhs_evaluations();
    return now;
  }

  [[nodiscard]] long rhs_evaluations() const override {
    if (past_.segments == 0) return 0;
    long of_segment = 0;
    IDAGetNumResEvals(memory_.get(), &of_segment);
    return past_.rhs_evaluations + of_segment;
  }

 private:
  [[nodiscard]] long error_test_failures() const {
    long failures = 0;
    IDAGetNumErrTestFails(memory_.get(), &failures);
    return failures;
  }

  static int error_weights(N_Vector y, N_Vector weights, void* self) noexcept {
    static_cast<const Ida*>(self)->tolerances_.put_weights(view(y), view(weights));
    return 0;
  }

  /// Replaces state and rates at the beginning of a step by the system's own. Next to a fold or a corner, those to
  /// which the steps have led may be so wrong that no corrector converges from them.
  void correct_begin(double xi) {
    const auto state = view(begin_.y.get());
    std::ranges::copy(state, complete_.begin());
    quadratures_.add_to(complete_);
    system_.complete(xi, complete_);
    system_.all_rates(xi, complete_, view(begin_.dy.get()));
    for (std::size_t k = 0; k < state.size(); ++k) {
      if (system_.unknowns()[k].kind != Unknown::Kind::quadrature) state[k] = complete_[k];
    }
    if (carried_) carried_->correct_begin(xi, complete_);
  }

  /// Restarts IDA at xi with state_. @param step  first step to try; 0: the library's choice
  void start(double xi, double step) {
    past_ = statistics();  // counters are reset with the state
    end_ = xi;
    check("IDAReInit", IDAReInit(memory_.get(), xi, state_.y.get(), state_.dy.get()));
    check("IDASetInitStep", IDASetInitStep(memory_.get(), step));
    check("IDASetStopTime", IDASetStopTime(memory_.get(), 1.0));
    if (carried_) check("IDASensInit", carried_->start(memory_.get(), residual_of_sensitivities));
    check("IDARootInit", roots_.list<IdaLibrary>(memory_.get(), guards));
  }

  /// Moves the end of the step to where a guard crosses zero.
  void find_root(double begin) {
    const auto values_at = [this](double xi, std::span<double> values) {
      ++past_.guard_evaluations;
      dense_output(xi, complete_);
      roots_.values(xi, complete_, values.data());
    };
    end_ = roots_.locate(begin, end_, values_at);
  }

  int evolve() {
    const int flag = IDASolve(memory_.get(), 1.0, &end_, state_.y.get(), state_.dy.get(), IDA_ONE_STEP);
    pending_.rethrow();
    return flag;
  }

  static int residual(realtype xi, N_Vector y, N_Vector dy, N_Vector res, void* self) noexcept {
    auto& ida = *static_cast<Ida*>(self);
    const bool is_left_out = ida.carried_ && ida.staggered_.ask(ida.memory_.get(), xi, ida.end_);
    return is_left_out ? 0 : ida.evaluate(xi, y, dy, res);
  }

  int evaluate(double xi, N_Vector y, N_Vector dy, N_Vector res) noexcept {
    return pending_.guard([&] {
      system_.residual(xi, view(y), view(dy), view(res));
      return all_finite(view(res));
    });
  }

  static int residual_of_sensitivities(int count, realtype xi, N_Vector y, N_Vector dy, N_Vector, N_Vector* s,
                                       N_Vector* ds, N_Vector* res, void* self, N_Vector, N_Vector, N_Vector) noexcept {
    auto& ida = *static_cast<Ida*>(self);
    return ida.pending_.guard([&] {
      for (int k = 0; k < count; ++k) {
        ida.carried_->of().residual(static_cast<std::size_t>(k), xi, view(y), view(dy), view(s[k]), view(ds[k]),
                                    view(res[k]));
        if (!all_finite(view(res[k]))) return false;
      }
      return true;
    });
  }

  /// d(residual)/dy + cj d(residual)/dy' by difference quotients. The library's own uses increments of at least the
  /// tolerance; if tolerances are loose, a law need not be smooth over them.
  static int jacobian(realtype xi, realtype cj, N_Vector y, N_Vector dy, N_Vector res, SUNMatrix matrix, void* self,
                      N_Vector shifted, N_Vector weights, N_Vector) noexcept {
    static const double k_root = std::sqrt(k_epsilon);
    auto& ida = *static_cast<Ida*>(self);
    double step = 0.0;
    if (IDAGetCurrentStep(ida.memory_.get(), &step) != IDA_SUCCESS ||
        IDAGetErrWeights(ida.memory_.get(), weights) != IDA_SUCCESS) {
      return -1;
    }
    if (ida.staggered_.is_left_out()) {
      ++ida.past_.rhs_evaluations;
      if (const int flag = ida.evaluate(xi, y, dy, res); flag != 0) return flag;
    }
    const auto values = view(y);
    const auto rates = view(dy);
    const auto unknowns = ida.system_.unknowns();
    for (std::size_t j = 0; j < values.size(); ++j) {
      const double value = values[j];
      const double rate = rates[j];
      const double tolerated = std::min(1.0 / view(weights)[j], k_root * unknowns[j].scale);
      const double size = std::max(k_root * std::max(std::abs(value), std::abs(step * rate)), tolerated);
      double increment = 0.0;
      const int flag = ida.pending_.guard([&] {
        shift_within_domain(std::copysign(size, step * rate), [&](double by) {
          values[j] = value + by;
          increment = values[j] - value;  // as rounded in the sum
          rates[j] = rate + cj * increment;
          ++ida.past_.rhs_evaluations;
          ida.pending_.beside([&] { ida.system_.residual(xi, values, rates, view(shifted)); });
        });
        return all_finite(view(shifted));
      });
      values[j] = value;
      rates[j] = rate;
      if (flag != 0) return flag;
      const auto now = view(shifted);
      const auto before = view(res);
      realtype* const column = SUNDenseMatrix_Column(matrix, static_cast<sunindextype>(j));
      for (std::size_t i = 0; i < now.size(); ++i) column[i] = (now[i] - before[i]) / increment;
    }
    return 0;
  }

  static int guards(realtype xi, N_Vector y, N_Vector, realtype* values, void* self) noexcept {
    auto& ida = *static_cast<Ida*>(self);
    ++ida.past_.guard_evaluations;
    return ida.pending_.guard([&] {
      std::ranges::copy(view(y), ida.complete_.begin());
      // Without completing, a free centre that idle contacts move would lag behind them, and errors alone would close
      // contacts.
      ida.system_.complete(xi, ida.complete_);
      ida.roots_.values(xi, ida.complete_, values);
      return true;
    });
  }

  void check(const char* call, int flag) {
    if (flag < 0) give_up<IdaLibrary>(call, flag, memory_.get(), state_.y.get(), system_.unknowns(), end_);
  }

  Equations& system_;
  SegmentQuadratures quadratures_;
  std::vector<double> complete_;
  Pending pending_;
  RootFunctions roots_;
  double end_ = 0.0;
  double last_length_ = 0.0;  ///< length of the last step of this segment; 0 before the first
  int failing_steps_ = 0;     ///< steps of order 1 in a row, each after a failed error test
  Statistics past_;           ///< counts up to the last start, and those that the library does not keep
  StaggeredResiduals staggered_;

  sundials::Context context_;  // first in, last out
  RisingTolerances tolerances_;
  DaeState state_;
  DaeState begin_;   ///< where the last step began
  NVector between_;  ///< a state within the last step
  DenseSolver newton_;
  std::optional<SundialsSensitivities<IdasCalls>> carried_;
  IdaMemory memory_;
};

}  // namespace

std::unique_ptr<Integrator> make_ida(Equations& system, GuardSet& guard_set, const Tolerances& tolerances,
                                     ForwardSensitivities* sensitivities) {
  return std::make_unique<Ida>(system, guard_set, tolerances, sensitivities);
}

}  // namespace monograin
