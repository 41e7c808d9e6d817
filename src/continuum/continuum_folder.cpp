#include "continuum/continuum_folder.hpp"

#include <stdlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "history/external_program.hpp"
#include "history/run_files.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

/// Files of CalculiX that a user may want; run_calculix() names them.
constexpr std::array<std::string_view, 6> k_calculix_files{"continuum.inp", "continuum.dat", "continuum.log",
                                                           "coarser.inp",   "coarser.dat",   "coarser.log"};

fs::path temporary_folder() {
  std::string pattern = (fs::temp_directory_path() / "monograin-continuum-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::system_error(errno, std::generic_category(), pattern);
  return pattern;
}

}  // namespace

fs::path find_calculix() {
  if (const auto ccx = find_program("ccx")) return *ccx;
  throw std::runtime_error(
      "ccx was not found on the PATH; finite elements need CalculiX (on Debian: apt-get install calculix-ccx)");
}

ContinuumFolder::ContinuumFolder(const fs::path& target, bool keeps_files) : keeps_files_(keeps_files) {
  if (target.empty()) {
    path_ = fs::absolute(temporary_folder());
    return;
  }
  std::vector<std::string_view> names(k_run_tables.begin(), k_run_tables.end());
  if (keeps_files) names.insert(names.end(), k_calculix_files.begin(), k_calculix_files.end());
  staged_.emplace(target, k_run_marker, names);
  path_ = fs::absolute(staged_->path());
}

ContinuumFolder::~ContinuumFolder() {
  std::error_code ignored;
  if (!staged_) fs::remove_all(path_, ignored);
}

void ContinuumFolder::publish(Run& run) {
  if (!staged_) return;
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(path_)) files.push_back(entry.path());
  for (const fs::path& file : files) {
    const bool is_wanted = std::ranges::find(k_calculix_files, file.filename().string()) != k_calculix_files.end();
    if (!keeps_files_ || !is_wanted) fs::remove(file);
  }
  write_run(run, *staged_);
}

}  // namespace monograin
