/// Interface between a model and the engine, in three parts: equations that integrators solve, regimes whose ends the
/// engine locates, and observables that histories record.
#pragma once

#include <span>

#include "system/equations.hpp"
#include "system/observables.hpp"
#include "system/regimes.hpp"
#include "system/walls.hpp"

namespace monograin {

/// A model bound to a scene, as the engine runs it.
class HybridSystem : public Equations, public Regimes, public Observables {
 public:
  virtual ~HybridSystem() = default;

  /// Contact classes of the scene; empty if the model has no walls.
  [[nodiscard]] virtual std::span<const ContactClass> classes() const noexcept { return {}; }
};

}  // namespace monograin
