/// Balance of the forces on the free centre of a particle: what contacts do to it, and how it moves for that.
///
/// The centre moves along the mean normals of the contact classes only, which keeps the symmetry of the walls. Walls
/// that face each other, or the same way, push it along one line. What they do is summed up there before it is
/// resolved: the round-off of large forces that nearly cancel would otherwise act across the line, where a soft contact
/// may be all that constrains the centre. Lengths in R0.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "system/walls.hpp"

namespace monograin::mdr {

/// Vectors and matrices along the free directions of the centre; entries beyond their number are zero.
using CentreVector = Eigen::Vector3d;
using CentreMatrix = Eigen::Matrix3d;

/// Load of a class of contacts on the centre, per wall, towards the centre positive.
struct CentreLoad {
  double count = 1.0;
  double force = 0.0;
  double force_by_time = 0.0;
  double force_by_radius = 0.0;
  double stiffness = 0.0;
  double tangent_stiffness = 0.0;  ///< no less than that of a touch
};

/// Tangent stiffness of the centre in its softest direction, over what it would be if no edge peeled and no contact
/// were softened past its peak.
struct CentreStiffness {
  double value = 0.0;
  CentreVector direction = CentreVector::Zero();
};

class FreeCentre {
 public:
  /// Smallest mean normal of a contact class, along the free directions, that counts. The stiffness along them goes
  /// with its square, and is round-off below this.
  static constexpr double k_no_direction = 1e-6;

  FreeCentre() = default;
  /// @param is_free  false: nothing moves the centre
  FreeCentre(std::span<const ContactClass> classes, bool is_free);

  /// Free directions, 0 to 3.
  [[nodiscard]] int count() const noexcept { return count_; }
  [[nodiscard]] bool is_free() const noexcept { return count_ > 0; }
  /// Mean normal of a class along the free directions.
  [[nodiscard]] const CentreVector& direction(std::size_t i) const noexcept { return directions_[i]; }
  /// True if a contact of the class acts on the centre.
  [[nodiscard]] bool acts(std::size_t i) const noexcept { return is_free() && acts_[i]; }
  /// A vector along the free directions, in space.
  [[nodiscard]] Eigen::Vector3d in_space(const CentreVector& vector) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int k = 0; k < count_; ++k) sum += basis_.col(k) * vector[k];
    return sum;
  }

  /// Forgets all loads.
  void clear() noexcept {
    for (Line& line : lines_) line = {.direction = line.direction, .kept_stiffness = line.kept_stiffness};
  }
  void add(std::size_t i, const CentreLoad& load) noexcept {
    const double along = on_lines_[i].along;
    Line& line = lines_[on_lines_[i].line];
    line.force += load.count * load.force * along;
    line.force_by_time += load.count * load.force_by_time * along;
    line.force_by_radius += load.count * load.force_by_radius * along;
    line.stiffness += load.count * load.stiffness * along * along;
    line.tangent_stiffness += load.count * load.tangent_stiffness * along * along;
  }
  /// Sums the loads of all lines up.
  /// @param least_stiffness  of a touch; at first touch all stiffnesses vanish together, and are in proportion to their
  ///                         tangents
  void sum_up(double least_stiffness) noexcept;
  [[nodiscard]] const CentreVector& force() const noexcept { return force_; }
  [[nodiscard]] const CentreMatrix& stiffness() const noexcept { return stiffness_; }

  // Displacements of the centre; none along directions in which no contact constrains it.

  /// Cancels the net force, by the stiffnesses, or by the tangent ones.
  [[nodiscard]] CentreVector step() const { return step_along(&Line::stiffness, &Line::force); }
  [[nodiscard]] CentreVector tangent_step() const { return step_along(&Line::tangent_stiffness, &Line::force); }
  /// Cancels it by the stiffnesses that keep_stiffness() saw.
  [[nodiscard]] CentreVector step_of_kept() const { return step_along(&Line::kept_stiffness, &Line::force); }
  void keep_stiffness() noexcept;
  /// Rates with the step coordinate and with the radius.
  [[nodiscard]] CentreVector by_time() const { return step_along(&Line::tangent_stiffness, &Line::force_by_time); }
  [[nodiscard]] CentreVector by_radius() const { return step_along(&Line::tangent_stiffness, &Line::force_by_radius); }

  /// Projector on the directions in which no contact constrains the centre.
  /// @param constrains  contact class -> whether it does
  template <class Constrains>
  [[nodiscard]] CentreMatrix unconstrained(Constrains&& constrains) {
    for (Line& line : lines_) line.held = 0.0;
    for (std::size_t i = 0; i < on_lines_.size(); ++i) {
      const OnLine& on = on_lines_[i];
      if (constrains(i)) lines_[on.line].held += on.along * on.along;
    }
    return unconstrained_directions();
  }
  /// @param stiffness_of  contact class, component of its mean normal along its line -> its tangent stiffness along
  /// that
  ///                      line, and the one without peeling and softening
  template <class StiffnessOf>
  [[nodiscard]] CentreStiffness softest(StiffnessOf&& stiffness_of) {
    for (Line& line : lines_) line.held = line.unsoftened = 0.0;
    for (std::size_t i = 0; i < on_lines_.size(); ++i) {
      const OnLine& on = on_lines_[i];
      const auto [held, unsoftened] = stiffness_of(i, on.along);
      lines_[on.line].held += held;
      lines_[on.line].unsoftened += unsoftened;
    }
    return softest_direction();
  }

 private:
  struct Line {
    CentreVector direction = CentreVector::Zero();
    double force = 0.0;  ///< net force, and its partial derivatives
    double force_by_time = 0.0;
    double force_by_radius = 0.0;
    double stiffness = 0.0;
    double tangent_stiffness = 0.0;
    double kept_stiffness = 0.0;
    double held = 0.0;        ///< work space of unconstrained() and softest()
    double unsoftened = 0.0;  ///< work space of softest()
  };
  /// Mean normal of a class as a multiple of the direction of a line.
  struct OnLine {
    std::size_t line = 0;
    double along = 0.0;
  };

  void find_lines();
  [[nodiscard]] CentreMatrix stiffest_directions(double Line::*stiffness) const;
  [[nodiscard]] static CentreVector components(const CentreMatrix& basis, const Line& line);
  [[nodiscard]] CentreVector step_along(double Line::*stiffness, double Line::*force) const;
  [[nodiscard]] CentreMatrix unconstrained_directions() const;
  [[nodiscard]] CentreStiffness softest_direction() const;

  int count_ = 0;
  Eigen::Matrix3d basis_ = Eigen::Matrix3d::Zero();  ///< orthonormal, in the first columns
  std::vector<CentreVector> directions_;
  std::vector<bool> acts_;
  std::vector<Line> lines_;
  std::vector<OnLine> on_lines_;
  CentreVector force_ = CentreVector::Zero();
  CentreMatrix stiffness_ = CentreMatrix::Zero();
};

}  // namespace monograin::mdr
