// Finite elements beside a law, as others use them.

#include "monograin/continuum.hpp"

#include <gtest/gtest.h>
#include <signal.h>

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "api/ready.hpp"
#include "support/calculix_stand_in.hpp"
#include "support/refusal.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

/// Sets a variable of the environment as long as a test.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    setenv(name, value.c_str(), 1);
  }
  ~Variable() { before_.empty() ? unsetenv(name_) : setenv(name_, before_.c_str(), 1); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::string before_;
};

/// A program in the place of CalculiX, and a folder for temporary files.
class Continuum : public testing::Test {
 protected:
  Continuum() {
    fs::create_directory(path("bin"));
    fs::create_directory(path("temporary"));
  }
  void put_in_place(const std::string& script) const {
    write_text(path("bin/ccx"), "#!/bin/sh\n" + script);
    fs::permissions(path("bin/ccx"), fs::perms::owner_all);
  }
  [[nodiscard]] fs::path path(const std::string& name) const { return folder_.path() / name; }
  [[nodiscard]] bool has_temporary_files() const { return !fs::is_empty(path("temporary")); }

 private:
  TemporaryFolder folder_;
  Variable path_{"PATH", (folder_.path() / "bin").string() + ":" + std::getenv("PATH")};
  Variable temporary_{"TMPDIR", (folder_.path() / "temporary").string()};
};

TEST_F(Continuum, IsARunBesideThatOfTheLaw) {
  put_in_place(k_constant_forces);
  const ContinuumResult found = continuum(ready_scenario("cel.toml"), {.mesh = "coarse"});
  EXPECT_EQ(found.run.status, RunStatus::complete) << found.run.message;
  EXPECT_EQ(found.solver, "CalculiX 2.20");
  EXPECT_EQ(found.run.integrator, found.solver);
  EXPECT_GT(found.elements, 100U);
  ASSERT_EQ(found.differences.size(), 4U);
  EXPECT_EQ(found.differences[0].column, "axial.force");
  EXPECT_GT(found.differences[0].loading, 0.0);
  EXPECT_TRUE(std::isnan(found.differences[0].mesh_error));
  const double unit = 1e9 * 0.01 * 0.01 / (1000.0 * 10.0 * 10.0);
  EXPECT_NEAR(found.run.history["axial.force"].back(), 8.0 * 3.0 * unit, 1e-9);
  EXPECT_NEAR(found.run.history["volume"].back(), 4.0 / 3.0 * std::numbers::pi * 1e-6, 1e-18);
  EXPECT_EQ(found.run.history["axial.displacement"].back(), found.law.history["axial.displacement"].back());
  EXPECT_TRUE(contains(found.run.json(), "\"model\": \"continuum\""));
  EXPECT_TRUE(contains(found.run.json(), "\"law_of\": \"cel\""));
  EXPECT_FALSE(contains(found.run.json(), "tolerances"));
  EXPECT_TRUE(contains(refusal<std::runtime_error>([&] { return found.run.profile(0.5); }), "have no profile"));
  EXPECT_FALSE(has_temporary_files());
}

TEST_F(Continuum, LeavesItsFilesInAFolderAndThoseOfCalculixIfAsked) {
  put_in_place(k_constant_forces);
  const RunResult law = run(ready_scenario("cel.toml"));
  const auto files_in = [](const fs::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
    return names;
  };
  const ContinuumResult found = continuum(law, {.mesh = "coarse", .folder = path("plain")});
  EXPECT_EQ(files_in(path("plain")), (std::set<std::string>{".monograin", "events.csv", "history.csv", "run.json"}));
  static_cast<void>(continuum(law, {.mesh = "coarse", .folder = path("kept"), .keeps_files = true}));
  EXPECT_TRUE(files_in(path("kept")).contains("continuum.inp"));
  EXPECT_EQ(read_text(path("plain/run.json")), found.run.json());
  EXPECT_EQ(read_text(path("plain/history.csv")), read_text(path("kept/history.csv")));
  found.run.save(path("saved"));
  for (const char* name : {"events.csv", "history.csv", "run.json"}) {
    EXPECT_EQ(read_text(path("saved") / name), read_text(path("plain") / name)) << name;
  }
}

TEST_F(Continuum, EndsCalculixWhenItIsAskedTo) {
  put_in_place("[ \"$1\" = -v ] && exit\necho $$ > '" + path("process").string() + "'\nexec sleep 600\n");
  const auto stop = [&] { return read_text(path("process")).ends_with('\n'); };
  EXPECT_THROW(static_cast<void>(continuum(run(ready_scenario("cel.toml")), {.folder = path("fe"), .stop = stop})),
               RunInterrupted);
  EXPECT_EQ(kill(std::stoi(read_text(path("process"))), 0), -1);
  EXPECT_EQ(errno, ESRCH);
  EXPECT_FALSE(fs::exists(path("fe")));
}

TEST_F(Continuum, WritesNothingWhenTheSignalThatAsksEndsCalculixToo) {
  put_in_place("[ \"$1\" = -v ] && exit\ntouch '" + path("interrupted").string() + "'\nkill -INT $$\n");
  const auto stop = [&] { return fs::exists(path("interrupted")); };
  const RunResult law = run(ready_scenario("cel.toml"));
  EXPECT_THROW(static_cast<void>(continuum(law, {.folder = path("fe"), .stop = stop})), RunInterrupted);
  EXPECT_FALSE(fs::exists(path("fe")));
}

TEST_F(Continuum, RefusesWhatItCannotCompute) {
  put_in_place("touch '" + path("called").string() + "'\n");
  const auto refused = [&](const auto& source, const ContinuumOptions& options) {
    return refusal<std::invalid_argument>([&] { return continuum(source, options); });
  };
  EXPECT_TRUE(contains(refused(ready_scenario("packing.toml"), {}), "has no material for finite elements"));
  EXPECT_TRUE(
      contains(refused(ready_scenario("die.toml"), {.mesh = "finest"}), "expected one of coarse, medium, fine"));
  EXPECT_TRUE(contains(refused(ready_scenario("die.toml"), {.keeps_files = true}), "no folder"));
  EXPECT_FALSE(fs::exists(path("called")));
  put_in_place(k_constant_forces);
  const ContinuumResult found = continuum(ready_scenario("cel.toml"), {.mesh = "coarse"});
  EXPECT_TRUE(contains(refused(found.run, {.mesh = "coarse"}), "expected the run of a law"));
  const Variable none("PATH", "/nowhere");
  EXPECT_TRUE(contains(refusal<std::runtime_error>([&] { return continuum(ready_scenario("die.toml")); }),
                       "apt-get install calculix-ccx"));
  EXPECT_FALSE(has_temporary_files());
}

}  // namespace
}  // namespace monograin
