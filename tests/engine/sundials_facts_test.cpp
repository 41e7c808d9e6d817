// Assumptions of the engine about stopping, restarting and root finding in SUNDIALS 6.4.1, and checks that its remedies
// work. A test that fails after a library upgrade names the assumption to review.

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <cvodes/cvodes.h>
#include <gtest/gtest.h>
#include <idas/idas.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sundials/sundials_context.hpp>

#include "engine/sundials.hpp"
#include "system/resolution.hpp"

namespace monograin::sundials_facts_test {
namespace {

using monograin::sundials_boundary::LinearSolver;
using monograin::sundials_boundary::Matrix;
using monograin::sundials_boundary::NVector;

constexpr double k_rtol = 1e-8;

void require(int flag) {
  if (flag < 0) throw std::runtime_error("SUNDIALS set-up failed with flag " + std::to_string(flag));
}

void collect_message(int, const char*, const char*, char* message, void* messages) noexcept {
  static_cast<std::string*>(messages)->append(message).append("\n");
}

using Function = std::function<double(double t, double y)>;
using Force = std::function<double(double overlap)>;

Function constant(double value) {
  return [value](double, double) { return value; };
}

/// The guard y - level.
Function above(double level) {
  return [level](double, double y) { return y - level; };
}

/// CVODE (BDF) on the scalar problem y' = rhs(t, y).
class Cvode {
 public:
  Cvode(Function rhs, double t0, double y0, double rtol = k_rtol) : rhs_(std::move(rhs)), t_(t0) {
    state()[0] = y0;
    require(CVodeInit(memory(), call_rhs, t0, y_.get()));
    require(CVodeSetUserData(memory(), this));
    require(CVodeSetErrHandlerFn(memory(), collect_message, &messages_));
    require(CVodeSStolerances(memory(), rtol, rtol));
    require(CVodeSetLinearSolver(memory(), solver_.get(), jacobian_.get()));
  }
  Cvode(const Cvode&) = delete;  // CVODE holds the address of this object
  Cvode& operator=(const Cvode&) = delete;

  /// Every step from now on has this length, as long as the error test allows it: y' = 1 always does.
  void set_step(double step) {
    require(CVodeSetInitStep(memory(), step));
    require(CVodeSetMaxStep(memory(), step));
  }

  void watch(std::vector<Function> guards) {
    guards_ = std::move(guards);
    require(CVodeRootInit(memory(), static_cast<int>(guards_.size()), call_guards));
  }

  void forget_guards() { require(CVodeRootInit(memory(), 0, nullptr)); }

  /// For a solver with one guard.
  void set_direction(int direction) { require(CVodeSetRootDirection(memory(), &direction)); }

  void set_stop_time(double stop) { require(CVodeSetStopTime(memory(), stop)); }

  void restart(double t0, double y0) {
    t_ = t0;
    state()[0] = y0;
    require(CVodeReInit(memory(), t0, y_.get()));
  }

  int advance(double tout, int task = CV_NORMAL) { return CVode(memory(), tout, y_.get(), &t_, task); }

  /// 1 or -1 for a guard that has just fired rising or falling, 0 for the others.
  [[nodiscard]] std::vector<int> fired() const {
    std::vector<int> roots(guards_.size());
    require(CVodeGetRootInfo(memory(), roots.data()));
    return roots;
  }

  [[nodiscard]] double t() const { return t_; }
  [[nodiscard]] double y() const { return N_VGetArrayPointer(y_.get())[0]; }
  [[nodiscard]] const std::string& messages() const { return messages_; }

 private:
  struct MemoryDeleter {
    void operator()(void* memory) const noexcept { CVodeFree(&memory); }
  };

  [[nodiscard]] void* memory() const { return memory_.get(); }
  [[nodiscard]] double* state() { return N_VGetArrayPointer(y_.get()); }

  static int call_rhs(realtype t, N_Vector y, N_Vector ydot, void* self) noexcept {
    N_VGetArrayPointer(ydot)[0] = static_cast<Cvode*>(self)->rhs_(t, N_VGetArrayPointer(y)[0]);
    return 0;
  }

  static int call_guards(realtype t, N_Vector y, realtype* values, void* self) noexcept {
    for (const Function& guard : static_cast<Cvode*>(self)->guards_) *values++ = guard(t, N_VGetArrayPointer(y)[0]);
    return 0;
  }

  Function rhs_;
  std::vector<Function> guards_;
  std::string messages_;
  double t_;
  sundials::Context context_;
  NVector y_{N_VNew_Serial(1, context_)};
  Matrix jacobian_{SUNDenseMatrix(1, 1, context_)};
  LinearSolver solver_{SUNLinSol_Dense(y_.get(), jacobian_.get(), context_)};
  std::unique_ptr<void, MemoryDeleter> memory_{CVodeCreate(CV_BDF, context_)};
};

/// IDA on a spring under a growing load: load' = 1, force(overlap) = load.
class Ida {
 public:
  Ida(Force force, double t0, double load, double overlap) : force_(std::move(force)) {
    set(y_, load, overlap);
    set(ydot_, 1, 0);
    set(is_differential_, 1, 0);
    require(IDAInit(memory(), call_residual, t0, y_.get(), ydot_.get()));
    require(IDASetUserData(memory(), this));
    require(IDASetErrHandlerFn(memory(), collect_message, &messages_));
    require(IDASStolerances(memory(), k_rtol, k_rtol));
    require(IDASetLinearSolver(memory(), solver_.get(), jacobian_.get()));
    require(IDASetId(memory(), is_differential_.get()));
  }
  Ida(const Ida&) = delete;  // IDA holds the address of this object
  Ida& operator=(const Ida&) = delete;

  /// Replaces the difference quotients by the force's derivative.
  void use_stiffness(Force stiffness) {
    stiffness_ = std::move(stiffness);
    require(IDASetJacFn(memory(), call_jacobian));
  }

  void suppress_algebraic_error_test() { require(IDASetSuppressAlg(memory(), SUNTRUE)); }

  int make_consistent(double tout1) { return IDACalcIC(memory(), IDA_YA_YDP_INIT, tout1); }

  int advance(double tout) {
    double t = 0;
    return IDASolve(memory(), tout, &t, y_.get(), ydot_.get(), IDA_NORMAL);
  }

  [[nodiscard]] long steps() const {
    long count = 0;
    require(IDAGetNumSteps(memory(), &count));
    return count;
  }

  [[nodiscard]] double overlap() const { return N_VGetArrayPointer(y_.get())[1]; }
  [[nodiscard]] const std::string& messages() const { return messages_; }

 private:
  struct MemoryDeleter {
    void operator()(void* memory) const noexcept { IDAFree(&memory); }
  };

  [[nodiscard]] void* memory() const { return memory_.get(); }

  static void set(const NVector& vector, double first, double second) {
    N_VGetArrayPointer(vector.get())[0] = first;
    N_VGetArrayPointer(vector.get())[1] = second;
  }

  static int call_residual(realtype, N_Vector y, N_Vector ydot, N_Vector residual, void* self) noexcept {
    const double* state = N_VGetArrayPointer(y);
    N_VGetArrayPointer(residual)[0] = N_VGetArrayPointer(ydot)[0] - 1;
    N_VGetArrayPointer(residual)[1] = static_cast<Ida*>(self)->force_(state[1]) - state[0];
    return 0;
  }

  static int call_jacobian(realtype, realtype cj, N_Vector y, N_Vector, N_Vector, SUNMatrix jacobian, void* self,
                           N_Vector, N_Vector, N_Vector) noexcept {
    SM_ELEMENT_D(jacobian, 0, 0) = cj;
    SM_ELEMENT_D(jacobian, 1, 0) = -1;
    SM_ELEMENT_D(jacobian, 1, 1) = static_cast<Ida*>(self)->stiffness_(N_VGetArrayPointer(y)[1]);
    return 0;
  }

  Force force_;
  Force stiffness_;
  std::string messages_;
  sundials::Context context_;
  NVector y_{N_VNew_Serial(2, context_)};
  NVector ydot_{N_VNew_Serial(2, context_)};
  NVector is_differential_{N_VNew_Serial(2, context_)};
  Matrix jacobian_{SUNDenseMatrix(2, 2, context_)};
  LinearSolver solver_{SUNLinSol_Dense(y_.get(), jacobian_.get(), context_)};
  std::unique_ptr<void, MemoryDeleter> memory_{IDACreate(context_)};
};

// --- Root finding detects only sign changes between the ends of a step.

TEST(SundialsRootFinding, MissesTwoCrossingsInsideOneStep) {
  Cvode solver(constant(1), 0, 0);
  solver.set_step(1);
  solver.watch({[](double, double y) { return (y - 0.4) * (y - 0.6); }});
  EXPECT_EQ(solver.advance(1), CV_SUCCESS);
}

TEST(SundialsRootFinding, MissesATouchingRoot) {
  Cvode solver(constant(1), 0, 0);
  solver.set_step(1);
  solver.watch({[](double, double y) { return (y - 0.4) * (y - 0.4); }});
  EXPECT_EQ(solver.advance(1), CV_SUCCESS);
}

TEST(SundialsRootFinding, FindsBothCrossingsOfABandSplitIntoTwoGuards) {
  Cvode solver(constant(1), 0, 0);
  solver.set_step(1);
  solver.watch({above(0.4), above(0.6)});
  EXPECT_EQ(solver.advance(1), CV_ROOT_RETURN);
  EXPECT_EQ(solver.fired(), (std::vector{1, 0}));
  EXPECT_EQ(solver.advance(1), CV_ROOT_RETURN);
  EXPECT_EQ(solver.fired(), (std::vector{0, 1}));
}

// --- A guard that is zero at the start.

TEST(SundialsRootFinding, LooksAtAZeroGuardAgainATenthOfTheFirstStepLater) {
  Cvode solver(constant(1), 0, 0);
  solver.set_step(0.5);
  std::vector<double> times;
  solver.watch({[&times](double t, double y) {
    times.push_back(t);
    return y;
  }});
  EXPECT_EQ(solver.advance(1, CV_ONE_STEP), CV_SUCCESS);
  EXPECT_EQ(times, (std::vector<double>{0, 0.05, 0.5}));
}

TEST(SundialsRootFinding, AGuardExactlyZeroAtTheStartFiresLaterOnly) {
  Cvode solver(constant(1), 0, 0);
  solver.set_step(1);
  solver.watch({[](double, double y) { return y * (y - 0.5); }});
  EXPECT_EQ(solver.advance(1), CV_ROOT_RETURN);
  EXPECT_NEAR(solver.t(), 0.5, 1e-12);
}

TEST(SundialsRootFinding, AGuardARoundingErrorFromZeroAtTheStartFiresThere) {
  Cvode solver(constant(1), 0, 0);
  solver.set_step(1);
  solver.watch({above(1e-17)});
  EXPECT_EQ(solver.advance(1), CV_ROOT_RETURN);
  EXPECT_NEAR(solver.t(), 0, 1e-12);
}

TEST(SundialsRootFinding, AGuardWatchedInTheOtherDirectionDoesNotFireWhereItIsLeft) {
  Cvode solver(constant(1), 0, 0);
  solver.set_step(1);
  solver.watch({above(1e-17)});
  solver.set_direction(-1);
  EXPECT_EQ(solver.advance(1), CV_SUCCESS);
}

// --- A guard that is identically zero at the start.

TEST(SundialsRootFinding, SwitchesOffAGuardThatIsIdenticallyZeroAndWarns) {
  Cvode solver(constant(1), 0, 0);
  solver.set_step(0.25);
  solver.watch({[](double, double y) { return std::max(y - 0.6, 0.0); }});
  EXPECT_EQ(solver.advance(1), CV_SUCCESS);
  EXPECT_NE(solver.messages().find("root functions identically 0"), std::string::npos) << solver.messages();
}

/// Zero up to y = 0.4, where it jumps to 0.2; then it falls through zero at y = 0.6.
double clamped_guard(double, double y) { return y < 0.4 ? 0 : 0.6 - y; }

TEST(SundialsRootFinding, LosesTheCrossingOfAZeroGuardInTheStepInWhichItLeavesZero) {
  Cvode solver(constant(1), 0, 0);
  solver.set_step(1);
  solver.watch({clamped_guard});
  EXPECT_EQ(solver.advance(1), CV_SUCCESS);
}

TEST(SundialsRootFinding, SwitchesAZeroGuardOnOnceItIsNonzeroAtTheEndOfAStep) {
  Cvode solver(constant(1), 0, 0);
  solver.set_step(0.5);
  solver.watch({clamped_guard});
  EXPECT_EQ(solver.advance(1), CV_ROOT_RETURN);
  EXPECT_NEAR(solver.t(), 0.6, 1e-12);
}

// --- A guard that is switched off.

/// A solver at t = 1 whose only guard was always zero and is therefore off; from now on the guard is y - 0.5.
class SundialsGuardSwitchedOff : public ::testing::Test {
 protected:
  void SetUp() override {
    solver_.set_step(1);
    solver_.watch({[this](double, double y) { return is_zero_ ? 0 : y - 0.5; }});
    ASSERT_EQ(solver_.advance(1, CV_ONE_STEP), CV_SUCCESS);
    is_zero_ = false;
  }

  bool is_zero_ = true;
  Cvode solver_{constant(1), 0, 0};
};

TEST_F(SundialsGuardSwitchedOff, StaysOffOverReInit) {
  solver_.restart(0, 0);
  EXPECT_EQ(solver_.advance(1), CV_SUCCESS);
}

TEST_F(SundialsGuardSwitchedOff, StaysOffOverRootInitWithTheSameCountAndFunction) {
  solver_.restart(0, 0);
  solver_.watch({above(0.5)});
  EXPECT_EQ(solver_.advance(1), CV_SUCCESS);
}

TEST_F(SundialsGuardSwitchedOff, IsOnAgainAfterRootInitWithNoGuards) {
  solver_.restart(0, 0);
  solver_.forget_guards();
  solver_.watch({above(0.5)});
  EXPECT_EQ(solver_.advance(1), CV_ROOT_RETURN);
  EXPECT_NEAR(solver_.t(), 0.5, 1e-12);
}

// --- A guard that stays zero after its root.

TEST(SundialsRootFinding, AGuardThatStaysZeroFiresAtTheWrongTimeAndIsAnErrorThen) {
  Cvode solver(constant(1), 0, 0);
  solver.set_step(1);
  solver.watch({[](double, double y) { return std::min(y - 0.5, 0.0); }});
  EXPECT_EQ(solver.advance(2), CV_ROOT_RETURN);
  EXPECT_EQ(solver.t(), 1) << "the end of the step, not the crossing";
  EXPECT_EQ(solver.advance(2), CV_ILL_INPUT);
  EXPECT_NE(solver.messages().find("Root found at and very near"), std::string::npos) << solver.messages();
}

TEST(SundialsRootFinding, ASignedGuardFiresAtItsRootAndLetsTheRunGoOn) {
  Cvode solver(constant(1), 0, 0);
  solver.set_step(1);
  solver.watch({above(0.5)});
  EXPECT_EQ(solver.advance(2), CV_ROOT_RETURN);
  EXPECT_NEAR(solver.t(), 0.5, 1e-12);
  EXPECT_EQ(solver.advance(2), CV_SUCCESS);
}

// --- A restart at a guard that has just fired.

TEST(SundialsRestart, OnTheOldSideOfTheGuardFiresItAgainAndAgain) {
  Cvode solver(constant(1), 0, 0);
  solver.watch({above(0.5)});
  ASSERT_EQ(solver.advance(1), CV_ROOT_RETURN);
  const double first = solver.t();
  for (int repeat = 0; repeat < 20; ++repeat) {
    solver.restart(solver.t(), std::nextafter(0.5, 0));
    ASSERT_EQ(solver.advance(1), CV_ROOT_RETURN) << "repeat " << repeat;
  }
  EXPECT_NEAR(solver.t(), first, 1e-11);
}

TEST(SundialsRestart, OnTheOldSideOfAGuardWatchedInTheOppositeDirectionDoesNotFire) {
  Cvode solver(constant(1), 0, 0);
  solver.watch({above(0.5)});
  ASSERT_EQ(solver.advance(1), CV_ROOT_RETURN);
  solver.restart(solver.t(), std::nextafter(0.5, 0));
  solver.set_direction(-1);
  EXPECT_EQ(solver.advance(1), CV_SUCCESS);
}

TEST(SundialsRestart, ExactlyOnTheGuardDoesNotFire) {
  Cvode solver(constant(1), 0, 0);
  solver.watch({above(0.5)});
  ASSERT_EQ(solver.advance(1), CV_ROOT_RETURN);
  solver.restart(solver.t(), 0.5);
  EXPECT_EQ(solver.advance(1), CV_SUCCESS);
}

// --- Guards that fire together.

TEST(SundialsRootFinding, FiresEqualGuardsTogether) {
  Cvode solver(constant(1), 0, 0);
  solver.watch({above(0.5), above(0.5)});
  EXPECT_EQ(solver.advance(1), CV_ROOT_RETURN);
  EXPECT_EQ(solver.fired(), (std::vector{1, 1}));
  EXPECT_EQ(solver.advance(1), CV_SUCCESS);
}

TEST(SundialsRootFinding, FiresGuardsThatDifferByARoundingErrorOneByOneWithinABracket) {
  Cvode solver(constant(1), 0, 0);
  solver.set_step(1);
  solver.watch({above(0.5), above(0.5 + 4 * k_epsilon)});
  EXPECT_EQ(solver.advance(1), CV_ROOT_RETURN);
  EXPECT_EQ(solver.fired(), (std::vector{1, 0}));
  const double first = solver.t();
  EXPECT_EQ(solver.advance(1), CV_ROOT_RETURN);
  EXPECT_EQ(solver.fired(), (std::vector{0, 1}));
  EXPECT_LE(solver.t() - first, 100 * k_epsilon * (1 + 1)) << "the bracket of the search, 100 U (|t| + |h|)";
}

// --- The accuracy of a root.

class SundialsRootAccuracy : public ::testing::TestWithParam<double> {};

TEST_P(SundialsRootAccuracy, IsThatOfTheSolutionDividedByTheSlope) {
  const double rtol = GetParam();
  Cvode solver([](double t, double) { return std::cos(t); }, 0, 0, rtol);
  solver.watch({above(0.5)});
  ASSERT_EQ(solver.advance(1), CV_ROOT_RETURN);
  const double exact = std::numbers::pi / 6;
  const double time_error = solver.t() - exact;
  const double solution_error = solver.y() - std::sin(solver.t());
  EXPECT_LT(std::abs(time_error), 100 * rtol) << "measured: " << std::abs(time_error) / rtol << " rtol";
  EXPECT_GT(std::abs(time_error), 1e-12) << "far outside the bracket of the search";
  EXPECT_NEAR(time_error, -solution_error / std::cos(exact), 0.01 * std::abs(time_error));
}

INSTANTIATE_TEST_SUITE_P(Tolerances, SundialsRootAccuracy, ::testing::Values(1e-4, 1e-6, 1e-8), [](const auto& row) {
  return "Digits" + std::to_string(std::lround(-std::log10(row.param)));
});

// --- Stop times.

TEST(SundialsStopTime, EqualToToutComesBackTwiceTheSecondTimeWithoutProgress) {
  Cvode solver(constant(1), 0, 0);
  solver.set_stop_time(1);
  EXPECT_EQ(solver.advance(1), CV_SUCCESS);
  EXPECT_EQ(solver.t(), 1);
  EXPECT_EQ(solver.advance(2), CV_TSTOP_RETURN);
  EXPECT_EQ(solver.t(), 1);
}

TEST(SundialsStopTime, IsReachedExactlyAndOnceStepByStep) {
  Cvode solver([](double t, double) { return std::cos(t); }, 0, 0);
  const double stop = 1.0 / 3;
  solver.set_stop_time(stop);
  int flag = CV_SUCCESS;
  while (flag == CV_SUCCESS && solver.t() < stop) flag = solver.advance(1, CV_ONE_STEP);
  EXPECT_EQ(flag, CV_TSTOP_RETURN);
  EXPECT_EQ(solver.t(), stop);
  EXPECT_EQ(solver.advance(1, CV_ONE_STEP), CV_SUCCESS);
  EXPECT_GT(solver.t(), stop);
}

TEST(SundialsStopTime, SurvivesARoot) {
  Cvode solver(constant(1), 0, 0);
  solver.watch({above(0.5)});
  solver.set_stop_time(1);
  EXPECT_EQ(solver.advance(2), CV_ROOT_RETURN);
  EXPECT_EQ(solver.advance(2), CV_TSTOP_RETURN);
  EXPECT_EQ(solver.t(), 1);
}

TEST(SundialsStopTime, SurvivesReInit) {
  Cvode solver(constant(1), 0, 0);
  solver.set_stop_time(1);
  solver.restart(0.5, 0);
  EXPECT_EQ(solver.advance(2), CV_TSTOP_RETURN);
  EXPECT_EQ(solver.t(), 1);
}

TEST(SundialsStopTime, BehindTheNewStartIsAnError) {
  Cvode solver(constant(1), 0, 0);
  solver.set_stop_time(1);
  solver.restart(2, 0);
  EXPECT_EQ(solver.advance(3), CV_ILL_INPUT);
  EXPECT_NE(solver.messages().find("tstop = 1 is behind"), std::string::npos) << solver.messages();
}

TEST(SundialsStopTime, SetAgainAfterReInitIsTheOneThatCounts) {
  Cvode solver(constant(1), 0, 0);
  solver.set_stop_time(1);
  solver.restart(2, 0);
  solver.set_stop_time(3);
  EXPECT_EQ(solver.advance(4), CV_TSTOP_RETURN);
  EXPECT_EQ(solver.t(), 3);
}

/// Latest time up to t = 1 at which the solver evaluates the right-hand side.
double latest_evaluation(bool with_stop_time) {
  double latest = 0;
  Cvode solver(
      [&latest](double t, double) {
        latest = std::max(latest, t);
        return 1;
      },
      0, 0);
  if (with_stop_time) solver.set_stop_time(1);
  require(solver.advance(1));
  return latest;
}

TEST(SundialsStopTime, WithoutOneTheRightHandSideIsEvaluatedBeyondTout) { EXPECT_GT(latest_evaluation(false), 1); }

TEST(SundialsStopTime, KeepsTheRightHandSideFromBeingEvaluatedBeyondIt) { EXPECT_LE(latest_evaluation(true), 1); }

// --- A segment without length.

TEST(SundialsStart, WithinRoundingOfToutIsAnError) {
  Cvode solver(constant(1), 1, 0);
  EXPECT_EQ(solver.advance(1 + 2 * k_epsilon), CV_TOO_CLOSE);
  EXPECT_EQ(solver.advance(1 + 4 * k_epsilon), CV_SUCCESS);
}

TEST(SundialsStart, AtToutWithAGivenStepChangesTheStateInNoTime) {
  Cvode solver([](double, double y) { return 100 - y * y; }, 1, 1);
  solver.set_step(1e-3);
  EXPECT_EQ(solver.advance(1), CV_SUCCESS);
  EXPECT_EQ(solver.t(), 1);
  EXPECT_NE(solver.y(), 1);
  EXPECT_NEAR(solver.y(), 1, 1e-8);
}

// --- Consistent values for IDA.

double linear_spring(double overlap) { return 3 * overlap; }

TEST(SundialsIda, FailsInItsFirstStepFromInconsistentValues) {
  Ida solver(linear_spring, 0, 1, 7);
  EXPECT_EQ(solver.advance(1), IDA_ERR_FAIL);
  EXPECT_EQ(solver.steps(), 0);
}

TEST(SundialsIda, FindsConsistentValuesWithTheEndOfTheSegmentAsTout1) {
  Ida solver(linear_spring, 0, 1, 7);
  ASSERT_EQ(solver.make_consistent(1), IDA_SUCCESS);
  EXPECT_EQ(solver.advance(1), IDA_SUCCESS);
  EXPECT_NEAR(solver.overlap(), 2.0 / 3, 10 * k_rtol);
}

TEST(SundialsIda, RefusesToFindConsistentValuesWithTheStartAsTout1) {
  Ida solver(linear_spring, 1, 1, 7);
  EXPECT_EQ(solver.make_consistent(1), IDA_ILL_INPUT);
  EXPECT_NE(solver.messages().find("tout1 too close to t0"), std::string::npos) << solver.messages();
}

TEST(SundialsIda, FailsToFindConsistentValuesWithTheStartAsTout1AtTimeZero) {
  Ida solver(linear_spring, 0, 1, 7);
  EXPECT_EQ(solver.make_consistent(0), IDA_LINESEARCH_FAIL) << "the distance to t0 is compared with a roundoff of zero";
}

// --- A singular balance in IDA: at first touch the stiffness of a sphere is zero.

double sphere_force(double overlap) { return overlap * std::sqrt(std::abs(overlap)); }
double sphere_stiffness(double overlap) { return 1.5 * std::sqrt(std::abs(overlap)); }
double sphere_overlap(double force) { return std::pow(force, 2.0 / 3); }

TEST(SundialsIda, FailsInItsFirstStepFromASingularBalance) {
  Ida solver(sphere_force, 0, 0, 0);
  solver.use_stiffness(sphere_stiffness);
  EXPECT_EQ(solver.advance(1), IDA_CONV_FAIL);
  EXPECT_EQ(solver.steps(), 0);
}

TEST(SundialsIda, FindsNoConsistentValuesAtASingularBalance) {
  Ida solver(sphere_force, 0, 0, 0);
  solver.use_stiffness(sphere_stiffness);
  EXPECT_EQ(solver.make_consistent(1), IDA_NO_RECOVERY);
}

TEST(SundialsIda, StartsFromAPointSlightlyInsideTheContact) {
  const double load = 1e-3;
  Ida solver(sphere_force, 0, load, sphere_overlap(load));
  solver.use_stiffness(sphere_stiffness);
  ASSERT_EQ(solver.make_consistent(1), IDA_SUCCESS);
  EXPECT_EQ(solver.advance(1), IDA_SUCCESS);
  EXPECT_NEAR(solver.overlap(), sphere_overlap(1 + load), 10 * k_rtol);
}

TEST(SundialsIda, HidesASingularBalanceBehindDifferenceQuotientsAndAnswersWrongly) {
  Ida solver(sphere_force, 0, 0, 0);
  solver.suppress_algebraic_error_test();
  EXPECT_EQ(solver.advance(1), IDA_SUCCESS);
  EXPECT_GT(std::abs(solver.overlap() - sphere_overlap(1)), 1e4 * k_rtol);
}

}  // namespace
}  // namespace monograin::sundials_facts_test
