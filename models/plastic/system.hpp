/// A plastic particle between rigid walls, by one of the laws of this folder: the law of one contact, and the hybrid
/// system of contacts that each depend on their own wall. The lateral contacts of a die follow the axial walls and do
/// not act back. Lengths in R0, stresses in the strength S.
///
/// Unloading: the source has no law. `mdr` gives every yielded contact the elastic indenter that model mdr would leave
/// under the same mean pressure and contact radius; a contact that has not yielded retraces its loading curve.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "contacts/independent.hpp"
#include "mdr/contact.hpp"
#include "plastic/law.hpp"

namespace monograin::plastic {

enum class Unloading { none, mdr };

struct Settings {
  Law law;
  double strength = 0.0;  ///< S [Pa], > 0
  Unloading unloading = Unloading::none;
  double composite_modulus = 0.0;          ///< E* [Pa], > 0; for unloading only
  double poisson_ratio = 0.0;              ///< for unloading only
  std::vector<OutOfRange> out_of_range{};  ///< properties of the material to which the law was not fitted
  Reach reach{};                           ///< as contacts::Settings
};

/// Law of one contact, for contacts::IndependentContacts.
class WallLaw {
 public:
  struct Branch {
    std::size_t next = 0;          ///< boundary ahead on the primary branch
    std::size_t next_lateral = 0;  ///< boundary ahead of the lateral contacts
    bool has_impinged = false;     ///< has met its neighbours
    bool is_on_indenter = false;   ///< unloaded since it yielded, and not back at its largest displacement
    mdr::UnloadingShape indenter{};
  };
  // In the order of Regime.
  static constexpr std::array<std::string_view, 9> k_regimes{
      "open",      "elastic",   "elastic-plastic", "fully-plastic", "low-compressibility", "elastic-volumetric",
      "undefined", "unloading", "separated"};
  static constexpr auto k_passed_at_end = contacts::PassedAtEnd::all;

  explicit WallLaw(Settings settings);

  [[nodiscard]] double unit_force(double radius) const noexcept { return settings_.strength * radius * radius; }
  [[nodiscard]] double force(const Branch& b, double x) const;
  [[nodiscard]] double slope(const Branch& b, double x) const;
  [[nodiscard]] std::pair<double, double> force_and_slope(const Branch& b, double x) const;
  [[nodiscard]] double slope_under(const Branch& b, double force) const;
  [[nodiscard]] double displacement(const Branch& b, double force, double near = 0.0) const;
  [[nodiscard]] double coordinate_power(const Branch& b) const noexcept;
  [[nodiscard]] bool is_integrated(const Branch& b) const noexcept;
  [[nodiscard]] double opening(const Branch& b) const noexcept;
  [[nodiscard]] double work(const Branch& b, double x) const;
  [[nodiscard]] bool is_work_costly(const Branch& b) const noexcept;
  [[nodiscard]] bool has_stored_energy() const noexcept { return settings_.unloading != Unloading::none; }
  [[nodiscard]] double stored(const Branch& b, double x) const;
  [[nodiscard]] contacts::BearingContact contact(const Branch& b, double x) const;
  [[nodiscard]] contacts::Boundary next(const Branch& b) const { return ahead(b).boundary; }
  void pass(Branch& b) const;
  [[nodiscard]] std::optional<std::string_view> refuses_unloading() const noexcept;
  void turn(Branch& b, double x);
  void reload(Branch& b) const noexcept { b.is_on_indenter = false; }
  [[nodiscard]] std::string_view made_event(const Branch& b) const noexcept;
  [[nodiscard]] int regime(const Branch& b, bool touches) const noexcept;
  [[nodiscard]] contacts::Magnitudes magnitudes(double reach) const;
  [[nodiscard]] bool follows(const ContactClass& walls) const noexcept;
  [[nodiscard]] contacts::VisibleContact follower(const Branch& leader, bool touches, double x);
  void start() noexcept;
  void note(double x) noexcept { farthest_ = std::max(farthest_, x); }
  [[nodiscard]] std::vector<Diagnostic> warnings(double walls) const;

 private:
  enum class Kind { of_law, impingement, end, of_followers };
  struct Ahead {
    contacts::Boundary boundary;
    Kind kind = Kind::of_law;
  };

  [[nodiscard]] Ahead ahead(const Branch& b) const;
  [[nodiscard]] Regime primary_regime(const Branch& b) const noexcept;
  [[nodiscard]] Regime lateral_regime(const Branch& leader, bool touches) const noexcept;
  [[nodiscard]] mdr::UnloadingShape indenter_at(const Branch& b, double x) const;

  Settings settings_;
  double modulus_ = 0.0;  ///< E* over S
  double first_power_ = 1.0;
  std::optional<LateralLaw> lateral_law_{};
  Boundaries boundaries_{};
  Boundaries lateral_boundaries_{};
  std::optional<double> impingement_{};

  double farthest_ = 0.0;                 ///< largest x in a row
  bool has_lateral_gap_ = false;          ///< a lateral contact was undefined
  std::optional<double> overshooting_{};  ///< recovery over displacement of a contact that opens beyond first touch
};

using System = contacts::IndependentContacts<WallLaw>;

}  // namespace monograin::plastic
