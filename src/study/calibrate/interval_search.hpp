/// Errors and intervals of the parameters of a fit.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "study/calibrate/calibration.hpp"

namespace monograin {

/// The least-squares problem of a calibration, whose first residuals are those of its data.
struct DataFit {
  const Calibration& calibration;
  const LeastSquaresProblem& problem;
  std::span<const std::size_t> rows;  ///< rows that count, in the order of their residuals
  std::span<const double> weights;    ///< of all rows

  /// Sum of rho over the residuals of the data, without priors and shared errors.
  [[nodiscard]] double cost(const LeastSquaresSolution& solution) const;
  /// True if the residuals of the data are round-off.
  [[nodiscard]] bool is_exact(const LeastSquaresSolution& solution) const;
};

/// Derivatives with respect to the parameters, which are the columns.
struct FitDerivatives {
  Eigen::MatrixXd response;   ///< of the response in all rows, including those that do not count
  Eigen::MatrixXd residuals;  ///< of the weighted residuals
};

/// Search for the intervals of a fit, by the method that its calibration names, or by the one that suits the sum of
/// squares near the minimum.
class IntervalSearch {
 public:
  using Derivatives = std::function<FitDerivatives(std::span<const double> parameters)>;

  /// @param fit  what it refers to must outlive the search
  IntervalSearch(const DataFit& fit, Derivatives derivatives) : fit_(fit), derivatives_(std::move(derivatives)) {}

  /// Finds uncertainty and intervals. If the search finds a better fit, continues from there.
  /// @param result  has a solution
  /// @return derivatives of the response in all rows
  [[nodiscard]] Eigen::MatrixXd run(CalibrationResult& result);

  /// Notes for the user.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }

 private:
  [[nodiscard]] std::vector<double> relative_deviations() const;
  std::optional<LocalMinimum> choose_intervals(CalibrationResult& result);
  std::optional<LocalMinimum> choose_method(CalibrationResult& result);
  std::optional<LocalMinimum> by_profile(CalibrationResult& result);
  void by_bootstrap(CalibrationResult& result);
  void note_narrow(const std::string& path, double share);

  DataFit fit_;
  Derivatives derivatives_;
  bool is_kinked_ = false;  ///< the sum of squares has a kink near its minimum
  std::vector<std::string> notes_;
};

}  // namespace monograin
