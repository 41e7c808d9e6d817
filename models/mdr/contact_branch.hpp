/// Branch of one contact of an MDR particle: what it remembers, its force and energy there, and its transitions.
///
/// Lengths in R0, stresses in any one unit; r = (R - R0)/R0 is the growth of the apparent radius. Functions know one
/// contact alone: no wall, no step of a program, no other contact. Source: Zunker and Kamrin (2024).
#pragma once

#include "mdr/adhesive_edge.hpp"
#include "mdr/contact.hpp"

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

/// Overlaps over R0 below this are round-off of lengths of the order of R0.
inline constexpr double k_resolution = 1e-12;

/// Material and rules that all contacts of a particle share.
struct ContactLaw {
  Material material;
  double surface_energy = 0.0;
  ElasticProfile elastic_profile = ElasticProfile::ellipse;
  DeltaMaxRule delta_max_rule = DeltaMaxRule::running_maximum;
  /// Forces go on, odd about the overlap at which a contact opens, where trials of a free centre open it or lead far
  /// off its branch: the trial then finds its way back.
  bool continues_off_branch = false;

  [[nodiscard]] bool adheres() const noexcept { return surface_energy > 0.0; }
  [[nodiscard]] bool is_shifted() const noexcept { return delta_max_rule == DeltaMaxRule::shifted; }
  [[nodiscard]] Adhesion adhesion() const noexcept { return {material.composite_modulus, surface_energy}; }
  /// Tangent stiffness of an elastic contact as deep as round-off.
  [[nodiscard]] double least_stiffness() const noexcept;
  /// Stiffness of a plastic contact at no overlap, which is the less stiff the deeper it is.
  [[nodiscard]] double plastic_stiffness() const noexcept;
};

/// Part of the energy of a contact at its largest overlap: the energy it would give back, or the work done on it (up to
/// a constant). On all other branches the two are equal.
enum class PlasticPart { recoverable, work_done };

/// The branch that a contact is on: a value. Transitions return the next one.
struct ContactBranch {
  Regime regime = Regime::open;
  bool is_on_primary_branch = true;  ///< at its largest overlap, and not decreasing
  double largest = 0.0;  ///< largest overlap (running maximum) or wall displacement (shifted), off the primary branch
  double area_constant = 0.0;  ///< c, set once at yield
  AdhesiveEdge edge;
  double resting = 0.0;  ///< displacement at which an open wall without load was left

  [[nodiscard]] bool touches() const noexcept { return mdr::touches(regime); }
  [[nodiscard]] double largest_overlap(const ContactLaw& law, double r) const noexcept {
    return law.is_shifted() ? largest + r : largest;
  }
  /// Overlap at which the contact opens, or at which its open wall begins to touch.
  [[nodiscard]] double touching_overlap(const ContactLaw& law, double r) const;

  /// Elastic indenter that the contact leaves when it unloads; one at its largest overlap leaves that of its overlap.
  /// Kept while radius and largest overlap stay: it is the greater part of the cost of an unloading force.
  [[nodiscard]] const UnloadingShape& shape(const ContactLaw& law, double r, double overlap) const;
  /// One-dimensional space of an elastic contact, or of one below its largest overlap.
  [[nodiscard]] Frame frame(const ContactLaw& law, double r, double overlap) const;
  /// Where the edge pulls off; kept while its indenter stays.
  [[nodiscard]] const PullOff& pull_off(const ContactLaw& law, const Indenter& indenter) const;

  /// Force and its derivatives on this branch.
  [[nodiscard]] Contact contact(const ContactLaw& law, double r, double overlap) const;
  /// The contact, or one as deep as round-off where it is less deep: its stiffness does not vanish.
  /// @param now  contact(law, r, overlap)
  [[nodiscard]] Contact stiff_contact(const ContactLaw& law, double r, double overlap, const Contact& now) const;
  /// False for a contact off its branch, and where the overlap is less than its round-off: the contact radius, a root
  /// of that, would be a hundred million times as large.
  /// @param magnitude  sum of the lengths that the overlap is a difference of
  [[nodiscard]] bool is_visible(const ContactLaw& law, double r, double overlap, double magnitude) const;
  /// Displacement of a wall under a force. Where no contact bears that force, the nearest that one bears.
  /// @param guess  a displacement nearby
  [[nodiscard]] double displacement_under(const ContactLaw& law, double r, double force, double guess) const;
  /// Stored energy, or work done, of one contact.
  [[nodiscard]] double energy(const ContactLaw& law, double r, double overlap, double contact_radius,
                              PlasticPart part) const;
  /// Rate at which the springs at the edge are pressed, over its magnitudes (press_rate()).
  [[nodiscard]] double press_rate(const ContactLaw& law, double r, double overlap, double contact_radius,
                                  double overlap_rate, double growth) const;
  /// Stiffness by which the contact takes part in the motion of a free centre: no less than that of a contact as deep
  /// as round-off, so that contacts of one law that only touch move it alike.
  [[nodiscard]] double tangent_stiffness(const ContactLaw& law, const Contact& now) const noexcept;
  /// Magnitude of the stiffness that the contact has, or would have if its edge did not peel.
  [[nodiscard]] double unpeeled_stiffness(const ContactLaw& law, double r, const Contact& now) const;

  /// True if an elastic contact yields where it is deep enough: at its largest overlap, and below it where that moves
  /// with the radius, as growth may then have pressed the contact in beyond anything it has borne while its wall went
  /// back, or have left it with a largest overlap that it never had.
  [[nodiscard]] bool may_yield(const ContactLaw& law) const noexcept;
  /// Guard: >= 0 where the contact yields.
  /// @param least  overlap below which none does
  [[nodiscard]] double yield_guard(const ContactLaw& law, double r, double overlap, double least = 0.0) const noexcept;
  /// Guard of a contact that can open, or close on its dent: <= 0 where it is open.
  [[nodiscard]] double opening_guard(const ContactLaw& law, double r, double overlap) const;

  // Transitions.

  /// From its largest overlap, which is where it is, to the branch below that.
  [[nodiscard]] ContactBranch unloaded(const ContactLaw& law, double r, double overlap) const noexcept;
  /// Where the contact is becomes its largest overlap.
  [[nodiscard]] ContactBranch with_largest(const ContactLaw& law, double r, double overlap) const noexcept;
  /// Back at its largest overlap, and on from there.
  [[nodiscard]] ContactBranch reloaded() const noexcept;
  [[nodiscard]] ContactBranch yielded(const ContactLaw& law, double r) const noexcept;
  /// A wall meets the fresh particle or its dent. An elastic contact that was pressed before keeps its largest overlap.
  [[nodiscard]] ContactBranch made() const noexcept;
  /// A wall leaves the particle or its dent, and stays where it is.
  [[nodiscard]] ContactBranch lost(double displacement) const noexcept;
  [[nodiscard]] ContactBranch with_edge(const AdhesiveEdge& next) const noexcept;

 private:
  [[nodiscard]] Contact adhering_contact(const ContactLaw& law, double r, double overlap) const;

  // Memos of shape() and pull_off(), which depend on nothing but what they are asked for.
  mutable UnloadingShape shape_;
  mutable PullOff pull_off_;
};

}  // namespace monograin::mdr
