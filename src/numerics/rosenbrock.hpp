/// Boost.Odeint's linearly implicit method of order 4, behind an interface without its matrices. These are of
/// Boost.uBLAS, which is not C++20: the source file is compiled as C++17.
#pragma once

#include <cstddef>
#include <memory>

namespace monograin {

class Rosenbrock4 {
 public:
  /// The equations that are integrated. Both functions may throw; the step is then not taken.
  struct Equations {
    std::size_t size = 0;
    void (*rates)(void* self, double xi, const double* z, double* dz) = nullptr;
    void (*jacobian)(void* self, double xi, const double* z, double* by_z, double* by_xi) = nullptr;  ///< row by row
    void* self = nullptr;
  };

  /// @param round_off  round-off of xi; errors up to it times the rates are tolerated
  Rosenbrock4(const Equations& equations, double atol, double rtol, double round_off);
  ~Rosenbrock4();
  Rosenbrock4(const Rosenbrock4&) = delete;
  Rosenbrock4& operator=(const Rosenbrock4&) = delete;

  /// Sets the state from which the next step begins.
  void begin(const double* z);
  /// Begins the next step at the end of the last one.
  void begin_step();
  /// Tries a step.
  /// @param xi    in: the step's beginning; out: its end, if the step is accepted
  /// @param step  in: length to try; out: length to try next
  /// @return true if the step is accepted
  [[nodiscard]] bool try_step(double& xi, double& step);
  [[nodiscard]] const double* begin_state() const noexcept;
  [[nodiscard]] const double* end_state() const noexcept;
  /// State at xi within the last step, computed by a shorter step: the method's own interpolation is some orders less
  /// accurate. Valid until the next call.
  /// @param begin  where the last step begins
  [[nodiscard]] const double* state_at(double xi, double begin);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace monograin
