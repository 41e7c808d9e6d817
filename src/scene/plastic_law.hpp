/// The law of a scenario of model `similarity`, `semimech` or `hardening`.
#pragma once

#include <span>
#include <string_view>

#include "plastic/law.hpp"
#include "scenario/scenario.hpp"
#include "scene/scene.hpp"

namespace monograin {

/// Whether a model is one of these.
[[nodiscard]] bool is_plastic(std::string_view model) noexcept;

[[nodiscard]] plastic::Law plastic_law_of(const Scenario& scenario);
/// The strength [Pa] that stresses of its law are counted in.
[[nodiscard]] double plastic_strength_of(const Scenario& scenario);

/// How far a contact is pressed that reaches a condition's value for the first time, to within 1e-6 of that, or the
/// event that ends a regime; infinity where it never does.
[[nodiscard]] Reach plastic_reach(const Scenario& scenario, const Until& until);

/// Index of the first step of a program that leads a contact back, where the law has no branch for that and the run
/// ends; the number of steps where none does.
[[nodiscard]] std::size_t first_without_branch(const Scenario& scenario, std::span<const Step> program);

}  // namespace monograin
