/// Ends of the segments of a yield surface, and where the state passes from one to the next.
///
/// At an end where the flow is isochoric, phi is stationary and the pressure moves as the program prescribes. The state
/// passes such an end in one direction only, and only if the program moves the pressure in that direction. Otherwise it
/// tends to the end (critical state) without reaching it.
#pragma once

#include "material-point/plastic_flow.hpp"

namespace monograin::material_point {

/// Rate of the pressure at an isochoric end of the present segment, where s follows p along the tangent.
[[nodiscard]] double pressure_rate_at_end(const Phase& phase, const Response& now, bool towards_compression);

/// True if the present segment has an end on that side that the state may pass as the program goes on.
[[nodiscard]] bool has_passable_end(const Phase& phase, const Response& now, bool towards_compression);

/// True if the state lies at an isochoric end of its segment and the program passes that end.
[[nodiscard]] bool stands_at_passed_end(const Phase& phase, const Response& now, bool towards_compression);

/// True if the flow takes a state at an end of its segment out through it. Where an arc joins a shear line, the flow is
/// the same on both, and a state that has just crossed may return by round-off alone.
[[nodiscard]] bool leads_out(const Phase& phase, const Response& now, bool towards_compression);

/// Branch beyond an end of the present segment. On the caps s may have changed its sign.
[[nodiscard]] Branch branch_beyond(const Phase& phase, const Response& now, bool towards_compression);

/// Sign of s. If s is zero to within error: that of its elastic rate, or 0 if s stays.
[[nodiscard]] double side_of(const Phase& phase, const Response& now);

/// True if s may change its sign. Under prescribed strains, the flow's share in the rate of s is proportional to s.
/// Then s passes zero only if the program drives it there; otherwise it decays into an integrator's error.
[[nodiscard]] bool may_pass_apex(const Phase& phase, const Response& now);

}  // namespace monograin::material_point
