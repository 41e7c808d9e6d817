/// A compressible plastic particle between rigid walls: the law of one contact, and the hybrid system of independent
/// contacts. Lengths in R0, forces in pi R0^2 sigma_y0.
#pragma once

#include <array>
#include <string_view>

#include "compressible/law.hpp"
#include "contacts/independent.hpp"

namespace monograin::compressible {

struct Settings {
  LoadingLaw law{};
  double hertz_stiffness = 1.0;  ///< k_H > 0
  UnloadingRule unloading{};
  double yield_pressure = 1.0;             ///< sigma_y0 [Pa]
  std::vector<Diagnostic> reservations{};  ///< warnings for the user about these numbers
};

/// Law of one contact, for contacts::IndependentContacts.
class WallLaw {
 public:
  struct Branch {
    Part part = Part::linear;   ///< of the primary loading branch
    bool is_unloading = false;  ///< below the largest displacement, on `curve`
    UnloadingCurve curve{};
  };
  static constexpr std::array<std::string_view, 4> k_regimes{"open", "linear", "exponential", "unloading"};
  static constexpr auto k_passed_at_end = contacts::PassedAtEnd::none;

  explicit WallLaw(Settings settings) : settings_(std::move(settings)) {}

  [[nodiscard]] double unit_force(double radius) const noexcept;
  [[nodiscard]] double force(const Branch& b, double d) const noexcept;
  [[nodiscard]] double slope(const Branch& b, double d) const noexcept;
  [[nodiscard]] double displacement(const Branch& b, double force) const noexcept;
  [[nodiscard]] double opening(const Branch& b) const noexcept { return b.is_unloading ? b.curve.separation() : 0.0; }
  [[nodiscard]] double work(const Branch& b, double d) const noexcept;
  /// Work that the contact would return. Records the least ratio of the slopes of unloading and loading.
  [[nodiscard]] double stored(const Branch& b, double d) noexcept;
  [[nodiscard]] contacts::Boundary next(const Branch& b) const noexcept;
  void pass(Branch& b) const noexcept { b.part = Part::exponential; }
  void turn(Branch& b, double d) noexcept;
  void reload(Branch& b) const noexcept { b.is_unloading = false; }
  [[nodiscard]] int regime(const Branch& b, bool touches) const noexcept;
  void start() noexcept;
  [[nodiscard]] std::vector<Diagnostic> warnings(double walls) const;

 private:
  [[nodiscard]] UnloadingCurve curve_from(double d) const noexcept {
    return unloading_from(settings_.law, settings_.hertz_stiffness, settings_.unloading, d);
  }

  Settings settings_;
  int clipped_ = 0;           ///< unloadings that would have opened before first touch
  double least_ratio_ = 1.0;  ///< least slope of unloading over that of loading, over all evaluated states
};

using System = contacts::IndependentContacts<WallLaw>;

}  // namespace monograin::compressible
