// Integration without an integrator: every asked instant is solved for, events are roots along that solution, and the
// work is a closed form or a Gauss-Legendre quadrature.

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "engine/integrator.hpp"

namespace monograin {
namespace {

// Pieces of a step in which guards are looked at; events do not depend on it as long as guards cross once per piece.
constexpr double k_pieces = 32.0;
// The first piece where there are slaved unknowns, and how fast pieces grow from there.
constexpr double k_first = 1e-9;
constexpr double k_grading = 30.0;
// A piece is not made smaller than this, in step coordinates.
constexpr double k_smallest = 1e-13;
// Shorter pieces are not searched for guards that cross twice.
constexpr double k_smallest_hidden = 1e-6;
// An extremum this near to zero, over the guard in the middle of the piece, is looked at.
constexpr double k_near = 0.5;
// How far ahead the side of a guard that begins at zero is read.
constexpr double k_ahead = 1e-9;
constexpr std::size_t k_nodes = 12;
// Share of the last Legendre coefficients below which a quadrature has converged.
constexpr double k_tail = 1e-13;
// Share of the work that is round-off in it.
constexpr double k_round_off = 1e-16;
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

class Direct final : public Integrator {
 public:
  Direct(HybridSystem& system, Watch& watch) : system_(system), watch_(watch) {
    const auto unknowns = system.unknowns();
    size_ = unknowns.size();
    const auto found = std::ranges::find(unknowns, Unknown::Kind::quadrature, &Unknown::kind);
    if (found != unknowns.end()) quadrature_ = static_cast<std::size_t>(found - unknowns.begin());
    has_slaves_ = std::ranges::any_of(unknowns, &Unknown::is_slaved);
    for (auto* vector : {&begin_state_, &end_state_, &trial_, &rates_}) vector->resize(size_);
  }

  void begin(double xi, std::span<const double> y) override {
    ++statistics_.segments;
    segment_begin_ = begin_ = end_ = xi;
    std::ranges::copy(y, end_state_.begin());
    values_.resize(watch_.size());
    middle_values_.resize(watch_.size());
    begin_values_.resize(watch_.size());
    end_values_.resize(watch_.size());
    look(end_, end_state_, end_values_);
    read_sides();
    is_closed_ = !quadrature_;
    if (const auto primitive = system_.closed_quadrature(xi, y); quadrature_ && primitive) {
      is_closed_ = true;
      primitive_offset_ = y[*quadrature_] - *primitive;
    }
  }

  Advance advance() override {
    ++statistics_.steps;
    begin_ = end_;
    std::swap(begin_state_, end_state_);
    std::swap(begin_values_, end_values_);
    fired_.clear();
    double next = std::min(1.0, (std::floor(begin_ * k_pieces + 1e-9) + 1.0) / k_pieces);
    // Slaved unknowns may start with a singularity, over which guards cross and come back within no time.
    if (has_slaves_) next = std::min(next, begin_ + std::max(k_first, k_grading * (begin_ - segment_begin_)));
    reach(next);
    while (!finish_piece()) reach(0.5 * (begin_ + end_));
    statistics_.last_step = end_ - begin_;
    return {.xi = end_, .hit_guard = !fired_.empty()};
  }

  [[nodiscard]] std::span<const std::size_t> fired() const noexcept override { return fired_; }

  void dense_output(double xi, std::span<double> y) override {
    if (xi == end_) {
      std::ranges::copy(end_state_, y.begin());
      return;
    }
    solve(xi, y);
    if (!quadrature_) return;
    if (is_closed_)
      y[*quadrature_] = primitive_offset_ + *system_.closed_quadrature(xi, y);
    else
      y[*quadrature_] = begin_state_[*quadrature_] + integral_(xi);
  }

  [[nodiscard]] double guard_tolerance() const noexcept override { return 1e-13; }

  [[nodiscard]] Statistics statistics() const override { return statistics_; }

 private:
  void look(double xi, std::span<const double> y, std::span<double> values) {
    ++statistics_.guard_evaluations;
    watch_.values(xi, y, values);
  }

  /// A guard that is zero, or just past it, where the segment begins (first touch) is on the side to which it leaves.
  void read_sides() {
    const auto is_open = [this](std::size_t g) {
      return std::abs(end_values_[g]) <= guard_tolerance() && watch_.directions()[g] * end_values_[g] >= 0.0;
    };
    bool any = false;
    for (std::size_t g = 0; g < end_values_.size(); ++g) any = any || is_open(g);
    if (!any) return;
    const double ahead = end_ + std::min(k_ahead, 0.5 * (1.0 - end_));
    std::ranges::copy(end_state_, trial_.begin());
    try {
      system_.solve(ahead, trial_);
      look(ahead, trial_, values_);
    } catch (const std::domain_error&) {
      return;  // no solution ahead: the first piece will find out how far there is one
    }
    for (std::size_t g = 0; g < end_values_.size(); ++g) {
      if (is_open(g)) end_values_[g] = values_[g];
    }
  }

  /// State at xi; the line through the ends of the present piece is the first guess.
  void solve(double xi, std::span<double> y) {
    ++statistics_.rhs_evaluations;
    const double share = end_ > begin_ ? (xi - begin_) / (end_ - begin_) : 0.0;
    for (std::size_t k = 0; k < size_; ++k) y[k] = std::lerp(begin_state_[k], end_state_[k], share);
    system_.solve(xi, y);
  }

  /// Solves for the end of the piece; where the equations end before it, comes as near as it takes to get a solution.
  void reach(double xi) {
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

  [[nodiscard]] static bool crosses(int direction, double before, double after) noexcept {
    if (direction > 0) return before < 0.0 && after >= 0.0;
    if (direction < 0) return before > 0.0 && after <= 0.0;
    return (before < 0.0 && after >= 0.0) || (before > 0.0 && after <= 0.0);
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

  /// Moves the end of the piece to the first root in it, if there is one.
  void locate_event() {
    fired_.clear();
    for (;;) {
      const auto directions = watch_.directions();
      std::size_t first = directions.size();
      double root = end_;
      for (std::size_t g = 0; g < directions.size(); ++g) {
        if (!crosses(directions[g], begin_values_[g], end_values_[g])) continue;
        const double found = polish(g);
        if (first == directions.size() || found < root) {
          first = g;
          root = found;
        }
      }
      if (first == directions.size()) {
        if (!shorten_to_hidden_crossing()) return;
        continue;
      }
      const bool is_shorter = root < end_ - k_smallest;
      if (root < end_) reach(root);
      // An earlier root that this piece's ends did not show is looked for again in the shorter piece.
      std::vector<std::size_t> all;
      bool has_earlier = false;
      for (std::size_t g = 0; g < directions.size(); ++g) {
        if (g == first) {
          all.push_back(g);
        } else if (crosses(directions[g], begin_values_[g], end_values_[g])) {
          if (!is_shorter || std::abs(end_values_[g]) <= guard_tolerance())
            all.push_back(g);
          else
            has_earlier = true;
        }
      }
      if (!has_earlier && !shorten_to_hidden_crossing()) {
        fired_ = std::move(all);
        return;
      }
    }
  }

  /// A guard that is on the same side at both ends of the piece may have crossed and come back in between. Looks at the
  /// middle, and from there at the extremum of the parabola through the three; where a guard is past, ends the piece.
  bool shorten_to_hidden_crossing() {
    if (end_ - begin_ < k_smallest_hidden || watch_.size() == 0) return false;
    const double middle = std::midpoint(begin_, end_);
    solve(middle, trial_);
    look(middle, trial_, middle_values_);
    const auto directions = watch_.directions();
    double extremum = end_;
    for (std::size_t g = 0; g < directions.size(); ++g) {
      const double before = begin_values_[g];
      const double sign = before < 0.0 ? 1.0 : -1.0;  // towards zero
      if (before == 0.0 || (directions[g] != 0 && directions[g] != static_cast<int>(sign))) continue;
      if (crosses(directions[g], before, middle_values_[g])) {
        reach(middle);
        return true;
      }
      const double slope = end_values_[g] - before;
      const double curvature = 2.0 * (before + end_values_[g] - 2.0 * middle_values_[g]);
      if (!(sign * curvature < 0.0)) continue;
      const double place = 0.5 - 0.5 * slope / curvature;  // share of the piece
      const double height = before + place * (slope - curvature * (1.0 - place));
      if (place <= 0.0 || place >= 1.0 || sign * height < -k_near * std::abs(middle_values_[g])) continue;
      extremum = std::min(extremum, std::lerp(begin_, end_, place));
    }
    if (extremum == end_) return false;
    solve(extremum, trial_);
    look(extremum, trial_, middle_values_);
    for (std::size_t g = 0; g < directions.size(); ++g) {
      if (!crosses(directions[g], begin_values_[g], middle_values_[g])) continue;
      reach(extremum);
      return true;
    }
    return false;
  }

  /// Root of one guard in the piece.
  [[nodiscard]] double polish(std::size_t guard) {
    if (end_values_[guard] == 0.0) return end_;
    std::uintmax_t iterations = 100;
    const auto function = [&](double xi) {
      solve(xi, trial_);
      look(xi, trial_, values_);
      return values_[guard];
    };
    const auto [below, above] = boost::math::tools::toms748_solve(
        function, begin_, end_, begin_values_[guard], end_values_[guard],
        [](double a, double b) { return b - a <= 1e-15 * std::max(1e-3, std::abs(b)); }, iterations);
    return above;  // on or just past the boundary, so that the event lies behind and not ahead
  }

  /// Integrates the quadrature over the piece; false where the piece is too long for it.
  bool integrate() {
    if (!quadrature_) return true;
    if (is_closed_) {
      end_state_[*quadrature_] = primitive_offset_ + *system_.closed_quadrature(end_, end_state_);
      return true;
    }
    integral_.sample(begin_, end_, [&](double xi) {
      solve(xi, trial_);
      system_.rates(xi, trial_, rates_);
      return rates_[*quadrature_];
    });
    const double scale = std::max(std::abs(begin_state_[*quadrature_]), system_.unknowns()[*quadrature_].scale);
    if (!integral_.has_converged(k_round_off * scale) && end_ - begin_ > k_smallest_quadrature) return false;
    end_state_[*quadrature_] = begin_state_[*quadrature_] + integral_(end_);
    return true;
  }

  HybridSystem& system_;
  Watch& watch_;
  std::size_t size_ = 0;
  std::optional<std::size_t> quadrature_;
  bool is_closed_ = false;
  double primitive_offset_ = 0.0;
  LegendreIntegral integral_;
  bool has_slaves_ = false;
  double segment_begin_ = 0.0;
  double begin_ = 0.0;
  double end_ = 0.0;
  std::vector<double> begin_state_, end_state_, trial_, rates_;
  std::vector<double> begin_values_, end_values_, middle_values_, values_;
  std::vector<std::size_t> fired_;
  Statistics statistics_;
};

}  // namespace

std::unique_ptr<Integrator> make_direct(HybridSystem& system, Watch& watch) {
  return std::make_unique<Direct>(system, watch);
}

}  // namespace monograin
