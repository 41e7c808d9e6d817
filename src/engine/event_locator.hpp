/// Events for integrators without root finding of their own: roots of the guards along a solution that is available at
/// any instant of a piece.
#pragma once

#include <optional>
#include <vector>

#include "engine/integrator.hpp"
#include "system/resolution.hpp"

namespace monograin {

/// Base of integrators that locate events between evaluations of the guards. The integrator evaluates the guards at the
/// ends of a piece and inside it, at most about 1/16 of a leg of the program apart unless all guards are monotone. A
/// guard is taken to cross zero at most once between two evaluations. To find one that crosses and returns, the guards
/// are also evaluated at the extremum of the parabola through three values, and at points that approach the end of a
/// branch.
class EventLocator : public Integrator {
 public:
  [[nodiscard]] std::span<const std::size_t> fired() const noexcept override { return fired_; }
  [[nodiscard]] Statistics statistics() const override { return statistics_; }

 protected:
  /// @param samples  expected evaluations of the guards inside a piece; memory for them is reserved
  EventLocator(Equations& system, GuardSet& guard_set, std::size_t samples = 0);

  /// Pieces shorter than this (step coordinates) have no evaluations inside, and are not searched for two crossings:
  /// guards near zero are round-off there.
  static constexpr double k_shortest_sampled = 1e-6;

  /// Starts a segment at xi: stores the state, evaluates the guards and finds which side of zero each one is on.
  void begin_segment(double xi, std::span<const double> y);
  /// Starts a piece where the last one ended.
  void begin_piece();
  /// Evaluates the guards inside the present piece and stores their values. xi must be beyond all earlier evaluations.
  void sample_inside(double xi, std::span<const double> y);
  /// Drops the evaluations inside the piece.
  void forget_samples() noexcept { samples_.clear(); }
  /// Moves the end of the piece to the first root in it, if there is one, and collects the guards that fire there.
  void locate_event();
  /// Evaluates the guards at (xi, y), and counts the evaluation.
  void evaluate_guards(double xi, std::span<const double> y, std::span<double> values);

  Equations& system_;
  GuardSet& guard_set_;
  double begin_ = 0.0;  ///< where the present piece begins; end_: where it ends (step coordinates)
  double end_ = 0.0;
  std::vector<double> begin_state_, end_state_;
  std::vector<double> begin_values_, end_values_;
  std::vector<std::size_t> fired_;
  Statistics statistics_;

 private:
  /// Values of the guards at one position of the piece.
  struct View {
    double xi = 0.0;
    std::span<const double> values;
  };

  /// A guard that crosses zero between two evaluations.
  struct Candidate {
    std::size_t guard = 0;
    double share = 0.0;  ///< where its secant crosses zero, from 0 at the first evaluation to 1 at the second
  };

  /// Finds the complete state at xi within the present piece. @throws std::domain_error if there is none
  virtual void state_at(double xi, std::span<double> y) = 0;
  /// Finds the complete state at xi just ahead of a segment's beginning.
  /// @param y  the state at the beginning; becomes that at xi
  /// @throws std::domain_error if there is none
  virtual void state_ahead(double xi, std::span<double> y) = 0;
  /// Ends the piece at xi and evaluates state and guards there. May end it earlier if no state exists at xi.
  virtual void move_end(double xi) = 0;

  void read_sides();
  [[nodiscard]] View sample(std::size_t index) const;
  [[nodiscard]] bool any_crosses(const View& before, const View& after) const;
  [[nodiscard]] double hidden_extremum(std::size_t interval) const;
  [[nodiscard]] std::optional<View> crossed_in(std::size_t interval);
  [[nodiscard]] double first_root(const View& before, const View& after, std::size_t& guard);
  [[nodiscard]] bool collect_fired(std::size_t first, const View& last, bool is_shorter);
  [[nodiscard]] std::size_t shorten(double xi, std::size_t samples);
  void sample_up_to(double last);
  [[nodiscard]] double polish(std::size_t guard, const View& before, const View& after);

  std::size_t most_samples_;           ///< evaluations inside a piece for which memory is reserved
  std::vector<double> samples_;        ///< positions of the evaluations inside the piece, in increasing order
  std::vector<double> sample_values_;  ///< one row of guard values for each of them
  std::vector<double> guess_;
  std::vector<double> values_, extremum_values_, root_values_;
  std::vector<Candidate> candidates_;
};

}  // namespace monograin
