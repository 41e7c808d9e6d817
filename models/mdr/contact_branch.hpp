/// Branch of one contact of an MDR particle: the memory of the contact, its force and energy, and its transitions.
///
/// Lengths in R0, stresses in any one unit; growth = (R - R0)/R0. Functions know one
/// contact alone: no wall, no step of a program, no other contact. Source: Zunker and Kamrin (2024).
#pragma once

#include "mdr/adhesive_edge.hpp"
#include "mdr/contact.hpp"
#include "system/resolution.hpp"

namespace monograin::mdr {

/// Rule for the largest overlap of an unloaded contact while R grows.
enum class DeltaMaxRule {
  running_maximum,  ///< stays: it is the running maximum of the overlap (Appendix E)
  shifted           ///< moves with R: delta_o,max + R - R0 (eq. 19)
};

enum class Regime { open, elastic, fully_plastic, unloading, separated };

[[nodiscard]] constexpr bool touches(Regime regime) noexcept {
  return regime != Regime::open && regime != Regime::separated;
}

/// Material and rules that all contacts of a particle share.
struct ContactLaw {
  Material material;
  double surface_energy = 0.0;
  ElasticProfile elastic_profile = ElasticProfile::ellipse;
  DeltaMaxRule delta_max_rule = DeltaMaxRule::running_maximum;
  /// True: forces continue beyond a branch, odd about the overlap at which the contact opens. Trials of a free centre
  /// that open a contact, or lead far off its branch, then lead back.
  bool continues_off_branch = false;

  [[nodiscard]] bool adheres() const noexcept { return surface_energy > 0.0; }
  [[nodiscard]] bool is_shifted() const noexcept { return delta_max_rule == DeltaMaxRule::shifted; }
  [[nodiscard]] Adhesion adhesion() const noexcept { return {material.composite_modulus, surface_energy}; }
  /// Tangent stiffness of an elastic contact whose overlap is k_resolution.
  [[nodiscard]] double least_stiffness() const noexcept;
  /// Scale of the stiffness of plastic contacts, 2 pi Y R0: that of a shallow contact under a mean pressure of Y. A
  /// contact softens as it grows deeper.
  [[nodiscard]] double plastic_stiffness() const noexcept;
};

/// Part of the energy of a contact at its largest overlap: the energy it would give back, or the work done on it (up to
/// a constant). On all other branches the two are equal.
enum class PlasticPart { recoverable, work_done };

/// The branch that a contact is on, as a value: transitions return the next branch.
struct ContactBranch {
  Regime regime = Regime::open;
  bool is_on_primary_branch = true;  ///< the contact is at its largest overlap, and the overlap is not decreasing
  double largest_measure = 0.0;      ///< off the primary branch: largest overlap (shifted: without the growth)
  double area_constant = 0.0;        ///< c of yield_area_constant(), set once at yield
  AdhesiveEdge edge;
  double resting = 0.0;  ///< approach at which an open wall without load was left

  [[nodiscard]] bool touches() const noexcept { return mdr::touches(regime); }
  [[nodiscard]] double largest_overlap(const ContactLaw& law, double growth) const noexcept {
    return law.is_shifted() ? largest_measure + growth : largest_measure;
  }
  /// Overlap at which the contact opens, or at which its open wall begins to touch.
  [[nodiscard]] double touching_overlap(const ContactLaw& law, double growth) const;

  /// Elastic indenter that the contact leaves when it unloads. Cached for one radius and largest overlap: it is most of
  /// the cost of an unloading force.
  /// @param overlap  counts only for a fully plastic contact, as its largest one
  [[nodiscard]] const UnloadingShape& shape(const ContactLaw& law, double growth, double overlap) const;
  /// Image of an elastic contact, or of one below its largest overlap.
  [[nodiscard]] Image image(const ContactLaw& law, double growth, double overlap) const;
  /// States in which the edge of an indenter pulls off. Cached for one indenter.
  [[nodiscard]] const PullOff& pull_off(const ContactLaw& law, const Indenter& indenter) const;

  /// Force and its derivatives on this branch.
  [[nodiscard]] Contact contact(const ContactLaw& law, double growth, double overlap) const;
  /// The contact, or one of overlap k_resolution if it is less deep: the stiffness does not vanish at first touch.
  /// @param now  contact(law, growth, overlap)
  [[nodiscard]] Contact stiff_contact(const ContactLaw& law, double growth, double overlap, const Contact& now) const;
  /// False if the overlap is negative or below its round-off: the history then shows no contact. The contact radius, a
  /// root, would be 1e8 times as large as that round-off.
  /// @param magnitude  sum of the lengths that the overlap is a difference of
  [[nodiscard]] bool is_visible(const ContactLaw& law, double growth, double overlap, double magnitude) const;
  /// Approach of a wall under a prescribed force. An open wall stays, or is pushed by the particle; a peeling edge
  /// beyond pull-off gives the approach at pull-off.
  /// @param guess  an approach nearby
  /// @throws std::domain_error for a force greater than the contact can bear
  [[nodiscard]] double approach_under(const ContactLaw& law, double growth, double force, double guess) const;
  /// Stored energy, or work done, of one contact.
  [[nodiscard]] double energy(const ContactLaw& law, double growth, double overlap, double contact_radius,
                              PlasticPart part) const;
  /// Rate at which the springs at the edge are pressed (+) or stretched (-), from -1 to 1, as mdr::press_rate() says.
  [[nodiscard]] double press_rate(const ContactLaw& law, double growth, double overlap, double contact_radius,
                                  double overlap_rate, double growth_rate) const;
  /// Stiffness with which the contact acts on a free centre: its tangent stiffness, but, except for plastic contacts
  /// and peeling edges, no less than least_stiffness(), so that idle contacts of one law act alike.
  [[nodiscard]] double regularized_stiffness(const ContactLaw& law, const Contact& now) const noexcept;
  /// Stiffness to compare the present one with: its magnitude; for a peeling edge, the tangent stiffness if it stuck.
  [[nodiscard]] double reference_stiffness(const ContactLaw& law, double growth, const Contact& now) const;

  /// True if an elastic contact can yield. At its largest overlap it always can. Below, it can if the largest overlap
  /// is counted with the growth of the radius: growth can then press the contact deeper than ever while its wall
  /// retreats.
  [[nodiscard]] bool may_yield(const ContactLaw& law) const noexcept;
  /// Guard: >= 0 where the contact yields.
  /// @param least  overlap below which no contact yields
  [[nodiscard]] double yield_guard(const ContactLaw& law, double growth, double overlap,
                                   double least = 0.0) const noexcept;
  /// Guard of a contact that can open, or close on its dent: <= 0 where it is open.
  [[nodiscard]] double opening_guard(const ContactLaw& law, double growth, double overlap) const;

  // Transitions.

  /// Branch of a contact that starts to unload: the present overlap becomes its largest one.
  [[nodiscard]] ContactBranch unloaded(const ContactLaw& law, double growth, double overlap) const noexcept;
  /// This branch, with the present overlap as its largest one.
  [[nodiscard]] ContactBranch with_largest(const ContactLaw& law, double growth, double overlap) const noexcept;
  /// Primary branch of a contact that is back at its largest overlap and loads on.
  [[nodiscard]] ContactBranch reloaded() const noexcept;
  /// Fully plastic branch of an elastic contact that yields.
  [[nodiscard]] ContactBranch yielded(const ContactLaw& law, double growth) const noexcept;
  /// Branch after a wall has met the fresh particle or its dent. A contact that was pressed keeps its largest overlap.
  [[nodiscard]] ContactBranch made() const noexcept;
  /// Branch after a wall has left the particle or its dent, and stays where it is.
  [[nodiscard]] ContactBranch lost(double approach) const noexcept;
  [[nodiscard]] ContactBranch with_edge(const AdhesiveEdge& next) const noexcept;

 private:
  [[nodiscard]] Contact adhering_contact(const ContactLaw& law, double growth, double overlap) const;

  // Caches of shape() and pull_off().
  mutable UnloadingShape shape_;
  mutable PullOff pull_off_;
};

}  // namespace monograin::mdr
