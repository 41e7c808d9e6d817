#include "nonlocal/walls.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "elastic/sphere_influence.hpp"
#include "system/resolution.hpp"

namespace monograin::nonlocal {
namespace {

void require_apart(double angle, const ContactClass& first, const ContactClass& second) {
  if (!(angle < k_least_wall_angle)) return;
  throw std::invalid_argument("walls of '" + first.name + "' and '" + second.name + "' are " + std::to_string(angle) +
                              " rad apart, less than " + std::to_string(k_least_wall_angle));
}

/// @throws std::invalid_argument if forces act differently on the walls of a class
void require_same_surroundings(const Eigen::MatrixXd& by_wall, const Eigen::MatrixXd& coupling,
                               std::span<const Wall> walls, std::span<const ContactClass> classes) {
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const std::size_t own = walls[i].contact_class;
    const double difference = (by_wall.row(as_index(i)) - coupling.row(as_index(own))).cwiseAbs().maxCoeff();
    if (difference > k_same_direction * (1.0 + coupling.cwiseAbs().maxCoeff())) {
      throw std::invalid_argument("the walls of '" + classes[own].name +
                                  "' do not share a history: forces around them differ by " +
                                  std::to_string(difference) + " in their effect");
    }
  }
}

/// Counts a wall among the neighbours of its class and angle.
void count_neighbour(std::vector<Neighbours>& neighbours, std::size_t contact_class, double angle,
                     double poisson_ratio) {
  const auto alike = std::ranges::find_if(neighbours, [&](const Neighbours& other) {
    return other.contact_class == contact_class && std::abs(other.angle - angle) < k_same_direction;
  });
  if (alike != neighbours.end())
    ++alike->count;
  else
    neighbours.push_back({contact_class, angle, radius_quotient(poisson_ratio, angle), 1});
}

}  // namespace

std::vector<Wall> walls_of(std::span<const ContactClass> classes) {
  std::vector<Wall> walls;
  for (std::size_t j = 0; j < classes.size(); ++j) {
    for (const Eigen::Vector3d& normal : classes[j].normals) walls.push_back({normal, j});
  }
  return walls;
}

Eigen::Matrix3Xd mean_normals_of(std::span<const ContactClass> classes) {
  Eigen::Matrix3Xd means = Eigen::Matrix3Xd::Zero(3, as_index(classes.size()));
  for (std::size_t j = 0; j < classes.size(); ++j) {
    for (const Eigen::Vector3d& normal : classes[j].normals)
      means.col(as_index(j)) += normal / classes[j].multiplicity();
  }
  return means;
}

Eigen::MatrixXd influence_of(Influence influence, double poisson_ratio, std::span<const Wall> walls,
                             std::span<const ContactClass> classes) {
  const bool is_sphere = influence == Influence::sphere;
  const double on_itself = is_sphere ? sphere_self_influence(poisson_ratio) : 0.0;
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(as_index(walls.size()), as_index(walls.size()));
  for (std::size_t i = 0; i < walls.size(); ++i) {
    for (std::size_t k = 0; k < walls.size(); ++k) {
      if (i == k) {
        result(as_index(i), as_index(i)) = on_itself;
        continue;
      }
      const double angle = angle_between(walls[i].normal, walls[k].normal);
      require_apart(angle, classes[walls[i].contact_class], classes[walls[k].contact_class]);
      result(as_index(i), as_index(k)) =
          is_sphere ? sphere_influence(poisson_ratio, angle) : half_space_influence(poisson_ratio, angle);
    }
  }
  return result;
}

bool has_negative_coupling(const Eigen::MatrixXd& influence) noexcept {
  for (Eigen::Index i = 0; i < influence.rows(); ++i) {
    for (Eigen::Index k = 0; k < influence.cols(); ++k) {
      if (i != k && influence(i, k) < 0.0) return true;
    }
  }
  return false;
}

Eigen::MatrixXd coupling_of(const Eigen::MatrixXd& influence, std::span<const Wall> walls,
                            std::span<const ContactClass> classes) {
  Eigen::MatrixXd belongs = Eigen::MatrixXd::Zero(as_index(walls.size()), as_index(classes.size()));
  for (std::size_t i = 0; i < walls.size(); ++i) belongs(as_index(i), as_index(walls[i].contact_class)) = 1.0;
  Eigen::VectorXd weights(as_index(classes.size()));
  for (std::size_t j = 0; j < classes.size(); ++j) weights[as_index(j)] = classes[j].multiplicity();
  const Eigen::MatrixXd by_wall = influence * belongs;
  const Eigen::MatrixXd coupling = weights.cwiseInverse().asDiagonal() * (belongs.transpose() * by_wall);
  require_same_surroundings(by_wall, coupling, walls, classes);
  return coupling;
}

std::vector<std::vector<Neighbours>> neighbours_of(double poisson_ratio, std::span<const Wall> walls,
                                                   std::size_t class_count) {
  std::vector<std::vector<Neighbours>> result(class_count);
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const std::size_t own = walls[i].contact_class;
    if (i > 0 && own == walls[i - 1].contact_class) continue;
    for (std::size_t k = 0; k < walls.size(); ++k) {
      if (k == i) continue;
      const double angle = angle_between(walls[i].normal, walls[k].normal);
      count_neighbour(result[own], walls[k].contact_class, angle, poisson_ratio);
    }
  }
  return result;
}

std::vector<double> rivalry_of(const Eigen::MatrixXd& influence, double composite_modulus, std::span<const Wall> walls,
                               std::size_t class_count) {
  std::vector<double> rivalry(class_count, k_infinity);
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const double lifting = -influence.row(as_index(i)).cwiseMin(0.0).sum();
    const double radius = 1.0 / (2.0 * composite_modulus * lifting);
    double& least = rivalry[walls[i].contact_class];
    if (radius < 1.0) least = std::min(least, radius * radius);
  }
  return rivalry;
}

}  // namespace monograin::nonlocal
