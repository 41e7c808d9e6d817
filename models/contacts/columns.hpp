/// Columns of the history that all laws of walls share. A column is a value: its name, its unit and where its number
/// is found, so that the list of columns and a row of them cannot disagree.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "system/observables.hpp"
#include "system/resolution.hpp"

namespace monograin::contacts {

/// Energies of a particle, SI. The dissipation is their difference.
struct Energies {
  double work = 0.0;
  double stored = 0.0;
};
/// Energies of a row if the system leaves them out.
inline constexpr Energies k_no_energies{k_nan, k_nan};

/// Numbers of one contact in a row of the history, SI.
struct VisibleContact {
  double displacement = 0.0;
  double overlap = 0.0;
  double force = 0.0;
  double contact_radius = 0.0;
  double pressure = 0.0;
  double regime = 0.0;  ///< an index into the law's words
};

/// Quantities of a wall, from what a row shows of its contact.
[[nodiscard]] inline AtWall wall_of(const VisibleContact& shown, double apparent_radius) noexcept {
  return {.force = shown.force,
          .displacement = shown.displacement,
          .pressure = shown.pressure,
          .contact_radius = shown.contact_radius,
          .apparent_radius = apparent_radius};
}

/// A column of a contact: its name after that of the class, its unit, and its number.
struct ContactColumn {
  std::string_view name;
  std::string_view unit;
  double VisibleContact::*value;
  bool needs_area = false;  ///< only models that know the contact area have this column
};
inline constexpr std::array k_contact_columns{
    ContactColumn{"displacement", "m", &VisibleContact::displacement},
    ContactColumn{"overlap", "m", &VisibleContact::overlap},
    ContactColumn{"force", "N", &VisibleContact::force},
    ContactColumn{"contact_radius", "m", &VisibleContact::contact_radius, true},
    ContactColumn{"pressure", "Pa", &VisibleContact::pressure, true},
    ContactColumn{"regime", "", &VisibleContact::regime}};

/// Appends the columns of a contact class.
inline void add_contact_columns(const std::string& contact_class, std::span<const std::string_view> regimes,
                                std::vector<Observable>& columns, bool has_contact_area = true) {
  for (const ContactColumn& column : k_contact_columns) {
    if (column.needs_area && !has_contact_area) continue;
    const bool is_regime = column.value == &VisibleContact::regime;
    columns.push_back({contact_class + "." + std::string(column.name), std::string(column.unit),
                       is_regime ? regimes : std::span<const std::string_view>()});
  }
}

/// Appends the columns of a free centre.
inline void add_centre_columns(std::vector<Observable>& columns) {
  for (const char* axis : {"centre_x", "centre_y", "centre_z"}) columns.push_back({axis, "m", {}});
}

/// Writes the columns of a free centre, which are the last three of a row.
/// @param displacement  displacement of the centre, in space [m]
inline void write_centre_columns(const Eigen::Vector3d& displacement, std::span<double> values) {
  std::ranges::copy(displacement, values.last(3).begin());
}

/// Columns of a particle: its energies, others of its own, then those of every class.
class Columns {
 public:
  /// Parts of a row that only some particles have.
  struct Parts {
    bool stored_energy = true;
    bool contact_area = true;
    bool free_centre = false;
  };
  Columns(const Parts& parts, std::span<const std::string_view> regimes, std::span<const ContactClass> classes,
          std::span<const Observable> others = {})
      : energies_(parts.stored_energy ? k_energy_observables.size() : 1), has_contact_area_(parts.contact_area) {
    for (const std::string_view name : std::span(k_energy_observables).first(energies_)) {
      observables_.push_back({std::string(name), "J", {}});
    }
    observables_.insert(observables_.end(), others.begin(), others.end());
    for (const ContactClass& c : classes) add_contact_columns(c.name, regimes, observables_, parts.contact_area);
    if (parts.free_centre) add_centre_columns(observables_);
  }

  [[nodiscard]] std::span<const Observable> observables() const noexcept { return observables_; }

  /// Writes one row.
  /// @param contact_of  VisibleContact of a class by its index
  template <class ContactOf>
  void write(const Energies& energies, std::size_t classes, ContactOf&& contact_of, std::span<double> values,
             std::span<const double> others = {}) const {
    const std::array row{energies.work, energies.stored, energies.work - energies.stored};  // as k_energy_observables
    auto out = std::ranges::copy(std::span(row).first(energies_), values.begin()).out;
    out = std::ranges::copy(others, out).out;
    for (std::size_t i = 0; i < classes; ++i) {
      const VisibleContact contact = contact_of(i);
      for (const ContactColumn& column : k_contact_columns) {
        if (has_contact_area_ || !column.needs_area) *out++ = contact.*column.value;
      }
    }
  }

 private:
  std::size_t energies_;  ///< number of energy columns
  bool has_contact_area_;
  std::vector<Observable> observables_;
};

}  // namespace monograin::contacts
