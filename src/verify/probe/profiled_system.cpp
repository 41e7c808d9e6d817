#include "verify/probe/profiled_system.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <ctime>
#include <stdexcept>
#include <utility>

#include "system/resolution.hpp"
#include "system/wrapped_system.hpp"

namespace monograin {
namespace {

using Clock = std::chrono::steady_clock;
using State = std::span<double>;
using View = std::span<const double>;

/// Time for one reading of the clock [s], on an otherwise idle processor.
double clock_cost() {
  constexpr int k_readings = 100;
  double least = k_infinity;
  for (int batch = 0; batch < 20; ++batch) {
    const auto start = Clock::now();
    Clock::time_point last = start;
    for (int i = 0; i < k_readings; ++i) last = Clock::now();
    least = std::min(least, std::chrono::duration<double>(last - start).count() / k_readings);
  }
  return least;
}

class Profiled final : public WrappedSystem {
 public:
  Profiled(std::unique_ptr<HybridSystem> system, SystemProfile& profile)
      : WrappedSystem(std::move(system)), profile_(profile), clock_cost_(clock_cost()) {}

  void begin_step(std::span<const Ramp> ramps, State y, std::vector<Event>& log) override {
    time(profile_.law, [&] { WrappedSystem::begin_step(ramps, y, log); });
  }
  void complete(double xi, State y) override {
    time(profile_.law, [&] { WrappedSystem::complete(xi, y); });
  }
  void rates(double xi, View y, State dy) override {
    time(profile_.law, [&] { WrappedSystem::rates(xi, y, dy); });
  }
  void all_rates(double xi, View y, State dy) override {
    time(profile_.law, [&] { WrappedSystem::all_rates(xi, y, dy); });
  }
  void residual(double xi, View y, View dy, State res) override {
    time(profile_.law, [&] { WrappedSystem::residual(xi, y, dy, res); });
  }
  void solve(double xi, State y) override {
    time(profile_.law, [&] { WrappedSystem::solve(xi, y); });
  }
  [[nodiscard]] std::optional<double> closed_quadrature(double xi, View y) override {
    std::optional<double> result;
    time(profile_.law, [&] { result = WrappedSystem::closed_quadrature(xi, y); });
    return result;
  }
  void guard_values(double xi, View y, State values) override {
    time(profile_.guards, [&] { WrappedSystem::guard_values(xi, y, values); });
  }
  std::optional<DomainEnd> fire(std::span<const std::size_t> fired, double xi, State y,
                                std::vector<Event>& log) override {
    std::optional<DomainEnd> result;
    time(profile_.law, [&] { result = WrappedSystem::fire(fired, xi, y, log); });
    return result;
  }
  void observe(double xi, View y, State values) override {
    time(profile_.recording, [&] { WrappedSystem::observe(xi, y, values); });
  }

 private:
  /// Adds the time of some work to a share, also if the work throws.
  template <class Work>
  void time(SystemProfile::Share& share, Work&& work) {
    struct Lap {
      SystemProfile::Share& share;
      double clock_cost;
      Clock::time_point start = Clock::now();
      ~Lap() {
        share.seconds += std::chrono::duration<double>(Clock::now() - start).count() - clock_cost;
        ++share.calls;
      }
    };
    const Lap lap{share, clock_cost_};
    work();
  }

  SystemProfile& profile_;
  double clock_cost_;
};

/// Throws OutOfTime if the processor time of the thread is up. It grows no faster than the steady clock, which is
/// cheaper to read: that shows when to read the former again.
class TimeLimit {
 public:
  explicit TimeLimit(double end) : end_(end) {}

  void operator()() {
    const Clock::time_point now = Clock::now();
    if (now < next_sample_) return;
    const double left = end_ - thread_seconds();
    if (!(left > 0.0)) throw OutOfTime();
    next_sample_ = now + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(left));
  }

 private:
  double end_;
  Clock::time_point next_sample_;
};

class AlwaysObserved final : public WrappedSystem {
 public:
  explicit AlwaysObserved(std::unique_ptr<HybridSystem> system)
      : WrappedSystem(std::move(system)), values_(observables().size()) {}

  void rates(double xi, View y, State dy) override {
    WrappedSystem::rates(xi, y, dy);
    observe(xi, y, values_);
  }
  void residual(double xi, View y, View dy, State res) override {
    WrappedSystem::residual(xi, y, dy, res);
    observe(xi, y, values_);
  }
  void solve(double xi, State y) override {
    WrappedSystem::solve(xi, y);
    observe(xi, y, values_);
  }

 private:
  std::vector<double> values_;
};

class AlwaysIntegrated final : public WrappedSystem {
 public:
  using WrappedSystem::WrappedSystem;
  [[nodiscard]] std::optional<double> closed_quadrature(double, View) override { return std::nullopt; }
};

class Disturbed final : public WrappedSystem {
 public:
  Disturbed(std::unique_ptr<HybridSystem> system, const std::array<double, 2>& shares)
      : WrappedSystem(std::move(system)), shares_(shares), shown_(unknowns().size()) {}

  void begin_step(std::span<const Ramp> ramps, State y, std::vector<Event>& log) override {
    disturb(y);
    WrappedSystem::begin_step(ramps, y, log);
  }
  void observe(double xi, View y, State values) override {
    std::ranges::copy(y, shown_.begin());
    disturb(shown_);
    try {
      WrappedSystem::complete(xi, shown_);
      WrappedSystem::observe(xi, shown_, values);
    } catch (const std::domain_error&) {
      WrappedSystem::observe(xi, y, values);  // next to a limit
    }
  }

 private:
  void disturb(State y) const {
    for (std::size_t k = 0; k < y.size(); ++k) {
      const Unknown& unknown = unknowns()[k];
      if (unknown.kind == Unknown::Kind::differential && !unknown.is_dependent) y[k] *= 1.0 + shares_[k % 2];
    }
  }

  std::array<double, 2> shares_;
  std::vector<double> shown_;
};

class LookingBeyond final : public WrappedSystem {
 public:
  LookingBeyond(std::unique_ptr<HybridSystem> system, double factor)
      : WrappedSystem(std::move(system)), factor_(factor), inner_rates_(unknowns().size()) {}

  void begin_step(std::span<const Ramp> ramps, State y, std::vector<Event>& log) override {
    longer_.assign(ramps.begin(), ramps.end());
    for (Ramp& ramp : longer_) ramp.end = std::lerp(ramp.start, ramp.end, factor_);
    WrappedSystem::begin_step(longer_, y, log);
  }
  void complete(double xi, State y) override { WrappedSystem::complete(inner(xi), y); }
  void rates(double xi, View y, State dy) override {
    WrappedSystem::rates(inner(xi), y, dy);
    for (double& rate : dy) rate /= factor_;
  }
  void all_rates(double xi, View y, State dy) override {
    WrappedSystem::all_rates(inner(xi), y, dy);
    for (double& rate : dy) rate /= factor_;
  }
  void residual(double xi, View y, View dy, State res) override {
    std::ranges::transform(dy, inner_rates_.begin(), [this](double rate) { return factor_ * rate; });
    WrappedSystem::residual(inner(xi), y, inner_rates_, res);
  }
  void solve(double xi, State y) override { WrappedSystem::solve(inner(xi), y); }
  [[nodiscard]] double next_kink(double after, double xi, View y) override {
    return factor_ * WrappedSystem::next_kink(inner(after), inner(xi), y);
  }
  [[nodiscard]] std::optional<double> closed_quadrature(double xi, View y) override {
    return WrappedSystem::closed_quadrature(inner(xi), y);
  }
  void guard_values(double xi, View y, State values) override { WrappedSystem::guard_values(inner(xi), y, values); }
  std::optional<DomainEnd> fire(std::span<const std::size_t> fired, double xi, State y,
                                std::vector<Event>& log) override {
    return WrappedSystem::fire(fired, inner(xi), y, log);
  }
  void observe(double xi, View y, State values) override { WrappedSystem::observe(inner(xi), y, values); }
  [[nodiscard]] double quantity(Quantity quantity, int channel, double xi, View y) override {
    return WrappedSystem::quantity(quantity, channel, inner(xi), y);
  }
  [[nodiscard]] double controlled(Control control, int channel, double xi, View y) override {
    return WrappedSystem::controlled(control, channel, inner(xi), y);
  }
  [[nodiscard]] std::vector<SurfacePoint> surface(int contact_class, double xi, View y) override {
    return WrappedSystem::surface(contact_class, inner(xi), y);
  }

 private:
  [[nodiscard]] double inner(double xi) const noexcept { return xi / factor_; }

  double factor_;
  std::vector<Ramp> longer_;
  std::vector<double> inner_rates_;
};

}  // namespace

std::unique_ptr<HybridSystem> profiled(std::unique_ptr<HybridSystem> system, SystemProfile& profile) {
  return std::make_unique<Profiled>(std::move(system), profile);
}

std::unique_ptr<HybridSystem> always_observed(std::unique_ptr<HybridSystem> system) {
  return std::make_unique<AlwaysObserved>(std::move(system));
}

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

double thread_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::unique_ptr<HybridSystem> limited(std::unique_ptr<HybridSystem> system, double end) {
  return std::make_unique<WatchedSystem>(std::move(system), TimeLimit(end));
}

std::unique_ptr<HybridSystem> sampling_beyond(std::unique_ptr<HybridSystem> system, double factor) {
  return std::make_unique<LookingBeyond>(std::move(system), factor);
}

std::unique_ptr<HybridSystem> disturbed(std::unique_ptr<HybridSystem> system, const std::array<double, 2>& shares) {
  return std::make_unique<Disturbed>(std::move(system), shares);
}

std::unique_ptr<HybridSystem> always_integrated(std::unique_ptr<HybridSystem> system) {
  return std::make_unique<AlwaysIntegrated>(std::move(system));
}

}  // namespace monograin
