#include "stress_test/draw.hpp"

#include <algorithm>

#include "system/awaited_events.hpp"
#include "system/number_text.hpp"

namespace monograin {

double draw_poisson_ratio(Dice& dice, double upper) {
  const double ordinary = dice.uniform(0.0, 0.49);
  const double odd = dice.one_of({0.0, 0.2, 0.3, 0.49, 0.4999, upper});
  return std::min(dice.happens(0.5) ? ordinary : odd, upper);
}

void draw_choices(Dice& dice, std::span<const OptionKey> options, DrawnMaterial& drawn) {
  for (const OptionKey& option : options) {
    if (option.kind == OptionKey::Kind::choice) {
      const std::size_t which = dice.below(option.choices.size());
      if (which > 0) drawn.options[std::string(option.name)] = std::string(option.choices[which]);
    } else if (option.kind == OptionKey::Kind::toggle && dice.happens(0.25)) {
      drawn.options[std::string(option.name)] = !option.default_toggle;
    }
  }
}

std::string example_file_name(std::string_view option) { return std::string(option) + ".csv"; }

double draw_duration(Dice& dice, double usual) {
  return dice.happens(0.1) ? dice.log_uniform(1e-12, 1e12) : usual * dice.log_uniform(0.1, 10.0);
}

void give_rate(DrawnStep& step) {
  step.has_rate = true;
  step.pace = 1.0 / step.pace;
}

std::string_view draw_event(Dice& dice, std::span<const Term> events) {
  const std::vector<std::string_view> names = events_to_wait_for(events);
  return names[dice.below(names.size())];
}

std::string csv_text(std::string_view headings, const std::vector<std::vector<double>>& rows) {
  std::string text(headings);
  for (const std::vector<double>& row : rows) {
    char separator = '\n';
    for (const double value : row) {
      text += separator + number_text(value);
      separator = ',';
    }
  }
  return text + "\n";
}

}  // namespace monograin
