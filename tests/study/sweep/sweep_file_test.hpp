/// Sweep files in a folder of their own.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "scenario/faults.hpp"
#include "study/sweep/sweep_file.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"

namespace monograin {

class SweepFileTest : public ::testing::Test {
 protected:
  /// The sweep of a text, as s.toml.
  [[nodiscard]] Sweep read(const std::string& text) const {
    write_text(folder() / "s.toml", text);
    return read_sweep(folder() / "s.toml");
  }
  /// All that is wrong with it; empty: nothing.
  [[nodiscard]] std::string fault(const std::string& text) const {
    try {
      static_cast<void>(read(text));
    } catch (const ScenarioError& error) {
      return error.what();
    }
    return {};
  }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
};

}  // namespace monograin
