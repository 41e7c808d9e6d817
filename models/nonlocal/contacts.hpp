/// An elastic sphere among rigid frictionless flat walls, of which every contact moves the surface under all others.
///
/// Unknowns y: the signed square s of the contact radius of each class (nonlocal/law.hpp; below zero it is
/// minus the gap), then the displacement u of the centre in each direction in which it is free. For every class
///
///   g(s_j) = d_j + n_j.u + sum_h G_jh F_h                                (eqs. 17, 18)
///
/// and in every free direction sum_j w_j F_j n_j = 0, with the wall displacement d, the mean normal n, the number of
/// walls w. The sign of s_j shows whether the contact is open, so that no regime has to be chosen beforehand.
///
/// Lengths are over R, forces over E R^2, energies over E R^3; a force is that on one wall of its class.
///
/// The branch. Because G mostly couples positively there may be several solutions. The physical one is connected with
/// the unloaded state, and on it the matrix
///
///   M = 1 - 2 E* sqrt(a) G sqrt(a)
///
/// over all walls is positive definite. Its smallest eigenvalue is the margin: 1 unloaded, 0 at the limit of
/// applicability, where the stiffness becomes infinite and the path turns back.
/// Source: Agarwal and Gonzalez (2018), sections 2 to 4. Elastic: no memory, unloading retraces loading.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "nonlocal/coupling.hpp"
#include "nonlocal/law.hpp"
#include "nonlocal/modes.hpp"
#include "nonlocal/walls.hpp"
#include "system/resolution.hpp"
#include "system/walls.hpp"

namespace monograin::nonlocal {

/// Variant of the formulation, and the material.
struct Formulation {
  double poisson_ratio = 0.0;  ///< in [0, 0.5]
  Terms terms = Terms::four;
  Influence influence = Influence::half_space;
};

/// Motion of the centre: fixed, or to where the forces balance. Even a free centre does not move in directions in
/// which the forces of every class balance by symmetry.
enum class Centre { fixed, free };

/// One contact of a class. Everything but displacement, approach and square is 0 without contact.
struct ContactState {
  double displacement = 0.0;    ///< d of the wall
  double approach = 0.0;        ///< g, total local approach
  double signed_square = 0.0;   ///< s
  double contact_radius = 0.0;  ///< a, in the reference configuration
  double force = 0.0;           ///< F
  double stiffness = 0.0;       ///< dF/dg at fixed surroundings, 2 E* a
};

// Tolerances that several searches share.

/// Contacts with a smaller overlap than this, over the walls' displacements or the deepest contact, support a free
/// centre too softly for an integrator, and do not show which ones will support it.
inline constexpr double k_unloaded = 1e-6;
/// Gap or overlap of a wall that just touches a free centre, over the walls' displacements or the deepest contact: its
/// s has the forces' round-off to the power 2/3.
inline constexpr double k_touching = 1e-9;

/// Local contacts of all classes, with their surroundings as they are.
struct Evaluation {
  std::vector<LocalContact> local;
  std::vector<double> forces;     ///< F on one wall
  std::vector<double> stiffness;  ///< dF/dg at fixed surroundings

  explicit Evaluation(std::size_t classes) : local(classes), forces(classes), stiffness(classes) {}
  /// Evaluates one contact at a signed square.
  void set(std::size_t j, const LocalLaw& law, double modulus, double signed_square) {
    local[j] = law.at(signed_square);
    forces[j] = modulus * local[j].force;
    stiffness[j] = 2.0 * modulus * local[j].contact_radius;
  }
};

/// All contacts at a state. Keeps the evaluation of the state seen last. Does not allocate once it is made, and two
/// threads must not use one object at once.
class Contacts {
 public:
  /// @param classes  walls that share a history by symmetry; only their normals are used
  /// @throws std::invalid_argument for a Poisson's ratio outside [0, 0.5], walls that are the same or closer than
  /// k_least_wall_angle, and classes whose walls do not all have equal surroundings
  Contacts(const Formulation& model, std::span<const ContactClass> classes, Centre centre);

  [[nodiscard]] std::size_t class_count() const noexcept { return weights_.size(); }
  /// Number of directions in which the centre moves.
  [[nodiscard]] std::size_t free_count() const noexcept { return static_cast<std::size_t>(directions_.cols()); }
  [[nodiscard]] std::size_t unknown_count() const noexcept { return class_count() + free_count(); }
  [[nodiscard]] const LocalLaw& law() const noexcept { return law_; }
  /// E* over E.
  [[nodiscard]] double composite_modulus() const noexcept { return modulus_; }
  /// G: approach of a wall of the row's class per unit force on every wall of the column's class.
  [[nodiscard]] const Eigen::MatrixXd& coupling() const noexcept { return coupling_; }
  /// Unit vectors, one per column, along which the centre moves.
  [[nodiscard]] const Eigen::Matrix3Xd& free_directions() const noexcept { return directions_; }
  /// Number of walls of a class.
  [[nodiscard]] double weight(std::size_t j) const noexcept { return weights_[j]; }
  /// Mean normal of a class along the free directions; 0 beyond their number.
  [[nodiscard]] const Eigen::Vector3d& mean_normal(std::size_t j) const noexcept { return mean_normals_[j]; }
  /// Neighbours of the first wall of a class.
  [[nodiscard]] std::span<const Neighbours> neighbours(std::size_t j) const noexcept { return neighbours_[j]; }
  /// Displacement of the centre in a state, along the free directions.
  [[nodiscard]] Eigen::Vector3d centre_of(std::span<const double> y) const;
  /// Approach that a displacement of the centre adds to that of a wall.
  [[nodiscard]] double approach_by_centre(std::size_t j, std::span<const double> y) const noexcept;

  /// Contacts at a state; valid until another state is asked for.
  /// @throws std::domain_error for a contact beyond the end of the law
  const Evaluation& evaluate(std::span<const double> y);
  /// Approach that the forces on all walls add to that of a wall, sum_h G_jh F_h.
  [[nodiscard]] double lift_by_forces(std::size_t j, std::span<const double> forces) const noexcept;
  /// Approach that the displacement of the centre and the forces on all walls add to that of a wall.
  [[nodiscard]] double lift(std::size_t j, std::span<const double> forces, std::span<const double> y) const noexcept;
  /// Sum of the forces on all walls along the free directions.
  [[nodiscard]] Eigen::Vector3d net_force(std::span<const double> forces) const;
  /// Writes the displacement of the centre, or its rate, to a state.
  void set_centre(const Eigen::Vector3d& centre, std::span<double> y) const {
    std::copy_n(centre.begin(), free_count(), y.begin() + static_cast<std::ptrdiff_t>(class_count()));
  }

  /// The margin, the smallest eigenvalue of M over all walls, whatever their control. Includes modes that break the
  /// symmetry of the classes if negative couplings may make those critical first.
  [[nodiscard]] double margin(std::span<const double> y);
  /// Smallest pivot of an elimination of M minus the shift; the first that is not positive, if there is one. Has the
  /// sign of the margin minus the shift, passes smoothly through zero with it, and costs a tenth of margin().
  [[nodiscard]] double least_pivot(std::span<const double> y, double shift = 0.0);
  /// True if the margin includes modes that break the symmetry of the classes, which Newton's method does not see.
  [[nodiscard]] bool has_modes_of_walls() const noexcept { return has_modes_of_walls_; }
  /// Change of a class's signed square within which one step may follow the branch. Walls can push each other off the
  /// surface where 2 E* a times their coupling reaches 1, and that is over once contacts have grown several times.
  /// Infinite if no contact narrower than the particle reaches that radius.
  [[nodiscard]] double branch_reach(std::size_t index, double signed_square) const noexcept;

  /// States of all contacts, one per class.
  void contacts(std::span<const double> y, std::span<ContactState> states);
  /// Contact radius in the deformed configuration a' (eq. 6 with the full instead of half the sum, because a wall acts
  /// as a mirror); 0 without contact.
  /// @throws std::domain_error for a contact radius of R or more
  [[nodiscard]] double deformed_radius(RadiusRule rule, std::size_t index, std::span<const double> y);
  /// Stored energy; its differential is the sum of w_j F_j dd_j.
  [[nodiscard]] double energy(std::span<const double> y);

 private:
  double poisson_ratio_;
  LocalLaw law_;
  double modulus_;
  std::vector<double> weights_;
  Eigen::MatrixXd coupling_;
  Eigen::Matrix3Xd directions_;
  std::vector<Eigen::Vector3d> mean_normals_;
  std::vector<std::vector<Neighbours>> neighbours_;  ///< of the first wall of each class
  std::vector<double> rivalry_;  ///< s of each class from which walls push each other off; infinite if they do not
  bool has_modes_of_walls_ = false;
  Modes modes_;  ///< of the classes; of all walls if a coupling is negative

  Evaluation at_{0};
  std::vector<double> seen_;  ///< signed squares at which at_ was evaluated
};

}  // namespace monograin::nonlocal
