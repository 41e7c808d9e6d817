/// The equations of a coupled elastic-plastic particle at a state.
///
/// Every contact presses a dent (contact_law.hpp) into a core, which yields as a whole by the deviator of its mean
/// stress. Contacts act on each other through the elastic sphere, through the core, and through how much of the surface
/// the contacts cover. For every class of walls
///
///   d + n.x = h + c + u - sum_j G_j F_j                                                  (K)
///
/// with the wall displacement d, the centre x, the plastic indentation h, the advance c that the core makes room for,
/// the elastic displacement u and the influence G of all contacts; the centre obeys sum F n = 0 (E). A contact that
/// flows obeys f = (X + Q)^(1/n1) - 1 = 0, where X and Q are the used shares of the strengths of dent and core. The
/// core flows at the rate Lam (core.hpp), which the contacts that drive it determine.
///
/// Lengths are over R0, stresses over E, forces over E R0^2, energies over E R0^3. Own law of this project
/// (docs/theory/cel.md); (K) and (E) are its (cel-kinematics).
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "cel/centre.hpp"
#include "cel/contact_law.hpp"
#include "cel/core.hpp"
#include "contacts/wall_drive.hpp"

namespace monograin::cel {

/// Indices of the unknowns in a state: own coordinate and dent of every class, centre, core.
struct Layout {
  std::size_t classes = 0;
  std::size_t directions = 0;  ///< free directions of the centre
  std::size_t shapes = 0;      ///< shapes of the core; 0: it keeps its shape, and is no unknown

  [[nodiscard]] std::size_t dent(std::size_t i) const noexcept { return classes + i; }
  [[nodiscard]] bool is_dent(std::size_t k) const noexcept { return k >= classes && k < 2 * classes; }
  [[nodiscard]] std::size_t centre(std::size_t k) const noexcept { return 2 * classes + k; }
  /// First index of the core: the components of C - 1 among its shapes, then e.
  [[nodiscard]] std::size_t core() const noexcept { return 2 * classes + directions; }
  [[nodiscard]] bool has_core() const noexcept { return shapes > 0; }
  [[nodiscard]] std::size_t size() const noexcept { return core() + (has_core() ? shapes + 1 : 0); }
  /// Displacement of the centre along its free directions.
  [[nodiscard]] Eigen::Vector3d centre_of(std::span<const double> y) const noexcept {
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    std::ranges::copy(y.subspan(centre(0), directions), x.begin());
    return x;
  }
};

/// Program of a class of walls, and the part that its contacts play in a mode.
struct ClassMode {
  contacts::WallDrive drive{};
  bool is_released = false;  ///< the wall bears no force: it rests until the surface meets it, then moves along
  bool touches = false;
  bool flows = false;  ///< the dent grows

  /// True if the own coordinate is the force F, not u.
  [[nodiscard]] bool is_force_controlled() const noexcept { return drive.is_force_controlled(); }
  /// Lets the wall rest at a displacement.
  void hold(double at) { drive = contacts::WallDrive({at, at, Control::displacement}, 1.0); }
  [[nodiscard]] bool operator==(const ClassMode&) const = default;
};

/// One class of walls, and each of its contacts.
struct ClassState : ClassMode {
  double count = 0.0;      ///< number of walls
  Eigen::Matrix3d wall;    ///< n n of the first wall
  Eigen::Matrix3d spread;  ///< sum of n n over all walls

  // At the state that was evaluated.
  ClassMode evaluated_mode{};
  double coordinate = 0.0;
  Dent dent{};
  double l = 1.0, per_l = 1.0;  ///< support distance of the core under the wall
  Advance advance{};
  Contact contact{};
  double displacement = 0.0;  ///< displacement of the wall, by (K)
  Yield yield{};
  double flow_by_dent = 0.0;  ///< Lam per rate of the dent, if it grows: n F (1 - b)/X dh/dzeta

  /// Displacement of the wall at the state that was evaluated; exact if it is prescribed.
  [[nodiscard]] double position(double xi) const noexcept {
    return is_force_controlled() ? displacement : drive.value(xi);
  }
  /// phi = -c'(l)/l, load of the core per force: a force loads the core as far as it does work on the advance.
  [[nodiscard]] double phi() const noexcept { return -advance.c_l * per_l; }
};

class Particle {
 public:
  /// Elastic displacement, over the program's depth, that is round-off; more than the error of a located guard.
  static constexpr double k_touch = 4.0 * k_zero_guard;

  /// @param depth  largest displacement of the program
  Particle(const Material& material, double poisson_ratio, std::span<const ContactClass> walls, bool centre_is_free,
           double depth = 1.0);

  [[nodiscard]] const Material& material() const noexcept { return material_; }
  [[nodiscard]] double depth() const noexcept { return depth_; }
  [[nodiscard]] const Layout& layout() const noexcept { return layout_; }
  [[nodiscard]] std::size_t size() const noexcept { return classes.size(); }
  [[nodiscard]] bool any_flows() const noexcept { return std::ranges::any_of(classes, &ClassState::flows); }
  [[nodiscard]] bool is_at_rest() const noexcept;
  /// Elastic displacement up to which a contact is neither clearly open nor clearly closed.
  [[nodiscard]] double slack(std::size_t i) const noexcept;
  [[nodiscard]] const Coupling& coupling(std::size_t i, std::size_t j) const noexcept {
    return couplings_[i * size() + j];
  }
  [[nodiscard]] Core core_of(std::span<const double> y) const noexcept;
  /// n.x, by which the displacement of the centre deepens the contacts of a class.
  [[nodiscard]] double approach_by_centre(std::size_t i) const noexcept {
    return centre.lines().mean_normal(i).dot(x_);
  }
  /// Releases a wall: it moves with the surface and bears no force.
  void release_wall(std::size_t i, std::span<double> y);
  /// Writes the prescribed forces into a state.
  void prescribe(double xi, std::span<double> y) const noexcept;

  /// Evaluates all equations at a state, unless the cached evaluation is for that state and the present mode.
  /// @param with_yield  false: leaves out the core's load and the yield functions, which elastic motion does not need
  /// @throws std::domain_error where the core or a dent has no size
  void evaluate(std::span<const double> y, bool with_yield = true);
  /// Chooses the equations (E) that suit the forces at the state that was evaluated.
  void choose_balance();
  /// True for an idle wall of a loose particle: it bears no more than the weak spring does at ten times the depth.
  [[nodiscard]] bool is_idle(const ClassState& c) const noexcept {
    return c.contact.F < 10.0 * Centre::k_weak_spring * depth_;
  }
  /// Moves an unloaded free particle off the walls that rest or withdraw. Otherwise the weak spring, which the former
  /// load has stretched, would press it against them.
  /// @return the contacts that it opens, without those that the spring alone had closed; none if it does not move
  [[nodiscard]] std::optional<std::vector<std::size_t>> leave_walls(std::span<double> y);
  /// If a force is prescribed, too, moves the spring of the centre with the walls that press under a displacement, in
  /// the mode that begins: the spring must be relaxed when that force vanishes.
  void follow_walls(double xi);
  /// Counts evaluations and choices of equations.
  [[nodiscard]] std::uint64_t revision() const noexcept { return revision_; }
  [[nodiscard]] const Coverage& coverage() const noexcept { return coverage_; }
  [[nodiscard]] const CoreLoad& load() const noexcept { return load_; }
  [[nodiscard]] double stored_energy() const noexcept { return stored_; }
  /// Displacement of the centre along its free directions.
  [[nodiscard]] const Eigen::Vector3d& position() const noexcept { return x_; }
  /// Residuals of (K) or of the prescribed force, of the yield functions of contacts that flow, and of (E), in the
  /// order of the unknowns up to the core.
  void residual(double xi, std::span<double> residual) const;

  /// Derivative of a support distance by Lam.
  [[nodiscard]] double l_by_flow(std::size_t i) const noexcept;
  /// Lam, from the rates of the dents.
  [[nodiscard]] double flow_rate(std::span<const double> dy) const noexcept;
  /// Writes the rates of the core, which follow from the rates of the dents by its flow rule.
  void write_core_rates(std::span<double> dy) const noexcept;

  std::vector<ClassState> classes;
  Centre centre;

 private:
  void evaluate_contacts(std::span<const double> y);
  void evaluate_displacements();
  void evaluate_yield(std::span<const double> y);

  Material material_;
  double depth_;
  std::vector<Coupling> couplings_;
  std::vector<Eigen::Matrix3d> shapes_;  ///< shapes that the core can take; empty: it keeps its shape
  Layout layout_;
  Eigen::MatrixXd along_;  ///< components of the walls' n n among the shapes of the core

  // At the state that was evaluated.
  std::vector<double> y_;  ///< empty: none
  bool has_yield_ = false;
  std::uint64_t revision_ = 0;
  Eigen::Vector3d x_ = Eigen::Vector3d::Zero();
  Coverage coverage_;
  std::vector<double> forces_;
  CoreLoad load_;
  Eigen::VectorXd flow_;  ///< components of load_.flow.C among the shapes of the core
  double stored_ = 0.0;
};

}  // namespace monograin::cel
