#include "mdr/info.hpp"

#include <array>

namespace monograin::mdr {
namespace {

using std::string_view;

constexpr Range k_positive{.lower = 0.0, .lower_is_open = true};
constexpr Range k_not_negative{.lower = 0.0};
constexpr Range k_poisson{.lower = -1.0, .upper = 0.5, .lower_is_open = true};

constexpr std::array<string_view, 5> k_wall_configurations{"simple", "die", "hydrostatic", "oblique-die", "walls"};

// --- hertz

constexpr std::array k_hertz_material{
    QuantityKey{"youngs_modulus", "Young's modulus", Dimension::stress, k_positive, {}},
    QuantityKey{"poisson_ratio", "Poisson's ratio", Dimension::none, k_poisson, {}},
};

constexpr std::array k_hertz_regimes{
    Term{"open", "the wall does not touch: no force"},
    Term{"elastic", "Hertz contact"},
};

constexpr std::array k_hertz_events{
    Term{"contact-made", "a wall comes to touch the particle"},
    Term{"contact-lost", "a wall leaves the particle"},
    Term{"load-reversal", "a contact starts to unload"},
    Term{"reload", "a contact passes its old maximum overlap"},
    Term{"retreat", "a contact starts to unload in the middle of a step"},
    Term{"step-end", "end of a step of the program"},
    Term{"until-met", "a step ended early by its condition"},
    Term{"limit", "end of the equations' domain; the message says which"},
};

constexpr std::array<string_view, 2> k_hertz_domain{
    "small contacts: contact radius well below the particle radius (no check)",
    "the overlap stays below the diameter",
};

// --- mdr

constexpr std::array k_mdr_material{
    QuantityKey{"youngs_modulus", "Young's modulus", Dimension::stress, k_positive, {}},
    QuantityKey{"poisson_ratio", "Poisson's ratio", Dimension::none, k_poisson, {}},
    QuantityKey{"yield_stress", "uniaxial yield stress", Dimension::stress, k_positive, {}},
    QuantityKey{"surface_energy", "effective surface energy of the particle-wall contact", Dimension::surface_energy,
                k_not_negative, 0.0},
};

constexpr std::array<string_view, 3> k_radius_rules{"yielded", "gated", "seed"};
constexpr std::array<string_view, 2> k_elastic_profiles{"ellipse", "parabola"};
constexpr std::array<string_view, 2> k_delta_max_rules{"running-maximum", "shifted"};

constexpr std::array k_mdr_options{
    OptionKey{"radius_rule", "which contacts make the apparent radius grow, and when", OptionKey::Kind::choice,
              k_radius_rules},
    OptionKey{"elastic_profile", "indenter of an elastic contact: the unified ellipse or Hertz's parabola",
              OptionKey::Kind::choice, k_elastic_profiles},
    OptionKey{"delta_max_rule", "whether the largest overlap of an unloaded contact moves with the apparent radius",
              OptionKey::Kind::choice, k_delta_max_rules},
    OptionKey{"strict", "stop where the contact caps intersect instead of warning", OptionKey::Kind::toggle, {}},
    OptionKey{"pressure_table",
              "own curve of p_Y/Y over delta_max/R instead of 1 + 1.75 exp(-4.4 x): CSV, from 0 on",
              OptionKey::Kind::file,
              {}},
};

constexpr std::array k_mdr_regimes{
    Term{"open", "the wall does not touch an undented surface: no force"},
    Term{"elastic", "elastic contact, loading, unloading or reloading"},
    Term{"fully-plastic", "yielded contact at its largest overlap"},
    Term{"unloading", "yielded contact below its largest overlap, unloading or reloading elastically"},
    Term{"separated", "yielded contact that has opened over its dent: no force"},
    Term{"adhering", "adhesive contact below its largest load: its edge sticks, the contact radius stays"},
    Term{"peeling", "adhesive contact whose edge recedes in equilibrium between elastic and surface energy"},
};

constexpr std::array k_mdr_events{
    Term{"contact-made", "a wall comes to touch the particle"},
    Term{"contact-lost", "a wall leaves the particle, or its dent"},
    Term{"dent-touched", "a wall touches the bottom of its dent again"},
    Term{"yield", "an elastic contact becomes fully plastic"},
    Term{"load-reversal",
         "a contact at its largest overlap starts to unload at a corner of the program or of the growth"},
    Term{"retreat", "a contact at its largest overlap starts to unload in the middle of a step"},
    Term{"reload", "a contact passes its old maximum overlap"},
    Term{"stick", "the edge of an adhesive contact comes to rest as the load is reversed"},
    Term{"peel", "the springs at the edge of an adhesive contact tear, and the edge begins to recede"},
    Term{"follow", "no spring at the edge is stretched any more, and the edge advances with the load again"},
    Term{"pull-off", "the edge of an adhesive contact turns unstable and the contact opens at once"},
    Term{"force-extremum", "the force of an adhesive contact that pulls is greatest or least: nothing changes there"},
    Term{"growth-on", "the apparent radius starts to grow"},
    Term{"growth-off", "the apparent radius stops growing"},
    Term{"caps-intersect", "the caps of two contacts meet: the source's limit of validity (warning; stop if strict)"},
    Term{"step-end", "end of a step of the program"},
    Term{"until-met", "a step ended early by its condition"},
    Term{"singular-growth", "the free surface is used up: the apparent radius would run away"},
    Term{"volume-limit", "elastic compression to half the volume"},
    Term{"limit", "another end of the equations' domain; the message says which"},
};

constexpr std::array<string_view, 9> k_mdr_domain{
    "E/Y above about 10 (small elastic strains); a warning below",
    "a contact yields only where E/(1 - nu^2)/Y exceeds 2.407; a warning below",
    "contact caps do not intersect (event caps-intersect)",
    "with pressure_table: contacts at their largest overlap within the table; the run stops where it ends",
    "warned: adhesive contacts whose pull-off the convex indenter, without yielding in tension, does not predict well",
    "at yield under a prescribed force (ellipse) the wall gives way at once and takes the apparent radius along, by up "
    "to "
    "3e-4 R0 where E/Y is 10 and more",
    "under a prescribed force a plastic contact that has softened to 1 % of its first stiffness, at overlaps of nine "
    "tenths "
    "of the apparent radius, ends the run: at a given radius it bears no more than a largest force",
    "a mode in which every contact's branch agrees with its motion need not exist (several loaded walls while the "
    "radius "
    "grows): the run stops there",
    "warned: dissipation that falls by more than 1e-6 of the energy. radius_rule yielded, where plastic contacts alone "
    "make the radius grow, is the default because it creates none without adhesion; gated and seed, which the source's "
    "curves are drawn with, create up to half the work where elastic contacts grow (E/Y below 41 at nu = 0.3)",
};

}  // namespace

ModelInfo hertz_info() noexcept {
  return {.name = "hertz",
          .summary = "elastic sphere between rigid walls, Hertz contacts at fixed radius",
          .source = "Hertz (1882); 002_000df8fc37500451.txt, eq. 25",
          .material = k_hertz_material,
          .options = {},
          .configurations = k_wall_configurations,
          .has_free_centre = true,
          .has_profile = true,
          .regimes = k_hertz_regimes,
          .events = k_hertz_events,
          .domain = k_hertz_domain};
}

ModelInfo mdr_info() noexcept {
  return {.name = "mdr",
          .summary = "elastic-perfectly plastic particle by dimensionality reduction, with growing apparent radius",
          .source = "002_000df8fc37500451.txt (Zunker and Kamrin, Part I)",
          .material = k_mdr_material,
          .options = k_mdr_options,
          .configurations = k_wall_configurations,
          .has_free_centre = true,
          .has_profile = true,
          .regimes = k_mdr_regimes,
          .events = k_mdr_events,
          .domain = k_mdr_domain};
}

}  // namespace monograin::mdr
