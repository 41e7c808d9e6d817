// Adds your own law to monograin: a linear spring at every wall. model_of() makes it a
// model like the built-in ones, with keys, direct solution, integrators, events and
// energies.
#include <monograin/laws/contacts/model_of.hpp>
#include <monograin/laws/stress_test/draw.hpp>
#include <monograin/monograin.hpp>

#include <array>
#include <cstdio>
#include <string_view>

namespace mg = monograin;

/// Law of one contact. Lengths are over R0, forces over unit_force().
struct Spring {
  struct Branch {
  };  ///< memory of a contact: empty, because unloading retraces the loading line
  static constexpr std::array<std::string_view, 2> k_regimes{"open", "elastic"};
  double stiffness = 1.0;  ///< k [Pa]: force/(R0 displacement)

  double unit_force(double radius) const { return stiffness * radius * radius; }
  double force(Branch, double d) const { return d; }
  double slope(Branch, double) const { return 1.0; }
  double displacement(Branch, double force) const { return force; }
  double opening(Branch) const { return 0.0; }
  double work(Branch, double d) const { return 0.5 * d * d; }
  double stored(Branch, double d) const { return 0.5 * d * d; }
  int regime(Branch, bool touches) const { return touches ? 1 : 0; }
};

constexpr std::array k_material{mg::QuantityKey{"stiffness",
                                                "force over R0 and displacement",
                                                mg::Dimension::stress, mg::k_positive}};
constexpr std::array k_regimes{
    mg::Term{"open", "no force"},
    mg::Term{"elastic", "force in proportion to displacement"}};
constexpr std::array<std::string_view, 1> k_domain{"small displacements; not checked"};

Spring law_of(const mg::ModelInput& input) { return {input.material("stiffness")}; }

/// Draws a material and a program for the stress test.
mg::ProgramBounds draw(mg::Dice&, mg::DrawnMaterial& drawn) {
  drawn.values = {{"stiffness", 1.0}};
  return {};
}

int main() {
  mg::add_model(mg::contacts::model_of<law_of>({.name = "spring",
                                                .summary = "linear spring at every wall",
                                                .source = "textbook",
                                                .material = k_material,
                                                .regimes = k_regimes,
                                                .domain = k_domain,
                                                .draw = draw}));
  mg::Scenario scenario;
  scenario.set("model", "spring")
      .set("particle.radius", "10 mm")
      .set("material.stiffness", "20 MPa")
      .set("loading.configuration", "simple")
      .set("loading.steps[0].displacement", "0.1 R0")
      .set("loading.steps[0].duration", "1 s");
  const mg::RunResult result = mg::run(scenario);
  std::printf("%s, force %.17g N, expected %.17g N\n",
              std::string(mg::to_string(result.status)).c_str(),
              result.history["axial.force"].back(), 20e6 * 0.01 * 0.001);
}
