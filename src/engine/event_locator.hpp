/// Events for integrators that have no root finding of their own: roots of the guards along a solution that can be had
/// at any instant of a piece.
#pragma once

#include <vector>

#include "engine/integrator.hpp"

namespace monograin {

/// The integrator looks at the guards at the ends of a piece and wherever it wants in between, not farther apart than
/// about 1/16 of a step of the program, unless all of them go one way. Guards cross once between two looks; one that
/// crosses and comes back is looked for at the extremum of the parabola through three values, and ever nearer to the
/// end of a branch.
class EventLocator : public Integrator {
 public:
  [[nodiscard]] std::span<const std::size_t> fired() const noexcept override { return fired_; }
  [[nodiscard]] Statistics statistics() const override { return statistics_; }

 protected:
  /// @param looks  inside of a piece, that there is room for without an allocation
  EventLocator(HybridSystem& system, GuardSet& guard_set, std::size_t looks = 0);

  /// Shorter pieces are not looked into: guards near zero are rounding there.
  static constexpr double k_smallest_looked_into = 1e-6;
  /// What a guard at zero is by rounding. Errors of an integrator are no such thing: a short regime lies within them.
  static constexpr double k_zero_guard = 1e-13;

  /// Takes up a segment: state, guards, and their sides.
  void begin_segment(double xi, std::span<const double> y);
  /// What was the end is the beginning.
  void begin_piece();
  /// Looks at the guards inside of the piece that has begun, beyond the last such look.
  void look_inside(double xi, std::span<const double> y);
  /// Forgets the looks inside of the piece.
  void forget_looks() noexcept { looks_.clear(); }
  /// Moves the end of the piece to the first root in it, if there is one.
  void locate_event();
  void look(double xi, std::span<const double> y, std::span<double> values);

  HybridSystem& system_;
  GuardSet& guard_set_;
  double begin_ = 0.0;  ///< of the piece
  double end_ = 0.0;
  std::vector<double> begin_state_, end_state_;
  std::vector<double> begin_values_, end_values_;
  std::vector<std::size_t> fired_;
  Statistics statistics_;

 private:
  /// The guards at one place of the piece.
  struct View {
    double xi = 0.0;
    std::span<const double> values;
  };

  /// A guard that crosses between two looks.
  struct Candidate {
    std::size_t guard = 0;
    double share = 0.0;  ///< of the distance between the looks at which its secant crosses
  };

  /// The complete state in the present piece.
  virtual void state_at(double xi, std::span<double> y) = 0;
  /// The same just ahead of a segment's beginning, where y holds the state.
  virtual void state_ahead(double xi, std::span<double> y) = 0;
  /// Ends the piece at xi, with state and guards there.
  virtual void move_end(double xi) = 0;

  void read_sides();
  [[nodiscard]] View seen(std::size_t place) const;
  [[nodiscard]] bool any_crosses(const View& before, const View& after) const;
  [[nodiscard]] double hidden_extremum(std::size_t place) const;
  [[nodiscard]] double first_root(const View& before, const View& after, std::size_t& guard);
  [[nodiscard]] bool collect_fired(std::size_t first, const View& last, bool is_shorter);
  [[nodiscard]] std::size_t shorten(double xi, std::size_t looks);
  [[nodiscard]] bool is_branch_end(std::size_t guard) const;
  void look_up_to(double last);
  [[nodiscard]] double polish(std::size_t guard, const View& before, const View& after);

  std::size_t most_looks_;           ///< that are usual
  std::vector<double> looks_;        ///< places of the looks inside of the piece
  std::vector<double> look_values_;  ///< a row for each
  std::vector<double> guess_;
  std::vector<double> values_, extremum_values_, root_values_;
  std::vector<Candidate> candidates_;
};

}  // namespace monograin
