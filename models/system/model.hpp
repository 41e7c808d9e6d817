/// Definition of a model as one value of type Model, made in the folder of its law.
///
/// The data give the name, keys, regimes, events and sources of the model. The reader of scenario files, the JSON
/// Schema and `monograin models` use these data, so that each key is described once. The functions turn a checked
/// scenario into equations, bound how far a program goes, draw scenes for the stress test and check their histories.
/// The workbench uses only this value and refers to no model by name.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "system/citation.hpp"
#include "system/hybrid_system.hpp"
#include "system/keys.hpp"
#include "system/model_input.hpp"

namespace monograin {

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

  /// True if a key of `[material]` is a surface energy: the law has adhesion.
  [[nodiscard]] bool has_adhesion() const noexcept;

  /// True if the surface energy among the values of `[material]` [SI] is positive, so that walls may pull.
  [[nodiscard]] bool adheres(const std::map<std::string, double>& values) const;
};

/// The references of a model as lines of text (citation_text), the main one first.
[[nodiscard]] std::vector<std::string> reference_texts(const Model& model);

}  // namespace monograin
