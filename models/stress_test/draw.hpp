/// Materials, options and programs that the stress test draws for a model, dimensionless. Lengths are over R0, stresses
/// over a unit of stress S, forces over S R0^2.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stress_test/dice.hpp"
#include "system/keys.hpp"
#include "system/model_input.hpp"

namespace monograin {

/// A material from the whole admissible space of a model, or from its edges.
struct DrawnMaterial {
  std::string_view configuration;              ///< empty where the model has none
  std::span<const Term> events;                ///< events of the model
  std::map<std::string, double> values;        ///< stresses in S, surface energies in S R0
  std::map<std::string, OptionValue> options;  ///< those that differ from their defaults, `[material]` ones included
};

/// Bounds within which the programs of a scene are drawn.
struct ProgramBounds {
  double deepest = 0.45;  ///< largest displacement of an ordinary step in R0; or strain, or packing fraction
  double force = 1.0;     ///< typical force of a wall at that displacement, in S R0^2; or stress in S
  double tension = 0.0;   ///< tensile force of the order of pull-off, in S R0^2
  bool only_loads = false;
  double start = 0.0;  ///< packing fraction at the start
};

/// A step of the program of a model without walls.
struct DrawnStep {
  std::optional<Control> control{};  ///< none: a hold
  double target = 0.0;
  std::optional<Prescription> lateral{};
  double pace = 1.0;  ///< duration [s]; with has_rate, the rate in units of the target per second
  bool has_rate = false;
  std::string until{};  ///< key of a condition; empty: none
  double until_value = 0.0;
  std::string until_event{};
};

/// Draws a Poisson's ratio of at most `upper`: ordinary values up to 0.49, and the edges.
[[nodiscard]] double draw_poisson_ratio(Dice& dice, double upper);

/// Draws words and switches of options, and writes those that differ from the defaults.
void draw_choices(Dice& dice, std::span<const OptionKey> options, DrawnMaterial& drawn);

/// Name of the file that stands for an option of kind file in drawn scenes: the stress test writes the option's example
/// there.
[[nodiscard]] std::string example_file_name(std::string_view option);

/// Draws a program, one in twelve of its steps a hold.
/// @param usual  usual duration of a step [s]
/// @param count  number of steps
/// @param ramp   (step, index): draws what a step does that is no hold
template <class Ramp>
[[nodiscard]] std::vector<DrawnStep> draw_steps(Dice& dice, double usual, std::size_t count, Ramp&& ramp);

/// Draws a duration [s]: the usual one within a factor of ten, or any within twelve orders of magnitude of a second.
[[nodiscard]] double draw_duration(Dice& dice, double usual);

/// Gives a step a rate instead of its duration.
void give_rate(DrawnStep& step);

/// Name of one of the events that a step may wait for, drawn at random.
[[nodiscard]] std::string_view draw_event(Dice& dice, std::span<const Term> events);

/// Rows of numbers under a line of headings, as comma-separated text.
[[nodiscard]] std::string csv_text(std::string_view headings, const std::vector<std::vector<double>>& rows);

template <class Ramp>
std::vector<DrawnStep> draw_steps(Dice& dice, double usual, std::size_t count, Ramp&& ramp) {
  std::vector<DrawnStep> program(count);
  for (std::size_t i = 0; i < count; ++i) {
    program[i].pace = draw_duration(dice, usual);
    if (!dice.happens(0.08)) ramp(program[i], i);
  }
  return program;
}

}  // namespace monograin
