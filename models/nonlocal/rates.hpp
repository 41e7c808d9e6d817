/// Rates of the contacts and of a free centre along a solution.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "contacts/centre/obstacles.hpp"
#include "nonlocal/contacts.hpp"
#include "nonlocal/support.hpp"
#include "nonlocal/tangent.hpp"

namespace monograin::nonlocal {

/// How rates treat states that are off the solution by integration errors.
struct Tolerances {
  double touch = 0.0;  ///< gap (minus s) up to which walls touch: they may support the centre at once
  double pull = 0.0;   ///< least decay rate of a balance error where contacts bear the centre against a force
  std::span<const char> touches{};  ///< classes whose idle walls may move the centre once they touch; empty: all

  [[nodiscard]] bool may_push(std::size_t j) const noexcept { return touches.empty() || touches[j]; }
};

/// Owns its working memory, so that rates do not allocate. Two threads must not use one object at once.
class Rates {
 public:
  explicit Rates(const Contacts& contacts);

  /// dy/dxi along a solution. Regular from the unloaded state on, except for a class under force control at s = 0: its
  /// own s has an infinite rate, on which the other rates do not depend. A free centre leaves the unloaded state as if
  /// the contacts were equally stiff, which is exact where they will be.
  /// @throws std::domain_error at and beyond the limit of applicability, and where nothing supports a free centre
  /// against prescribed forces
  void find(Contacts& contacts, std::span<const Ramp> ramps, std::span<const double> y, std::span<double> dy,
            const Tolerances& tolerances = {});
  /// Where no contact supports a free centre, the balance of forces does not determine its position. Replaces the
  /// balance in those directions by an equation for the centre's rate.
  /// @param is_closed  classes in contact
  /// @param missing    rate of the centre minus that of find()
  /// @param balance    rows of residual() for the centre; rotated so that each holds either a force or a rate
  void let_unheld_centre_go(const Contacts& contacts, std::span<const Ramp> ramps, std::span<const char> is_closed,
                            const Eigen::Vector3d& missing, std::span<double> balance);

 private:
  /// A state, and what acts on it.
  struct State {
    std::span<const Ramp> ramps;
    std::span<const double> y;
    std::span<const double> forces;
    const Tolerances& tolerances;
  };

  [[nodiscard]] bool find_unloaded(const Contacts& contacts, const State& now, std::span<double> dy);
  void set_approach_rates_of_walls(const Contacts& contacts, std::span<const Ramp> ramps);
  void let_centre_follow(Contacts& contacts, const State& now, std::span<double> dy);
  [[nodiscard]] Eigen::Vector3d error_against_forces(const Contacts& contacts, const State& now) const;
  [[nodiscard]] double reach_of_support(const Contacts& contacts, const State& now) const;
  void let_idle_walls_push(const Contacts& contacts, const State& now, std::span<double> dy);

  Tangent tangent_;
  CentreSupport support_;
  std::vector<double> stiffness_;  ///< dF/dg; 0 under force control, and of redundant walls
  std::vector<contacts::Obstacle> obstacles_;
};

}  // namespace monograin::nonlocal
