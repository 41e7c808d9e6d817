/// Derivatives of a run with respect to numbers of its scenario, carried along with it.
///
/// Beside the scene that is integrated, the base, stand two neighbours for each number p: the scenes of p - h and p +
/// h. They are not integrated. Their states are y - h s and y + h s, and s = dy/dp obeys ds/dxi = (df/dy) s + df/dp,
/// taken as the difference of the neighbours' rates over 2 h (Hindmarsh et al., 2005); of the implicit form, as that of
/// their residuals. At an event each neighbour goes on to where its own guard is zero and takes its own transition
/// there, so that what the law remembers differs as it should; the neighbours' states after it give s anew (the jump of
/// Hiskens and Pai, 2000).
///
/// Instants. From an event on, s compares states that are equally far from each run's own event: the neighbours stand
/// at xi - h sigma and xi + h sigma, where sigma = d(xi of the event)/dp. Rates that begin like a root at an event then
/// have derivatives that begin like it, too. Where a branch of solutions ends, at pull-off, rates end like a root as
/// well: such a segment is tried first, and then sigma goes linearly from that of its beginning to that of its end.
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
#include <string>
#include <string_view>
#include <vector>

#include "engine/step_plan.hpp"
#include "scene/scene.hpp"

namespace monograin {

/// The derivatives cannot be carried on; what() says why.
class LostSensitivities : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Scenes for a little less and a little more of a number.
struct Neighbours {
  Scene lower;
  Scene upper;
  double value = 0.0;  ///< of the number
  double step = 0.0;   ///< to either side, > 0
};

/// Whether an integrator carries derivatives along.
[[nodiscard]] bool has_forward_sensitivities(std::string_view integrator) noexcept;

class ForwardSensitivities {
 public:
  /// @param base  outlives this object
  ForwardSensitivities(HybridSystem& base, std::vector<Neighbours> numbers);
  ~ForwardSensitivities();
  ForwardSensitivities(const ForwardSensitivities&) = delete;
  ForwardSensitivities& operator=(const ForwardSensitivities&) = delete;

  [[nodiscard]] std::size_t count() const noexcept { return numbers_.size(); }
  /// Evaluations of the neighbours' equations.
  [[nodiscard]] long evaluations() const noexcept { return evaluations_; }

  // --- what an integrator asks

  /// Magnitude of a number.
  [[nodiscard]] double magnitude(std::size_t number) const noexcept;
  /// How far the neighbours of a number are from it.
  [[nodiscard]] double step(std::size_t number) const noexcept { return numbers_[number].step; }
  /// Typical magnitude of an unknown.
  [[nodiscard]] double scale(std::size_t unknown) const noexcept { return base_.unknowns()[unknown].scale; }
  /// s of all unknowns, where the integration stands: at the beginning of a segment, later only of integrated ones.
  [[nodiscard]] std::span<double> state(std::size_t number) noexcept { return numbers_[number].s; }
  /// False while the base is integrated alone.
  [[nodiscard]] bool is_active() const noexcept { return is_active_; }
  /// ds/dxi.
  /// @param y      integrated unknowns of the base
  /// @param guess  a complete state near them
  /// @throws std::domain_error where the equations of a neighbour end
  void rates(std::size_t number, double xi, std::span<const double> y, std::span<const double> guess,
             std::span<const double> s, std::span<double> ds);

  /// What the implicit form leaves of s and ds, one number for each unknown.
  /// @throws std::domain_error where the equations of a neighbour end
  void residual(std::size_t number, double xi, std::span<const double> y, std::span<const double> dy,
                std::span<const double> s, std::span<const double> ds, std::span<double> res);
  /// Takes s of all unknowns but quadratures from completed neighbours, and ds from their rates.
  /// @param y  complete
  /// @throws std::domain_error where the equations of a neighbour end
  void complete(std::size_t number, double xi, std::span<const double> y, std::span<double> s, std::span<double> ds);

  // --- what a drive says, in the order in which it comes by it; each may throw LostSensitivities

  void set_active(bool is_active) noexcept { is_active_ = is_active; }
  void start();
  /// The base has begun a step of the program.
  void begin_step(std::size_t step, const StepPlan& plan, std::span<const Event> log);
  /// Whether a condition holds where the step begins.
  void expect_held(bool is_held);
  /// The base has been taken past a singularity, to xi.
  void leave_singularity(double xi);
  /// Whether the segment that begins may lead to the end of a branch of solutions.
  [[nodiscard]] bool may_end_branch() const;
  /// What has fired at xi, when the segment was tried. If a branch ends there, derivatives are as at its beginning
  /// again, and the neighbours will come to their own ends together with the base.
  /// @return whether a branch ends there
  [[nodiscard]] bool aim(std::span<const std::size_t> fired, double xi, std::span<const double> y);
  /// Integration has come to xi, where these guards have fired. The neighbours go to where theirs do.
  void locate(std::span<const std::size_t> fired, double xi, std::span<const double> y);
  /// The base has fired guards of the system. @param log  what it has logged
  void fire(std::span<const std::size_t> of_system, std::span<const Event> log);
  /// These have fired, which change nothing.
  void pass_mark(std::span<const std::size_t> of_system, double xi, std::span<const Event> log);
  /// What jumps has been solved for.
  void solve();
  /// The event is over. @param is_met  a condition has ended the step
  void end_event(std::span<const std::size_t> fired, double xi, bool is_met);
  /// The step ends at xi = 1. @param is_solved  a remainder of the size of rounding was solved for
  void end_step(std::span<const double> y, bool is_solved);

  // --- rows: for each number d(time)/dp, and that of every observable that has no words; after them what the rounding
  // of the instant makes of each, 0 between events

  /// Following the corner or event at which the base stands.
  [[nodiscard]] std::span<const double> row_here();
  /// At a fixed time.
  /// @param start, duration  of the step of the program [s]
  [[nodiscard]] std::span<const double> row_at(double xi, std::span<const double> y, double start, double duration);

 private:
  struct Side;
  struct Number {
    double value = 0.0;
    double step = 0.0;
    double sigma = 0.0;    ///< d(xi)/dp at which the neighbours stand where the segment begins
    double stretch = 0.0;  ///< how it grows with xi
    std::vector<double> s;
    std::vector<Side> sides;  ///< lower, upper
  };

  /// d(xi)/dp at which the neighbours stand.
  [[nodiscard]] double sigma_at(const Number& number, double xi) const noexcept {
    return number.sigma + number.stretch * (xi - begin_);
  }
  [[nodiscard]] double slope_of(const Number& number, std::size_t unknown) const noexcept;
  void each_side(const std::function<void(Number&, Side&)>& action);
  void place(Number& number, double xi, std::span<const double> y, double beyond = 0.0);
  void expect_near(const Side& side, std::span<const double> y) const;
  void resume();
  void go_to_guard(Side& side, std::span<const std::size_t> fired);
  void expect_same_guards(Side& side, std::span<const Event> log, std::span<const Event> of_side) const;
  void expect_no_other_guard(Side& side, std::span<const std::size_t> fired) const;
  void find_slopes(double xi, std::span<const double> y);
  void observe(Side& side);
  void add_rounding_to_row(Number& number);
  void add_to_row(Number& number, double of_time, double beyond_slopes = 0.0);

  HybridSystem& base_;
  std::size_t size_ = 0;  ///< integrated unknowns
  std::vector<std::size_t> columns_;
  std::vector<Number> numbers_;
  bool is_active_ = true;
  bool is_placed_ = true;  ///< the neighbours stand where the base does
  double begin_ = 0.0;     ///< of the segment
  long evaluations_ = 0;
  std::array<std::vector<double>, 2> rates_;  ///< or residuals
  std::array<std::vector<double>, 2> values_;
  std::array<std::vector<double>, 2> states_;
  std::vector<double> state_, base_rates_, slope_, guards_, row_;
};

}  // namespace monograin
