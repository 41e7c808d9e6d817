/// Curves of a recorded run for a figure: contact states along the path of the driven class, with their phases.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "history/table.hpp"

namespace monograin::figure {

/// Reads a table of a run. @throws FigureError if it cannot be read
[[nodiscard]] Table read_table(const std::filesystem::path& file);

/// Folder of a file, by its whole path.
[[nodiscard]] std::filesystem::path folder_of(const std::filesystem::path& file);

/// Reads the events of a run from its folder; none if there is no such file. @throws FigureError if it cannot be read
[[nodiscard]] Table read_events(const std::filesystem::path& folder);

/// References of the model that a history's header names, one per line; none if this version has no such model.
[[nodiscard]] std::vector<std::string> references_of(const Table& history);

/// True for a corner of the program, which needs no mark: the curves turn there.
[[nodiscard]] bool is_of_program(std::string_view event);

/// Contact classes of an event's cell: "axial/lateral" has two, an event of the particle an empty one.
[[nodiscard]] std::vector<std::string> classes_of_event(std::string_view cell);

/// The first contact class that moves; the first of all if none does. None without contacts.
[[nodiscard]] std::optional<std::string> driven_class(const Table& history);

enum class Quantity { force, pressure, area, apparent_radius };
inline constexpr std::array k_quantities{Quantity::force, Quantity::pressure, Quantity::area,
                                         Quantity::apparent_radius};

/// Motion of the driven class: beyond its largest displacement so far, back, or forth again below that displacement.
enum class Phase { loading, unloading, reloading };
inline constexpr std::array k_phases{Phase::loading, Phase::unloading, Phase::reloading};

/// Phase of the path that ends at each displacement; a hold continues the phase that it interrupts.
[[nodiscard]] std::vector<Phase> phases_along(std::span<const double> displacements);

/// One contact at one instant, in SI; nan for quantities that the run does not have.
struct ContactState {
  double displacement;                             ///< of the driven class, also for contacts of other classes
  std::array<double, k_quantities.size()> values;  ///< in the order of Quantity; area is pi a^2

  [[nodiscard]] double operator[](Quantity quantity) const { return values[static_cast<std::size_t>(quantity)]; }
};

struct ContactCurve {
  std::string name;                    ///< contact class
  std::vector<ContactState> states{};  ///< one for each row of the history
  bool is_ever_made = false;           ///< the contact bears a force at some time

  /// True if the contact has any value of the quantity.
  [[nodiscard]] bool has(Quantity quantity) const;
};

/// A located instant to be marked on the curve of a contact, or on the apparent radius.
struct EventMark {
  std::string name;
  std::string contact_class;  ///< empty: an event of the particle
  ContactState state;
};

struct RunCurves {
  std::string name;
  std::vector<std::string> references;   ///< of its model, one per line
  std::optional<double> radius;          ///< R0 [m]
  std::optional<double> youngs_modulus;  ///< E [Pa]
  std::optional<double> yield_stress;    ///< Y [Pa]
  std::vector<ContactCurve> contacts{};  ///< in the order of the history's columns; at least one
  std::vector<Phase> phases{};           ///< of the path that ends at each row
  std::vector<EventMark> events;         ///< of contacts, material and particle; not of the program
  bool unloads_as_it_loads = false;      ///< the curves of unloading lie on those of loading, in every panel

  [[nodiscard]] bool has(Quantity quantity) const;
};

/// Reads a run from its folder, or from the path of its history.csv. A missing events.csv means no events.
/// @throws FigureError when a file cannot be read, or does not hold a curve of a contact
[[nodiscard]] RunCurves read_run(const std::filesystem::path& run);

/// Reads several runs; runs of the same name are named by their paths. Contacts whose curves lie on each other in every
/// run become one, with the names of all.
[[nodiscard]] std::vector<RunCurves> read_runs(const std::vector<std::filesystem::path>& runs);

}  // namespace monograin::figure
