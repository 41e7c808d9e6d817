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
    free_directions_ = static_cast<int>(qr.rank());
    const Matrix q = qr.householderQ();
    basis_.leftCols(free_directions_) = q.leftCols(free_directions_);
  }
  for (Eigen::Index i = 0; i < means.cols(); ++i) {
    Vector mean_normal = basis_.transpose() * means.col(i);
    OnLine on{};
    if (const double size = mean_normal.norm(); size > k_no_direction) {
      const Vector unit = mean_normal / size;
      while (on.line < directions_.size()) {
        const Vector& other = directions_[on.line];
        if ((unit - std::copysign(1.0, unit.dot(other)) * other).norm() <= k_no_direction) break;
        ++on.line;
      }
      if (on.line == directions_.size()) directions_.push_back(unit);
      on.share = std::copysign(size, unit.dot(directions_[on.line]));
      mean_normal = on.share * directions_[on.line];
    }
    mean_normals_.push_back(mean_normal);
    on_lines_.push_back(on);
  }
  if (directions_.empty()) directions_.emplace_back(Vector::Zero());  // line of classes that act along none
}

}  // namespace monograin::contacts
