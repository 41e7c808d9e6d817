#include "compressible/contact_info.hpp"

#include <array>
#include <map>
#include <optional>
#include <string>

#include "compressible/presets.hpp"
#include "compressible/regressions.hpp"

namespace monograin::compressible {
namespace {

using std::string_view;

constexpr Range k_positive{.lower = 0.0, .lower_is_open = true};
constexpr Range k_poisson{.lower = -1.0, .upper = 0.5, .lower_is_open = true};
constexpr Range k_from_one{.lower = 1.0};
constexpr Range k_depth{.lower = 0.0, .upper = k_largest_displacement, .lower_is_open = true};

constexpr std::array<string_view, 5> k_configurations{"simple", "die", "hydrostatic", "oblique-die", "walls"};

constexpr std::array k_material{
    QuantityKey{"stiffness_ratio", "Young's modulus over yield pressure, E0/sigma_y0", Dimension::none, k_positive, {}},
    QuantityKey{"shear_ratio",
                "shear strength over yield pressure, Gamma0/sigma_y0; for the regressions and unloading_table only",
                Dimension::none,
                k_positive,
                {},
                true},
    QuantityKey{"tensile_ratio",
                "hydrostatic tensile strength over yield pressure, Lambda0/sigma_y0; the law does not depend on it",
                Dimension::none,
                k_positive,
                {},
                true},
    QuantityKey{"nu0", "Poisson's ratio at the reference density", Dimension::none, k_poisson, {}},
    QuantityKey{"yield_pressure",
                "hydrostatic yield pressure sigma_y0 at the reference density",
                Dimension::stress,
                k_positive,
                {}},
};

constexpr std::array k_columns{
    QuantityKey{"stiffness_over_shear", "E0/Gamma0", Dimension::none, k_positive, {}},
    QuantityKey{"delta_max_over_R0", "largest displacement", Dimension::none, k_depth, {}},
    QuantityKey{"alpha", "exponent of unloading", Dimension::none, k_from_one, {}},
    QuantityKey{"beta", "secant stiffness over that of Hertz", Dimension::none, k_positive, {}},
};

constexpr OptionKey number(string_view name, string_view meaning, Range range) {
  return {name, meaning, OptionKey::Kind::quantity, {}, false, Dimension::none, range};
}

constexpr std::array k_options{
    number("k", "slope of the linear part; from the regression unless given", k_positive),
    number("delta_t", "displacement over R0 at which the exponential part begins; from the regression unless given",
           k_positive),
    number("a", "exponent of the exponential part; from the regression unless given", k_positive),
    number("alpha", "exponent of unloading; 1.5 (Hertz) unless it or unloading_table is given", k_from_one),
    number("beta", "secant stiffness of unloading over that of Hertz; 1 unless it or unloading_table is given",
           k_positive),
    OptionKey{.name = "unloading_table",
              .meaning = "alpha and beta over E0/Gamma0 and the largest displacement: columns stiffness_over_shear, "
                         "delta_max_over_R0, alpha, beta",
              .kind = OptionKey::Kind::file,
              .choices = {},
              .columns = k_columns},
};

constexpr std::array k_regimes{
    Term{"open", "the wall does not touch: no force"},
    Term{"linear", "first loading up to delta_t"},
    Term{"exponential", "first loading beyond delta_t"},
    Term{"unloading", "below the largest displacement so far, back or forth"},
};

constexpr std::array k_events{
    Term{"contact-made", "a wall comes to touch the particle, or the place at which it has left it"},
    Term{"contact-lost", "a wall leaves the particle, short of where it first touched it"},
    Term{"transition", "the linear part ends; the slope jumps"},
    Term{"load-reversal", "a contact at its largest displacement starts to unload"},
    Term{"reload", "a contact passes its old largest displacement, and the loading law goes on"},
    Term{"step-end", "end of a step of the program"},
    Term{"until-met", "a step ended early by its condition"},
    Term{"limit", "the law ends, at a displacement of 0.5 R0"},
};

constexpr std::array<string_view, 8> k_domain{
    "displacement up to 0.5 R0, where the source's data end",
    "k, delta_t, a from the material: stiffness_ratio from 3 to 500, shear_ratio from 0.25 to 1; a warning below 4.5, "
    "where the source left delta_t and a unfitted; two printed coefficients are misprints and corrected",
    "every contact is independent of the others; a warning where more than two walls are loaded",
    "no contact radius, no pressure, no shape of the particle",
    "unloading: the source has no law for alpha and beta; a warning where Hertz's 1.5 and 1 stand in for them",
    "unloading ends at first touch or before: where beta would have it beyond, alpha stays and a warning counts it",
    "reloading: not in the source; elastic on the way of the unloading",
    "warned: dissipation that falls by more than 1e-6 of the energy, where alpha, beta or a soft material make the "
    "unloading softer than the loading",
};

std::optional<double> value_of(const std::map<std::string, double>& values, const char* key) {
  const auto found = values.find(key);
  return found == values.end() ? std::nullopt : std::optional(found->second);
}

std::vector<Objection> objections(const ModelInput& given) {
  const auto number = [&](const char* key) { return value_of(given.numbers, key); };
  const auto shear_ratio = value_of(given.material, "shear_ratio");
  std::vector<Objection> found = regression_objections({number("k"), number("delta_t"), number("a")},
                                                       given.material.at("stiffness_ratio"), shear_ratio);
  if (given.choices.at("unloading_table").empty()) return found;
  for (const char* key : {"alpha", "beta"}) {
    if (!number(key)) continue;
    found.push_back({key, std::string("key '") + key +
                              "' does not go with 'unloading_table', which stands for it; expected one of them"});
  }
  if (!shear_ratio) {
    found.push_back({"unloading_table",
                     "unloading_table is over E0/Gamma0; expected shear_ratio in [material], or alpha and beta"});
  }
  return found;
}

}  // namespace

ModelInfo contact_info() noexcept {
  return {.name = "compressible",
          .summary = "compressible plastic particle: force linear, then exponential; power-law unloading",
          .source = "001_3cd85d3b0dc520cf.txt (Edmans & Sinka), section 6 and appendix A",
          .material = k_material,
          .options = k_options,
          .configurations = k_configurations,
          .has_free_centre = false,
          .has_contact_area = false,
          .regimes = k_regimes,
          .events = k_events,
          .domain = k_domain,
          .presets = presets(),
          .takes_ludwik = false,
          .objections = objections};
}

}  // namespace monograin::compressible
