/// Line styles of runs, contacts, phases and events, and the legend that explains them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "figure/panels.hpp"
#include "figure/run_curves.hpp"

namespace monograin::figure {

/// Gives each contact class its colour and each run its shade and width; runs with one class in all differ in colour.
class Palette {
 public:
  explicit Palette(const std::vector<RunCurves>& runs);

  [[nodiscard]] const std::vector<std::string>& contacts() const noexcept { return contacts_; }

  /// gnuplot's colour and width of a contact's curve.
  [[nodiscard]] std::string contact_line(std::size_t run, std::string_view contact) const;
  /// The same for what belongs to the particle.
  [[nodiscard]] std::string particle_line(std::size_t run) const;

 private:
  [[nodiscard]] std::string line(std::size_t run, unsigned colour) const;
  [[nodiscard]] bool colours_tell_runs() const noexcept { return run_count_ > 1 && contacts_.size() == 1; }

  std::size_t run_count_;
  std::vector<std::string> contacts_;
};

/// Colours (0xRRGGBB) and gnuplot's point types, told apart in colour-blindness and in grey print; they come round
/// again.
[[nodiscard]] unsigned colour_of(std::size_t place) noexcept;
[[nodiscard]] int point_of(std::size_t place) noexcept;
/// For what has no colour of its own.
inline constexpr unsigned k_neutral_colour = 0x303030u;

/// gnuplot's dash type of a phase.
[[nodiscard]] std::string_view dash(Phase phase) noexcept;
/// gnuplot's style of the marks of the event with that place in the legend.
[[nodiscard]] std::string event_points(std::size_t place);

struct LegendRow {
  struct Entry {
    std::string title;
    std::string style;  ///< from `with` on
  };
  std::string heading;
  std::vector<Entry> entries;
};

/// Contacts, runs, phases and events; a row that would tell nothing is left out.
[[nodiscard]] std::vector<LegendRow> legend_rows(const std::vector<RunCurves>& runs, const Palette& palette);
/// Lines the rows take in a legend of that width.
[[nodiscard]] std::size_t line_count(const std::vector<LegendRow>& rows, double width_cm);
/// gnuplot commands that draw the legend in its place.
[[nodiscard]] std::string legend_text(const std::vector<LegendRow>& rows, const Layout& layout);

}  // namespace monograin::figure
