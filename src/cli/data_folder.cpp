#include "cli/data_folder.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "cli/commands.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_variable = "MONOGRAIN_DATA";
/// Path from the folder of the installed program to that of its data.
constexpr const char* k_installed = MONOGRAIN_DATA_FROM_PROGRAM;
/// File beside a program in a build tree that contains the path of the checkout.
constexpr const char* k_checkout_file = "monograin-data";

/// True for a file, and for a folder with definitions, scenarios or curves: a folder of a user may be called plots,
/// too. What cannot be read counts as missing.
bool is_there(const fs::path& part) {
  std::error_code error;
  if (!fs::is_directory(part, error)) return fs::exists(part, error);
  const fs::directory_iterator files(part, error);
  const char* extension = part.filename() == "curves" ? ".csv" : ".toml";
  return !error && std::any_of(begin(files), end(files), [extension](const fs::directory_entry& entry) {
    return entry.path().extension() == extension;
  });
}

/// The first part that a folder does not have; empty if it has all.
std::string_view missing_part(const DataFolder& folder, std::initializer_list<std::string_view> parts) {
  const auto found =
      std::ranges::find_if_not(parts, [&](std::string_view part) { return is_there(folder.path(part)); });
  return found == parts.end() ? std::string_view{} : *found;
}

/// Folders that may have the data, found from the path of the program.
std::vector<DataFolder> folders_of_program() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (error) return {};
  std::vector<DataFolder> folders{
      {.root = (program.parent_path() / k_installed).lexically_normal(), .is_checkout = false}};
  std::ifstream file(program.parent_path() / k_checkout_file);
  std::string checkout;
  if (std::getline(file, checkout) && !checkout.empty()) folders.push_back({.root = checkout});
  return folders;
}

}  // namespace

fs::path DataFolder::path(std::string_view part) const {
  return root / (is_checkout && part == "curves" ? "tests/curves" : part);
}

DataFolder find_data(std::initializer_list<std::string_view> parts) {
  if (const char* named = std::getenv(k_variable); named != nullptr && *named != '\0') {
    const DataFolder installed{.root = named, .is_checkout = false};
    const DataFolder checkout{.root = named};
    const std::string_view missing = missing_part(installed, parts);
    if (missing.empty()) return installed;
    if (missing_part(checkout, parts).empty()) return checkout;
    throw UsageError(fmt::format("{} = {} has no '{}'; expected a folder with scenarios, plots and curves", k_variable,
                                 named, missing));
  }
  std::vector<DataFolder> folders{DataFolder{}};
  std::ranges::move(folders_of_program(), std::back_inserter(folders));
  const auto found =
      std::ranges::find_if(folders, [&](const DataFolder& folder) { return missing_part(folder, parts).empty(); });
  return found == folders.end() ? DataFolder{} : *found;
}

}  // namespace monograin
