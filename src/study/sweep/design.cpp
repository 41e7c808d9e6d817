#include "study/sweep/design.hpp"

#include <fmt/format.h>
#include <libalglib/dataanalysis.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "numerics/parallel.hpp"
#include "stress_test/dice.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

constexpr std::size_t k_candidates_per_run = 25;
constexpr std::size_t k_least_candidates = 1500;
// Largest number of points to cluster at once, which takes its square in time and memory; larger sets are cut first.
constexpr std::size_t k_most_clustered_at_once = 1500;
constexpr std::size_t k_most_draws_per_candidate = 1000;
constexpr int k_most_enlargements = 8;

using Members = std::vector<std::size_t>;  ///< indices of candidates

void shuffle(std::vector<std::size_t>& values, Dice& dice) {
  for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[dice.below(i)]);
}

[[nodiscard]] std::vector<double> draw_candidates(const DesignSpace& space, std::size_t count, Dice& dice) {
  std::vector<double> candidates;
  candidates.reserve(count * space.factors);
  std::vector<double> point(space.factors);
  std::size_t draws = 0;
  while (candidates.size() < count * space.factors) {
    if (++draws > k_most_draws_per_candidate * count) {
      throw std::domain_error(fmt::format("less than {:g} of the space is allowed", 1.0 / k_most_draws_per_candidate));
    }
    for (double& coordinate : point) coordinate = dice.uniform(0.0, 1.0);
    if (!space.contains || space.contains(point)) candidates.insert(candidates.end(), point.begin(), point.end());
  }
  return candidates;
}

/// Candidates in the cube, and their clusters.
class Candidates {
 public:
  Candidates(std::vector<double> coordinates, std::size_t factors)
      : coordinates_(std::move(coordinates)), factors_(factors) {}

  [[nodiscard]] std::span<const double> point(std::size_t index) const {
    return std::span(coordinates_).subspan(index * factors_, factors_);
  }
  [[nodiscard]] std::size_t size() const noexcept { return coordinates_.size() / factors_; }

  /// Divides all candidates into `count` clusters. Large sets are first cut across their widest side into parts, which
  /// get clusters in proportion; within a part the clustering is Ward's.
  [[nodiscard]] std::vector<Members> clusters(std::size_t count) const {
    Members all(size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    std::vector<Part> parts;
    cut(std::move(all), count, parts);
    std::vector<std::vector<Members>> clusters(parts.size());
    for_each_index(parts.size(), thread_count(0),
                   [&](std::size_t i, std::size_t) { clusters[i] = ward(parts[i].members, parts[i].cluster_count); });
    std::vector<Members> result;
    for (std::vector<Members>& part : clusters) std::ranges::move(part, std::back_inserter(result));
    return result;
  }

  /// Ward's clusters of some candidates: `count` of them, or as many as there are candidates.
  [[nodiscard]] std::vector<Members> ward(const Members& members, std::size_t count) const {
    count = std::min(count, members.size());
    if (count == 1) return {members};
    std::vector<Members> clusters(count);
    alglib::real_2d_array points;
    points.setlength(static_cast<alglib::ae_int_t>(members.size()), static_cast<alglib::ae_int_t>(factors_));
    for (std::size_t i = 0; i < members.size(); ++i) {
      std::ranges::copy(point(members[i]), points[static_cast<alglib::ae_int_t>(i)]);
    }
    constexpr alglib::ae_int_t k_euclidean = 2;
    constexpr alglib::ae_int_t k_ward = 4;
    alglib::clusterizerstate state;
    alglib::ahcreport report;
    alglib::integer_1d_array cluster_of;
    alglib::integer_1d_array ignored;
    alglib::clusterizercreate(state);
    alglib::clusterizersetpoints(state, points, k_euclidean);
    alglib::clusterizersetahcalgo(state, k_ward);
    alglib::clusterizerrunahc(state, report);
    alglib::clusterizergetkclusters(report, static_cast<alglib::ae_int_t>(count), cluster_of, ignored);
    for (std::size_t i = 0; i < members.size(); ++i) {
      clusters[static_cast<std::size_t>(cluster_of[static_cast<alglib::ae_int_t>(i)])].push_back(members[i]);
    }
    return clusters;
  }

  /// The candidate of a cluster that is nearest to the cluster's mean.
  [[nodiscard]] std::size_t central(const Members& members) const {
    std::vector<double> mean(factors_);
    for (const std::size_t member : members) {
      for (std::size_t l = 0; l < factors_; ++l) {
        mean[l] += point(member)[l] / static_cast<double>(members.size());
      }
    }
    return *std::ranges::min_element(members, {}, [&](std::size_t member) {
      double square = 0.0;
      for (std::size_t l = 0; l < factors_; ++l) square += std::pow(point(member)[l] - mean[l], 2);
      return square;
    });
  }

 private:
  struct Part {
    Members members;
    std::size_t cluster_count;
  };

  void cut(Members members, std::size_t cluster_count, std::vector<Part>& parts) const {
    if (members.size() <= k_most_clustered_at_once || cluster_count == 1) {
      parts.push_back({std::move(members), cluster_count});
      return;
    }
    const std::size_t axis = widest_axis(members);
    const std::size_t first_count = cluster_count / 2;
    const auto middle = members.begin() + static_cast<std::ptrdiff_t>(members.size() * first_count / cluster_count);
    std::ranges::nth_element(members, middle, {}, [&](std::size_t member) { return point(member)[axis]; });
    cut(Members(members.begin(), middle), first_count, parts);
    cut(Members(middle, members.end()), cluster_count - first_count, parts);
  }

  [[nodiscard]] std::size_t widest_axis(const Members& members) const {
    std::size_t widest = 0;
    double largest = -1.0;
    for (std::size_t l = 0; l < factors_; ++l) {
      const auto [least, most] = std::ranges::minmax(members, {}, [&](std::size_t member) { return point(member)[l]; });
      const double width = point(most)[l] - point(least)[l];
      if (width > largest) {
        largest = width;
        widest = l;
      }
    }
    return widest;
  }

  std::vector<double> coordinates_;
  std::size_t factors_;
};

/// Points of a design that is being improved, ordered by their levels, with the contribution of each to the criterion.
class Arrangement {
 public:
  Arrangement(std::size_t points, std::size_t factors, std::size_t level_count)
      : points_(static_cast<Eigen::Index>(points), static_cast<Eigen::Index>(factors)),
        level_count_(static_cast<Eigen::Index>(level_count)),
        per_level_(points_.rows() / level_count_) {}

  void set(std::size_t place, std::span<const double> point) {
    points_.row(static_cast<Eigen::Index>(place)) =
        Eigen::Map<const Eigen::ArrayXd>(point.data(), static_cast<Eigen::Index>(point.size())).transpose();
  }

  /// Contribution of a point x at an index to the criterion: sum over all other points j of 1 / [ prod_l (x_l - x_jl)^2
  /// (I(v != v_j) + 1/k)^2 ], where v is the level of that index; infinite as soon as it is above `bound`.
  [[nodiscard]] double crowding(std::size_t place, std::span<const double> x, double bound) const {
    const auto own = static_cast<Eigen::Index>(place);
    const double same = static_cast<double>(level_count_ * level_count_);
    const double other = 1.0 / std::pow(1.0 + 1.0 / static_cast<double>(level_count_), 2);
    double sum = 0.0;
    for (Eigen::Index level = 0; level < level_count_; ++level) {
      const Eigen::Index begin = level * per_level_;
      const Eigen::Index end = begin + per_level_;
      const bool is_own = own >= begin && own < end;
      const double weight = is_own ? same : other;
      sum = add(x, begin, is_own ? own : end, weight, bound, sum);
      if (is_own) sum = add(x, own + 1, end, weight, bound, sum);
    }
    return sum;
  }

 private:
  static constexpr Eigen::Index k_block = 256;

  [[nodiscard]] double add(std::span<const double> x, Eigen::Index begin, Eigen::Index end, double weight, double bound,
                           double sum) const {
    Eigen::Array<double, Eigen::Dynamic, 1, 0, k_block, 1> product;
    for (; begin < end && sum <= bound; begin += k_block) {
      const Eigen::Index size = std::min(k_block, end - begin);
      product = points_.col(0).segment(begin, size) - x[0];
      for (Eigen::Index l = 1; l < points_.cols(); ++l) {
        product *= points_.col(l).segment(begin, size) - x[static_cast<std::size_t>(l)];
      }
      sum += weight * product.square().inverse().sum();
    }
    return sum <= bound ? sum : k_infinity;
  }

  Eigen::ArrayXXd points_;
  Eigen::Index level_count_;
  Eigen::Index per_level_;
};

/// Sub-clusters from which the points are taken, one for each index of the arrangement: those of the first level, then
/// those of the second, and so on.
[[nodiscard]] std::vector<Members> allotted_clusters(const std::vector<std::vector<Members>>& sub_clusters,
                                                     std::size_t level_count, Dice& dice) {
  const std::size_t primary_count = sub_clusters.size();
  std::vector<Members> allotted(primary_count * level_count);
  std::vector<std::size_t> levels(level_count);
  std::iota(levels.begin(), levels.end(), std::size_t{0});
  for (std::size_t c = 0; c < primary_count; ++c) {
    shuffle(levels, dice);
    for (std::size_t s = 0; s < level_count; ++s) allotted[levels[s] * primary_count + c] = sub_clusters[c][s];
  }
  return allotted;
}

/// Replaces each point by the best candidate of its own cluster, until no candidate is better. Every replacement lowers
/// the criterion, so that this ends.
[[nodiscard]] std::vector<std::size_t> improved(const Candidates& candidates, const std::vector<Members>& clusters,
                                                std::size_t factors, std::size_t level_count) {
  Arrangement arrangement(clusters.size(), factors, level_count);
  std::vector<std::size_t> chosen(clusters.size());
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    chosen[i] = candidates.central(clusters[i]);
    arrangement.set(i, candidates.point(chosen[i]));
  }
  for (bool has_changed = true; has_changed;) {
    has_changed = false;
    for (std::size_t i = 0; i < clusters.size(); ++i) {
      double least = arrangement.crowding(i, candidates.point(chosen[i]), k_infinity);
      for (const std::size_t candidate : clusters[i]) {
        const double crowding = arrangement.crowding(i, candidates.point(candidate), least);
        if (!(crowding < least)) continue;
        least = crowding;
        chosen[i] = candidate;
        has_changed = true;
      }
      arrangement.set(i, candidates.point(chosen[i]));
    }
  }
  return chosen;
}

}  // namespace

double maxpro_criterion(const Design& design) {
  const std::size_t n = design.size();
  const auto k = static_cast<double>(design.level_count);
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      double product = 1.0;
      for (std::size_t l = 0; l < design.factors; ++l) product *= design.point(i)[l] - design.point(j)[l];
      if (design.level_count > 0) product *= (design.levels[i] != design.levels[j] ? 1.0 : 0.0) + 1.0 / k;
      sum += 1.0 / (product * product);
    }
  }
  const double pairs = 0.5 * static_cast<double>(n) * (static_cast<double>(n) - 1.0);
  return std::pow(sum / pairs, 1.0 / static_cast<double>(design.factors + (design.level_count > 0 ? 1 : 0)));
}

Design maxpro_design(const DesignSpace& space, std::size_t runs, std::uint64_t seed) {
  const std::size_t levels = std::max<std::size_t>(space.level_count, 1);
  if (space.factors == 0) throw std::invalid_argument("a space without continuous factors cannot be filled");
  if (runs == 0 || runs % levels != 0) {
    throw std::invalid_argument(fmt::format("{} runs are no multiple of the {} levels", runs, levels));
  }
  Dice dice(seed);
  std::size_t count = std::max(k_candidates_per_run * runs, k_least_candidates);
  for (int enlargement = 0;; ++enlargement, count *= 2) {
    const Candidates candidates(draw_candidates(space, count, dice), space.factors);
    std::vector<std::vector<Members>> sub_clusters;
    for (const Members& cluster : candidates.clusters(runs / levels)) {
      sub_clusters.push_back(candidates.ward(cluster, levels));
    }
    // A cluster with fewer points than levels shows that there are too few candidates.
    const auto is_short = [&](const std::vector<Members>& clusters) { return clusters.size() < levels; };
    if (std::ranges::any_of(sub_clusters, is_short)) {
      if (enlargement < k_most_enlargements) continue;
      throw std::domain_error(fmt::format("no clusters of at least {} points found", levels));
    }
    const std::vector<Members> clusters = allotted_clusters(sub_clusters, levels, dice);
    Design design{.factors = space.factors, .level_count = space.level_count};
    const std::vector<std::size_t> chosen = improved(candidates, clusters, space.factors, levels);
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      std::ranges::copy(candidates.point(chosen[i]), std::back_inserter(design.coordinates));
      if (space.level_count > 0) design.levels.push_back(i / (runs / levels));
    }
    return design;
  }
}

}  // namespace monograin
