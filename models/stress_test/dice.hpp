/// Random numbers that are the same with every standard library, which the distributions of <random> are not.
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <random>

namespace monograin {

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}
  /// Sequence of one member of a family: no two members share a sequence.
  Dice(std::uint64_t seed, std::uint64_t member) {
    std::seed_seq both{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U),
                       static_cast<std::uint32_t>(member), static_cast<std::uint32_t>(member >> 32U)};
    engine_.seed(both);
  }

  /// Number in [low, high).
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11U) * 0x1p-53);
  }
  double log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(uniform(0.0, static_cast<double>(count))); }
  bool happens(double probability) { return uniform(0.0, 1.0) < probability; }
  template <class T>
  T one_of(std::initializer_list<T> values) {
    return *(values.begin() + below(values.size()));
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace monograin
