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

/// End of the next part of an interval, which takes in a remainder of up to `mergeable` times its length.
double part_end(double begin, double length, double end, double mergeable = k_mergeable) noexcept {
  return end - begin <= (1.0 + mergeable) * length ? end : begin + length;
}

/// An interval of the step coordinate.
struct XiInterval {
  double begin = 0.0, end = 0.0;

  [[nodiscard]] double length() const noexcept { return end - begin; }
  /// Position of xi, from -1 at the beginning to 1 at the end.
  [[nodiscard]] double position(double xi) const noexcept { return 2.0 * (xi - begin) / length() - 1.0; }
  /// Step coordinate of a position.
  [[nodiscard]] double at(double position) const noexcept { return begin + 0.5 * length() * (1.0 + position); }
};

/// Result of an attempt to cover a piece.
struct Attempt {
  bool is_covered = true;         ///< false: the piece is too long
  double factor = k_most_growth;  ///< length of the next piece, or of the next attempt, over that of this one
};
Attempt too_long(double factor) noexcept { return {.is_covered = false, .factor = factor}; }

/// The work over an interval, as the integral of a series of its rate.
struct WorkSeries {
  XiInterval interval;
  double scale = 1.0;  ///< of the work
  double begin = 0.0;  ///< work where the interval begins
  LegendreSeries rate;

  [[nodiscard]] double at(double xi) const noexcept {
    return begin + 0.5 * interval.length() * rate.integral(interval.position(xi));
  }

  /// How many times as long the interval could be.
  /// @param accuracy   tolerated error, over the work
  /// @param round_off  known round-off of the rates
  [[nodiscard]] double length_ratio(double accuracy, double round_off = 0.0) const {
    // Last terms of a series of rates, times the length, up to this share of the work count as round-off: the rates are
    // then next to nothing beside the work.
    constexpr double k_nothing = 1e-12;
    // The tolerance itself must not count as round-off: terms next to a kink fall slowly, and the sum of those left out
    // exceeds the last ones kept.
    const double least = k_nothing * size() / interval.length();
    return rate.reach(2.0 * accuracy * size() / interval.length(), std::max(round_off, least));
  }

  /// Magnitude of the work to which errors are relative.
  [[nodiscard]] double size() const noexcept { return std::max(std::abs(begin), scale); }
};

/// The work of a run: its closed form where the equations have one, otherwise an integral over each piece. If a leg has
/// many rows and the closed form is costly, rows take the work from series over panels of a piece.
class WorkIntegral {
 public:
  WorkIntegral(Equations& system, double rtol, std::size_t rows)
      : system_(system),
        accuracy_(k_share_of_work * rtol),
        has_many_rows_(rows >= k_many_rows),
        rates_(system.unknowns().size()) {
    const auto unknowns = system.unknowns();
    const auto found = std::ranges::find(unknowns, Unknown::Kind::quadrature, &Unknown::kind);
    if (found == unknowns.end() || !system.has_energies()) return;
    index_ = static_cast<std::size_t>(found - unknowns.begin());
    series_.scale = found->scale;
  }

  /// Starts a segment at a complete state.
  void begin_segment(double xi, std::span<const double> y) {
    round_off_ = {};
    panel_.reset();
    closed_offset_.reset();
    const auto primitive = system_.closed_quadrature(xi, y);
    if (index_ && primitive) closed_offset_ = y[*index_] - *primitive;
  }

  /// True if the segment has no closed form of the work: pieces need fit().
  [[nodiscard]] bool is_integrated() const noexcept { return index_ && !closed_offset_; }

  /// Fits the series of the work's rate over a piece, and judges whether its last terms are below the tolerance.
  /// @param begin  state where the piece begins
  /// @param rates  of each unknown, at the nodes
  Attempt fit(const XiInterval& piece, std::span<const double> begin, std::span<const LegendreSamples> rates) {
    // The quadrature does not refine pieces shorter than this (step coordinates): their error is below the round-off of
    // the whole work.
    constexpr double k_smallest_quadrature = 1e-6;
    series_.interval = piece;
    series_.begin = begin[*index_];
    series_.rate.fit(LegendreNodes::many(), rates[*index_]);
    const double ratio = series_.length_ratio(accuracy_, round_off_.known());
    const bool is_refused = ratio < 1.0 && piece.length() > k_smallest_quadrature;
    round_off_.report(series_.rate, piece.begin, piece.length(), is_refused);
    return {.is_covered = !is_refused, .factor = std::clamp(k_safety * ratio, k_most_shrinkage, k_most_growth)};
  }

  /// True if the series of the piece holds up to the event that ended it. Nodes lie beyond the event, where the mode
  /// need not continue smoothly (a contact that opens has no force).
  /// @param end, y       event and state there
  /// @param begin_rates  where the piece begins
  [[nodiscard]] bool holds_up_to(double end, std::span<const double> y, std::span<const double> begin_rates) {
    system_.rates(end, y, rates_);
    const double begin = series_.interval.begin;
    const auto agrees = [&](double xi, std::span<const double> rates) {
      const double error = std::abs(series_.rate.value(series_.interval.position(xi)) - rates[*index_]);
      return (end - begin) * error <= accuracy_ * series_.size();
    };
    return agrees(begin, begin_rates) && agrees(end, rates_);
  }

  /// Sets the work in a state of the piece that is complete but for it.
  void complete(double xi, std::span<double> y) {
    if (index_) y[*index_] = is_integrated() ? series_.at(xi) : closed(xi, y);
  }

  /// Starts panels over a piece, from a complete state, if rows need them.
  void begin_panels(const XiInterval& piece, std::span<const double> begin) {
    if (!closed_offset_ || !has_many_rows_ || !system_.is_quadrature_costly()) return;
    series_.interval = {piece.begin, piece.begin};
    series_.begin = begin[*index_];
    panel_ = Panel{.piece_end = piece.end, .next_length = piece.length()};
  }

  /// Does what complete() does for a row. From the closed form if there are no panels, if the panel has no accurate
  /// series, or if rows do not come in order of xi.
  /// @param state_at  gives the state at any xi of the piece
  template <class StateAt>
  void complete_row(double xi, std::span<double> y, StateAt&& state_at) {
    while (panel_ && xi > series_.interval.end) take_next_panel(state_at);
    if (panel_ && panel_->is_resolved && xi >= series_.interval.begin)
      y[*index_] = series_.at(xi);
    else
      complete(xi, y);
  }

 private:
  /// A part of a piece in which series_ gives the work of the rows.
  struct Panel {
    double piece_end = 0.0;
    double next_length = 0.0;  ///< of the panel that follows
    bool is_resolved = false;  ///< the series is accurate
  };

  [[nodiscard]] double closed(double xi, std::span<const double> y) {
    return *closed_offset_ + *system_.closed_quadrature(xi, y);
  }

  /// Fits the series of the work over the next panel. No event lies inside a piece, so the mode holds at all nodes.
  template <class StateAt>
  void take_next_panel(StateAt&& state_at) {
    // A panel no longer than this (step coordinates) whose series is less accurate, over the work, lies next to a
    // singularity: its rows use the closed form.
    constexpr double k_shortest_panel = 1.0 / 32.0;
    constexpr double k_panel_accuracy = 1e-15;
    const LegendreNodes& nodes = LegendreNodes::many();
    auto& [begin, end] = series_.interval;
    if (panel_->is_resolved)
      series_.begin = series_.at(end);
    else if (end > begin)
      series_.begin = closed(end, state_at(end));
    begin = end;
    for (double factor = 0.0; factor < 1.0;) {
      end = part_end(begin, panel_->next_length, panel_->piece_end);
      LegendreSamples samples{};
      for (std::size_t j = 0; j < nodes.count; ++j) {
        const double xi = series_.interval.at(nodes.places[j]);
        system_.rates(xi, state_at(xi), rates_);
        samples[j] = rates_[*index_];
      }
      series_.rate.fit(nodes, samples);
      const double ratio = series_.length_ratio(k_panel_accuracy);
      panel_->is_resolved = ratio >= 1.0;
      const bool is_last = panel_->is_resolved || end - begin <= k_shortest_panel;
      factor = is_last ? k_most_growth : std::clamp(k_safety * ratio, k_most_shrinkage, 0.5);
      panel_->next_length = factor * (end - begin);
    }
  }

  Equations& system_;
  double accuracy_;  ///< tolerance of a piece's series, over the work
  bool has_many_rows_;
  std::optional<std::size_t> index_;     ///< of the work among the unknowns; none if the run needs no energies
  std::optional<double> closed_offset_;  ///< work less its closed form; none if the segment has no closed form
  WorkSeries series_;                    ///< over the present piece, or panel
  RateRoundOff round_off_;               ///< of the rates in this segment
  std::optional<Panel> panel_;           ///< present if rows take the work from series
  std::vector<double> rates_;
};

/// Predicts states of a piece, from which the system solves: from node to node, and then by series through the nodes.
class StatePredictor {
 public:
  explicit StatePredictor(std::span<const Unknown> unknowns)
      : unknowns_(unknowns),
        begin_rates_(unknowns.size()),
        changes_(unknowns.size()),
        slopes_(unknowns.size()),
        series_(unknowns.size()) {}

  /// Starts a segment. @param has_rates  the rates at the nodes will be known
  void begin_segment(bool has_rates) {
    has_rates_ = has_rates;
    starts_from_nodes_ = !has_rates && std::ranges::any_of(unknowns_, &Unknown::may_be_undetermined) &&
                         std::ranges::none_of(unknowns_, &Unknown::is_dependent);
  }

  /// The rule for all pieces of the segment.
  [[nodiscard]] const LegendreNodes& nodes() const { return has_rates_ ? LegendreNodes::many() : LegendreNodes::few(); }

  /// Starts a piece.
  /// @param state  where it begins; must not change within the piece
  /// @param rates  there; not used without rates at the nodes
  void begin_piece(std::span<const double> state, std::span<const double> rates) {
    begin_ = state;
    std::ranges::copy(rates, begin_rates_.begin());
  }
  [[nodiscard]] std::span<const double> begin_rates() const noexcept { return begin_rates_; }

  /// Predicts the state at a distance from the beginning of the piece, along the rates there.
  void go_along_rates(double distance, std::span<double> y) const {
    for (std::size_t k = 0; k < y.size(); ++k) y[k] = begin_[k] + (has_rate(k) ? begin_rates_[k] * distance : 0.0);
  }

  /// Predicts the state at node j by extrapolating from the beginning of the piece and the nodes already solved. Going
  /// node by node keeps the guess close to the solution; a distant guess could converge to another one. Algebraic
  /// unknowns may be singular, and polynomials overshoot there: dependent ones are extrapolated along a line, the
  /// others keep the value of the last node. Unknowns that no equation determines keep their value exactly.
  /// @param length  of the piece
  void guess_ahead(std::size_t j, double length, std::span<double> y) const {
    const LegendreNodes::Ahead& ahead = nodes().ahead[j];
    const double half = 0.5 * length;
    for (std::size_t k = 0; k < y.size(); ++k) {
      // The i-th node before j, or the beginning of the piece.
      const auto change_before = [&](std::size_t i) { return j > i ? changes_[k][j - 1 - i] : 0.0; };
      double change = 0.0;
      if (has_rates_ && has_rate(k)) {
        for (std::size_t i = 0; i < std::min(j + 1, LegendreNodes::k_known); ++i) {
          const double slope = j > i ? slopes_[k][j - 1 - i] : begin_rates_[k];
          change += ahead.values[i] * change_before(i) + half * ahead.slopes[i] * slope;
        }
      } else if (j > 0) {
        change = change_before(0);
        if (unknowns_[k].is_dependent) change += ahead.onward * (change_before(0) - change_before(1));
      }
      y[k] = begin_[k] + change;
    }
  }

  void keep_state(std::size_t j, std::span<const double> y) {
    for (std::size_t k = 0; k < y.size(); ++k) changes_[k][j] = y[k] - begin_[k];
  }
  void keep_rates(std::size_t j, std::span<const double> rates) {
    for (std::size_t k = 0; k < rates.size(); ++k) slopes_[k][j] = rates[k];
  }
  /// Rates of each unknown at the nodes.
  [[nodiscard]] std::span<const LegendreSamples> rates() const noexcept { return slopes_; }

  /// Fits the series once the states at all nodes are kept. The work has another series.
  void fit() {
    for (std::size_t k = 0; k < series_.size(); ++k) {
      if (unknowns_[k].kind != Unknown::Kind::quadrature) series_[k].fit(nodes(), changes_[k]);
    }
  }

  /// Predicts the state at a position of the piece from the series. Unknowns that no equation may determine depend on
  /// the path so far, which no series represents: the solver then starts from the last node before that position.
  /// Dependent unknowns are too steep to start from a node.
  void guess(double position, std::span<double> y) const {
    if (starts_from_nodes_) {
      const LegendreNodes& rule = nodes();
      std::size_t passed = 0;
      while (passed < rule.count && rule.places[passed] <= position) ++passed;
      for (std::size_t k = 0; k < y.size(); ++k) y[k] = begin_[k] + (passed > 0 ? changes_[k][passed - 1] : 0.0);
    } else {
      for (std::size_t k = 0; k < y.size(); ++k) y[k] = begin_[k] + series_[k].value(position);
    }
  }

  /// True if the series converge: the states then lie on one branch of solutions.
  [[nodiscard]] bool is_resolved() const {
    // Largest last terms of a series, over its largest term, that show a single branch. The passage from one branch to
    // another is a jump or behaves like a square root, and its series converges more slowly. Smaller last terms, over
    // the unknown's scale, are round-off and pass.
    constexpr double k_unresolved = 1e-2;
    constexpr double k_round_off_of_branch = 1e-8;
    for (std::size_t k = 0; k < series_.size(); ++k) {
      if (series_[k].rest(k_round_off_of_branch * unknowns_[k].scale) > k_unresolved) return false;
    }
    return true;
  }

 private:
  [[nodiscard]] bool has_rate(std::size_t k) const noexcept { return unknowns_[k].kind != Unknown::Kind::algebraic; }

  std::span<const Unknown> unknowns_;
  bool has_rates_ = false;                ///< rates at the nodes are known
  bool starts_from_nodes_ = false;        ///< guess() starts from the last node
  std::span<const double> begin_;         ///< state where the piece begins
  std::vector<double> begin_rates_;       ///< rates there
  std::vector<LegendreSamples> changes_;  ///< change of each unknown from the beginning of the piece to its nodes
  std::vector<LegendreSamples> slopes_;   ///< rates of the unknowns at the nodes
  std::vector<LegendreSeries> series_;    ///< series of the changes
};

class Direct final : public EventLocator {
 public:
  Direct(Equations& system, double rtol, GuardSet& guard_set, std::size_t rows)
      : EventLocator(system, guard_set),
        work_(system, rtol, rows),
        predictor_(system.unknowns()),
        branch_reach_(system.unknowns().size()),
        trial_(system.unknowns().size()),
        rates_(system.unknowns().size()) {}

  void begin(double xi, std::span<const double> y) override {
    segment_begin_ = xi;
    work_.begin_segment(xi, y);
    predictor_.begin_segment(work_.is_integrated());
    next_length_ = longest();
    begin_segment(xi, y);
  }

  Advance advance() override {
    ++statistics_.steps;
    begin_piece();
    system_.branch_reach(begin_.state, branch_reach_);
    if (work_.is_integrated()) system_.rates(begin_.xi, begin_.state, rates_);
    predictor_.begin_piece(begin_.state, rates_);
    Attempt attempt{.is_covered = false};
    for (double mergeable = k_mergeable; !attempt.is_covered; mergeable = 0.0) {
      piece_end_ = part_end(begin_.xi, next_length_, 1.0, mergeable);
      const double planned_length = next_length_;
      double tried_length = piece().length();
      bool ends_at_kink = false;
      try {
        ends_at_kink = end_at_kink(mergeable);
        tried_length = piece().length();
        attempt = cover_piece();
      } catch (const std::domain_error&) {
        // The equations end within the piece, or Newton's method left their domain although there is a solution.
        if (tried_length < least_progress(begin_.xi)) throw;
        attempt = too_long(0.5);
      }
      next_length_ = attempt.factor * tried_length;
      // The length grows beyond the distances of kinks, to find out whether they are weak.
      if (attempt.is_covered && ends_at_kink) next_length_ = std::max(next_length_, k_growth_at_kinks * planned_length);
      next_length_ = std::min(longest(), next_length_);
    }
    statistics_.last_step = covered_length();
    work_.begin_panels({begin_.xi, end_.xi}, begin_.state);
    return {.xi = end_.xi, .hit_guard = !fired_.empty()};
  }

  void dense_output(double xi, std::span<double> y) override {
    if (xi == end_.xi || xi == begin_.xi) {
      std::ranges::copy((xi == end_.xi ? end_ : begin_).state, y.begin());
      return;
    }
    state_at(xi, y);
    work_.complete_row(xi, y, [this](double at) -> std::span<const double> {
      state_at(at, trial_);
      return trial_;
    });
  }

  [[nodiscard]] double guard_tolerance() const noexcept override { return k_zero_guard; }

 private:
  /// The piece as it would be without an event.
  [[nodiscard]] XiInterval piece() const noexcept { return {begin_.xi, piece_end_}; }

  void state_at(double xi, std::span<double> y) override {
    ++statistics_.rhs_evaluations;
    predictor_.guess(piece().position(xi), y);
    system_.solve(xi, y);
  }

  void state_ahead(double xi, std::span<double> y) override { system_.solve(xi, y); }

  void move_end(double xi) override { evaluate(xi, end_); }

  /// Ends the piece at the first kink in it, or up to a share `mergeable` beyond it: the series of the work then see
  /// smooth rates. Kinks that lie close together for the length of the piece are taken to be weak. If they are not,
  /// pieces are refused until they are as short as the distances between the kinks.
  /// @return true if the piece ends at a kink
  bool end_at_kink(double mergeable) {
    // The last piece ended at kinks that are nearer than this share of the piece to its beginning.
    constexpr double k_passed = 1e-3;
    constexpr double k_close = 0.25;  // share of the piece up to which kinks lie close together
    if (!work_.is_integrated()) return false;
    const double begin = begin_.xi;
    const double length = piece().length();
    const double limit = std::min(1.0, begin + (1.0 + mergeable) * length);
    const double kink = system_.next_kink(begin + k_passed * length, begin, begin_.state);
    if (kink - begin < k_close * length || kink >= limit) return false;
    // The system has predicted the kink from the rates at the beginning. It corrects the prediction by those there.
    predictor_.go_along_rates(kink - begin, trial_);
    ++statistics_.rhs_evaluations;
    system_.solve(kink, trial_);
    piece_end_ = std::min(system_.next_kink(std::midpoint(begin, kink), kink, trial_), limit);
    return true;
  }

  /// Solves for the state at the nodes of the piece, locates its event and integrates the work over it.
  Attempt cover_piece() {
    constexpr double k_inside = 0.99;        // an event before this share of the piece has nodes beyond it
    constexpr double k_just_beyond = 1.001;  // length of a piece that ends just beyond its event, over that up to it
    forget_samples();
    if (begin_.xi == segment_begin_) sample_early();
    const bool has_branches = std::ranges::any_of(branch_reach_, [](double reach) { return std::isfinite(reach); });
    if (!solve_nodes(has_branches)) return too_long(0.5);
    predictor_.fit();
    Attempt attempt = work_.is_integrated() ? work_.fit(piece(), begin_.state, predictor_.rates()) : Attempt{};
    if (!attempt.is_covered) return attempt;
    move_end(piece_end_);
    locate_event();
    if (has_jumped()) return too_long(k_most_shrinkage);
    const double beyond_event = k_just_beyond * covered_length() / piece().length();
    if (has_branches) {
      if (covered_length() > least_progress(begin_.xi) && !predictor_.is_resolved())
        return too_long(std::min(0.5, beyond_event));
      attempt.factor = std::min(attempt.factor, std::max(k_safety / share_of_reach(end_.state), k_most_shrinkage));
    }
    const bool has_nodes_beyond = covered_length() < k_inside * piece().length();
    if (work_.is_integrated() && has_nodes_beyond &&
        !work_.holds_up_to(end_.xi, end_.state, predictor_.begin_rates())) {
      return too_long(beyond_event);
    }
    work_.complete(end_.xi, end_.state);
    return attempt;
  }

  /// Solves for the states at the nodes, and evaluates the rates there if the work needs them.
  /// @return false if a state is so far from the beginning that it may lie on another branch of solutions
  bool solve_nodes(bool has_branches) {
    const double length = piece().length();
    const LegendreNodes& nodes = predictor_.nodes();
    for (std::size_t j = 0; j < nodes.count; ++j) {
      const double xi = piece().at(nodes.places[j]);
      predictor_.guess_ahead(j, length, trial_);
      ++statistics_.rhs_evaluations;
      system_.solve(xi, trial_);
      predictor_.keep_state(j, trial_);
      if (length > k_shortest_sampled && !guard_set_.is_monotone()) sample_inside(xi, trial_);
      if (has_branches && length > least_progress(begin_.xi) && share_of_reach(trial_) > 1.0) return false;
      if (!work_.is_integrated()) continue;
      system_.rates(xi, trial_, rates_);
      predictor_.keep_rates(j, rates_);
    }
    return true;
  }

  /// True if the states of the piece lie on another branch than its beginning: an event there comes with a jump of the
  /// state. Next to a fold, the solver may find the other branch at the first node of a long piece; shorter pieces
  /// avoid this.
  [[nodiscard]] bool has_jumped() const noexcept {
    constexpr double k_jumped = 1e-8;  // change of an unknown within round-off of xi, over its scale, that is a jump
    constexpr double k_tiny = 1e-10;   // pieces up to this length (step coordinates) may be round-off
    if (fired_.empty() || covered_length() > least_progress(begin_.xi) || piece().length() <= k_tiny) return false;
    for (std::size_t k = 0; k < end_.state.size(); ++k) {
      if (std::abs(end_.state[k] - begin_.state[k]) > k_jumped * system_.unknowns()[k].scale) return true;
    }
    return false;
  }

  /// Greatest length of a piece. Guards are evaluated at its nodes; if all are monotone and nothing is integrated, a
  /// piece may be the whole leg.
  [[nodiscard]] double longest() const noexcept {
    constexpr double k_longest_per_node = 1.0 / 24.0;
    if (!work_.is_integrated() && guard_set_.is_monotone()) return 1.0;
    return k_longest_per_node * static_cast<double>(predictor_.nodes().count);
  }
  /// Length of the piece up to its event.
  [[nodiscard]] double covered_length() const noexcept { return end_.xi - begin_.xi; }

  /// Largest change of an unknown since the beginning of the piece, over its branch_reach(); 0 if there is one branch
  /// of solutions only.
  [[nodiscard]] double share_of_reach(std::span<const double> y) const noexcept {
    double share = 0.0;
    for (std::size_t k = 0; k < y.size(); ++k) {
      share = std::max(share, std::abs(y[k] - begin_.state[k]) / branch_reach_[k]);
    }
    return share;
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
    const double near = system_.has_dependent_unknowns() ? k_near_zero_if_steep : k_near_zero;
    const auto is_near = [near](double value) { return std::abs(value) > k_zero_guard && std::abs(value) < near; };
    if (std::ranges::none_of(begin_.values, is_near)) return;
    const double first_node = 0.5 * piece().length() * (1.0 + predictor_.nodes().places[0]);
    try {
      for (double distance = std::max(k_ahead, begin_.xi); k_grading * distance <= first_node; distance *= k_grading) {
        std::ranges::copy(begin_.state, trial_.begin());
        ++statistics_.rhs_evaluations;
        system_.solve(begin_.xi + distance, trial_);
        sample_inside(begin_.xi + distance, trial_);
      }
    } catch (const std::domain_error&) {
      return;  // solving at the nodes finds out how far solutions exist
    }
  }

  WorkIntegral work_;
  StatePredictor predictor_;
  std::vector<double> branch_reach_;  ///< Equations::branch_reach() where the piece begins
  double segment_begin_ = 0.0;
  double next_length_ = 0.0;  ///< of a piece
  double piece_end_ = 0.0;    ///< where the piece would end without an event
  std::vector<double> trial_, rates_;
};

}  // namespace

std::unique_ptr<Integrator> make_direct(Equations& system, double rtol, GuardSet& guard_set, std::size_t rows) {
  return std::make_unique<Direct>(system, rtol, guard_set, rows);
}

}  // namespace monograin
