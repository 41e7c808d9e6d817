#include "study/sweep/sampling.hpp"

#include <gsl/gsl_qrng.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <random>
#include <vector>

#include "system/resolution.hpp"

namespace monograin {
namespace {

constexpr std::size_t k_morris_levels = 4;

/// Random numbers of a seed, equal with every standard library.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : generator_(seed) {}

  /// A number in the open interval from 0 to 1.
  [[nodiscard]] double share() {
    constexpr int k_digits = std::numeric_limits<double>::digits - 1;
    return std::ldexp(static_cast<double>(generator_() >> (64 - k_digits)) + 0.5, -k_digits);
  }
  /// An integer below a small number.
  [[nodiscard]] std::size_t below(std::size_t count) {
    return static_cast<std::size_t>(share() * static_cast<double>(count));
  }
  void shuffle(std::vector<std::size_t>& places) {
    for (std::size_t left = places.size(); left > 1; --left) std::swap(places[left - 1], places[below(left)]);
  }

 private:
  std::mt19937_64 generator_;
};

/// Moves a share inside the open interval, where every distribution has a value.
[[nodiscard]] double inside(double share) { return std::clamp(share, k_epsilon, 1.0 - k_epsilon); }

[[nodiscard]] Design sequence(const gsl_qrng_type* type, std::size_t factors, std::size_t runs, Draw& draw) {
  const std::unique_ptr<gsl_qrng, decltype(&gsl_qrng_free)> generator(
      gsl_qrng_alloc(type, static_cast<unsigned>(factors)), gsl_qrng_free);
  std::vector<double> move(factors);
  std::ranges::generate(move, [&] { return draw.share(); });
  Design design{.factors = factors, .level_count = 0, .coordinates = std::vector<double>(factors * runs)};
  for (std::size_t run = 0; run < runs; ++run) {
    const std::span<double> point = std::span(design.coordinates).subspan(run * factors, factors);
    gsl_qrng_get(generator.get(), point.data());
    for (std::size_t k = 0; k < factors; ++k) point[k] = inside(std::fmod(point[k] + move[k], 1.0));
  }
  return design;
}

}  // namespace

Design sampled_design(std::string_view name, std::size_t factors, std::size_t runs, std::uint64_t seed) {
  Draw draw(seed);
  if (name == "sobol") return sequence(gsl_qrng_sobol, factors, runs, draw);
  if (name == "halton") return sequence(gsl_qrng_halton, factors, runs, draw);
  Design design{.factors = factors, .level_count = 0, .coordinates = std::vector<double>(factors * runs)};
  if (name == "random") {
    std::ranges::generate(design.coordinates, [&] { return draw.share(); });
    return design;
  }
  std::vector<std::size_t> slices(runs);
  for (std::size_t k = 0; k < factors; ++k) {
    std::iota(slices.begin(), slices.end(), std::size_t{0});
    draw.shuffle(slices);
    for (std::size_t run = 0; run < runs; ++run) {
      design.coordinates[run * factors + k] =
          inside((static_cast<double>(slices[run]) + draw.share()) / static_cast<double>(runs));
    }
  }
  return design;
}

Design saltelli_design(std::size_t factors, std::size_t samples, std::uint64_t seed) {
  Draw draw(seed);
  const Design pairs = sequence(gsl_qrng_sobol, 2 * factors, samples, draw);
  Design design{.factors = factors, .level_count = 0};
  design.coordinates.reserve(samples * factors * (factors + 2));
  for (std::size_t sample = 0; sample < samples; ++sample) {
    const std::span<const double> a = pairs.point(sample).first(factors);
    const std::span<const double> b = pairs.point(sample).last(factors);
    design.coordinates.insert(design.coordinates.end(), a.begin(), a.end());
    design.coordinates.insert(design.coordinates.end(), b.begin(), b.end());
    for (std::size_t changed = 0; changed < factors; ++changed) {
      for (std::size_t k = 0; k < factors; ++k) design.coordinates.push_back(k == changed ? b[k] : a[k]);
    }
  }
  return design;
}

Design morris_design(std::size_t factors, std::size_t trajectories, std::uint64_t seed) {
  Draw draw(seed);
  constexpr std::size_t k_step = k_morris_levels / 2;
  Design design{.factors = factors, .level_count = 0};
  std::vector<std::size_t> order(factors);
  std::vector<std::size_t> levels(factors);
  for (std::size_t trajectory = 0; trajectory < trajectories; ++trajectory) {
    std::ranges::generate(levels, [&] { return draw.below(k_morris_levels); });
    std::iota(order.begin(), order.end(), std::size_t{0});
    draw.shuffle(order);
    for (std::size_t point = 0; point <= factors; ++point) {
      if (point > 0) {
        std::size_t& level = levels[order[point - 1]];
        level = level < k_step ? level + k_step : level - k_step;
      }
      for (const std::size_t level : levels) {
        design.coordinates.push_back((static_cast<double>(level) + 0.5) / static_cast<double>(k_morris_levels));
      }
    }
  }
  return design;
}

}  // namespace monograin
