#include "numerics/search_box.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace monograin {
namespace {

constexpr double k_near_bound = 1e-4;  // distance from a bound, over the range

double parameter_at(const BoundedParameter& bounds, double share) {
  if (!bounds.is_logarithmic) return std::lerp(bounds.lower, bounds.upper, share);
  const double parameter = std::exp(std::lerp(std::log(bounds.lower), std::log(bounds.upper), share));
  return std::clamp(parameter, bounds.lower, bounds.upper);
}

double share_of(const BoundedParameter& bounds, double parameter) {
  if (!bounds.is_logarithmic) return (parameter - bounds.lower) / (bounds.upper - bounds.lower);
  return std::log(parameter / bounds.lower) / std::log(bounds.upper / bounds.lower);
}

double share_at(double z) noexcept { return std::sin(z) * std::sin(z); }

double z_at(double share) { return std::asin(std::sqrt(share)); }

}  // namespace

double folded(double z) { return z >= 0.0 && z <= k_end_of_z ? z : z_at(std::clamp(share_at(z), 0.0, 1.0)); }

bool is_near(std::span<const double> a, std::span<const double> b, double distance) {
  return std::ranges::equal(a, b, [distance](double x, double y) { return std::abs(x - y) < distance; });
}

SearchBox::SearchBox(const LeastSquaresProblem& problem) : problem_(problem), residuals_(problem.residual_count) {}

std::vector<double> SearchBox::parameters_at(const Place& place) const {
  std::vector<double> parameters(size());
  for (std::size_t k = 0; k < size(); ++k) parameters[k] = parameter_at(problem_.parameters[k], share(place, k));
  return parameters;
}

double SearchBox::share(const Place& place, std::size_t k) const noexcept { return share_at(place.z[k]); }

bool SearchBox::is_near_bound(const Place& place, std::size_t k) const noexcept {
  return share(place, k) <= k_near_bound || share(place, k) >= 1.0 - k_near_bound;
}

double SearchBox::z_of(std::size_t k, double parameter) const {
  return z_at(std::clamp(share_of(problem_.parameters[k], parameter), k_near_bound, 1.0 - k_near_bound));
}

bool SearchBox::evaluate(const Place& place, std::span<double> values) {
  std::vector<double> parameters = parameters_at(place);
  if (parameters == last_parameters_) {
    std::ranges::copy(last_values_, values.begin());
    return true;
  }
  ++evaluations_;
  if (!problem_.residuals(parameters, values)) {
    ++failures_;
    return false;
  }
  if (problem_.loss.kind != Loss::linear) {
    for (double& r : values.first(values.size() - problem_.plain_count)) {
      r = std::copysign(std::sqrt(problem_.loss.rho(r)), r);
    }
  }
  last_parameters_ = std::move(parameters);
  last_values_.assign(values.begin(), values.end());
  return true;
}

double SearchBox::cost_at(const Place& place) {
  if (!evaluate(place, residuals_)) return k_no_cost;
  const double cost = std::inner_product(residuals_.begin(), residuals_.end(), residuals_.begin(), 0.0);
  worst_cost_ = std::max(worst_cost_, cost);
  return cost;
}

Eigen::MatrixXd SearchBox::derivatives(const Place& place, std::span<const double> values, bool is_central) {
  // Truncation (h, or h^2 for central differences) and round-off (noise/h) are similar at this step h.
  const double step = is_central ? std::cbrt(problem_.noise) : std::sqrt(problem_.noise);
  const auto count = static_cast<Eigen::Index>(values.size());
  const Eigen::Map<const Eigen::VectorXd> present(values.data(), count);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(count, static_cast<Eigen::Index>(size()));
  Eigen::VectorXd above(count);
  Eigen::VectorXd below(count);
  Place trial = place;
  for (std::size_t k = 0; k < size(); ++k) {
    const double middle = place.z[k];
    // Evaluates the residuals with another z; goes back to the middle if there are none.
    const auto move = [&](double& z, Eigen::VectorXd& moved) {
      trial.z[k] = z;
      if (z != middle && evaluate(trial, {moved.data(), values.size()})) return;
      z = middle;
      moved = present;
    };
    double right = middle + step;
    move(right, above);
    double left = is_central || right == middle ? middle - step : middle;
    move(left, below);
    trial.z[k] = middle;
    if (right > left) jacobian.col(static_cast<Eigen::Index>(k)) = (above - below) / (right - left);
  }
  return jacobian;
}

std::vector<double> SearchBox::residuals_at(std::span<const double> parameters) {
  if (problem_.loss.kind == Loss::linear && std::ranges::equal(parameters, last_parameters_)) return last_values_;
  std::vector<double> residuals(problem_.residual_count);
  problem_.residuals(parameters, residuals);
  ++evaluations_;
  return residuals;
}

void SearchBox::count(long evaluations, long failures) noexcept {
  evaluations_ += evaluations;
  failures_ += failures;
}

}  // namespace monograin
