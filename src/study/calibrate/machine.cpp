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
constexpr int k_secant_runs = 10;      // after these runs brackets are halved, because secants may jump back and forth
                                       // about a jump
constexpr double k_least_slope = 0.1;  // of the shown displacement over the particle's; 1 for a rigid machine
constexpr double k_least_step = 1e3 * k_epsilon;  // of a secant, over the largest x

/// The last trials of one displacement that showed too little and too much.
class Bracket {
 public:
  struct Trial {
    double particle = 0.0;
    double error = 0.0;  ///< of the displacement shown by the machine
    double force = 0.0;
  };

  void add(const Trial& trial) { (trial.error < 0.0 ? low_ : high_) = trial; }
  [[nodiscard]] bool is_valid() const { return low_ && high_ && low_->particle < high_->particle; }
  [[nodiscard]] bool is_within(double width) const { return is_valid() && high_->particle - low_->particle <= width; }
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

/// Searches for the displacements of the particle at which the machine shows x: by secants, then between brackets.
class SeriesSearch {
 public:
  SeriesSearch(const Machine& machine, std::span<const double> x, double tolerance)
      : machine_(machine),
        x_(x),
        tolerance_(tolerance),
        slopes_(x.size(), 1.0),
        brackets_(x.size()),
        errors_(x.size()) {
    for (const double value : x) largest_ = std::max(largest_, std::abs(value));
  }

  /// Takes the forces of a trial, and puts those in a jump into its middle. @return true if all displacements are found
  bool take(std::span<const double> particle, std::span<double> forces, bool has_brackets) {
    bool is_done = true;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      errors_[i] = particle[i] + machine_.addition(forces[i]) - x_[i];
      brackets_[i].add({particle[i], errors_[i], forces[i]});
      is_done = is_done && (!is_off(i) || (has_brackets && brackets_[i].is_within(tolerance_)));
    }
    if (!is_done) return false;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      if (is_off(i)) forces[i] = brackets_[i].force();
    }
    return true;
  }

  void go_on(std::vector<double>& particle, std::span<const double> forces, bool has_brackets) {
    if (before_.empty()) {
      slopes_from_neighbours(particle, forces);
    } else {
      slopes_from_trials(particle);
    }
    before_ = particle;
    errors_before_ = errors_;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const bool is_halved = has_brackets && is_off(i) && brackets_[i].is_valid();
      particle[i] = is_halved ? brackets_[i].middle() : particle[i] - errors_[i] / slopes_[i];
    }
    keep_order(x_, particle);
  }

 private:
  [[nodiscard]] bool is_off(std::size_t i) const { return std::abs(errors_[i]) > tolerance_; }
  [[nodiscard]] bool is_long(double step) const { return std::abs(step) > k_least_step * largest_; }
  void set_slope(std::size_t i, double slope) {
    if (slope >= k_least_slope) slopes_[i] = slope;
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
      if (is_long(step)) set_slope(i, (errors_[i] - errors_before_[i]) / step);
    }
  }

  const Machine& machine_;
  std::span<const double> x_;
  double tolerance_;
  double largest_ = 0.0;
  std::vector<double> slopes_;
  std::vector<Bracket> brackets_;
  std::vector<double> errors_;  ///< of the displacements shown by the machine
  std::vector<double> before_, errors_before_;
};

}  // namespace

bool put_in_series(const Machine& machine, std::span<const double> x, const ForcesOf& forces_of, double tolerance,
                   std::vector<double>& particle, std::span<double> forces) {
  SeriesSearch search(machine, x, tolerance);
  keep_order(x, particle);
  for (int run = 0; run < k_most_runs; ++run) {
    if (!forces_of(particle, forces)) return false;
    const bool has_brackets = run >= k_secant_runs;
    if (search.take(particle, forces, has_brackets)) return true;
    search.go_on(particle, forces, has_brackets);
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
