/// A model is one value, made in the folder of its law.
///
/// The data say what the model is called, which keys it reads, which regimes and events it knows, and where it comes
/// from: reading and checking scenario files, the JSON Schema and `monograin models` are made from them, so that a key
/// is described in one place only. The functions make equations of a checked scenario, say how far a program goes, draw
/// scenes of the stress test and check their histories. The workbench knows models by these alone, none by its name.
#pragma once

#include <array>
#include <initializer_list>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "system/citation.hpp"
#include "system/hybrid_system.hpp"
#include "system/walls.hpp"

namespace monograin {

/// Physical dimension of a quantity; fixes which unit strings are accepted (a bare number is always SI).
enum class Dimension {
  none,
  length,
  stress,
  surface_energy,
  force,
  time,
  velocity,
  force_rate,
  angle,
  strain_rate,  ///< of strains and other pure numbers
  stress_rate
};

/// Interval of admissible values; the bounds belong to it unless they are marked open.
struct Range {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool lower_is_open = false;
  bool upper_is_open = false;

  [[nodiscard]] constexpr bool contains(double value) const noexcept {
    return (lower_is_open ? value > lower : value >= lower) && (upper_is_open ? value < upper : value <= upper);
  }
};

inline constexpr Range k_positive{.lower = 0.0, .lower_is_open = true};
inline constexpr Range k_not_negative{.lower = 0.0};
/// Poisson's ratio, incompressible material included.
inline constexpr Range k_poisson_to_half{.lower = -1.0, .upper = 0.5, .lower_is_open = true};
/// Poisson's ratio of compressible material.
inline constexpr Range k_poisson_below_half{.lower = -1.0, .upper = 0.5, .lower_is_open = true, .upper_is_open = true};

/// Wall sets of models in which walls may stand anywhere.
inline constexpr std::array<std::string_view, 5> k_wall_configurations{"simple", "die", "hydrostatic", "oblique-die",
                                                                       "walls"};

/// A quantity in `[material]` (or a number in a model's own table).
struct QuantityKey {
  std::string_view name;
  std::string_view meaning;
  Dimension dimension = Dimension::none;
  Range range;
  std::optional<double> default_value{};  ///< none: the key must be given, or is optional
  bool is_optional = false;
};

/// A choice, a switch, a file name or a number in the table that bears the model's name.
struct OptionKey {
  enum class Kind { choice, toggle, file, quantity };
  std::string_view name;
  std::string_view meaning;
  Kind kind = Kind::choice;
  std::span<const std::string_view> choices;  ///< of a choice; the first one is the default
  bool default_toggle = false;
  Dimension dimension = Dimension::none;  ///< of a quantity, as its range and default
  Range range{};
  std::optional<double> default_value{};  ///< none: the quantity may be absent
  /// The columns of a table that is not a curve of two. No two rows have the same first two values.
  std::span<const QuantityKey> columns{};
  std::string (*example)() = nullptr;  ///< of a file: what one may hold
};

/// A ramp that a step of a model without walls may prescribe; its name is the step's key.
struct DriveKey {
  std::string_view name;
  std::string_view meaning;
  Control control = Control::strain;
  Dimension dimension = Dimension::none;
  Range range;
  std::string_view example;  ///< as written in a file
  /// `[axial, lateral]` stands for a value of this key and one that controls the same in the second channel.
  bool may_take_lateral = false;
  std::string_view column{};  ///< of the history, that shows what it prescribes; empty: that of its name
};

/// A material of a source's table: values of keys in `[material]`, not of all of them.
struct Preset {
  struct Value {
    std::string_view key;
    double value = 0.0;  ///< [SI]
  };
  std::string_view name;
  std::string_view source;  ///< table
  std::span<const Value> values;
};

/// A regime or an event with one sentence about it.
struct Term {
  std::string_view name;
  std::string_view meaning;
};

/// The end of the ramp that a step prescribes one channel.
struct Prescription {
  Control control = Control::displacement;
  double target = 0.0;  ///< [SI]
};

/// A step of the program of a model without walls, cycles written out.
struct PlannedStep {
  std::optional<Prescription> first{};    ///< none: what is controlled is kept
  std::optional<Prescription> lateral{};  ///< of the second channel; none: it keeps its value
  bool may_end_early = false;             ///< has a condition
};

/// A curve given by samples, in a file that an option names; or, of a table with more columns, values over x and y.
struct SampledCurve {
  std::string text;  ///< the file as it was read
  std::vector<double> x;
  std::vector<double> y;
  std::vector<std::vector<double>> values{};  ///< further columns, in the order of the option's; of a curve: none
};

using OptionValue = std::variant<bool, double, std::string>;

/// A scenario as its model sees it; each value is right by itself.
struct ModelInput {
  double radius = 0.0;                                ///< R0 [m]; 0 where the model has no particle
  const std::map<std::string, double>& values;        ///< of the keys in `[material]` [SI]
  const std::map<std::string, OptionValue>& options;  ///< defaults filled in
  const std::map<std::string, SampledCurve>& curves;  ///< by option: what the files hold that options name
  std::string_view configuration{};                   ///< empty where the model has none
  bool centre_is_free = false;
  std::vector<PlannedStep> program{};  ///< empty where there are walls
  std::string_view integrator{};       ///< as asked for

  /// Value of a key in `[material]`. @throws std::out_of_range where it has none
  [[nodiscard]] double material(const char* key) const { return values.at(key); }
  [[nodiscard]] std::optional<double> optional_material(const char* key) const {
    const auto found = values.find(key);
    return found == values.end() ? std::nullopt : std::optional(found->second);
  }
  /// Value of an option of kind quantity; none where it is absent.
  [[nodiscard]] std::optional<double> number(const char* key) const {
    const auto found = options.find(key);
    return found == options.end() ? std::nullopt : std::optional(std::get<double>(found->second));
  }
  /// Word of an option of kind choice, or file name.
  [[nodiscard]] const std::string& word(const char* key) const { return std::get<std::string>(options.at(key)); }
  [[nodiscard]] bool toggle(const char* key) const { return std::get<bool>(options.at(key)); }
  [[nodiscard]] const SampledCurve* curve(const char* key) const {
    const auto found = curves.find(key);
    return found == curves.end() ? nullptr : &found->second;
  }
  /// One of an option's words as the enumerator at the same position.
  /// @throws std::logic_error for a word that the list does not have
  template <class Enum, std::size_t N>
  [[nodiscard]] Enum choice(const char* key, const std::pair<const char*, Enum> (&table)[N]) const {
    for (const auto& [name, value] : table) {
      if (word(key) == name) return value;
    }
    throw std::logic_error(std::string("option ") + key + " = '" + word(key) + "' was checked but is not bound");
  }
};

/// Why values do not go together.
struct Objection {
  std::string_view key;  ///< in `[material]`, in the model's own table, or `configuration`
  std::string message;
  std::optional<std::size_t> step{};  ///< of the program; the fault is shown at this step, not at the key
};

/// Walls of a scene and their ramps in the first step; a wall that holds has a ramp that ends where it starts.
struct FirstStep {
  std::span<const ContactClass> classes;
  std::span<const Ramp> ramps;  ///< of each class [SI]
};

/// A constant that follows from a scenario's material before anything moves.
struct DerivedParameter {
  std::string_view name;
  double value = 0.0;
  std::string_view unit;
  std::string_view symbol{};  ///< in the source; empty: none
};

/// Values of those keys of `[material]` that a scenario has, each with its unit.
[[nodiscard]] std::vector<DerivedParameter> material_parameters(
    const ModelInput& input, std::initializer_list<std::pair<const char*, std::string_view>> keys);

/// A value that the steps of a model without walls prescribe, before the first of them.
struct RestingChannel {
  std::string_view name;
  Ramp at_rest;
  bool is_lateral = false;     ///< follows the lateral parts of the steps
  bool bears_nothing = false;  ///< every other quantity that a step may prescribe is zero there
};

/// Ludwik's law sigma = Y + K eps_pl^(1/n) up to a strain.
struct LudwikInput {
  double youngs_modulus = 0.0;  ///< [Pa]; infinite: rigid
  double yield_stress = 0.0;    ///< Y [Pa]
  double strength = 0.0;        ///< K [Pa]
  double exponent = 0.0;        ///< 1/n
  double largest_strain = 0.0;
  bool fits_both = true;  ///< strength and exponent; false: the exponent, with the strength Y + K
};

/// sigma = strength eps^exponent.
struct PowerLaw {
  double strength = 0.0;  ///< [Pa]
  double exponent = 0.0;
};

// stress/draw.hpp, stress/checks.hpp, system/curve_procedure.hpp and system/adhesion_map.hpp define these.
class Dice;
struct AdhesionMap;
struct CheckedRun;
struct CurveProcedure;
struct DrawnMaterial;
struct DrawnStep;
struct ProgramBounds;
struct Violation;

/// A model, as users read about it and as the workbench runs it.
struct Model {
  std::string_view name;
  std::string_view summary;
  /// Sources of the model, the main one first.
  std::span<const Citation* const> references{};
  /// Where in the references the law stands, and which of their misprints are corrected.
  std::string_view source{};
  std::span<const QuantityKey> material;
  std::span<const OptionKey> options{};
  std::span<const std::string_view> configurations{};  ///< empty: there is nothing to choose from
  bool has_free_centre = false;                        ///< `[loading] centre = "equilibrium"` is defined
  bool has_contact_area = true;  ///< there are contact radii, pressures, and a surface that may move
  bool has_profile = false;      ///< pressure and surface under a contact are known
  std::span<const Term> regimes{};
  std::span<const Term> events{};
  std::span<const std::string_view> domain;       ///< limits of validity, a sentence each
  double least_wall_angle = 0.0;                  ///< [rad], between any two walls
  std::span<const OptionKey> material_options{};  ///< options that stand in `[material]`
  /// Materials that `preset` in `[material]` may name. Keys that are given beside it win.
  std::span<const Preset> presets{};
  std::string_view sign{};  ///< convention of stresses and strains, where it is not that compression is positive
  /// Quantities that steps prescribe of a model without particle and walls; empty: it has both.
  std::span<const DriveKey> drives{};
  /// Quantities that such a step can prescribe in a second channel, under keys of their own.
  std::span<const DriveKey> lateral_drives{};
  /// Quantities that such a step can wait for, besides events.
  std::span<const QuantityKey> conditions{};

  /// Parts of other models that this one does not have, for the record of a run.
  std::span<const std::string_view> skipped{};
  /// True if a contact moves the surface under the other walls, so that their overlap need not be a contact.
  bool moves_surface = false;
  /// True if a wall cannot pull: a step that prescribes a negative force ends the run.
  bool stops_when_pulled = false;

  // --- functions

  /// Lists the values that do not go together. Null: any go together.
  std::vector<Objection> (*objections)(const ModelInput& input) = nullptr;
  /// Finds the `strength` and the `hardening_exponent` that stand for Ludwik's law. Null: the model has no `ludwik`.
  PowerLaw (*power_law_of)(const LudwikInput& ludwik) = nullptr;
  /// Makes the equations over contact classes, which are empty where there are no walls. Never null.
  std::unique_ptr<HybridSystem> (*bind)(const ModelInput& input, std::vector<ContactClass> classes,
                                        const Reach& reach) = nullptr;
  /// Says where a model without walls starts. Null: the model has walls.
  std::vector<RestingChannel> (*channels)(const ModelInput& input) = nullptr;
  /// Lists constants that follow from the material. Null: there are none.
  std::vector<DerivedParameter> (*parameters)(const ModelInput& input, const FirstStep& step) = nullptr;
  /// Says how far a contact is pressed, at most, that meets a condition for the first time; infinite where only a run
  /// can tell. Null: a condition on a displacement or a force says it itself, others do not.
  Reach (*reach)(const ModelInput& input, const Until& until) = nullptr;
  /// Tells whether walls may go back. Null: they may.
  bool (*can_unload)(const ModelInput& input) = nullptr;
  /// Tells whether unloading goes back on the loading curve, so that all work is stored. Null: it does not.
  bool (*is_elastic)(const ModelInput& input) = nullptr;
  /// Draws material, options and bounds of a program for the stress test. Never null.
  ProgramBounds (*draw)(Dice& dice, DrawnMaterial& drawn) = nullptr;
  /// Draws the program of such a scene. Null: a program of walls is drawn.
  std::vector<DrawnStep> (*draw_program)(Dice& dice, const DrawnMaterial& drawn, const ProgramBounds& bounds,
                                         std::size_t count) = nullptr;
  /// Checks what must hold of every history of this model alone. Null: nothing is checked beside what holds for all.
  void (*check)(const CheckedRun& run, std::vector<Violation>& found) = nullptr;
  /// Tells whether a column may be without a value in a row. Null: none may.
  bool (*may_be_undefined)(const CheckedRun& run, std::size_t row, std::string_view column) = nullptr;
  /// The source's own procedure for finding parameters from a curve. Null: there is none.
  const CurveProcedure* curve_procedure = nullptr;
  /// Where the model's pull-off can be trusted. Null: it says nothing about that.
  const AdhesionMap* adhesion_map = nullptr;

  [[nodiscard]] bool has_walls() const noexcept { return drives.empty(); }
};

/// The references of a model as lines of text (citation_text), the main one first.
[[nodiscard]] std::vector<std::string> reference_texts(const Model& model);

}  // namespace monograin
