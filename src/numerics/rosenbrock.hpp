/// Boost.Odeint's linearly implicit method of order 4 behind an interface without its matrices: Boost.uBLAS, which it
/// brings along, is not C++20, so that its source file is compiled as C++17.
#pragma once

#include <cstddef>
#include <memory>

namespace monograin {

class Rosenbrock4 {
 public:
  /// What is integrated. Both functions may throw; the step is then not taken.
  struct Equations {
    std::size_t size = 0;
    void (*rates)(void* self, double xi, const double* z, double* dz) = nullptr;
    void (*jacobian)(void* self, double xi, const double* z, double* by_z, double* by_xi) = nullptr;  ///< row by row
    void* self = nullptr;
  };

  /// @param rounding  of xi
  Rosenbrock4(const Equations& equations, double atol, double rtol, double rounding);
  ~Rosenbrock4();
  Rosenbrock4(const Rosenbrock4&) = delete;
  Rosenbrock4& operator=(const Rosenbrock4&) = delete;

  /// Takes up a state.
  void begin(const double* z);
  /// The end of the last step is the beginning of the next one.
  void begin_step();
  /// @param xi    in: the step's beginning; out, where it is accepted: its end
  /// @param step  in: to be tried; out: to be tried next
  /// @return whether the step is accepted
  [[nodiscard]] bool try_step(double& xi, double& step);
  [[nodiscard]] const double* begin_state() const noexcept;
  [[nodiscard]] const double* end_state() const noexcept;
  /// Within the last step, by a shorter one: the method's own interpolation is some orders less exact. Valid until the
  /// next call.
  /// @param is_known  the derivatives at the step's beginning are those that were asked for last
  [[nodiscard]] const double* state_at(double xi, double begin, bool is_known);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace monograin
