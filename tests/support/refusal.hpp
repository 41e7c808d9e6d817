/// Message with which a call is refused.
#pragma once

#include <string>
#include <string_view>

namespace monograin {

/// The message of the exception that a call throws; empty if it throws none, or another.
template <class Exception, class Call>
[[nodiscard]] std::string refusal(const Call& call) {
  try {
    static_cast<void>(call());
  } catch (const Exception& exception) {
    return exception.what();
  }
  return {};
}

[[nodiscard]] inline bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

}  // namespace monograin
