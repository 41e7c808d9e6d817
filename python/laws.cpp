// Laws in closed form, evaluated element by element over arrays that broadcast. The Python files of the package
// describe arguments, units, sources and domains.

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "cel/contact_law.hpp"
#include "compressible/law.hpp"
#include "compressible/regressions.hpp"
#include "elastic/hertz.hpp"
#include "elastic/line_contact.hpp"
#include "elementwise.hpp"
#include "hardening/law.hpp"
#include "interruptible.hpp"
#include "mdr/adhesion.hpp"
#include "mdr/relaxed_profile.hpp"
#include "mdr/transforms.hpp"
#include "nonlocal/law.hpp"
#include "packing/law.hpp"
#include "plastic/ludwik.hpp"
#include "semimech/law.hpp"
#include "similarity/law.hpp"
#include "system/number_text.hpp"
#include "system/resolution.hpp"

namespace monograin::python {
namespace {

/// Calls `value` and returns NaN outside the domain of the law (std::domain_error). std::invalid_argument passes on.
template <class Value>
double or_nan(Value&& value) {
  try {
    return value();
  } catch (const std::domain_error&) {
    return std::numeric_limits<double>::quiet_NaN();
  }
}

/// @throws std::invalid_argument for a parameter of zero or less; NaN passes
void require_positive(std::initializer_list<std::pair<const char*, double>> parameters) {
  for (const auto& [name, value] : parameters) {
    if (value <= 0.0)
      throw std::invalid_argument(std::string(name) + " = " + number_text(value) + ": expected above 0");
  }
}

/// @throws std::invalid_argument for what is no Poisson's ratio; NaN passes
void require_poisson_ratio(double nu) {
  if (nu <= -1.0 || nu > 0.5) {
    throw std::invalid_argument("poisson_ratio = " + number_text(nu) + ": expected above -1 and up to 0.5");
  }
}

/// Makes a function of arrays from a function of numbers; NaN outside the domain of the law.
template <class... Args>
auto elementwise(double (*function)(Args...)) {
  return [function](const std::conditional_t<false, Args, Numbers>&... arrays) {
    return Elementwise([function](Args... args) { return or_nan([&] { return function(args...); }); }, arrays...);
  };
}

/// Keeps the last law made, because parameters seldom change from one element to the next.
template <class Law, std::size_t N>
class LastMade {
 public:
  template <class Make>
  const Law& get(const std::array<double, N>& parameters, Make&& make) {
    if (!law_ || parameters != parameters_) {
      law_.reset();
      law_.emplace(make());
      parameters_ = parameters;
    }
    return *law_;
  }

 private:
  std::array<double, N> parameters_{};
  std::optional<Law> law_;
};

/// Value that belongs to a word. @throws std::invalid_argument that lists the known words
template <class Value>
Value word(const std::string& given, std::initializer_list<std::pair<const char*, Value>> known) {
  std::string names;
  for (const auto& [name, value] : known) {
    if (given == name) return value;
    names += (names.empty() ? "'" : ", '") + std::string(name) + "'";
  }
  throw std::invalid_argument("'" + given + "' is not known; expected one of " + names);
}

// --- plastic spheres between walls

/// Quantity of a contact between sphere and wall, in SI units; NaN outside the domain of the law, 0 without contact.
/// @param quantity  contact_radius, mean_pressure, force or work
template <class Law>
double plastic_quantity(const Law& law, const std::string& quantity, double strength, double radius,
                        double displacement) {
  using plastic::work_per_wall;
  const double x = displacement / radius;
  if (x <= 0.0) return 0.0;
  if (quantity == "work") return or_nan([&] { return work_per_wall(law, x); }) * strength * radius * radius * radius;
  return or_nan([&] {
    const plastic::ContactState state = state_at(law, x);
    if (quantity == "contact_radius") return state.contact_radius * radius;
    if (quantity == "mean_pressure") return state.pressure * strength;
    return state.force * strength * radius * radius;
  });
}

Elementwise semimech(const std::string& quantity, const std::string& configuration, const Numbers& youngs_modulus,
                     const Numbers& poisson_ratio, const Numbers& yield_stress, const Numbers& radius,
                     const Numbers& displacement) {
  const plastic::Configuration walls = plastic::configuration_named(configuration);
  return Elementwise(
      [=, last = LastMade<semimech::Law, 3>()](double e, double nu, double y, double r, double d) mutable {
        const semimech::Law& law =
            last.get({e, nu, y}, [&] { return semimech::make_law(semimech::make_material(e, nu, y), walls); });
        return plastic_quantity(law, quantity, y, r, d);
      },
      youngs_modulus, poisson_ratio, yield_stress, radius, displacement);
}

Elementwise hardening(const std::string& quantity, const std::string& configuration, const Numbers& strength,
                      const Numbers& exponent, const Numbers& radius, const Numbers& displacement) {
  const plastic::Configuration walls = plastic::configuration_named(configuration);
  return Elementwise(
      [=, last = LastMade<hardening::Law, 1>()](double kappa, double mu, double r, double d) mutable {
        return plastic_quantity(last.get({mu}, [&] { return hardening::make_law(mu, walls); }), quantity, kappa, r, d);
      },
      strength, exponent, radius, displacement);
}

similarity::RadiusRule radius_rule(const std::string& given) {
  using Rule = similarity::RadiusRule;
  return word<Rule>(given, {{"parabolic", Rule::parabolic}, {"corrected", Rule::corrected}});
}

Elementwise similarity(const std::string& quantity, const std::string& rule, const Numbers& strength,
                       const Numbers& exponent, const Numbers& radius, const Numbers& displacement) {
  const similarity::RadiusRule radius_law = radius_rule(rule);
  return Elementwise(
      [=](double kappa, double mu, double r, double d) {
        return plastic_quantity(similarity::make_law(mu, radius_law), quantity, kappa, r, d);
      },
      strength, exponent, radius, displacement);
}

/// Quantity of a contact of two plastic spheres, in SI units.
/// @param quantity  contact_radius, force or work at an approach; approach under a force
/// @param argument  the approach [m], or the force [N]
Elementwise similarity_pair(const std::string& quantity, const std::string& rule, const Numbers& strength,
                            const Numbers& exponent, const Numbers& first_radius, const Numbers& second_radius,
                            const Numbers& argument) {
  const similarity::RadiusRule radius_law = radius_rule(rule);
  return Elementwise(
      [=](double kappa, double mu, double first, double second, double given) {
        const similarity::Law law = similarity::make_law(mu, radius_law);
        const similarity::Pair pair = similarity::pair_of(first, second);
        if (quantity == "approach") return similarity::pair_approach(law, pair, kappa, given);
        if (quantity == "work") return similarity::pair_work(law, pair, kappa, given);
        const similarity::PairContact contact = similarity::pair_contact(law, pair, kappa, given);
        return quantity == "force" ? contact.force : contact.contact_radius;
      },
      strength, exponent, first_radius, second_radius, argument);
}

plastic::LudwikMaterial ludwik_material(double youngs_modulus, double yield_stress, double strength, double exponent) {
  return {youngs_modulus, yield_stress, strength, 1.0 / exponent};
}

py::tuple ludwik_power_law(double youngs_modulus, double yield_stress, double strength, double exponent,
                           double largest_strain, const std::string& fit) {
  using Fit = plastic::HollomonFit;
  const plastic::HollomonMaterial found =
      plastic::fit_hollomon(ludwik_material(youngs_modulus, yield_stress, strength, exponent), largest_strain,
                            word<Fit>(fit, {{"both", Fit::both}, {"exponent", Fit::exponent}}));
  return py::make_tuple(found.strength, found.exponent, found.residual);
}

// --- one contact of model cel, on an undeformed core

/// Makes a function of (E, nu, Y, R0, numbers...) from a function of (cel::Material, E, R0, numbers...). It refuses
/// inadmissible parameters, and is NaN if one of its arguments is.
template <class Function>
auto with_cel_material(Function function) {
  return [function, last = LastMade<cel::Material, 3>()](double e, double nu, double y, double r,
                                                         auto... numbers) mutable {
    require_positive({{"youngs_modulus", e}, {"yield_stress", y}, {"radius", r}});
    require_poisson_ratio(nu);
    if (((std::isnan(e) || std::isnan(nu) || std::isnan(y) || std::isnan(r)) || ... || std::isnan(numbers)))
      return k_nan;
    const cel::Material& material = last.get({e, nu, y}, [&] { return cel::Material(y / e, nu); });
    return function(material, e, r, numbers...);
  };
}

/// Dent of a contact with that largest radius over R0: a fresh surface up to yield.
cel::Dent cel_dent(const cel::Material& material, double largest) {
  return cel::dent_of(material, std::max(largest, material.a_Y));
}

/// Onset of yield.
/// @param quantity  contact_radius or overlap
Elementwise cel_yield(const std::string& quantity, const Numbers& youngs_modulus, const Numbers& poisson_ratio,
                      const Numbers& yield_stress, const Numbers& radius) {
  return Elementwise(with_cel_material([=](const cel::Material& material, double, double r) {
                       return quantity == "overlap" ? material.a_Y * material.a_Y * r : material.a_Y * r;
                     }),
                     youngs_modulus, poisson_ratio, yield_stress, radius);
}

/// Plastic indentation below a dent.
Elementwise cel_indentation(const Numbers& youngs_modulus, const Numbers& poisson_ratio, const Numbers& yield_stress,
                            const Numbers& radius, const Numbers& largest) {
  return Elementwise(with_cel_material([](const cel::Material& material, double, double r, double a) {
                       return a <= r ? cel_dent(material, a / r).h * r : k_nan;
                     }),
                     youngs_modulus, poisson_ratio, yield_stress, radius, largest);
}

/// Overlap over R0 at which a contact on a dent flows, where its force is the limit.
/// @param contact  on the dent, at any overlap
double cel_limit_overlap(const cel::Material& material, const cel::Dent& dent, const cel::Contact& contact) {
  return dent.h + contact.H / (2.0 * material.Es * std::sqrt(contact.alpha) * (1.0 - dent.q));
}

/// First loading up to a contact radius.
/// @param quantity  overlap, force or mean_pressure
Elementwise cel_loading(const std::string& quantity, const Numbers& youngs_modulus, const Numbers& poisson_ratio,
                        const Numbers& yield_stress, const Numbers& radius, const Numbers& contact_radius) {
  return Elementwise(with_cel_material([=](const cel::Material& material, double e, double r, double a) {
                       if (a <= 0.0) return 0.0;
                       if (a > r) return k_nan;
                       const double zeta = a / r;
                       // Before yield the contact is Hertz's; afterwards its force is the limit.
                       double overlap = zeta * zeta;
                       double pressure = 4.0 * material.Es * zeta / (3.0 * std::numbers::pi);
                       if (zeta >= material.a_Y) {
                         const cel::Dent dent = cel::dent_of(material, zeta);
                         const cel::Contact open = cel::contact_at(material, dent, 1.0, 1.0, 0.0);
                         overlap = cel_limit_overlap(material, dent, open);
                         pressure = open.H / (std::numbers::pi * open.alpha);
                       }
                       if (quantity == "overlap") return overlap * r;
                       return quantity == "force" ? pressure * e * std::numbers::pi * a * a : pressure * e;
                     }),
                     youngs_modulus, poisson_ratio, yield_stress, radius, contact_radius);
}

/// A contact below its limit, on the dent of its largest radius; NaN beyond the limit, where the dent would grow.
/// @param quantity  force or contact_radius
Elementwise cel_unloading(const std::string& quantity, const Numbers& youngs_modulus, const Numbers& poisson_ratio,
                          const Numbers& yield_stress, const Numbers& radius, const Numbers& largest,
                          const Numbers& overlap) {
  return Elementwise(with_cel_material([=](const cel::Material& material, double e, double r, double a, double delta) {
                       if (a > r) return k_nan;
                       const cel::Dent dent = cel_dent(material, a / r);
                       const cel::Contact contact = cel::contact_at(material, dent, 1.0, 1.0, delta / r - dent.h);
                       const double limit = cel_limit_overlap(material, dent, contact);
                       if (delta > limit * r * (1.0 + k_same_value)) return k_nan;
                       return quantity == "force" ? contact.F * e * r * r : std::sqrt(contact.area) * r;
                     }),
                     youngs_modulus, poisson_ratio, yield_stress, radius, largest, overlap);
}

// --- elastic contacts

nonlocal::Terms terms_named(const std::string& given) {
  using nonlocal::Terms;
  return word<Terms>(
      given, {{"1", Terms::one}, {"2", Terms::two}, {"3", Terms::three}, {"4", Terms::four}, {"inf", Terms::all}});
}

Elementwise curved_sphere(const std::string& quantity, const std::string& terms, const Numbers& composite_modulus,
                          const Numbers& radius, const Numbers& overlap) {
  const nonlocal::LocalLaw law(terms_named(terms));
  return Elementwise(
      [=](double modulus, double r, double delta) {
        if (delta <= 0.0) return 0.0;
        return or_nan([&] {
          const double s = law.signed_square(delta / r);
          if (quantity == "energy") return law.energy(s) * modulus * r * r * r;
          const nonlocal::LocalContact contact = law.at(s);
          return quantity == "force" ? contact.force * modulus * r * r : contact.contact_radius * r;
        });
      },
      composite_modulus, radius, overlap);
}

mdr::ElasticProfile profile_named(const std::string& given) {
  using Profile = mdr::ElasticProfile;
  return word<Profile>(given, {{"ellipse", Profile::ellipse}, {"parabola", Profile::parabola}});
}

Elementwise mdr_elastic(const std::string& quantity, const std::string& profile, const Numbers& composite_modulus,
                        const Numbers& radius, const Numbers& overlap) {
  const mdr::ElasticProfile shape = profile_named(profile);
  return Elementwise(
      [=](double modulus, double r, double delta) {
        require_positive({{"modulus", modulus}, {"radius", r}});
        return or_nan([&] {
          if (quantity == "energy") return mdr::elastic_energy(shape, modulus, r, delta);
          const mdr::Contact contact = mdr::elastic_contact(shape, modulus, r, delta);
          return quantity == "force" ? contact.force : contact.contact_radius;
        });
      },
      composite_modulus, radius, overlap);
}

Elementwise mdr_plastic(const std::string& quantity, const Numbers& youngs_modulus, const Numbers& poisson_ratio,
                        const Numbers& yield_stress, const Numbers& radius, const Numbers& overlap) {
  return Elementwise(
      [=, last = LastMade<mdr::Material, 3>()](double e, double nu, double y, double r, double delta) mutable {
        require_positive({{"youngs_modulus", e}, {"yield_stress", y}, {"radius", r}});
        require_poisson_ratio(nu);
        const mdr::Material& material = last.get({e, nu, y}, [&] { return mdr::make_material(e, nu, y); });
        return or_nan([&] {
          if (quantity == "mean_pressure") return mdr::plastic_pressure(material, delta / r).pressure;
          if (delta < material.yield_overlap_ratio * r * (1.0 - k_same_value)) return k_nan;
          const double c = mdr::yield_area_constant(material.yield_overlap_ratio, r);
          const mdr::Contact contact = mdr::plastic_contact(material, r, delta, c);
          return quantity == "force" ? contact.force : contact.contact_radius;
        });
      },
      youngs_modulus, poisson_ratio, yield_stress, radius, overlap);
}

Control control_named(const std::string& given) {
  return word<Control>(given, {{"force", Control::force}, {"displacement", Control::displacement}});
}

/// Force at pull-off, or the contact radius at pull-off.
/// @param quantity  force; any other text: contact radius
/// @param control   controlled quantity at pull-off: force or displacement
Elementwise mdr_pull_off(const std::string& quantity, const std::string& profile, const std::string& control,
                         const Numbers& composite_modulus, const Numbers& radius, const Numbers& surface_energy) {
  const mdr::ElasticProfile shape = profile_named(profile);
  const Control prescribed = control_named(control);
  return Elementwise(
      [=](double modulus, double r, double energy) {
        require_positive({{"modulus", modulus}, {"radius", r}, {"surface_energy", energy}});
        return or_nan([&] {
          const mdr::Indenter indenter = mdr::elastic_indenter(shape, r);
          const double a = mdr::critical_radius(indenter, {modulus, energy}, prescribed);
          return quantity == "force" ? mdr::peel_state(indenter, {modulus, energy}, a).force : a;
        });
      },
      composite_modulus, radius, surface_energy);
}

/// @throws std::invalid_argument for an array of more or fewer dimensions than one
std::vector<double> list_of(const Numbers& numbers) {
  if (numbers.array.ndim() != 1) throw std::invalid_argument("expected samples of shape (n,)");
  const auto samples = numbers.array.unchecked<1>();
  std::vector<double> list;
  for (py::ssize_t k = 0; k < samples.shape(0); ++k) list.push_back(samples(k));
  return list;
}

/// Stable states of an adhesive contact with a sampled profile, down to pull-off.
/// @return contact radii, displacements and forces
py::tuple mdr_peel_curve(const Numbers& radii, const Numbers& heights, double composite_modulus, double surface_energy,
                         const std::string& control, std::size_t count) {
  require_positive({{"modulus", composite_modulus}, {"surface_energy", surface_energy}});
  const Control controlled = control_named(control);
  const mdr::RelaxedProfile profile(list_of(radii), list_of(heights));
  const std::vector<mdr::PeelState> states = run_interruptibly([&](const auto&) {
    return mdr::peel_curve(profile, {composite_modulus, surface_energy}, controlled, count);
  });
  const auto column = [&](double mdr::PeelState::*value) {
    Array array(static_cast<py::ssize_t>(states.size()));
    std::ranges::transform(states, array.mutable_data(), value);
    return array;
  };
  return py::make_tuple(column(&mdr::PeelState::contact_radius), column(&mdr::PeelState::displacement_1d),
                        column(&mdr::PeelState::force));
}

// --- compressible particle and packing

Elementwise compressible_unloading(const Numbers& stiffness, const Numbers& transition, const Numbers& exponent,
                                   const Numbers& hertz_stiffness, const Numbers& unloading_exponent,
                                   const Numbers& stiffness_ratio, const Numbers& largest,
                                   const Numbers& displacement) {
  using namespace compressible;
  return Elementwise(
      [](double k, double delta_t, double a, double k_hertz, double alpha, double beta, double dm, double d) {
        const UnloadingRule rule(UnloadingShape{alpha, beta});
        const UnloadingCurve curve = unloading_from(make_loading_law(k, delta_t, a), k_hertz, rule, dm);
        return d <= curve.separation() ? 0.0 : unloading_force(curve, d);
      },
      stiffness, transition, exponent, hertz_stiffness, unloading_exponent, stiffness_ratio, largest, displacement);
}

Elementwise packing_quantity(const std::string& quantity, const Numbers& packing_fraction,
                             const Numbers& youngs_modulus, const Numbers& poisson_ratio, const Numbers& yield_stress,
                             const Numbers& hardening_modulus) {
  return Elementwise(
      [=, last = LastMade<packing::Law, 4>()](double phi, double e, double nu, double y, double h) mutable {
        const packing::Law& law = last.get({e, nu, y, h}, [&] {
          packing::Parameters parameters;
          parameters.youngs_modulus = e;
          parameters.poisson_ratio = nu;
          if (!std::isinf(y)) parameters.plasticity = packing::Plasticity{y, h};
          return packing::make_law(parameters);
        });
        return or_nan([&] {
          if (quantity == "coordination_number") return packing::coordination_number(law, phi);
          if (quantity == "plastic_fraction") return packing::plastic_fraction(law, phi);
          const packing::State state = packing::state(law, phi);
          return quantity == "stress" ? state.stress : state.modulus;
        });
      },
      packing_fraction, youngs_modulus, poisson_ratio, yield_stress, hardening_modulus);
}

void add_elastic(py::module_& laws) {
  laws.def("composite_modulus", elementwise(+[](double e, double nu) {
             require_positive({{"youngs_modulus", e}});
             require_poisson_ratio(nu);
             return composite_modulus(e, nu);
           }));
  laws.def("hertz_force", elementwise(+[](double e, double r, double d) {
             require_positive({{"modulus", e}, {"radius", r}});
             return hertz_force(e, r, d);
           }));
  laws.def("hertz_contact_radius", elementwise(+[](double r, double d) {
             require_positive({{"radius", r}});
             return hertz_contact_radius(r, d);
           }));
  laws.def("hertz_energy", elementwise(+[](double e, double r, double d) {
             require_positive({{"modulus", e}, {"radius", r}});
             return hertz_energy(e, r, d);
           }));
  laws.def("line_contact_strain",
           elementwise(+[](double e, double stress) { return line_contact_under_stress(e, stress).strain; }));
  laws.def("line_contact_half_width",
           elementwise(+[](double e, double stress) { return line_contact_under_stress(e, stress).half_width; }));
  laws.def("line_contact_stress",
           elementwise(+[](double e, double strain) { return line_contact_at_strain(e, strain).stress; }));
  laws.def("curved_sphere", &curved_sphere);
}

void add_mdr(py::module_& laws) {
  laws.def("mdr_elastic", &mdr_elastic);
  laws.def("mdr_plastic", &mdr_plastic);
  laws.def("mdr_pull_off", &mdr_pull_off);
  laws.def("mdr_peel_curve", &mdr_peel_curve);
  laws.def("mdr_yield_overlap", elementwise(+[](double e, double nu, double y, double r) {
             require_positive({{"youngs_modulus", e}, {"yield_stress", y}, {"radius", r}});
             require_poisson_ratio(nu);
             return mdr::make_material(e, nu, y).yield_overlap_ratio * r;
           }));
  laws.def("mdr_power_ratio", elementwise(+[](double n) { return mdr::power_ratio(n); }));
  laws.def("mdr_power_profile_1d",
           elementwise(+[](double c, double n, double x) { return mdr::power_profile_1d(c, n, x); }));
  laws.def("mdr_power_profile_3d",
           elementwise(+[](double c, double n, double r) { return mdr::power_profile_3d(c, n, r); }));
}

void add_plastic(py::module_& laws) {
  laws.def("cel_yield", &cel_yield);
  laws.def("cel_indentation", &cel_indentation);
  laws.def("cel_loading", &cel_loading);
  laws.def("cel_unloading", &cel_unloading);
  laws.def("semimech", &semimech);
  laws.def("hardening", &hardening);
  laws.def("similarity", &similarity);
  laws.def("similarity_pair", &similarity_pair);
  laws.def("similarity_strength", elementwise(+[](double first, double second, double exponent) {
             return similarity::pair_strength(first, second, exponent);
           }));
  laws.def("ludwik_stress", elementwise(+[](double yield_stress, double strength, double exponent, double strain) {
             return plastic::ludwik_stress(
                 ludwik_material(std::numeric_limits<double>::infinity(), yield_stress, strength, exponent), strain);
           }));
  laws.def("ludwik_power_law", &ludwik_power_law);
}

void add_compressible(py::module_& laws) {
  using namespace compressible;
  laws.def("compressible_loading_force", elementwise(+[](double k, double delta_t, double a, double d) {
             return d <= 0.0 ? 0.0 : loading_force(make_loading_law(k, delta_t, a), d);
           }));
  laws.def("compressible_loading_work", elementwise(+[](double k, double delta_t, double a, double d) {
             return d <= 0.0 ? 0.0 : loading_work(make_loading_law(k, delta_t, a), d);
           }));
  laws.def("compressible_hertz_stiffness",
           elementwise(+[](double ratio, double nu) { return compressible::hertz_stiffness(ratio, nu); }));
  laws.def("compressible_stiffness",
           elementwise(+[](double ratio, double shear) { return regressed_stiffness(ratio, shear); }));
  laws.def("compressible_transition",
           elementwise(+[](double ratio, double shear) { return regressed_transition(ratio, shear); }));
  laws.def("compressible_exponent",
           elementwise(+[](double ratio, double shear) { return regressed_exponent(ratio, shear); }));
  laws.def("compressible_unloading_force", &compressible_unloading);
}

}  // namespace

void add_laws(py::module_& module) {
  py::class_<Elementwise>(module, "Elementwise").def("into", &Elementwise::into);
  py::module_ laws = module.def_submodule("laws");
  add_elastic(laws);
  add_mdr(laws);
  add_plastic(laws);
  add_compressible(laws);
  laws.def("packing", &packing_quantity);
}

}  // namespace monograin::python
