#include "study/sweep/joint_normal.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <boost/math/distributions/normal.hpp>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "scenario/document.hpp"
#include "scenario/text_file.hpp"
#include "scenario/words.hpp"

namespace monograin {

void JointNormal::correlate(std::span<double> shares) const {
  const boost::math::normal normal;
  Eigen::VectorXd z(static_cast<Eigen::Index>(shares.size()));
  for (std::size_t k = 0; k < shares.size(); ++k) {
    z[static_cast<Eigen::Index>(k)] = boost::math::quantile(normal, shares[k]);
  }
  z = factor.triangularView<Eigen::Lower>() * z;
  for (std::size_t k = 0; k < shares.size(); ++k) {
    shares[k] = boost::math::cdf(normal, z[static_cast<Eigen::Index>(k)]);
  }
}

std::string text_of_calibration(std::filesystem::path path) {
  if (std::filesystem::is_directory(path)) path /= "calibration.json";
  auto [text, problem] = read_text_file(path, k_largest_text);
  if (!problem.empty()) {
    throw std::runtime_error(
        fmt::format("{} ({}); expected a path relative to this file", problem, on_one_line(path.string())));
  }
  return std::move(text);
}

JointNormal read_joint_normal(std::string_view text) {
  JointNormal joint;
  std::vector<std::size_t> places;
  try {
    const auto json = nlohmann::json::parse(text);
    const auto& parameters = json.at("parameters");
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      const auto key = parameters[k].at("key").get<std::string>();
      if (key.starts_with("data.")) continue;
      const auto& error = parameters[k].at("standard_error");
      if (!error.is_number() || !(error.get<double>() > 0.0)) {
        throw std::runtime_error(
            fmt::format("'{}' has no standard error; expected a number that the data determine", key));
      }
      places.push_back(k);
      joint.keys.push_back(key);
      joint.means.push_back(parameters[k].at("value").get<double>());
      joint.standard_errors.push_back(error.get<double>());
    }
    const auto size = static_cast<Eigen::Index>(places.size());
    Eigen::MatrixXd correlation(size, size);
    for (Eigen::Index i = 0; i < size; ++i) {
      for (Eigen::Index j = 0; j < size; ++j) {
        correlation(i, j) = json.at("correlation")
                                .at(places[static_cast<std::size_t>(i)])
                                .at(places[static_cast<std::size_t>(j)])
                                .get<double>();
      }
    }
    const Eigen::LLT<Eigen::MatrixXd> decomposition(correlation);
    joint.factor = decomposition.matrixL();
    if (decomposition.info() != Eigen::Success) {
      throw std::runtime_error("its numbers depend on each other; expected a calibration with fewer free numbers");
    }
  } catch (const nlohmann::json::exception&) {
    throw std::runtime_error("it is no result of monograin calibrate; expected its calibration.json");
  }
  if (joint.keys.empty()) throw std::runtime_error("it has found no number of the scenario");
  return joint;
}

}  // namespace monograin
