#include "packing/events.hpp"

#include <algorithm>
#include <cmath>

namespace monograin::packing {

Yielding::Yielding(const Law& law)
    : softening(packing::softening(law)), full_plasticity(packing::full_plasticity(law)) {}

void Yielding::pass(const ControlledBranch& branch, double value, std::vector<Event>& log) {
  const auto take = [&](bool& is_passed, double threshold, std::string_view name) {
    if (is_passed || threshold > branch.range().end) return;
    if (threshold > branch.range().begin && branch.value_at(threshold) > value) return;
    is_passed = true;
    log.push_back({name});
  };
  take(is_softer, softening, "plastic-softening");
  take(is_full, full_plasticity, "fully-plastic");
}

void Guards::arm(const ControlledBranch& branch, const Ramp& ramp, Mode mode, const Yielding& yielding, double value) {
  guards_.clear();
  values_.clear();
  if (ramp.direction() > 0) {
    arm_jamming(branch, ramp, mode);
    // A loose packing reaches strains that a jammed one has, but not its states.
    if (mode != Mode::unjammed) arm_compaction(branch, ramp, yielding, value);
  } else if (ramp.direction() < 0) {
    arm_loosening(branch, ramp, mode);
  }
}

/// Adds a guard at a value of the controlled quantity, if the ramp leads there.
void Guards::add(const Ramp& ramp, GuardKind kind, std::string_view name, double value) {
  const int d = ramp.direction();
  if (!(d > 0 ? value <= ramp.end : value >= ramp.end)) return;
  guards_.push_back({kind, 0, d, name, name.empty()});
  values_.push_back(value);
}

/// Arms the guards before integration: the packing jams, its branch begins, and its closed start ends.
void Guards::arm_jamming(const ControlledBranch& branch, const Ramp& ramp, Mode mode) {
  switch (mode) {
    case Mode::unjammed:
      // Under stress the packing jams at once, at the start of the step.
      if (ramp.control != Control::stress) add(ramp, jams, "jamming", branch.value_at_jamming());
      break;
    case Mode::held:
      add(ramp, grips, "", branch.range().least);
      break;
    case Mode::starting:
      add(ramp, starts, "", branch.value_at(branch.end_of_start()));
      break;
    case Mode::jammed:
      break;
  }
}

/// Arms the guards of a decreasing ramp: integration ends, the stress falls below its branch, the packing comes loose.
void Guards::arm_loosening(const ControlledBranch& branch, const Ramp& ramp, Mode mode) {
  switch (mode) {
    case Mode::unjammed:
    case Mode::held:
      break;
    case Mode::starting:
      if (ramp.control == Control::stress)
        add(ramp, grips, "", branch.range().least);
      else
        add(ramp, jams, "jamming", branch.value_at_jamming());
      break;
    case Mode::jammed: {
      // If the strain falls at first, a decreasing ramp may pass its value at jamming before the closed start.
      const double start = branch.value_at(branch.end_of_start());
      const bool comes_loose = ramp.control == Control::strain && start <= branch.value_at_jamming();
      add(ramp, comes_loose ? jams : starts, comes_loose ? "jamming" : "", start);
      break;
    }
  }
}

/// Arms the guards of a jammed packing: it softens, yields as a whole, and is full or reaches the end of its branch.
void Guards::arm_compaction(const ControlledBranch& branch, const Ramp& ramp, const Yielding& yielding, double value) {
  const double end = branch.range().end;
  if (!yielding.is_softer && yielding.softening <= end) {
    add(ramp, softens, "plastic-softening", branch.value_at(yielding.softening));
  }
  if (!yielding.is_full && yielding.full_plasticity <= std::min(1.0, end)) {
    add(ramp, yields_fully, "fully-plastic", branch.value_at(yielding.full_plasticity));
  }
  if (end != 1.0) {
    add(ramp, ends, "limit", branch.last_value());
  } else if (value < branch.range().greatest) {
    add(ramp, is_full, "full", branch.range().greatest);
  }
}

void Guards::distances(const Ramp& ramp, double xi, std::span<double> values) const {
  const double length = std::abs(ramp.rate());
  for (std::size_t g = 0; g < guards_.size(); ++g) values[g] = (ramp.value(xi) - values_[g]) / length;
}

}  // namespace monograin::packing
