/// Definition of a model as one value of type Model, made in the folder of its law.
///
/// The data give the name, keys, regimes, events and sources of the model. The reader of scenario files, the JSON
/// Schema and `monograin models` use these data, so that each key is described once. The functions turn a checked
/// scenario into equations, bound how far a program goes, draw scenes for the stress test and check their histories.
/// The workbench uses only this value and refers to no model by name.
#pragma once

#include <array>
#include <initializer_list>
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
#include "system/resolution.hpp"
#include "system/walls.hpp"

namespace monograin {

/// Physical dimension of a quantity. It fixes which unit strings are accepted; a bare number is always in SI units.
enum class Dimension {
  none,
  length,
  stress,
  surface_energy,
  stiffness,  ///< force over displacement
  force,
  time,
  velocity,
  force_rate,
  angle,
  strain_rate,  ///< rate of a strain or of another pure number
  stress_rate,
  frequency
};

/// Interval of admissible values. It contains its bounds unless they are marked open.
struct Range {
  double lower = -k_infinity;
  double upper = k_infinity;
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

/// Wall sets that a scenario may name if the model allows walls in any position.
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

/// A choice, a switch, a file name or a number in the table named after the model.
struct OptionKey {
  enum class Kind { choice, toggle, file, quantity };
  std::string_view name;
  std::string_view meaning;
  Kind kind = Kind::choice;
  std::span<const std::string_view> choices{};  ///< words of a choice; the first one is the default
  bool default_toggle = false;                  ///< default of a toggle
  Dimension dimension = Dimension::none;        ///< dimension of a quantity
  Range range{};                                ///< admissible values of a quantity
  std::optional<double> default_value{};        ///< default of a quantity; none: the quantity may be absent
  /// Columns of a file with a table of values over x and y; empty for a curve of two columns. No two rows of the table
  /// have the same x and y.
  std::span<const QuantityKey> columns{};
  std::string (*example)() = nullptr;  ///< content of an example file
};

/// A controlled quantity that a step of a model without walls may prescribe; its name is the key in the step.
struct DriveKey {
  std::string_view name;
  std::string_view meaning;
  Control control = Control::strain;
  Dimension dimension = Dimension::none;
  Range range;
  std::string_view example;  ///< value as written in a scenario file
  /// True if the key also takes `[axial, lateral]`: targets of this quantity in the first and the second channel.
  bool may_take_lateral = false;
  std::string_view column{};  ///< column of the history with the controlled quantity; empty: the column named `name`
};

/// A named material from a table of the source: values of some keys in `[material]`.
struct Preset {
  struct Value {
    std::string_view key;
    double value = 0.0;  ///< [SI]
  };
  std::string_view name;
  std::string_view source;  ///< table of the source
  std::span<const Value> values;
};

/// A regime or an event with one sentence about it.
struct Term {
  std::string_view name;
  std::string_view meaning;
};

/// Control and target of the ramp that a step prescribes for one channel.
struct Prescription {
  Control control = Control::displacement;
  double target = 0.0;  ///< [SI]
};

/// A step of the program of a model without walls, cycles written out.
struct PlannedStep {
  std::optional<Prescription> first{};    ///< first channel; none: the controlled quantity keeps its value
  std::optional<Prescription> lateral{};  ///< second channel; none: the controlled quantity keeps its value
  bool may_end_early = false;             ///< true if the step has a condition
};

/// Samples from a file that an option names: a curve y(x), or a table of values over x and y.
struct SampledCurve {
  std::string text;  ///< the file as it was read
  std::vector<double> x{};
  std::vector<double> y{};
  std::vector<std::vector<double>> values{};  ///< further columns of a table, in the order of OptionKey::columns
};

/// Value of an option: toggle, quantity [SI], or the word of a choice or file name.
using OptionValue = std::variant<bool, double, std::string>;

/// A scenario as its model sees it. Each value alone is admissible; Model::objections checks them together.
struct ModelInput {
  double radius = 0.0;                                ///< R0 [m]; 0 if the model has no particle
  const std::map<std::string, double>& values;        ///< values of the keys in `[material]` [SI]
  const std::map<std::string, OptionValue>& options;  ///< options by name, defaults filled in
  const std::map<std::string, SampledCurve>& curves;  ///< content of the files, by the option that names the file
  std::string_view configuration{};                   ///< wall set; empty if the model has none
  bool centre_is_free = false;         ///< true if the forces on the particle determine the position of its centre
  std::vector<PlannedStep> program{};  ///< program of a model without walls; empty with walls
  std::string_view integrator{};       ///< integrator that the scenario names, before `auto` is resolved

  /// Value of a key in `[material]` [SI]. @throws std::out_of_range if the scenario has no such key
  [[nodiscard]] double material(const char* key) const {
    const auto found = values.find(key);
    if (found != values.end()) return found->second;
    throw std::out_of_range(std::string("the law asks for '") + key + "', which is no key of its [material]");
  }
  /// Value of a key in `[material]` [SI]; none if the scenario has no such key.
  [[nodiscard]] std::optional<double> optional_material(const char* key) const {
    const auto found = values.find(key);
    return found == values.end() ? std::nullopt : std::optional(found->second);
  }
  /// Value of an option of kind quantity [SI]; none if it is absent.
  [[nodiscard]] std::optional<double> number(const char* key) const {
    const auto found = options.find(key);
    return found == options.end() ? std::nullopt : std::optional(std::get<double>(found->second));
  }
  /// Word of an option of kind choice, or file name of an option of kind file.
  [[nodiscard]] const std::string& word(const char* key) const { return std::get<std::string>(options.at(key)); }
  [[nodiscard]] bool toggle(const char* key) const { return std::get<bool>(options.at(key)); }
  [[nodiscard]] const SampledCurve* curve(const char* key) const {
    const auto found = curves.find(key);
    return found == curves.end() ? nullptr : &found->second;
  }
  /// Value of an option of kind choice as an enumerator, by a table of words and enumerators.
  /// @throws std::logic_error if the table lacks the word
  template <class Enum, std::size_t N>
  [[nodiscard]] Enum choice(const char* key, const std::pair<const char*, Enum> (&table)[N]) const {
    for (const auto& [name, value] : table) {
      if (word(key) == name) return value;
    }
    throw std::logic_error(std::string("option ") + key + " = '" + word(key) + "' was checked but is not bound");
  }
};

/// A fault of a scenario whose values are inconsistent, though each is admissible.
struct Objection {
  std::string_view key;  ///< key in `[material]` or in the model's own table, or `configuration`
  std::string message;
  std::optional<std::size_t> step{};  ///< index of a step; if given, the message points to this step, not to the key
};

/// Contact classes of a scene and their ramps in the first step. The ramp of a wall at rest ends where it starts.
struct FirstStep {
  std::span<const ContactClass> classes;
  std::span<const Ramp> ramps;  ///< one for each class [SI]
};

/// A constant that follows from the material of a scenario, before the program starts.
struct DerivedParameter {
  std::string_view name;
  double value = 0.0;
  std::string_view unit;
  std::string_view symbol{};  ///< symbol in the source; empty: none
};

/// Lists keys of `[material]` with their values, as constants with the given units. Keys that the scenario lacks are
/// left out.
[[nodiscard]] std::vector<DerivedParameter> material_parameters(
    const ModelInput& input, std::initializer_list<std::pair<const char*, std::string_view>> keys);

/// A channel of a model without walls, at rest before the first step.
struct RestingChannel {
  std::string_view name;
  Ramp at_rest;                      ///< constant ramp of the quantity that is controlled at rest [SI]
  bool is_lateral = false;           ///< true for the second channel, which follows the lateral parts of the steps
  bool is_unloaded_at_rest = false;  ///< true if every other quantity that a step may prescribe is zero at rest
};

/// Ludwik's law sigma = Y + K eps_pl^(1/n), with the strain up to which a power law has to stand for it.
struct LudwikInput {
  double youngs_modulus = 0.0;  ///< [Pa]; infinite: rigid
  double yield_stress = 0.0;    ///< Y [Pa]
  double strength = 0.0;        ///< K [Pa]
  double exponent = 0.0;        ///< 1/n
  double largest_strain = 0.0;  ///< end of the fit
  bool fits_both = true;        ///< true: fit strength and exponent; false: fit the exponent, with the strength Y + K
};

/// sigma = strength eps^exponent.
struct PowerLaw {
  double strength = 0.0;  ///< [Pa]
  double exponent = 0.0;
};

// stress_test/draw.hpp, stress_test/checks.hpp, system/curve_procedure.hpp, system/adhesion_map.hpp,
// system/continuum_material.hpp and system/lammps_law.hpp define these.
class Dice;
struct AdhesionMap;
struct CheckedRun;
struct ContinuumMaterial;
struct CurveProcedure;
struct DrawnMaterial;
struct DrawnStep;
struct LammpsLaw;
struct ProgramBounds;
struct Violation;

/// A model: its description for users, and its functions for the workbench.
struct Model {
  std::string_view name{};
  std::string_view summary{};
  /// Publications of the law, the main one first.
  std::span<const Citation* const> references{};
  /// Equations of the references that give the law, and the misprints that are corrected.
  std::string_view source{};
  std::span<const QuantityKey> material{};
  std::span<const OptionKey> options{};
  std::span<const std::string_view> configurations{};  ///< wall sets that a scenario may name; empty: no choice
  bool has_free_centre = false;                        ///< true if `[loading] centre = "equilibrium"` is allowed
  bool has_contact_area = true;  ///< true if the law has contact radii, pressures, and a surface that may move
  bool has_profile = false;      ///< true if HybridSystem::surface() gives pressure and surface under a contact
  std::span<const Term> regimes{};
  std::span<const Term> events{};
  std::span<const std::string_view> domain{};     ///< limits of validity, a sentence each
  double least_wall_angle = 0.0;                  ///< smallest admissible angle between the normals of two walls [rad]
  std::span<const OptionKey> material_options{};  ///< options in the table `[material]`
  /// Materials that the key `preset` in `[material]` may name. Keys given beside `preset` override its values.
  std::span<const Preset> presets{};
  std::string_view sign{};  ///< sign convention of stresses and strains; empty: compression is positive
  /// Quantities that a step prescribes in a model without particle and walls; empty: the model has particle and walls.
  std::span<const DriveKey> drives{};
  /// Quantities that a step prescribes in the second channel of a model without walls, under keys of their own.
  std::span<const DriveKey> lateral_drives{};
  /// Quantities that a condition of a step in a model without walls can wait for, besides events.
  std::span<const QuantityKey> conditions{};

  /// Parts of other models that this model lacks; run.json lists them.
  std::span<const std::string_view> skipped{};
  /// True if a contact moves the surface under the other walls, so that the sign of an overlap does not show a contact.
  bool moves_surface = false;
  /// True if walls cannot pull, and a step that prescribes a negative force ends the run.
  bool stops_when_pulled = false;
  /// True if pores of the particle close, so that it may become smaller than it was.
  bool has_pores = false;

  // --- functions

  /// Lists inconsistent values. Null: any admissible values are consistent.
  std::vector<Objection> (*objections)(const ModelInput& input) = nullptr;
  /// Lists what a scenario may mean otherwise than it says, a sentence each, as warnings. Null: nothing is listed.
  std::vector<std::string> (*reservations)(const ModelInput& input) = nullptr;
  /// Fits `strength` and `hardening_exponent` to Ludwik's law. Null: the model has no key `ludwik`.
  PowerLaw (*power_law_of)(const LudwikInput& ludwik) = nullptr;
  /// Makes the equations for contact classes; `classes` is empty for a model without walls. Never null.
  /// @param reach  largest displacement and force that the program prescribes
  std::unique_ptr<HybridSystem> (*bind)(const ModelInput& input, std::vector<ContactClass> classes,
                                        const Reach& reach) = nullptr;
  /// Lists the channels of a model without walls. Null: the model has walls.
  std::vector<RestingChannel> (*channels)(const ModelInput& input) = nullptr;
  /// Lists the constants that follow from the material. Null: there are none.
  std::vector<DerivedParameter> (*parameters)(const ModelInput& input, const FirstStep& step) = nullptr;
  /// Upper bound of displacement and force at which a contact first meets a condition; infinite if only a run can show
  /// it. Null: only conditions on a displacement or a force have a bound, their value.
  Reach (*reach)(const ModelInput& input, const Until& until) = nullptr;
  /// True if the law has an unloading branch. Null: it has one.
  bool (*can_unload)(const ModelInput& input) = nullptr;
  /// True if unloading retraces the loading curve, so that all work is stored. Null: it does not.
  bool (*is_elastic)(const ModelInput& input) = nullptr;
  /// Draws material, options and bounds of a program for the stress test. Null: the stress test leaves the model out.
  ProgramBounds (*draw)(Dice& dice, DrawnMaterial& drawn) = nullptr;
  /// Draws the program of a stress-test scene without walls. Null: the stress test draws a program of walls.
  std::vector<DrawnStep> (*draw_program)(Dice& dice, const DrawnMaterial& drawn, const ProgramBounds& bounds,
                                         std::size_t count) = nullptr;
  /// Checks the rules that every history of this model has to meet. Null: only the rules for all models are checked.
  void (*check)(const CheckedRun& run, std::vector<Violation>& found) = nullptr;
  /// True if a column may be undefined (NaN) in a row. Null: no column may.
  bool (*may_be_undefined)(const CheckedRun& run, std::size_t row, std::string_view column) = nullptr;
  /// Procedure of the source that finds parameters from a measured curve. Null: there is none.
  const CurveProcedure* curve_procedure = nullptr;
  /// Map of the materials for which the model's pull-off can be trusted. Null: there is none.
  const AdhesionMap* adhesion_map = nullptr;
  /// Law of LAMMPS with these equations. Null: LAMMPS has none.
  /// @throws std::invalid_argument that says why LAMMPS has none for the options or the material of the scenario
  LammpsLaw (*lammps_law)(const ModelInput& input) = nullptr;
  /// Material for finite elements of the particle. Null: its particle is no isotropic elastic-plastic body.
  /// @throws std::invalid_argument that says what the scenario lacks
  ContinuumMaterial (*continuum_material)(const ModelInput& input) = nullptr;

  /// True if the model has a particle and walls; false for a material point or a packing.
  [[nodiscard]] bool has_walls() const noexcept { return drives.empty(); }
};

/// The references of a model as lines of text (citation_text), the main one first.
[[nodiscard]] std::vector<std::string> reference_texts(const Model& model);

}  // namespace monograin
