/// How a run ends: its status, and the exception of a run that was interrupted.
#pragma once

#include <stdexcept>
#include <string_view>

namespace monograin {

/// Status with which a run ends.
enum class RunStatus {
  complete,  ///< the program was run to its end
  stopped,   ///< the run reached a limit of the model's domain
  failed     ///< the solver gave up
};

/// Thrown by a run that RunOptions::stop has ended.
class RunInterrupted : public std::runtime_error {
 public:
  RunInterrupted() : std::runtime_error("the run was interrupted") {}
};

/// Name of a status, as run.json has it: "complete", "stopped" or "failed".
[[nodiscard]] std::string_view to_string(RunStatus status) noexcept;

}  // namespace monograin
