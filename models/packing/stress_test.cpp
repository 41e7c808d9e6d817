#include "packing/stress_test.hpp"

#include <algorithm>
#include <cmath>

#include "packing/model.hpp"

namespace monograin::packing {

ProgramBounds draw(Dice& dice, DrawnMaterial& drawn) {
  const bool is_plastic = dice.happens(0.5);
  drawn.values = {{"youngs_modulus", 1.0}, {"poisson_ratio", draw_poisson_ratio(dice, 0.4999)}};
  if (is_plastic) {
    drawn.values["yield_stress"] = 1.0 / dice.log_uniform(2.0, 1e6);
    drawn.values["hardening_modulus"] = dice.happens(0.2) ? 0.0 : dice.log_uniform(1e-6, 10.0);
  }
  draw_choices(dice, options(), drawn);
  const auto maybe = [&](const char* key, double value) {
    if (dice.happens(0.5)) drawn.options[key] = value;
  };
  const double stretch = dice.log_uniform(0.05, 5.0);
  if (dice.happens(0.5)) {
    drawn.options["f_E"] = stretch;
    drawn.options["f_G"] = dice.happens(0.2) ? stretch : dice.uniform(0.01, 1.0) * stretch;
  }
  const double jamming = dice.happens(0.5) ? 0.8 : dice.uniform(0.3, 0.99);
  drawn.options["jamming_fraction"] = jamming;
  if (!drawn.options.contains("continuous_jamming")) {
    maybe("critical_porosity", (1.0 - jamming) * dice.uniform(0.8, 1.5));
    maybe("c2", -std::log(jamming) * dice.uniform(0.8, 1.5));
  }
  maybe("c1", dice.log_uniform(1e-2, 1e3));
  maybe("alpha", dice.log_uniform(1e-2, 1e2));
  maybe("Z_1", dice.uniform(4.0, 12.0));
  const double initial = jamming * dice.one_of({0.5, 0.9, 0.999999, 1.0, 1.000001, 1.01});
  maybe("initial_packing_fraction", std::min(initial, 0.999));
  const auto given = drawn.options.find("initial_packing_fraction");
  return {.deepest = 1.0,
          .force = 0.5,
          .only_loads = is_plastic,
          .start = given == drawn.options.end() ? jamming : std::get<double>(given->second)};
}

std::vector<DrawnStep> draw_program(Dice& dice, const DrawnMaterial& drawn, const ProgramBounds& bounds,
                                    std::size_t count) {
  const double usual = dice.happens(0.6) ? 1.0 : dice.log_uniform(1e-12, 1e12);
  // Plastic packings are only compacted. The order of targets of different kinds is unknown here: use one kind.
  const Control only = dice.one_of({Control::packing_fraction, Control::strain, Control::stress});
  double present = 0.0;  // share of the path
  return draw_steps(dice, usual, count, [&](DrawnStep& step, std::size_t i) {
    step.control =
        bounds.only_loads ? only : dice.one_of({Control::packing_fraction, Control::strain, Control::stress});
    const double share = dice.happens(0.9) ? dice.uniform(0.0, 1.0) : dice.one_of({0.0, 1e-12, 1.0, 1.2});
    const bool goes_back = !bounds.only_loads && i % 2 == 1;
    present = goes_back ? present * dice.uniform(0.0, 1.0)
                        : present + share * (bounds.only_loads ? std::max(0.0, 1.0 - present) : 1.0 - present);
    if (step.control == Control::packing_fraction) {
      step.target = std::min(1.9, bounds.start + present * (bounds.deepest - bounds.start));
    } else if (step.control == Control::strain) {
      step.target = -0.3 * present * std::log(bounds.start);
    } else {
      step.target = present * bounds.force * (bounds.only_loads ? 0.2 : 1.0);
    }
    if (dice.happens(0.3)) give_rate(step);
    if (dice.happens(0.1)) step.until_event = draw_event(dice, drawn.events);
  });
}

void check(const CheckedRun& run, std::vector<Violation>& found) {
  const HistoryRows& rows = run.rows;
  const double tolerance = run.tolerance;
  const std::size_t fraction = rows.column("packing_fraction");
  check_rows(run, "density", "the packing fraction passes 1", found,
             [&](std::size_t row) { return rows.at(row, fraction) - 1.0 - tolerance; });
  const std::size_t stress = rows.column("stress");
  const double scale = rows.largest_magnitude(stress);
  check_rows(run, "tension", "the packing pulls", found,
             [&](std::size_t row) { return -rows.at(row, stress) - tolerance * scale; });
  const Law law = law_of(run.input);
  const double full = std::max(full_plasticity(law), law.jamming);
  const std::size_t regime = rows.column("regime");
  check_rows(run, "regime", "the regime does not belong to the packing fraction", found, [&](std::size_t row) {
    const std::string_view word = rows.word(row, regime);
    const double phi = rows.at(row, fraction);
    if (word == "unjammed") return phi / law.jamming - 1.0 - tolerance;
    return (word == "fully-plastic" ? full / phi : phi / full) - 1.0 - tolerance;
  });
  // The coordination number has an infinite slope at jamming, so that each row is compared by its own packing fraction.
  const std::size_t coordination = rows.column("coordination_number");
  check_rows(run, "coordination", "the coordination number does not belong to the packing fraction", found,
             [&](std::size_t row) {
               const double number = rows.at(row, coordination);
               if (std::isnan(number)) return -1.0;
               return std::abs(number / coordination_number(law, rows.at(row, fraction)) - 1.0) - run.round_off;
             });
  const std::size_t plastic = rows.column("plastic_fraction");
  check_rows(run, "plastic-fraction", "the plastic fraction is not within 0 and 1", found, [&](std::size_t row) {
    return std::max(-rows.at(row, plastic), rows.at(row, plastic) - 1.0) - tolerance;
  });
  if (law.given.plasticity) check_growth(run, "plastic_fraction", tolerance, found);
}

}  // namespace monograin::packing
