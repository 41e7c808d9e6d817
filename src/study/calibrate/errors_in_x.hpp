/// Errors in x: how the noise of a measured x adds to the residuals of y.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "study/calibrate/response.hpp"

namespace monograin {

/// Effects of the errors in x on one curve's response, linearised at a fit. An error of a row's own x moves its y along
/// the curve (effective variance: Orear (1982), Am. J. Phys. 50, 912). An error of a turn moves y of all rows after it.
/// Its standard deviation is that of a row's x, or of the mean over a hold.
class ErrorsInX {
 public:
  /// @param calibration  and `curve`, with noise of x, must outlive the errors
  ErrorsInX(const Calibration& calibration, const MeasuredCurve& curve, const DataPath& path);

  /// Sets slopes and curvature biases. @param response  that has run along this path
  void follow(const Response& response);
  /// Sets the effects of turns, after follow(). @param response  that has run with these parameters along this path
  void set_effects_of_turns(std::span<const double> parameters, const Response& response);

  /// dy/dx of the response in every row, on the row's own branch: the secant over a standard deviation of x to both
  /// sides. Zero in a hold, whose rows lie at the turn whatever their own x is.
  [[nodiscard]] std::span<const double> slopes() const noexcept { return slopes_; }
  /// Mean of y over the noise of a row's own x, less y in the row: d2y/dx2 times half the variance of x. Zero in a hold
  /// and at the ends of branches.
  [[nodiscard]] std::span<const double> curvature_biases() const noexcept { return curvature_biases_; }
  /// Change of the response in every row by an error of one standard deviation of each turn; zero for a turn that the
  /// scenario cannot follow if it is moved to either side.
  [[nodiscard]] const Eigen::MatrixXd& effects_of_turns() const noexcept { return of_turns_; }

 private:
  struct UncertainTurn {
    std::size_t point = 0;  ///< of the path
    double error = 0.0;     ///< standard deviation of its x, with the sign of outwards
  };

  /// First point of a branch of the path.
  [[nodiscard]] std::size_t beginning_of(std::size_t branch) const noexcept {
    return branch > 0 ? path_.ends[branch - 1] : 0;
  }
  /// Sets slope and curvature bias of a row.
  void set_slope_and_bias(std::size_t row, std::span<const double> y);
  /// Moves a turn by an error. @return false if the scenario cannot follow
  /// @param measured  y at the points of the path
  [[nodiscard]] bool respond_with(std::span<const double> parameters, std::size_t point, double error,
                                  const std::vector<double>& measured);

  const Calibration& calibration_;
  const MeasuredCurve& curve_;
  DataPath path_;
  double noise_;
  std::vector<std::size_t> branch_of_;  ///< of every row
  std::vector<bool> is_held_;           ///< every row
  std::vector<UncertainTurn> turns_;
  std::vector<double> moved_;  ///< response of every row with a moved turn
  std::vector<double> slopes_;
  std::vector<double> curvature_biases_;
  Eigen::MatrixXd of_turns_;
};

/// Errors that many residuals share, each with a normal distribution: the residuals that their most probable values
/// leave, together with these values over their standard deviations, have the sum of squares
///
///   min over d of |r - G d|^2 + |d|^2 = r^T (1 + G G^T)^-1 r
///
/// so that a least-squares problem has the covariance 1 + G G^T.
class SharedErrors {
 public:
  SharedErrors() = default;
  /// @param effects  G: change of each residual by one standard deviation of each error
  explicit SharedErrors(Eigen::MatrixXd effects);

  [[nodiscard]] Eigen::Index count() const noexcept { return effects_.cols(); }
  /// Logarithm of the determinant of 1 + G G^T.
  [[nodiscard]] double log_determinant() const;
  /// Takes the effects of the most probable errors away. @return these errors, over their standard deviations
  Eigen::VectorXd take_from(Eigen::Ref<Eigen::VectorXd> residuals) const;

 private:
  Eigen::MatrixXd effects_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

}  // namespace monograin
