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
  /// @param curve  with noise of x
  ErrorsInX(const Calibration& calibration, const MeasuredCurve& curve, const DataPath& path);

  /// Linearises the response. @param response  that has run with these parameters along this path
  void linearise(std::span<const double> parameters, const Response& response);

  /// dy/dx of the response in every row, on the row's own branch: the secant over a standard deviation of x to both
  /// sides. Zero in a hold, whose rows lie at the turn whatever their own x is.
  [[nodiscard]] std::span<const double> slopes() const noexcept { return slopes_; }
  /// Change of the response in every row by an error of one standard deviation of each turn.
  [[nodiscard]] const Eigen::MatrixXd& of_turns() const noexcept { return of_turns_; }

 private:
  struct MovedTurn {
    double error = 0.0;  ///< standard deviation of its x, with the sign of outwards
    Response response;   ///< along the path with the turn moved by that
  };

  [[nodiscard]] double slope_at(std::size_t point, std::size_t branch, std::span<const double> y) const;

  DataPath path_;
  double noise_;
  std::vector<std::size_t> branch_of_;  ///< of every row
  std::vector<bool> is_held_;           ///< every row
  std::vector<MovedTurn> turns_;
  std::vector<double> moved_;  ///< response of every row with a moved turn
  std::vector<double> slopes_;
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
  /// Takes the effects of the most probable errors away. @return these errors, over their standard deviations
  Eigen::VectorXd take_from(Eigen::Ref<Eigen::VectorXd> residuals) const;

 private:
  Eigen::MatrixXd effects_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

}  // namespace monograin
