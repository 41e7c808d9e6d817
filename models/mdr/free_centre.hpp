/// Balance of forces on the free centre of a particle: the loads of contacts, their sums, and how the centre responds.
///
/// Contacts push the centre along the lines of contacts/centre/centre_lines.hpp. Lengths in R0.
#pragma once

#include <span>
#include <vector>

#include "contacts/centre/centre_lines.hpp"
#include "system/resolution.hpp"

namespace monograin::mdr {

using CentreVector = contacts::CentreLines::Vector;
using CentreMatrix = contacts::CentreLines::Matrix;

/// Load of a class of contacts on the centre, per wall, towards the centre positive.
struct CentreLoad {
  double count = 1.0;
  double force = 0.0;
  double force_by_time = 0.0;
  double force_by_radius = 0.0;
  double stiffness = 0.0;
  double tangent_stiffness = 0.0;  ///< ContactBranch::tangent_stiffness(), which has a least value for idle contacts
};

/// Tangent stiffness of the centre in its softest direction, over what it would be if no edge peeled and no contact
/// were softened past its peak.
struct CentreStiffness {
  double value = 0.0;
  CentreVector direction = CentreVector::Zero();
};

class FreeCentre {
 public:
  FreeCentre() = default;
  /// @param is_free  false: nothing moves the centre
  FreeCentre(std::span<const ContactClass> classes, bool is_free) : lines_(classes, is_free), loads_(lines_.size()) {}

  /// Free directions, 0 to 3.
  [[nodiscard]] int count() const noexcept { return lines_.dimension(); }
  [[nodiscard]] bool is_free() const noexcept { return count() > 0; }
  /// Mean normal of a class along the free directions.
  [[nodiscard]] const CentreVector& direction(std::size_t i) const noexcept { return lines_.arm(i); }
  /// By how much the centre has moved towards the walls of a class.
  /// @param position  of the centre along the free directions, and whatever follows
  [[nodiscard]] double moved_towards(std::size_t i, std::span<const double> position) const noexcept {
    double distance = 0.0;
    for (int k = 0; k < count(); ++k) distance += direction(i)[k] * position[static_cast<std::size_t>(k)];
    return distance;
  }
  /// True if a contact of the class acts on the centre.
  [[nodiscard]] bool acts(std::size_t i) const noexcept { return is_free() && lines_.acts(i); }
  /// A vector along the free directions, in space.
  [[nodiscard]] Eigen::Vector3d in_space(const CentreVector& vector) const { return lines_.in_space(vector); }

  /// Forgets all loads.
  void clear() noexcept {
    for (Load& load : loads_) load = {.kept_stiffness = load.kept_stiffness};
  }
  void add(std::size_t i, const CentreLoad& added) noexcept {
    const double along = lines_.along(i);
    Load& line = load(i);
    line.force += added.count * added.force * along;
    line.force_by_time += added.count * added.force_by_time * along;
    line.force_by_radius += added.count * added.force_by_radius * along;
    line.stiffness += added.count * added.stiffness * along * along;
    line.tangent_stiffness += added.count * added.tangent_stiffness * along * along;
  }
  /// Sums up the loads of all lines. A line without stiffness, as at first touch, takes its tangent stiffness.
  void sum_up() noexcept;
  [[nodiscard]] const CentreVector& force() const noexcept { return force_; }
  [[nodiscard]] const CentreMatrix& stiffness() const noexcept { return stiffness_; }

  // Displacements of the centre; zero along directions in which no contact constrains it.

  /// Newton step of the centre: displacement that cancels the net force with the present stiffnesses.
  [[nodiscard]] CentreVector step() const { return step_along(&Load::stiffness, &Load::force); }
  /// Displacement of the centre that cancels the net force with the tangent stiffnesses.
  [[nodiscard]] CentreVector tangent_step() const { return step_along(&Load::tangent_stiffness, &Load::force); }
  /// Displacement of the centre that cancels the net force with the stiffnesses that keep_stiffness() has stored.
  [[nodiscard]] CentreVector step_of_kept() const { return step_along(&Load::kept_stiffness, &Load::force); }
  void keep_stiffness() noexcept;
  /// Derivatives of the centre's position by the step coordinate and by the radius.
  [[nodiscard]] CentreVector by_time() const { return step_along(&Load::tangent_stiffness, &Load::force_by_time); }
  [[nodiscard]] CentreVector by_radius() const { return step_along(&Load::tangent_stiffness, &Load::force_by_radius); }

  /// Projector on the directions in which no contact constrains the centre.
  /// @param constrains  contact class -> whether it does
  template <class Constrains>
  [[nodiscard]] CentreMatrix unconstrained(Constrains&& constrains) {
    for (Load& load : loads_) load.held = 0.0;
    for (std::size_t i = 0; i < lines_.classes(); ++i) {
      if (constrains(i)) load(i).held += lines_.along(i) * lines_.along(i);
    }
    return unconstrained_directions();
  }
  /// Softest direction of the centre, and its tangent stiffness over that without peeling and softening.
  /// @param stiffness_of  (contact class, component of its mean normal along its line) -> its tangent stiffness along
  ///                      that line, and the one without peeling and softening
  template <class StiffnessOf>
  [[nodiscard]] CentreStiffness softest(StiffnessOf&& stiffness_of) {
    for (Load& load : loads_) load.held = load.unsoftened = 0.0;
    for (std::size_t i = 0; i < lines_.classes(); ++i) {
      const auto [held, unsoftened] = stiffness_of(i, lines_.along(i));
      load(i).held += held;
      load(i).unsoftened += unsoftened;
    }
    return softest_direction();
  }

 private:
  /// Loads along a line.
  struct Load {
    double force = 0.0;  ///< net force, and its partial derivatives
    double force_by_time = 0.0;
    double force_by_radius = 0.0;
    double stiffness = 0.0;
    double tangent_stiffness = 0.0;
    double kept_stiffness = 0.0;
    double held = 0.0;        ///< work space of unconstrained() and softest()
    double unsoftened = 0.0;  ///< work space of softest()
  };
  /// Load along the line of a class.
  [[nodiscard]] Load& load(std::size_t i) noexcept { return loads_[lines_.line_of(i)]; }
  [[nodiscard]] CentreMatrix stiffest_directions(double Load::*stiffness) const {
    return lines_.stiffest_directions([&](std::size_t line) { return loads_[line].*stiffness; });
  }
  [[nodiscard]] CentreVector step_along(double Load::*stiffness, double Load::*force) const;
  [[nodiscard]] CentreMatrix unconstrained_directions() const;
  [[nodiscard]] CentreStiffness softest_direction() const;

  contacts::CentreLines lines_;
  std::vector<Load> loads_;
  CentreVector force_ = CentreVector::Zero();
  CentreMatrix stiffness_ = CentreMatrix::Zero();
};

}  // namespace monograin::mdr
