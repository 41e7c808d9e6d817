/// Texts of scenarios from which several tests start.
#pragma once

#include <gtest/gtest.h>

#include <string>

namespace monograin {

inline constexpr const char* k_hertz_text = R"(model = "hertz"
[particle]
radius = "10 mm"
[material]
youngs_modulus = "50 GPa"
poisson_ratio = 0.22
[loading]
configuration = "simple"
[[loading.steps]]
displacement = "0.01 R0"
duration = "1 s"
)";

/// A free set of two walls, of which one makes contact later.
inline constexpr const char* k_late_wall_text = R"(model = "hertz"
[particle]
radius = "10 mm"
[material]
youngs_modulus = "50 GPa"
poisson_ratio = 0.22
[loading]
configuration = "walls"
steps = [{ displacement = "0.01 R0", duration = "1 s" }]
[[loading.wall]]
name = "top"
normal = [0, 0, 1]
[[loading.wall]]
name = "late"
normal = [1, 0, 0]
gap = "0.002 R0"
)";

/// A text in which a part, which has to be there, is replaced.
[[nodiscard]] inline std::string replaced(std::string text, const std::string& old, const std::string& by) {
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return at == std::string::npos ? text : text.replace(at, old.size(), by);
}

}  // namespace monograin
