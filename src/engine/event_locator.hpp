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
  EventLocator(Equations& system, GuardSet& guard_set);

  /// Pieces shorter than this (step coordinates) have no evaluations inside, and are not searched for two crossings:
  /// guards near zero are round-off there.
  static constexpr double k_shortest_sampled = 1e-6;

  /// A position of a piece, with the complete state and the values of the guards there.
  struct Instant {
    double xi = 0.0;
    std::vector<double> state, values;
  };

  /// Starts a segment at xi: stores the state, evaluates the guards and finds which side of zero each one is on.
  void begin_segment(double xi, std::span<const double> y);
  /// Starts a piece where the last one ended.
  void begin_piece();
  /// Evaluates the guards inside the present piece and stores their values. xi must be beyond all earlier evaluations.
  void sample_inside(double xi, std::span<const double> y);
  /// Finds the state at xi inside the present piece, evaluates the guards there and stores their values.
  /// @throws std::domain_error if there is no state
  void sample_inside(double xi);
  /// Drops the evaluations inside the piece.
  void forget_samples() noexcept { samples_.clear(); }
  /// Moves the end of the piece to the first root in it, if there is one, and collects the guards that fire there.
  void locate_event();
  /// Finds state and guards at xi within the present piece. @throws std::domain_error if there is no state
  void evaluate(double xi, Instant& at);

  Equations& system_;
  GuardSet& guard_set_;
  Instant begin_, end_;  ///< of the present piece
  std::vector<std::size_t> fired_;
  Statistics statistics_;

 private:
  /// Values of the guards at one position of the piece.
  struct View {
    View(double position, std::span<const double> guard_values) : xi(position), values(guard_values) {}
    View(const Instant& instant) : View(instant.xi, instant.values) {}
    double xi;
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

  void evaluate_guards(double xi, std::span<const double> y, std::span<double> values);
  void read_sides();
  [[nodiscard]] std::size_t row_length() const noexcept { return 1 + guard_set_.size(); }
  [[nodiscard]] std::size_t sample_count() const noexcept { return samples_.size() / row_length(); }
  [[nodiscard]] View sample(std::size_t index) const;
  [[nodiscard]] bool any_crosses(const View& before, const View& after) const;
  [[nodiscard]] double hidden_extremum(std::size_t interval) const;
  [[nodiscard]] std::optional<View> crossed_in(std::size_t interval);
  [[nodiscard]] double first_root(const View& before, const View& after, std::size_t& guard);
  [[nodiscard]] bool collect_fired(std::size_t first, const View& last, bool is_shorter);
  [[nodiscard]] std::size_t shorten(double xi, std::size_t samples);
  void sample_up_to(double last);
  [[nodiscard]] double polish(std::size_t guard, const View& before, const View& after);

  std::vector<double> samples_;        ///< rows of a position inside the piece and the guards there, in order of xi
  Instant between_, extremum_, root_;  ///< between two evaluations: any position, an extremum, the first root so far
  std::vector<Candidate> candidates_;
};

}  // namespace monograin
