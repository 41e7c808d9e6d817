/// Columns of the history that all laws of walls share. A column is a value: its name, its unit and where its number
/// is found, so that the list of columns and a row of them cannot disagree.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "system/hybrid_system.hpp"

namespace monograin::contacts {

/// Energies of a particle, SI.
struct Energies {
  double work = 0.0;
  double stored = 0.0;
  double dissipation = 0.0;
};

/// What the history shows of one contact, SI.
struct VisibleContact {
  double displacement = 0.0;
  double overlap = 0.0;
  double force = 0.0;
  double contact_radius = 0.0;
  double pressure = 0.0;
  double regime = 0.0;  ///< an index into the law's words
};

/// Which columns there are.
class Columns {
 public:
  Columns(bool has_stored_energy, bool has_contact_area, std::span<const std::string_view> regimes,
          std::span<const ContactClass> classes)
      : energies_(std::span(k_energies).first(has_stored_energy ? k_energies.size() : 1)) {
    for (const OfContact& column : k_of_contact) {
      if (has_contact_area || !column.needs_area) of_contact_.push_back(column);
    }
    for (const OfParticle& column : energies_) observables_.push_back({std::string(column.name), "J", {}});
    for (const ContactClass& c : classes) {
      for (const OfContact& column : of_contact_) {
        observables_.push_back(
            {c.name + "." + std::string(column.name), std::string(column.unit),
             column.value == &VisibleContact::regime ? regimes : std::span<const std::string_view>()});
      }
    }
  }

  [[nodiscard]] std::span<const Observable> observables() const noexcept { return observables_; }

  /// Writes one row.
  /// @param contact  VisibleContact of a class by its index
  template <class ContactOf>
  void write(const Energies& energies, std::size_t classes, ContactOf&& contact_of, std::span<double> values) const {
    auto out = values.begin();
    for (const OfParticle& column : energies_) *out++ = energies.*column.value;
    for (std::size_t i = 0; i < classes; ++i) {
      const VisibleContact contact = contact_of(i);
      for (const OfContact& column : of_contact_) *out++ = contact.*column.value;
    }
  }

 private:
  struct OfParticle {
    std::string_view name;
    double Energies::*value;
  };
  struct OfContact {
    std::string_view name;
    std::string_view unit;
    double VisibleContact::*value;
    bool needs_area;
  };
  static constexpr std::array k_energies{OfParticle{"work", &Energies::work},
                                         OfParticle{"stored_energy", &Energies::stored},
                                         OfParticle{"dissipation", &Energies::dissipation}};
  static constexpr std::array k_of_contact{OfContact{"displacement", "m", &VisibleContact::displacement, false},
                                           OfContact{"overlap", "m", &VisibleContact::overlap, false},
                                           OfContact{"force", "N", &VisibleContact::force, false},
                                           OfContact{"contact_radius", "m", &VisibleContact::contact_radius, true},
                                           OfContact{"pressure", "Pa", &VisibleContact::pressure, true},
                                           OfContact{"regime", "", &VisibleContact::regime, false}};

  std::span<const OfParticle> energies_;
  std::vector<OfContact> of_contact_;
  std::vector<Observable> observables_;
};

}  // namespace monograin::contacts
