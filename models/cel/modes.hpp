/// Modes of a coupled elastic-plastic particle: which contacts touch and which flow, the guards of a mode, and the
/// limits of the law.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cel/motion.hpp"
#include "system/regimes.hpp"

namespace monograin::cel {

enum GuardKind : int { k_made, k_lost, k_yield, k_reversal, k_fold, k_coverage, k_away };

/// Set of the guards that are alive until the next transition or the end of the step.
class GuardSet {
 public:
  void arm(const Particle& p);
  [[nodiscard]] std::span<const Guard> list() const noexcept { return list_; }
  /// Values at the state that particle and motion evaluated.
  void values(const Particle& p, const Motion& motion, double xi, std::span<double> values) const;
  /// The limit that this state is at or beyond, if its guard is alive.
  [[nodiscard]] std::optional<DomainEnd> limit_met(const Particle& p, const Motion& motion, double xi) const;

 private:
  Guard& add(GuardKind kind, int index);

  std::vector<Guard> list_;
};

/// True for the guard of a limit of the law, where a run ends.
[[nodiscard]] inline bool is_limit(const Guard& guard) noexcept {
  return guard.kind == k_fold || guard.kind == k_coverage || guard.kind == k_away;
}
/// End of a run at a limit, whose guard has fired.
[[nodiscard]] DomainEnd end_at(const Guard& guard, const Particle& p, double xi);

/// Decides the mode from here on, and logs contacts that are made or lost, or begin or stop to flow.
/// @param fired  guards that have just fired
void decide_mode(Particle& p, Motion& motion, double xi, std::span<const double> y, std::span<const Guard> fired,
                 std::vector<Event>& log);

}  // namespace monograin::cel
