// Integration without an integrator: every asked instant is solved for, events are roots along that solution, and the
// work is a closed form or a Gauss-Legendre quadrature.

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "engine/event_locator.hpp"
#include "numerics/legendre_series.hpp"

namespace monograin {
namespace {

// Pieces of a step of the program for each of their nodes, at which guards are looked at; shorter where the state or
// the quadrature needs it, and as long as the step where guards go one way and nothing is integrated.
constexpr double k_longest_per_node = 1.0 / 24.0;
// A remainder of the step up to this share of a piece is merged into the piece.
constexpr double k_rest = 0.25;
// Looks between the beginning of a segment and its first node: the first one, and the ratio of two that follow each
// other. They are made where a guard is so near zero, but not zero by rounding, that it may cross and come back in
// between. Dependent unknowns may start with an infinite slope, so guards count as near from farther away.
constexpr double k_first_look = 1e-9;
constexpr double k_grading = 30.0;
constexpr double k_near_zero = 1e-3;
constexpr double k_near_zero_if_steep = 0.1;
// Tiny pieces of a segment in which the equations may end: more of them are rounding that gets nowhere.
constexpr double k_tiny = 1e-10;
constexpr int k_most_refusals = 200;
// How much pieces change at most, and how much shorter they are than would just do.
constexpr double k_most_growth = 2.0;
constexpr double k_most_shrinkage = 0.2;
constexpr double k_safety = 0.85;
// The series of a piece's work may leave out a share of the tolerance, over the work: the tolerance itself, or
// k_share_of_work where that is larger, but no less than rounding. Where the work has a singularity, as at a first
// touch, its error is up to a hundred times that.
constexpr double k_rounding_of_work = 1e-16;
constexpr double k_share_of_work = 1e-3;
// Where a closed form of the work is costly and a step has many rows, they take the work from series over panels of a
// piece: these are that accurate, over the work. The closed form stays for panels that are no longer than this and
// whose series is not: those next to a singularity.
constexpr std::size_t k_many_rows = 50;
constexpr double k_shortest_panel = 1.0 / 32.0;
constexpr double k_panel_accuracy = 1e-15;
// How many times as large last terms may be that are rounding, where the rates are next to nothing beside the work.
constexpr double k_noise_of_nothing = 1e4;
// From which of that on few nodes are enough for it.
constexpr double k_few_nodes_accuracy = 1e-5;
// An event within this share of a piece may have all nodes beyond it; within that one, some. What the work up to it may
// be wrong by, as the rates there and at the beginning show it; and how far beyond it the piece ends that is covered
// again.
constexpr double k_deep_inside = 0.5;
constexpr double k_inside = 0.99;
constexpr double k_event_accuracy = 1e-13;
constexpr double k_just_beyond = 1.001;
// Over its scale: an unknown that has gone so far within the rounding of the step coordinate has jumped.
constexpr double k_spring = 1e-8;
// Where there are several solutions, what the last terms of a piece's series are at most, over the largest: the way
// from one solution to another is a jump, or goes like a root, and no piece on one of them does.
constexpr double k_unresolved = 1e-2;
// Terms over the unknown's scale of which nothing is asked: rounding.
constexpr double k_rounding_of_branch = 1e-8;
// Quadrature pieces are not refined below this; what is left is below round-off of the whole.
constexpr double k_smallest_quadrature = 1e-6;

/// Rounding of the rates, as the series of pieces show it: their last terms are as large as those of a longer piece
/// from the same beginning, which was refused. Those of a root fall as the length to the power 1/2, those of a kink as
/// the length; where it lies just inside a longer piece they do not, but those of several are not alike. Pieces need
/// not be as short as to have no rounding: it would add up in their states.
class RateRounding {
 public:
  [[nodiscard]] double known() const noexcept { return known_; }

  void see(const LegendreSeries& rate, double begin, double length, bool is_refused) noexcept {
    const double tail = rate.tail();
    if (begin != refused_at_) {
      if (!is_refused) return;
      refused_at_ = begin;
      refused_length_ = length;
      refused_tail_ = tail;
      return;
    }
    if (tail < k_as_large * refused_tail_ || length > k_shorter * refused_length_) return;
    if (refused_tail_ > k_most * rate.largest()) return;
    if (std::max(largest_, refused_tail_) > k_alike * std::min(largest_, refused_tail_)) {
      largest_ = 0.0;
      count_ = 0;
    }
    largest_ = std::max(largest_, refused_tail_);
    if (++count_ >= k_often) known_ = largest_;
    refused_at_ = -1.0;
  }

 private:
  static constexpr double k_shorter = 0.5;
  static constexpr double k_as_large = 0.75;
  static constexpr double k_most = 1e-6;  // over the rates
  static constexpr double k_alike = 10.0;
  static constexpr int k_often = 3;

  double refused_at_ = -1.0;
  double refused_length_ = 0.0, refused_tail_ = 0.0;
  int count_ = 0;
  double largest_ = 0.0, known_ = 0.0;
};

class Direct final : public EventLocator {
 public:
  Direct(HybridSystem& system, double rtol, GuardSet& guard_set, std::size_t rows)
      : EventLocator(system, guard_set, k_most_nodes),
        has_many_rows_(rows >= k_many_rows),
        work_accuracy_(std::max(k_rounding_of_work, rtol * std::max(rtol, k_share_of_work))) {
    const auto unknowns = system.unknowns();
    const auto found = std::ranges::find(unknowns, Unknown::Kind::quadrature, &Unknown::kind);
    if (found != unknowns.end() && system.has_energies())
      quadrature_ = static_cast<std::size_t>(found - unknowns.begin());
    has_slaves_ = system.has_dependent_unknowns();
    may_rest_ = std::ranges::any_of(unknowns, &Unknown::may_rest);
    trial_.resize(unknowns.size());
    branch_reach_.resize(unknowns.size());
    rates_.resize(unknowns.size());
    begin_rates_.resize(unknowns.size());
    integrated_ = static_cast<std::size_t>(std::ranges::count_if(
        unknowns, [](const Unknown& unknown) { return unknown.kind != Unknown::Kind::algebraic; }));
    gains_.resize(unknowns.size());
    slopes_.resize(integrated_);
    series_.resize(unknowns.size());
  }

  void begin(double xi, std::span<const double> y) override {
    segment_begin_ = xi;
    refusals_ = 0;
    rounding_ = {};
    is_closed_ = !quadrature_;
    has_panels_ = false;
    if (const auto primitive = system_.closed_quadrature(xi, y); quadrature_ && primitive) {
      is_closed_ = true;
      has_panels_ = has_many_rows_ && system_.is_quadrature_costly();
      primitive_offset_ = y[*quadrature_] - *primitive;
    }
    nodes_ = is_closed_ || work_accuracy_ >= k_few_nodes_accuracy ? &LegendreNodes::few() : &LegendreNodes::many();
    length_ = longest();
    begin_segment(xi, y);
  }

  Advance advance() override {
    ++statistics_.steps;
    begin_piece();
    system_.branch_reach(begin_state_, branch_reach_);
    has_branches_ = std::ranges::any_of(branch_reach_, [](double reach) { return std::isfinite(reach); });
    double rest = k_rest;
    for (bool is_covered = false; !is_covered; rest = 0.0) {
      piece_end_ = 1.0 - begin_ <= (1.0 + rest) * length_ ? 1.0 : begin_ + length_;
      const double tried = piece_length();
      double factor = k_most_growth;
      try {
        is_covered = cover_piece(factor);
      } catch (const std::domain_error&) {
        // The equations end in it, or Newton's method has left the domain although there is a solution.
        if (tried < least_progress(begin_) || (tried < k_tiny && ++refusals_ > k_most_refusals)) throw;
        factor = 0.5;
      }
      length_ = std::min(longest(), factor * tried);
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
    if (quadrature_) y[*quadrature_] = has_panels_ ? panel_work_at(xi, y) : quadrature_at(xi, y);
  }

  [[nodiscard]] double guard_tolerance() const noexcept override { return 1e-13; }

 private:
  /// Place in the piece, from -1 to 1.
  [[nodiscard]] double place(double xi) const noexcept {
    return piece_end_ > begin_ ? std::clamp(2.0 * (xi - begin_) / piece_length() - 1.0, -1.0, 1.0) : -1.0;
  }

  /// The series through the nodes of the piece are the first guess. What may rest has gone the way that it has come,
  /// which no series knows: from the last node before, if there is a way from there. Slaved unknowns are too steep for
  /// that.
  void state_at(double xi, std::span<double> y) override {
    ++statistics_.rhs_evaluations;
    const double t = place(xi);
    if (goes_from_nodes() && !has_slaves_) {
      std::size_t gone = 0;
      while (gone < nodes_->count && nodes_->places[gone] <= t) ++gone;
      for (std::size_t k = 0; k < y.size(); ++k) y[k] = begin_state_[k] + (gone > 0 ? gains_[k][gone - 1] : 0.0);
      try {
        system_.solve(xi, y);
        return;
      } catch (const std::domain_error&) {
        ++statistics_.rhs_evaluations;
      }
    }
    for (std::size_t k = 0; k < y.size(); ++k) y[k] = begin_state_[k] + series_[k].value(t);
    system_.solve(xi, y);
  }

  [[nodiscard]] bool goes_from_nodes() const noexcept { return may_rest_ && is_closed_; }

  void state_ahead(double xi, std::span<double> y) override { system_.solve(xi, y); }

  void move_end(double xi) override {
    end_ = xi;
    state_at(xi, end_state_);
    look(xi, end_state_, end_values_);
  }

  void solve_at_node(std::size_t j) {
    guess_ahead(j);
    ++statistics_.rhs_evaluations;
    system_.solve(node(j), trial_);
    for (std::size_t k = 0; k < trial_.size(); ++k) gains_[k][j] = trial_[k] - begin_state_[k];
  }

  /// Solves for the state at the nodes of the piece, finds its event and integrates over it; false where the piece is
  /// too long for that.
  /// @param factor  how many times as long the next piece, or this one, should be; left alone where nothing says
  bool cover_piece(double& factor) {
    forget_looks();
    if (!is_closed_) system_.rates(begin_, begin_state_, begin_rates_);
    if (begin_ == segment_begin_) look_early();
    for (std::size_t j = 0; j < nodes_->count; ++j) {
      const double xi = node(j);
      solve_at_node(j);
      if (piece_length() > k_smallest_looked_into && !guard_set_.is_monotone()) look_inside(xi, trial_);
      if (has_branches_ && piece_length() > least_progress(begin_)) {
        if (const double share = share_of_reach(trial_); share > 1.0) {
          factor = std::clamp(k_safety / share, k_most_shrinkage, 0.5);
          return false;
        }
      }
      if (is_closed_) continue;
      system_.rates(xi, trial_, rates_);
      for (std::size_t k = 0; k < integrated_; ++k) slopes_[k][j] = rates_[k];
    }
    fit_gains();
    if (!is_closed_) {
      work_.fit(*nodes_, slopes_[*quadrature_]);
      const double length = piece_length();
      const double reach = work_reach(begin_state_[*quadrature_], length, work_accuracy_, rounding_.known());
      factor = std::clamp(k_safety * reach, k_most_shrinkage, k_most_growth);
      const bool is_too_long = reach < 1.0 && length > k_smallest_quadrature;
      rounding_.see(work_, begin_, length, is_too_long);
      if (is_too_long) return false;
    }
    move_end(piece_end_);
    locate_event();
    if (has_sprung()) {
      factor = k_most_shrinkage;
      return false;
    }
    if (goes_from_nodes() && end_ < piece_end_ && end_ - begin_ > least_progress(begin_)) forget_what_follows();
    if (has_branches_) {
      if (!is_resolved()) {
        factor = std::min(0.5, k_just_beyond * (end_ - begin_) / piece_length());
        return false;
      }
      factor = std::min(factor, std::max(k_safety / share_of_reach(end_state_), k_most_shrinkage));
    }
    if (!is_closed_ && end_ - begin_ < k_inside * piece_length() && !holds_up_to_end()) {
      factor = k_just_beyond * (end_ - begin_) / piece_length();
      return false;
    }
    if (quadrature_) end_state_[*quadrature_] = quadrature_at(end_, end_state_);
    return true;
  }

  /// How many times as long the interval of work_, the series of the work's rate, could be.
  /// @param work      where the interval begins
  /// @param accuracy  over the work
  /// @param rounding  of the rates, that is known
  [[nodiscard]] double work_reach(double work, double length, double accuracy, double rounding = 0.0) const {
    const double scale = std::max(std::abs(work), system_.unknowns()[*quadrature_].scale);
    // What is tolerated is no rounding: terms that fall slowly, as those of a kink do, leave out more than they show.
    const double least = k_noise_of_nothing * k_rounding_of_work * scale / length;
    return work_.reach(2.0 * accuracy * scale / length, std::max(rounding, least));
  }

  /// Whether an event at the beginning shows that the states of the piece are others than those that lead on from
  /// there: next to a fold, the first node of a long piece may have gone over to them. Shorter pieces follow.
  [[nodiscard]] bool has_sprung() const noexcept {
    if (fired_.empty() || end_ - begin_ > least_progress(begin_) || piece_length() <= k_tiny) return false;
    for (std::size_t k = 0; k < end_state_.size(); ++k) {
      if (std::abs(end_state_[k] - begin_state_[k]) > k_spring * system_.unknowns()[k].scale) return true;
    }
    return false;
  }

  [[nodiscard]] double longest() const noexcept {
    return is_closed_ && guard_set_.is_monotone() ? 1.0 : k_longest_per_node * static_cast<double>(nodes_->count);
  }
  [[nodiscard]] double piece_length() const noexcept { return piece_end_ - begin_; }

  /// How far a state is from the beginning of the piece, over how far it may be; 0 where it may be anywhere.
  [[nodiscard]] double share_of_reach(std::span<const double> y) const noexcept {
    double share = 0.0;
    for (std::size_t k = 0; k < y.size(); ++k) {
      share = std::max(share, std::abs(y[k] - begin_state_[k]) / branch_reach_[k]);
    }
    return share;
  }

  /// Whether the state up to the end of the piece is one branch of solutions: nodes show it, and series go through
  /// them.
  [[nodiscard]] bool is_resolved() const {
    const double length = piece_length();
    if (end_ - begin_ <= least_progress(begin_)) return true;
    if (end_ - begin_ < k_deep_inside * length) return false;
    for (std::size_t k = 0; k < series_.size(); ++k) {
      if (series_[k].rest(k_rounding_of_branch * system_.unknowns()[k].scale) > k_unresolved) return false;
    }
    return true;
  }

  /// Nodes beyond an event belong to a mode that is not to be: what rests would keep, before the event, what has moved
  /// it there.
  void forget_what_follows() {
    piece_end_ = end_;
    for (std::size_t j = 0; j < nodes_->count; ++j) solve_at_node(j);
    fit_gains();
    move_end(end_);
  }

  [[nodiscard]] double node(std::size_t j) const noexcept {
    return begin_ + 0.5 * piece_length() * (1.0 + nodes_->places[j]);
  }

  void fit_gains() {
    for (std::size_t k = 0; k < series_.size(); ++k) {
      if (k != quadrature_) series_[k].fit(*nodes_, gains_[k]);
    }
  }

  /// A step may begin with a singularity, as from first touch on: smooth in one guard, and not in another. A segment
  /// that begins soon after is as near to it.
  void look_early() {
    const double near = has_slaves_ ? k_near_zero_if_steep : k_near_zero;
    const auto is_near = [near](double value) { return std::abs(value) > k_zero_guard && std::abs(value) < near; };
    if (std::ranges::none_of(begin_values_, is_near)) return;
    const double first_node = 0.5 * piece_length() * (1.0 + nodes_->places[0]);
    try {
      for (double distance = std::max(k_first_look, begin_); k_grading * distance <= first_node;
           distance *= k_grading) {
        std::ranges::copy(begin_state_, trial_.begin());
        ++statistics_.rhs_evaluations;
        system_.solve(begin_ + distance, trial_);
        look_inside(begin_ + distance, trial_);
      }
    } catch (const std::domain_error&) {
      return;  // the nodes will find out how far there is a solution
    }
  }

  /// From what is known at the beginning of the piece and the nodes so far. One after another: the guess is then never
  /// far from the solution, which may not be the only one. Algebraic unknowns may be singular, over which polynomials
  /// overshoot: from a line if an equation gives them outright, else the last one. What nothing determines stays
  /// exactly what it is.
  void guess_ahead(std::size_t j) {
    const LegendreNodes::Ahead& ahead = nodes_->ahead[j];
    const double half = 0.5 * piece_length();
    for (std::size_t k = 0; k < trial_.size(); ++k) {
      const auto gone = [&](std::size_t i) { return j > i ? gains_[k][j - 1 - i] : 0.0; };
      double gain = 0.0;
      if (!is_closed_ && k < integrated_) {
        for (std::size_t i = 0; i < std::min(j + 1, LegendreNodes::k_known); ++i) {
          gain +=
              ahead.values[i] * gone(i) + half * ahead.slopes[i] * (j > i ? slopes_[k][j - 1 - i] : begin_rates_[k]);
        }
      } else if (j > 0) {
        gain = gone(0);
        if (system_.unknowns()[k].is_dependent) gain += ahead.onward * (gone(0) - gone(1));
      }
      trial_[k] = begin_state_[k] + gain;
    }
  }

  /// Whether the series of the work is that of this mode up to the event that has ended the piece: a mode need not go
  /// on smoothly beyond it (a contact that opens has no force), and nodes lie there.
  [[nodiscard]] bool holds_up_to_end() {
    system_.rates(end_, end_state_, rates_);
    const double scale = std::max(std::abs(begin_state_[*quadrature_]), system_.unknowns()[*quadrature_].scale);
    const auto is_same = [&](double xi, std::span<const double> rates) {
      const double error = std::abs(work_.value(place(xi)) - rates[*quadrature_]);
      return (end_ - begin_) * error <= std::max(k_event_accuracy, work_accuracy_) * scale;
    };
    return is_same(begin_, begin_rates_) && is_same(end_, rates_);
  }

  [[nodiscard]] double quadrature_at(double xi, std::span<const double> y) {
    if (is_closed_) return primitive_offset_ + *system_.closed_quadrature(xi, y);
    return begin_state_[*quadrature_] + 0.5 * piece_length() * work_.integral(place(xi));
  }

  // --- panels

  void begin_panels() {
    panel_begin_ = panel_end_ = begin_;
    panel_length_ = end_ - begin_;
    panel_work_ = begin_state_[*quadrature_];
    is_panel_resolved_ = false;
  }

  [[nodiscard]] double panel_place(double xi) const noexcept {
    return 2.0 * (xi - panel_begin_) / (panel_end_ - panel_begin_) - 1.0;
  }
  [[nodiscard]] double panel_integral(double t) const noexcept {
    return 0.5 * (panel_end_ - panel_begin_) * work_.integral(t);
  }

  /// The work in a row. @param y  its state; rows come in their order, or the closed form gives it
  double panel_work_at(double xi, std::span<const double> y) {
    while (xi > panel_end_) take_next_panel();
    if (!is_panel_resolved_ || xi < panel_begin_) return quadrature_at(xi, y);
    return panel_work_ + panel_integral(panel_place(xi));
  }

  /// No event lies inside, so that the law holds at all nodes.
  void take_next_panel() {
    const LegendreNodes& nodes = LegendreNodes::many();
    if (is_panel_resolved_) {
      panel_work_ += panel_integral(1.0);
    } else if (panel_end_ > begin_) {
      state_at(panel_end_, trial_);
      panel_work_ = quadrature_at(panel_end_, trial_);
    }
    panel_begin_ = panel_end_;
    for (double factor = 0.0; factor < 1.0;) {
      panel_end_ = end_ - panel_begin_ <= (1.0 + k_rest) * panel_length_ ? end_ : panel_begin_ + panel_length_;
      const double length = panel_end_ - panel_begin_;
      for (std::size_t j = 0; j < nodes.count; ++j) {
        const double xi = panel_begin_ + 0.5 * length * (1.0 + nodes.places[j]);
        state_at(xi, trial_);
        system_.rates(xi, trial_, rates_);
        slopes_[*quadrature_][j] = rates_[*quadrature_];
      }
      work_.fit(nodes, slopes_[*quadrature_]);
      const double reach = work_reach(panel_work_, length, k_panel_accuracy);
      is_panel_resolved_ = reach >= 1.0;
      const bool is_last = is_panel_resolved_ || length <= k_shortest_panel;
      factor = is_last ? k_most_growth : std::clamp(k_safety * reach, k_most_shrinkage, 0.5);
      panel_length_ = factor * length;
    }
  }

  bool has_many_rows_;
  double work_accuracy_;
  std::optional<std::size_t> quadrature_;
  bool is_closed_ = false;
  double primitive_offset_ = 0.0;
  // A panel of the piece, in which work_ is the series of the rates; with a closed form nothing else needs it.
  bool has_panels_ = false;
  double panel_begin_ = 0.0, panel_end_ = 0.0;
  double panel_length_ = 0.0;  ///< of the next one
  double panel_work_ = 0.0;    ///< where it begins
  bool is_panel_resolved_ = false;
  bool has_slaves_ = false;
  bool may_rest_ = false;  ///< some unknown
  double segment_begin_ = 0.0;
  int refusals_ = 0;                     ///< of tiny pieces in this segment
  double length_ = 0.0;                  ///< of the next piece
  double piece_end_ = 0.0;               ///< where the piece would end without an event
  LegendreSeries work_;                  ///< rate of the quadrature
  RateRounding rounding_;                ///< of the segment
  std::size_t integrated_ = 0;           ///< unknowns that rates() knows: the first ones
  std::vector<LegendreSamples> gains_;   ///< at the nodes: what the unknowns have gained since the beginning
  std::vector<LegendreSamples> slopes_;  ///< and the rates of the integrated ones
  std::vector<LegendreSeries> series_;   ///< of the gains
  std::vector<double> trial_, rates_, begin_rates_;
  bool has_branches_ = false;             ///< of solutions, several
  std::vector<double> branch_reach_;      ///< of the system where the piece begins
  const LegendreNodes* nodes_ = nullptr;  ///< of the segment's pieces
};

}  // namespace

std::unique_ptr<Integrator> make_direct(HybridSystem& system, double rtol, GuardSet& guard_set, std::size_t rows) {
  return std::make_unique<Direct>(system, rtol, guard_set, rows);
}

}  // namespace monograin
