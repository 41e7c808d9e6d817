#include "engine/forward_sensitivities.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/drive.hpp"
#include "support/toy_system.hpp"

namespace monograin::forward_sensitivities_test {
namespace {

using MadeToy = std::function<std::unique_ptr<ToySystem>(double p)>;

/// y0' = p y0 from 1 to y0 = 2, where y0 jumps by p/2; y0' = -y0 from there.
std::unique_ptr<ToySystem> jumping_toy(double p) {
  auto toy = std::make_unique<ToySystem>();
  ToySystem* const self = toy.get();
  toy->initial = {1.0};
  toy->rates_function = [self, p](double, ToySystem::View y, std::span<double> dy) {
    dy[0] = self->mode == 0 ? p * y[0] : -y[0];
  };
  toy->flow = [](double, ToySystem::View from, double, std::span<double> y) { y[0] = from[0]; };
  toy->watched = {{"jump", 1, [self](double, ToySystem::View y) { return self->mode == 0 ? y[0] - 2.0 : -1.0; },
                   [self, p](std::span<double> y) {
                     self->mode = 1;
                     y[0] += 0.5 * p;
                   }}};
  return toy;
}

/// y0' = sqrt(0.5 p - xi) from 0 to xi = 0.5 p, where it ends; from there y0 stays at 2/3 (0.5 p)^(3/2).
std::unique_ptr<ToySystem> ending_toy(double p) {
  auto toy = std::make_unique<ToySystem>();
  ToySystem* const self = toy.get();
  toy->rates_function = [self, p](double xi, ToySystem::View, std::span<double> dy) {
    dy[0] = self->mode == 0 ? std::sqrt(std::max(0.5 * p - xi, 0.0)) : 0.0;
  };
  toy->flow = [](double, ToySystem::View from, double, std::span<double> y) { y[0] = from[0]; };
  toy->watched = {{.name = "end",
                   .direction = 1,
                   .value = [self, p](double xi, ToySystem::View) { return self->mode == 0 ? xi - 0.5 * p : -1.0; },
                   .transition = [self](std::span<double>) { self->mode = 1; },
                   .is_branch_end = true}};
  return toy;
}

/// y0' = p from 0, with guards that depend on p and y0.
MadeToy rising_toy(std::vector<std::function<double(double p, double y)>> guards) {
  return [guards](double p) {
    auto toy = std::make_unique<ToySystem>();
    toy->rates_function = [p](double, ToySystem::View, std::span<double> dy) { dy[0] = p; };
    toy->flow = [](double, ToySystem::View from, double, std::span<double> y) { y[0] = from[0]; };
    for (std::size_t g = 0; g < guards.size(); ++g) {
      toy->watched.push_back({g == 0 ? "first" : "second", 1,
                              [guard = guards[g], p](double, ToySystem::View y) { return guard(p, y[0]); }});
    }
    return toy;
  };
}

struct Row {
  double time = 0.0;
  RowSide side = RowSide::output;
  double y = 0.0;
  std::vector<double> derivatives;
};

class Rows final : public HistorySink {
 public:
  std::vector<Row> rows;

  void observe(double time, int, double, std::span<const double> y) override { seen_ = {time, {}, y[0], {}}; }
  void take_derivatives(std::span<const double> derivatives) override {
    seen_.derivatives.assign(derivatives.begin(), derivatives.end());
  }
  void append(RowSide side) override {
    rows.push_back(seen_);
    rows.back().side = side;
  }
  void event(const Event&) override {}

 private:
  Row seen_;
};

constexpr Tolerances k_tolerances{1e-9, 1e-12};
constexpr double k_step = 2e-5;

struct Driven {
  std::vector<Row> rows;
  DriveResult result;
};

Driven driven(const MadeToy& made, double p, std::string_view integrator, std::size_t steps = 1) {
  Scene scene = toy_scene(made(p), steps);
  std::vector<Neighbours> neighbours;
  neighbours.push_back({toy_scene(made(p - k_step), steps), toy_scene(made(p + k_step), steps), p, k_step});
  ForwardSensitivities sensitivities(*scene.system, std::move(neighbours));
  Rows sink;
  DriveResult result = drive(scene, integrator, k_tolerances, {.points = 20, .times = {}}, sink, &sensitivities);
  return {sink.rows, result};
}

std::string why_lost(const MadeToy& made) {
  try {
    static_cast<void>(driven(made, 1.0, "cvode-bdf"));
  } catch (const LostSensitivities& lost) {
    return lost.what();
  }
  return {};
}

TEST(ForwardSensitivities, PassAJumpAsTheClosedFormDoes) {
  for (const char* integrator : {"cvode-bdf", "cvode-adams", "ida"}) {
    const double instant = std::log(2.0);  // log(2)/p, p = 1
    bool has_passed = false;
    int at_event = 0;
    for (const Row& row : driven(jumping_toy, 1.0, integrator, 2).rows) {
      const bool is_here = std::abs(row.time - instant) < 1e-7 && row.side != RowSide::output;
      has_passed = has_passed || (is_here && row.side == RowSide::after);
      at_event += is_here ? 1 : 0;
      const double decay = std::exp(instant - row.time);
      const double from_event = decay * 0.5 - 2.5 * decay * instant;  // d(instant)/dp = -instant
      const double at_fixed_time = has_passed ? from_event : row.time * std::exp(row.time);
      const double following = row.side == RowSide::after ? 0.5 : 0.0;  // y0 is 2 and 2 + p/2 at the event
      ASSERT_EQ(row.derivatives.size(), 4U);
      EXPECT_NEAR(row.derivatives[0], is_here ? -instant : 0.0, 1e-8) << integrator << " at " << row.time;
      EXPECT_NEAR(row.derivatives[1], is_here ? following : at_fixed_time, 1e-7) << integrator << " at " << row.time;
    }
    EXPECT_EQ(at_event, 2);
  }
}

TEST(ForwardSensitivities, PassTheEndOfABranchAsTheClosedFormDoes) {
  const double p = 0.97;  // no output point at the end
  for (const char* integrator : {"cvode-bdf", "cvode-adams", "ida"}) {
    bool has_passed = false;
    for (const Row& row : driven(ending_toy, p, integrator).rows) {
      const bool is_here = std::abs(row.time - 0.5 * p) < 1e-7;
      has_passed = has_passed || is_here;
      // The second root is that of fixed time before the end.
      const double expected = 0.5 * (std::sqrt(0.5 * p) - (has_passed ? 0.0 : std::sqrt(0.5 * p - row.time)));
      ASSERT_EQ(row.derivatives.size(), 4U);
      EXPECT_NEAR(row.derivatives[0], is_here ? 0.5 : 0.0, 1e-8) << integrator << " at " << row.time;
      EXPECT_NEAR(row.derivatives[1], expected, 1e-7) << integrator << " at " << row.time;
    }
    EXPECT_TRUE(has_passed);
  }
}

/// y0' = p y0 from 1. The n-th evaluation of the base's rate fails.
MadeToy failing_toy(int n) {
  return [n](double p) {
    auto toy = std::make_unique<ToySystem>();
    ToySystem* const self = toy.get();
    toy->initial = {1.0};
    toy->rates_function = [self, n, p](double, ToySystem::View y, std::span<double> dy) {
      if (p == 1.0 && self->rates_count == n) throw DomainError({.limit = Limit::walls_meet});
      dy[0] = p * y[0];
    };
    toy->flow = [](double, ToySystem::View from, double, std::span<double> y) { y[0] = from[0]; };
    return toy;
  };
}

TEST(ForwardSensitivities, AreThoseOfAnIntegrationThatGoesBackWhereTheEquationsEnd) {
  for (const char* integrator : {"cvode-bdf", "ida"}) {
    for (int n = 5; n < 60; ++n) {
      const Driven run = driven(failing_toy(n), 1.0, integrator);
      ASSERT_EQ(run.result.status, RunStatus::complete) << integrator << ", " << n << ": " << run.result.message;
      EXPECT_NEAR(run.rows.back().y, std::exp(1.0), 1e-8) << integrator << ", " << n;
      EXPECT_NEAR(run.rows.back().derivatives[1], std::exp(1.0), 1e-7) << integrator << ", " << n;
    }
  }
}

TEST(ForwardSensitivities, CostNoMoreThanTwoMoreRuns) {
  for (const char* integrator : {"cvode-bdf", "ida"}) {
    Scene scene = toy_scene(jumping_toy(1.0), 2);
    Rows sink;
    const DriveResult alone = drive(scene, integrator, k_tolerances, {.points = 20, .times = {}}, sink);
    const DriveResult with = driven(jumping_toy, 1.0, integrator, 2).result;
    EXPECT_LT(with.statistics.rhs_evaluations, 3 * alone.statistics.rhs_evaluations) << integrator;
    EXPECT_GT(2 * with.statistics.rhs_evaluations, 3 * alone.statistics.rhs_evaluations) << integrator;
  }
}

TEST(ForwardSensitivities, AreLostWhereANeighbourPassesAnEventThatTheRunDoesNot) {
  const std::string why = why_lost(rising_toy({[](double, double y) { return y - 1.0 - 1e-6; }}));
  EXPECT_NE(why.find("event 'first of toy' earlier or later"), std::string::npos) << why;
}

TEST(ForwardSensitivities, AreLostWhereANeighbourDoesNotPassAnEvent) {
  const std::string why = why_lost(rising_toy({[](double, double y) { return y - 1.0 + 1e-6; }}));
  EXPECT_NE(why.find("does not pass event 'first"), std::string::npos) << why;
}

TEST(ForwardSensitivities, AreLostWhereEventsComeApart) {
  const std::string why = why_lost(
      rising_toy({[](double, double y) { return y - 0.5; }, [](double p, double y) { return p * p * y - 0.5; }}));
  EXPECT_NE(why.find("come apart"), std::string::npos) << why;
}

TEST(ForwardSensitivities, AreLostWhereANeighbourMeetsALimit) {
  const auto made = [](double p) {
    auto toy = rising_toy({[](double, double y) { return y - 2.0; }})(p);
    toy->rates_function = [p](double, ToySystem::View y, std::span<double> dy) {
      if (p != 1.0 && y[0] > 0.5) throw DomainError({.limit = Limit::walls_meet});
      dy[0] = p;
    };
    return toy;
  };
  Scene scene = toy_scene(made(1.0));
  Rows sink;
  ASSERT_EQ(drive(scene, "cvode-bdf", k_tolerances, {.points = 20, .times = {}}, sink).status, RunStatus::complete);
  EXPECT_NE(driven(made, 1.0, "cvode-bdf").result.status, RunStatus::complete);
}

}  // namespace
}  // namespace monograin::forward_sensitivities_test
