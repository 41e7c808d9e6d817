// The data of a calibration and its free numbers.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "study/calibrate/calibration.hpp"
#include "study/calibrate/calibration_language.hpp"

namespace monograin {

std::vector<std::size_t> Calibration::counted_rows() const {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < weights.size(); ++row) {
    if (weights[row] > 0.0) rows.push_back(row);
  }
  return rows;
}

const FreeParameter* Calibration::find_free(std::string_view path) const noexcept {
  const auto found =
      std::ranges::find_if(free, [path](const FreeParameter& parameter) { return parameter.key.path == path; });
  return found == free.end() ? nullptr : &*found;
}

bool Calibration::knows_noise() const noexcept {
  return weighting == calibration::k_noise && loss.kind == Loss::linear;
}

Machine Calibration::machine_of(const MeasuredCurve& curve, std::span<const double> parameters) const {
  Machine machine = curve.machine;
  for (std::size_t k = 0; k < free.size(); ++k) {
    if (free[k].key.path == calibration::k_offset) machine.offset = parameters[k];
    if (free[k].key.path == calibration::k_force_offset) machine.force_offset = parameters[k];
    if (free[k].key.path == calibration::k_compliance) machine.compliance = parameters[k];
  }
  return machine;
}

bool FreeParameter::is_of_machine() const noexcept { return key.path.starts_with(calibration::k_data); }

std::string FreeParameter::bounds_text() const {
  return fmt::format("'{}' from {:.6g} to {:.6g}{}{}", key.path, lower / unit_factor, upper / unit_factor,
                     unit.empty() ? "" : " ", unit);
}

bool Calibration::has_machine() const noexcept {
  const auto has_own = [](const MeasuredCurve& curve) { return !curve.machine.adds_nothing(); };
  return std::ranges::any_of(free, &FreeParameter::is_of_machine) || std::ranges::any_of(curves, has_own);
}

const MeasuredCurve& Calibration::curve_of(std::size_t row) const noexcept {
  return *std::ranges::find_if(curves, [row](const MeasuredCurve& curve) { return row < curve.end; });
}

std::string data_names(const Calibration& calibration) {
  std::vector<std::string> names;
  for (const MeasuredCurve& curve : calibration.curves)
    names.push_back(std::filesystem::path(curve.file).filename().string());
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace monograin
