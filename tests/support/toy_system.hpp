/// A small hybrid system made of functions, for tests of the engine.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.hpp"
#include "system/hybrid_system.hpp"

namespace monograin {

class ToySystem final : public HybridSystem {
 public:
  using State = std::vector<double>;
  using View = std::span<const double>;

  struct ToyGuard {
    std::string_view name;
    int direction = 1;
    std::function<double(double xi, View y)> value;
    std::function<void(std::span<double> y)> transition = {};
    bool ends_domain = false;
    bool is_silent = false;
    bool is_mark = false;
    bool is_branch_end = false;
  };

  State initial{0.0};
  /// dy/dxi in the present mode.
  std::function<void(double xi, View y, std::span<double> dy)> rates_function = [](double, View, std::span<double> dy) {
    dy[0] = 1.0;
  };
  /// Exact state at xi, from the state at the start of the present mode, for the direct form.
  std::function<void(double start, View from, double xi, std::span<double> y)> flow =
      [](double start, View from, double xi, std::span<double> y) { y[0] = from[0] + xi - start; };
  std::function<double(double xi)> costly_primitive;  ///< primitive of y0, if it has one
  std::vector<double> kinks;                          ///< step coordinates, ascending
  std::vector<ToyGuard> watched;
  bool is_quadrature = false;  ///< y0 is a quadrature: rates do not depend on it
  bool adheres = false;        ///< a force may pass through zero
  int mode = 0;                ///< transitions set it, and rates use it

  // Record of the engine's calls.
  double earliest_xi = 1.0;
  double latest_xi = 0.0;
  int rates_count = 0;
  int primitive_count = 0;
  std::vector<std::vector<std::size_t>> fired_together;

  /// Call when everything above is set.
  void finish() {
    static constexpr std::string_view k_names[] = {"y0", "y1", "y2"};
    for (std::size_t k = 0; k < initial.size(); ++k) {
      const bool is_integral = is_quadrature && k == 0;
      unknowns_.push_back(
          {k_names[k], is_integral ? Unknown::Kind::quadrature : Unknown::Kind::differential, 1.0, false});
      observables_.push_back({std::string(k_names[k]), "m", {}});
    }
    for (std::size_t g = 0; g < watched.size(); ++g) {
      guards_.push_back({.kind = static_cast<int>(g),
                         .index = 0,
                         .direction = watched[g].direction,
                         .name = watched[g].name,
                         .is_silent = watched[g].is_silent,
                         .is_mark = watched[g].is_mark,
                         .is_branch_end = watched[g].is_branch_end});
    }
  }

  [[nodiscard]] std::span<const Unknown> unknowns() const noexcept override { return unknowns_; }
  [[nodiscard]] std::span<const ContactClass> classes() const noexcept override { return classes_; }
  void start(std::span<double> y) override { std::ranges::copy(initial, y.begin()); }
  void begin_step(std::span<const Ramp>, std::span<double> y, std::vector<Event>&) override { remember(0.0, y); }
  [[nodiscard]] std::function<void()> checkpoint() override {
    return [this, then = *this] { *this = then; };
  }
  void complete(double, std::span<double>) override {}
  void rates(double xi, View y, std::span<double> dy) override {
    see(xi);
    ++rates_count;
    rates_function(xi, y, dy);
  }
  void residual(double xi, View y, View dy, std::span<double> res) override {
    rates(xi, y, res);
    for (std::size_t k = 0; k < res.size(); ++k) res[k] = dy[k] - res[k];
  }
  void solve(double xi, std::span<double> y) override {
    see(xi);
    flow(mode_start_, mode_state_, xi, y);
  }
  /// The kinks as a law with a curved path would extrapolate them: with an error of the second order.
  [[nodiscard]] double next_kink(double after, double xi, View) override {
    for (const double kink : kinks) {
      const double extrapolated = kink + 0.1 * (kink - xi) * (kink - xi);
      if (extrapolated > after) return extrapolated;
    }
    return k_infinity;
  }
  [[nodiscard]] std::optional<double> closed_quadrature(double xi, View) override {
    if (!costly_primitive) return std::nullopt;
    ++primitive_count;
    return costly_primitive(xi);
  }
  [[nodiscard]] bool is_quadrature_costly() const noexcept override { return true; }
  [[nodiscard]] std::span<const Guard> guards() const noexcept override { return guards_; }
  void guard_values(double xi, View y, std::span<double> values) override {
    see(xi);
    for (std::size_t g = 0; g < watched.size(); ++g) values[g] = watched[g].value(xi, y);
  }
  std::optional<DomainEnd> fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                std::vector<Event>& log) override {
    fired_together.emplace_back(fired.begin(), fired.end());
    std::optional<DomainEnd> end;
    for (const std::size_t g : fired) {
      if (watched[g].transition) watched[g].transition(y);
      log.push_back({watched[g].name});
      if (watched[g].ends_domain) end = DomainEnd{log.back(), {Limit::walls_meet, -1, "xi", xi}};
    }
    remember(xi, y);
    return end;
  }
  [[nodiscard]] std::span<const Observable> observables() const noexcept override { return observables_; }
  void observe(double, View y, std::span<double> values) override { std::ranges::copy(y, values.begin()); }
  [[nodiscard]] double quantity(Quantity, int, double, View y) override { return y[0]; }
  [[nodiscard]] double controlled(Control control, int, double xi, View y) override {
    return control == Control::force ? y[0] : xi;
  }
  [[nodiscard]] bool contacts_adhere() const noexcept override { return adheres; }

 private:
  void see(double xi) {
    earliest_xi = std::min(earliest_xi, xi);
    latest_xi = std::max(latest_xi, xi);
  }
  void remember(double xi, View y) {
    mode_start_ = xi;
    mode_state_.assign(y.begin(), y.end());
  }

  std::vector<Unknown> unknowns_;
  std::vector<ContactClass> classes_{{"toy", {Eigen::Vector3d::UnitZ()}, 0.0}};
  std::vector<Observable> observables_;
  std::vector<Guard> guards_;
  double mode_start_ = 0.0;
  State mode_state_;
};

/// A scene of a toy, whose program has a number of steps of one second.
[[nodiscard]] inline Scene toy_scene(std::unique_ptr<ToySystem> toy, std::size_t steps = 1) {
  toy->finish();
  Scene scene;
  scene.classes.assign(toy->classes().begin(), toy->classes().end());
  scene.walls = {{"toy"}};
  Step step;
  step.duration = 1.0;
  scene.channels.push_back({"toy", {}, std::vector<Step>(steps, step)});
  scene.system = std::move(toy);
  return scene;
}

/// The toy in a scene, with its record of the engine's calls.
[[nodiscard]] inline const ToySystem& toy_in(const Scene& scene) {
  return dynamic_cast<const ToySystem&>(*scene.system);
}

/// y' = -y from 1: y = exp(-xi).
[[nodiscard]] inline std::unique_ptr<ToySystem> decaying_toy() {
  auto toy = std::make_unique<ToySystem>();
  toy->initial = {1.0};
  toy->rates_function = [](double, ToySystem::View y, std::span<double> dy) { dy[0] = -y[0]; };
  toy->flow = [](double start, ToySystem::View from, double xi, std::span<double> y) {
    y[0] = from[0] * std::exp(start - xi);
  };
  return toy;
}

}  // namespace monograin
