#include "packing/model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "packing/stress_test.hpp"
#include "packing/system.hpp"
#include "stress_test/checks.hpp"
#include "system/resolution.hpp"

namespace monograin::packing {
namespace {

using std::string_view;

constexpr Range k_inside_one{.lower = 0.0, .upper = 1.0, .lower_is_open = true, .upper_is_open = true};
constexpr Range k_to_one{.lower = 0.0, .upper = 1.0, .lower_is_open = true};
// Beyond 1 the run stops with an event.
constexpr Range k_fraction_range{.lower = 0.0, .upper = 2.0, .lower_is_open = true};

constexpr Parameters k_published{};
constexpr double k_published_yield_stress = 0.4e6;

constexpr std::array<string_view, 2> k_couplings{"published", "consistent"};
constexpr std::array<string_view, 4> k_regime_words{"unjammed", "elastic", "elastic-plastic", "fully-plastic"};

constexpr std::array k_material{
    QuantityKey{"youngs_modulus", "Young's modulus of the particles", Dimension::stress, k_positive,
                k_published.youngs_modulus},
    QuantityKey{"poisson_ratio", "their Poisson's ratio", Dimension::none, k_poisson_below_half,
                k_published.poisson_ratio},
    QuantityKey{"yield_stress", "their uniaxial yield stress", Dimension::stress, k_positive, k_published_yield_stress},
    QuantityKey{"hardening_modulus",
                "their plastic modulus d sigma_y/d eps_p; absent: they stay elastic",
                Dimension::stress,
                k_not_negative,
                {},
                true},
};

constexpr OptionKey number(string_view name, string_view meaning, const Range& range, std::optional<double> value) {
  return {.name = name, .meaning = meaning, .kind = OptionKey::Kind::quantity, .range = range, .default_value = value};
}

constexpr std::array k_options{
    number("f_E", "exponent of the stretching modulus", k_positive, k_published.stretch_exponent),
    number("f_G", "exponent of the shear modulus, not above f_E", k_positive, k_published.shear_exponent),
    number("critical_porosity", "porosity at which the moduli vanish", k_inside_one, k_published.critical_porosity),
    number("c1", "factor of the particles' volume stiffness", k_positive, k_published.coupling_factor),
    number("c2", "logarithmic strain at Phi = 1, counted from where the stress is zero", k_positive,
           k_published.strain_offset),
    number("alpha", "growth of the plastic fraction", k_positive, k_published.plastic_growth),
    number("jamming_fraction", "packing fraction Phi_c at jamming", k_inside_one, k_published.jamming_fraction),
    number("Z_c", "coordination number at jamming (not of the source)", k_positive,
           k_published.coordination_at_jamming),
    number("Z_1", "coordination number at Phi_1 (not of the source)", k_positive,
           k_published.coordination_at_reference),
    number("Phi_1", "packing fraction at which Z_1 is given (not of the source)", k_to_one,
           k_published.reference_fraction),
    OptionKey{
        "coupling",
        "sign of the particles' share in the strain: as printed, to which the parameters belong, or as eqs. 18-20 "
        "give it",
        OptionKey::Kind::choice, k_couplings},
    OptionKey{.name = "continuous_jamming",
              .meaning = "put critical_porosity = 1 - jamming_fraction and c2 = -ln jamming_fraction, so that the "
                         "stress begins at zero",
              .kind = OptionKey::Kind::toggle},
    number("initial_packing_fraction", "packing fraction at the start; absent: where the packing jams", k_inside_one,
           {}),
};

constexpr std::array k_drives{
    DriveKey{"packing_fraction", "ramp to this packing fraction", Control::packing_fraction, Dimension::none,
             k_fraction_range, "0.95"},
    DriveKey{"strain",
             "ramp to this strain, compression positive; zero where the elastic law has no stress, not at jamming",
             Control::strain,
             Dimension::none,
             {.lower = -10.0, .upper = 10.0},
             "0.1"},
    DriveKey{"stress", "ramp to this stress, compression positive", Control::stress, Dimension::stress, k_not_negative,
             "\"0.5 MPa\""},
};

constexpr std::array k_regimes{
    Term{k_regime_words[0], "the packing rearranges without stress"},
    Term{k_regime_words[1], "elastic particles bear stress"},
    Term{k_regime_words[2], "a growing fraction of the contacts is plastic"},
    Term{k_regime_words[3], "the plastic fraction has reached 1"},
};

constexpr std::array k_events{
    Term{"jamming", "the packing begins to bear stress, or comes loose"},
    Term{"plastic-softening", "from here on the plastic packing bears less stress than the elastic one"},
    Term{"fully-plastic", "the plastic fraction reaches 1; the stress has a kink"},
    Term{"full", "no pores are left (Phi = 1); a run that would go on stops"},
    Term{"limit", "the prescribed strain or stress cannot grow any further"},
    Term{"step-end", "a step of the program is complete"},
    Term{"until-met", "a step ends early because its condition is met"},
};

constexpr std::array k_references{&references::k_nezamabadi2022};

constexpr std::array<string_view, 7> k_domain{
    "discs in plane strain; packing fractions up to 1",
    "f_E >= f_G > 0 and a Poisson's ratio below 0.5; at 0.45 the modulus grows fourfold between Phi = 0.97 and 1",
    "jamming at the largest of jamming_fraction, 1 - critical_porosity and exp(-c2): with the published values the "
    "stress jumps there from 0 to 0.0108 MPa",
    "the strain has its greatest value before Phi = 1 (published: 0.2028 at Phi = 0.9918), the stress may; strain or "
    "stress control ends there",
    "plastic particles: compaction only; just above jamming the plastic packing bears more stress than the elastic one",
    "consistent coupling: stress and strain fall by less than a millionth just above Phi_c before they grow; under "
    "strain or stress control a packing that stands there gives way to where they grow",
    "coordination law: Z_c, Z_1 and Phi_1 are assumed (isostatic frictionless discs, 6 contacts at Phi = 1)",
};

/// Packing fractions to which the steps of a program lead.
class Destinations {
 public:
  explicit Destinations(const Law& law) : law_(law) {}

  /// Packing fraction after a step that begins at `now`; infinite if the step leads out of the model's domain.
  double of(const Prescription& step, double now) {
    if (step.control == Control::packing_fraction) return step.target;
    const bool is_strain = step.control == Control::strain;
    if (is_strain) {
      const double at_jamming = state(law_, law_.jamming).strain;
      if (step.target <= at_jamming) return law_.jamming * std::exp(step.target - at_jamming);
    } else if (step.target == 0.0 && now <= law_.jamming) {
      return now;
    }
    std::optional<Branch>& branch = is_strain ? strain_ : stress_;
    if (!branch) branch = growing_branch(law_, is_strain ? Measure::strain : Measure::stress);
    if (step.target > branch->greatest) return k_infinity;
    return step.target <= branch->least ? law_.jamming : packing_fraction_at(law_, *branch, step.target);
  }

 private:
  const Law& law_;
  std::optional<Branch> strain_;
  std::optional<Branch> stress_;
};

/// Objects to steps that unload a plastic packing. The run finds out about steps that may end early by their condition.
void check_only_compaction(const Law& law, double initial, const ModelInput& input, std::vector<Objection>& found) {
  Destinations destinations(law);
  double least = initial;
  for (std::size_t k = 0; k < input.program.size(); ++k) {
    const PlannedStep& step = input.program[k];
    if (!step.first) continue;
    const double next = destinations.of(*step.first, least);
    if (next < least * (1.0 - k_same_number)) {
      found.push_back({"",
                       "the packing goes back from packing fraction " + std::to_string(least) + " to " +
                           std::to_string(next) +
                           ", and there is no law of unloading for plastic particles; expected growing targets, or "
                           "elastic particles (no hardening_modulus)",
                       k});
      return;
    }
    if (!step.may_end_early) least = std::max(least, next);
  }
}

/// Key whose value conflicts with the others.
const char* culprit(const Parameters& p) {
  if (p.stretch_exponent < p.shear_exponent) return "f_E";
  if (p.coordination_at_reference < p.coordination_at_jamming) return "Z_1";
  if (p.reference_fraction <= p.jamming_fraction) return "Phi_1";
  return "jamming_fraction";
}

/// Parameters of a law from the keys in `[material]` and `[packing]`; without a hardening modulus the particles are
/// elastic.
Parameters parameters_of(const ModelInput& input) {
  Parameters p;
  p.youngs_modulus = input.material("youngs_modulus");
  p.poisson_ratio = input.material("poisson_ratio");
  if (const auto hardening = input.optional_material("hardening_modulus")) {
    p.plasticity = {input.material("yield_stress"), *hardening};
  }
  p.stretch_exponent = input.number("f_E").value();
  p.shear_exponent = input.number("f_G").value();
  p.critical_porosity = input.number("critical_porosity").value();
  p.coupling_factor = input.number("c1").value();
  p.strain_offset = input.number("c2").value();
  p.plastic_growth = input.number("alpha").value();
  p.jamming_fraction = input.number("jamming_fraction").value();
  p.coordination_at_jamming = input.number("Z_c").value();
  p.coordination_at_reference = input.number("Z_1").value();
  p.reference_fraction = input.number("Phi_1").value();
  p.coupling = input.word("coupling") == k_couplings.front() ? Coupling::published : Coupling::consistent;
  p.has_continuous_jamming = input.toggle("continuous_jamming");
  return p;
}

std::vector<Objection> objections(const ModelInput& input) {
  const Parameters parameters = parameters_of(input);
  std::vector<Objection> found;
  if (parameters.has_continuous_jamming) {
    const auto check_absent = [&](const char* key, double given_value, double default_value) {
      if (given_value == default_value) return;
      found.push_back({key, std::string("key '") + key +
                                "' does not go with continuous_jamming = true, which sets it; expected one of them"});
    };
    check_absent("critical_porosity", parameters.critical_porosity, k_published.critical_porosity);
    check_absent("c2", parameters.strain_offset, k_published.strain_offset);
  }
  try {
    const Law law = make_law(parameters);
    const double initial = initial_packing_fraction(input, law);
    static_cast<void>(state(law, std::max(initial, law.jamming)));
    if (initial >= law.end) {
      found.push_back({"initial_packing_fraction", "the stress of the packing is infinite from packing fraction " +
                                                       std::to_string(law.end) + " on; expected less"});
      return found;
    }
    if (parameters.plasticity) check_only_compaction(law, initial, input, found);
  } catch (const std::invalid_argument& error) {
    found.push_back({culprit(parameters), error.what()});
  } catch (const std::domain_error& error) {
    found.push_back({"c1", error.what()});
  }
  return found;
}

bool is_elastic(const ModelInput& input) { return !input.optional_material("hardening_modulus"); }

std::vector<std::string> reservations(const ModelInput& input) {
  std::vector<std::string> found;
  if (is_elastic(input) && input.material("yield_stress") != k_published_yield_stress) {
    found.emplace_back(
        "yield_stress has no effect without hardening_modulus: the particles stay elastic; expected hardening_modulus "
        "= 0 for particles that are ideally plastic");
  }
  const auto loosens = [](const PlannedStep& step) { return step.first && step.first->target < 0.0; };
  const auto compacts = [](const PlannedStep& step) { return step.first && step.first->target > 0.0; };
  if (std::ranges::any_of(input.program, loosens) && std::ranges::none_of(input.program, compacts)) {
    found.emplace_back("the program only loosens the packing: compression is positive");
  }
  return found;
}

std::unique_ptr<HybridSystem> bind(const ModelInput& input, std::vector<ContactClass> /*classes*/,
                                   const Reach& /*reach*/) {
  const Law law = law_of(input);
  return std::make_unique<System>(law, initial_packing_fraction(input, law));
}

std::vector<RestingChannel> channels(const ModelInput& input) {
  const double initial = initial_packing_fraction(input, law_of(input));
  return {{.name = "packing", .at_rest = {initial, initial, Control::packing_fraction}}};
}

std::vector<DerivedParameter> parameters(const ModelInput& input, const FirstStep& /*step*/) {
  const Law law = law_of(input);
  std::vector<DerivedParameter> list =
      law.given.plasticity
          ? material_parameters(
                input,
                {{"youngs_modulus", "Pa"}, {"poisson_ratio", "-"}, {"yield_stress", "Pa"}, {"hardening_modulus", "Pa"}})
          : material_parameters(input, {{"youngs_modulus", "Pa"}, {"poisson_ratio", "-"}});
  list.push_back({"shear_modulus", law.shear_modulus, "Pa", "G"});
  list.push_back({"bulk_modulus", law.bulk_modulus, "Pa", "K"});
  list.push_back({"modulus_at_one", law.modulus_at_one, "Pa", "M"});
  list.push_back({"critical_porosity", law.given.critical_porosity, "-", "p_c"});
  list.push_back({"c2", law.given.strain_offset, "-"});
  list.push_back({"jamming", law.jamming, "-", "Phi_J"});
  list.push_back({"initial_packing_fraction", initial_packing_fraction(input, law), "-"});
  const State at_jamming = state(law, law.jamming);
  list.push_back({"jamming_strain", at_jamming.strain, "-", "e(Phi_J)"});
  list.push_back({"jamming_stress", at_jamming.stress, "Pa", "sigma(Phi_J)"});
  const Branch strain = growing_branch(law, Measure::strain);
  list.push_back({"greatest_strain", strain.greatest, "-"});
  list.push_back({"greatest_strain_fraction", strain.end, "-"});
  const Branch stress = growing_branch(law, Measure::stress);
  list.push_back({"greatest_stress", stress.greatest, "Pa"});
  list.push_back({"greatest_stress_fraction", stress.end, "-"});
  if (!law.given.plasticity) return list;
  list.push_back({"softening_fraction", softening(law), "-"});
  list.push_back({"fully_plastic_fraction", full_plasticity(law), "-"});
  return list;
}

}  // namespace

std::span<const string_view> regime_words() noexcept { return k_regime_words; }

std::span<const OptionKey> options() noexcept { return k_options; }

Law law_of(const ModelInput& input) { return make_law(parameters_of(input)); }

double initial_packing_fraction(const ModelInput& input, const Law& law) {
  return input.number("initial_packing_fraction").value_or(law.jamming);
}

Model model() noexcept {
  return {.name = "packing",
          .summary = "compaction of a packing of elastic or plastic discs, from jamming to no pores left",
          .references = k_references,
          .source = "eqs. 5-22; signs corrected",
          .material = k_material,
          .options = k_options,
          .regimes = k_regimes,
          .events = k_events,
          .domain = k_domain,
          .drives = k_drives,
          .objections = objections,
          .reservations = reservations,
          .bind = bind,
          .channels = channels,
          .parameters = parameters,
          .is_elastic = is_elastic,
          .draw = draw,
          .draw_program = draw_program,
          .check = check,
          .may_be_undefined = [](const CheckedRun&, std::size_t, string_view column) {
            return column == "coordination_number";  // below jamming
          }};
}

}  // namespace monograin::packing
