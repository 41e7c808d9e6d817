// The corpus of the fuzz target, without a fuzzer.

#include <gtest/gtest.h>

#include <filesystem>

#include "fuzz/readers.hpp"
#include "support/text_file.hpp"

namespace monograin::replay_test {
namespace {

namespace fs = std::filesystem;

TEST(FuzzCorpus, IsReadOrRefused) {
  int read = 0;
  for (const char* folder : {"tests/fuzz/corpus", "tests/scenario/corpus", "scenarios"}) {
    for (const auto& entry : fs::directory_iterator(fs::path(MONOGRAIN_SOURCE_DIR) / folder)) {
      if (!entry.is_regular_file()) continue;
      EXPECT_NO_THROW(read_any(read_text(entry.path()))) << entry.path();
      ++read;
    }
  }
  EXPECT_GT(read, 180);
}

}  // namespace
}  // namespace monograin::replay_test
