#include "study/atlas/profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "catalogue.hpp"
#include "figure/chart.hpp"
#include "figure/run_curves.hpp"
#include "history/run.hpp"
#include "scenario/text_file.hpp"
#include "scenario/words.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

/// Keeps the profiles at one output point.
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
    if (side != RowSide::output || has_come_ || !is_asked_for) return;
    has_come_ = true;
    for (std::size_t c = 0; c < system_.classes().size(); ++c) {
      for (const SurfacePoint& p : system_.surface(static_cast<int>(c), xi_, state_)) {
        const double row[] = {static_cast<double>(c), p.radius, p.pressure, p.displacement, p.relaxed_height};
        profiles_.append(row);
      }
    }
  }

  void event(const Event&) override {}

  [[nodiscard]] bool has_come() const noexcept { return has_come_; }
  [[nodiscard]] const Table& profiles() const noexcept { return profiles_; }

 private:
  HybridSystem& system_;
  double instant_ = 0.0;
  double time_ = 0.0;
  Table profiles_;
  double xi_ = 0.0;
  std::vector<double> state_;
  bool has_come_ = false;
};

/// A column over the points of one class.
std::vector<double> of_class(const Table& profiles, std::size_t c, std::string_view name, double scale) {
  std::vector<double> values;
  const std::size_t column = *profiles.find(name);
  for (std::size_t row = 0; row < profiles.row_count(); ++row) {
    if (static_cast<std::size_t>(profiles.at(row, 0)) == c) values.push_back(profiles.at(row, column) * scale);
  }
  return values;
}

}  // namespace

Table contact_profiles(const CheckedScenario& scenario, double time) {
  if (!find_model(scenario.model)->has_profile) {
    std::vector<std::string_view> names;
    for (const Model& model : model_catalogue()) {
      if (model.has_profile) names.push_back(model.name);
    }
    throw std::runtime_error(fmt::format("model '{}' has no profile under its contacts; those of {} have one",
                                         scenario.model, listed(names)));
  }
  Scene scene = make_scene(scenario);
  ProfileSink sink(*scene.system, time);
  const Output output{.points = 0, .times = {time}};
  const IntegratorChoice integrator = choose_integrator(scenario.numerics.integrator, *scene.system);
  const DriveResult result =
      drive(scene, integrator.used, {scenario.numerics.rtol, scenario.numerics.atol}, output, sink);
  if (!sink.has_come()) {
    throw std::runtime_error(
        fmt::format("there is no profile at t = {:g} s: the run {}", time,
                    result.message.empty() ? "does not come to that instant" : "ended before, at " + result.message));
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

fs::path draw_profiles(const Table& profiles, const fs::path& output) {
  const double length = profiles.header_number("R0").value_or(1.0);
  const std::optional<double> yield_stress = profiles.header_number("Y");
  const std::string distance = "Distance from the middle {/:Italic r} / {/:Italic R}_0";
  figure::ChartPanel pressure{
      .x = {.label = distance},
      .y = {.label = yield_stress ? "Pressure {/:Italic p} / {/:Italic Y}" : "Pressure {/:Italic p} [Pa]"}};
  figure::ChartPanel surface{.x = {.label = distance}, .y = {.label = "Height {/:Italic z} / {/:Italic R}_0"}};
  const Column& classes = profiles.columns()[0];
  double highest = 0.0;
  double lowest = 0.0;
  for (std::size_t c = 0; c < classes.labels.size(); ++c) {
    const std::vector<double> radius = of_class(profiles, c, "radius", 1.0 / length);
    if (radius.empty()) continue;
    using Style = figure::ChartSeries::Style;
    const auto add = [&](figure::ChartPanel& panel, const std::string& state, Style style, std::vector<double> y) {
      panel.series.push_back({.legend = figure::verbatim_text(classes.labels[c]) + state,
                              .style = style,
                              .colour = c,
                              .x = radius,
                              .y = std::move(y)});
    };
    std::vector<double> load = of_class(profiles, c, "pressure", 1.0 / yield_stress.value_or(1.0));
    highest = std::max(highest, std::ranges::max(load));
    lowest = std::min(lowest, std::ranges::min(load));
    add(pressure, "", Style::solid, std::move(load));
    // Heights are counted from the middle of the relaxed surface; the loaded surface is flat in contact.
    std::vector<double> relaxed = of_class(profiles, c, "relaxed_height", -1.0 / length);
    std::vector<double> loaded = of_class(profiles, c, "displacement", -1.0 / length);
    std::ranges::transform(relaxed, loaded, loaded.begin(), std::plus<>());
    add(surface, "", Style::solid, std::move(loaded));
    add(surface, ", relaxed", Style::dashed, std::move(relaxed));
  }
  // The tension at the edge of an adhesive contact is unbounded.
  if (lowest < -2.0 * highest) pressure.y.lowest = -2.0 * highest;
  const figure::Chart chart{.panels = {std::move(pressure), std::move(surface)},
                            .references = figure::references_of(profiles)};
  fs::path csv = output;
  csv.replace_extension(".csv");
  expect_own_file(csv, csv);
  figure::draw_chart(chart, fmt::format("contact profiles of {}", profiles.header_value("scenario")), output);
  figure::write_whole(csv, csv_text(profiles));
  return csv;
}

}  // namespace monograin
