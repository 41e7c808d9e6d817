#include "history/profile.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "catalogue.hpp"
#include "scenario/words.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

struct InstantHasCome {};  // ends the drive

/// Keeps the profiles at one output point, and ends the drive there.
class ProfileSink final : public HistorySink {
 public:
  ProfileSink(HybridSystem& system, double instant) : system_(system), instant_(instant) {
    std::vector<std::string> names;
    for (const ContactClass& c : system.classes()) names.push_back(c.name);
    profiles_ = Table({{"class", "", names},
                       {"radius", "m", {}},
                       {"pressure", "Pa", {}},
                       {"displacement", "m", {}},
                       {"relaxed_height", "m", {}}});
  }

  void observe(double time, int, double xi, std::span<const double> y) override {
    time_ = time;
    xi_ = xi;
    state_.assign(y.begin(), y.end());
  }

  void append(RowSide side) override {
    // The start of the run is an output point, too. An output point at a corner of the program has the corner's time.
    const bool is_asked_for = std::abs(time_ - instant_) <= k_same_number * instant_;
    if (side != RowSide::output || !is_asked_for) return;
    for (std::size_t c = 0; c < system_.classes().size(); ++c) {
      for (const SurfacePoint& p : system_.surface(static_cast<int>(c), xi_, state_)) {
        const double row[] = {static_cast<double>(c), p.radius, p.pressure, p.displacement, p.relaxed_height};
        profiles_.append(row);
      }
    }
    throw InstantHasCome();
  }

  void event(const Event&) override {}

  [[nodiscard]] const Table& profiles() const noexcept { return profiles_; }

 private:
  HybridSystem& system_;
  double instant_ = 0.0;
  double time_ = 0.0;
  Table profiles_;
  double xi_ = 0.0;
  std::vector<double> state_;
};

}  // namespace

Table contact_profiles(const CheckedScenario& scenario, double time, const SystemWrapper& wrapped) {
  if (!find_model(scenario.model)->has_profile) {
    const auto names = names_of_models([](const Model& model) { return model.has_profile; });
    throw std::runtime_error(fmt::format("model '{}' has no profile under its contacts; those of {} have one",
                                         scenario.model, listed(names)));
  }
  if (!std::isfinite(time) || time < 0.0) {
    throw std::runtime_error(
        fmt::format("there is no profile at t = {:g} s: expected a finite instant, 0 or later", time));
  }
  Scene scene = make_scene(scenario);
  if (wrapped) scene.system = wrapped(std::move(scene.system));
  ProfileSink sink(*scene.system, time);
  const Output output{.points = 0, .times = {time}};
  const IntegratorChoice integrator = choose_integrator(scenario.numerics.integrator, *scene.system);
  try {
    const DriveResult result =
        drive(scene, integrator.used, {scenario.numerics.rtol, scenario.numerics.atol}, output, sink);
    throw std::runtime_error(
        fmt::format("there is no profile at t = {:g} s: the run {}", time,
                    result.message.empty() ? "does not come to that instant" : "ended before, at " + result.message));
  } catch (const InstantHasCome&) {
  }
  Table profiles = sink.profiles();
  if (profiles.row_count() == 0) {
    throw std::runtime_error(fmt::format("there is no profile at t = {:g} s: no contact is closed then", time));
  }
  profiles.header = {{"scenario", scenario.name},
                     {"model", scenario.model},
                     {"time", fmt::format("{}", time)},
                     {"R0", fmt::format("{}", scenario.radius)}};
  if (const auto found = scenario.material.find("yield_stress"); found != scenario.material.end()) {
    profiles.header.emplace_back("Y", fmt::format("{}", found->second));
  }
  return profiles;
}

}  // namespace monograin
