// Integration without an integrator: every asked instant is solved for, events are roots along that solution, and the
// work is a closed form or a Gauss-Legendre quadrature.

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "engine/event_locator.hpp"

namespace monograin {
namespace {

// The first piece where there are slaved unknowns, and how fast pieces grow from there.
constexpr double k_first = 1e-9;
constexpr double k_grading = 30.0;
constexpr std::size_t k_nodes = 12;
// Share of the last Legendre coefficients below which a quadrature has converged.
constexpr double k_tail = 1e-13;
// Share of the work that is round-off in it.
constexpr double k_quadrature_accuracy = 1e-16;
// Quadrature pieces are not refined below this; what is left is below round-off of the whole.
constexpr double k_smallest_quadrature = 1e-6;

/// Cumulative integral of a function known at the Gauss-Legendre nodes of an interval.
class LegendreIntegral {
 public:
  template <class Function>
  void sample(double begin, double end, Function&& function) {
    begin_ = begin;
    end_ = end;
    std::array<double, k_nodes> samples{};
    for (std::size_t j = 0; j < k_nodes; ++j) samples[j] = function(begin + 0.5 * (end - begin) * (1.0 + node(j)));
    coefficients_.fill(0.0);
    for (std::size_t j = 0; j < k_nodes; ++j) {
      double previous = 0.0;
      double legendre = 1.0;
      for (std::size_t k = 0; k < k_nodes; ++k) {
        coefficients_[k] += 0.5 * (2.0 * static_cast<double>(k) + 1.0) * weight(j) * samples[j] * legendre;
        next(k, node(j), previous, legendre);
      }
    }
  }

  /// @param negligible  error of the integral that does not count, however large a share of it that is
  [[nodiscard]] bool has_converged(double negligible) const noexcept {
    double largest = 0.0;
    for (const double c : coefficients_) largest = std::max(largest, std::abs(c));
    const double tail = std::abs(coefficients_[k_nodes - 1]) + std::abs(coefficients_[k_nodes - 2]);
    return tail <= k_tail * largest || tail * (end_ - begin_) <= negligible;
  }

  /// Integral from the interval's beginning to x.
  [[nodiscard]] double operator()(double x) const noexcept {
    const double t = std::clamp(2.0 * (x - begin_) / (end_ - begin_) - 1.0, -1.0, 1.0);
    double sum = coefficients_[0] * (t + 1.0);
    double previous = 1.0;  // P_(k-1)
    double legendre = t;    // P_k
    for (std::size_t k = 1; k < k_nodes; ++k) {
      const double before = previous;
      next(k, t, previous, legendre);
      sum += coefficients_[k] * (legendre - before) / (2.0 * static_cast<double>(k) + 1.0);
    }
    return 0.5 * (end_ - begin_) * sum;
  }

 private:
  using Rule = boost::math::quadrature::gauss<double, k_nodes>;
  static constexpr std::size_t k_half = k_nodes / 2;

  [[nodiscard]] static double node(std::size_t j) noexcept {
    return j < k_half ? -Rule::abscissa()[k_half - 1 - j] : Rule::abscissa()[j - k_half];
  }
  [[nodiscard]] static double weight(std::size_t j) noexcept {
    return Rule::weights()[j < k_half ? k_half - 1 - j : j - k_half];
  }
  /// From (P_(k-1), P_k) to (P_k, P_(k+1)).
  static void next(std::size_t k, double x, double& previous, double& legendre) noexcept {
    const auto n = static_cast<double>(k);
    const double after = ((2.0 * n + 1.0) * x * legendre - n * previous) / (n + 1.0);
    previous = legendre;
    legendre = after;
  }

  double begin_ = 0.0;
  double end_ = 1.0;
  std::array<double, k_nodes> coefficients_{};
};

class Direct final : public EventLocator {
 public:
  Direct(HybridSystem& system, Watch& watch) : EventLocator(system, watch) {
    const auto unknowns = system.unknowns();
    const auto found = std::ranges::find(unknowns, Unknown::Kind::quadrature, &Unknown::kind);
    if (found != unknowns.end()) quadrature_ = static_cast<std::size_t>(found - unknowns.begin());
    has_slaves_ = std::ranges::any_of(unknowns, &Unknown::is_slaved);
    trial_.resize(unknowns.size());
    rates_.resize(unknowns.size());
  }

  void begin(double xi, std::span<const double> y) override {
    segment_begin_ = xi;
    is_closed_ = !quadrature_;
    if (const auto primitive = system_.closed_quadrature(xi, y); quadrature_ && primitive) {
      is_closed_ = true;
      primitive_offset_ = y[*quadrature_] - *primitive;
    }
    begin_segment(xi, y);
  }

  Advance advance() override {
    ++statistics_.steps;
    begin_piece();
    double next = next_piece_end(begin_);
    // Slaved unknowns may start with a singularity, over which guards cross and come back within no time.
    if (has_slaves_) next = std::min(next, begin_ + std::max(k_first, k_grading * (begin_ - segment_begin_)));
    move_end(next);
    while (!finish_piece()) move_end(0.5 * (begin_ + end_));
    statistics_.last_step = end_ - begin_;
    return {.xi = end_, .hit_guard = !fired_.empty()};
  }

  void dense_output(double xi, std::span<double> y) override {
    if (xi == end_) {
      std::ranges::copy(end_state_, y.begin());
      return;
    }
    state_at(xi, y);
    if (!quadrature_) return;
    if (is_closed_)
      y[*quadrature_] = primitive_offset_ + *system_.closed_quadrature(xi, y);
    else
      y[*quadrature_] = begin_state_[*quadrature_] + integral_(xi);
  }

  [[nodiscard]] double guard_tolerance() const noexcept override { return 1e-13; }

 private:
  /// The line through the ends of the present piece is the first guess.
  void state_at(double xi, std::span<double> y) override {
    ++statistics_.rhs_evaluations;
    const double share = end_ > begin_ ? (xi - begin_) / (end_ - begin_) : 0.0;
    for (std::size_t k = 0; k < y.size(); ++k) y[k] = std::lerp(begin_state_[k], end_state_[k], share);
    system_.solve(xi, y);
  }

  void state_ahead(double xi, std::span<double> y) override { system_.solve(xi, y); }

  /// Where the equations end before xi, comes as near as it takes to get a solution.
  void move_end(double xi) override {
    for (;;) {
      end_ = xi;
      std::ranges::copy(begin_state_, end_state_.begin());
      try {
        ++statistics_.rhs_evaluations;
        system_.solve(xi, end_state_);
        look(xi, end_state_, end_values_);
        return;
      } catch (const std::domain_error&) {
        if (xi - begin_ < k_smallest) throw;
        xi = 0.5 * (begin_ + xi);
      }
    }
  }

  /// Locates the piece's event and integrates over it; false where the piece is too long for either.
  bool finish_piece() {
    try {
      locate_event();
      return integrate();
    } catch (const std::domain_error&) {
      // From a guess far off, Newton's method can leave the domain although there is a solution.
      if (end_ - begin_ < k_smallest) throw;
      return false;
    }
  }

  /// Integrates the quadrature over the piece; false where the piece is too long for it.
  bool integrate() {
    if (!quadrature_) return true;
    if (is_closed_) {
      end_state_[*quadrature_] = primitive_offset_ + *system_.closed_quadrature(end_, end_state_);
      return true;
    }
    integral_.sample(begin_, end_, [&](double xi) {
      state_at(xi, trial_);
      system_.rates(xi, trial_, rates_);
      return rates_[*quadrature_];
    });
    const double scale = std::max(std::abs(begin_state_[*quadrature_]), system_.unknowns()[*quadrature_].scale);
    if (!integral_.has_converged(k_quadrature_accuracy * scale) && end_ - begin_ > k_smallest_quadrature) return false;
    end_state_[*quadrature_] = begin_state_[*quadrature_] + integral_(end_);
    return true;
  }

  std::optional<std::size_t> quadrature_;
  bool is_closed_ = false;
  double primitive_offset_ = 0.0;
  LegendreIntegral integral_;
  bool has_slaves_ = false;
  double segment_begin_ = 0.0;
  std::vector<double> trial_, rates_;
};

}  // namespace

std::unique_ptr<Integrator> make_direct(HybridSystem& system, Watch& watch) {
  return std::make_unique<Direct>(system, watch);
}

}  // namespace monograin
