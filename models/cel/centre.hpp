/// The centre of a particle: balance of the contact forces on it, equation (E), and a weak spring.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "contacts/centre/centre_lines.hpp"

namespace monograin::cel {

/// A centre that is fixed, or free to move along some directions. The spring determines it where no contact is stiff.
/// Its rest position may follow the walls that press: it then bears next to nothing if these carry the particle along.
class Centre {
 public:
  /// Stiffness of the spring over E R0.
  static constexpr double k_weak_spring = 1e-9;

  Centre(std::span<const ContactClass> classes, bool is_free);

  /// Number of free directions.
  [[nodiscard]] std::size_t directions() const noexcept { return static_cast<std::size_t>(lines_.free_directions()); }
  [[nodiscard]] const contacts::CentreLines& lines() const noexcept { return lines_; }

  /// Chooses the directions of the equations (E): along the line of the largest forces, then across it, where the
  /// round-off of these forces would otherwise exceed the spring.
  /// @param forces  one for each class, of one wall
  void choose_balance(std::span<const double> forces);
  /// Net force on the centre, along the directions of the equations.
  /// @param x  displacement of the centre along its free directions
  [[nodiscard]] Eigen::Vector3d net_force(double xi, const Eigen::Vector3d& x, std::span<const double> forces) const;
  /// Rate of the net force while forces and centre rest.
  [[nodiscard]] Eigen::Vector3d net_force_rate() const { return -k_weak_spring * balance_.transpose() * velocity_; }
  /// Derivatives of an equation by the force on one wall of a class, and by the centre.
  [[nodiscard]] double by_force(std::size_t equation, std::size_t i) const noexcept {
    return shares_[lines_.line_of(i)][equation] * weights_[i];
  }
  [[nodiscard]] Eigen::Vector3d by_centre(std::size_t equation) const noexcept {
    return k_weak_spring * balance_.col(equation);
  }

  /// Puts the rest position of the spring at the beginning of a step; there it stays until follow().
  void rest_at(const Eigen::Vector3d& x) noexcept {
    rest_ = x;
    velocity_.setZero();
    since_ = 0.0;
  }
  /// Moves the rest position with the walls that lead; by least squares if their speeds differ.
  /// @param speeds  one for each class: rate of the displacement of a wall that leads; none of others
  void follow(double xi, std::span<const std::optional<double>> speeds);
  [[nodiscard]] bool follows() const noexcept { return velocity_ != Eigen::Vector3d::Zero(); }
  [[nodiscard]] Eigen::Vector3d stretch(double xi, const Eigen::Vector3d& x) const noexcept {
    return x - rest_ - (xi - since_) * velocity_;
  }
  /// Room left before forces drive the centre away, where only the weak spring holds it: 1 at rest, 0 at the limit,
  /// which is ten radii.
  [[nodiscard]] double room(double xi, const Eigen::Vector3d& x) const noexcept {
    return 1.0 - stretch(xi, x).cwiseAbs().maxCoeff() / 10.0;
  }
  /// Energy of the spring, which is no part of the law.
  [[nodiscard]] double energy(double xi, const Eigen::Vector3d& x) const noexcept {
    return 0.5 * k_weak_spring * stretch(xi, x).squaredNorm();
  }

 private:
  contacts::CentreLines lines_;
  std::vector<double> weights_;  ///< push of all walls of a class along their line, per force of one wall
  Eigen::Vector3d rest_ = Eigen::Vector3d::Zero();         ///< rest position of the spring at an instant
  double since_ = 0.0;                                     ///< that instant
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();     ///< of the rest position
  Eigen::Matrix3d balance_ = Eigen::Matrix3d::Identity();  ///< directions of the equations
  std::vector<Eigen::Vector3d> shares_;                    ///< components of the lines' directions among these
};

}  // namespace monograin::cel
