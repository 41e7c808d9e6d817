#include "material-point/stress_test.hpp"

#include <algorithm>
#include <cmath>

#include "material-point/model.hpp"
#include "material-point/yield_surface.hpp"

namespace monograin::material_point {

ProgramBounds draw(Dice& dice, DrawnMaterial& drawn) {
  const std::string model(dice.one_of<std::string_view>({"vmdc", "vmdc", "dpc", "vm"}));
  const double stiffness = dice.happens(0.8) ? dice.log_uniform(30.0, 2000.0) : dice.log_uniform(2.0, 1e6);
  drawn.values = {{"yield_pressure", 1.0},
                  {"stiffness_ratio", stiffness},
                  {"shear_ratio", dice.uniform(0.3, 3.0)},
                  {"nu0", draw_poisson_ratio(dice, 0.4999)}};
  drawn.options["yield_model"] = model;
  const auto maybe = [&](const char* key, double value) {
    if (dice.happens(0.6)) drawn.values[key] = value;
  };
  maybe("eta", dice.uniform(0.0, 17.0));
  maybe("xi", dice.uniform(0.0, 10.0));
  maybe("xi1", dice.uniform(0.0, 0.9));
  if (model != "vm") {
    const double density = dice.uniform(0.2, 0.9);
    drawn.values["reference_density"] = density;
    drawn.values["tensile_ratio"] = dice.log_uniform(1e-3, 0.5);
    drawn.values["eps0"] = dice.uniform(0.1, 1.2);
    maybe("zeta", dice.uniform(0.0, 19.0));
    maybe("omega", dice.uniform(0.0, 20.0));
    maybe("xi2", dice.uniform(0.0, 3.0));
    if (dice.happens(0.3)) drawn.values["relative_density"] = dice.uniform(density, 0.99);
    if (model == "dpc" && dice.happens(0.5)) drawn.values["transition_width"] = dice.log_uniform(1e-6, 0.1);
  }
  return {.deepest = 0.4, .force = 3.0, .tension = 0.5};
}

namespace {

/// Draws the steps of a program, one after the other.
class ProgramDraw {
 public:
  ProgramDraw(Dice& dice, const DrawnMaterial& drawn, const ProgramBounds& bounds)
      : dice_(dice),
        drawn_(drawn),
        bounds_(bounds),
        is_path_(drawn.configuration == "strain-path"),
        is_triaxial_(drawn.configuration == "triaxial"),
        size_(dice.one_of({1e-6, 1e-2, 0.1, 1.0, 1.0})) {}

  /// Draws an axial stress, or an axial strain, which may be next to the previous one.
  void draw_axial(DrawnStep& step) {
    step.control = !is_path_ && dice_.happens(0.3) ? Control::stress : Control::strain;
    step.target = step.control == Control::stress ? stress() : strain();
    if (step.control == Control::stress) return;
    if (dice_.happens(0.3)) step.target = strain_ + dice_.one_of({1e-13, 1e-8, 1e-4}) * dice_.uniform(-1.0, 1.0);
    strain_ = step.target;
  }

  /// Draws a lateral strain or stress, where the configuration has one.
  void draw_lateral(DrawnStep& step) {
    if (is_path_) {
      // Paths along an axis of the stress plane are among them: no deviator, or no pressure.
      const double of_axial = dice_.one_of({0.0, 1.0, -0.5, dice_.uniform(-1.0, 1.0)});
      if (dice_.happens(0.8)) step.lateral = {Control::strain, of_axial * step.target};
    } else if (is_triaxial_ && dice_.happens(0.5)) {
      step.lateral = {Control::stress, stress()};
    }
  }

  /// Draws an event or a quantity that ends the step early.
  void draw_condition(DrawnStep& step) {
    const std::string_view key =
        dice_.one_of<std::string_view>({"stress_axial", "stress_lateral", "relative_density", "event"});
    if (key == "event") {
      step.until_event = draw_event(dice_, drawn_.events);
      return;
    }
    step.until = key;
    step.until_value = key == "relative_density" ? dice_.uniform(0.2, 0.999) : stress();
  }

 private:
  double strain() { return bounds_.deepest * size_ * dice_.uniform(-1.0, 0.3); }

  double stress() {
    return dice_.happens(0.2) ? bounds_.tension * dice_.uniform(0.0, 1.0)
                              : -bounds_.force * size_ * dice_.uniform(0.0, 1.0);
  }

  Dice& dice_;
  const DrawnMaterial& drawn_;
  const ProgramBounds& bounds_;
  bool is_path_;
  bool is_triaxial_;
  double size_;          ///< of targets, over the bounds
  double strain_ = 0.0;  ///< axial strain prescribed last
};

}  // namespace

std::vector<DrawnStep> draw_program(Dice& dice, const DrawnMaterial& drawn, const ProgramBounds& bounds,
                                    std::size_t count) {
  const double usual = dice.happens(0.6) ? 1.0 : dice.log_uniform(1e-12, 1e12);
  ProgramDraw program(dice, drawn, bounds);
  return draw_steps(dice, usual, count, [&](DrawnStep& step, std::size_t /*index*/) {
    program.draw_axial(step);
    program.draw_lateral(step);
    if (!step.lateral && dice.happens(0.3)) give_rate(step);
    if (dice.happens(0.15)) program.draw_condition(step);
  });
}

void check(const CheckedRun& run, std::vector<Violation>& found) {
  const HistoryRows& rows = run.rows;
  const double tolerance = run.tolerance;
  const double yield_pressure = run.input.material("yield_pressure");
  // Stresses are moduli times strains, with the strains' round-off; prescribed ones are without it. Densities and
  // strengths follow from the plastic strain alone.
  const Parameters law = parameters_of(run.input);
  const std::size_t phi = rows.column("phi");
  const double strain_round_off = run.round_off * std::max(1.0, rows.largest_magnitude(rows.column("strain_axial")));
  const auto properties = [&](std::size_t row) { return properties_at(law, rows.at(row, phi)); };
  const std::size_t p = rows.column("p");
  const std::size_t s = rows.column("s");
  const std::size_t axial = rows.column("stress_axial");
  const std::size_t lateral = rows.column("stress_lateral");
  const double scale = std::max(rows.largest_magnitude(p), rows.largest_magnitude(s));
  check_rows(
      run, "stress-invariants", "p and s do not belong to the axial and the lateral stress", found,
      [&](std::size_t row) {
        const double of_axial = rows.at(row, p) + 2.0 / 3.0 * rows.at(row, s) - rows.at(row, axial);
        const double of_lateral = rows.at(row, p) - rows.at(row, s) / 3.0 - rows.at(row, lateral);
        const Properties now = properties(row);
        const double stiffness = yield_pressure * std::max({now.bulk_modulus.value, now.shear_modulus.value, 1.0});
        return std::max(std::abs(of_axial), std::abs(of_lateral)) - tolerance * scale - strain_round_off * stiffness;
      });
  const std::size_t f = rows.column("yield_function");
  check_rows(run, "yield", "the stress is outside the yield surface", found, [&](std::size_t row) {
    const Properties now = properties(row);
    const double of_p = rows.at(row, p) / yield_pressure;
    const double of_s = rows.at(row, s) / yield_pressure;
    const Yield y = yield_on(law, now, branch_at(law, now, of_p, of_s), of_p, of_s);
    const double by_strain =
        std::abs(y.f_p) * now.bulk_modulus.value + 3.0 * std::abs(y.f_s) * now.shear_modulus.value + std::abs(y.f_phi);
    return rows.at(row, f) - tolerance - strain_round_off * by_strain;
  });
  if (!is_compressible(law.model)) {
    check_growth(run, "phi", tolerance, found);
    return;
  }
  // The mass of the solid is constant.
  const std::size_t density = rows.column("relative_density");
  const std::size_t volumetric = rows.column("plastic_strain_volumetric");
  const double initial = rows.at(0, density);
  check_rows(run, "mass", "relative density and plastic strain do not belong together", found, [&](std::size_t row) {
    const double solid = rows.at(row, density) * std::exp(rows.at(row, volumetric));
    return std::abs(solid / initial - 1.0) - run.round_off;
  });
  check_rows(run, "density", "the relative density passes 1", found,
             [&](std::size_t row) { return rows.at(row, density) - 1.0 - tolerance; });
}

}  // namespace monograin::material_point
