/// Finds the ready scenarios, figure definitions and stored curves that come with the program.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string_view>

namespace monograin {

/// A folder with the program's data: a checkout, or the data of an installation.
struct DataFolder {
  std::filesystem::path root;  ///< empty: the current folder
  bool is_checkout = true;     ///< stored curves are in tests/curves, not in curves

  /// Path of a part: "scenarios", "plots" or a path below these, or "curves".
  [[nodiscard]] std::filesystem::path path(std::string_view part) const;
  /// True if the folder is the current one, a checkout in which the user works: results may go there.
  [[nodiscard]] bool is_current() const { return root.empty(); }
};

/// Finds the first folder that has all of the parts: the folder that the environment variable MONOGRAIN_DATA names, the
/// current folder, ../share/monograin relative to the program's folder, and the checkout from which the program was
/// built, whose path is in the file monograin-data beside the program.
/// @return the current folder if no folder has all parts
/// @throws UsageError if MONOGRAIN_DATA is set and its folder lacks a part
[[nodiscard]] DataFolder find_data(std::initializer_list<std::string_view> parts);

}  // namespace monograin
