// The implicit form integrated by IDA.

#include <fmt/format.h>
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

class Ida final : public Integrator {
 public:
  Ida(Equations& system, GuardSet& guard_set, const Tolerances& tolerances, ForwardSensitivities* sensitivities)
      : system_(system), guard_set_(guard_set), tolerances_(tolerances), quadratures_(system.unknowns()) {
    const auto unknowns = system.unknowns();
    const auto size = static_cast<sunindextype>(unknowns.size());
    for (NVector* vector : {&y_, &dy_, &begin_state_, &begin_rates_, &id_, &least_atol_, &atol_, &weights_, &errors_}) {
      vector->reset(N_VNew_Serial(size, context_));
    }
    complete_.resize(unknowns.size());
    N_VConst(0.0, y_.get());
    N_VConst(0.0, dy_.get());
    for (std::size_t k = 0; k < unknowns.size(); ++k) {
      // A dependent unknown has no error of its own: it has little weight, and is completed wherever it is used.
      const double absolute = unknowns[k].is_dependent ? k_dependent_tolerance : of_step(tolerances).atol;
      view(least_atol_.get())[k] = std::max(absolute * unknowns[k].scale, k_above_round_off * unknowns[k].sum_scale);
      view(id_.get())[k] = unknowns[k].is_algebraic_in_residual ? 0.0 : 1.0;
    }
    if (sensitivities != nullptr) {
      carried_.emplace(*sensitivities, of_step(tolerances).rtol, least_atol_.get(), false, context_);
    }
    memory_.reset(IDACreate(context_));
    check("IDASetErrHandlerFn", IDASetErrHandlerFn(memory_.get(), ignore_message, nullptr));
    check("IDAInit", IDAInit(memory_.get(), residual, 0.0, y_.get(), dy_.get()));
    check("IDASetUserData", IDASetUserData(memory_.get(), this));
    check("IDAWFtolerances", IDAWFtolerances(memory_.get(), error_weights));
    check("IDASetMaxNumSteps", IDASetMaxNumSteps(memory_.get(), k_most_internal_steps));
    // If a segment starts at zero force, its first steps are smaller than IDA's guess by many orders of magnitude.
    check("IDASetMaxErrTestFails", IDASetMaxErrTestFails(memory_.get(), k_most_failures));
    const double left =
        std::clamp(k_left_by_round_off / tolerances.rtol, k_left_by_corrector, k_most_left_by_corrector);
    check("IDASetNonlinConvCoef", IDASetNonlinConvCoef(memory_.get(), left));
    check("IDASetMaxConvFails", IDASetMaxConvFails(memory_.get(), k_most_failures));
    check("IDASetId", IDASetId(memory_.get(), id_.get()));
    matrix_.reset(SUNDenseMatrix(size, size, context_));
    linear_ = make_dense_solver(y_.get(), matrix_.get(), context_);
    check("IDASetLinearSolver", IDASetLinearSolver(memory_.get(), linear_.get(), matrix_.get()));
    check("IDASetJacFn", IDASetJacFn(memory_.get(), jacobian));
  }

  void begin(double xi, std::span<const double> y) override {
    std::ranges::copy(y, view(y_.get()).begin());
    quadratures_.begin(view(y_.get()));
    system_.all_rates(xi, y, view(dy_.get()));
    N_VScale(1.0, least_atol_.get(), atol_.get());
    raise_tolerances();
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
    roots_.fired.clear();
    const double begin = end_;
    N_VScale(1.0, y_.get(), begin_state_.get());
    N_VScale(1.0, dy_.get(), begin_rates_.get());
    if (carried_) carried_->keep();
    raise_tolerances();
    const auto restart = [&](double step) {
      N_VScale(1.0, begin_state_.get(), y_.get());
      N_VScale(1.0, begin_rates_.get(), dy_.get());
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
        N_VScale(1.0, dy_.get(), begin_rates_.get());
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
    int order = 0;
    IDAGetLastOrder(memory_.get(), &order);
    failing_steps_ = order == 1 && error_test_failures() > failures ? failing_steps_ + 1 : 0;
    if (flag == IDA_ROOT_RETURN) {
      check("IDAGetRootInfo", IDAGetRootInfo(memory_.get(), roots_.found.data()));
      roots_.collect();
      find_root(begin);
    } else if (flag == IDA_TSTOP_RETURN) {
      end_ = 1.0;
    }
    if (carried_) check("IDAGetSensDky", carried_->get(memory_.get(), end_));
    return {.xi = end_, .hit_guard = flag == IDA_ROOT_RETURN};
  }

  [[nodiscard]] std::span<const std::size_t> fired() const noexcept override { return roots_.fired; }

  void dense_output(double xi, std::span<double> y) override {
    check("IDAGetDky", IDAGetDky(memory_.get(), xi, 0, errors_.get()));
    std::ranges::copy(view(errors_.get()), y.begin());
    quadratures_.add_to(y);
    system_.complete(xi, y);
  }

  void dense_sensitivities(double xi) override {
    if (carried_) check("IDAGetSensDky", carried_->put(memory_.get(), xi, end_));
  }

  [[nodiscard]] double guard_tolerance() const noexcept override { return guard_tolerance_of(tolerances_); }

  [[nodiscard]] Statistics statistics() const override {
    if (past_.segments == 0) return past_;
    Statistics now;
    IDAGetNumSteps(memory_.get(), &now.steps);
    IDAGetNumJacEvals(memory_.get(), &now.jacobian_evaluations);
    IDAGetNumErrTestFails(memory_.get(), &now.error_test_failures);
    IDAGetNumNonlinSolvConvFails(memory_.get(), &now.convergence_failures);
    IDAGetLastOrder(memory_.get(), &now.last_order);
    IDAGetLastStep(memory_.get(), &now.last_step);
    now += past_;
    now.rhs_evaluations = rhs_evaluations();
    now.guard_evaluations = roots_.evaluations;
    return now;
  }

  [[nodiscard]] long rhs_evaluations() const override {
    if (past_.segments == 0) return 0;
    long of_segment = 0;
    IDAGetNumResEvals(memory_.get(), &of_segment);
    return past_.rhs_evaluations + of_segment + for_jacobian_;
  }

 private:
  [[nodiscard]] long error_test_failures() const {
    long failures = 0;
    IDAGetNumErrTestFails(memory_.get(), &failures);
    return failures;
  }

  /// Raises the absolute tolerances to the round-off of xi times the rates: no unknown is known better. Without this,
  /// tolerances are finer for an unknown that changes fast through zero, or ever faster towards the end of the
  /// equations. Residuals have that round-off, too: it is divided by k_left_by_corrector, the share that the corrector
  /// may leave.
  void raise_tolerances() {
    const auto rates = view(dy_.get());
    for (std::size_t k = 0; k < rates.size(); ++k) {
      const double round_off = k_round_off / k_left_by_corrector * std::abs(rates[k]);
      double& atol = view(atol_.get())[k];
      if (std::isfinite(round_off)) atol = std::max(atol, round_off);
    }
  }

  /// One over the tolerance of each unknown.
  static int error_weights(N_Vector y, N_Vector weights, void* self) noexcept {
    const auto& ida = *static_cast<Ida*>(self);
    const double rtol = of_step(ida.tolerances_).rtol;
    for (std::size_t k = 0; k < view(y).size(); ++k) {
      view(weights)[k] = 1.0 / (rtol * std::abs(view(y)[k]) + view(ida.atol_.get())[k]);
    }
    return 0;
  }

  /// Replaces state and rates at the beginning of a step by the system's own. Next to a fold or a corner, those to
  /// which the steps have led may be so wrong that no corrector converges from them.
  void correct_begin(double xi) {
    const auto state = view(begin_state_.get());
    std::ranges::copy(state, complete_.begin());
    quadratures_.add_to(complete_);
    system_.complete(xi, complete_);
    system_.all_rates(xi, complete_, view(begin_rates_.get()));
    for (std::size_t k = 0; k < state.size(); ++k) {
      if (system_.unknowns()[k].kind != Unknown::Kind::quadrature) state[k] = complete_[k];
    }
    if (carried_) carried_->correct_begin(xi, complete_);
  }

  /// Restarts IDA at xi with the state in y_ and dy_. @param step  first step to try; 0: the library's choice
  void start(double xi, double step) {
    past_ = statistics();  // counters are reset with the state
    for_jacobian_ = 0;
    end_ = xi;
    check("IDAReInit", IDAReInit(memory_.get(), xi, y_.get(), dy_.get()));
    check("IDASetInitStep", IDASetInitStep(memory_.get(), step));
    check("IDASetStopTime", IDASetStopTime(memory_.get(), 1.0));
    if (carried_) check("IDASensInit", carried_->start(memory_.get(), residual_of_sensitivities));
    check("IDARootInit", IDARootInit(memory_.get(), 0, nullptr));
    roots_.found.assign(guard_set_.size(), 0);
    if (guard_set_.size() == 0) return;
    check("IDARootInit", IDARootInit(memory_.get(), static_cast<int>(guard_set_.size()), guards));
    roots_.directions.assign(guard_set_.directions().begin(), guard_set_.directions().end());
    check("IDASetRootDirection", IDASetRootDirection(memory_.get(), roots_.directions.data()));
    check("IDASetNoInactiveRootWarn", IDASetNoInactiveRootWarn(memory_.get()));
  }

  /// Moves the end of the step to where a guard crosses zero.
  void find_root(double begin) {
    const auto values_at = [this](double xi, std::span<double> values) {
      ++roots_.evaluations;
      dense_output(xi, complete_);
      guard_set_.values(xi, complete_, values);
    };
    end_ = root_of_step(guard_set_, roots_.fired, begin, end_, guard_tolerance_of(tolerances_), values_at);
  }

  int evolve() {
    const int flag = IDASolve(memory_.get(), 1.0, &end_, y_.get(), dy_.get(), IDA_ONE_STEP);
    pending_.rethrow();
    return flag;
  }

  static int residual(realtype xi, N_Vector y, N_Vector dy, N_Vector res, void* self) noexcept {
    auto& ida = *static_cast<Ida*>(self);
    // The staggered method asks for the residual of a corrected state, which only a new Jacobian may need; jacobian()
    // then evaluates it. If this residual had no value, the library would begin its next trial without undoing this
    // one (6.4.1).
    ida.is_left_out_ = ida.carried_ && ida.is_corrected(xi);
    return ida.is_left_out_ ? 0 : ida.evaluate(xi, y, dy, res);
  }

  int evaluate(double xi, N_Vector y, N_Vector dy, N_Vector res) noexcept {
    return pending_.guard([&] {
      system_.residual(xi, view(y), view(dy), view(res));
      return all_finite(view(res));
    });
  }

  /// True if the corrector has changed the state at the end of a trial since the library last asked for its residual.
  bool is_corrected(double xi) noexcept {
    long corrections = 0;
    IDAGetNumNonlinSolvIters(memory_.get(), &corrections);
    const bool is_asked_again = xi == residual_xi_ && xi > end_;
    residual_xi_ = xi;
    return std::exchange(corrections_, corrections) < corrections && is_asked_again;
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
                      N_Vector shifted, N_Vector, N_Vector) noexcept {
    static const double k_root = std::sqrt(k_epsilon);
    auto& ida = *static_cast<Ida*>(self);
    double step = 0.0;
    if (IDAGetCurrentStep(ida.memory_.get(), &step) != IDA_SUCCESS ||
        IDAGetErrWeights(ida.memory_.get(), ida.weights_.get()) != IDA_SUCCESS) {
      return -1;
    }
    if (ida.is_left_out_) {
      ++ida.for_jacobian_;
      if (const int flag = ida.evaluate(xi, y, dy, res); flag != 0) return flag;
    }
    const auto values = view(y);
    const auto rates = view(dy);
    const auto unknowns = ida.system_.unknowns();
    for (std::size_t j = 0; j < values.size(); ++j) {
      const double value = values[j];
      const double rate = rates[j];
      const double tolerated = std::min(1.0 / view(ida.weights_.get())[j], k_root * unknowns[j].scale);
      const double size = std::max(k_root * std::max(std::abs(value), std::abs(step * rate)), tolerated);
      double increment = 0.0;
      const int flag = ida.pending_.guard([&] {
        shift_within_domain(std::copysign(size, step * rate), [&](double by) {
          values[j] = value + by;
          increment = values[j] - value;  // as rounded in the sum
          rates[j] = rate + cj * increment;
          ++ida.for_jacobian_;
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
    ++ida.roots_.evaluations;
    return ida.pending_.guard([&] {
      std::ranges::copy(view(y), ida.complete_.begin());
      // Without completing, a free centre that idle contacts move would lag behind them, and errors alone would close
      // contacts.
      ida.system_.complete(xi, ida.complete_);
      ida.guard_set_.values(xi, ida.complete_, {values, ida.guard_set_.size()});
      return true;
    });
  }

  void check(const char* call, int flag) {
    if (flag < 0) throw failure(Failure::no_step, fmt::format("{}: {}", call, flag_name(IDAGetReturnFlagName(flag))));
  }

  [[nodiscard]] SolverError failure(Failure why, const std::string& library) {
    double step = 0.0;
    std::string details;
    // Weights and errors exist once a step has been tried.
    if (memory_ && IDAGetCurrentStep(memory_.get(), &step) == IDA_SUCCESS &&
        IDAGetErrWeights(memory_.get(), weights_.get()) == IDA_SUCCESS &&
        IDAGetEstLocalErrors(memory_.get(), errors_.get()) == IDA_SUCCESS) {
      details = worst_components(system_.unknowns(), view(weights_.get()), view(errors_.get()));
    }
    return {why, end_, step, details, library};
  }

  Equations& system_;
  GuardSet& guard_set_;
  Tolerances tolerances_;
  SegmentQuadratures quadratures_;
  std::vector<double> complete_;
  Pending pending_;
  RootList roots_;
  double end_ = 0.0;
  double last_length_ = 0.0;  ///< length of the last step of this segment; 0 before the first
  int failing_steps_ = 0;     ///< steps of order 1 in a row, each after a failed error test
  Statistics past_;
  long for_jacobian_ = 0;     ///< residuals evaluated for Jacobians, which the library does not count
  double residual_xi_ = 0.0;  ///< step coordinate at which the library last asked for a residual
  long corrections_ = 0;      ///< corrections of states up to that call
  bool is_left_out_ = false;  ///< that residual was not evaluated

  sundials::Context context_;  // first in, last out
  NVector y_, dy_, begin_state_, begin_rates_, id_, least_atol_, atol_, weights_, errors_;
  Matrix matrix_;
  LinearSolver linear_;
  std::optional<SundialsSensitivities<IdasCalls>> carried_;
  IdaMemory memory_;
};

}  // namespace

std::unique_ptr<Integrator> make_ida(Equations& system, GuardSet& guard_set, const Tolerances& tolerances,
                                     ForwardSensitivities* sensitivities) {
  return std::make_unique<Ida>(system, guard_set, tolerances, sensitivities);
}

}  // namespace monograin
