#include "study/calibrate/response.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "catalogue.hpp"
#include "engine/drive.hpp"
#include "scenario/integrators.hpp"
#include "scene/scene.hpp"
#include "study/calibrate/calibration_language.hpp"

namespace monograin {
namespace {

constexpr double k_series_noise = 1e-12;  // relative error of a response in series with a machine
constexpr std::string_view k_displacement = ".displacement";
constexpr std::string_view k_force = ".force";

}  // namespace

double noise_of(const Calibration& calibration) {
  const Scene scene = make_scene(calibration.scenario);
  const Numerics& numerics = calibration.scenario.numerics;
  const bool is_direct = choose_integrator(numerics.integrator, *scene.system).used == integrators::k_direct;
  const double noise = is_direct ? k_direct_noise : numerics.rtol;
  return calibration.has_machine() ? std::max(noise, k_series_noise) : noise;
}

Response::Response(const Calibration& calibration, const MeasuredCurve& curve, DataPath path, std::vector<double> y)
    : calibration_(calibration),
      curve_(curve),
      replay_(curve.scenario, {curve.driven, calibration.y.observable, curve.control, curve.start}, std::move(path)),
      measured_(std::move(y)),
      noise_(noise_of(calibration)),
      response_(measured_.size()) {}

bool Response::operator()(std::span<const double> parameters, std::span<double> response) {
  problem_.clear();
  for (const bool is_radius : {true, false}) {  // the radius comes first: lengths in R0 follow it
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      const std::string& path = calibration_.free[k].key.path;
      if (calibration_.free[k].is_of_machine() || (path == k_radius_key) != is_radius) continue;
      if (!replay_.set(path, parameters[k])) return false;
    }
  }
  if (!run(calibration_.machine_of(curve_, parameters))) return false;
  for (std::size_t row = 0; row < path().point_of.size(); ++row) response[row] = response_[path().point_of[row]];
  return true;
}

/// Finds the response at the points of the path.
bool Response::run(const Machine& machine) {
  if (calibration_.machine_moves_x()) {
    if (!machine.adds_nothing()) return run_in_series(machine);
    if (std::exchange(is_moved_, false)) replay_.follow(path().x);
    particle_ = path().x;
    return replay_.run(response_);
  }
  std::vector<double> driving = path().x;
  const bool moves_force = calibration_.x.observable.ends_with(k_force) && machine.force_offset != 0.0;
  if (moves_force) {
    const bool may_pull = find_model(curve_.scenario.model)->adheres(curve_.scenario.material);
    for (double& force : driving) {
      force -= machine.force_offset;
      // Nothing pulls at a particle that does not adhere: with less force than without a load, it is not touched.
      if (!may_pull) force = std::max(force, 0.0);
    }
  }
  if (moves_force || is_moved_) replay_.follow(driving);
  is_moved_ = moves_force;
  if (!replay_.run(response_)) return false;
  const std::string& y = calibration_.y.observable;
  if (y.ends_with(k_displacement)) {
    particle_ = response_;
    for (std::size_t i = 0; i < response_.size(); ++i) response_[i] += machine.addition(driving[i]);
  } else if (y.ends_with(k_force)) {
    for (double& force : response_) force += machine.force_offset;
  }
  return true;
}

/// Finds the response if x is the sum of the displacements of the machine and the particle.
bool Response::run_in_series(const Machine& machine) {
  is_moved_ = true;
  const std::vector<double>& x = path().x;
  particle_ = x;
  double largest = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    particle_[i] -= machine.addition(measured_[i] - machine.force_offset);
    largest = std::max(largest, std::abs(x[i]));
  }
  bool has_run = true;
  const auto forces_of = [&](const std::vector<double>& particle, std::span<double> forces) {
    replay_.follow(particle);
    has_run = replay_.run(forces);
    return has_run;
  };
  if (!put_in_series(machine, x, forces_of, noise_ * largest, particle_, response_)) {
    if (has_run) problem_ = "no displacements of the particle and of the machine add up to those measured";
    return false;
  }
  for (double& force : response_) force += machine.force_offset;
  return true;
}

}  // namespace monograin
