// Cost of one evaluation of the law of coupled contacts, with all derivatives: of the parts of one contact, and of the
// rates of a whole die beside those of the MDR particle.
#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

#include "cel/contact_law.hpp"
#include "cel/motion.hpp"
#include "law_timing.hpp"
#include "mdr/particle.hpp"

namespace monograin {
namespace {

constexpr double k_yield_stress = 0.05;  ///< over E
constexpr double k_poisson_ratio = 0.3;
constexpr double k_depth = 0.2;  ///< displacement of the driven walls over R0

std::vector<ContactClass> die() {
  return {{.name = "axial", .normals = {{0, 0, 1}, {0, 0, -1}}},
          {.name = "lateral", .normals = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}}}};
}

void cel_dent(benchmark::State& state) {
  const cel::Material material(k_yield_stress, k_poisson_ratio);
  time_law(state, "", material.a_Y, 0.6, [&](double zeta) { return cel::dent_of(material, zeta); });
}
BENCHMARK(cel_dent);

void cel_contact(benchmark::State& state) {
  const cel::Material material(k_yield_stress, k_poisson_ratio);
  const cel::Dent dent = cel::dent_of(material, 0.4);
  time_law(state, "", 1e-3, 0.1, [&](double u) { return cel::contact_at(material, dent, 0.95, 0.98, u); });
}
BENCHMARK(cel_contact);

/// Rates of two classes that flow.
void cel_die(benchmark::State& state) {
  cel::Particle particle({k_yield_stress, k_poisson_ratio}, k_poisson_ratio, die(), false);
  for (cel::ClassState& c : particle.classes) {
    c.drive = contacts::WallDrive(Ramp{0.0, k_depth, Control::displacement}, 1.0);
    c.touches = c.flows = true;
  }
  cel::Motion motion;
  const cel::Layout& layout = particle.layout();
  std::vector<double> y(layout.size(), 0.0);
  y[0] = 0.03;
  y[1] = 0.01;
  y[layout.dent(1)] = 0.25;
  time_law(state, "", 0.3, 0.5, [&](double zeta) {
    y[layout.dent(0)] = zeta;
    return motion.evaluate(particle, 0.5, y);
  });
}
BENCHMARK(cel_die);

/// Rates of two plastic classes while the radius grows.
void mdr_die(benchmark::State& state) {
  const mdr::Settings settings{
      .initial_radius = 1.0, .youngs_modulus = 1.0, .poisson_ratio = k_poisson_ratio, .yield_stress = k_yield_stress};
  mdr::Particle particle(std::make_shared<const mdr::Setup>(settings, die()));
  particle.start();
  particle.set_drives(std::vector{Ramp{0.0, k_depth}, Ramp{0.0, 0.0}});
  for (std::size_t i = 0; i < particle.size(); ++i) {
    mdr::ContactBranch plastic;
    plastic.regime = mdr::Regime::fully_plastic;
    particle.set_branch(i, plastic);
  }
  std::vector<double> y(particle.setup().unknown_count(), 0.0);
  time_law(state, "", 0.02, 0.06, [&](double growth) {
    y[mdr::k_growth] = growth;
    particle.evaluate(0.5, y);
    return particle.growing_motion();
  });
}
BENCHMARK(mdr_die);

}  // namespace
}  // namespace monograin
