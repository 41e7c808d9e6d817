/// Makes a model from the contacts of a plastic particle, and defines the words that models of this kind share.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <string_view>
#include <utility>
#include <vector>

#include "plastic/wall_law.hpp"
#include "system/model.hpp"
#include "system/resolution.hpp"

namespace monograin::plastic {

// --- words

inline constexpr std::array<std::string_view, 3> k_source_configurations{"simple", "die", "hydrostatic"};

inline constexpr std::array<std::string_view, 2> k_unloading_rules{"none", "mdr"};

inline constexpr OptionKey k_unloading{
    "unloading",
    "unloading of the contacts: none (the source has no law; a program that unloads is refused) or mdr, "
    "the workbench's own extension, the elastic indenter that model mdr leaves under the "
    "same mean pressure and contact radius",
    OptionKey::Kind::choice, k_unloading_rules};

/// Lists of terms, one after the other.
template <std::size_t... N>
[[nodiscard]] constexpr std::array<Term, (N + ...)> joined(const std::array<Term, N>&... lists) {
  std::array<Term, (N + ...)> all{};
  auto end = all.begin();
  ((end = std::ranges::copy(lists, end).out), ...);
  return all;
}

inline constexpr std::array k_regime_before_contact{Term{"open", "the wall does not touch: no force"}};
inline constexpr std::array k_regime_without_law{
    Term{"undefined", "lateral contact of a die where the source has no law; its columns are nan"}};
inline constexpr std::array k_regimes_of_unloading{
    Term{"unloading", "yielded contact below its largest displacement (unloading = \"mdr\")"},
    Term{"separated", "yielded contact that has opened over its dent: no force"}};

inline constexpr std::array k_events_of_touching{Term{"contact-made", "a wall comes to touch the particle"},
                                                 Term{"contact-lost", "a wall leaves the particle, or its dent"},
                                                 Term{"dent-touched", "a wall touches the bottom of its dent again"}};
inline constexpr std::array k_event_of_neighbours{
    Term{"impingement", "the circles of neighbouring contacts meet; the law does not change there"}};
inline constexpr std::array k_events_of_programs{
    Term{"load-reversal", "a contact at its largest displacement starts to unload"},
    Term{"reload", "a contact passes its old maximum displacement, and the law goes on"},
    Term{"step-end", "end of a step of the program"}, Term{"until-met", "a step ended early by its condition"},
    Term{"limit", "the walls meet at displacement/R0 = 1, or another end of the equations; the message says which"}};

// Validity.
inline constexpr std::string_view k_loading_only = "walls only come nearer, unless unloading = \"mdr\"";
inline constexpr std::string_view k_extension =
    "unloading = \"mdr\" is not of the source: A = 4 p a/E*, b = a, and the unloading branch of model mdr; a contact "
    "that has not yielded unloads along its loading curve";

// --- constants, as `monograin models` shows them, each with its symbol in the source

/// Appends the coefficients of a contact radius to a list.
void add_parameters(const RadiusSeries& series, std::vector<DerivedParameter>& list);
/// Appends the constants of a fall of the mean pressure to a list.
/// @param configuration  in simple compression the constants of the least pressure are left out
void add_parameters(const PressureFall& fall, Configuration configuration, std::vector<DerivedParameter>& list);

// --- from a scenario to the contacts

/// Configuration of a scenario. Other sets of walls count as simple: the law that allows them treats each wall by
/// itself.
[[nodiscard]] Configuration configuration_of(const ModelInput& input);

/// True if the contacts of a scenario may unload: unloading = "mdr".
[[nodiscard]] bool can_unload(const ModelInput& input);

/// True for the columns of lateral contacts: where the source has no law for these, they are nan.
[[nodiscard]] bool may_be_undefined(const CheckedRun& run, std::size_t row, std::string_view column);

/// Reads the properties of contacts from the material and the program of a scenario.
/// @param strength  key of the material's strength S
/// @throws std::invalid_argument if the scenario unloads and has no elastic constants
[[nodiscard]] Settings settings_of(const ModelInput& input, const char* strength, const Reach& reach);

/// Displacement and force at which a contact meets a condition for the first time; infinity for a condition that it
/// does not meet, or whose quantity the law does not have.
template <class Wall>
[[nodiscard]] Reach reach_of(const Wall& wall, double radius, const Until& until) {
  const auto& law = wall.law();
  const double force_unit = wall.unit_force(radius);
  const auto reach_at = [&](double x) { return Reach{x * radius, state_at(law, x).force * force_unit}; };
  if (until.is_event()) {
    for (const Boundary& boundary : boundaries(law)) {
      if (boundary.event == until.event && boundary.beyond != Regime::undefined) return reach_at(boundary.approach);
    }
    return {k_infinity, k_infinity};
  }
  const auto is_met = [&](double x) {
    if (until.quantity == Quantity::displacement) return x * radius >= until.value;
    const ContactState contact = state_at(law, x);
    if (until.quantity == Quantity::force) return contact.force * force_unit >= until.value;
    if (until.quantity == Quantity::pressure) return contact.pressure * wall.strength() >= until.value;
    if (until.quantity == Quantity::contact_radius) return contact.contact_radius * radius >= until.value;
    return until.value <= 0.0;
  };
  double first = 0.0;
  // Pressures fall again at greater depth: the search goes on to the least displacement that meets the condition, down
  // to the resolution.
  for (double x = k_far_from_limit * law.limit; x > 0.5 * k_resolution; x *= 0.5) {
    if (is_met(x)) first = x;
  }
  if (first == 0.0) return {k_infinity, k_infinity};
  double before = 0.5 * first;
  // Next to the limit, work may grow by orders over a tenth of the path.
  for (int k = 0; k < k_most_halvings; ++k) {
    const double middle = std::midpoint(before, first);
    (is_met(middle) ? first : before) = middle;
  }
  return reach_at(first);
}

/// Completes a model with what follows from the contacts: equations, reach, whether a scenario unloads, and columns
/// that may be nan.
/// @tparam wall_law_of  function from a scenario and the reach of its program to the law of one contact
template <auto wall_law_of>
[[nodiscard]] Model model_of(Model model) {
  using Wall = decltype(wall_law_of(std::declval<const ModelInput&>(), Reach{}));
  model.bind = [](const ModelInput& input, std::vector<ContactClass> classes,
                  const Reach& reach) -> std::unique_ptr<HybridSystem> {
    return std::make_unique<contacts::IndependentContacts<Wall>>(
        wall_law_of(input, reach), contacts::Settings{input.radius, reach, input.centre_is_free}, std::move(classes));
  };
  model.reach = [](const ModelInput& input, const Until& until) {
    return reach_of(wall_law_of(input, Reach{}), input.radius, until);
  };
  model.can_unload = can_unload;
  if constexpr (Wall::k_has_neighbours) model.may_be_undefined = may_be_undefined;
  return model;
}

}  // namespace monograin::plastic
