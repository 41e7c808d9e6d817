// A law of one's own outside of monograin: a linear spring at every wall. It becomes a model like the others, with its
// keys, direct solution, integrators, events and energies.
#include <monograin/laws/contacts/model_of.hpp>
#include <monograin/laws/stress/draw.hpp>
#include <monograin/monograin.hpp>

#include <array>
#include <cstdio>
#include <string_view>

namespace mg = monograin;

/// One contact. Lengths are in R0, forces in unit_force().
struct Spring {
  struct Branch {};  ///< unloading goes back on the same line
  static constexpr std::array<std::string_view, 2> k_regimes{"open", "elastic"};
  double stiffness = 1.0;  ///< k [Pa]: force over R0 and displacement

  double unit_force(double radius) const { return stiffness * radius * radius; }
  double force(Branch, double d) const { return d; }
  double slope(Branch, double) const { return 1.0; }
  double displacement(Branch, double force) const { return force; }
  double opening(Branch) const { return 0.0; }
  double work(Branch, double d) const { return 0.5 * d * d; }
  double stored(Branch, double d) const { return 0.5 * d * d; }
  int regime(Branch, bool touches) const { return touches ? 1 : 0; }
};

constexpr std::array k_material{
    mg::QuantityKey{"stiffness", "force over R0 and displacement", mg::Dimension::stress, mg::k_positive}};
constexpr std::array k_regimes{mg::Term{"open", "no force"},
                               mg::Term{"elastic", "force in proportion to displacement"}};
constexpr std::array<std::string_view, 1> k_domain{"small displacements; not checked"};

Spring law_of(const mg::ModelInput& input) { return {input.material("stiffness")}; }

/// Material that the stress test draws for the law.
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
  std::printf("%s, force %.17g N, expected %.17g N\n", std::string(mg::to_string(result.status)).c_str(),
              result.history["axial.force"].back(), 20e6 * 0.01 * 0.001);
}
