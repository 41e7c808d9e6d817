/// Material points written in code: materials, programs, and the reference histories beside the tests.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "material-point/model.hpp"
#include "material-point/properties.hpp"
#include "support/test_run.hpp"

namespace monograin::material_point {

/// The source's base case (Table 6).
[[nodiscard]] Parameters base_case();
/// The base case with other ratios of stiffness, shear and tensile strength.
[[nodiscard]] Parameters base_case(double stiffness_ratio, double shear_ratio, double tensile_ratio);
/// Lactose DT (Table 4) from relative density 0.5 as a Drucker-Prager cap.
[[nodiscard]] Parameters lactose(double transition_width);
/// Von Mises with constant moduli; eta = 0: perfectly plastic.
[[nodiscard]] Parameters von_mises(double eta);

// --- programs: logarithmic strains, and stresses in yield pressures (the yield pressure is 1 Pa here)

[[nodiscard]] Step strain(double axial, double duration = 1.0);
[[nodiscard]] Step strains(double axial, double lateral, double duration = 1.0);
[[nodiscard]] Step stress(double axial, double duration = 1.0);
/// A step of a triaxial program: axial stress and lateral stress.
[[nodiscard]] Step stresses(double axial, double lateral, double duration = 1.0);
[[nodiscard]] Step strain_and_stress(double axial_strain, double lateral_stress, double duration = 1.0);

[[nodiscard]] CheckedScenario point(const Parameters& parameters, Configuration configuration, std::vector<Step> steps);

// --- reference histories

/// A file of tests/models/material-point/reference with the scenario that its header describes.
struct PointReference {
  Table table;
  CheckedScenario scenario;  ///< output at the file's instants that are not events
};
inline constexpr const char* k_reference_points[] = {
    "mp01_vmdc_base_hydrostatic",    "mp02_vmdc_base_oedometric",      "mp03_vmdc_base_uniaxial_stress",
    "mp04_vmdc_base_triaxial",       "mp05_vmdc_tension_compression",  "mp06_dpc_lactose_dt_oedometric",
    "mp07_vm_hardening_uniaxial",    "mp08_vmdc_base_oedometric_stop", "mp09_vmdc_base_oedometric_cycles",
    "mp10_vmdc_general_strain_path",
};
[[nodiscard]] PointReference load_point(const std::string& name);

struct PointErrors {
  double largest = 0.0;     ///< of all rows and columns, over the column's largest magnitude
  std::string column;       ///< that has it
  double time = 0.0;        ///< where
  double event_time = 0.0;  ///< over the run's length
  std::string mismatch;     ///< of rows, regimes or events; empty: none
};
[[nodiscard]] PointErrors errors_against(const PointReference& reference, const RunRecord& run);

/// True if an integrator can run a scenario.
[[nodiscard]] bool is_offered(std::string_view integrator, const CheckedScenario& scenario);

}  // namespace monograin::material_point
