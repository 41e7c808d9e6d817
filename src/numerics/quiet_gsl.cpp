#include "numerics/quiet_gsl.hpp"

#include <gsl/gsl_errno.h>

#include <mutex>

namespace monograin {
namespace {

struct Handler {
  std::mutex mutex;
  int users = 0;
  gsl_error_handler_t* before = nullptr;
};

Handler& handler() {
  static Handler the_one;
  return the_one;
}

}  // namespace

QuietGsl::QuietGsl() {
  Handler& of = handler();
  const std::scoped_lock lock(of.mutex);
  if (of.users++ == 0) of.before = gsl_set_error_handler_off();
}

QuietGsl::~QuietGsl() {
  Handler& of = handler();
  const std::scoped_lock lock(of.mutex);
  if (--of.users == 0) gsl_set_error_handler(of.before);
}

}  // namespace monograin
