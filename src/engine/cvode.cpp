// The explicit form integrated by CVODE.

#include <cvode/cvode.h>
#include <fmt/format.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <stdexcept>

#include "engine/sundials.hpp"

namespace monograin {
namespace {

using namespace sundials_boundary;

struct CvodeDeleter {
  void operator()(void* memory) const noexcept { CVodeFree(&memory); }
};
using CvodeMemory = std::unique_ptr<void, CvodeDeleter>;

constexpr long k_most_steps = 200'000;  // internal steps of one segment

class Cvode final : public Integrator {
 public:
  Cvode(CvodeMethod method, HybridSystem& system, Watch& watch, const Tolerances& tolerances)
      : system_(system), watch_(watch), tolerances_(tolerances), quadratures_(system.unknowns()) {
    const auto unknowns = system.unknowns();
    complete_.resize(unknowns.size());
    explicit_size_ = static_cast<std::size_t>(
        std::ranges::count_if(unknowns, [](const Unknown& u) { return u.kind != Unknown::Kind::algebraic; }));
    const auto size = static_cast<sunindextype>(explicit_size_);
    y_.reset(N_VNew_Serial(size, context_));
    atol_.reset(N_VNew_Serial(size, context_));
    for (std::size_t k = 0; k < explicit_size_; ++k) view(atol_.get())[k] = local_atol(tolerances) * unknowns[k].scale;
    weights_.reset(N_VNew_Serial(size, context_));
    errors_.reset(N_VNew_Serial(size, context_));

    memory_.reset(CVodeCreate(method == CvodeMethod::adams ? CV_ADAMS : CV_BDF, context_));
    check("CVodeSetErrHandlerFn", CVodeSetErrHandlerFn(memory_.get(), keep_message, &message_));
    check("CVodeInit", CVodeInit(memory_.get(), right_hand_side, 0.0, y_.get()));
    check("CVodeSetUserData", CVodeSetUserData(memory_.get(), this));
    check("CVodeSVtolerances", CVodeSVtolerances(memory_.get(), local_rtol(tolerances), atol_.get()));
    check("CVodeSetMaxNumSteps", CVodeSetMaxNumSteps(memory_.get(), k_most_steps));
    if (method == CvodeMethod::adams) {
      nonlinear_.reset(SUNNonlinSol_FixedPoint(y_.get(), 0, context_));
      check("CVodeSetNonlinearSolver", CVodeSetNonlinearSolver(memory_.get(), nonlinear_.get()));
    } else {
      matrix_.reset(SUNDenseMatrix(size, size, context_));
      linear_.reset(SUNLinSol_Dense(y_.get(), matrix_.get(), context_));
      check("CVodeSetLinearSolver", CVodeSetLinearSolver(memory_.get(), linear_.get(), matrix_.get()));
    }
  }

  void begin(double xi, std::span<const double> y) override {
    // Counters are reset by CVodeReInit.
    past_ = statistics();
    ++past_.segments;
    segment_steps_ = 0;
    end_ = xi;
    std::ranges::copy(y, complete_.begin());
    std::ranges::copy(y.first(explicit_size_), view(y_.get()).begin());
    quadratures_.begin(view(y_.get()));
    check("CVodeReInit", CVodeReInit(memory_.get(), xi, y_.get()));
    check("CVodeSetStopTime", CVodeSetStopTime(memory_.get(), 1.0));
    // Unlisting all guards first makes CVODE forget which ones it had switched off.
    check("CVodeRootInit", CVodeRootInit(memory_.get(), 0, nullptr));
    roots_.found.assign(watch_.size(), 0);
    if (watch_.size() == 0) return;
    check("CVodeRootInit", CVodeRootInit(memory_.get(), static_cast<int>(watch_.size()), guards));
    std::vector<int> directions(watch_.directions().begin(), watch_.directions().end());
    check("CVodeSetRootDirection", CVodeSetRootDirection(memory_.get(), directions.data()));
    check("CVodeSetNoInactiveRootWarn", CVodeSetNoInactiveRootWarn(memory_.get()));
  }

  Advance advance() override {
    if (++segment_steps_ > k_most_steps) throw failure("CVode", "CV_TOO_MUCH_WORK");
    pending_.forget();
    roots_.fired.clear();
    const double begin = end_;
    const int flag = CVode(memory_.get(), 1.0, y_.get(), &end_, CV_ONE_STEP);
    pending_.rethrow();
    if (flag < 0 && !pending_.domain_end().empty()) throw std::domain_error(pending_.domain_end());
    check("CVode", flag);
    // Ever smaller steps towards the end of the equations would never get there.
    if (!pending_.domain_end().empty() && end_ - begin < k_least_progress) {
      throw std::domain_error(pending_.domain_end());
    }
    if (flag == CV_ROOT_RETURN) {
      check("CVodeGetRootInfo", CVodeGetRootInfo(memory_.get(), roots_.found.data()));
      roots_.collect();
    } else if (flag == CV_TSTOP_RETURN) {
      end_ = 1.0;
    }
    return {.xi = end_, .hit_guard = flag == CV_ROOT_RETURN};
  }

  [[nodiscard]] std::span<const std::size_t> fired() const noexcept override { return roots_.fired; }

  void dense_output(double xi, std::span<double> y) override {
    check("CVodeGetDky", CVodeGetDky(memory_.get(), xi, 0, errors_.get()));
    std::ranges::copy(complete_, y.begin());
    std::ranges::copy(view(errors_.get()), y.begin());
    quadratures_.add_to(y);
    system_.complete(xi, y);
  }

  [[nodiscard]] double guard_tolerance() const noexcept override { return 1e-2 * tolerances_.rtol; }

  [[nodiscard]] Statistics statistics() const override {
    if (past_.segments == 0) return past_;
    Statistics now;
    long for_jacobian = 0;
    CVodeGetNumSteps(memory_.get(), &now.steps);
    CVodeGetNumRhsEvals(memory_.get(), &now.rhs_evaluations);
    if (linear_) {
      CVodeGetNumLinRhsEvals(memory_.get(), &for_jacobian);
      CVodeGetNumJacEvals(memory_.get(), &now.jacobian_evaluations);
    }
    now.rhs_evaluations += for_jacobian;
    CVodeGetNumErrTestFails(memory_.get(), &now.error_test_failures);
    CVodeGetNumNonlinSolvConvFails(memory_.get(), &now.convergence_failures);
    CVodeGetNumGEvals(memory_.get(), &now.guard_evaluations);
    CVodeGetLastOrder(memory_.get(), &now.last_order);
    CVodeGetLastStep(memory_.get(), &now.last_step);
    return now += past_;
  }

 private:
  static int right_hand_side(realtype xi, N_Vector y, N_Vector dy, void* self) noexcept {
    auto& cvode = *static_cast<Cvode*>(self);
    return cvode.pending_.guard([&] {
      cvode.fill(xi, y);
      cvode.system_.rates(xi, cvode.complete_, view(dy));
      return all_finite(view(dy));
    });
  }

  static int guards(realtype xi, N_Vector y, realtype* values, void* self) noexcept {
    auto& cvode = *static_cast<Cvode*>(self);
    return cvode.pending_.guard([&] {
      cvode.fill(xi, y);
      cvode.watch_.values(xi, cvode.complete_, {values, cvode.watch_.size()});
      return true;
    });
  }

  /// The complete state that belongs to CVODE's part of it.
  void fill(double xi, N_Vector y) {
    std::ranges::copy(view(y), complete_.begin());
    quadratures_.add_to(complete_);
    system_.complete(xi, complete_);
  }

  void check(const char* call, int flag) {
    if (flag < 0) throw failure(call, flag_name(CVodeGetReturnFlagName(flag)));
  }

  [[nodiscard]] SolverError failure(const char* call, std::string flag) {
    double step = 0.0;
    std::string details = message_;
    // Weights and errors are there once a step has been tried.
    if (memory_ && CVodeGetCurrentStep(memory_.get(), &step) == CV_SUCCESS &&
        CVodeGetErrWeights(memory_.get(), weights_.get()) == CV_SUCCESS &&
        CVodeGetEstLocalErrors(memory_.get(), errors_.get()) == CV_SUCCESS) {
      details += worst_components(system_.unknowns(), view(weights_.get()), view(errors_.get()));
    }
    return {call, std::move(flag), end_, step, details};
  }

  HybridSystem& system_;
  Watch& watch_;
  Tolerances tolerances_;
  SegmentQuadratures quadratures_;
  std::size_t explicit_size_ = 0;
  std::vector<double> complete_;
  std::string message_;
  Pending pending_;
  RootList roots_;
  double end_ = 0.0;
  long segment_steps_ = 0;
  Statistics past_;

  sundials::Context context_;  // first in, last out
  NVector y_, atol_, weights_, errors_;
  Matrix matrix_;
  LinearSolver linear_;
  NonlinearSolver nonlinear_;
  CvodeMemory memory_;
};

}  // namespace

std::unique_ptr<Integrator> make_cvode(CvodeMethod method, HybridSystem& system, Watch& watch,
                                       const Tolerances& tolerances) {
  return std::make_unique<Cvode>(method, system, watch, tolerances);
}

}  // namespace monograin
