/// From a scene that breaks a rule to a smaller one that still does.
#pragma once

#include <functional>

#include "verify/stress/draw/scene.hpp"

namespace monograin {

/// Makes a scene smaller as long as it stays faulty: without walls, steps, cycles, options, and with round numbers.
/// @param is_faulty  asked of every candidate, which need not be admissible
[[nodiscard]] StressScene shrink(StressScene scene, const std::function<bool(const StressScene&)>& is_faulty);

}  // namespace monograin
