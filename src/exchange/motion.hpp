/// Where the particle and its walls are in a recorded run.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "history/table.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

/// A wall, and the contact class with whose columns it moves.
struct MovingWall {
  std::string name;
  Eigen::Vector3d normal;  ///< unit, outward
  std::size_t contact_class = 0;
};

/// Contact of one wall of a class at an instant.
struct ContactInstant {
  double displacement = 0.0;  ///< of the wall, positive inward [m]
  double force = 0.0;         ///< [N]
  double radius = 0.0;        ///< contact radius [m]; NaN if the law has none
  double pressure = 0.0;      ///< mean contact pressure [Pa]; NaN if the law has none
};

/// State of a run at one instant.
struct MotionInstant {
  double time = 0.0;                                 ///< [s]
  double radius = 0.0;                               ///< apparent radius [m]; R0 if the law has none
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< displacement of the centre [m]
  std::vector<ContactInstant> contacts{};            ///< one for each contact class
};

/// Motion of particle and walls in a recorded run.
struct Motion {
  std::vector<std::pair<std::string, std::string>> header{};  ///< header lines of the history
  double initial_radius = 0.0;                                ///< R0 [m]
  std::vector<std::string> classes{};                         ///< names of the contact classes
  std::vector<MovingWall> walls{};
  std::vector<MotionInstant> instants{};  ///< times increase; the state just after an event stands for its instant

  /// Motion of a wall from first touch on as seen from the centre, positive inward [m].
  [[nodiscard]] double overlap(const MovingWall& wall, const MotionInstant& instant) const {
    return instant.contacts[wall.contact_class].displacement + wall.normal.dot(instant.centre);
  }
  /// Distance of a wall's plane from the present centre, along its outward normal [m].
  [[nodiscard]] double distance(const MovingWall& wall, const MotionInstant& instant) const {
    return initial_radius - overlap(wall, instant);
  }
  /// True if the walls of a contact class move.
  [[nodiscard]] bool moves(std::size_t contact_class) const;
};

/// Reads the motion from the history of a scenario's run.
/// @throws std::invalid_argument if the model has no walls, or the history lacks the displacement or the force of a
/// contact class
[[nodiscard]] Motion motion_of(const CheckedScenario& scenario, const Table& history);

}  // namespace monograin
