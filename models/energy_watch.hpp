/// Whether a law gives back more energy than was put in.
#pragma once

#include <algorithm>
#include <optional>
#include <string_view>

#include "hybrid_system.hpp"

namespace monograin {

/// Watches the least dissipation, work less recoverable energy.
class EnergyWatch {
 public:
  void see(double work, double stored) noexcept {
    largest_work_ = std::max(largest_work_, work);
    lowest_dissipation_ = std::min(lowest_dissipation_, work - stored);
  }
  /// What to tell, where more than rounding and small corrections of a law come back.
  [[nodiscard]] std::optional<Finding> finding(std::string_view message) const {
    if (lowest_dissipation_ >= -1e-6 * largest_work_) return std::nullopt;
    return Finding{message, "lowest dissipation over work", lowest_dissipation_ / largest_work_};
  }

 private:
  double largest_work_ = 0.0;
  double lowest_dissipation_ = 0.0;
};

}  // namespace monograin
