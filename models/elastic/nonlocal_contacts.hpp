/// An elastic sphere among rigid frictionless flat walls, of which every contact moves the surface under all others.
///
/// Unknowns y: the signed square s of the contact radius of each class (elastic/nonlocal_law.hpp; below zero it is
/// minus the gap), then the displacement u of the centre in each direction in which it is free. For every class
///
///   g(s_j) = d_j + n_j.u + sum_h G_jh F_h                                (eqs. 17, 18)
///
/// and in every free direction sum_j w_j F_j n_j = 0, with the wall displacement d, the mean normal n, the number of
/// walls w. The sign of s_j says whether the contact is open, so that nothing has to be decided.
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

/// Which of the variants of the formulation is meant, and of what material.
struct Formulation {
  double poisson_ratio = 0.0;  ///< in [0, 0.5]
  Terms terms = Terms::four;
  Influence influence = Influence::half_space;
};

/// Whether the centre stays where it is, or moves until the forces balance. In directions in which every class balances
/// itself it stays in any case.
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

/// Owns its working memory: solve(), rates(), margin() and the like do not allocate, and one object is not to be used
/// by two threads at once.
class Contacts {
 public:
  /// @param classes  walls that share a history by symmetry; only their normals are used
  /// @throws std::invalid_argument for a Poisson's ratio outside [0, 0.5], walls that are the same or closer than
  /// k_least_wall_angle, and classes of which not every wall sees the same forces around it
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

  /// Finds the state at the coordinate xi of a step of the program (ramps over R and E R^2).
  /// @param y  in: a state on the physical branch, the nearer the better; the unloaded one (s = -gap, u = 0) always is
  /// one. Out: the solution that is connected with it. Unchanged where this throws.
  /// Newton's method; where it does not contract, or would leave the branch, it goes there in smaller steps of the
  /// program.
  /// @throws std::domain_error naming the numbers for a state beyond the limit of applicability, a negative force, or a
  /// centre that nothing holds
  /// @param is_own_mode  the contacts that bear in y do so in the state that is sought, too
  void solve(std::span<const Ramp> ramps, double xi, std::span<double> y, bool is_own_mode = false);

  /// Moves the centre to the nearest place where no wall under displacement control is beyond the surface, and sets y
  /// accordingly. If the walls leave no such place, or one is under a force: out of the way of those that touch but
  /// cannot bear, where that changes nothing for contacts that hold it. Where the centre is fixed, gaps are what they
  /// are under the forces of the others.
  /// @param is_closed  classes in contact; others are where their s is above zero
  void clear_centre(std::span<const Ramp> ramps, double xi, std::span<const char> is_closed, std::span<double> y);

  /// Whether walls as near as that may hold a centre that contacts do not, against the forces of a little later.
  [[nodiscard]] bool may_be_held(std::span<const Ramp> ramps, std::span<const double> y, double near);

  /// dy/dxi along a solution. Regular from the unloaded state on, but for a class under force control at s = 0, where
  /// its own s has an infinite rate; the other rates do not depend on that. A free centre leaves the unloaded state as
  /// if the contacts were equally stiff, which is exact where they will be.
  /// @param touch  walls with an s less than this below zero touch: they may hold the centre at once
  /// @param touches  walls that may take the centre along as soon as they touch; empty: all
  /// @param pull  how fast contacts that bear the centre against a force are drawn back to their balance, at least
  /// @throws std::domain_error at and beyond the limit of applicability, and where nothing holds a free centre against
  /// prescribed forces
  void rates(std::span<const Ramp> ramps, std::span<const double> y, std::span<double> dy, double touch = 0.0,
             double pull = 0.0, std::span<const char> touches = {});

  /// What is left of the equations, one per unknown: that of the approach under displacement control, s_j - s(F_j)
  /// under force control, balance of forces.
  void residual(std::span<const Ramp> ramps, double xi, std::span<const double> y, std::span<double> residual);
  /// Where no contact holds a free centre, the balance of forces does not determine it: puts what is missing to its
  /// rate in place of that.
  /// @param is_closed  classes in contact
  /// @param missing    rate of the centre less that of rates()
  /// @param balance    rows of residual() for the centre; each is turned to say the one or the other
  void let_unheld_centre_go(std::span<const Ramp> ramps, std::span<const char> is_closed,
                            const Eigen::Vector3d& missing, std::span<double> balance);
  /// d(residual)/dy.
  void jacobian(std::span<const Ramp> ramps, std::span<const double> y, Eigen::MatrixXd& jacobian);

  /// The margin, over all walls and whatever their control: modes that break the symmetry of the classes count where
  /// negative couplings let them come first.
  [[nodiscard]] double margin(std::span<const double> y);
  /// The least pivot of an elimination, or the first that is not positive: has the sign of the margin less the shift,
  /// goes smoothly through zero with it, and costs a tenth.
  [[nodiscard]] double least_pivot(std::span<const double> y, double shift = 0.0);

  /// How far the signed square of a class may go while the branch is followed at once. A wall under which others lift
  /// the surface may be pushed off by them, or they by it, from where 2 E* a times their coupling is 1; that is over
  /// where contacts have grown several times. Infinite where no contact narrower than the particle does that.
  [[nodiscard]] double branch_reach(std::size_t index, double signed_square) const noexcept;

  /// Whether a free centre moves in a direction in which touching contacts shallower than s hold it alone, or none.
  [[nodiscard]] bool is_held_softly(std::span<const Ramp> ramps, std::span<const double> y, double s);

  /// All contacts, one per class.
  void contacts(std::span<const double> y, std::span<ContactState> states);
  /// Contact radius in the deformed configuration a' (eq. 6 for a wall, which is a mirror: with the full instead of
  /// half the sum); 0 without contact.
  /// @throws std::domain_error for a contact radius of R or more
  [[nodiscard]] double deformed_radius(RadiusRule rule, std::size_t index, std::span<const double> y);
  /// Stored energy; its differential is the sum of w_j F_j dd_j.
  [[nodiscard]] double energy(std::span<const double> y);
  /// dF/dd over all classes, with the centre free where it is.
  /// @throws std::domain_error at and beyond the limit of applicability
  void stiffness(std::span<const double> y, Eigen::MatrixXd& stiffness);

 private:
  /// Of the largest signed square: what Newton's method leaves open.
  static constexpr double k_resolved = 4.0 * std::numeric_limits<double>::epsilon();
  /// Contacts shallower than this, over where the walls go, say nothing of which will bear the centre.
  static constexpr double k_unloaded = 1e-6;
  static constexpr double k_touching = 1e-10;  ///< gap of walls that begin to bear
  static constexpr double k_balance = 1e-9;    ///< net force over the sum of forces
  [[nodiscard]] static Eigen::Index at(std::size_t index) noexcept { return static_cast<Eigen::Index>(index); }

  struct Target {
    bool is_force = false;
    double value = 0.0;          ///< displacement or force
    double signed_square = 0.0;  ///< under that force
  };

  /// What Newton's method is to find, and what is known of that beforehand.
  struct Search {
    double imbalance = 0.0;  ///< share of imbalance_ that is left; where it is none, forces have to balance
    bool moves_centre = false;
    bool is_first_touch = false;   ///< a free centre has yet to find out which contacts bear it
    double farthest = 0.0;         ///< prescribed displacement, where forces have to balance
    double deepest = 0.0;          ///< signed square under the greatest force
    double touch_stiffness = 1.0;  ///< that of contacts under the greatest force
    int free_steps = 1;            ///< corrections at first that need not contract

    /// On a path in steps nobody asks for balance, and the contacts are those of the state before.
    [[nodiscard]] bool is_to_balance() const noexcept { return imbalance == 0.0; }
  };

  /// One of the corrections of Newton's method.
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
  [[nodiscard]] bool bears_nothing() const noexcept;
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

  Modes modes_;  ///< of the classes, or of all walls where a coupling is negative
  bool has_modes_of_walls_ = false;
  std::vector<double> rivalry_;  ///< s of each class from where walls push each other off; infinite where they do not

  // Working memory.
  std::size_t stride_;
  std::vector<LocalContact> now_;
  std::vector<double> forces_;
  std::vector<double> stiffness_;           ///< dF/dg; 0 under force control
  std::vector<double> seen_;                ///< signed squares that these are of
  std::vector<double> free_displacements_;  ///< of the walls that a centre goes out of the way of
  std::vector<char> may_bear_;              ///< among which bystanders are sought
  std::vector<char> sorted_;                ///< that these are of
  std::vector<char> is_redundant_;
  std::vector<char> holds_;     ///< bears a free centre under displacement control
  std::vector<double> matrix_;  ///< a row per class: 1 - G dF/dg, right-hand side, arms
  std::vector<Target> targets_, first_targets_, last_targets_;
  std::vector<double> trial_, state_, unit_rates_;
  // On a way on which walls take the centre along.
  std::vector<Target> way_start_, way_end_;
  std::vector<double> carried_, at_once_, by_halves_, early_, late_;
  std::vector<Ramp> unit_ramps_;
  Eigen::Vector3d imbalance_ = Eigen::Vector3d::Zero();
};

}  // namespace monograin::nonlocal
