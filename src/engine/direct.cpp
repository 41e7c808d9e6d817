// Integration without an integrator: the state at every requested instant is solved for, events are roots along that
// solution, and the work is a closed form or a Gauss-Legendre quadrature.

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "engine/event_locator.hpp"
#include "engine/rate_round_off.hpp"
#include "numerics/legendre_series.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

// A remainder of the leg up to this share of a piece is merged into the piece.
constexpr double k_mergeable = 0.25;
// Largest and smallest ratio of a piece's length to the length before, and the safety factor on the predicted length.
constexpr double k_most_growth = 2.0;
constexpr double k_most_shrinkage = 0.2;
constexpr double k_safety = 0.85;
// Growth of the planned length of pieces that end at kinks.
constexpr double k_growth_at_kinks = 1.1;
// Tolerance of a piece's series of the work, over rtol. Next to a singularity of the work, as at a first touch, the
// error is up to a hundred times that.
constexpr double k_share_of_work = 1e-3;
// A leg of at least so many rows takes their work from series, if its closed form is costly.
constexpr std::size_t k_many_rows = 50;

class Direct final : public EventLocator {
 public:
  Direct(Equations& system, double rtol, GuardSet& guard_set, std::size_t rows)
      : EventLocator(system, guard_set, k_most_nodes),
        has_many_rows_(rows >= k_many_rows),
        work_accuracy_(k_share_of_work * rtol) {
    const auto unknowns = system.unknowns();
    const auto found = std::ranges::find(unknowns, Unknown::Kind::quadrature, &Unknown::kind);
    if (found != unknowns.end() && system.has_energies())
      quadrature_ = static_cast<std::size_t>(found - unknowns.begin());
    has_dependent_unknowns_ = system.has_dependent_unknowns();
    may_be_undetermined_ = std::ranges::any_of(unknowns, &Unknown::may_be_undetermined);
    trial_.resize(unknowns.size());
    branch_reach_.resize(unknowns.size());
    rates_.resize(unknowns.size());
    begin_rates_.resize(unknowns.size());
    integrated_ = static_cast<std::size_t>(std::ranges::count_if(
        unknowns, [](const Unknown& unknown) { return unknown.kind != Unknown::Kind::algebraic; }));
    changes_.resize(unknowns.size());
    slopes_.resize(integrated_);
    series_.resize(unknowns.size());
  }

  void begin(double xi, std::span<const double> y) override {
    segment_begin_ = xi;
    round_off_ = {};
    is_closed_ = !quadrature_;
    has_panels_ = false;
    if (const auto primitive = system_.closed_quadrature(xi, y); quadrature_ && primitive) {
      is_closed_ = true;
      has_panels_ = has_many_rows_ && system_.is_quadrature_costly();
      primitive_offset_ = y[*quadrature_] - *primitive;
    }
    nodes_ = is_closed_ ? &LegendreNodes::few() : &LegendreNodes::many();
    length_ = longest();
    begin_segment(xi, y);
  }

  Advance advance() override {
    ++statistics_.steps;
    begin_piece();
    system_.branch_reach(begin_state_, branch_reach_);
    has_branches_ = std::ranges::any_of(branch_reach_, [](double reach) { return std::isfinite(reach); });
    if (!is_closed_) system_.rates(begin_, begin_state_, begin_rates_);
    Attempt attempt{.is_covered = false};
    for (double mergeable = k_mergeable; !attempt.is_covered; mergeable = 0.0) {
      piece_end_ = 1.0 - begin_ <= (1.0 + mergeable) * length_ ? 1.0 : begin_ + length_;
      const double planned_length = length_;
      double tried_length = piece_length();
      bool ends_at_kink = false;
      try {
        ends_at_kink = end_at_kink(mergeable);
        tried_length = piece_length();
        attempt = cover_piece();
      } catch (const std::domain_error&) {
        // The equations end within the piece, or Newton's method left their domain although there is a solution.
        if (tried_length < least_progress(begin_)) throw;
        attempt = too_long(0.5);
      }
      length_ = attempt.factor * tried_length;
      // The length grows beyond the distances of kinks, to find out whether they are weak.
      if (attempt.is_covered && ends_at_kink) length_ = std::max(length_, k_growth_at_kinks * planned_length);
      length_ = std::min(longest(), length_);
    }
    statistics_.last_step = end_ - begin_;
    if (has_panels_) begin_panels();
    return {.xi = end_, .hit_guard = !fired_.empty()};
  }

  void dense_output(double xi, std::span<double> y) override {
    if (xi == end_ || xi == begin_) {
      std::ranges::copy(xi == end_ ? end_state_ : begin_state_, y.begin());
      return;
    }
    state_at(xi, y);
    if (quadrature_) y[*quadrature_] = has_panels_ ? panel_work_at(xi, y) : work_at(xi, y);
  }

  [[nodiscard]] double guard_tolerance() const noexcept override { return k_zero_guard; }

 private:
  /// Result of an attempt to cover a piece.
  struct Attempt {
    bool is_covered = true;         ///< false: the piece is too long
    double factor = k_most_growth;  ///< length of the next piece, or of the next attempt, over that of this one
  };
  [[nodiscard]] static Attempt too_long(double factor) noexcept { return {.is_covered = false, .factor = factor}; }

  /// A part of a piece in which one series gives the work of the rows. work_rate_ is that series; with a closed form it
  /// has no other use.
  struct Panel {
    double begin = 0.0, end = 0.0;
    double work = 0.0;         ///< where the panel begins
    double next_length = 0.0;  ///< of the panel that follows
    bool is_resolved = false;  ///< the series is accurate

    [[nodiscard]] double length() const noexcept { return end - begin; }
    /// Position of xi in the panel, from -1 at its beginning to 1 at its end.
    [[nodiscard]] double position(double xi) const noexcept { return 2.0 * (xi - begin) / length() - 1.0; }
    /// Integral up to a position.
    [[nodiscard]] double integral(const LegendreSeries& rate, double at) const noexcept {
      return 0.5 * length() * rate.integral(at);
    }
  };

  /// Position of xi in the piece, from -1 at its beginning to 1 at its end.
  [[nodiscard]] double position(double xi) const noexcept { return 2.0 * (xi - begin_) / piece_length() - 1.0; }

  /// Solves for the state at xi, starting from the series through the nodes of the piece. Unknowns that no equation may
  /// determine depend on the path so far, which no series represents: the solver then starts from the last node before
  /// xi. Dependent unknowns are too steep to start from a node.
  void state_at(double xi, std::span<double> y) override {
    ++statistics_.rhs_evaluations;
    const double t = position(xi);
    if (starts_from_nodes() && !has_dependent_unknowns_) {
      std::size_t passed = 0;
      while (passed < nodes_->count && nodes_->places[passed] <= t) ++passed;
      for (std::size_t k = 0; k < y.size(); ++k) y[k] = begin_state_[k] + (passed > 0 ? changes_[k][passed - 1] : 0.0);
    } else {
      for (std::size_t k = 0; k < y.size(); ++k) y[k] = begin_state_[k] + series_[k].value(t);
    }
    system_.solve(xi, y);
  }

  [[nodiscard]] bool starts_from_nodes() const noexcept { return may_be_undetermined_ && is_closed_; }

  void state_ahead(double xi, std::span<double> y) override { system_.solve(xi, y); }

  void move_end(double xi) override {
    end_ = xi;
    state_at(xi, end_state_);
    evaluate_guards(xi, end_state_, end_values_);
  }

  void solve_at_node(std::size_t j) {
    guess_ahead(j);
    ++statistics_.rhs_evaluations;
    system_.solve(node(j), trial_);
    for (std::size_t k = 0; k < trial_.size(); ++k) changes_[k][j] = trial_[k] - begin_state_[k];
  }

  /// Ends the piece at the first kink in it, or up to a share `mergeable` beyond it: the series of the work then see
  /// smooth rates. Kinks that lie close together for the length of the piece are taken to be weak. If they are not,
  /// pieces are refused until they are as short as the distances between the kinks.
  /// @return true if the piece ends at a kink
  bool end_at_kink(double mergeable) {
    // The last piece ended at kinks that are nearer than this share of the piece to its beginning.
    constexpr double k_passed = 1e-3;
    constexpr double k_close = 0.25;  // share of the piece up to which kinks lie close together
    if (is_closed_) return false;
    const double limit = std::min(1.0, begin_ + (1.0 + mergeable) * piece_length());
    const double kink = system_.next_kink(begin_ + k_passed * piece_length(), begin_, begin_state_);
    if (kink - begin_ < k_close * piece_length() || kink >= limit) return false;
    // The system has predicted the kink from the rates at the beginning. It corrects the prediction by those there.
    piece_end_ = kink;
    for (std::size_t k = 0; k < trial_.size(); ++k)
      trial_[k] = begin_state_[k] + (k < integrated_ ? begin_rates_[k] * piece_length() : 0.0);
    ++statistics_.rhs_evaluations;
    system_.solve(kink, trial_);
    piece_end_ = std::min(system_.next_kink(std::midpoint(begin_, kink), kink, trial_), limit);
    return true;
  }

  /// Solves for the state at the nodes of the piece, locates its event and integrates the work over it.
  Attempt cover_piece() {
    // An event before this share of the piece has nodes beyond it.
    constexpr double k_inside = 0.99;
    forget_samples();
    if (begin_ == segment_begin_) sample_early();
    if (!solve_nodes()) return too_long(0.5);
    fit_changes();
    Attempt attempt = is_closed_ ? Attempt{} : judge_series();
    if (!attempt.is_covered) return attempt;
    move_end(piece_end_);
    locate_event();
    if (has_jumped()) return too_long(k_most_shrinkage);
    if (has_branches_) {
      if (!is_resolved()) return too_long(std::min(0.5, factor_just_beyond_event()));
      attempt.factor = std::min(attempt.factor, std::max(k_safety / share_of_reach(end_state_), k_most_shrinkage));
    }
    const bool has_nodes_beyond = end_ - begin_ < k_inside * piece_length();
    if (!is_closed_ && has_nodes_beyond && !holds_up_to_end()) return too_long(factor_just_beyond_event());
    if (quadrature_) end_state_[*quadrature_] = work_at(end_, end_state_);
    return attempt;
  }

  /// Solves for the states at the nodes, and evaluates the rates there if the work needs them.
  /// @return false if a state is so far from the beginning that it may lie on another branch of solutions
  bool solve_nodes() {
    for (std::size_t j = 0; j < nodes_->count; ++j) {
      const double xi = node(j);
      solve_at_node(j);
      if (piece_length() > k_shortest_sampled && !guard_set_.is_monotone()) sample_inside(xi, trial_);
      if (has_branches_ && piece_length() > least_progress(begin_) && share_of_reach(trial_) > 1.0) return false;
      if (is_closed_) continue;
      system_.rates(xi, trial_, rates_);
      for (std::size_t k = 0; k < integrated_; ++k) slopes_[k][j] = rates_[k];
    }
    return true;
  }

  /// Fits the series of the work's rate, and judges whether its last terms are below the tolerance.
  Attempt judge_series() {
    // The quadrature does not refine pieces shorter than this (step coordinates): their error is below the round-off of
    // the whole work.
    constexpr double k_smallest_quadrature = 1e-6;
    work_rate_.fit(*nodes_, slopes_[*quadrature_]);
    const double length = piece_length();
    const double ratio = length_ratio(begin_state_[*quadrature_], length, work_accuracy_, round_off_.known());
    const bool is_refused = ratio < 1.0 && length > k_smallest_quadrature;
    round_off_.report(work_rate_, begin_, length, is_refused);
    return {.is_covered = !is_refused, .factor = std::clamp(k_safety * ratio, k_most_shrinkage, k_most_growth)};
  }

  /// Factor of the piece's length with which it ends just beyond its event.
  [[nodiscard]] double factor_just_beyond_event() const noexcept {
    constexpr double k_just_beyond = 1.001;
    return k_just_beyond * (end_ - begin_) / piece_length();
  }

  /// How many times as long the interval of work_rate_, the series of the work's rate, could be.
  /// @param work      work where the interval begins
  /// @param length    of the interval, in step coordinates
  /// @param accuracy  tolerated error, over the work
  /// @param round_off  known round-off of the rates
  [[nodiscard]] double length_ratio(double work, double length, double accuracy, double round_off = 0.0) const {
    // Last terms of a series of rates, times the length, up to this share of the work count as round-off: the rates are
    // then next to nothing beside the work.
    constexpr double k_nothing = 1e-12;
    const double scale = std::max(std::abs(work), system_.unknowns()[*quadrature_].scale);
    // The tolerance itself must not count as round-off: terms next to a kink fall slowly, and the sum of those left out
    // exceeds the last ones kept.
    const double least = k_nothing * scale / length;
    return work_rate_.reach(2.0 * accuracy * scale / length, std::max(round_off, least));
  }

  /// True if the states of the piece lie on another branch than its beginning: an event there comes with a jump of the
  /// state. Next to a fold, the solver may find the other branch at the first node of a long piece; shorter pieces
  /// avoid this.
  [[nodiscard]] bool has_jumped() const noexcept {
    constexpr double k_jumped = 1e-8;  // change of an unknown within round-off of xi, over its scale, that is a jump
    constexpr double k_tiny = 1e-10;   // pieces up to this length (step coordinates) may be round-off
    if (fired_.empty() || end_ - begin_ > least_progress(begin_) || piece_length() <= k_tiny) return false;
    for (std::size_t k = 0; k < end_state_.size(); ++k) {
      if (std::abs(end_state_[k] - begin_state_[k]) > k_jumped * system_.unknowns()[k].scale) return true;
    }
    return false;
  }

  /// Greatest length of a piece. Guards are evaluated at its nodes; if all are monotone and nothing is integrated, a
  /// piece may be the whole leg.
  [[nodiscard]] double longest() const noexcept {
    constexpr double k_longest_per_node = 1.0 / 24.0;
    return is_closed_ && guard_set_.is_monotone() ? 1.0 : k_longest_per_node * static_cast<double>(nodes_->count);
  }
  [[nodiscard]] double piece_length() const noexcept { return piece_end_ - begin_; }

  /// Largest change of an unknown since the beginning of the piece, over its branch_reach(); 0 if there is one branch
  /// of solutions only.
  [[nodiscard]] double share_of_reach(std::span<const double> y) const noexcept {
    double share = 0.0;
    for (std::size_t k = 0; k < y.size(); ++k) {
      share = std::max(share, std::abs(y[k] - begin_state_[k]) / branch_reach_[k]);
    }
    return share;
  }

  /// True if the states up to the end of the piece lie on one branch of solutions: the series through them converge.
  [[nodiscard]] bool is_resolved() const {
    // Largest last terms of a series, over its largest term, that show a single branch. The passage from one branch to
    // another is a jump or behaves like a square root, and its series converges more slowly. Smaller last terms, over
    // the unknown's scale, are round-off and pass.
    constexpr double k_unresolved = 1e-2;
    constexpr double k_round_off_of_branch = 1e-8;
    if (end_ - begin_ <= least_progress(begin_)) return true;
    for (std::size_t k = 0; k < series_.size(); ++k) {
      if (series_[k].rest(k_round_off_of_branch * system_.unknowns()[k].scale) > k_unresolved) return false;
    }
    return true;
  }

  [[nodiscard]] double node(std::size_t j) const noexcept {
    return begin_ + 0.5 * piece_length() * (1.0 + nodes_->places[j]);
  }

  void fit_changes() {
    for (std::size_t k = 0; k < series_.size(); ++k) {
      if (k != quadrature_) series_[k].fit(*nodes_, changes_[k]);
    }
  }

  /// Evaluates the guards between the beginning of the segment and its first node, if one of them begins near zero. A
  /// step may begin with a singularity, as at first touch, in which one guard is smooth and another is not. A segment
  /// that begins soon after is as near to the singularity.
  void sample_early() {
    // A guard that begins nearer to zero than this, but is not zero to within round-off, may cross and return before
    // the first node. Dependent unknowns may start with an infinite slope: guards then count as near from farther away.
    constexpr double k_near_zero = 1e-3;
    constexpr double k_near_zero_if_steep = 0.1;
    constexpr double k_grading = 30.0;  // ratio of successive distances from the beginning
    const double near = has_dependent_unknowns_ ? k_near_zero_if_steep : k_near_zero;
    const auto is_near = [near](double value) { return std::abs(value) > k_zero_guard && std::abs(value) < near; };
    if (std::ranges::none_of(begin_values_, is_near)) return;
    const double first_node = 0.5 * piece_length() * (1.0 + nodes_->places[0]);
    try {
      for (double distance = std::max(k_ahead, begin_); k_grading * distance <= first_node; distance *= k_grading) {
        std::ranges::copy(begin_state_, trial_.begin());
        ++statistics_.rhs_evaluations;
        system_.solve(begin_ + distance, trial_);
        sample_inside(begin_ + distance, trial_);
      }
    } catch (const std::domain_error&) {
      return;  // solving at the nodes finds out how far solutions exist
    }
  }

  /// Predicts the state at node j by extrapolating from the beginning of the piece and the nodes already solved. Going
  /// node by node keeps the guess close to the solution; a distant guess could converge to another one. Algebraic
  /// unknowns may be singular, and polynomials overshoot there: dependent ones are extrapolated along a line, the
  /// others keep the value of the last node. Unknowns that no equation determines keep their value exactly.
  void guess_ahead(std::size_t j) {
    const LegendreNodes::Ahead& ahead = nodes_->ahead[j];
    const double half = 0.5 * piece_length();
    for (std::size_t k = 0; k < trial_.size(); ++k) {
      // The i-th node before j, or the beginning of the piece.
      const auto change_before = [&](std::size_t i) { return j > i ? changes_[k][j - 1 - i] : 0.0; };
      double change = 0.0;
      if (!is_closed_ && k < integrated_) {
        for (std::size_t i = 0; i < std::min(j + 1, LegendreNodes::k_known); ++i) {
          const double slope = j > i ? slopes_[k][j - 1 - i] : begin_rates_[k];
          change += ahead.values[i] * change_before(i) + half * ahead.slopes[i] * slope;
        }
      } else if (j > 0) {
        change = change_before(0);
        if (system_.unknowns()[k].is_dependent) change += ahead.onward * (change_before(0) - change_before(1));
      }
      trial_[k] = begin_state_[k] + change;
    }
  }

  /// True if the series of the work holds up to the event that ended the piece. Nodes lie beyond the event, where the
  /// mode need not continue smoothly (a contact that opens has no force).
  [[nodiscard]] bool holds_up_to_end() {
    system_.rates(end_, end_state_, rates_);
    const double scale = std::max(std::abs(begin_state_[*quadrature_]), system_.unknowns()[*quadrature_].scale);
    const auto is_same = [&](double xi, std::span<const double> rates) {
      const double error = std::abs(work_rate_.value(position(xi)) - rates[*quadrature_]);
      return (end_ - begin_) * error <= work_accuracy_ * scale;
    };
    return is_same(begin_, begin_rates_) && is_same(end_, rates_);
  }

  [[nodiscard]] double work_at(double xi, std::span<const double> y) {
    if (is_closed_) return primitive_offset_ + *system_.closed_quadrature(xi, y);
    return begin_state_[*quadrature_] + 0.5 * piece_length() * work_rate_.integral(position(xi));
  }

  void begin_panels() {
    panel_ = {.begin = begin_, .end = begin_, .work = begin_state_[*quadrature_], .next_length = end_ - begin_};
  }

  /// Work at xi from the series of its panel. From the closed form if the panel has no accurate series, or if rows do
  /// not come in order of xi.
  /// @param y  complete state at xi but for the work
  double panel_work_at(double xi, std::span<const double> y) {
    while (xi > panel_.end) take_next_panel();
    if (!panel_.is_resolved || xi < panel_.begin) return work_at(xi, y);
    return panel_.work + panel_.integral(work_rate_, panel_.position(xi));
  }

  /// Fits the series of the work over the next panel. No event lies inside a piece, so the mode holds at all nodes.
  void take_next_panel() {
    // A panel no longer than this (step coordinates) whose series is less accurate, over the work, lies next to a
    // singularity: its rows use the closed form.
    constexpr double k_shortest_panel = 1.0 / 32.0;
    constexpr double k_panel_accuracy = 1e-15;
    const LegendreNodes& nodes = LegendreNodes::many();
    if (panel_.is_resolved) {
      panel_.work += panel_.integral(work_rate_, 1.0);
    } else if (panel_.end > begin_) {
      state_at(panel_.end, trial_);
      panel_.work = work_at(panel_.end, trial_);
    }
    panel_.begin = panel_.end;
    for (double factor = 0.0; factor < 1.0;) {
      panel_.end =
          end_ - panel_.begin <= (1.0 + k_mergeable) * panel_.next_length ? end_ : panel_.begin + panel_.next_length;
      const double length = panel_.length();
      for (std::size_t j = 0; j < nodes.count; ++j) {
        const double xi = panel_.begin + 0.5 * length * (1.0 + nodes.places[j]);
        state_at(xi, trial_);
        system_.rates(xi, trial_, rates_);
        slopes_[*quadrature_][j] = rates_[*quadrature_];
      }
      work_rate_.fit(nodes, slopes_[*quadrature_]);
      const double ratio = length_ratio(panel_.work, length, k_panel_accuracy);
      panel_.is_resolved = ratio >= 1.0;
      const bool is_last = panel_.is_resolved || length <= k_shortest_panel;
      factor = is_last ? k_most_growth : std::clamp(k_safety * ratio, k_most_shrinkage, 0.5);
      panel_.next_length = factor * length;
    }
  }

  bool has_many_rows_;
  double work_accuracy_;  ///< tolerance of a piece's series of the work, over the work
  std::optional<std::size_t> quadrature_;
  bool is_closed_ = false;
  double primitive_offset_ = 0.0;
  bool has_panels_ = false;
  Panel panel_;
  bool has_dependent_unknowns_ = false;
  bool may_be_undetermined_ = false;  ///< some unknown may be determined by no equation
  double segment_begin_ = 0.0;
  double length_ = 0.0;                   ///< length of the next piece
  double piece_end_ = 0.0;                ///< where the piece would end without an event
  LegendreSeries work_rate_;              ///< rate of the quadrature
  RateRoundOff round_off_;                ///< round-off of the rates in this segment
  std::size_t integrated_ = 0;            ///< number of unknowns with rates(): the first ones
  std::vector<LegendreSamples> changes_;  ///< change of each unknown from the beginning of the piece to its nodes
  std::vector<LegendreSamples> slopes_;   ///< rates of the integrated unknowns at the nodes
  std::vector<LegendreSeries> series_;    ///< series of the changes
  std::vector<double> trial_, rates_, begin_rates_;
  bool has_branches_ = false;             ///< the equations have several branches of solutions
  std::vector<double> branch_reach_;      ///< Equations::branch_reach() where the piece begins
  const LegendreNodes* nodes_ = nullptr;  ///< rule for all pieces of the segment
};

}  // namespace

std::unique_ptr<Integrator> make_direct(Equations& system, double rtol, GuardSet& guard_set, std::size_t rows) {
  return std::make_unique<Direct>(system, rtol, guard_set, rows);
}

}  // namespace monograin
