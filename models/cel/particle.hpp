/// The equations of a coupled elastic-plastic particle at a state, and their derivatives.
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
/// core flows by L = Lam M; the contacts that drive it determine Lam.
///
/// Lengths are over R0, stresses over E, forces over E R0^2, energies over E R0^3. Own law of this project
/// (docs/theory/cel.md, sections 4 to 7).
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <span>
#include <vector>

#include "cel/contact_law.hpp"
#include "cel/core_shape.hpp"
#include "contacts/centre/centre_lines.hpp"
#include "contacts/wall_drive.hpp"
#include "system/walls.hpp"

namespace monograin::cel {

/// Indices of the unknowns in a state: own coordinate and dent of every class, centre, core.
class Layout {
 public:
  /// @param shapes  number of shapes that the core can take; 0: the core keeps its shape, and is no unknown
  Layout(std::size_t classes, std::size_t directions, std::size_t shapes) noexcept
      : classes_(classes), directions_(directions), core_size_(shapes > 0 ? shapes + 1 : 0) {}
  [[nodiscard]] std::size_t coordinate(std::size_t i) const noexcept { return i; }
  [[nodiscard]] std::size_t dent(std::size_t i) const noexcept { return classes_ + i; }
  [[nodiscard]] bool is_dent(std::size_t place) const noexcept { return place >= classes_ && place < 2 * classes_; }
  [[nodiscard]] std::size_t centre(std::size_t k) const noexcept { return 2 * classes_ + k; }
  /// First index of the core: the components of C - 1 (core_shape.hpp), then e.
  [[nodiscard]] std::size_t core() const noexcept { return 2 * classes_ + directions_; }
  [[nodiscard]] std::size_t size() const noexcept { return core() + core_size_; }

  [[nodiscard]] std::size_t directions() const noexcept { return directions_; }
  [[nodiscard]] bool has_core() const noexcept { return core_size_ > 0; }
  /// Displacement of the centre along its free directions.
  [[nodiscard]] Eigen::Vector3d centre_of(std::span<const double> y) const noexcept {
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    std::copy_n(y.begin() + static_cast<std::ptrdiff_t>(centre(0)), directions_, x.begin());
    return x;
  }

 private:
  std::size_t classes_, directions_, core_size_;
};

/// Shape of the core and its accumulated equivalent strain, or the rates of both.
struct Core {
  /// Metric, of determinant 1; the support distance along n is sqrt(n.C n).
  Eigen::Matrix3d C = Eigen::Matrix3d::Zero();
  double e = 0.0;
};

/// State of one class of walls and of each of its contacts.
struct ClassState {
  double count = 0.0;      ///< number of walls
  Eigen::Matrix3d wall;    ///< n n of the first wall
  Eigen::Matrix3d spread;  ///< sum of n n over all walls

  contacts::WallDrive drive{};
  bool takes_force = false;  ///< the own coordinate is the force F, not u
  bool gives_way = false;    ///< the wall bears no force: it rests until the surface meets it, then moves along
  bool touches = false;
  bool flows = false;    ///< the dent grows
  bool may_flow = true;  ///< false: ruled out at the present instant

  double coordinate = 0.0;
  Dent dent{};
  Contact contact{};
  Advance advance{};
  double l = 1.0, per_l = 1.0, l_by_flow = 0.0;
  double displacement = 0.0;  ///< displacement of the wall, by (K)
  double f = -1.0;            ///< yield function
  double X = 0.0;
  double tau = 0.0;   ///< share of the wall in the load of the core
  double b = 0.0;     ///< 1: carried by the flow of the core; 0: drives it
  double wk = 1.0;    ///< factor by which a core that flows weakens a carried contact
  double pace = 0.0;  ///< Lam per rate of the dent, if the dent grows

  /// w = -c'(l)/l, load of the core per force: a force loads the core as far as it does work on the advance.
  [[nodiscard]] double w() const noexcept { return -advance.c_l * per_l; }
};

class Particle {
 public:
  /// Stiffness (over E R0) of a weak spring at a free centre. It determines the centre where no contact is stiff.
  static constexpr double k_weak_spring = 1e-9;

  Particle(const Material& material, double poisson_ratio, std::span<const ContactClass> classes, bool centre_is_free);

  [[nodiscard]] const Material& material() const noexcept { return material_; }
  [[nodiscard]] const Layout& layout() const noexcept { return layout_; }
  [[nodiscard]] std::size_t size() const noexcept { return classes_.size(); }
  [[nodiscard]] ClassState& at(std::size_t i) noexcept { return classes_[i]; }
  [[nodiscard]] const ClassState& at(std::size_t i) const noexcept { return classes_[i]; }
  [[nodiscard]] std::span<ClassState> classes() noexcept { return classes_; }
  [[nodiscard]] std::span<const ClassState> classes() const noexcept { return classes_; }
  [[nodiscard]] bool any_flows() const noexcept { return std::ranges::any_of(classes_, &ClassState::flows); }
  [[nodiscard]] const contacts::CentreLines& lines() const noexcept { return lines_; }
  [[nodiscard]] Core core_of(std::span<const double> y) const noexcept;
  /// n.x, by which a displacement of the centre deepens the contacts of a class.
  [[nodiscard]] double carried(std::size_t i, std::span<const double> y) const noexcept {
    return lines_.arm(i).dot(layout_.centre_of(y));
  }
  /// Puts the rest position of the weak spring to where the centre is.
  void rest_centre(std::span<const double> y) noexcept { rest_ = layout_.centre_of(y); }

  /// Drops the cached evaluation. To be called when an own coordinate changes from u to F or back.
  void forget() noexcept { is_known_ = false; }
  /// Evaluates all equations at a state.
  /// @return false if the cached evaluation is for that state
  /// @throws std::domain_error where the core or a dent has no size
  bool evaluate(std::span<const double> y);
  [[nodiscard]] double coverage() const noexcept { return Om_; }
  [[nodiscard]] double stored_energy() const noexcept { return stored_; }
  /// Energy of the weak spring, which is no part of the law.
  [[nodiscard]] double spring_energy() const noexcept { return 0.5 * k_weak_spring * (centre_ - rest_).squaredNorm(); }
  /// Residuals of (K) or of the prescribed force, of the yield functions of contacts that flow, and of (E), in the
  /// order of the unknowns up to the core.
  void residual(double xi, std::span<double> residual) const;
  /// Writes the prescribed forces into a state.
  void prescribe(double xi, std::span<double> y) const noexcept;
  /// Corrects a state by Newton's method for given core and dents of contacts that do not flow.
  /// @throws std::domain_error where there is no solution near the state
  void solve(double xi, std::span<double> y);
  /// Rates of all unknowns with the step coordinate at the state that was evaluated.
  /// @param pull  rate at which dy also draws the state back to the equations; the functions below leave this part out
  /// @return the margin to a fold: the speed of walls over the sum of that and the speed of their contacts; negative
  /// beyond the fold, where the determinant of the equations has changed its sign
  double rates(std::span<double> dy, double xi = 0.0, double pull = 0.0);
  /// Rate of a dent, by the last rates().
  [[nodiscard]] double dent_rate(std::size_t i) const noexcept { return solution_[layout_.dent(i)]; }
  /// Rate of the yield function of a class, by the last rates().
  [[nodiscard]] double yield_rate(std::size_t i);
  /// Rate of the work of all walls, by the last rates().
  [[nodiscard]] double power() const;
  /// Rates of the core, C' and e', over Lam.
  [[nodiscard]] const Core& core_flow() const noexcept { return flow_; }
  /// Lam, from the rates of the dents.
  [[nodiscard]] double flow_rate(std::span<const double> dy) const noexcept;
  /// Writes the rates of the core, which follow from the rates of the dents by its flow rule.
  void let_core_flow(std::span<double> dy) const noexcept;

 private:
  /// Influence of the forces on the walls of one class on a wall of another.
  struct Coupling {
    double same = 0.0, mixed = 0.0, across = 0.0;  ///< sums of g c2^2, g c2 (1 - c2), g (1 - c2)^2
    double G = 0.0;                                ///< influence
  };

  void evaluate_elastically(std::span<const double> y);
  void evaluate_flow(std::span<const double> y);
  void evaluate_contacts(std::span<const double> y);
  void evaluate_coupling();
  void evaluate_core();
  void evaluate_yield();
  void differentiate();
  void differentiate_kinematics(std::size_t i);
  void differentiate_yield(std::size_t i);
  void differentiate_balance(std::size_t direction);
  void add(std::size_t i, const Slopes& by, double factor, std::span<double> row) const noexcept;
  void fold_coverage(std::span<double> row) const noexcept;
  // A row holds derivatives by the unknowns up to the core, by the coverage, and by the flow of the core.
  [[nodiscard]] std::size_t by_Om() const noexcept { return layout_.core(); }
  [[nodiscard]] std::size_t by_flow() const noexcept { return layout_.core() + 1; }
  [[nodiscard]] std::size_t row_width() const noexcept { return layout_.core() + 2; }
  [[nodiscard]] std::span<const double> row_at(std::size_t place) const noexcept {
    return std::span(residual_by_).subspan(place * row_width(), row_width());
  }
  [[nodiscard]] std::span<double> new_row(std::size_t place) noexcept {
    const auto row = std::span(residual_by_).subspan(place * row_width(), row_width());
    std::ranges::fill(row, 0.0);
    return row;
  }
  [[nodiscard]] double push_on(std::size_t line, std::size_t i) const noexcept;
  void choose_balance();
  void assemble(bool takes_core_along);
  double eliminate(std::span<const double> right, std::span<const double> drift);
  [[nodiscard]] double error(double xi);
  double correct(double xi, std::span<double> y, double bound);
  [[nodiscard]] double slowness() const noexcept;
  [[nodiscard]] double rate_of(std::size_t place) const noexcept;

  Material material_;
  std::vector<Eigen::Matrix3d> shapes_;  ///< shapes that the core can take; empty: it keeps its shape
  contacts::CentreLines lines_;
  Layout layout_;
  std::vector<Coupling> coupling_;  ///< row by row
  std::vector<ClassState> classes_;
  Eigen::MatrixXd along_;                           ///< components of the walls' n n among the shapes of the core
  Eigen::Vector3d rest_ = Eigen::Vector3d::Zero();  ///< rest position of the weak spring
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d balance_ = Eigen::Matrix3d::Identity();  ///< directions of the equations (E)
  std::vector<Eigen::Vector3d> shares_;                    ///< components of the lines' directions in balance_

  // At the state that was evaluated.
  std::vector<double> evaluated_;
  bool is_known_ = false;
  double Om_ = 0.0, m_by_Om_ = 0.0, shade_ = 1.0;
  Core core_;
  Eigen::Matrix3d pushes_;  ///< sum of F w n n over all walls
  Eigen::Matrix3d T_;       ///< deviator of the load of the core
  double s_ = 0.0, per_s_ = 0.0, per_S_ = 1.0, Q_ = 0.0;
  double stored_ = 0.0;
  Core flow_;
  Eigen::VectorXd flow_components_;  ///< components of flow_.C among the shapes of the core

  // Derivatives at that state.
  std::vector<double> Om_by_zeta_;
  double Om_by_flow_ = 0.0;
  Eigen::Matrix3d pushes_by_flow_;   ///< derivative of pushes_ by the flow of the core, at given forces
  std::vector<double> residual_by_;  ///< row by row

  // The linear equations for rates or corrections of those unknowns up to the core that move.
  std::vector<std::size_t> active_;                                                ///< indices of these unknowns
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> matrix_;  ///< last columns: two right sides
  std::vector<double> solution_, drift_;  ///< solutions for the two right sides, for all unknowns up to the core
  double Lam_ = 0.0;                      ///< Lam of the last rates()
  std::vector<double> rest_of_equations_, before_;
};

}  // namespace monograin::cel
