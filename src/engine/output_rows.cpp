#include "engine/output_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "system/resolution.hpp"

namespace monograin {
namespace {

// Step coordinate of the output point at the end of a step that may end early, wherever that will be.
constexpr double k_at_end = k_infinity;

/// True if one time [s] lies after another one by more than round-off.
bool is_later(double time, double other) { return time > other * (1.0 + k_same_value); }

}  // namespace

OutputRows::OutputRows(const Output& output, const StepClock& clock, Integrator& integrator, HistorySink& sink,
                       ForwardSensitivities* sensitivities, std::size_t unknowns)
    : output_(output),
      clock_(clock),
      integrator_(integrator),
      sink_(sink),
      sensitivities_(sensitivities),
      state_(unknowns) {
  points_.reserve(output.times.empty() ? static_cast<std::size_t>(output.points) : output.times.size());
}

double OutputRows::least_length() const noexcept { return output_.points * k_same_instant; }

void OutputRows::begin_leg() { points_.clear(); }

void OutputRows::place(const Leg& leg, double end, bool may_end_elsewhere) {
  next_ = 0;
  const auto count = static_cast<double>(output_.points);
  // A table has as many legs as rows: points before the leg are skipped.
  const double first = end > 0.0 ? std::max(1.0, std::min(count, std::floor(leg.begin / end * count))) : count;
  for (int j = static_cast<int>(first); output_.times.empty() && j <= output_.points; ++j) {
    const double share = end * (static_cast<double>(j) / count);
    if (share > leg.end + k_same_instant) break;
    if (!leg.is_first() && share <= leg.begin + k_same_instant) continue;
    const double xi = std::min(1.0, (share - leg.begin) / (leg.end - leg.begin));
    points_.push_back({xi, clock_.time(xi)});
    if (may_end_elsewhere && j == output_.points) points_.back().xi = k_at_end;
  }
  // The margin is one of times, so that an instant beside the end of a leg belongs to this leg or to the next one. Step
  // coordinates of a short leg that begins late have the round-off of its times over its duration.
  const double begin_of_leg = clock_.time(0.0);
  const double end_of_leg = clock_.time(1.0);
  for (const double instant : output_.times) {
    if (clock_.duration == 0.0) break;
    if (!is_later(instant, begin_of_leg) || is_later(instant, end_of_leg)) continue;
    const double xi = clock_.step_coordinate(instant);
    const bool is_at_end = !is_later(end_of_leg, instant) || xi > 1.0 - k_same_instant;
    points_.push_back({is_at_end ? 1.0 : xi, instant});
  }
}

void OutputRows::end_leg(double xi) {
  if (next_ + 1 == points_.size() && points_.back().xi == k_at_end) points_.back().xi = xi;
}

std::optional<std::string> OutputRows::note_unreached_times(double end) const {
  const auto is_beyond = [end](double instant) { return is_later(instant, end); };
  const auto count = std::ranges::count_if(output_.times, is_beyond);
  if (count == 0) return std::nullopt;
  return fmt::format("{} of {} output times lie{} beyond the end of the program, t = {:.9g} s: no rows there", count,
                     output_.times.size(), count == 1 ? "s" : "", end);
}

void OutputRows::write_before(double last, double xi) {
  if (has_internal_steps() && xi < 1.0 && integrator_.fired().empty()) write_output({xi, clock_.time(xi)});
  for (; next_ < points_.size() && points_[next_].xi < xi - k_same_instant; ++next_) {
    // A point that lies before the integrator's last step by round-off is evaluated where that step began.
    write_output({std::max(points_[next_].xi, last), points_[next_].time});
  }
}

void OutputRows::write_output(const Point& point) {
  integrator_.dense_output(point.xi, state_);
  std::span<const double> derivatives;
  if (sensitivities_ != nullptr) {
    integrator_.dense_sensitivities(point.xi);
    derivatives = sensitivities_->row_at(point.xi, state_, clock_);
  }
  if (is_buffering_)
    buffer_.push_back({point, state_, {derivatives.begin(), derivatives.end()}});
  else
    write(point, state_, derivatives);
}

void OutputRows::write(const Point& point, std::span<const double> y, std::span<const double> derivatives) {
  sink_.observe(point.time, clock_.step_label(), point.xi, y);
  sink_.take_derivatives(derivatives);
  sink_.append(RowSide::output);
}

void OutputRows::observe(double xi, std::span<const double> y) {
  sink_.observe(clock_.time(xi), clock_.step_label(), xi, y);
  if (sensitivities_ != nullptr) sink_.take_derivatives(sensitivities_->row_here());
}

void OutputRows::write_first(std::span<const double> y, std::span<const Event> events) {
  observe(0.0, y);
  if (!events.empty()) sink_.append(RowSide::before);
  sink_.append(RowSide::output);
  if (!events.empty()) close_instant(0.0, y, events);
}

void OutputRows::open_instant(double xi, std::span<const double> y) {
  if (is_paused_) return;
  reach_joint(xi, y);
  pass_joint(true);
}

void OutputRows::reach_joint(double xi, std::span<const double> y) {
  observe(xi, y);
  reached_ = xi;
}

void OutputRows::pass_joint(bool has_events) {
  if (has_events) sink_.append(RowSide::before);
  for (; next_ < points_.size() && points_[next_].xi <= reached_ + k_same_instant; ++next_) {
    sink_.append(RowSide::output);
  }
}

void OutputRows::close_instant(double xi, std::span<const double> y, std::span<const Event> events) {
  if (is_paused_) return;
  observe(xi, y);
  sink_.append(RowSide::after);
  for (const Event& event : events) sink_.event(event);
}

void OutputRows::buffer() {
  is_buffering_ = true;
  first_buffered_ = next_;
}

void OutputRows::drop_buffer() {
  is_buffering_ = false;
  next_ = first_buffered_;
  buffer_.clear();
}

void OutputRows::flush_buffer() {
  is_buffering_ = false;
  for (const BufferedRow& row : std::exchange(buffer_, {})) write(row.point, row.state, row.derivatives);
}

}  // namespace monograin
