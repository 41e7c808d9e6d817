#include "study/sweep/indices.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "numerics/quantile.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

constexpr std::size_t k_resamples = 500;

/// Groups of `size` consecutive results without a missing one, joined together.
[[nodiscard]] std::vector<double> whole_groups(std::span<const double> results, std::size_t size) {
  std::vector<double> whole;
  for (std::size_t begin = 0; begin + size <= results.size(); begin += size) {
    const auto group = results.subspan(begin, size);
    if (std::ranges::all_of(group, [](double value) { return std::isfinite(value); })) {
      whole.insert(whole.end(), group.begin(), group.end());
    }
  }
  return whole;
}

/// @param values  of the resamples
[[nodiscard]] Estimate with_interval(double value, std::vector<double>& values, double confidence) {
  std::ranges::sort(values);
  const double tail = 0.5 * (1.0 - confidence);
  return {value, quantile(values, tail), quantile(values, 1.0 - tail)};
}

/// Calls estimate(samples, values) with all samples, then with resamples; the k-th value makes the k-th estimate.
template <class Function>
[[nodiscard]] std::vector<Estimate> bootstrapped(std::size_t samples, std::size_t count, double confidence,
                                                 Function&& estimate) {
  std::vector<Estimate> estimates(count, {k_nan, k_nan, k_nan});
  if (samples == 0) return estimates;
  std::vector<std::size_t> chosen(samples);
  for (std::size_t i = 0; i < samples; ++i) chosen[i] = i;
  std::vector<double> values(count);
  estimate(chosen, values);
  const std::vector<double> whole = values;
  std::vector<std::vector<double>> resampled(count);
  std::mt19937_64 generator(1);
  for (std::size_t resample = 0; resample < k_resamples; ++resample) {
    for (std::size_t& sample : chosen) sample = static_cast<std::size_t>(generator() % samples);
    estimate(chosen, values);
    for (std::size_t k = 0; k < count; ++k) resampled[k].push_back(values[k]);
  }
  for (std::size_t k = 0; k < count; ++k) estimates[k] = with_interval(whole[k], resampled[k], confidence);
  return estimates;
}

}  // namespace

SobolIndices sobol_indices(std::span<const double> results, std::size_t factors, double confidence) {
  const std::size_t size = factors + 2;
  const std::vector<double> whole = whole_groups(results, size);
  SobolIndices indices;
  indices.samples = whole.size() / size;
  const auto estimate = [&](const std::vector<std::size_t>& samples, std::vector<double>& values) {
    double sum = 0.0;
    for (const std::size_t s : samples) sum += whole[s * size] + whole[s * size + 1];
    const auto n = static_cast<double>(samples.size());
    const double mean = sum / (2.0 * n);
    double variance = 0.0;
    std::ranges::fill(values, 0.0);
    for (const std::size_t s : samples) {
      const double a = whole[s * size] - mean;
      const double b = whole[s * size + 1] - mean;
      variance += (a * a + b * b) / (2.0 * n);
      for (std::size_t k = 0; k < factors; ++k) {
        const double changed = whole[s * size + 2 + k] - mean;
        values[k] += b * (changed - a) / n;
        values[factors + k] += (a - changed) * (a - changed) / (2.0 * n);
      }
    }
    const bool varies = variance > k_same_value * k_same_value * mean * mean;
    for (double& value : values) value = varies ? value / variance : k_nan;
  };
  std::vector<Estimate> all = bootstrapped(indices.samples, 2 * factors, confidence, estimate);
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(factors);
  indices.first.assign(all.begin(), middle);
  indices.total.assign(middle, all.end());
  return indices;
}

MorrisEffects morris_effects(const Design& design, std::span<const double> results, double confidence) {
  const std::size_t factors = design.factors;
  const std::size_t size = factors + 1;
  std::vector<double> effects;  // trajectory by trajectory, in the order of the factors
  for (std::size_t begin = 0; begin + size <= results.size(); begin += size) {
    std::vector<double> own(factors, k_nan);
    for (std::size_t point = begin; point + 1 < begin + size; ++point) {
      for (std::size_t k = 0; k < factors; ++k) {
        const double change = design.point(point + 1)[k] - design.point(point)[k];
        if (change != 0.0) own[k] = (results[point + 1] - results[point]) / change;
      }
    }
    effects.insert(effects.end(), own.begin(), own.end());
  }
  effects = whole_groups(effects, factors);
  MorrisEffects found;
  found.samples = effects.size() / factors;
  found.mean_size = bootstrapped(found.samples, factors, confidence,
                                 [&](const std::vector<std::size_t>& samples, std::vector<double>& values) {
                                   std::ranges::fill(values, 0.0);
                                   for (const std::size_t s : samples) {
                                     for (std::size_t k = 0; k < factors; ++k) {
                                       values[k] += std::abs(effects[s * factors + k]);
                                     }
                                   }
                                   for (double& value : values) value /= static_cast<double>(samples.size());
                                 });
  const auto n = static_cast<double>(found.samples);
  for (std::size_t k = 0; k < factors; ++k) {
    double mean = 0.0;
    for (std::size_t s = 0; s < found.samples; ++s) mean += effects[s * factors + k] / n;
    double squares = 0.0;
    for (std::size_t s = 0; s < found.samples; ++s) squares += std::pow(effects[s * factors + k] - mean, 2);
    found.mean.push_back(found.samples > 0 ? mean : k_nan);
    found.spread.push_back(found.samples > 1 ? std::sqrt(squares / (n - 1.0)) : k_nan);
  }
  return found;
}

}  // namespace monograin
