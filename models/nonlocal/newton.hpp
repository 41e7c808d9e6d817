/// Newton's method for the coupled equations (nonlocal/equations.hpp) from a near guess.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "nonlocal/contacts.hpp"
#include "nonlocal/equations.hpp"
#include "nonlocal/tangent.hpp"

namespace monograin::nonlocal {

/// True if a state found by Newton's method is off the branch in modes that the method does not see: those of single
/// walls, and of contacts under force control.
[[nodiscard]] bool has_left_branch(Contacts& contacts, std::span<const Target> targets, std::span<const double> y);
/// True if the forces on a free centre balance, and contacts bear all prescribed ones.
[[nodiscard]] bool is_balanced(Contacts& contacts, std::span<const Target> targets, std::span<const double> y);

/// State that Newton's method shall reach.
struct Goal {
  std::span<const Target> targets;
  /// False at intermediate points of a path in steps, which need no balance and keep the contacts of the last point.
  bool is_to_balance = true;
  Eigen::Vector3d imbalance = Eigen::Vector3d::Zero();  ///< net force that is left over
  bool holds_centre = false;                            ///< the centre stays where it is
};

class Newton {
 public:
  explicit Newton(const Contacts& contacts) : tangent_(contacts), at_(contacts.class_count()) {}

  /// Corrects a state towards a goal. Gives up if the corrections do not contract, or if M is not positive definite:
  /// other branches lie beyond such a state.
  /// @param y  in: the guess; out: the solution, or where the method has given up
  /// @return true if y is the solution
  [[nodiscard]] bool solve(const Contacts& contacts, const Goal& goal, std::span<double> y);
  /// Net force on the centre before the last correction.
  [[nodiscard]] Eigen::Vector3d net_force(const Contacts& contacts) const { return contacts.net_force(at_.forces); }
  /// Displacement of the centre that cancels a net force, to first order about the state before the last correction.
  [[nodiscard]] Eigen::Vector3d step_to_balance(const Contacts& contacts, const Eigen::Vector3d& net_force) const {
    return tangent_.step_to_balance(contacts, at_.stiffness, net_force);
  }

 private:
  /// Knowledge of a search before its first correction.
  struct Search {
    bool moves_centre = false;
    bool is_first_touch = false;   ///< no contact shows yet that it supports a free centre
    double farthest = 0.0;         ///< largest prescribed displacement, if forces have to balance
    double deepest = 0.0;          ///< signed square under the greatest prescribed force
    double touch_stiffness = 1.0;  ///< stiffness of contacts under the greatest prescribed force
    int free_steps = 1;            ///< first corrections, which need not contract
  };

  /// One correction.
  struct Correction {
    double largest = 0.0;  ///< change of a signed square
    double scale = 0.0;    ///< largest signed square after it
  };

  [[nodiscard]] static Search begin(const Contacts& contacts, const Goal& goal, std::span<const double> y);
  [[nodiscard]] bool evaluate(const Contacts& contacts, const Goal& goal, std::span<double> y);
  [[nodiscard]] bool regularize_stiffness(const Contacts& contacts, const Goal& goal, double gap,
                                          std::span<const double> y);
  [[nodiscard]] Eigen::Vector3d corrected_net_force(const Contacts& contacts, const Goal& goal);
  void stiffen_touching(const Contacts& contacts, const Goal& goal, const Search& search, std::span<const double> y);
  void balance_centre(const Contacts& contacts, const Goal& goal, const Search& search, bool may_find_more,
                      std::span<double> y);
  [[nodiscard]] Correction correct_squares(const Goal& goal, std::span<double> y);
  [[nodiscard]] bool is_round_off(const Contacts& contacts, const Goal& goal, const Correction& correction,
                                  std::span<const double> y) const;

  Tangent tangent_;
  Evaluation at_;
};

}  // namespace monograin::nonlocal
