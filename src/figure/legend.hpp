/// Line styles of runs, contacts, phases and events, and the legend that explains them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "figure/panels.hpp"
#include "figure/run_curves.hpp"

namespace monograin::figure {

/// Colour (0xRRGGBB) and width of a line.
struct Stroke {
  unsigned colour;
  double width;
};

/// gnuplot's line of a phase: loading solid, unloading dashed, reloading as dots wider than the line, which remain
/// visible on top of dashes where both lines coincide.
[[nodiscard]] std::string phase_line(const Stroke& stroke, Phase phase);
/// gnuplot's line with a dash type of its own.
[[nodiscard]] std::string dashed_line(const Stroke& stroke, std::string_view dash);

/// Gives each contact class a colour, and each run a shade and a width. If all runs together have one class, runs
/// differ in colour.
class Palette {
 public:
  explicit Palette(const std::vector<RunCurves>& runs);

  [[nodiscard]] const std::vector<std::string>& contacts() const noexcept { return contacts_; }

  [[nodiscard]] Stroke contact_line(std::size_t run, std::string_view contact) const;
  /// Line of a quantity of the particle.
  [[nodiscard]] Stroke particle_line(std::size_t run) const;

 private:
  [[nodiscard]] Stroke line(std::size_t run, unsigned colour) const;
  [[nodiscard]] bool colours_tell_runs() const noexcept { return run_count_ > 1 && contacts_.size() == 1; }

  std::size_t run_count_;
  std::vector<std::string> contacts_;
};

/// Colour (0xRRGGBB) with a number; colours differ for the colour-blind and in grey print. After six numbers the
/// colours come again darker, after twelve paler; after eighteen they repeat.
[[nodiscard]] unsigned colour_of(std::size_t place) noexcept;
/// gnuplot's point type with a number; the types repeat after fifteen.
[[nodiscard]] int point_of(std::size_t place) noexcept;
/// Colour of items without a colour of their own.
inline constexpr unsigned k_neutral_colour = 0x303030u;

/// gnuplot's style of the marks of an event. @param place  number of the event in the legend
[[nodiscard]] std::string event_points(std::size_t place);

struct LegendRow {
  struct Entry {
    std::string title;  ///< gnuplot's enhanced text
    std::string style;  ///< gnuplot's plot style, beginning with `with`
  };
  std::string heading;
  std::vector<Entry> entries;
};

/// Number of visible characters of an enhanced text.
[[nodiscard]] std::size_t shown_length(std::string_view enhanced);

/// Rows for contacts, runs, phases and events; rows that distinguish nothing are left out.
[[nodiscard]] std::vector<LegendRow> legend_rows(const std::vector<RunCurves>& runs, const Palette& palette);
/// Number of lines that rows take in a legend of a given width.
[[nodiscard]] std::size_t line_count(const std::vector<LegendRow>& rows, double width_cm);
/// gnuplot commands that draw the legend in its box of the layout.
[[nodiscard]] std::string legend_text(const std::vector<LegendRow>& rows, const Layout& layout);

}  // namespace monograin::figure
