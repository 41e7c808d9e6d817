#include "study/model_fit.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>

#include "compressible/curve_fit.hpp"
#include "study/branches.hpp"
#include "study/calibration.hpp"

namespace monograin {
namespace {

constexpr std::array k_loading_keys{"compressible.k", "compressible.delta_t", "compressible.a"};

const FreeParameter* free_parameter(const Calibration& calibration, std::string_view path) {
  const auto found = std::ranges::find(calibration.free, path, [](const auto& free) { return free.key.path; });
  return found == calibration.free.end() ? nullptr : &*found;
}

std::string_view class_of(const MeasuredQuantity& quantity) {
  return std::string_view(quantity.observable).substr(0, quantity.observable.rfind('.'));
}

/// Whether the data are one curve, of forces over displacements of one contact, in the law's units whatever is fitted.
bool is_force_curve(const Calibration& calibration) {
  return calibration.curves.size() == 1 && calibration.curves.front().control == Step::Kind::displacement &&
         calibration.y.observable.ends_with(".force") && class_of(calibration.x) == class_of(calibration.y) &&
         free_parameter(calibration, "material.yield_pressure") == nullptr;
}

/// Rows that count, displacements over R0 and forces over pi R0^2 sigma_y0.
XyCurve normalised(const Calibration& calibration) {
  const double radius = calibration.scenario.radius;
  const double force_unit = std::numbers::pi * radius * radius * calibration.scenario.material.at("yield_pressure");
  XyCurve curve;
  for (std::size_t row = 0; row < calibration.x.values.size(); ++row) {
    if (!(calibration.weights[row] > 0.0) || calibration.x.values[row] < 0.0) continue;
    curve.x.push_back(calibration.x.values[row] / radius);
    curve.y.push_back(calibration.y.values[row] / force_unit);
  }
  return curve;
}

ProcedureFit reported(std::string procedure, const compressible::LoadingFit& fit) {
  return {std::move(procedure),
          {fit.law.stiffness, fit.law.transition, fit.law.exponent},
          fit.errors.area,
          fit.errors.peak};
}

void add_unloading(const Calibration& calibration, const XyCurve& curve, ModelFits& fits) {
  const Scenario& scenario = calibration.scenario;
  const std::vector<XyCurve> ways_back = unloadings(curve);
  if (ways_back.empty()) return;
  const XyCurve& first = ways_back.front();
  const double stiffness =
      compressible::hertz_stiffness(scenario.material.at("stiffness_ratio"), scenario.material.at("nu0"));
  const auto fit = compressible::fit_unloading(first.x, first.y, stiffness);
  if (!fit) return;
  fits.starts.emplace("compressible.alpha", fit->shape.exponent);
  fits.starts.emplace("compressible.beta", fit->shape.stiffness_ratio);
}

}  // namespace

ModelFits model_fits(const Calibration& calibration) {
  ModelFits fits;
  if (calibration.scenario.model != "compressible" || !is_force_curve(calibration)) return fits;
  const XyCurve curve = normalised(calibration);
  add_unloading(calibration, curve, fits);
  for (const char* key : k_loading_keys) {
    if (free_parameter(calibration, key) == nullptr) return fits;
  }
  const XyCurve loading = first_loading(curve);
  const auto nested = compressible::fit_nested(loading.x, loading.y);
  if (!nested) return fits;
  const compressible::LoadingFit joint = compressible::fit_jointly(loading.x, loading.y, *nested);
  fits.keys.assign(k_loading_keys.begin(), k_loading_keys.end());
  fits.fits = {reported("nested", *nested), reported("joint", joint)};
  for (std::size_t k = 0; k < fits.keys.size(); ++k) fits.starts.emplace(fits.keys[k], fits.fits[1].parameters[k]);
  return fits;
}

ProcedureFit measured_fit(const Calibration& calibration, const ModelFits& fits,
                          const std::vector<double>& parameters) {
  std::array<double, k_loading_keys.size()> values{};
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] =
        parameters[static_cast<std::size_t>(free_parameter(calibration, fits.keys[k]) - calibration.free.data())];
  }
  const compressible::LoadingLaw law{values[0], values[1], values[2]};
  const XyCurve loading = first_loading(normalised(calibration));
  return reported("this fit", {law, compressible::fit_errors(law, loading.x, loading.y)});
}

}  // namespace monograin
