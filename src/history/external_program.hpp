/// Programs of others that monograin calls.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace monograin {

/// Path of a program in the folders of PATH; none if there is none.
[[nodiscard]] std::optional<std::filesystem::path> find_program(std::string_view name);

/// Runs a program in a folder, without input and with all output in a new log file, and waits for its end. It is ended
/// if the calling thread ends.
/// @param meanwhile  called about ten times a second until it ends; may be empty
/// @return its exit code, or the negative number of the signal that ended it
/// @throws std::runtime_error if it cannot be started
[[nodiscard]] int run_program(const std::filesystem::path& program, std::vector<std::string> words,
                              const std::filesystem::path& folder, const std::filesystem::path& log,
                              const std::function<void()>& meanwhile = {});

}  // namespace monograin
