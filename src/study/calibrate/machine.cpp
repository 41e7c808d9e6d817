#include "study/calibrate/machine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "scenario/units.hpp"

namespace monograin {
namespace {

constexpr int k_most_runs = 80;
constexpr int k_secant_runs = 10;      // from here on brackets are halved, where secants go back and forth about a jump
constexpr double k_least_slope = 0.1;  // of the shown displacement over that of the particle: 1 for a rigid machine
constexpr double k_least_step = 1e3 * std::numeric_limits<double>::epsilon();  // of a secant, over the largest x

/// The last trials of one displacement that were too small and too large.
class Bracket {
 public:
  struct Trial {
    double particle = 0.0;
    double error = 0.0;  ///< of the displacement shown
    double force = 0.0;
  };

  void add(const Trial& trial) { (trial.error < 0.0 ? low_ : high_) = trial; }
  [[nodiscard]] bool is_valid() const { return low_ && high_ && low_->particle < high_->particle; }
  [[nodiscard]] bool is_within(double width) const { return is_valid() && high_->particle - low_->particle <= width; }
  [[nodiscard]] double middle() const { return std::midpoint(low_->particle, high_->particle); }
  /// The middle of a jump of the force. What balances the machine lies in the jump, too, but follows the machine's
  /// line: its derivatives would be those of the machine, and hold only within the jump.
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

}  // namespace

bool put_in_series(const Machine& machine, std::span<const double> x, const ForcesOf& forces_of, double tolerance,
                   std::vector<double>& particle, std::span<double> forces) {
  const std::size_t n = x.size();
  double largest = 0.0;
  for (const double value : x) largest = std::max(largest, std::abs(value));
  std::vector<double> slopes(n, 1.0);
  std::vector<Bracket> brackets(n);
  std::vector<double> before;
  std::vector<double> errors_before;
  std::vector<double> errors(n);  // of the displacements shown
  keep_order(x, particle);
  for (int run = 0; run < k_most_runs; ++run) {
    if (!forces_of(particle, forces)) return false;
    const bool has_brackets = run >= k_secant_runs;
    bool is_done = true;
    for (std::size_t i = 0; i < n; ++i) {
      errors[i] = particle[i] + machine.addition(forces[i]) - x[i];
      brackets[i].add({particle[i], errors[i], forces[i]});
      is_done = is_done && (std::abs(errors[i]) <= tolerance || (has_brackets && brackets[i].is_within(tolerance)));
    }
    if (is_done) {
      for (std::size_t i = 0; i < n; ++i) {
        if (std::abs(errors[i]) > tolerance) forces[i] = brackets[i].force();
      }
      return true;
    }
    for (std::size_t i = 0; i < n; ++i) {
      // Neighbours give the first slopes, the last two runs those that follow.
      const bool is_first = before.empty();
      const double step = is_first ? (i > 0 ? particle[i] - particle[i - 1] : 0.0) : particle[i] - before[i];
      if (std::abs(step) <= k_least_step * largest) {
        if (is_first && i > 0) slopes[i] = slopes[i - 1];
        continue;
      }
      const double slope = is_first ? 1.0 + (machine.addition(forces[i]) - machine.addition(forces[i - 1])) / step
                                    : (errors[i] - errors_before[i]) / step;
      if (slope >= k_least_slope) slopes[i] = slope;
    }
    before = particle;
    errors_before = errors;
    for (std::size_t i = 0; i < n; ++i) {
      const bool is_halved = has_brackets && std::abs(errors[i]) > tolerance && brackets[i].is_valid();
      particle[i] = is_halved ? brackets[i].middle() : particle[i] - errors[i] / slopes[i];
    }
    keep_order(x, particle);
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
