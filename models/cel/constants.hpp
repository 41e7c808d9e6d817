/// Constants of the law of coupled elastic-plastic contacts, all without unit.
///
/// Fifteen are fitted to finite-element curves of a sphere of elastic-perfectly plastic material: two walls (E/Y 6.25
/// to 200, Poisson's ratio 0 to 0.45), closed dies (E/Y 20 and 50) and six walls at once (E/Y 20 and 50). Nine were
/// chosen before the fit. Curves that took no part in it check the law (docs/theory/cel.md).
#pragma once

namespace monograin::cel::constants {

// --- pressure of a local indentation, fitted
inline constexpr double pY = 1.28724;    ///< mean pressure at yield over Y
inline constexpr double pinf = 4.19072;  ///< mean pressure of a half-space far beyond yield, over Y
inline constexpr double ps = 1.58441;    ///< mean pressure of a deep dent in a particle of finite size, over Y
inline constexpr double hs = 0.0438701;  ///< indentation over R0 at which the finite size matters
inline constexpr int k = 5;              ///< sharpness of the change from one to the other; chosen

// --- indentation that belongs to a dent, fitted
inline constexpr double x1 = 1.87686;   ///< excess of Johnson's parameter over which a dent becomes fully plastic
inline constexpr double k0 = 0.444946;  ///< fully plastic indentation over the square of the dent
inline constexpr double k1 = 1.8449;    ///< factor of the next term, of the fourth power
inline constexpr int x2 = 2;            ///< excess of Johnson's parameter over which the k1 term fades; chosen

// --- elastic unloading
inline constexpr double q1 = 6.84409;   ///< how fast the exponent of the contact radius falls with the dent; fitted
inline constexpr double gam = 0.56191;  ///< growth of the compliance with the dent; fitted
inline constexpr double hg = 0.15;      ///< indentation over which the compliance grows; chosen
inline constexpr double kap = 0.3;      ///< how fast coverage removes the influence of neighbours; chosen

// --- core
inline constexpr double s0 = 2.02803;   ///< strength of the core over Y R0^2; fitted
inline constexpr double s1 = 2.97636;   ///< growth of the strength with the strain of the core; fitted
inline constexpr double chi = 1.34517;  ///< advance of a wall per bulge of the core under it; fitted
inline constexpr double w = 0.01;       ///< width of the change from chi to one, as the core shrinks; chosen

// --- coverage, fitted
inline constexpr double m2 = 0.292764;  ///< loss of the limit force as pores begin to close
inline constexpr double m4 = 0.447332;  ///< gain of the limit force as pores are closed
inline constexpr double ab = 0.185636;  ///< area over pi R0^2 above which a carried contact is not weak
inline constexpr double beta = 0.95;    ///< largest weakness of a carried contact; chosen

// --- yield function, chosen
inline constexpr int n1 = 7;  ///< power of a contact's force
inline constexpr int n2 = 3;  ///< power of the core's load
inline constexpr int n3 = 2;  ///< power of the core's load in the weakness of carried contacts

}  // namespace monograin::cel::constants
