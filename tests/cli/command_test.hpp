/// The program as a user runs it: as a process of its own, in a folder of its own.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"

namespace monograin {

/// What a process has left; its output also stands in stdout.txt and stderr.txt of the folder.
struct Outcome {
  int code = -1;
  std::string out;
  std::string err;
};

class CommandTest : public ::testing::Test {
 protected:
  /// Runs `monograin ARGUMENTS` in the test's folder.
  [[nodiscard]] Outcome monograin(const std::string& arguments) const;
  /// Runs a shell script in the test's folder, in which `monograin` and $M are the program; the exit code is the
  /// script's.
  [[nodiscard]] Outcome shell(const std::string& script) const;
  /// Starts `monograin ARGUMENTS` and ends it by a signal after some time; whether it was still running.
  bool start_and_kill(const std::vector<std::string>& arguments, std::chrono::microseconds delay,
                      int signal = SIGKILL) const;

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_.path(); }
  [[nodiscard]] std::filesystem::path path(const std::string& name) const { return folder() / name; }
  [[nodiscard]] std::string text(const std::string& name) const { return read_text(path(name)); }
  /// All files below the folder, but the two that catch the output.
  [[nodiscard]] std::vector<std::string> files() const;

 private:
  TemporaryFolder folder_;
};

}  // namespace monograin
