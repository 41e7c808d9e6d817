/// The border to solvers written in C: ownership of their objects, and exceptions in their callbacks.
#pragma once

#include <exception>
#include <memory>
#include <optional>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "system/limit.hpp"

namespace monograin {

template <auto Free>
struct HandleDeleter {
  template <class T>
  void operator()(T* handle) const noexcept {
    Free(handle);
  }
};
template <class H, auto Free>
using Handle = std::unique_ptr<std::remove_pointer_t<H>, HandleDeleter<Free>>;

/// Keeps exceptions from crossing C. A domain error in a callback asks the solver for a smaller step; any other
/// exception is kept and rethrown once the solver has returned.
class Pending {
 public:
  /// Runs a callback. @return 0 if it succeeded, 1 if a smaller step may succeed, -1 if the solver has to give up
  template <class Function>
  int guard(Function&& function) noexcept {
    try {
      return function() ? 0 : 1;
    } catch (const std::domain_error& error) {
      domain_end_ = as_domain_error(error);
      return 1;
    } catch (...) {
      exception_ = std::current_exception();
      return -1;
    }
  }

  /// Evaluates, within guard(), a state beside a trial state, as difference quotients do. If the equations end there,
  /// this explains a failed step, but it does not make a successful step fail.
  template <class Function>
  void beside(Function&& function) {
    try {
      function();
    } catch (const std::domain_error& error) {
      end_beside_ = as_domain_error(error);
      throw;
    }
  }

  void forget() noexcept {
    exception_ = nullptr;
    domain_end_.reset();
    end_beside_.reset();
  }
  void rethrow() {
    if (exception_) std::rethrow_exception(std::exchange(exception_, nullptr));
  }
  /// Why the equations ended at some trial since the last forget(); none if they did not.
  [[nodiscard]] const std::optional<DomainError>& domain_end() const noexcept { return domain_end_; }
  /// Why the equations ended at a trial or, if they did at none, at a state beside a trial.
  [[nodiscard]] const std::optional<DomainError>& nearest_domain_end() const noexcept {
    return domain_end_ ? domain_end_ : end_beside_;
  }

 private:
  std::exception_ptr exception_;
  std::optional<DomainError> domain_end_, end_beside_;
};

}  // namespace monograin
