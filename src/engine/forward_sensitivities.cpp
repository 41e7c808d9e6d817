#include "engine/forward_sensitivities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "engine/explicit_form.hpp"
#include "scenario/integrators.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

// Guards that fire together in the base have to fire together in a neighbour: largest difference of their instants
// there, over the distance that the neighbour moves to its event.
constexpr double k_together = 1e-4;
// Largest distance of a neighbour from the base, over the size of an unknown: curvature then leaves an error of 1e-6 in
// a derivative.
constexpr double k_farthest = 1e-3;
// A neighbour's root is located once a secant step (step coordinates) is shorter than this.
constexpr double k_located = 1e-15;
constexpr int k_most_secant_steps = 30;

/// Performs an action on neighbours. A limit that a neighbour meets ends the derivatives, not the run: it is thrown as
/// LostSensitivities.
template <class Action>
auto beside(Action&& action) {
  try {
    return action();
  } catch (const std::domain_error& error) {
    throw LostSensitivities(fmt::format("a neighbouring run meets a limit: {}", error.what()));
  } catch (const Stop& stop) {
    throw LostSensitivities(fmt::format("a neighbouring run stops: {}", stop.message));
  }
}

/// True if one of the guards that have fired ends a branch of solutions.
bool is_branch_end(const HybridSystem& system, std::span<const std::size_t> fired) {
  return std::ranges::any_of(
      fired, [&](std::size_t g) { return g < system.guards().size() && system.guards()[g].is_branch_end; });
}

}  // namespace

/// A neighbour of the base, at its own position in the program.
struct ForwardSensitivities::Side {
  Scene scene;
  double sign = 1.0;  ///< -1: lower neighbour, +1: upper neighbour
  GuardSet guard_set;
  std::vector<Ramp> resting_ramps{};
  StepPlan plan{};
  StepClock clock;
  double xi = 0.0;
  double begin = 0.0;  ///< step coordinate where the segment begins
  std::vector<double> begin_y{};
  std::vector<double> y{}, rates{}, guards{};
  std::vector<double> begin_guards{};  ///< guards where the segment begins; nan if they have no values there
  std::optional<std::size_t> quadrature{};
  std::optional<double> primitive_offset{};        ///< of the quadrature, if it has a closed form in the segment
  std::vector<double> derivatives{}, round_off{};  ///< of the last row at an event

  Side(Scene made, double its_sign)
      : scene(std::move(made)),
        sign(its_sign),
        guard_set(*scene.system),
        y(scene.system->unknowns().size()),
        rates(y.size()) {
    for (const Channel& channel : scene.channels) resting_ramps.push_back(channel.at_rest);
    const auto unknowns = scene.system->unknowns();
    const auto found = std::ranges::find(unknowns, Unknown::Kind::quadrature, &Unknown::kind);
    if (found != unknowns.end()) quadrature = static_cast<std::size_t>(found - unknowns.begin());
  }
  [[nodiscard]] HybridSystem& system() noexcept { return *scene.system; }
  [[nodiscard]] double time() const noexcept { return clock.time(xi); }

  void begin_segment() {
    begin = xi;
    begin_y = y;
    begin_guards.resize(guard_set.size());
    primitive_offset = offset_of_primitive();
    try {
      guard_set.values(xi, y, begin_guards);
    } catch (const std::domain_error&) {
      std::ranges::fill(begin_guards, k_nan);
    }
  }
  /// Value of the quadrature less its closed form; none where there is no such form.
  [[nodiscard]] std::optional<double> offset_of_primitive() {
    if (!quadrature || system().is_quadrature_costly()) return std::nullopt;
    try {
      const auto primitive = system().closed_quadrature(xi, y);
      return primitive ? std::optional(y[*quadrature] - *primitive) : std::nullopt;
    } catch (const std::domain_error&) {
      return std::nullopt;
    }
  }
  /// Completes the state. The quadrature gets its closed form, if it has one, in place of the integrated value: the
  /// derivative of the work behaves like a square root where a contact is lost, and integrators lose digits there.
  void complete() {
    system().complete(xi, y);
    if (!primitive_offset) return;
    if (const auto primitive = system().closed_quadrature(xi, y)) y[*quadrature] = *primitive_offset + *primitive;
  }
  void go_back() {
    xi = begin;
    y = begin_y;
  }
  /// Moves along its rates by a length (step coordinates) of the order of its distance from the base.
  void move(double length) {
    if (length == 0.0) return;
    system().rates(xi, y, rates);
    shift(length);
  }
  void shift(double length) {
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += length * rates[i];
    xi += length;
    complete();
  }
  void go_to_guard(std::span<const std::size_t> fired);
  void expect_same_guards(const HybridSystem& base, std::span<const Event> log, std::span<const Event> of_side) const;
  void expect_no_other_guard(std::span<const std::size_t> fired);
};

/// Throws LostSensitivities if a neighbour has other events or other guards than the base.
void ForwardSensitivities::Side::expect_same_guards(const HybridSystem& base, std::span<const Event> log,
                                                    std::span<const Event> of_side) const {
  const bool has_same_events = std::ranges::equal(log, of_side, [](const Event& one, const Event& other) {
    return one.name == other.name && one.contact_class == other.contact_class && one.other_class == other.other_class;
  });
  const bool has_same_guards =
      std::ranges::equal(base.guards(), scene.system->guards(), [](const Guard& one, const Guard& other) {
        return one.kind == other.kind && one.index == other.index && one.direction == other.direction;
      });
  if (!has_same_events || !has_same_guards) throw LostSensitivities("a neighbouring run passes other events");
}

/// Throws LostSensitivities if a guard has crossed zero in this neighbour, but has not fired in the base.
void ForwardSensitivities::Side::expect_no_other_guard(std::span<const std::size_t> fired) {
  guards.resize(guard_set.size());
  guard_set.values(xi, y, guards);
  for (std::size_t g = 0; g < guards.size(); ++g) {
    const int direction = guard_set.directions()[g];
    const bool has_crossed = direction * guards[g] > k_zero_guard && direction * begin_guards[g] < -k_zero_guard;
    if (has_crossed && std::ranges::find(fired, g) == fired.end()) {
      throw LostSensitivities(fmt::format("a neighbouring run passes event '{}' earlier or later", guard_set.name(g)));
    }
  }
}

/// Moves a neighbour along its rates to where the guards that have fired are zero; all of them have to be zero at the
/// same instant.
void ForwardSensitivities::Side::go_to_guard(std::span<const std::size_t> fired) {
  constexpr double k_short = 1e-7;
  system().rates(xi, y, rates);
  if (!all_finite(rates)) throw LostSensitivities("the rates of a neighbouring run are infinite at an event");
  const double from_xi = xi;
  const std::vector<double> from_y = y;
  guards.resize(guard_set.size());
  const auto guard_at = [&](double length, std::size_t guard) {
    xi = from_xi;
    y = from_y;
    shift(length);
    guard_set.values(xi, y, guards);
    return guards[guard];
  };
  double first = 0.0;
  for (std::size_t j = fired.size(); j-- > 0;) {
    double length = 0.0;
    double value = guard_at(0.0, fired[j]);
    const double slope = (value - guard_at(-k_short, fired[j])) / k_short;
    for (int correction = 0; value != 0.0; ++correction) {
      const double by = -value / slope;
      if (!std::isfinite(by) || correction == k_most_secant_steps) {
        throw LostSensitivities(fmt::format("the instant of event '{}' has no derivative", guard_set.name(fired[j])));
      }
      if (std::abs(by) < k_located * (1 + correction * correction)) break;
      length += by;
      value = guard_at(length, fired[j]);
    }
    if (j + 1 == fired.size()) first = length;
    if (std::abs(length - first) > k_together * std::max(std::abs(length), 1e-6)) {
      throw LostSensitivities(fmt::format("events that happen together come apart in a neighbouring run: '{}' and '{}'",
                                          guard_set.name(fired[j]), guard_set.name(fired.back())));
    }
    if (j == 0) static_cast<void>(guard_at(length, fired[j]));
  }
  if (xi > 1.0 + k_same_value || xi < begin - k_same_value) {
    throw LostSensitivities(
        fmt::format("a neighbouring run does not pass event '{}' there", guard_set.name(fired.front())));
  }
}

bool has_forward_sensitivities(std::string_view integrator) noexcept {
  return integrator == integrators::k_cvode_bdf || integrator == integrators::k_cvode_adams ||
         integrator == integrators::k_ida;
}

ForwardSensitivities::ForwardSensitivities(HybridSystem& base, std::vector<Neighbours> numbers) : base_(base) {
  const auto unknowns = base.unknowns();
  size_ = static_cast<std::size_t>(
      std::ranges::count_if(unknowns, [](const Unknown& u) { return u.kind != Unknown::Kind::algebraic; }));
  const auto observables = base.observables();
  for (std::size_t column = 0; column < observables.size(); ++column) {
    if (observables[column].words.empty()) columns_.push_back(column);
  }
  for (Neighbours& of : numbers) {
    Number& number = numbers_.emplace_back();
    number.value = of.value;
    number.step = of.step;
    number.s.assign(unknowns.size(), 0.0);
    number.sides.reserve(2);
    number.sides.emplace_back(std::move(of.lower), -1.0);
    number.sides.emplace_back(std::move(of.upper), 1.0);
    for (Side& side : number.sides) {
      const bool is_alike = side.system().unknowns().size() == unknowns.size() &&
                            side.system().observables().size() == observables.size();
      if (!is_alike) throw LostSensitivities("a neighbouring scene has other unknowns");
    }
  }
  for (auto* vectors : {&rates_, &states_}) {
    for (auto& values : *vectors) values.resize(unknowns.size());
  }
  for (auto& values : values_) values.resize(observables.size());
  base_values_.resize(observables.size());
  state_.resize(unknowns.size());
  base_rates_.resize(unknowns.size());
  slope_.resize(observables.size());
}

ForwardSensitivities::~ForwardSensitivities() = default;

double ForwardSensitivities::magnitude(std::size_t number) const noexcept { return std::abs(numbers_[number].value); }

void ForwardSensitivities::each_side(const std::function<void(Number&, Side&)>& action) {
  beside([&] {
    for (Number& number : numbers_) {
      for (Side& side : number.sides) action(number, side);
    }
  });
}

void ForwardSensitivities::rates(std::size_t index, double xi, std::span<const double> y, std::span<const double> guess,
                                 std::span<const double> s, std::span<double> ds) {
  Number& number = numbers_[index];
  for (std::size_t k = 0; k < 2; ++k) {
    Side& side = number.sides[k];
    const double distance = side.sign * number.step;
    std::ranges::copy(guess, state_.begin());
    for (std::size_t i = 0; i < size_; ++i) state_[i] = y[i] + distance * s[i];
    const double own_xi = xi + distance * sigma_at(number, xi);
    side.system().complete(own_xi, state_);
    side.system().rates(own_xi, state_, rates_[k]);
    ++evaluations_;
  }
  for (std::size_t i = 0; i < size_; ++i) ds[i] = slope_of(number, i);
}

void ForwardSensitivities::residual(std::size_t index, double xi, std::span<const double> y, std::span<const double> dy,
                                    std::span<const double> s, std::span<const double> ds, std::span<double> res) {
  Number& number = numbers_[index];
  for (std::size_t k = 0; k < 2; ++k) {
    Side& side = number.sides[k];
    const double distance = side.sign * number.step;
    for (std::size_t i = 0; i < y.size(); ++i) {
      state_[i] = y[i] + distance * s[i];
      side.rates[i] = (dy[i] + distance * ds[i]) / (1.0 + distance * number.stretch);
    }
    side.system().residual(xi + distance * sigma_at(number, xi), state_, side.rates, rates_[k]);
    ++evaluations_;
  }
  for (std::size_t i = 0; i < res.size(); ++i) res[i] = (rates_[1][i] - rates_[0][i]) / (2.0 * number.step);
}

void ForwardSensitivities::complete(std::size_t index, double xi, std::span<const double> y, std::span<double> s,
                                    std::span<double> ds) {
  Number& number = numbers_[index];
  for (std::size_t k = 0; k < 2; ++k) {
    Side& side = number.sides[k];
    const double distance = side.sign * number.step;
    const double own_xi = xi + distance * sigma_at(number, xi);
    for (std::size_t i = 0; i < y.size(); ++i) states_[k][i] = y[i] + distance * s[i];
    side.system().complete(own_xi, states_[k]);
    side.system().all_rates(own_xi, states_[k], rates_[k]);
    ++evaluations_;
  }
  for (std::size_t i = 0; i < y.size(); ++i) {
    if (base_.unknowns()[i].kind != Unknown::Kind::quadrature) {
      s[i] = (states_[1][i] - states_[0][i]) / (2.0 * number.step);
    }
    ds[i] = slope_of(number, i);
  }
}

/// ds/dxi of an unknown, from the neighbours' rates by their own xi.
double ForwardSensitivities::slope_of(const Number& number, std::size_t unknown) const noexcept {
  const double lower = rates_[0][unknown];
  const double upper = rates_[1][unknown];
  return (upper - lower) / (2.0 * number.step) + 0.5 * number.stretch * (upper + lower);
}

/// Sets the neighbours of a number to y - h s and y + h s, where the base is at xi.
/// @param beyond  d(xi)/dp by which they are moved farther, along the base's rates
void ForwardSensitivities::place(Number& number, double xi, std::span<const double> y, double beyond) {
  for (Side& side : number.sides) {
    const double distance = side.sign * number.step;
    std::ranges::copy(y, side.y.begin());
    for (std::size_t i = 0; i < size_; ++i) {
      side.y[i] += distance * (beyond == 0.0 ? number.s[i] : number.s[i] + beyond * base_rates_[i]);
    }
    expect_near(side, y);
    side.xi = xi + distance * (sigma_at(number, xi) + beyond);
    side.complete();
  }
}

/// Throws LostSensitivities if a neighbour is too far from the base for their difference to show a derivative.
void ForwardSensitivities::expect_near(const Side& side, std::span<const double> y) const {
  for (std::size_t i = 0; i < size_; ++i) {
    const Unknown& unknown = base_.unknowns()[i];
    if (std::abs(side.y[i] - y[i]) <= k_farthest * std::max(unknown.scale, std::abs(y[i]))) continue;
    throw LostSensitivities(
        fmt::format("the derivative of '{}' is so large that neighbouring runs part", unknown.name));
  }
}

/// Computes s and sigma from the neighbours' states and positions, where a segment begins.
void ForwardSensitivities::resume() {
  for (Number& number : numbers_) {
    Side& lower = number.sides[0];
    Side& upper = number.sides[1];
    for (std::size_t i = 0; i < number.s.size(); ++i) number.s[i] = (upper.y[i] - lower.y[i]) / (2.0 * number.step);
    number.sigma = (upper.xi - lower.xi) / (2.0 * number.step);
    number.stretch = 0.0;
    for (Side& side : number.sides) side.begin_segment();
  }
}

void ForwardSensitivities::start() {
  each_side([](Number&, Side& side) { side.system().start(side.y); });
  is_placed_ = true;
}

void ForwardSensitivities::begin_leg(std::size_t leg, const StepPlan& plan, std::span<const Event> log) {
  each_side([&](Number&, Side& side) {
    if (leg > 0) {
      for (std::size_t c = 0; c < side.resting_ramps.size(); ++c) {
        side.resting_ramps[c] = ramp_after(side.plan, side.system(), static_cast<int>(c), side.xi, plan.leg.is_first());
      }
    }
    side.plan = plan_leg(side.scene, leg, side.resting_ramps, side.guard_set, side.xi, side.y);
    side.clock = side.clock.next(side.xi, leg, side.plan.leg, side.plan.duration);
    side.xi = 0.0;
    std::vector<Event> of_side;
    side.system().begin_step(side.plan.ramps, side.y, of_side);
    side.expect_same_guards(base_, log, of_side);
    side.guard_set.begin_leg(side.plan.conditions, 0.0, side.y);
    if ((side.plan.duration > 0.0) != (plan.duration > 0.0)) {
      throw LostSensitivities("a step takes no time in one of the neighbouring runs");
    }
  });
  begin_ = 0.0;
  is_placed_ = true;
  resume();
}

void ForwardSensitivities::expect_met_at_begin(bool is_met) {
  each_side([is_met](Number&, Side& side) {
    if (side.guard_set.met_at_begin().has_value() == is_met) return;
    throw LostSensitivities("a condition that ends a step holds where it begins, in one of the neighbouring runs only");
  });
}

void ForwardSensitivities::leave_singularity(double xi) {
  each_side([](Number&, Side& side) { side.xi = side.system().leave_singularity(side.xi, side.y); });
  begin_ = xi;
  resume();
  is_placed_ = false;
}

bool ForwardSensitivities::may_end_branch() const {
  return is_active_ && std::ranges::any_of(base_.guards(), &Guard::is_branch_end);
}

bool ForwardSensitivities::aim(std::span<const std::size_t> fired, double xi, std::span<const double> y) {
  if (!is_branch_end(base_, fired)) return false;
  std::vector<double> sigma_ahead;
  beside([&] {
    for (Number& number : numbers_) {
      place(number, xi, y);
      for (Side& side : number.sides) side.go_to_guard(fired);
      evaluations_ += 2;
      sigma_ahead.push_back((number.sides[1].xi - number.sides[0].xi) / (2.0 * number.step));
      for (Side& side : number.sides) side.go_back();
    }
  });
  resume();
  for (std::size_t k = 0; k < numbers_.size(); ++k) {
    numbers_[k].stretch = (sigma_ahead[k] - numbers_[k].sigma) / (xi - begin_);
  }
  return true;
}

void ForwardSensitivities::locate(std::span<const std::size_t> fired, double xi, std::span<const double> y) {
  const bool has_end = is_branch_end(base_, fired);
  beside([&] {
    for (Number& number : numbers_) {
      place(number, xi, y);
      for (Side& side : number.sides) {
        // aim() has brought a neighbour to the end of its branch already.
        if (!has_end) side.go_to_guard(fired);
        evaluations_ += has_end ? 0 : 1;
        side.expect_no_other_guard(fired);
      }
    }
  });
  is_placed_ = true;
}

void ForwardSensitivities::fire(std::span<const std::size_t> of_system, std::span<const Event> log) {
  each_side([&](Number&, Side& side) {
    std::vector<Event> of_side;
    if (side.system().fire(of_system, side.xi, side.y, of_side)) {
      throw LostSensitivities("a neighbouring run ends at an event");
    }
    side.expect_same_guards(base_, log, of_side);
  });
}

void ForwardSensitivities::pass_mark(std::span<const std::size_t> of_system, double xi, std::span<const Event> log) {
  fire(of_system, log);
  begin_ = xi;
  resume();
}

void ForwardSensitivities::solve() {
  each_side([](Number&, Side& side) { side.system().solve(side.xi, side.y); });
}

void ForwardSensitivities::end_event(std::span<const std::size_t> fired, double xi, bool is_met) {
  each_side([&](Number&, Side& side) {
    const bool is_by_jump =
        std::ranges::none_of(fired, [&](std::size_t g) { return g >= side.guard_set.system_guards(); });
    if (is_by_jump && side.plan.ending_events.empty() && side.guard_set.is_met(side.xi, side.y) != is_met) {
      throw LostSensitivities("a neighbouring run does not end a step at an event");
    }
    if (is_met) side.guard_set.note_met(fired, side.xi, side.y);
    side.guard_set.renew();
  });
  begin_ = xi;
  resume();
}

void ForwardSensitivities::end_leg(std::span<const double> y, bool is_solved) {
  beside([&] {
    for (Number& number : numbers_) {
      if (!is_placed_) place(number, 1.0, y);
      for (Side& side : number.sides) {
        if (side.clock.duration > 0.0) side.move(1.0 - side.xi);
        side.xi = 1.0;
        if (is_solved && side.system().is_solvable()) side.system().solve(1.0, side.y);
        side.expect_no_other_guard({});
        side.guard_set.note_met({}, 1.0, side.y);
      }
    }
  });
  is_placed_ = true;
  resume();
}

void ForwardSensitivities::observe(Side& side) {
  side.system().observe(side.xi, side.y, values_[side.sign > 0.0 ? 1 : 0]);
}

/// Appends the derivatives of a number to the row.
/// @param of_time        d(time)/dp
/// @param beyond_slopes  d(xi)/dp by which the row is farther than the neighbours; the slopes of the observables extend
///   their derivatives by it
void ForwardSensitivities::add_to_row(Number& number, double of_time, double beyond_slopes) {
  for (Side& side : number.sides) observe(side);
  row_.push_back(of_time);
  for (const std::size_t c : columns_) {
    double value = (values_[1][c] - values_[0][c]) / (2.0 * number.step);
    if (beyond_slopes != 0.0) value += beyond_slopes * slope_[c];
    row_.push_back(value);
  }
}

/// Appends the truncation of the derivatives that add_to_row() has added, for d(time)/dp and every observable: next to
/// an event, an observable may begin or end like a square root. Its difference quotient is then too large by the share
/// r^2/2, where r is the ratio of its second difference to its first one. A larger second difference is round-off, or
/// that of a kink.
void ForwardSensitivities::add_truncation(const Number& number, double xi, std::span<const double> y) {
  std::ranges::copy(y, state_.begin());
  // The neighbours' work may come from its closed form, that of the base from the integrator.
  if (const auto work = number.sides[0].quadrature) {
    state_[*work] = std::midpoint(number.sides[0].y[*work], number.sides[1].y[*work]);
  }
  base_.complete(xi, state_);
  base_.observe(xi, state_, base_values_);
  const std::span<const double> derivatives = std::span(row_).last(columns_.size());
  truncation_.push_back(0.0);
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    const std::size_t c = columns_[k];
    const double first =
        std::max(0.5 * std::abs(values_[1][c] - values_[0][c]), std::abs(derivatives[k]) * number.step);
    const double second = std::abs(values_[1][c] - 2.0 * base_values_[c] + values_[0][c]);
    truncation_.push_back(second < first ? 0.5 * second * second / (first * number.step) : 0.0);
  }
}

/// Finds the errors that round-off of the instant makes in the derivatives that a row has: d(time)/dp and those of the
/// observables. An observable that begins like a square root at an event is known there only to the square root of
/// round-off.
void ForwardSensitivities::find_round_off(Number& number, std::span<double> round_off) {
  Side& side = number.sides[1];
  if (side.xi == 0.0 || side.xi == 1.0) return;  // the ends of a step are exact
  try {
    side.system().rates(side.xi, side.y, side.rates);
    if (!all_finite(side.rates)) return;
    observe(side);
    for (const double length : {-k_round_off, k_round_off}) {
      for (std::size_t i = 0; i < state_.size(); ++i) state_[i] = side.y[i] + length * side.rates[i];
      side.system().complete(side.xi + length, state_);
      side.system().observe(side.xi + length, state_, values_[0]);
      for (std::size_t c = 0; c < columns_.size(); ++c) {
        const double error = std::abs(values_[0][columns_[c]] - values_[1][columns_[c]]) / number.step;
        round_off[1 + c] = std::max(round_off[1 + c], error);
      }
    }
  } catch (const std::domain_error&) {
    return;  // the error is not known where the equations end
  }
}

/// Appends these errors to the row. A derivative that an event leaves as it is keeps its error: after pull-off, the
/// displacement under force is the one at the end of the branch.
void ForwardSensitivities::add_round_off_to_row(Number& number) {
  const std::size_t width = 1 + columns_.size();
  const std::size_t begin = row_.size();
  row_.resize(begin + width, 0.0);
  const std::span<double> round_off = std::span(row_).subspan(begin);
  find_round_off(number, round_off);
  const auto index = static_cast<std::size_t>(&number - numbers_.data());
  const std::span<const double> derivatives = std::span(row_).subspan(index * width, width);
  Side& side = number.sides[1];
  for (std::size_t c = 0; c < side.derivatives.size(); ++c) {
    const bool is_kept = derivatives[c] != 0.0 && derivatives[c] == side.derivatives[c];
    if (is_kept) round_off[c] = std::max(round_off[c], side.round_off[c]);
  }
  side.derivatives.assign(derivatives.begin(), derivatives.end());
  side.round_off.assign(round_off.begin(), round_off.end());
}

std::span<const double> ForwardSensitivities::row_here() {
  row_.clear();
  beside([&] {
    for (Number& number : numbers_) {
      add_to_row(number, (number.sides[1].time() - number.sides[0].time()) / (2.0 * number.step));
    }
    for (Number& number : numbers_) add_round_off_to_row(number);
  });
  return row_;
}

/// Slopes of the observables along the base's rates, by differences of fourth order.
void ForwardSensitivities::find_slopes(double xi, std::span<const double> y) {
  // Curves may be singular where the segment ends, which is not known here, and where it begins. Both lengths are as
  // small as round-off of the observables allows.
  constexpr double k_longest = 2e-7;
  constexpr double k_share = 0.03;  // of the distance from the segment's beginning
  const auto difference = [&](double length) {
    for (std::size_t k = 0; k < 2; ++k) {
      const double by = k == 0 ? -length : length;
      for (std::size_t i = 0; i < y.size(); ++i) state_[i] = y[i] + by * base_rates_[i];
      base_.complete(xi + by, state_);
      base_.observe(xi + by, state_, values_[k]);
    }
  };
  const double length = shift_within_domain(std::min(k_longest, k_share * (xi - begin_)), difference);
  for (std::size_t c = 0; c < slope_.size(); ++c) slope_[c] = -(values_[1][c] - values_[0][c]) / (6.0 * length);
  difference(0.5 * length);
  for (std::size_t c = 0; c < slope_.size(); ++c) slope_[c] += 4.0 * (values_[1][c] - values_[0][c]) / (3.0 * length);
}

std::span<const double> ForwardSensitivities::row_at(double xi, std::span<const double> y, const StepClock& clock) {
  // Up to this share of the segment so far, the neighbours are moved to the instant of the row along straight lines;
  // farther away, the curvature is too large.
  constexpr double k_short = 1e-5;
  row_.clear();
  truncation_.clear();
  const double time = clock.time(xi);
  beside([&] {
    bool has_slopes = false;
    base_.rates(xi, y, base_rates_);
    for (Number& number : numbers_) {
      std::array<double, 2> own_xi{};
      for (std::size_t k = 0; k < 2; ++k) {
        own_xi[k] = number.sides[k].clock.step_coordinate(time);
      }
      const double beyond = (own_xi[1] - own_xi[0]) / (2.0 * number.step) - sigma_at(number, xi);
      const bool is_near = std::abs(beyond) * number.step <= k_short * (xi - begin_);
      if (!is_near && !has_slopes) find_slopes(xi, y);
      has_slopes = has_slopes || !is_near;
      place(number, xi, y, is_near ? beyond : 0.0);
      add_to_row(number, 0.0, is_near ? 0.0 : beyond);
      add_truncation(number, xi, y);
    }
  });
  row_.insert(row_.end(), truncation_.begin(), truncation_.end());
  is_placed_ = false;
  return row_;
}

}  // namespace monograin
