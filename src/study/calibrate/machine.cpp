#include "study/calibrate/machine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scenario/units.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

constexpr int k_most_runs = 80;
// Least step of a secant, over the largest x: the slope then has three digits.
constexpr double k_least_step = 1e3 * k_epsilon;
// Least step of a secant, over the last moves of the turns before the point, which change the force as well.
constexpr double k_least_share = 10.0;

/// The last trials of one displacement that showed too little and too much.
class Bracket {
 public:
  struct Trial {
    double particle = 0.0;
    double error = 0.0;  ///< of the displacement shown by the machine
    double force = 0.0;
  };

  void add(const Trial& trial) { (trial.error < 0.0 ? low_ : high_) = trial; }
  /// Forgets all trials.
  void reset() { low_ = high_ = std::nullopt; }
  [[nodiscard]] bool is_valid() const { return low_ && high_ && low_->particle < high_->particle; }
  [[nodiscard]] bool is_within(double width) const { return is_valid() && high_->particle - low_->particle <= width; }
  [[nodiscard]] bool holds(double particle) const { return particle > low_->particle && particle < high_->particle; }
  [[nodiscard]] double middle() const { return std::midpoint(low_->particle, high_->particle); }
  /// The middle of a jump of the force. The force that balances the machine lies in the jump, too, but follows the
  /// machine's line: its derivatives would be those of the machine, and hold only within the jump.
  [[nodiscard]] double force() const { return std::midpoint(low_->force, high_->force); }

 private:
  std::optional<Trial> low_;
  std::optional<Trial> high_;
};

/// Makes the displacements of the particle rise and fall with x.
void keep_order(std::span<const double> x, std::vector<double>& particle) {
  for (std::size_t i = 1; i < x.size(); ++i) {
    if (x[i] >= x[i - 1]) particle[i] = std::max(particle[i], particle[i - 1]);
    if (x[i] <= x[i - 1]) particle[i] = std::min(particle[i], particle[i - 1]);
  }
}

/// Searches for the displacements of the particle at which the machine shows x. That is Dekker's method for all points
/// at once, since each run gives the forces at all of them: a secant step or, where these do not halve the error in
/// each run, the middle of the bracket. The force at a point depends on the turns before it, too: as long as these
/// move, trials of the point do not compare.
class SeriesSearch {
 public:
  SeriesSearch(const Machine& machine, std::span<const double> x, double tolerance)
      : machine_(machine),
        x_(x),
        tolerance_(tolerance),
        slopes_(x.size(), 1.0),
        brackets_(x.size()),
        errors_(x.size()),
        moves_before_(x.size(), k_infinity) {
    for (const double value : x) largest_ = std::max(largest_, std::abs(value));
  }

  /// Takes the forces of a trial, and puts those in a jump into its middle. @return true if all displacements are found
  bool take(std::span<const double> particle, std::span<double> forces) {
    find_moves(particle);
    bool is_done = true;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      errors_[i] = particle[i] + machine_.addition(forces[i]) - x_[i];
      if (moves_before_[i] > 0.0) brackets_[i].reset();
      brackets_[i].add({particle[i], errors_[i], forces[i]});
      is_done = is_done && (!is_off(i) || is_in_jump(i));
    }
    if (!is_done) return false;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      if (is_off(i)) forces[i] = brackets_[i].force();
    }
    return true;
  }

  void go_on(std::vector<double>& particle, std::span<const double> forces) {
    if (before_.empty()) {
      slopes_from_neighbours(particle, forces);
    } else {
      slopes_from_trials(particle);
    }
    before_ = particle;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      if (is_in_jump(i) || is_settled(i)) continue;
      const double secant = particle[i] - errors_[i] / slopes_[i];
      const bool is_halved = is_off(i) && brackets_[i].is_valid() && (!is_shrinking(i) || !brackets_[i].holds(secant));
      particle[i] = is_halved ? brackets_[i].middle() : secant;
    }
    errors_before_ = errors_;
    keep_order(x_, particle);
  }

 private:
  /// True if a point has been found, and improved once more. It then stays, so that points behind it settle as well.
  [[nodiscard]] bool is_settled(std::size_t i) const {
    return !errors_before_.empty() && !is_off(i) && std::abs(errors_before_[i]) <= tolerance_;
  }
  /// True if the last step has at least halved the error.
  [[nodiscard]] bool is_shrinking(std::size_t i) const {
    return !errors_before_.empty() && std::abs(errors_[i]) <= 0.5 * std::abs(errors_before_[i]);
  }
  [[nodiscard]] bool is_off(std::size_t i) const { return std::abs(errors_[i]) > tolerance_; }
  [[nodiscard]] bool is_in_jump(std::size_t i) const {
    return is_off(i) && !is_shrinking(i) && brackets_[i].is_within(tolerance_);
  }
  [[nodiscard]] bool is_long(double step) const { return std::abs(step) > k_least_step * largest_; }
  [[nodiscard]] bool is_turn(std::size_t i) const {
    return i > 0 && i + 1 < x_.size() && (x_[i] - x_[i - 1]) * (x_[i + 1] - x_[i]) < 0.0;
  }
  void set_slope(std::size_t i, double slope) {
    if (slope > 0.0) slopes_[i] = slope;
  }

  /// Finds by how much the turns before each point have moved since the last trial.
  void find_moves(std::span<const double> particle) {
    if (before_.empty()) return;
    double largest = 0.0;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      moves_before_[i] = largest;
      if (is_turn(i)) largest = std::max(largest, std::abs(particle[i] - before_[i]));
    }
  }

  void slopes_from_neighbours(std::span<const double> particle, std::span<const double> forces) {
    for (std::size_t i = 1; i < x_.size(); ++i) {
      const double step = particle[i] - particle[i - 1];
      if (is_long(step)) {
        set_slope(i, 1.0 + (machine_.addition(forces[i]) - machine_.addition(forces[i - 1])) / step);
      } else {
        slopes_[i] = slopes_[i - 1];
      }
    }
  }
  void slopes_from_trials(std::span<const double> particle) {
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const double step = particle[i] - before_[i];
      if (is_long(step) && std::abs(step) >= k_least_share * moves_before_[i]) {
        set_slope(i, (errors_[i] - errors_before_[i]) / step);
      }
    }
  }

  const Machine& machine_;
  std::span<const double> x_;
  double tolerance_;
  double largest_ = 0.0;
  std::vector<double> slopes_;
  std::vector<Bracket> brackets_;
  std::vector<double> errors_;        ///< of the displacements shown by the machine
  std::vector<double> moves_before_;  ///< largest last move of the turns before each point
  std::vector<double> before_, errors_before_;
};

}  // namespace

bool put_in_series(const Machine& machine, std::span<const double> x, const ForcesOf& forces_of, double tolerance,
                   std::vector<double>& particle, std::span<double> forces) {
  SeriesSearch search(machine, x, tolerance);
  keep_order(x, particle);
  for (int run = 0; run < k_most_runs; ++run) {
    if (!forces_of(particle, forces)) return false;
    if (search.take(particle, forces)) return true;
    search.go_on(particle, forces);
  }
  return false;
}

double Machine::addition(double force) const noexcept {
  double sum = offset + compliance * force;
  if (forces.size() < 2) return sum;
  const auto next = std::upper_bound(forces.begin() + 1, forces.end() - 1, force);
  const auto k = static_cast<std::size_t>(next - forces.begin());
  sum += std::lerp(deflections[k - 1], deflections[k], (force - forces[k - 1]) / (forces[k] - forces[k - 1]));
  return sum;
}

ParsedCompliance parse_compliance(std::string_view text) {
  const std::size_t slash = text.rfind('/');
  if (slash == std::string_view::npos) return {};
  const ParsedQuantity length = parse_quantity(text.substr(0, slash), Dimension::length, std::nullopt);
  const std::string force_unit(text.substr(slash + 1));
  const ParsedQuantity force = parse_quantity("1 " + force_unit, Dimension::force, std::nullopt);
  if (!length.value || !force.value) return {};
  const double length_factor = parse_quantity("1 " + length.unit, Dimension::length, std::nullopt).value.value_or(1.0);
  return {.value = *length.value / *force.value,
          .unit = fmt::format("{}/{}", length.unit, force.unit),
          .unit_factor = length_factor / *force.value};
}

}  // namespace monograin
