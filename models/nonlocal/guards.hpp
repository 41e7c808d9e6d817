/// Guards of the nonlocal system: their kinds, which of them are alive in a mode, their values, and the limits at which
/// they end a run.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "nonlocal/particle.hpp"
#include "system/regimes.hpp"

namespace monograin::nonlocal {

/// A guard's index is that of a class, of a pair, or -1.
enum GuardKind : int {
  k_made,
  k_lost,
  k_touched,
  k_left,
  k_impingement,
  k_stiffening,
  k_force_ends,
  k_radius,
  k_centre,
  k_limit
};

/// Margin below which the source's formulation counts as stiffened.
inline constexpr double k_stiff_margin = 0.25;
/// A wall begins to move a free centre at a gap of this share of the touch tolerance. At the whole tolerance the centre
/// would move too early.
inline constexpr double k_begins = 1e-3;

/// Two walls, given by their classes, that may meet on the surface of the particle; one pair for each angle.
struct Pair {
  std::size_t first = 0, second = 0;
  double angle = 0.0;
  bool has_impinged = false;
};

[[nodiscard]] std::vector<Pair> pairs_of(const Contacts& contacts);

/// Set of the guards that are alive until the next transition or the end of the step.
class GuardSet {
 public:
  explicit GuardSet(const Contacts& contacts) : pairs_(pairs_of(contacts)), edge_angles_(contacts.class_count()) {}

  /// Forgets the events of the last run.
  void start();
  /// Arms the guards of the particle's mode, in the state evaluated last.
  void arm(Particle& p);
  [[nodiscard]] std::span<const Guard> list() const noexcept { return list_; }
  void values(Particle& p, double xi, std::span<const double> y, std::span<double> values);

  /// Notes that a pair has met, which happens once.
  const Pair& impinge(std::size_t pair) noexcept;
  /// Notes that the formulation has stiffened, which happens once.
  void stiffen() noexcept { has_stiffened_ = true; }
  [[nodiscard]] bool has_stiffened() const noexcept { return has_stiffened_; }

  /// End of the domain that the guard of a limit reports.
  [[nodiscard]] static DomainEnd end_at(Particle& p, const Guard& guard, double xi, std::span<const double> y);
  /// The limit at which a step begins, if the step leads beyond it: that limit's guard would not cross zero. Else none.
  [[nodiscard]] std::optional<DomainEnd> limit_at_start(Particle& p, std::span<const double> y) const;

 private:
  Guard& add(int kind, int index, int direction, std::string_view name);
  void arm_contacts(const Particle& p);
  void arm_carriers(const Particle& p);
  void arm_impingement(const Particle& p);
  void arm_ends_of_forces(const Particle& p);
  void arm_limits(Particle& p);
  [[nodiscard]] double angle_between_edges(Particle& p, const Pair& pair, double xi);

  std::vector<Guard> list_;
  std::vector<Pair> pairs_;
  bool has_stiffened_ = false;
  std::vector<double> edge_angles_;  ///< edge angles that values() has computed in this state; nan: none
};

}  // namespace monograin::nonlocal
