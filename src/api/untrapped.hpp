/// Floating-point exceptions in programs that trap them.
#pragma once

#include <cfenv>

namespace monograin {

/// Lets floating-point exceptions pass while it exists, in this thread and those that it starts: equations compare with
/// nan and divide by zero where the result says that something does not exist. Then the environment of the caller
/// is back, its traps and flags included.
class Untrapped {
 public:
  Untrapped() noexcept { std::feholdexcept(&before_); }
  ~Untrapped() { std::fesetenv(&before_); }
  Untrapped(const Untrapped&) = delete;
  Untrapped& operator=(const Untrapped&) = delete;

 private:
  std::fenv_t before_{};
};

}  // namespace monograin
