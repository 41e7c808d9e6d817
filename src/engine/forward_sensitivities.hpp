/// Derivatives of a run with respect to numbers of its scenario, integrated along with the run.
///
/// The scene that is integrated is the base. Each number p has two neighbours: the scenes for p - h and p + h. They are
/// not integrated. Their states are y - h s and y + h s, where s = dy/dp obeys ds/dxi = (df/dy) s + df/dp. The right
/// side is the difference of the neighbours' rates over 2 h (Hindmarsh et al., 2005); for the implicit form, it is the
/// difference of their residuals. At an event each neighbour moves to where its own guard is zero and makes its own
/// transition there, so that the memory of the law differs as it should. The neighbours' states after the event give s
/// anew (the jump of Hiskens and Pai, 2000).
///
/// Instants. After an event, s compares states at equal distances from each run's own event: the neighbours are at
/// xi - h sigma and xi + h sigma, where sigma = d(xi of the event)/dp. Rates that begin like a square root at an event
/// then have derivatives that begin like it, too. Where a branch of solutions ends, at pull-off, rates also end like a
/// square root. Such a segment is integrated twice: the first pass locates its end; in the second, sigma changes
/// linearly from its value at the beginning to its value at the end.
///
/// Sources: I. A. Hiskens and M. A. Pai, Trajectory sensitivity analysis of hybrid systems, IEEE Trans. Circuits
/// Syst. I 47 (2000) 204-220; A. C. Hindmarsh et al., SUNDIALS: suite of nonlinear and differential/algebraic equation
/// solvers, ACM Trans. Math. Softw. 31 (2005) 363-396.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "engine/step_clock.hpp"
#include "engine/step_plan.hpp"
#include "scene/scene.hpp"

namespace monograin {

/// The derivatives of a run cannot be carried on; what() says why.
class LostSensitivities : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  long evaluations = 0;  ///< of the equations of run and neighbours so far; a drive sets them
};

/// Scenes for a slightly smaller and a slightly larger value of a number.
struct Neighbours {
  Scene lower;
  Scene upper;
  double value = 0.0;  ///< value of the number in the base
  double step = 0.0;   ///< h: distance of the neighbours' values from it, > 0
};

/// True if an integrator can integrate derivatives along with a run.
[[nodiscard]] bool has_forward_sensitivities(std::string_view integrator) noexcept;

/// Derivatives of a run: s for the integrator, rows for the history, and transitions of the neighbours at events.
class ForwardSensitivities {
 public:
  /// @param base     system that is integrated; must outlive this object
  /// @param numbers  neighbours for each number with respect to which derivatives are taken
  ForwardSensitivities(HybridSystem& base, std::vector<Neighbours> numbers);
  ~ForwardSensitivities();
  ForwardSensitivities(const ForwardSensitivities&) = delete;
  ForwardSensitivities& operator=(const ForwardSensitivities&) = delete;

  [[nodiscard]] std::size_t count() const noexcept { return numbers_.size(); }
  /// Evaluations of the neighbours' equations.
  [[nodiscard]] long evaluations() const noexcept { return evaluations_; }

  // --- what an integrator asks

  /// Absolute value of a number.
  [[nodiscard]] double magnitude(std::size_t number) const noexcept;
  /// h of a number: distance of its neighbours' values from its own.
  [[nodiscard]] double step(std::size_t number) const noexcept { return numbers_[number].step; }
  /// Typical magnitude of an unknown.
  [[nodiscard]] double scale(std::size_t unknown) const noexcept { return base_.unknowns()[unknown].scale; }
  /// s at the present state: of all unknowns at the beginning of a segment, of the integrated unknowns later.
  [[nodiscard]] std::span<double> state(std::size_t number) noexcept { return numbers_[number].s; }
  /// False while the base is integrated alone.
  [[nodiscard]] bool is_active() const noexcept { return is_active_; }
  /// Computes ds/dxi of the integrated unknowns, for the explicit form.
  /// @param y      integrated unknowns of the base
  /// @param guess  complete state near y, from which the neighbours' states are completed
  /// @throws std::domain_error where the equations of a neighbour end
  void rates(std::size_t number, double xi, std::span<const double> y, std::span<const double> guess,
             std::span<const double> s, std::span<double> ds);

  /// Computes the residual of s and ds, for the implicit form; one number for each unknown.
  /// @throws std::domain_error where the equations of a neighbour end
  void residual(std::size_t number, double xi, std::span<const double> y, std::span<const double> dy,
                std::span<const double> s, std::span<const double> ds, std::span<double> res);
  /// Computes s of all unknowns but quadratures from completed neighbours, and ds from their rates.
  /// @param y  complete state of the base
  /// @throws std::domain_error where the equations of a neighbour end
  void complete(std::size_t number, double xi, std::span<const double> y, std::span<double> s, std::span<double> ds);

  // --- what a drive reports, in the order of a run; each function may throw LostSensitivities

  void set_active(bool is_active) noexcept { is_active_ = is_active; }
  void start();
  /// The base has begun a leg of the program. @param log  events of the base at its beginning
  void begin_leg(std::size_t leg, const StepPlan& plan, std::span<const Event> log);
  /// The base has evaluated its conditions where the leg begins. @param is_met  one of them is met there
  void expect_met_at_begin(bool is_met);
  /// The base has been taken past a singularity, to xi.
  void leave_singularity(double xi);
  /// True if the segment that begins may lead to the end of a branch of solutions.
  [[nodiscard]] bool may_end_branch() const;
  /// The first pass over a segment has ended at xi, where these guards have fired. If a branch ends there, puts the
  /// derivatives back to the beginning of the segment and aims the neighbours at their own ends: in the second pass
  /// they arrive together with the base.
  /// @return true if a branch ends there
  [[nodiscard]] bool aim(std::span<const std::size_t> fired, double xi, std::span<const double> y);
  /// The integration has come to xi, where these guards have fired. Moves each neighbour to where its own guards fire.
  void locate(std::span<const std::size_t> fired, double xi, std::span<const double> y);
  /// The base has made the transitions of these guards of the system. @param log  events of the base
  void fire(std::span<const std::size_t> of_system, std::span<const Event> log);
  /// Guards have fired that only mark an instant and change nothing.
  void pass_mark(std::span<const std::size_t> of_system, double xi, std::span<const Event> log);
  /// The base has solved for the unknowns that jump in a transition.
  void solve();
  /// The event is over. @param is_met  a condition has ended the step
  void end_event(std::span<const std::size_t> fired, double xi, bool is_met);
  /// The leg ends at xi = 1. @param is_solved  a remainder of the size of round-off was solved for
  void end_leg(std::span<const double> y, bool is_solved);

  // --- rows: for each number d(time)/dp and the derivative of every observable that has no words; after them, in the
  // same order, the error of each: at an event that of the instant's round-off, between events the truncation of its
  // difference quotient

  /// Row at the present corner or event, which moves with the numbers.
  [[nodiscard]] std::span<const double> row_here();
  /// Row at a fixed time within a step.
  /// @param clock  of the base
  [[nodiscard]] std::span<const double> row_at(double xi, std::span<const double> y, const StepClock& clock);

 private:
  struct Side;
  struct Number {
    double value = 0.0;
    double step = 0.0;
    double sigma = 0.0;    ///< d(xi)/dp of the neighbours' positions where the segment begins
    double stretch = 0.0;  ///< d(sigma)/dxi in the segment
    std::vector<double> s;
    std::vector<Side> sides;  ///< lower, upper
  };

  /// d(xi)/dp of the neighbours' positions when the base is at xi.
  [[nodiscard]] double sigma_at(const Number& number, double xi) const noexcept {
    return number.sigma + number.stretch * (xi - begin_);
  }
  [[nodiscard]] double slope_of(const Number& number, std::size_t unknown) const noexcept;
  void each_side(const std::function<void(Number&, Side&)>& action);
  void place(Number& number, double xi, std::span<const double> y, double beyond = 0.0);
  void expect_near(const Side& side, std::span<const double> y) const;
  void resume();
  void find_slopes(double xi, std::span<const double> y);
  void observe(Side& side);
  void find_round_off(Number& number, std::span<double> round_off);
  void add_round_off_to_row(Number& number);
  void add_to_row(Number& number, double of_time, double beyond_slopes = 0.0);
  void add_truncation(const Number& number, double xi, std::span<const double> y);

  HybridSystem& base_;
  std::size_t size_ = 0;  ///< number of integrated unknowns
  std::vector<std::size_t> columns_;
  std::vector<Number> numbers_;
  bool is_active_ = true;
  bool is_placed_ = true;  ///< the neighbours' states belong to the present state of the base
  double begin_ = 0.0;     ///< step coordinate where the segment begins
  long evaluations_ = 0;
  std::array<std::vector<double>, 2> rates_;  ///< rates or residuals of the two neighbours
  std::array<std::vector<double>, 2> values_;
  std::array<std::vector<double>, 2> states_;
  std::vector<double> state_, base_rates_, base_values_, slope_, guards_, row_, truncation_;
};

}  // namespace monograin
