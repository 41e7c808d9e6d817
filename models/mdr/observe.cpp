// Observables of the MDR system: columns of the history, quantities, surfaces, warnings.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "mdr/contact_profile.hpp"
#include "mdr/system.hpp"

namespace monograin::mdr {
namespace {

using std::numbers::pi;

// Words in the order of Regime, then those of an adhesive contact whose edge sticks or peels.
constexpr std::array<std::string_view, 7> k_regime_words{"open",      "elastic",  "fully-plastic", "unloading",
                                                         "separated", "adhering", "peeling"};
constexpr double k_adhering_word = static_cast<double>(Regime::separated) + 1.0;
constexpr double k_peeling_word = k_adhering_word + 1.0;
static_assert(k_peeling_word + 1.0 == k_regime_words.size());

double regime_word(const ContactBranch& branch) noexcept {
  if (branch.edge.sticks()) return k_adhering_word;
  return branch.edge.peels() ? k_peeling_word : static_cast<double>(branch.regime);
}

}  // namespace

System::System(std::shared_ptr<const Setup> setup)
    : setup_(std::move(setup)),
      unknowns_(setup_->unknowns()),
      columns_({.free_centre = setup_->settings.centre_is_free}, k_regime_words, setup_->classes),
      now_{.particle = Particle(setup_), .caps = ContactCaps(*setup_)},
      search_(now_.particle),
      trial_(unknowns_.size()) {
  observables_ = {{"apparent_radius", "m", {}}, {"volume", "m3", {}}};
  observables_.insert(observables_.end(), columns_.observables().begin(), columns_.observables().end());
}

void System::observe(double xi, std::span<const double> y, std::span<double> values) {
  const Evaluation& at = now_.particle.at_state(xi, y);
  const double length = setup_->length_unit();
  values[0] = (1.0 + at.growth) * length;
  values[1] = 4.0 * pi / 3.0 * length * length * length * at.volume.volume_ratio();
  values = values.subspan(2);
  contacts::Energies energies = contacts::k_no_energies;
  if (has_energies()) {
    const double energy_unit = setup_->force_unit() * length;
    energies = {(y[k_work] + at.force_work) * energy_unit,
                now_.particle.energy(PlasticPart::recoverable) * energy_unit};
  }
  columns_.write(
      energies, now_.particle.size(), [this](std::size_t i) { return visible(i); }, values);
  if (!setup_->settings.centre_is_free) return;
  const FreeCentre& centre = now_.particle.centre();
  contacts::write_centre_columns(centre.in_space(centre_of(y, centre.free_directions())) * length, values);
}

/// What a row of the history shows of a contact.
contacts::VisibleContact System::visible(std::size_t i) const {
  const Instant& now = now_.particle.contact(i);
  // The overlap is the sum of the approach and the growth, which is no larger than |approach| + |overlap|.
  const double magnitude = 2.0 * std::abs(now.approach) + std::abs(now.overlap);
  const bool is_visible =
      now_.particle.branch(i).is_visible(setup_->law, now_.particle.at().growth, now.overlap, magnitude);
  const Contact contact = is_visible ? now.contact : Contact{};
  const double area = pi * contact.contact_radius * contact.contact_radius;
  return {.displacement = now.wall_displacement * setup_->length_unit(),
          .overlap = now.overlap * setup_->length_unit(),
          .force = contact.force * setup_->force_unit(),
          .contact_radius = contact.contact_radius * setup_->length_unit(),
          .pressure = area > 0.0 ? contact.force / area * setup_->stress_unit() : 0.0,
          .regime = regime_word(now_.particle.branch(i))};
}

double System::quantity(Quantity quantity, int contact_class, double xi, std::span<const double> y) {
  now_.particle.at_state(xi, y);
  return quantity_of(
      contacts::wall_of(visible(static_cast<std::size_t>(contact_class)), (1.0 + y[k_growth]) * setup_->length_unit()),
      quantity);
}

std::vector<SurfacePoint> System::surface(int contact_class, double xi, std::span<const double> y) {
  now_.particle.evaluate(xi, y);
  const auto i = static_cast<std::size_t>(contact_class);
  const ContactBranch& branch = now_.particle.branch(i);
  const double a = now_.particle.contact(i).contact.contact_radius;
  if (!branch.touches() || !(a > 0.0)) return {};
  const Image now = branch.image(setup_->law, y[k_growth], now_.particle.contact(i).overlap);
  std::vector<SurfacePoint> points = surface_of({.indenter = now.indenter,
                                                 .composite_modulus = setup_->law.material.composite_modulus,
                                                 .contact_radius = std::min(a, now.indenter.half_width),
                                                 .displacement_1d = now.displacement_1d});
  for (SurfacePoint& point : points) {
    point.radius *= setup_->length_unit();
    point.pressure *= setup_->stress_unit();
    point.displacement *= setup_->length_unit();
    point.relaxed_height *= setup_->length_unit();
  }
  return points;
}

double System::controlled(Control control, int contact_class, double xi, std::span<const double> y) {
  if (control == Control::force) return quantity(Quantity::force, contact_class, xi, y);
  now_.particle.evaluate(xi, y);
  return now_.particle.contact(static_cast<std::size_t>(contact_class)).wall_displacement * setup_->length_unit();
}

std::vector<Diagnostic> System::warnings() const {
  std::vector<Diagnostic> result;
  const double ratio = setup_->settings.youngs_modulus / setup_->settings.yield_stress;
  if (!std::isfinite(setup_->law.material.yield_overlap_ratio)) {
    result.push_back(
        {"the material is too compliant to yield inside the model; the particle stays elastic", "E/Y", ratio});
  } else if (ratio < 10.0) {
    result.push_back({"elastic strains are not small: the model is meant for E/Y of 10 and more", "E/Y", ratio});
  }
  if (now_.caps.first_radius()) {
    result.push_back({"contact caps intersect (event caps-intersect); the model is not valid beyond", "first at R/R0",
                      *now_.caps.first_radius()});
  }
  if (now_.validity) result.push_back(*now_.validity);
  return result;
}

}  // namespace monograin::mdr
