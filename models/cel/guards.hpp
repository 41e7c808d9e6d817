/// Guards of a coupled elastic-plastic particle, and the limits of its law.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cel/motion.hpp"
#include "system/hybrid_system.hpp"

namespace monograin::cel {

enum GuardKind : int { k_made, k_lost, k_yield, k_reversal, k_fold, k_coverage };

/// Set of the guards that are alive until the next transition or the end of the step.
class GuardSet {
 public:
  void arm(const Particle& p);
  [[nodiscard]] std::span<const Guard> list() const noexcept { return list_; }
  /// Values at the state that particle and motion evaluated.
  void values(const Particle& p, const Motion& motion, double xi, std::span<double> values) const;

 private:
  Guard& add(int kind, int index);

  std::vector<Guard> list_;
};

/// End of a run at a limit.
/// @param kind  k_fold or k_coverage
[[nodiscard]] DomainEnd end_at(int kind, const Particle& p, double xi);
/// The limit that a state is at or beyond.
[[nodiscard]] std::optional<DomainEnd> limit_met(const Particle& p, const Motion& motion, double xi);

}  // namespace monograin::cel
