#include "study/atlas/adhesion_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "catalogue.hpp"
#include "history/recorder.hpp"
#include "history/run.hpp"
#include "scenario/integrators.hpp"
#include "scenario/scenario.hpp"
#include "scene/scene.hpp"

namespace monograin {
namespace {

/// The map of the one model that offers one.
const AdhesionMap& offered_map() {
  const auto has_map = [](const Model& model) { return model.adhesion_map != nullptr; };
  return *std::ranges::find_if(model_catalogue(), has_map)->adhesion_map;
}

void check(const AdhesionMapSettings& settings) {
  if (!(settings.least_modulus > 0.0) || !(settings.least_yield_stress > 0.0) || !(settings.decades > 0.0))
    throw std::invalid_argument("the axes of an adhesion map begin above zero and extend over some decades");
  if (settings.points < 2) throw std::invalid_argument("an axis of an adhesion map has two points or more");
}

std::vector<double> logarithmic_axis(double least, double decades, std::size_t points) {
  std::vector<double> axis(points);
  for (std::size_t i = 0; i < points; ++i) {
    axis[i] = least * std::pow(10.0, decades * static_cast<double>(i) / static_cast<double>(points - 1));
  }
  return axis;
}

}  // namespace

std::vector<FlattenedContact> flatten(double modulus_over_yield, double poisson_ratio,
                                      std::span<const double> displacements) {
  if (!(modulus_over_yield > 0.0) || !std::isfinite(modulus_over_yield))
    throw std::invalid_argument("E/Y has to be positive and finite");
  if (!(poisson_ratio > -1.0 && poisson_ratio <= 0.5))
    throw std::invalid_argument("Poisson's ratio has to lie in (-1, 0.5]");
  if (displacements.empty() || !(displacements.front() > 0.0) ||
      std::ranges::adjacent_find(displacements, std::ranges::greater_equal()) != displacements.end())
    throw std::invalid_argument("displacements have to be positive and to ascend");

  const AdhesionMap& map = offered_map();
  const double run_modulus = std::min(modulus_over_yield, map.stiffest_run);
  CheckedScenario scenario = parse_scenario(map.scenario, "adhesion map");
  scenario.material.at("poisson_ratio") = poisson_ratio;
  scenario.material.at("yield_stress") = 1.0 / run_modulus;
  // The wall moves by one metre in a second: time and displacement have the same number.
  scenario.loading.steps.front().target = displacements.back();
  scenario.loading.steps.front().duration = displacements.back();
  scenario.output.times.assign(displacements.begin(), displacements.end());

  Scene scene = make_scene(scenario);
  const RunRecord record = record_run(scene, integrators::k_direct, {}, scenario.output);
  if (record.status != RunStatus::complete)
    throw std::runtime_error(fmt::format("E/Y = {}: {}", modulus_over_yield, record.message));

  const Table& history = record.history;
  const std::string contact_class = scene.classes.front().name;
  const std::vector<double> times = history.column("time");
  const std::vector<double> apparent_radius = history.column("apparent_radius");
  const std::vector<double> overlap = history.column(contact_class + ".overlap");
  const std::vector<double> contact_radius = history.column(contact_class + ".contact_radius");
  const std::size_t regime = history.find(contact_class + ".regime").value();

  std::vector<FlattenedContact> contacts;
  for (const std::size_t i : output_rows(history)) {
    if (times[i] == 0.0) continue;
    contacts.push_back({.modulus_over_yield = modulus_over_yield,
                        .poisson_ratio = poisson_ratio,
                        .displacement = times[i],
                        .apparent_radius = apparent_radius[i],
                        .overlap = overlap[i],
                        .contact_radius = contact_radius[i],
                        .has_yielded = history.word(i, regime) == map.yielded});
  }
  return contacts;
}

std::vector<AdhesionDiagram> adhesion_maps(const AdhesionMapSettings& settings) {
  check(settings);
  const std::size_t points = settings.points;
  const std::vector<double> modulus = logarithmic_axis(settings.least_modulus, settings.decades, points);
  const std::vector<double> yield_stress = logarithmic_axis(settings.least_yield_stress, settings.decades, points);
  const AdhesionMap& map = offered_map();
  std::vector<AdhesionDiagram> diagrams;
  for (const double displacement : settings.displacements) {
    diagrams.push_back({displacement, map.classes, modulus, yield_stress, std::vector<std::size_t>(points * points)});
  }
  // A diagonal begins in the first column or in the first row; its other points have the same E/Y.
  for (std::size_t diagonal = 0; diagonal + 1 < 2 * points; ++diagonal) {
    const std::size_t first_row = diagonal < points ? diagonal : 0;
    const std::size_t first_column = diagonal < points ? 0 : diagonal - (points - 1);
    const double composite_over_yield = modulus[first_column] / yield_stress[first_row];
    const std::vector<FlattenedContact> contacts =
        flatten(composite_over_yield * (1.0 - settings.poisson_ratio * settings.poisson_ratio), settings.poisson_ratio,
                settings.displacements);
    for (std::size_t k = 0; std::max(first_row, first_column) + k < points; ++k) {
      const std::size_t row = first_row + k;
      const std::size_t column = first_column + k;
      for (std::size_t d = 0; d < diagrams.size(); ++d) {
        diagrams[d].classes[row * points + column] =
            map.classify(contacts[d], modulus[column], yield_stress[row], settings.control);
      }
    }
  }
  return diagrams;
}

}  // namespace monograin
