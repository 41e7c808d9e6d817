/// The equations of a coupled elastic-plastic particle at a state, and their derivatives.
///
/// Every contact presses a dent (contact_law.hpp) into a core, which yields as a whole by the deviator of its mean
/// stress. Contacts act on each other through the elastic sphere, through the core, and through how much of the surface
/// they cover. For every class of walls
///
///   d + n.x = h + c + u - sum_j G_j F_j                                                  (K)
///
/// with the wall displacement d, the centre x, the plastic indentation h, the advance c that the core makes room for,
/// the elastic displacement u and the influence G of all contacts; the centre obeys sum F n = 0 (E). A contact that
/// flows obeys f = (X + Q)^(1/n1) - 1 = 0, where X and Q say how much of the strength of its dent and of the core is
/// used. The core flows by L = Lam M as the contacts that drive it do.
///
/// Lengths are over R0, stresses over E, forces over E R0^2, energies over E R0^3. Own law of this project
/// (docs/theory/cel.md, sections 4 to 7).
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "cel/contact_law.hpp"
#include "contacts/centre/centre_lines.hpp"
#include "contacts/wall_drive.hpp"
#include "system/walls.hpp"

namespace monograin::cel {

/// Places of the unknowns in a state: own coordinate and dent of every class, centre, core.
class Layout {
 public:
  Layout(std::size_t classes, std::size_t directions, bool has_core)
      : classes_(classes), directions_(directions), has_core_(has_core) {}
  [[nodiscard]] std::size_t coordinate(std::size_t i) const noexcept { return i; }
  [[nodiscard]] std::size_t dent(std::size_t i) const noexcept { return classes_ + i; }
  [[nodiscard]] std::size_t centre(std::size_t k) const noexcept { return 2 * classes_ + k; }
  /// C by its entries 11, 22, 33, 12, 13, 23, then e.
  [[nodiscard]] std::size_t core() const noexcept { return 2 * classes_ + directions_; }
  [[nodiscard]] std::size_t size() const noexcept { return core() + (has_core_ ? k_core_size : 0); }

  [[nodiscard]] std::size_t classes() const noexcept { return classes_; }
  [[nodiscard]] std::size_t directions() const noexcept { return directions_; }
  [[nodiscard]] bool has_core() const noexcept { return has_core_; }

  static constexpr std::size_t k_core_size = 7;

 private:
  std::size_t classes_, directions_;
  bool has_core_;
};

/// Shape of the core and its accumulated equivalent strain.
struct Core {
  Eigen::Matrix3d C = Eigen::Matrix3d::Identity();  ///< metric; the support distance along n is sqrt(n.C n)
  double e = 0.0;
};

/// One class of walls, or a contact of it.
struct ClassState {
  contacts::WallDrive drive{};
  bool takes_force = false;  ///< its own coordinate is the force, not u
  bool flows = false;        ///< dent grows

  Dent dent{};
  Contact contact{};
  Advance advance{};
  double coordinate = 0.0;
  double l = 1.0;
  double kinematic = 0.0;  ///< right side of (K)
  double f = -1.0;         ///< yield function
  double X = 0.0;
  double driving = 1.0;  ///< 1 - b, share of the contact in what drives the core
};

class Particle {
 public:
  Particle(const Material& material, double poisson_ratio, std::span<const ContactClass> classes, bool centre_is_free);

  [[nodiscard]] const Material& material() const noexcept { return material_; }
  [[nodiscard]] const Layout& layout() const noexcept { return layout_; }
  [[nodiscard]] std::size_t size() const noexcept { return classes_.size(); }
  [[nodiscard]] ClassState& at(std::size_t i) noexcept { return classes_[i]; }
  [[nodiscard]] const ClassState& at(std::size_t i) const noexcept { return classes_[i]; }
  [[nodiscard]] double count(std::size_t i) const noexcept { return counts_[i]; }
  [[nodiscard]] const contacts::CentreLines& lines() const noexcept { return lines_; }
  [[nodiscard]] Core core_of(std::span<const double> y) const noexcept;
  /// n.x, what the centre adds to the overlap of a class.
  [[nodiscard]] double carried(std::size_t i, std::span<const double> y) const noexcept;
  /// Takes the centre to rest where it is: the weak spring that settles directions without stiffness is at ease there.
  void rest_centre(std::span<const double> y) noexcept;

  /// Evaluates all equations and their derivatives at a state.
  /// @throws std::domain_error where the core or a dent has no size
  void evaluate(std::span<const double> y);
  [[nodiscard]] double coverage() const noexcept { return Om_; }
  [[nodiscard]] double stored_energy() const noexcept { return stored_; }

  /// Residuals of (K), or of the prescribed force; of the yield functions of contacts that flow; of (E): in the order
  /// of the unknowns up to the core.
  void residual(double xi, std::span<double> residual) const;
  /// Corrects a state by Newton's method for given core and dents of contacts that do not flow.
  /// @throws std::domain_error where there is no solution near the state
  void solve(double xi, std::span<double> y);
  /// Rates of all unknowns with the step coordinate at the state that was evaluated, by the chain of all equations.
  /// @return the least pivot of their matrix, which is 1 at the unloaded particle and 0 where the equations turn back
  double rates(std::span<double> dy);
  /// Rate of the yield function of a class, by the last rates().
  [[nodiscard]] double yield_rate(std::size_t i) const;
  /// Rate of the work of all walls, by the last rates().
  [[nodiscard]] double power() const;
  /// C' and e' over Lam.
  [[nodiscard]] Core core_flow() const noexcept { return flow_; }
  /// Lam from rates of the dents.
  [[nodiscard]] double flow_rate(std::span<const double> dy) const noexcept;

 private:
  struct Coupling {
    double same = 0.0, mixed = 0.0, across = 0.0;  ///< sums of g c^4, g c^2 (1 - c^2), g (1 - c^2)^2; c = cos(theta)
  };
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  [[nodiscard]] static Eigen::Index ix(std::size_t i) noexcept { return static_cast<Eigen::Index>(i); }
  void evaluate_contacts(std::span<const double> y, const Core& core);
  void evaluate_core(const Core& core);
  void evaluate_yield();
  void evaluate_coupling();
  void add(std::size_t i, const Slopes& by, Eigen::Ref<Eigen::RowVectorXd> row, double factor) const;
  void assemble();
  [[nodiscard]] double pace_of_core(std::size_t i) const noexcept;
  double eliminate(Eigen::Index count);
  [[nodiscard]] double rate_of(Eigen::Ref<const Eigen::RowVectorXd> row) const;

  Material material_;
  std::vector<double> counts_;
  std::vector<Eigen::Vector3d> normals_;  ///< of the first wall of each class
  std::vector<Eigen::Matrix3d> spreads_;  ///< sum of n n over the walls of a class
  contacts::CentreLines lines_;
  Layout layout_;
  std::vector<Coupling> coupling_;  ///< row by row
  std::vector<ClassState> classes_;
  Eigen::Vector3d rest_ = Eigen::Vector3d::Zero();  ///< where the centre is at ease
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();

  // At the state that was evaluated. Rows of derivatives are by the coordinates of all classes, by their dents, and by
  // the flow of the core.
  double Om_ = 0.0;
  double s_ = 0.0, S_ = 1.0, Q_ = 0.0;
  double stored_ = 0.0;
  double m_by_Om_ = 0.0;
  Core flow_;
  std::vector<double> l_by_flow_;
  std::vector<Eigen::Matrix3d> load_;  ///< deviator of w sym(C N), per unit force of a class
  std::vector<double> push_;           ///< ds/dF
  Eigen::RowVectorXd Om_by_, s_by_;
  Matrix F_by_, tau_by_, f_by_, kinematic_by_;
  Eigen::VectorXd tau_;
  Matrix matrix_;  ///< of the linear equations for rates or corrections, with their right side
  Eigen::VectorXd solution_;
};

}  // namespace monograin::cel
