/// Names of the integrators that a scenario may select, and their default tolerances. No other file of the program
/// spells them.
#pragma once

#include <array>
#include <string_view>

namespace monograin::integrators {

inline constexpr const char* k_auto = "auto";  ///< the cheapest that reaches the accuracy
inline constexpr const char* k_direct = "direct";
inline constexpr const char* k_cvode_bdf = "cvode-bdf";
inline constexpr const char* k_cvode_adams = "cvode-adams";
inline constexpr const char* k_ida = "ida";
inline constexpr const char* k_arkode_erk = "arkode-erk";
inline constexpr const char* k_arkode_dirk = "arkode-dirk";
inline constexpr const char* k_odeint_dopri5 = "odeint-dopri5";
inline constexpr const char* k_odeint_fehlberg78 = "odeint-fehlberg78";
inline constexpr const char* k_odeint_bulirsch_stoer = "odeint-bulirsch-stoer";
inline constexpr const char* k_odeint_rosenbrock4 = "odeint-rosenbrock4";
inline constexpr const char* k_gsl_rk8pd = "gsl-rk8pd";
inline constexpr const char* k_gsl_msadams = "gsl-msadams";
inline constexpr const char* k_gsl_msbdf = "gsl-msbdf";
inline constexpr const char* k_forward_euler = "forward-euler";

/// All integrators, in the order of their lists for users.
inline constexpr std::array<std::string_view, 15> k_all{k_auto,
                                                        k_direct,
                                                        k_cvode_bdf,
                                                        k_cvode_adams,
                                                        k_ida,
                                                        k_arkode_erk,
                                                        k_arkode_dirk,
                                                        k_odeint_dopri5,
                                                        k_odeint_fehlberg78,
                                                        k_odeint_bulirsch_stoer,
                                                        k_odeint_rosenbrock4,
                                                        k_gsl_rk8pd,
                                                        k_gsl_msadams,
                                                        k_gsl_msbdf,
                                                        k_forward_euler};

/// Former name of forward Euler, which files may have.
inline constexpr const char* k_former_forward_euler = "explicit";
/// The present name of an integrator.
[[nodiscard]] constexpr std::string_view present_name(std::string_view name) noexcept {
  return name == k_former_forward_euler ? k_forward_euler : name;
}

inline constexpr double k_default_rtol = 1e-8;
inline constexpr double k_default_atol = 1e-12;  ///< relative to each unknown's own scale
/// Bound of the global error of an integration with error control, over its rtol (docs/performance.md).
inline constexpr double k_error_over_rtol = 100.0;
/// Bound of the difference of two results of the direct form, over the largest values: each state is polished to 1e-12
/// of them, and the work is a sum of quadratures.
inline constexpr double k_direct_tolerance = 1e-10;

}  // namespace monograin::integrators
