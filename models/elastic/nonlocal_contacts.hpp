/// An elastic sphere among rigid frictionless flat walls, of which every contact moves the surface under all others.
///
/// Unknowns y: the signed square s of the contact radius of each class (elastic/nonlocal_law.hpp; below zero it is
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
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "elastic/nonlocal_coupling.hpp"
#include "elastic/nonlocal_law.hpp"
#include "elastic/nonlocal_modes.hpp"
#include "elastic/nonlocal_walls.hpp"
#include "system/walls.hpp"

namespace monograin::nonlocal {

/// Variant of the formulation, and the material.
struct Formulation {
  double poisson_ratio = 0.0;  ///< in [0, 0.5]
  Terms terms = Terms::four;
  Influence influence = Influence::half_space;
};

/// Whether the centre is fixed, or moves until the forces balance. Even a free centre does not move in directions in
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

/// Owns its working memory: solve(), rates(), margin() and the like do not allocate. Two threads must not use one
/// object at once.
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
  [[nodiscard]] double composite_modulus() const noexcept { return modulus_; }
  /// G: approach of a wall of the row's class per unit force on every wall of the column's class.
  [[nodiscard]] const Eigen::MatrixXd& coupling() const noexcept { return coupling_; }
  /// Unit vectors, one per column, along which the centre moves.
  [[nodiscard]] const Eigen::Matrix3Xd& free_directions() const noexcept { return directions_; }

  /// Finds the state at the coordinate xi of a step of the program (ramps over R and E R^2). Uses Newton's method;
  /// where that does not contract, or would leave the branch, approaches the state in smaller steps.
  /// @param y  in: a state on the physical branch, the nearer the better, or the unloaded state (s = -gap, u = 0),
  /// which is always on it. Out: the solution that is connected with that state. Unchanged if this throws.
  /// @param is_own_mode  true if the contacts that are loaded in y are also the loaded ones of the solution
  /// @throws std::domain_error naming the numbers for a state beyond the limit of applicability, a negative force, or a
  /// centre that nothing supports
  void solve(std::span<const Ramp> ramps, double xi, std::span<double> y, bool is_own_mode = false);

  /// Moves the centre to the nearest position where no wall under displacement control overlaps the surface, and sets y
  /// accordingly. If there is no such position, or a wall is under a force, the centre evades only redundant walls, in
  /// directions that leave the supporting contacts unchanged. With a fixed centre, sets the gaps of open walls from the
  /// forces on the others.
  /// @param is_closed  classes in contact by their regime; classes with s > 0 count as closed, too
  void clear_centre(std::span<const Ramp> ramps, double xi, std::span<const char> is_closed, std::span<double> y);

  /// True if touching walls with a gap up to `near` could balance the prescribed forces that act a little later.
  [[nodiscard]] bool may_be_held(std::span<const Ramp> ramps, std::span<const double> y, double near);

  /// dy/dxi along a solution. Regular from the unloaded state on, except for a class under force control at s = 0: its
  /// own s has an infinite rate, on which the other rates do not depend. A free centre leaves the unloaded state as if
  /// the contacts were equally stiff, which is exact where they will be.
  /// @param touch  gap (minus s) up to which walls touch: they may support the centre at once
  /// @param touches  classes whose idle walls may move the centre as soon as they touch; empty: all
  /// @param pull  least decay rate of a balance error where contacts bear the centre against a force
  /// @throws std::domain_error at and beyond the limit of applicability, and where nothing supports a free centre
  /// against prescribed forces
  void rates(std::span<const Ramp> ramps, std::span<const double> y, std::span<double> dy, double touch = 0.0,
             double pull = 0.0, std::span<const char> touches = {});

  /// Residual of the equations, one per unknown: the approach under displacement control, s_j - s(F_j) under force
  /// control, the net force for each free direction.
  void residual(std::span<const Ramp> ramps, double xi, std::span<const double> y, std::span<double> residual);
  /// Where no contact supports a free centre, the balance of forces does not determine its position. Replaces the
  /// balance in those directions by an equation for the centre's rate.
  /// @param is_closed  classes in contact
  /// @param missing    rate of the centre minus that of rates()
  /// @param balance    rows of residual() for the centre; rotated so that each holds either a force or a rate
  void let_unheld_centre_go(std::span<const Ramp> ramps, std::span<const char> is_closed,
                            const Eigen::Vector3d& missing, std::span<double> balance);
  /// d(residual)/dy.
  void jacobian(std::span<const Ramp> ramps, std::span<const double> y, Eigen::MatrixXd& jacobian);

  /// The margin, the smallest eigenvalue of M over all walls, whatever their control. Includes modes that break the
  /// symmetry of the classes if negative couplings may make those critical first.
  [[nodiscard]] double margin(std::span<const double> y);
  /// Smallest pivot of an elimination of M minus the shift; the first that is not positive, if there is one. Has the
  /// sign of the margin minus the shift, passes smoothly through zero with it, and costs a tenth of margin().
  [[nodiscard]] double least_pivot(std::span<const double> y, double shift = 0.0);

  /// Change of a class's signed square within which one step may follow the branch. Walls can push each other off the
  /// surface where 2 E* a times their coupling reaches 1, and that is over once contacts have grown several times.
  /// Infinite if no contact narrower than the particle reaches that radius.
  [[nodiscard]] double branch_reach(std::size_t index, double signed_square) const noexcept;

  /// True if, in some free direction, all walls with a gap below s are shallower than s or under force control.
  [[nodiscard]] bool is_held_softly(std::span<const Ramp> ramps, std::span<const double> y, double s);

  /// States of all contacts, one per class.
  void contacts(std::span<const double> y, std::span<ContactState> states);
  /// Contact radius in the deformed configuration a' (eq. 6 with the full instead of half the sum, because a wall acts
  /// as a mirror); 0 without contact.
  /// @throws std::domain_error for a contact radius of R or more
  [[nodiscard]] double deformed_radius(RadiusRule rule, std::size_t index, std::span<const double> y);
  /// Stored energy; its differential is the sum of w_j F_j dd_j.
  [[nodiscard]] double energy(std::span<const double> y);
  /// Stiffness matrix dF/dd over all classes. A free centre moves so that the forces stay in balance.
  /// @throws std::domain_error at and beyond the limit of applicability
  void stiffness(std::span<const double> y, Eigen::MatrixXd& stiffness);

 private:
  /// Relative to the largest signed square: correction at which Newton's method has converged.
  static constexpr double k_resolved = 4.0 * std::numeric_limits<double>::epsilon();
  /// Contacts shallower than this, over the walls' displacements or the deepest contact, do not show which ones will
  /// support the centre.
  static constexpr double k_unloaded = 1e-6;
  static constexpr double k_touching = 1e-10;  ///< gap at which walls begin to bear, over the walls' displacements
  static constexpr double k_balance = 1e-9;    ///< net force that counts as zero, over the sum of forces
  [[nodiscard]] static Eigen::Index at(std::size_t index) noexcept { return static_cast<Eigen::Index>(index); }

  struct Target {
    bool is_force = false;
    double value = 0.0;          ///< displacement or force
    double signed_square = 0.0;  ///< s under the prescribed force
  };

  /// Goal of Newton's method, and what is known before its first correction.
  struct Search {
    double imbalance = 0.0;  ///< share of imbalance_ that is left over; if 0, forces have to balance
    bool moves_centre = false;
    bool is_first_touch = false;   ///< no contact shows yet that it supports a free centre
    double farthest = 0.0;         ///< largest prescribed displacement, if forces have to balance
    double deepest = 0.0;          ///< signed square under the greatest prescribed force
    double touch_stiffness = 1.0;  ///< stiffness of contacts under the greatest prescribed force
    int free_steps = 1;            ///< first corrections, which need not contract

    /// False at intermediate points of a path in steps, which need no balance and keep the contacts of the last point.
    [[nodiscard]] bool is_to_balance() const noexcept { return imbalance == 0.0; }
  };

  /// One correction of Newton's method.
  struct Correction {
    double largest = 0.0;  ///< change of a signed square
    double scale = 0.0;    ///< largest signed square after it
  };

  void reserve_working_memory();
  [[nodiscard]] Target target(bool is_force, double value) const;
  void set_targets(std::span<const Ramp> ramps, double xi);
  void find_start(std::span<const Target> ends, std::span<const double> y, std::span<Target> starts);
  void set_targets_between(std::span<const Target> starts, std::span<const Target> ends, double share);
  void evaluate(std::span<const double> y);
  void forget() noexcept;
  [[nodiscard]] double lift(std::size_t index, std::span<const double> y) const noexcept;
  [[nodiscard]] double net_force(std::size_t direction) const noexcept;
  [[nodiscard]] bool eliminate() noexcept;
  [[nodiscard]] bool carries_no_load() const noexcept;
  [[nodiscard]] Eigen::Vector3d way_to_balance(const Eigen::Vector3d& net_force);
  void move_centre(const Eigen::Vector3d& net_force, std::span<double> centre);
  [[nodiscard]] Eigen::Matrix3d directions_of_nothing() const;
  [[nodiscard]] double unborne_force() const;
  bool lend_stiffness(double gap, std::span<const double> y);
  [[nodiscard]] Search begin_search(std::span<const double> y, double imbalance, bool moves_centre) const;
  [[nodiscard]] bool evaluate_trial(std::span<double> y);
  void set_misfits(std::span<const double> y);
  [[nodiscard]] Eigen::Vector3d corrected_net_force(double imbalance);
  void stiffen_touching(const Search& search, std::span<const double> y);
  void balance_centre(const Search& search, bool may_find_more, std::span<double> y);
  [[nodiscard]] Correction correct_squares(std::span<double> y);
  [[nodiscard]] bool is_rounding(const Correction& correction, std::span<const double> y) const;
  [[nodiscard]] bool newton(std::span<double> y, double imbalance, bool do_hold_centre = false);
  void find_redundant_walls();
  [[nodiscard]] bool has_redundant_walls() const;
  [[nodiscard]] bool may_balance(std::span<const Target> targets, std::span<const double> y,
                                 double near = std::numeric_limits<double>::infinity()) const;
  void find_holding_among(const auto& is_force);
  bool find_holding(std::span<const double> y, double gap = 0.0);
  void sort_near(std::span<const Ramp> ramps, std::span<const double> y, double near);
  [[nodiscard]] Eigen::Matrix3d unheld_directions() const;
  void take_along(std::span<const Ramp> ramps, std::span<const double> y, double touch, std::span<const char> touches,
                  std::span<double> dy);
  [[nodiscard]] bool take_centre_to_targets(std::span<double> y);
  [[nodiscard]] bool sink_to_balance(std::span<double> y);
  [[nodiscard]] bool leaves_forces(const Eigen::Matrix3d& projector, std::span<const double> y);
  [[nodiscard]] bool let_all_go(std::span<double> y);
  [[nodiscard]] bool let_others_go(std::span<double> y);
  bool let_bystanders_go(std::span<const char> is_closed, std::span<double> y);
  void close_gaps(std::span<const char> is_closed, std::span<double> y);
  [[nodiscard]] bool has_left_branch(std::span<const double> y);
  [[nodiscard]] bool is_balanced(std::span<const double> y);
  [[nodiscard]] bool is_balanced_but_for_rounding(std::span<const double> y);
  [[nodiscard]] bool let_go_on(std::span<const Ramp> ramps, std::span<const double> y, std::span<double> dy,
                               double touch, std::span<const char> touches);
  void set_approach_rates_of_walls(std::span<const Ramp> ramps);
  void let_centre_follow(std::span<const Ramp> ramps, std::span<const double> y, std::span<double> dy, double touch,
                         double pull, std::span<const char> touches);
  [[nodiscard]] Eigen::Vector3d error_against_forces(std::span<const Ramp> ramps, std::span<const double> y,
                                                     double touch) const;
  [[nodiscard]] double error_decay(std::span<const Ramp> ramps, double least) const noexcept;
  [[nodiscard]] double reach_of_support(std::span<const Ramp> ramps, std::span<const double> y, double touch) const;
  [[nodiscard]] double free_approach(std::size_t index, const Eigen::Vector3d& centre,
                                     double rounding = k_resolved) const;
  [[nodiscard]] bool release_centre(const Eigen::Matrix3d& projector, Eigen::Vector3d& centre) const;
  [[nodiscard]] bool clear_walls(std::size_t count, const Eigen::Matrix3d& projector, Eigen::Vector3d& place,
                                 double rounding = k_resolved) const;
  [[nodiscard]] double lift_by_forces(std::size_t index) const noexcept;
  void put(const Eigen::Vector3d& place, std::span<double> y) const;
  [[nodiscard]] Eigen::Vector3d place_of(std::span<const double> y) const;
  [[nodiscard]] Eigen::Vector3d arm_of(std::size_t index) const;
  void approach_in_steps(std::span<double> y);

  [[nodiscard]] double& entry(std::size_t row, std::size_t column) noexcept { return matrix_[row * stride_ + column]; }

  double poisson_ratio_;
  LocalLaw law_;
  double modulus_;  ///< E* over E
  std::vector<double> weights_;
  Eigen::MatrixXd coupling_;
  Eigen::Matrix3Xd directions_;
  Eigen::MatrixXd arms_;  ///< mean normals along the free directions

  std::vector<std::vector<Neighbours>> neighbours_;  ///< of the first wall of each class

  Modes modes_;  ///< of the classes; of all walls if a coupling is negative
  bool has_modes_of_walls_ = false;
  std::vector<double> rivalry_;  ///< s of each class from which walls push each other off; infinite if they do not

  // Working memory.
  std::size_t stride_;
  std::vector<LocalContact> now_;
  std::vector<double> forces_;
  std::vector<double> stiffness_;           ///< dF/dg; 0 under force control
  std::vector<double> seen_;                ///< signed squares of the cached evaluation
  std::vector<double> free_displacements_;  ///< of the walls that the centre evades; k_no_wall: all others
  std::vector<char> may_bear_;              ///< classes among which redundant walls are sought
  std::vector<char> sorted_;                ///< may_bear_ for which is_redundant_ was found
  std::vector<char> is_redundant_;
  std::vector<char> holds_;     ///< supports a free centre under displacement control
  std::vector<double> matrix_;  ///< a row per class: 1 - G dF/dg, right-hand side, arms
  std::vector<Target> targets_, first_targets_, last_targets_;
  std::vector<double> trial_, state_, unit_rates_;
  // Working memory of take_centre_to_targets().
  std::vector<Target> way_start_, way_end_;
  std::vector<double> carried_, at_once_, by_halves_, early_, late_;
  std::vector<Ramp> unit_ramps_;
  Eigen::Vector3d imbalance_ = Eigen::Vector3d::Zero();
};

}  // namespace monograin::nonlocal
