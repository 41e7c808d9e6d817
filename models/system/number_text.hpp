/// Numbers in messages.
#pragma once

#include <array>
#include <charconv>
#include <string>

namespace monograin {

/// A number as text, independent of the locale.
/// @param digits  significant digits; 0: as few as read back as the same number
[[nodiscard]] inline std::string number_text(double value, int digits = 0) {
  std::array<char, 32> text{};
  char* const end = text.data() + text.size();
  const auto result = digits > 0 ? std::to_chars(text.data(), end, value, std::chars_format::general, digits)
                                 : std::to_chars(text.data(), end, value);
  return {text.data(), result.ptr};
}

}  // namespace monograin
