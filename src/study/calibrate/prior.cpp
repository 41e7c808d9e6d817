#include "study/calibrate/prior.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>

namespace monograin {

double Prior::deviation(double value) const noexcept {
  switch (kind) {
    case Kind::normal:
      return (value - first) / second;
    case Kind::lognormal:
      return std::log(value / first) / second;
    case Kind::uniform:
      return 0.0;
  }
  return 0.0;
}

double Prior::slope(double value) const noexcept {
  switch (kind) {
    case Kind::normal:
      return 1.0 / second;
    case Kind::lognormal:
      return 1.0 / (second * value);
    case Kind::uniform:
      return 0.0;
  }
  return 0.0;
}

std::string_view word_of(Prior::Kind kind) noexcept {
  constexpr std::array<std::string_view, 3> k_words{"normal", "lognormal", "uniform"};
  return k_words[static_cast<std::size_t>(kind)];
}

std::string describe(const Prior& prior, const std::string& unit, double unit_factor) {
  const std::string end = unit.empty() ? "" : " " + unit;
  const double first = prior.first / unit_factor;
  switch (prior.kind) {
    case Prior::Kind::normal:
      return fmt::format("normal {:.6g} +- {:.6g}{}", first, prior.second / unit_factor, end);
    case Prior::Kind::lognormal:
      return fmt::format("lognormal {:.6g}{}, sigma of log {:.6g}", first, end, prior.second);
    case Prior::Kind::uniform:
      return fmt::format("uniform {:.6g} ... {:.6g}{}", first, prior.second / unit_factor, end);
  }
  return {};
}

}  // namespace monograin
