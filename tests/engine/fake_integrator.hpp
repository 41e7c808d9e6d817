// An integrator whose last step, work and fired guards a test sets.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "engine/integrator.hpp"

namespace monograin {

class FakeIntegrator final : public Integrator {
 public:
  std::function<double(double xi)> curve = [](double xi) { return xi; };  ///< the only unknown
  std::vector<std::size_t> guards;                                        ///< that have fired
  double tolerance = 1e-6;
  Statistics work;
  long most = 10;

  void begin(double, std::span<const double>) override {}
  Advance advance() override { return {1.0, false}; }
  [[nodiscard]] std::span<const std::size_t> fired() const noexcept override { return guards; }
  void dense_output(double xi, std::span<double> y) override { y[0] = curve(xi); }
  [[nodiscard]] double guard_tolerance() const noexcept override { return tolerance; }
  [[nodiscard]] Statistics statistics() const override { return work; }
  [[nodiscard]] long most_steps() const noexcept override { return most; }
};

}  // namespace monograin
