#include "contacts/centre/centre_lines.hpp"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>

namespace monograin::contacts {

namespace {

/// Orthonormal basis of what lines span. Its first vector is along the line of most classes, whose forces then have one
/// component: those of opposite walls cancel exactly, and leave no round-off across them.
/// @param sums  of the directions of the classes along each line
Eigen::Matrix3Xd basis_of_span(const std::vector<Eigen::Vector3d>& sums) {
  const Eigen::Map<const Eigen::Matrix3Xd> lines(sums.front().data(), 3, static_cast<Eigen::Index>(sums.size()));
  Eigen::JacobiSVD<Eigen::Matrix3Xd> svd(lines.colwise().normalized(), Eigen::ComputeFullU);
  svd.setThreshold(0.5 * k_no_direction);  // two lines at an angle of k_no_direction have this ratio
  const Eigen::Matrix3Xd span = svd.matrixU().leftCols(svd.rank());
  const Eigen::Matrix3Xd projected = span * (span.transpose() * lines);
  const Eigen::Matrix3d q = projected.colPivHouseholderQr().householderQ();
  return q.leftCols(svd.rank());
}

}  // namespace

CentreLines::CentreLines(std::span<const ContactClass> classes, bool is_free) {
  std::vector<Vector> members;  // the first direction on each line
  std::vector<Vector> sums;     // of the directions on each line
  for (const ContactClass& c : classes) {
    Vector mean = Vector::Zero();
    for (const Eigen::Vector3d& normal : c.normals) mean += normal;
    mean /= c.multiplicity();
    OnLine on{};
    // The sum of normals that balance is round-off, where they do not lie along the axes.
    if (const double size = mean.norm(); is_free && size > k_no_direction) {
      const Vector unit = mean / size;
      const auto is_parallel = [&](const Vector& other) {
        return std::min((unit - other).norm(), (unit + other).norm()) <= k_no_direction;
      };
      on.line = static_cast<std::size_t>(std::ranges::find_if(members, is_parallel) - members.begin());
      if (on.line == members.size()) {
        members.push_back(unit);
        sums.emplace_back(Vector::Zero());
      }
      on.share = std::copysign(size, unit.dot(members[on.line]));
      sums[on.line] += std::copysign(1.0, on.share) * unit;
    }
    on_lines_.push_back(on);
  }
  if (!sums.empty()) {
    const Eigen::Matrix3Xd basis = basis_of_span(sums);
    free_directions_ = static_cast<int>(basis.cols());
    basis_.leftCols(free_directions_) = basis;
  }
  for (const Vector& sum : sums) directions_.emplace_back((basis_.transpose() * sum).normalized());
  if (directions_.empty()) directions_.emplace_back(Vector::Zero());  // line of classes that act along none
  for (const OnLine& on : on_lines_) mean_normals_.emplace_back(on.share * directions_[on.line]);
}

}  // namespace monograin::contacts
