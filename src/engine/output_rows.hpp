/// The rows of a history.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/drive.hpp"
#include "engine/forward_sensitivities.hpp"
#include "engine/integrator.hpp"
#include "engine/step_clock.hpp"

namespace monograin {

/// Writes the rows of a history to a sink: those at output points, and those just before and after events and corners.
class OutputRows {
 public:
  /// @param clock          where the run stands; the owner moves it on
  /// @param sensitivities  derivatives that the rows have; null: none
  OutputRows(const Output& output, const StepClock& clock, Integrator& integrator, HistorySink& sink,
             ForwardSensitivities* sensitivities, std::size_t unknowns);

  /// True if output points divide a step evenly up to its end, which must be known before they are placed.
  [[nodiscard]] bool needs_end_of_step() const noexcept { return output_.times.empty() && output_.points > 1; }
  /// Shortest length of a step that has room for rows; a shorter one is round-off.
  [[nodiscard]] double least_length() const noexcept;

  /// Forgets the output points of the last leg.
  void begin_leg();
  /// Places the output points of a step that lie in the present leg.
  /// @param end                share of the step's time at which the step ends
  /// @param may_end_elsewhere  the last point is wherever the step will end
  void place(const Leg& leg, double end, bool may_end_elsewhere);
  /// Puts that last point where the step has ended.
  void end_leg(double xi);

  /// Note about output times beyond the end [s] of the program; none if there are none.
  [[nodiscard]] std::optional<std::string> note_unreached_times(double end) const;

  /// Nothing is written between pause() and resume().
  void pause() noexcept { is_paused_ = true; }
  void resume() noexcept { is_paused_ = false; }

  /// Writes the rows of the output points before xi, all of them within the integrator's last step.
  /// @param last  step coordinate where that step began
  void write_before(double last, double xi);
  /// Writes the first row of the history, before anything can have jumped.
  /// @param events  those of the first instant
  void write_first(std::span<const double> y, std::span<const Event> events);
  /// Writes the row just before an event or corner, and the row of an output point that falls on it.
  void open_instant(double xi, std::span<const double> y);
  /// Notes the state where one leg of a curve ends and the next one begins. That is no corner of the program.
  void reach_joint(double xi, std::span<const double> y);
  /// Writes the row of an output point that falls there; also the row just before the events of the next leg, if it has
  /// any.
  void pass_joint(bool has_events);
  /// Writes the row just after an event or corner, and the events between the rows.
  void close_instant(double xi, std::span<const double> y, std::span<const Event> events);

  /// Collects the rows of output points from here on, and does not write them yet.
  void buffer();
  /// Forgets the rows in the buffer; their output points come again.
  void drop_buffer();
  /// Writes the rows in the buffer, and those that follow at once.
  void flush_buffer();

 private:
  /// An output point of the present leg.
  struct Point {
    double xi = 0.0;
    double time = 0.0;
  };
  struct BufferedRow {
    Point point;
    std::vector<double> state;
    std::vector<double> derivatives;
  };
  [[nodiscard]] bool has_internal_steps() const noexcept { return output_.times.empty() && output_.points == 0; }
  void write_output(const Point& point);
  void write(const Point& point, std::span<const double> y, std::span<const double> derivatives);
  void observe(double xi, std::span<const double> y);

  const Output& output_;
  const StepClock& clock_;
  Integrator& integrator_;
  HistorySink& sink_;
  ForwardSensitivities* sensitivities_;
  std::vector<Point> points_;
  std::size_t next_ = 0;  ///< first point that is not written yet
  double reached_ = 0.0;  ///< where the present instant was opened
  bool is_paused_ = false;
  bool is_buffering_ = false;
  std::size_t first_buffered_ = 0;  ///< output point
  std::vector<BufferedRow> buffer_;
  std::vector<double> state_;  ///< at an output point
};

}  // namespace monograin
