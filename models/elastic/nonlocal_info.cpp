#include "elastic/nonlocal_info.hpp"

#include <array>

#include "elastic/nonlocal_contacts.hpp"

namespace monograin::nonlocal {
namespace {

using std::string_view;

constexpr std::array k_material{
    QuantityKey{"youngs_modulus", "Young's modulus", Dimension::stress, {.lower = 0.0, .lower_is_open = true}, {}},
    QuantityKey{"poisson_ratio", "Poisson's ratio", Dimension::none, {.lower = 0.0, .upper = 0.5}, {}},
};

constexpr std::array<string_view, 5> k_terms{"4", "1", "2", "3", "inf"};
constexpr std::array<string_view, 4> k_radius_rules{"closed", "integral", "projected", "none"};
constexpr std::array<string_view, 2> k_influences{"half-space", "sphere"};

constexpr std::array k_options{
    OptionKey{"terms",
              "terms of the particle's profile in the local law; 1: Hertz, inf: the sphere itself (the "
              "workbench's own)",
              OptionKey::Kind::choice, k_terms},
    OptionKey{
        "contact_radius_rule",
        "contact radius in the deformed configuration: the source's closed form or its integral, the same with the "
        "displacement projected on the true radial direction (the workbench's own), or none",
        OptionKey::Kind::choice, k_radius_rules},
    OptionKey{
        "influence",
        "what a force does elsewhere on the surface: the source's half-space, or the sphere's exact solution without "
        "its logarithm (the workbench's own; for nearly incompressible material)",
        OptionKey::Kind::choice, k_influences},
};

constexpr std::array<string_view, 5> k_configurations{"simple", "die", "hydrostatic", "oblique-die", "walls"};

constexpr std::array k_regimes{
    Term{"open", "the wall does not touch: no force"},
    Term{"elastic", "elastic contact"},
};

constexpr std::array k_events{
    Term{"contact-made", "a contact closes, also one that the surface is pushed against"},
    Term{"contact-lost", "a contact opens, also under growing load where close neighbours push the surface away"},
    Term{"impingement", "the circles of two contacts meet on the surface: circular contacts are no longer right"},
    Term{"stiffening", "the margin to the limit of applicability falls below 0.25 (warning)"},
    Term{"step-end", "end of a step of the program"},
    Term{"until-met", "a step ended early by its condition"},
    Term{"limit", "limit of applicability: the stiffness becomes infinite; or a wall at the centre of the particle"},
    Term{"radius-limit", "a contact is as wide as the particle"},
};

constexpr std::array<string_view, 8> k_domain{
    "up to the limit of applicability, where the margin is 0 (column margin; stop), well before it the source's "
    "formulation stiffens too much",
    "up to contacts as wide as the particle, with all terms but for 1e-6 (stop; not with contact_radius_rule none "
    "and 1 to 4 terms)",
    "walls at least 0.05 rad apart: the influence is that of a point force",
    "works best for nearly incompressible material, where errors of the half-space cancel: under hydrostatic "
    "compression "
    "the compliance is off by 1 % at nu = 0.48 and by -26 % at nu = 0.3",
    "more terms are no better everywhere: between two walls, against finite elements of rubber, four are better than "
    "one "
    "up to 0.3 R0 and worse beyond (force -15 against -3 % at 0.45 R0)",
    "the closed contact radius is off from its integral by a quarter of the correction at a = R0/2 and 90 degrees",
    "a wall under a force follows the surface, also under no force, and closes a gap at once",
    "a free centre that only touching walls keep from moving has no definite place, and their contacts no definite "
    "regime",
};

}  // namespace

ModelInfo nonlocal_info() noexcept {
  return {.name = "nonlocal",
          .summary = "linear elastic sphere, of which every contact moves the surface under all others",
          .source = "003_97bacd62ecebe201.txt (Agarwal and Gonzalez)",
          .material = k_material,
          .options = k_options,
          .configurations = k_configurations,
          .has_free_centre = true,
          .has_profile = true,
          .regimes = k_regimes,
          .events = k_events,
          .domain = k_domain,
          .least_wall_angle = k_least_wall_angle};
}

}  // namespace monograin::nonlocal
