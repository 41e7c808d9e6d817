#include "engine/integrator.hpp"

#include <fmt/format.h>
#include <sundials/sundials_version.h>

#include <algorithm>
#include <array>
#include <type_traits>
#include <variant>

namespace monograin {

namespace {

std::string_view sentence(Failure failure) noexcept {
  switch (failure) {
    case Failure::no_step:
      return "no step, however short, meets the tolerances";
    case Failure::too_much_work:
      return "too much work";
    case Failure::no_progress:
      return "no progress";
    case Failure::chattering:
      return "chattering: events without progress";
    case Failure::endless_events:
      return "endless events";
    case Failure::set_up:
      return "the integrator did not start";
  }
  return {};
}

}  // namespace

SolverError::SolverError(Failure failure, double xi, double step, std::string_view details, std::string_view library)
    : std::runtime_error(fmt::format("{} at {:.6g} of the step (step size {:.3g}{}{}){}{}", sentence(failure), xi, step,
                                     library.empty() ? "" : "; ", library, details.empty() ? "" : ": ", details)),
      failure_(failure),
      xi_(xi) {}

Statistics& Statistics::operator+=(const Statistics& other) noexcept {
  steps += other.steps;
  rhs_evaluations += other.rhs_evaluations;
  jacobian_evaluations += other.jacobian_evaluations;
  error_test_failures += other.error_test_failures;
  convergence_failures += other.convergence_failures;
  guard_evaluations += other.guard_evaluations;
  segments += other.segments;
  events += other.events;
  return *this;
}

namespace {

// Least relative tolerance of an integrator: finer steps would follow the round-off of states.
constexpr double k_least_rtol = 1e-14;

using Method = std::variant<OdeMethod, OdeintMethod, GslMethod>;

struct NamedMethod {
  std::string_view name;
  Method method;
  bool suits_stiff;  ///< an implicit method
};

/// Integrators of the explicit form with error control.
constexpr std::array<NamedMethod, 11> k_of_explicit_form{{
    {integrators::k_cvode_adams, OdeMethod::cvode_adams, false},
    {integrators::k_cvode_bdf, OdeMethod::cvode_bdf, true},
    {integrators::k_arkode_erk, OdeMethod::arkode_erk, false},
    {integrators::k_arkode_dirk, OdeMethod::arkode_dirk, true},
    {integrators::k_odeint_dopri5, OdeintMethod::dopri5, false},
    {integrators::k_odeint_fehlberg78, OdeintMethod::fehlberg78, false},
    {integrators::k_odeint_bulirsch_stoer, OdeintMethod::bulirsch_stoer, false},
    {integrators::k_odeint_rosenbrock4, OdeintMethod::rosenbrock4, true},
    {integrators::k_gsl_rk8pd, GslMethod::rk8pd, false},
    {integrators::k_gsl_msadams, GslMethod::msadams, false},
    {integrators::k_gsl_msbdf, GslMethod::msbdf, true},
}};

/// Name of the pair of integrators that "auto" chooses if states are not solved for directly.
const std::string& switching_name() {
  static const std::string k_name =
      fmt::format("{}, {} where stiff", integrators::k_odeint_dopri5, integrators::k_cvode_bdf);
  return k_name;
}

}  // namespace

std::span<const std::string_view> integrator_names() noexcept {
  static const auto k_names = [] {
    std::array<std::string_view, k_of_explicit_form.size() + 3> names{integrators::k_direct, integrators::k_ida,
                                                                      integrators::k_forward_euler};
    std::ranges::transform(k_of_explicit_form, names.begin() + 3, &NamedMethod::name);
    return names;
  }();
  return k_names;
}

bool suits_stiff_equations(std::string_view name) noexcept {
  const auto found = std::ranges::find(k_of_explicit_form, name, &NamedMethod::name);
  return found == k_of_explicit_form.end() ? name != integrators::k_forward_euler : found->suits_stiff;
}

std::unique_ptr<Integrator> make_integrator(std::string_view name, Equations& system, GuardSet& guard_set,
                                            const Tolerances& asked, std::size_t rows,
                                            ForwardSensitivities* sensitivities) {
  if (name == integrators::k_direct && !system.is_solvable()) throw std::logic_error("the system has no direct form");
  if (name == integrators::k_direct) return make_direct(system, asked.rtol, guard_set, rows);
  if (name == integrators::k_forward_euler) return make_fixed_step(system, guard_set, asked);
  const double gain = system.error_gain();
  const double rtol = std::max(asked.rtol / gain, std::min(asked.rtol, k_least_rtol));
  // The absolute tolerance need not be below a tenth of the relative one: equations without rates have round-off.
  const Tolerances tolerances{rtol, std::min(asked.atol, std::max(asked.atol / gain, 0.1 * rtol))};
  if (name == integrators::k_ida) return make_ida(system, guard_set, tolerances, sensitivities);
  if (name == switching_name()) return make_switching(system, guard_set, tolerances);
  for (const auto& [word, method, suits_stiff] : k_of_explicit_form) {
    if (word != name) continue;
    return std::visit(
        [&](auto chosen) {
          if constexpr (std::is_same_v<decltype(chosen), OdeMethod>)
            return make_sundials_ode(chosen, system, guard_set, tolerances, sensitivities);
          else
            return make_stepped(chosen, system, guard_set, tolerances);
        },
        method);
  }
  throw std::logic_error(fmt::format("no integrator is called '{}'", name));
}

IntegratorChoice choose_integrator(const std::string& asked, const Equations& system) {
  if (asked != integrators::k_auto) return {asked, asked, "asked for"};
  if (system.is_solvable()) {
    return {asked, integrators::k_direct,
            "the state at any instant follows from equations that need no history: nothing is integrated"};
  }
  return {asked, switching_name(),
          "the state depends on the path to it, so that it is integrated, in its explicit form: by the cheapest "
          "method, and from the first phase that slows that down by one for stiff equations"};
}

std::string sundials_version() {
  char text[32] = {};
  SUNDIALSGetVersion(text, sizeof text);
  return text;
}

}  // namespace monograin
