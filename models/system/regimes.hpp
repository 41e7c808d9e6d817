/// Regimes of a model: the mode of a system, the guards that are alive in it, and the transitions when a guard fires.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "system/limit.hpp"
#include "system/walls.hpp"

namespace monograin {

/// A guard: a root function, scaled to order one, that is alive in the present mode.
struct Guard {
  int kind = 0;           ///< code of the guard, private to the system
  int index = 0;          ///< contact class, or pair of classes, that the guard belongs to
  int direction = 1;      ///< the guard fires when it crosses zero upwards (+1) or downwards (-1)
  std::string_view name;  ///< name of the event that the guard locates
  /// The guard changes the form of the equations but no observable: it leaves no rows in the history.
  bool is_silent = false;
  /// The guard marks an instant and changes neither mode nor state. The history shows it if fire() logs an event.
  bool is_mark = false;
  /// The guard is a function of the program only, free of integration error.
  bool is_exact = false;
  /// The guard ends a branch of solutions: rates, or their slopes, are unbounded towards its root. Just before the root
  /// other guards may cross zero and return within a vanishing interval of xi.
  bool is_branch_end = false;
  /// The guard is monotone over the rest of the step: its values at two instants show whether it crosses between them.
  bool is_monotone = false;

  /// `index` as a position in a list; 0 if there is none.
  [[nodiscard]] std::size_t list_index() const noexcept { return static_cast<std::size_t>(std::max(0, index)); }
};

/// A regime transition or other located instant.
struct Event {
  std::string_view name;
  int contact_class = -1;  ///< -1: the particle
  int other_class = -1;    ///< second class of an event of two
};

/// End of a run at a limit of the model: the event that ends the run, and the limit that it meets.
struct DomainEnd {
  Event event;
  LimitPoint point;
};

/// Thrown if the system cannot begin the next step of the program, because it meets a limit at the start of the step.
class CannotBegin : public DomainError {
 public:
  explicit CannotBegin(const DomainEnd& end) : DomainError(end.point), end_(end) {}
  [[nodiscard]] const DomainEnd& end() const noexcept { return end_; }

 private:
  DomainEnd end_;
};

/// Regimes of a system, as the engine locates their ends and passes from one to the next.
class Regimes {
 public:
  /// Sets y to the state before the first step.
  virtual void start(std::span<double> y) = 0;

  /// Begins the next leg of the program, resolves the mode at its start, and logs the events that happen there.
  /// @param ramps  one for each channel of the scene; with walls, one for each contact class
  /// @throws CannotBegin if the system meets a limit at the start of the leg
  virtual void begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) = 0;

  /// Returns a function that restores the present mode and memory of the system, for use after a rehearsed step. The
  /// function must not outlive the system.
  [[nodiscard]] virtual std::function<void()> checkpoint() = 0;

  /// Guards alive until the next transition or the end of the step, in the order in which they are applied.
  [[nodiscard]] virtual std::span<const Guard> guards() const noexcept = 0;
  /// Computes the value of every guard, in the order of guards().
  virtual void guard_values(double xi, std::span<const double> y, std::span<double> values) = 0;

  /// Applies the transitions of the guards with these indices, resolves the mode, and logs the events. Unknowns that
  /// jump keep their values from before the event in y; the next solve() sets the values after it.
  /// @return the limit that ends the run here; empty if the run goes on
  virtual std::optional<DomainEnd> fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                        std::vector<Event>& log) = 0;

  /// True if the walls of a class do not touch the particle.
  [[nodiscard]] virtual bool is_open(int /*contact_class*/) const noexcept { return false; }

  /// True if contacts adhere: the force of a closed contact may then pass through zero and pull.
  [[nodiscard]] virtual bool contacts_adhere() const noexcept { return false; }

 protected:
  Regimes() = default;
  Regimes(const Regimes&) = default;
  Regimes& operator=(const Regimes&) = default;
  ~Regimes() = default;
};

}  // namespace monograin
