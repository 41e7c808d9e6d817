/// The border to solvers written in C: who owns their objects, and what becomes of exceptions in their callbacks.
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

/// What callbacks do with exceptions: a domain error asks for a smaller step, anything else is kept and
/// rethrown once the solver has returned, because exceptions must not cross C.
class Pending {
 public:
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

  /// Within guard(): a state beside a trial's, as difference quotients take them. That the equations end there says
  /// why a step has failed, but does not stand in the way of one that has not.
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
  /// Why they ended at a trial or, failing that, at a state beside one.
  [[nodiscard]] const std::optional<DomainError>& nearest_domain_end() const noexcept {
    return domain_end_ ? domain_end_ : end_beside_;
  }

 private:
  std::exception_ptr exception_;
  std::optional<DomainError> domain_end_, end_beside_;
};

}  // namespace monograin
