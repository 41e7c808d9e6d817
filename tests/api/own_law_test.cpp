// Laws of a user of the library, added to the models.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <string_view>

#include "catalogue.hpp"
#include "contacts/model_of.hpp"
#include "monograin/monograin.hpp"

namespace monograin::own_law_test {
namespace {

struct Spring {
  struct Branch {};
  static constexpr std::array<std::string_view, 2> k_regimes{"open", "elastic"};
  double stiffness = 1.0;  ///< [N/m]

  double unit_force(double radius) const { return stiffness * radius; }
  double force(Branch, double d) const { return d; }
  double slope(Branch, double) const { return 1.0; }
  double displacement(Branch, double force) const { return force; }
  double opening(Branch) const { return 0.0; }
  int regime(Branch, bool touches) const { return touches ? 1 : 0; }
};

constexpr std::array k_material{QuantityKey{"stiffness", "force over displacement", Dimension::stiffness, k_positive}};
constexpr Citation k_hooke{"hooke1678", "R. Hooke", "Lectures de potentia restitutiva", "London", "", "", "1678", ""};
constexpr std::array k_references{&k_hooke};
constexpr std::array k_regimes{Term{"open", "no force"}, Term{"elastic", "force in proportion to displacement"}};

Spring law_of(const ModelInput& input) { return {input.material("stiffness")}; }

Model spring(std::string_view name) {
  return contacts::model_of<law_of>({.name = name,
                                     .summary = "linear spring at every wall",
                                     .references = k_references,
                                     .source = "Hooke (1678)",
                                     .material = k_material,
                                     .regimes = k_regimes,
                                     .domain = {}});
}

std::string refusal_of(const Model& model) {
  try {
    add_model(model);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

// A free particle between a wall that presses with 100 N and a wall at rest: both bear 100 N, and each contact gives
// way by F/k.
TEST(OwnLaw, HasAFreeCentre) {
  if (find_model("spring-with-free-centre") == nullptr) add_model(spring("spring-with-free-centre"));
  const std::string text = R"toml(model = "spring-with-free-centre"
particle.radius = "10 mm"
material.stiffness = "1 kN/mm"
[loading]
configuration = "walls"
centre = "equilibrium"
[[loading.wall]]
name = "top"
normal = [0, 0, 1]
steps = [{ force = "100 N", duration = "1 s" }]
[[loading.wall]]
name = "bottom"
normal = [0, 0, -1]
fixed = true
)toml";
  for (const char* integrator : {"direct", "cvode-bdf", "ida"}) {
    const RunResult result = run(Scenario::parse(text, "s.toml", {std::string("numerics.integrator=") + integrator}));
    ASSERT_EQ(result.status, RunStatus::complete) << integrator << ": " << result.message;
    EXPECT_NEAR(result.history["top.force"].back(), 100.0, 1e-6) << integrator;
    EXPECT_NEAR(result.history["bottom.force"].back(), 100.0, 1e-4) << integrator;
    EXPECT_NEAR(result.history["top.displacement"].back(), 2.0 * 100.0 / 1e6, 1e-9) << integrator;
  }
}

TEST(OwnLaw, ListsTheEventsThatItMayHave) {
  const Model model = spring("spring");
  const auto has = [&](std::string_view name) {
    return std::ranges::find(model.events, name, &Term::name) != model.events.end();
  };
  EXPECT_TRUE(has("contact-made"));
  EXPECT_TRUE(has("retreat"));
  EXPECT_FALSE(has("limit")) << "the law has no boundary";
}

TEST(OwnLaw, IsRefusedForNamesThatNoFileCanHave) {
  for (const char* name : {"", "my spring", "Spring", "a/../b", "3d"}) {
    EXPECT_EQ(refusal_of(spring(name)), "a model is named '" + std::string(name) +
                                            "'; expected a small letter, then small letters, digits and '-'");
  }
  EXPECT_EQ(refusal_of(spring("output")), "'output' is a key of every scenario; expected another name for a model");
  EXPECT_EQ(refusal_of(spring("hertz")), "there is a model 'hertz' already; expected another name");
  static constexpr std::array k_twice{k_material[0], k_material[0]};
  Model model = spring("spring");
  model.material = k_twice;
  EXPECT_EQ(refusal_of(model), "model 'spring' has the key 'stiffness' twice");
  static constexpr std::array k_blank{
      QuantityKey{"k one", "force over displacement", Dimension::stiffness, k_positive}};
  model.material = k_blank;
  EXPECT_EQ(refusal_of(model), "model 'spring' has the key 'k one'; expected a letter, then letters, digits and '_'");
  model = spring("spring");
  model.bind = nullptr;
  EXPECT_EQ(refusal_of(model), "model 'spring' has no function `bind`");
  EXPECT_EQ(find_model("spring"), nullptr);
}

Spring of_another_key(const ModelInput& input) { return {input.material("stifness")}; }

TEST(OwnLaw, ThatAsksForAKeyWhichItDoesNotListIsNamed) {
  Model model = spring("spring-of-another-key");
  model.bind = contacts::model_of<of_another_key>(model).bind;
  if (find_model(model.name) == nullptr) add_model(model);
  const Scenario scenario = Scenario::parse(R"toml(model = "spring-of-another-key"
particle.radius = "10 mm"
material.stiffness = "1 kN/mm"
loading = { configuration = "simple", steps = [{ displacement = "0.1 R0", duration = "1 s" }] }
)toml");
  try {
    static_cast<void>(run(scenario));
    FAIL() << "ran";
  } catch (const std::out_of_range& error) {
    EXPECT_STREQ(error.what(), "the law asks for 'stifness', which is no key of its [material]");
  }
}

}  // namespace
}  // namespace monograin::own_law_test
