#include "material-point/presets.hpp"

#include <array>

namespace monograin::material_point {
namespace {

using Value = Preset::Value;

using Material = std::array<Value, 13>;

constexpr Material material(double reference_density, double yield_pressure, double stiffness_ratio,
                            double tensile_ratio, double shear_ratio, double xi2, double eps0, double eta, double xi,
                            double omega, double zeta, double xi1, double nu0) {
  return {{{"reference_density", reference_density},
           {"yield_pressure", yield_pressure * 1e6},  // MPa in the tables
           {"stiffness_ratio", stiffness_ratio},
           {"tensile_ratio", tensile_ratio},
           {"shear_ratio", shear_ratio},
           {"xi2", xi2},
           {"eps0", eps0},
           {"eta", eta},
           {"xi", xi},
           {"omega", omega},
           {"zeta", zeta},
           {"xi1", xi1},
           {"nu0", nu0}}};
}

// Table 4, three to five printed digits. The axis ratios below zero are starred there: the linear law of eq. 5b does
// not hold at the reference density, so that such a material has to start denser.
constexpr Material k_dical_emcompress =
    material(0.4, 3.68, 202, 0.00149, 1.139, 0.844, 0.455, 9.94, 9.82, 19.8, 18.66, 0.367, 0.15);
constexpr Material k_dical_fujicalin =
    material(0.4, 28.2, 36, 0.0759, 0.944, 1.0222, 0.645, 8.25, 9.92, 5.91, 4.86, 0.362, 0.147);
constexpr Material k_lactose_dt =
    material(0.4, 0.76, 436, 0.0925, 1.141, 1.006, 0.304, 12.01, 8.39, 9.45, 8.66, 0.123, 0.172);
constexpr Material k_lactose_310_nf =
    material(0.4, 0.33, 500, 0.00168, 1.205, 0.88, 0.314, 13.62, 9.6, 18.77, 14.18, 0.231, 0.153);
constexpr Material k_mcc_ph_102 =
    material(0.4, 4.83, 134, 0.187, 1.475, 2.291, -0.0783, 7.17, 4.48, 6.27, 5.41, 0.511, 0.119);
constexpr Material k_mcc_ph_200 =
    material(0.4, 8.61, 51.3, 0.0995, 1.351, 2.007, 0.147, 6.11, 5.25, 6.28, 5.43, 0.443, 0.1472);
constexpr Material k_starch_1500 =
    material(0.4, 1.49, 335, 0.00367, 1.825, 3.0364, -0.103, 16.29, 4.96, 14.03, 15.1, 0.878, 0.063);

// Table 6
constexpr Material k_base_case = material(0.7, 150, 100, 0.01, 1.0, 1.5, 0.7, 10, 7.5, 10, 10, 0.4, 0.3);

// Table 5
using Stiffness = std::array<Value, 1>;
constexpr Stiffness k_silanized_glass_beads_dry{{{"stiffness_ratio", 344.8}}};
constexpr Stiffness k_lactose_monohydrate_dry{{{"stiffness_ratio", 133.3}}};
constexpr Stiffness k_monocrystalline_cellulose_dry{{{"stiffness_ratio", 163.9}}};
constexpr Stiffness k_starch_dry{{{"stiffness_ratio", 174.3}}};
constexpr Stiffness k_alumina_sintered_5_strain{{{"stiffness_ratio", 1357.8}}};
constexpr Stiffness k_alumina_sintered_20_strain{{{"stiffness_ratio", 1574.5}}};
constexpr Stiffness k_glass_beads_w_polyvinylpyrrolidone_pvp_binder{{{"stiffness_ratio", 32}}};
constexpr Stiffness k_silica_sand_w_pvp_binder{{{"stiffness_ratio", 32}}};
constexpr Stiffness k_lactose_avicel_starch_w_water_binder{{{"stiffness_ratio", 4.5}}};
constexpr Stiffness k_lactose_avicel_starch_w_waterethanol_binder{{{"stiffness_ratio", 5.3}}};

constexpr std::array k_presets{
    Preset{"Dical Emcompress", "Table 4", k_dical_emcompress},
    Preset{"Dical Fujicalin", "Table 4", k_dical_fujicalin},
    Preset{"Lactose DT", "Table 4", k_lactose_dt},
    Preset{"Lactose 310 NF", "Table 4", k_lactose_310_nf},
    Preset{"MCC PH-102", "Table 4", k_mcc_ph_102},
    Preset{"MCC PH-200", "Table 4", k_mcc_ph_200},
    Preset{"Starch 1500", "Table 4", k_starch_1500},
    Preset{"Base case", "Table 6", k_base_case},
    Preset{"Silanized glass beads, dry", "Table 5", k_silanized_glass_beads_dry},
    Preset{"Lactose monohydrate, dry", "Table 5", k_lactose_monohydrate_dry},
    Preset{"Monocrystalline cellulose, dry", "Table 5", k_monocrystalline_cellulose_dry},
    Preset{"Starch, dry", "Table 5", k_starch_dry},
    Preset{"Alumina, sintered (5% strain)", "Table 5", k_alumina_sintered_5_strain},
    Preset{"Alumina, sintered (20% strain)", "Table 5", k_alumina_sintered_20_strain},
    Preset{"Glass beads w/ polyvinylpyrrolidone (PVP) binder", "Table 5",
           k_glass_beads_w_polyvinylpyrrolidone_pvp_binder},
    Preset{"Silica sand w/ PVP binder", "Table 5", k_silica_sand_w_pvp_binder},
    Preset{"Lactose-Avicel-Starch w/ water binder", "Table 5", k_lactose_avicel_starch_w_water_binder},
    Preset{"Lactose-Avicel-Starch w/ water/ethanol binder", "Table 5", k_lactose_avicel_starch_w_waterethanol_binder},
};

}  // namespace

std::span<const Preset> presets() noexcept { return k_presets; }

}  // namespace monograin::material_point
