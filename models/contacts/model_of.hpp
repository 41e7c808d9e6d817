/// Makes a model from the law of contacts that each depend on their own wall alone.
#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "contacts/independent.hpp"
#include "contacts/law_check.hpp"
#include "system/model.hpp"
#include "system/number_text.hpp"

namespace monograin::contacts {

/// Events of contacts; the last one is of laws that end at a boundary.
inline constexpr std::array k_events{
    Term{"contact-made", "a wall comes to touch the particle"},
    Term{"contact-lost", "a wall leaves the particle"},
    Term{"load-reversal", "a contact at its largest displacement starts to unload"},
    Term{"reload", "a contact passes its old largest displacement"},
    Term{"retreat", "a contact starts to unload in the middle of a step"},
    Term{"step-end", "end of a step of the program"},
    Term{"until-met", "a step ended early by its condition"},
    Term{"limit", "end of the law's domain; the message says which"},
};

/// True for a law whose tests compare its functions with each other, so that no run has to.
template <class Law>
[[nodiscard]] constexpr bool is_tested() noexcept {
  if constexpr (requires { Law::k_is_tested; }) {
    return Law::k_is_tested;
  } else {
    return false;
  }
}

/// Fills in what follows from the law: the equations, with a fixed or a free centre, wall sets and events where none
/// are named, and whether contacts have areas. The equations refuse a law whose functions contradict each other, by
/// std::runtime_error.
/// @tparam law_of  function from a scenario to its law, as IndependentContacts needs it
template <auto law_of>
[[nodiscard]] Model model_of(Model model) {
  using Law = decltype(law_of(std::declval<const ModelInput&>()));
  if (model.configurations.empty()) model.configurations = k_wall_configurations;
  constexpr bool may_end = requires(const Law& law, const typename Law::Branch& b) { law.next(b); };
  if (model.events.empty()) model.events = std::span(k_events).first(k_events.size() - (may_end ? 0 : 1));
  model.has_free_centre = true;
  model.has_contact_area = k_has_contact_area<Law>;
  model.bind = [](const ModelInput& input, std::vector<ContactClass> classes,
                  const Reach& reach) -> std::unique_ptr<HybridSystem> {
    const Law law = law_of(input);
    if (const double unit = law.unit_force(input.radius); !(unit > 0.0 && std::isfinite(unit))) {
      throw std::runtime_error("unit_force(R0) of the law is " + number_text(unit, 6) + "; expected a force above 0 N");
    }
    if constexpr (!is_tested<Law>()) {
      if (const std::string found = contradiction_in(law, reach.displacement / input.radius); !found.empty()) {
        throw std::runtime_error("the functions of the law do not belong together: " + found);
      }
    }
    return std::make_unique<IndependentContacts<Law>>(law, Settings{input.radius, reach, input.centre_is_free},
                                                      std::move(classes));
  };
  return model;
}

}  // namespace monograin::contacts
