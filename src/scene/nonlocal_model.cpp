#include "scene/nonlocal_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "elastic/hertz.hpp"
#include "elastic/nonlocal_limit.hpp"
#include "scene/choice.hpp"

namespace monograin {

nonlocal::Model nonlocal_model_of(const Scenario& scenario) {
  using nonlocal::Influence;
  using nonlocal::Terms;
  return {.poisson_ratio = scenario.material.at("poisson_ratio"),
          .terms = choice<Terms>(
              scenario, "terms",
              {{"4", Terms::four}, {"1", Terms::one}, {"2", Terms::two}, {"3", Terms::three}, {"inf", Terms::all}}),
          .influence = choice<Influence>(scenario, "influence",
                                         {{"half-space", Influence::half_space}, {"sphere", Influence::sphere}})};
}

std::optional<double> nonlocal_limit_of(const Scenario& scenario) {
  const Scene scene = make_scene(scenario);
  std::vector<Ramp> ramps;
  std::optional<Ramp> driven;
  double end = std::numeric_limits<double>::infinity();  // where a wall reaches the centre
  for (std::size_t c = 0; c < scene.classes.size(); ++c) {
    const double start = -scene.classes[c].gap / scenario.radius;
    ramps.push_back({start, start, Control::displacement});
    if (scene.channels[c].program.empty()) continue;
    const Step& step = scene.channels[c].program.front();
    if (step.kind == Step::Kind::force) return std::nullopt;
    if (step.kind != Step::Kind::displacement) continue;
    ramps.back().end = step.target / scenario.radius;
    const double speed = ramps.back().end - start;
    if (speed > 0.0) end = std::min(end, (1.0 - start) / speed);
    if (!driven) driven = ramps.back();
  }
  if (!driven || !std::isfinite(end)) return std::nullopt;
  nonlocal::Contacts contacts(nonlocal_model_of(scenario), scene.classes,
                              scenario.loading.centre_is_free ? nonlocal::Centre::free : nonlocal::Centre::fixed);
  std::vector<double> y(contacts.unknown_count(), 0.0);
  for (std::size_t c = 0; c < ramps.size(); ++c) y[c] = ramps[c].start;
  try {
    const auto xi = nonlocal::limit_of_step(contacts, ramps, end, y);
    return xi ? std::optional(std::lerp(driven->start, driven->end, *xi)) : std::nullopt;
  } catch (const std::domain_error&) {
    return std::nullopt;  // a contact becomes as wide as the particle, or nothing holds the centre
  }
}

Reach nonlocal_reach(const Scenario& scenario, const Until& until) {
  constexpr double k_infinity = std::numeric_limits<double>::infinity();
  const nonlocal::LocalLaw law(nonlocal_model_of(scenario).terms);
  const double radius = scenario.radius;
  const double modulus =
      composite_modulus(scenario.material.at("youngs_modulus"), scenario.material.at("poisson_ratio"));
  const double force_unit = modulus * radius * radius;
  double square = k_infinity;  // of the contact radius
  switch (until.quantity) {
    case Until::Quantity::force:
      if (until.value < force_unit * law.greatest_force()) square = law.signed_square_under(until.value / force_unit);
      break;
    case Until::Quantity::displacement:
      if (until.value < radius) square = law.signed_square(until.value / radius);
      break;
    case Until::Quantity::contact_radius:
      square = std::pow(until.value / radius, 2);
      break;
    case Until::Quantity::pressure:
      square = std::pow(0.75 * std::numbers::pi * until.value / modulus, 2);  // with one term; others raise it
      break;
    default:
      break;
  }
  if (!(square < 1.0)) return {.displacement = k_infinity, .force = k_infinity};
  const nonlocal::LocalContact contact = law.at(square);
  return {.displacement = contact.approach * radius, .force = contact.force * force_unit};
}

}  // namespace monograin
