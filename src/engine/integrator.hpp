/// The interface of an integrator, and how integrators are chosen and made.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "engine/guard_set.hpp"
#include "scenario/integrators.hpp"
#include "system/equations.hpp"
#include "system/resolution.hpp"

namespace monograin {

class ForwardSensitivities;

struct Tolerances {
  double rtol = integrators::k_default_rtol;
  double atol = integrators::k_default_atol;  ///< relative to each unknown's own scale
};

/// Finest rtol that an integrator is expected to keep: the round-off of a scene's own equations may exceed finer ones
/// (docs/reference/limits.md). Two floors lie below it: a step's tolerances are no finer than of_step() makes them
/// (rtol = 1e-13), and make_integrator() takes no rtol below 1e-14.
inline constexpr double k_finest_rtol = 1e-11;

/// Counts of one run, summed over its segments.
struct Statistics {
  long steps = 0;
  long rhs_evaluations = 0;  ///< right-hand sides, residuals, or solutions at an instant
  long jacobian_evaluations = 0;
  long error_test_failures = 0;
  long convergence_failures = 0;
  long guard_evaluations = 0;
  long segments = 0;
  long events = 0;
  int last_order = 0;
  double last_step = 0.0;  ///< in step coordinates

  /// Adds counts; keeps its own last order and step.
  Statistics& operator+=(const Statistics& other) noexcept;
};

/// Why an integration was given up.
enum class Failure {
  no_step,         ///< no step, however short, meets the tolerances
  too_much_work,   ///< more steps or evaluations than a leg of the program may take
  no_progress,     ///< steps below the round-off of the step coordinate
  chattering,      ///< regimes that alternate at one instant
  endless_events,  ///< more events than a leg of the program may have
  set_up           ///< a library did not start
};

/// An integrator gave up: why, and where.
class SolverError : public std::runtime_error {
 public:
  /// @param xi       step coordinate
  /// @param step     last step size, in step coordinates; 0 if there was none
  /// @param details  numbers that show the failure, such as the unknowns with the largest local errors; may be empty
  /// @param library  function of a library and the code it has returned, e.g. "CVode: CV_ERR_FAILURE"; may be empty
  SolverError(Failure failure, double xi, double step, std::string_view details, std::string_view library = {});
  [[nodiscard]] Failure failure() const noexcept { return failure_; }
  [[nodiscard]] double xi() const noexcept { return xi_; }

 private:
  Failure failure_;
  double xi_;
};

/// Length (step coordinates) below which a step that leaves the domain of the equations has reached the domain's
/// boundary. The length shrinks towards the beginning of a leg of the program, where an overlap may be as small.
[[nodiscard]] inline double least_progress(double xi) noexcept {
  constexpr double k_nearest_start = 1e-7;  // nearer to the start, the length is constant
  return k_same_instant * std::max(xi, k_nearest_start);
}

/// Internal steps after which a leg of the program is given up.
inline constexpr long k_most_internal_steps = 200'000;

/// Integrates one system over segments: smooth parts of a leg of the program, from one restart to the next.
class Integrator {
 public:
  virtual ~Integrator() = default;

  /// Starts a segment that ends at 1.
  /// @param xi  < 1
  /// @param y   complete state, consistent with the system's mode
  virtual void begin(double xi, std::span<const double> y) = 0;

  /// Where an internal step has ended: at xi = 1 exactly, at a guard's root, or in between.
  struct Advance {
    double xi = 0.0;
    bool hit_guard = false;
  };
  /// Takes one internal step. @throws SolverError, or std::domain_error where the equations end
  virtual Advance advance() = 0;

  /// Guards that fired at the end of the last internal step, by index into the GuardSet.
  [[nodiscard]] virtual std::span<const std::size_t> fired() const noexcept = 0;

  /// Gives the complete state at any xi in the last internal step.
  virtual void dense_output(double xi, std::span<double> y) = 0;

  /// Stores s = dy/dp at any xi in the last internal step in the ForwardSensitivities, if the integrator has them.
  virtual void dense_sensitivities(double /*xi*/) {}

  /// Largest distance from zero at which a guard fires together with a guard that has just fired.
  [[nodiscard]] virtual double guard_tolerance() const noexcept = 0;

  [[nodiscard]] virtual Statistics statistics() const = 0;
  /// statistics().rhs_evaluations, by which the drive bounds the work; called after every internal step.
  [[nodiscard]] virtual long rhs_evaluations() const { return statistics().rhs_evaluations; }

  /// Largest number of internal steps that a leg of the program may take.
  [[nodiscard]] virtual long most_steps() const noexcept { return k_most_internal_steps; }
};

/// Names that make_integrator() accepts: those of scenario files except "auto".
[[nodiscard]] std::span<const std::string_view> integrator_names() noexcept;

/// False for methods that have to take short steps where the equations are stiff, however smooth their solution.
[[nodiscard]] bool suits_stiff_equations(std::string_view name) noexcept;

/// Makes an integrator for a system.
/// @param name           one of integrator_names(), or IntegratorChoice::used of choose_integrator()
/// @param rows           approximate number of rows of the history in a leg of the program
/// @param sensitivities  derivatives to integrate too, if the integrator has_forward_sensitivities(); null: none
/// @throws std::logic_error for another name, or for "direct" with a system that is not solvable
[[nodiscard]] std::unique_ptr<Integrator> make_integrator(std::string_view name, Equations& system, GuardSet& guard_set,
                                                          const Tolerances& tolerances, std::size_t rows = 0,
                                                          ForwardSensitivities* sensitivities = nullptr);

/// Which integrator runs, and why.
struct IntegratorChoice {
  std::string asked;
  std::string used;
  std::string why;

  /// True if every state is solved for, and nothing integrated.
  [[nodiscard]] bool is_direct() const noexcept { return used == integrators::k_direct; }
};

/// Chooses the integrator asked for; for "auto", the direct form if the system is solvable, else switching methods.
[[nodiscard]] IntegratorChoice choose_integrator(const std::string& asked, const Equations& system);

/// Version of the SUNDIALS library in use.
[[nodiscard]] std::string sundials_version();

// One adapter per library.
[[nodiscard]] std::unique_ptr<Integrator> make_direct(Equations& system, double rtol, GuardSet& guard_set,
                                                      std::size_t rows);
enum class OdeMethod { cvode_adams, cvode_bdf, arkode_erk, arkode_dirk };
[[nodiscard]] std::unique_ptr<Integrator> make_sundials_ode(OdeMethod method, Equations& system, GuardSet& guard_set,
                                                            const Tolerances& tolerances,
                                                            ForwardSensitivities* sensitivities = nullptr);
enum class OdeintMethod { dopri5, fehlberg78, bulirsch_stoer, rosenbrock4 };
[[nodiscard]] std::unique_ptr<Integrator> make_stepped(OdeintMethod method, Equations& system, GuardSet& guard_set,
                                                       const Tolerances& tolerances);
enum class GslMethod { rk8pd, msadams, msbdf };
[[nodiscard]] std::unique_ptr<Integrator> make_stepped(GslMethod method, Equations& system, GuardSet& guard_set,
                                                       const Tolerances& tolerances);
/// Forward Euler with 1/rtol steps in each leg of the program, at most 1e7; transitions at the ends of steps.
[[nodiscard]] std::unique_ptr<Integrator> make_fixed_step(Equations& system, GuardSet& guard_set,
                                                          const Tolerances& tolerances);
/// Odeint's dopri5, replaced by CVODE's BDF when dopri5 takes too many steps; "auto" integrates with this pair.
[[nodiscard]] std::unique_ptr<Integrator> make_switching(Equations& system, GuardSet& guard_set,
                                                         const Tolerances& tolerances);
[[nodiscard]] std::unique_ptr<Integrator> make_ida(Equations& system, GuardSet& guard_set, const Tolerances& tolerances,
                                                   ForwardSensitivities* sensitivities = nullptr);

}  // namespace monograin
