#include "figure/data_file.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "figure/gnuplot.hpp"

namespace monograin::figure {
namespace {

/// One point. Quantities for which `is_shown` is false are left undefined.
template <class IsShown>
void append_state(std::string& text, const RunCurves& run, const ContactState& state, const Scales& scales,
                  IsShown is_shown) {
  append_number(text, scales.displacement(run, state.displacement));
  for (const Quantity quantity : k_quantities) {
    text += ' ';
    append_number(text, is_shown(quantity) ? scales.value(run, quantity, state[quantity]) : std::nan(""));
  }
  text += '\n';
}

void append_events(std::string& text, const std::vector<RunCurves>& runs, const std::string& name,
                   const Scales& scales) {
  for (const RunCurves& run : runs) {
    for (const EventMark& mark : run.events) {
      if (mark.name != name) continue;
      append_state(text, run, mark.state, scales, [&](Quantity quantity) { return is_marked(mark, quantity); });
    }
  }
}

}  // namespace

void append_number(std::string& text, double value) {
  if (std::isfinite(value)) {
    fmt::format_to(std::back_inserter(text), "{:.10g}", value);
  } else {
    text += "NaN";  // a gap in the line
  }
}

std::string_view phase_name(Phase phase) noexcept {
  switch (phase) {
    case Phase::loading:
      return "loading";
    case Phase::unloading:
      return "unloading";
    case Phase::reloading:
      return "reloading";
  }
  return {};
}

std::string block_name(std::size_t run, const std::string& contact, Phase phase) {
  return plain_text(fmt::format("run {} {} {}", run + 1, contact, phase_name(phase)));
}

// The full stop keeps gnuplot, which compares beginnings, from taking one name for another.
std::string block_name(const std::string& event) { return plain_text(fmt::format("event {}.", event)); }

bool is_marked(const EventMark& mark, Quantity quantity) {
  const bool is_of_particle = mark.contact_class.empty();
  return is_of_particle == (quantity == Quantity::apparent_radius) && std::isfinite(mark.state[quantity]);
}

std::vector<std::string> event_names(const std::vector<RunCurves>& runs) {
  std::vector<std::string> names;
  for (const RunCurves& run : runs) {
    for (const EventMark& mark : run.events) {
      const bool is_shown = std::ranges::any_of(k_quantities, [&](Quantity q) { return is_marked(mark, q); });
      if (is_shown && std::ranges::find(names, mark.name) == names.end()) names.push_back(mark.name);
    }
  }
  return names;
}

bool has_phase(const std::vector<Phase>& phases, Phase phase) {
  return !phases.empty() && std::find(std::next(phases.begin()), phases.end(), phase) != phases.end();
}

std::string reference_lines(std::span<const std::string> references) {
  std::string text;
  for (auto it = references.begin(); it != references.end(); ++it) {
    if (std::find(references.begin(), it, *it) == it) text += fmt::format("# reference: {}\n", plain_text(*it));
  }
  return text;
}

std::string data_text(const std::vector<RunCurves>& runs, const Scales& scales) {
  std::string text = fmt::format("# columns: {}", scales.displacement_label());
  for (const Quantity quantity : k_quantities) text += "; " + scales.label(quantity);
  text += '\n';
  std::vector<std::string> references;
  for (const RunCurves& run : runs) references.insert(references.end(), run.references.begin(), run.references.end());
  text += reference_lines(references);
  for (std::size_t k = 0; k < runs.size(); ++k) {
    text += fmt::format("# run {}: {}\n", k + 1, plain_text(runs[k].name));
    for (const ContactCurve& contact : runs[k].contacts) {
      for (const Phase phase : k_phases) {
        if (!has_phase(runs[k].phases, phase)) continue;
        text += fmt::format("\n\n# {}", block_name(k, contact.name, phase));
        append_phase(text, runs[k].phases, phase, [&](std::size_t row) {
          append_state(text, runs[k], contact.states[row], scales, [](Quantity) { return true; });
        });
      }
    }
  }
  for (const std::string& name : event_names(runs)) {
    text += fmt::format("\n\n# {}\n", block_name(name));
    append_events(text, runs, name, scales);
  }
  return text;
}

}  // namespace monograin::figure
