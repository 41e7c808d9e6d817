#include "engine/integrator.hpp"

#include <fmt/format.h>
#include <sundials/sundials_version.h>

namespace monograin {

SolverError::SolverError(std::string call, std::string flag, double xi, double step, std::string details)
    : std::runtime_error(fmt::format("{} failed with {} at {:.6g} of the step (step size {:.3g}){}{}", call, flag, xi,
                                     step, details.empty() ? "" : ": ", details)),
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

std::unique_ptr<Integrator> make_integrator(std::string_view name, HybridSystem& system, Watch& watch,
                                            const Tolerances& tolerances) {
  if (name == "direct" && !system.is_solvable()) throw std::logic_error("the system has no direct form");
  if (name == "direct") return make_direct(system, watch);
  if (name == "cvode-adams") return make_cvode(CvodeMethod::adams, system, watch, tolerances);
  if (name == "cvode-bdf") return make_cvode(CvodeMethod::bdf, system, watch, tolerances);
  if (name == "ida") return make_ida(system, watch, tolerances);
  throw std::logic_error(fmt::format("no integrator is called '{}'", name));
}

IntegratorChoice choose_integrator(const std::string& asked, const HybridSystem& system) {
  if (asked != "auto") return {asked, asked, "asked for"};
  if (system.is_solvable()) {
    return {asked, "direct",
            "the state at any instant follows from equations that need no history: nothing is integrated"};
  }
  return {asked, "cvode-bdf",
          "the state depends on the way to it, so that it is integrated; in its explicit form, by the method that "
          "stiff phases do not slow down"};
}

std::string sundials_version() {
  char text[32] = {};
  SUNDIALSGetVersion(text, sizeof text);
  return text;
}

}  // namespace monograin
