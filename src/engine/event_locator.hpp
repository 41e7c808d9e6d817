/// Events for integrators that have no root finding of their own: roots of the guards along a solution that can be had
/// at any instant of a piece.
#pragma once

#include <vector>

#include "engine/integrator.hpp"

namespace monograin {

/// A piece of the solution is shorter than 1/32 of a step of the program, so that guards cross once in it; one that
/// crosses and comes back is looked for in its middle and at the extremum of the parabola through three values.
class EventLocator : public Integrator {
 public:
  [[nodiscard]] std::span<const std::size_t> fired() const noexcept override { return fired_; }
  [[nodiscard]] Statistics statistics() const override { return statistics_; }

 protected:
  EventLocator(HybridSystem& system, Watch& watch);

  /// A piece is not made smaller than this, in step coordinates.
  static constexpr double k_smallest = 1e-13;

  /// Where the piece that begins at xi has to end.
  [[nodiscard]] static double next_piece_end(double xi) noexcept;
  /// Takes up a segment: state, guards, and their sides.
  void begin_segment(double xi, std::span<const double> y);
  /// What was the end is the beginning.
  void begin_piece();
  /// Moves the end of the piece to the first root in it, if there is one.
  void locate_event();
  void look(double xi, std::span<const double> y, std::span<double> values);

  HybridSystem& system_;
  Watch& watch_;
  double begin_ = 0.0;  ///< of the piece
  double end_ = 0.0;
  std::vector<double> begin_state_, end_state_;
  std::vector<double> begin_values_, end_values_;
  std::vector<std::size_t> fired_;
  Statistics statistics_;

 private:
  /// The complete state in the present piece.
  virtual void state_at(double xi, std::span<double> y) = 0;
  /// The same just ahead of a segment's beginning, where y holds the state.
  virtual void state_ahead(double xi, std::span<double> y) = 0;
  /// Ends the piece at xi, with state and guards there.
  virtual void move_end(double xi) = 0;

  void read_sides();
  bool shorten_to_hidden_crossing();
  [[nodiscard]] double polish(std::size_t guard);

  std::vector<double> guess_;
  std::vector<double> values_, middle_values_;
};

}  // namespace monograin
