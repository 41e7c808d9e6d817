/// Events of a packing. All lie at known packing fractions, and therefore at known values of the controlled quantity.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "packing/mode.hpp"
#include "system/regimes.hpp"

namespace monograin::packing {

/// Yielding of the particles during compaction: two packing fractions, and whether the packing has passed them.
struct Yielding {
  double softening = 0.0;        ///< Phi above which the plastic packing bears less stress than the elastic one
  double full_plasticity = 0.0;  ///< Phi above which all particles have yielded
  bool is_softer = false;
  bool is_full = false;

  explicit Yielding(const Law& law);
  /// Passes what lies at or before a value of the controlled quantity, and logs the events.
  void pass(const ControlledBranch& branch, double value, std::vector<Event>& log);
};

enum GuardKind {
  jams,    ///< the packing jams, or comes loose
  grips,   ///< the stress reaches the value with which its branch begins
  starts,  ///< the closed start ends
  softens,
  yields_fully,
  is_full,
  ends  ///< the branch ends before the packing is full
};

/// Guards of a ramp, and the values of the controlled quantity at which they lie.
class Guards {
 public:
  /// Arms the guards that lie ahead of a packing that is at a value of the ramp.
  void arm(const ControlledBranch& branch, const Ramp& ramp, Mode mode, const Yielding& yielding, double value);
  [[nodiscard]] std::span<const Guard> list() const noexcept { return guards_; }
  /// Value of the controlled quantity at which a guard lies.
  [[nodiscard]] double value(std::size_t guard) const { return values_[guard]; }
  /// Distances from the guards at an instant, over the length of the ramp.
  void distances(const Ramp& ramp, double xi, std::span<double> values) const;

 private:
  void arm_jamming(const ControlledBranch& branch, const Ramp& ramp, Mode mode);
  void arm_loosening(const ControlledBranch& branch, const Ramp& ramp, Mode mode);
  void arm_compaction(const ControlledBranch& branch, const Ramp& ramp, const Yielding& yielding, double value);
  void add(const Ramp& ramp, GuardKind kind, std::string_view name, double value);

  std::vector<Guard> guards_;
  std::vector<double> values_;
};

}  // namespace monograin::packing
