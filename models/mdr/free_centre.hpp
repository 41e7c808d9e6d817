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
  double stiffness = 0.0;              ///< tangent stiffness dF/d(delta)
  double regularized_stiffness = 0.0;  ///< at least that of an idle contact: ContactBranch::regularized_stiffness()
};

/// Present stiffness of the centre in its softest direction over the reference: what it would be if no edge peeled and
/// no contact were softened past its peak.
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
  [[nodiscard]] int free_directions() const noexcept { return lines_.free_directions(); }
  [[nodiscard]] bool is_free() const noexcept { return free_directions() > 0; }
  /// Mean normal of a class along the free directions.
  [[nodiscard]] const CentreVector& mean_normal(std::size_t i) const noexcept { return lines_.mean_normal(i); }
  /// n.x, by how much a displacement of the centre brings it nearer to the walls of a class.
  /// @param position  of the centre along the free directions, and whatever follows
  [[nodiscard]] double approach_by_centre(std::size_t i, std::span<const double> position) const noexcept {
    double distance = 0.0;
    for (int k = 0; k < free_directions(); ++k) distance += mean_normal(i)[k] * position[static_cast<std::size_t>(k)];
    return distance;
  }
  /// True if a contact of the class acts on the centre.
  [[nodiscard]] bool acts(std::size_t i) const noexcept { return is_free() && lines_.acts(i); }
  /// A vector along the free directions, in space.
  [[nodiscard]] Eigen::Vector3d in_space(const CentreVector& vector) const { return lines_.in_space(vector); }

  /// Sets all loads to zero. The stiffnesses of keep_stiffness() stay.
  void clear() noexcept {
    for (Load& load : loads_) load = {.stiffness_at_last_step = load.stiffness_at_last_step};
  }
  void add(std::size_t i, const CentreLoad& added) noexcept {
    const double share = lines_.share_on_line(i);
    Load& line = load(i);
    line.force += added.count * added.force * share;
    line.force_by_time += added.count * added.force_by_time * share;
    line.force_by_radius += added.count * added.force_by_radius * share;
    line.stiffness += added.count * added.stiffness * share * share;
    line.regularized_stiffness += added.count * added.regularized_stiffness * share * share;
  }
  /// Sums up the loads of all lines. A line without stiffness, as at first touch, takes its regularized stiffness.
  void sum_up() noexcept;
  [[nodiscard]] const CentreVector& force() const noexcept { return force_; }
  [[nodiscard]] const CentreMatrix& stiffness() const noexcept { return stiffness_; }

  // Displacements of the centre; zero along directions in which no contact constrains it.

  /// Newton step of the centre: displacement that cancels the net force with the tangent stiffnesses.
  [[nodiscard]] CentreVector step() const { return step_along(&Load::stiffness, &Load::force); }
  /// Displacement of the centre that cancels the net force with the regularized stiffnesses.
  [[nodiscard]] CentreVector regularized_step() const { return step_along(&Load::regularized_stiffness, &Load::force); }
  /// Displacement of the centre that cancels the net force with the stiffnesses that keep_stiffness() stored last.
  [[nodiscard]] CentreVector step_with_last_stiffness() const {
    return step_along(&Load::stiffness_at_last_step, &Load::force);
  }
  void keep_stiffness() noexcept;
  /// Derivatives of the centre's position by the step coordinate and by the radius.
  [[nodiscard]] CentreVector by_time() const { return step_along(&Load::regularized_stiffness, &Load::force_by_time); }
  [[nodiscard]] CentreVector by_radius() const {
    return step_along(&Load::regularized_stiffness, &Load::force_by_radius);
  }

  /// Projector on the directions in which no contact constrains the centre.
  /// @param constrains  contact class -> whether it does
  template <class Constrains>
  [[nodiscard]] CentreMatrix unconstrained(Constrains&& constrains) {
    for (Load& load : loads_) load.present = 0.0;
    for (std::size_t i = 0; i < lines_.classes(); ++i) {
      if (constrains(i)) load(i).present += lines_.share_on_line(i) * lines_.share_on_line(i);
    }
    return unconstrained_directions();
  }
  /// Softest direction of the centre, and its present stiffness over the reference: the stiffness without peeling and
  /// softening.
  /// @param stiffness_of  (contact class, CentreLines::share_on_line()) -> present and reference stiffness along its
  /// line
  template <class StiffnessOf>
  [[nodiscard]] CentreStiffness softest(StiffnessOf&& stiffness_of) {
    for (Load& load : loads_) load.present = load.reference = 0.0;
    for (std::size_t i = 0; i < lines_.classes(); ++i) {
      const auto [present, reference] = stiffness_of(i, lines_.share_on_line(i));
      load(i).present += present;
      load(i).reference += reference;
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
    double regularized_stiffness = 0.0;
    double stiffness_at_last_step = 0.0;  ///< from keep_stiffness()
    double present = 0.0;                 ///< work space of unconstrained() and softest()
    double reference = 0.0;               ///< work space of softest()
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
