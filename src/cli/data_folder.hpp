/// Where the ready scenarios, figure definitions and stored curves are that come with the program.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string_view>

namespace monograin {

/// A folder with what comes with the program: a checkout, or the data that an installation has.
struct DataFolder {
  std::filesystem::path root;  ///< empty: the current folder
  bool is_checkout = true;     ///< stored curves stand in tests/curves, not in curves

  /// Path of a part: "scenarios" or "plots", with what is below them, or "curves".
  [[nodiscard]] std::filesystem::path path(std::string_view part) const;
  /// True for a checkout that the user works in: results may go there.
  [[nodiscard]] bool is_current() const { return root.empty(); }
};

/// Finds the first folder that has all of the parts: the one that the environment names in MONOGRAIN_DATA, the current
/// one, ../share/monograin seen from the program, and the checkout that the program was built from, which stands in the
/// file monograin-data beside it.
/// @return the current folder where none has them
/// @throws UsageError where MONOGRAIN_DATA is set and its folder lacks a part
[[nodiscard]] DataFolder find_data(std::initializer_list<std::string_view> parts);

}  // namespace monograin
