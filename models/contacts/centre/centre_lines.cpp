#include "contacts/centre/centre_lines.hpp"

#include <Eigen/QR>

namespace monograin::contacts {

CentreLines::CentreLines(std::span<const ContactClass> classes, bool is_free) {
  Eigen::Matrix3Xd means(3, static_cast<Eigen::Index>(classes.size()));
  for (std::size_t i = 0; i < classes.size(); ++i) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& normal : classes[i].normals) mean += normal;
    mean /= classes[i].multiplicity();
    // The sum of normals that balance is round-off, where they do not lie along the axes.
    if (mean.norm() <= k_no_direction) mean.setZero();
    means.col(static_cast<Eigen::Index>(i)) = mean;
  }
  if (is_free) {
    Eigen::ColPivHouseholderQR<Eigen::Matrix3Xd> qr(means);
    qr.setThreshold(k_no_direction);
    dimension_ = static_cast<int>(qr.rank());
    const Matrix q = qr.householderQ();
    basis_.leftCols(dimension_) = q.leftCols(dimension_);
  }
  for (Eigen::Index i = 0; i < means.cols(); ++i) {
    Vector arm = basis_.transpose() * means.col(i);
    OnLine on{};
    if (const double size = arm.norm(); size > k_no_direction) {
      const Vector unit = arm / size;
      while (on.line < directions_.size()) {
        const Vector& other = directions_[on.line];
        if ((unit - std::copysign(1.0, unit.dot(other)) * other).norm() <= k_no_direction) break;
        ++on.line;
      }
      if (on.line == directions_.size()) directions_.push_back(unit);
      on.along = std::copysign(size, unit.dot(directions_[on.line]));
      arm = on.along * directions_[on.line];
    }
    arms_.push_back(arm);
    on_lines_.push_back(on);
  }
  if (directions_.empty()) directions_.emplace_back(Vector::Zero());  // line of classes that act along none
}

}  // namespace monograin::contacts
