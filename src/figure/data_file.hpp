/// The data file of a figure of runs, in gnuplot's format.
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

/// True if an event is marked in the panel of a quantity. Events of contacts are marked on the contact's curves, events
/// of the particle on its apparent radius.
[[nodiscard]] bool is_marked(const EventMark& mark, Quantity quantity);

/// The names of all events, in the order in which they first happen.
[[nodiscard]] std::vector<std::string> event_names(const std::vector<RunCurves>& runs);

/// True if any row is in a phase, so that there is a line to draw.
[[nodiscard]] bool has_phase(const std::vector<Phase>& phases, Phase phase);

/// Appends a number as a cell of the file; an undefined number makes a gap in the line.
void append_number(std::string& text, double value);

/// Appends the rows in one phase to a block. Each piece begins, after a blank line, with the row at which the phase
/// before it ended.
/// @param append_row  appends the row with a given index
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

/// Comment lines with references, each of them once.
[[nodiscard]] std::string reference_lines(std::span<const std::string> references);

/// All blocks of the file. Each one begins with its name and ends with two blank lines; a single blank line makes a gap
/// in the line.
[[nodiscard]] std::string data_text(const std::vector<RunCurves>& runs, const Scales& scales);

[[nodiscard]] std::string_view phase_name(Phase phase) noexcept;

}  // namespace monograin::figure
