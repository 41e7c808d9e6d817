/// Line styles of runs, contacts, phases and events, and the legend that explains them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "figure/panels.hpp"
#include "figure/run_curves.hpp"

namespace monograin::figure {

struct Stroke {
  unsigned colour;  ///< 0xRRGGBB
  double width;
  std::size_t mark;      ///< number of the sparse points on the line, which also differ in grey print; 0: none
  bool is_open = false;  ///< the points are open
};

/// gnuplot's line of a phase: loading solid, unloading dashed, reloading as dots wider than the line and without marks,
/// which remain visible on top of dashes where both lines coincide.
[[nodiscard]] std::string phase_line(const Stroke& stroke, Phase phase);
/// gnuplot's line with a dash type of its own.
[[nodiscard]] std::string dashed_line(const Stroke& stroke, std::string_view dash);

/// Gives each contact class of one run a colour and marks. With several runs, each run has marks, a shade and a width,
/// and each class a colour; marks of the first class are filled, those of others open. If all runs together have one
/// class, runs differ in colour and marks.
class Palette {
 public:
  explicit Palette(const std::vector<RunCurves>& runs);

  [[nodiscard]] const std::vector<std::string>& contacts() const noexcept { return contacts_; }

  [[nodiscard]] Stroke contact_line(std::size_t run, std::string_view contact) const;
  /// Line of a quantity of the particle.
  [[nodiscard]] Stroke particle_line(std::size_t run) const;

 private:
  [[nodiscard]] Stroke line(std::size_t run, unsigned colour, std::size_t mark, bool is_open) const;
  [[nodiscard]] bool colours_tell_runs() const noexcept { return run_count_ > 1 && contacts_.size() == 1; }

  std::size_t run_count_;
  std::vector<std::string> contacts_;
};

/// Colour (0xRRGGBB) with a number; colours differ for the colour-blind. After six numbers the
/// colours come again darker, after twelve paler; after eighteen they repeat.
[[nodiscard]] unsigned colour_of(std::size_t place) noexcept;
/// gnuplot's point type with a number; the types repeat after fifteen.
[[nodiscard]] int point_of(std::size_t place) noexcept;
/// Colour of items without a colour of their own.
inline constexpr unsigned k_neutral_colour = 0x303030u;

/// gnuplot's style of the points at an event: each name has one symbol, in every figure.
[[nodiscard]] std::string event_points(std::string_view name);

struct LegendRow {
  struct Entry {
    std::string title;  ///< gnuplot's enhanced text
    std::string style;  ///< gnuplot's plot style, beginning with `with`
  };
  std::string heading;
  std::vector<Entry> entries;
};

/// Rows for contacts, runs, phases and events; rows that distinguish nothing are left out.
[[nodiscard]] std::vector<LegendRow> legend_rows(const std::vector<RunCurves>& runs, const Palette& palette);
/// Number of lines that rows take in a legend of a given width.
[[nodiscard]] std::size_t line_count(const std::vector<LegendRow>& rows, double width_cm);
/// Arranges panels and the legend of the rows on the page.
[[nodiscard]] Layout layout_of(std::size_t panel_count, const std::vector<LegendRow>& rows);
/// gnuplot commands that draw the legend in its box of the layout.
[[nodiscard]] std::string legend_text(const std::vector<LegendRow>& rows, const Layout& layout);

}  // namespace monograin::figure
