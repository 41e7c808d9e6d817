#include "scene/plastic_law.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <variant>

namespace monograin {
namespace {

// Where the search for a condition's value begins, over the limit, at which pressures may be infinite; and where it
// ends, over R0: shallower contacts are rounding, and steps of an integrator so short would be, too.
constexpr double k_deepest = 0.9;
constexpr double k_shallowest = 1e-12;
// How closely the place is then known: next to the limit work may grow by orders over a tenth of the way.
constexpr int k_bisections = 20;
constexpr double k_place = 1e-6;
// Share of a displacement by which a wall that holds its place may seem to go back.
constexpr double k_same_place = 1e-9;

/// What a condition looks at, in SI.
double value_of(const Scenario& scenario, double strength, double x, const plastic::ContactState& contact,
                Until::Quantity quantity) {
  switch (quantity) {
    case Until::Quantity::displacement:
      return x * scenario.radius;
    case Until::Quantity::force:
      return contact.force * strength * scenario.radius * scenario.radius;
    case Until::Quantity::pressure:
      return contact.pressure * strength;
    case Until::Quantity::contact_radius:
      return contact.contact_radius * scenario.radius;
    default:
      return 0.0;
  }
}

/// Walls of other sets are each for themselves, in the one law that allows them.
plastic::Configuration configuration_of(const Scenario& scenario) {
  switch (scenario.loading.configuration) {
    case Loading::Configuration::die:
      return plastic::Configuration::die;
    case Loading::Configuration::hydrostatic:
      return plastic::Configuration::hydrostatic;
    default:
      return plastic::Configuration::simple;
  }
}

}  // namespace

bool is_plastic(std::string_view model) noexcept {
  return model == "similarity" || model == "semimech" || model == "hardening";
}

double plastic_strength_of(const Scenario& scenario) {
  return scenario.material.at(scenario.model == "semimech" ? "yield_stress" : "strength");
}

plastic::Law plastic_law_of(const Scenario& scenario) {
  const auto& material = scenario.material;
  if (scenario.model == "semimech") {
    return plastic::make_semimech(
        plastic::make_semimech_material(material.at("youngs_modulus"), material.at("poisson_ratio"),
                                        material.at("yield_stress")),
        configuration_of(scenario));
  }
  const double exponent = material.at("hardening_exponent");
  if (scenario.model == "hardening") {
    const bool is_ideal = std::get<std::string>(scenario.options.at("minimum_condition")) == "ideal";
    return plastic::make_hardening(exponent, configuration_of(scenario),
                                   is_ideal ? plastic::MinimumCondition::ideal : plastic::MinimumCondition::current);
  }
  const bool is_corrected = std::get<bool>(scenario.options.at("curvature_correction"));
  return plastic::make_similarity(
      exponent, is_corrected ? plastic::SimilarityRadius::corrected : plastic::SimilarityRadius::parabolic);
}

Reach plastic_reach(const Scenario& scenario, const Until& until) {
  const plastic::Law law = plastic_law_of(scenario);
  const double strength = plastic_strength_of(scenario);
  Reach reach{.displacement = std::numeric_limits<double>::infinity(),
              .force = std::numeric_limits<double>::infinity()};
  const auto reach_at = [&](double x, const plastic::ContactState& contact) {
    return Reach{.displacement = x * scenario.radius,
                 .force = contact.force * strength * scenario.radius * scenario.radius};
  };
  if (until.quantity == Until::Quantity::event) {
    for (const plastic::Boundary& boundary : plastic::boundaries(law)) {
      const double x = boundary.approach;
      if (boundary.event != until.event || boundary.beyond == plastic::Regime::undefined) continue;
      return reach_at(x, std::visit([x](const auto& any) { return state_at(any, x); }, law));
    }
    return reach;
  }
  const auto contact_at = [&](double x) { return std::visit([x](const auto& any) { return state_at(any, x); }, law); };
  const auto is_met = [&](double x) {
    return value_of(scenario, strength, x, contact_at(x), until.quantity) >= until.value;
  };
  double first = 0.0;
  // Pressures fall again further in.
  for (double x = k_deepest * plastic::limit(law); x > 0.5 * k_shallowest; x *= 0.5) {
    if (is_met(x)) first = x;
  }
  if (first == 0.0) return reach;
  double before = 0.5 * first;
  for (int k = 0; k < k_bisections; ++k) {
    const double middle = std::midpoint(before, first);
    (is_met(middle) ? first : before) = middle;
  }
  return reach_at(first, contact_at(first));
}

std::size_t first_without_branch(const Scenario& scenario, std::span<const Step> program) {
  const bool may_go_back =
      !is_plastic(scenario.model) || std::get<std::string>(scenario.options.at("unloading")) != "none";
  if (program.size() < 2 || may_go_back) return program.size();
  const plastic::Law law = plastic_law_of(scenario);
  const double force_unit = plastic_strength_of(scenario) * scenario.radius * scenario.radius;
  double deepest = 0.0;  // at least
  for (std::size_t k = 0; k < program.size(); ++k) {
    const Step& step = program[k];
    double x = step.kind == Step::Kind::detach ? 0.0 : deepest;
    try {
      if (step.kind == Step::Kind::displacement) x = step.target / scenario.radius;
      if (step.kind == Step::Kind::force) x = plastic::approach_under(law, std::max(step.target, 0.0) / force_unit);
    } catch (const std::domain_error&) {
      continue;  // ends at a limit of the law
    }
    if (deepest > k_shallowest && x < (1.0 - k_same_place) * deepest) return k;
    for (const Until& until : step.until) {
      const bool is_foreseen = until.value > 0.0 || until.quantity == Until::Quantity::event;
      const double place = plastic_reach(scenario, until).displacement / scenario.radius;
      x = is_foreseen ? std::min(x, (1.0 - k_place) * place) : 0.0;
    }
    deepest = std::max(deepest, x);
  }
  return program.size();
}

}  // namespace monograin
