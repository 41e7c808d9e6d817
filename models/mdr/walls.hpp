/// Walls of an MDR particle during a step of the program.
#pragma once

#include <span>
#include <vector>

#include "contacts/wall_drive.hpp"
#include "mdr/setup.hpp"

namespace monograin::mdr {

class Walls {
 public:
  explicit Walls(std::size_t count) : walls_(count) {}

  void set_drives(const Setup& setup, std::span<const Ramp> ramps);
  [[nodiscard]] const contacts::WallDrive& drive(std::size_t i) const noexcept { return walls_[i].drive; }
  [[nodiscard]] bool is_force_controlled(std::size_t i) const noexcept { return walls_[i].drive.is_force_controlled(); }
  /// Largest rate of a wall under displacement control; 1 where none moves.
  [[nodiscard]] double speed_scale() const noexcept;
  /// Prescribed displacement of a wall towards the initial position of the centre.
  [[nodiscard]] double displacement(std::size_t i, double xi) const noexcept {
    // As exact as std::lerp, which takes longer than the rest of an evaluation.
    const contacts::WallDrive& drive = walls_[i].drive;
    return xi == 1.0 ? drive.end() : drive.start() + xi * drive.rate();
  }

  /// False for a contact whose push no others can balance: its force is round-off, which the power does not count.
  [[nodiscard]] bool bears(std::size_t i) const noexcept { return walls_[i].bears; }
  void set_bears(std::size_t i, bool bears) noexcept { walls_[i].bears = bears; }
  /// True for a prescribed force that is round-off beside the others during the whole step.
  [[nodiscard]] bool may_be_negligible(std::size_t i) const noexcept { return walls_[i].may_be_negligible; }

 private:
  struct Wall {
    contacts::WallDrive drive;
    bool may_be_negligible = false;
    bool bears = true;
  };
  std::vector<Wall> walls_;
};

}  // namespace monograin::mdr
