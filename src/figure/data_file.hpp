/// The numbers behind a figure, as gnuplot reads them.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "figure/panels.hpp"
#include "figure/run_curves.hpp"

namespace monograin::figure {

/// Name of the data block with one contact of one run (counted from 0) in one phase.
[[nodiscard]] std::string block_name(std::size_t run, const std::string& contact, Phase phase);
/// Name of the data block with all marks of one kind of event.
[[nodiscard]] std::string block_name(const std::string& event);

/// Column of the data file, counted from 1 as gnuplot does; column 1 is the displacement.
[[nodiscard]] constexpr std::size_t data_column(Quantity quantity) noexcept {
  return static_cast<std::size_t>(quantity) + 2;
}

/// Whether an event is marked in the panel of a quantity: those of contacts on the contact's curves, those of the
/// particle on its apparent radius.
[[nodiscard]] bool is_marked(const EventMark& mark, Quantity quantity);

/// The names of all events, in the order in which they first happen.
[[nodiscard]] std::vector<std::string> event_names(const std::vector<RunCurves>& runs);

/// Whether a phase has any way to draw.
[[nodiscard]] bool has_phase(const std::vector<Phase>& phases, Phase phase);

/// A number as a cell of the file; where it is undefined the line breaks.
void append_number(std::string& text, double value);

/// The lines of a block with the rows in one phase: each piece begins where the phase before it ended, after a blank
/// line.
template <class AppendRow>
void append_phase(std::string& text, const std::vector<Phase>& phases, Phase phase, AppendRow append_row) {
  for (std::size_t row = 1; row < phases.size(); ++row) {
    if (phases[row] != phase) continue;
    const bool goes_on = row > 1 && phases[row - 1] == phase;
    if (!goes_on) {
      text += '\n';
      append_row(row - 1);
    }
    append_row(row);
  }
}

/// Comment lines with references, each once.
[[nodiscard]] std::string reference_lines(std::span<const std::string> references);

/// All blocks: each is headed by its name, ends with two blank lines, and is cut by single ones where the line breaks.
[[nodiscard]] std::string data_text(const std::vector<RunCurves>& runs, const Scales& scales);

[[nodiscard]] std::string_view phase_name(Phase phase) noexcept;

}  // namespace monograin::figure
