// The bounds of the work in one step of a program.

#include "engine/step_work.hpp"

#include <string>

#include <gtest/gtest.h>

#include "engine/fake_integrator.hpp"
#include "support/toy_system.hpp"

namespace monograin::step_work_test {
namespace {

class StepWorkTest : public ::testing::Test {
 protected:
  StepWorkTest() {
    toy_.watched = {{"yield", 1, [](double, ToySystem::View y) { return y[0] - 1.0; }}};
    toy_.finish();
    guards_.begin_leg({}, 0.0, std::vector<double>{0.0});
    work_.begin();
  }
  /// Repeats an action until it throws. @return how often it did not, and why it does
  template <class Action>
  std::pair<int, SolverError> repeat(Action&& action) {
    for (int count = 0; count < 100'000; ++count) {
      try {
        action();
      } catch (const SolverError& error) {
        return {count, error};
      }
    }
    return {-1, SolverError(Failure::set_up, 0.0, 0.0, "goes on without end")};
  }

  ToySystem toy_;
  GuardSet guards_{toy_};
  FakeIntegrator integrator_;
  StepWork work_{integrator_, guards_};
};

TEST_F(StepWorkTest, EndsAfterTheInternalStepsThatTheIntegratorMayTake) {
  const auto [count, error] = repeat([&] { work_.begin_internal_step(0.5); });
  EXPECT_EQ(count, 10);
  EXPECT_EQ(error.failure(), Failure::too_much_work);
  EXPECT_EQ(error.xi(), 0.5);
}

TEST_F(StepWorkTest, EndsAfterTenEvaluationsForEachOfThoseSteps) {
  integrator_.work.rhs_evaluations = 1'000;
  work_.begin();
  integrator_.work.rhs_evaluations = 1'100;
  EXPECT_NO_THROW(work_.begin_internal_step(0.0));
  integrator_.work.rhs_evaluations = 1'101;
  EXPECT_THROW(work_.begin_internal_step(0.0), SolverError);
}

TEST_F(StepWorkTest, EndsAfterAThousandInternalStepsWithoutProgress) {
  EXPECT_EQ(repeat([&] { work_.end_internal_step(0.5, 0.5); }).first, 1000);
  work_.begin();
  double xi = 0.0;
  const auto advance = [&] {
    work_.end_internal_step(xi, xi + 1e-15);
    xi += 1e-15;
  };
  EXPECT_EQ(repeat(advance).first, -1);
}

TEST_F(StepWorkTest, NamesTheGuardsThatAlternateAtOneInstant) {
  integrator_.guards = {0};
  const auto [count, error] = repeat([&] { work_.count_event(0.0, 0.25); });
  EXPECT_EQ(count, 50);
  EXPECT_EQ(error.failure(), Failure::chattering);
  EXPECT_NE(std::string(error.what()).find("yield of toy"), std::string::npos) << error.what();
}

TEST_F(StepWorkTest, AllowsAThousandEventsWithProgressBetweenThem) {
  const auto [count, error] = repeat([&] { work_.count_event(1e-6, 0.25); });
  EXPECT_EQ(count, 1000);
  EXPECT_EQ(error.failure(), Failure::endless_events);
}

}  // namespace
}  // namespace monograin::step_work_test
