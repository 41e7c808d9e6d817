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

/// gnuplot's line of a phase: loading solid, unloading dashed, reloading as dots wider than the line, which show on top
/// of dashes where both lines take the same path.
[[nodiscard]] std::string phase_line(const Stroke& stroke, Phase phase);
/// gnuplot's line with a dash type of its own.
[[nodiscard]] std::string dashed_line(const Stroke& stroke, std::string_view dash);

/// Gives each contact class its colour and each run its shade and width; runs with one class in all differ in colour.
class Palette {
 public:
  explicit Palette(const std::vector<RunCurves>& runs);

  [[nodiscard]] const std::vector<std::string>& contacts() const noexcept { return contacts_; }

  [[nodiscard]] Stroke contact_line(std::size_t run, std::string_view contact) const;
  /// The line of what belongs to the particle.
  [[nodiscard]] Stroke particle_line(std::size_t run) const;

 private:
  [[nodiscard]] Stroke line(std::size_t run, unsigned colour) const;
  [[nodiscard]] bool colours_tell_runs() const noexcept { return run_count_ > 1 && contacts_.size() == 1; }

  std::size_t run_count_;
  std::vector<std::string> contacts_;
};

/// Colours (0xRRGGBB) and gnuplot's point types, told apart in colour-blindness and in grey print. After six places the
/// colours come again darker, after twelve paler; after eighteen, and the points after fifteen, they repeat.
[[nodiscard]] unsigned colour_of(std::size_t place) noexcept;
[[nodiscard]] int point_of(std::size_t place) noexcept;
/// For what has no colour of its own.
inline constexpr unsigned k_neutral_colour = 0x303030u;

/// gnuplot's style of the marks of the event with that place in the legend.
[[nodiscard]] std::string event_points(std::size_t place);

struct LegendRow {
  struct Entry {
    std::string title;  ///< gnuplot's enhanced text
    std::string style;  ///< from `with` on
  };
  std::string heading;
  std::vector<Entry> entries;
};

/// Characters that an enhanced text shows.
[[nodiscard]] std::size_t shown_length(std::string_view enhanced);

/// Contacts, runs, phases and events; a row that would tell nothing is left out.
[[nodiscard]] std::vector<LegendRow> legend_rows(const std::vector<RunCurves>& runs, const Palette& palette);
/// Lines the rows take in a legend of that width.
[[nodiscard]] std::size_t line_count(const std::vector<LegendRow>& rows, double width_cm);
/// gnuplot commands that draw the legend in its place.
[[nodiscard]] std::string legend_text(const std::vector<LegendRow>& rows, const Layout& layout);

}  // namespace monograin::figure
