// Symmetry of a wall set, found from the walls themselves.

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "scene/scene.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

/// True if two steps are equal to the last digit: walls of one class have one program, or programs with equal numbers.
/// Normals may be computed, and are compared to within round-off.
bool same_step(const Step& a, const Step& b) {
  return a.kind == b.kind && a.target == b.target && a.duration == b.duration && a.rate == b.rate &&
         a.until == b.until && a.leg == b.leg && a.share == b.share;
}

/// Colours of walls: those with the same gap and the same program have the same colour.
std::vector<std::size_t> colours_of(const std::vector<Wall>& walls) {
  std::vector<std::size_t> colours(walls.size());
  for (std::size_t i = 0; i < walls.size(); ++i) {
    colours[i] = i;
    for (std::size_t j = 0; j < i; ++j) {
      if (walls[i].gap == walls[j].gap && std::ranges::equal(walls[i].steps, walls[j].steps, same_step)) {
        colours[i] = colours[j];
        break;
      }
    }
  }
  return colours;
}

/// Searches for a rotation or reflection of the wall set that maps one given wall to another.
class Matcher {
 public:
  explicit Matcher(const std::vector<Wall>& walls) : colours_(colours_of(walls)) {
    normals_.resize(3, static_cast<Eigen::Index>(walls.size()));
    for (std::size_t i = 0; i < walls.size(); ++i) normals_.col(static_cast<Eigen::Index>(i)) = walls[i].normal;
    products_ = normals_.transpose() * normals_;
  }

  [[nodiscard]] bool maps(Eigen::Index from, Eigen::Index to) {
    if (colour(from) != colour(to)) return false;
    if (basis_.empty() || basis_.front() != from) choose_basis(from);
    images_.assign(1, to);
    return extend();
  }

 private:
  [[nodiscard]] std::size_t colour(Eigen::Index i) const { return colours_[static_cast<std::size_t>(i)]; }

  /// Chooses walls whose normals are a basis of all normals, beginning with a given wall: their images fix the map.
  void choose_basis(Eigen::Index first) {
    basis_.assign(1, first);
    Eigen::Matrix3d outside = Eigen::Matrix3d::Identity();  // projector onto directions that the basis does not span
    outside -= normals_.col(first) * normals_.col(first).transpose();
    for (Eigen::Index i = 0; i < normals_.cols() && basis_.size() < 3; ++i) {
      const Eigen::Vector3d rest = outside * normals_.col(i);
      if (rest.norm() <= k_no_direction) continue;
      basis_.push_back(i);
      outside -= rest.normalized() * rest.normalized().transpose();
    }
    coordinates_ = Eigen::ColPivHouseholderQR<Eigen::Matrix3Xd>(normals_(Eigen::all, basis_)).solve(normals_);
  }

  /// Finds images for the rest of the basis that keep all scalar products, then tests the whole map.
  bool extend() {
    if (images_.size() == basis_.size()) return is_symmetry();
    const Eigen::Index next = basis_[images_.size()];
    for (Eigen::Index candidate = 0; candidate < normals_.cols(); ++candidate) {
      if (colour(candidate) != colour(next)) continue;
      bool keeps_products = true;
      for (std::size_t k = 0; k < images_.size(); ++k) {
        if (std::abs(products_(candidate, images_[k]) - products_(next, basis_[k])) > k_same_direction)
          keeps_products = false;
      }
      if (!keeps_products) continue;
      images_.push_back(candidate);
      if (extend()) return true;
      images_.pop_back();
    }
    return false;
  }

  [[nodiscard]] bool is_symmetry() const {
    for (Eigen::Index i = 0; i < normals_.cols(); ++i) {
      Eigen::Vector3d mapped = Eigen::Vector3d::Zero();
      for (std::size_t k = 0; k < images_.size(); ++k) {
        mapped += coordinates_(static_cast<Eigen::Index>(k), i) * normals_.col(images_[k]);
      }
      bool lands_on_wall = false;
      for (Eigen::Index j = 0; j < normals_.cols() && !lands_on_wall; ++j) {
        lands_on_wall = colour(i) == colour(j) && (mapped - normals_.col(j)).norm() < k_same_direction;
      }
      if (!lands_on_wall) return false;
    }
    return true;
  }

  std::vector<std::size_t> colours_;
  Eigen::Matrix3Xd normals_;
  Eigen::MatrixXd products_;
  std::vector<Eigen::Index> basis_;
  Eigen::MatrixXd coordinates_;  ///< of all normals in the basis
  std::vector<Eigen::Index> images_;
};

}  // namespace

std::vector<std::size_t> symmetry_classes(const std::vector<Wall>& walls) {
  Matcher matcher(walls);
  std::vector<std::size_t> class_of(walls.size());
  std::vector<std::size_t> representatives;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const auto found = std::ranges::find_if(representatives, [&](std::size_t first) {
      return matcher.maps(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(i));
    });
    class_of[i] = static_cast<std::size_t>(found - representatives.begin());
    if (found == representatives.end()) representatives.push_back(i);
  }
  return class_of;
}

}  // namespace monograin
