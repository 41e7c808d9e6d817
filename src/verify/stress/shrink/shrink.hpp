/// Reduction of a scene that breaks a rule to a smaller one that still does.
#pragma once

#include <functional>

#include "verify/stress/draw/scene.hpp"

namespace monograin {

/// Makes a scene smaller as long as it stays faulty: removes walls, steps, cycles and options, and rounds numbers.
/// @param is_faulty  called with candidates, which need not be admissible
[[nodiscard]] StressScene shrink(StressScene scene, const std::function<bool(const StressScene&)>& is_faulty);

}  // namespace monograin
