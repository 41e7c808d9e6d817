/// The error handler of GSL.
#pragma once

namespace monograin {

/// Keeps GSL from ending the process at an error. The process has one handler: the first of several objects, in
/// whatever threads, turns it off, and the last one gives it back.
class QuietGsl {
 public:
  QuietGsl();
  ~QuietGsl();
  QuietGsl(const QuietGsl&) = delete;
  QuietGsl& operator=(const QuietGsl&) = delete;
};

}  // namespace monograin
