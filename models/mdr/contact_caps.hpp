/// Caps of contacts that meet: the source's model ends where they intersect.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mdr/particle.hpp"
#include "system/regimes.hpp"

namespace monograin::mdr {

class ContactCaps {
 public:
  explicit ContactCaps(const Setup& setup)
      : pairs_(cap_pairs_of(setup.classes)),
        angles_(setup.classes.size()),
        largest_angles_(setup.classes.size()),
        stops_(setup.settings.stops_at_cap_intersection) {}

  /// Before the first step: no caps have met.
  void start() noexcept {
    for (CapPair& pair : pairs_) pair.have_met = false;
    first_radius_.reset();
  }
  [[nodiscard]] std::span<const CapPair> pairs() const noexcept { return pairs_; }
  [[nodiscard]] bool both_touch(const Particle& p, std::size_t pair) const noexcept;
  /// Finds the angles of all caps at the state that the particle has evaluated last, for guard().
  void set_angles(const Particle& p);
  /// Finds the largest angles that the caps can have until the step or the mode ends, for may_meet().
  void set_largest_angles(const Particle& p);
  /// False if the caps of a pair stay apart until the step or the mode ends.
  [[nodiscard]] bool may_meet(std::size_t pair) const noexcept;
  /// Guard, at the last set_angles(): >= 0 where the caps of a pair intersect.
  [[nodiscard]] double guard(std::size_t pair) const noexcept { return guard_at(angles_, pair); }

  /// Records and logs that the caps of a pair have met.
  /// @return the reason to stop, if the settings say so
  std::optional<DomainEnd> meet(std::size_t pair, double growth, std::vector<Event>& log);
  /// Records caps that intersect from the start of a mode, because a contact was made within the cap of another one: no
  /// guard fires there. Caps that have parted may meet again.
  /// @return the reason to stop, if the settings say so
  std::optional<DomainEnd> meet_at_once(const Particle& p, std::vector<Event>& log);

  /// Apparent radius over R0 at which caps met for the first time.
  [[nodiscard]] std::optional<double> first_radius() const noexcept { return first_radius_; }

 private:
  [[nodiscard]] double guard_at(const std::vector<CapAngle>& angles, std::size_t pair) const noexcept {
    const CapPair& caps = pairs_[pair];
    return cap_guard(caps, angles[static_cast<std::size_t>(caps.first)], angles[static_cast<std::size_t>(caps.second)]);
  }

  std::vector<CapPair> pairs_;
  std::vector<CapAngle> angles_;          ///< one per class
  std::vector<CapAngle> largest_angles_;  ///< of each class ahead; NaN where it has no known bound
  bool stops_ = false;
  std::optional<double> first_radius_;
};

}  // namespace monograin::mdr
