/// How a run ends.
#pragma once

#include <string_view>

namespace monograin {

enum class RunStatus {
  complete,
  stopped,  ///< left the model's domain
  failed    ///< the solver gave up
};

[[nodiscard]] std::string_view to_string(RunStatus status) noexcept;

}  // namespace monograin
