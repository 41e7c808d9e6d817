#include "study/calibrate/model_fit.hpp"

#include <algorithm>

#include "catalogue.hpp"
#include "history/branches.hpp"
#include "scenario/model_input.hpp"
#include "study/calibrate/calibration.hpp"
#include "study/calibrate/calibration_language.hpp"

namespace monograin {
namespace {

std::string_view class_of(const MeasuredQuantity& quantity) {
  return std::string_view(quantity.observable).substr(0, quantity.observable.rfind('.'));
}

const CurveProcedure* procedure_of(const Calibration& calibration) {
  return find_model(calibration.scenario.model)->curve_procedure;
}

/// True if the data are forces over displacements of one contact, and the fit has fixed radius, units and machine.
bool is_force_curve(const Calibration& calibration) {
  return calibration.curves.size() == 1 && calibration.curves.front().control == Step::Kind::displacement &&
         calibration.y.observable.ends_with(".force") && class_of(calibration.x) == class_of(calibration.y) &&
         calibration.find_free(k_radius_key) == nullptr &&
         std::ranges::none_of(calibration.free, &FreeParameter::is_of_machine) &&
         std::ranges::none_of(procedure_of(calibration)->fixed_keys,
                              [&](std::string_view key) { return calibration.find_free(key) != nullptr; });
}

/// The rows that count, as displacements over R0 and forces over the procedure's unit.
XyCurve normalised(const Calibration& calibration) {
  const double radius = calibration.scenario.radius;
  const double force_unit = procedure_of(calibration)->force_unit(model_input(calibration.scenario));
  const Machine& machine = calibration.curves.front().machine;
  XyCurve curve;
  for (std::size_t row = 0; row < calibration.x.values.size(); ++row) {
    const double force = calibration.y.values[row] - machine.force_offset;
    const double displacement = calibration.x.values[row] - machine.addition(force);
    if (!(calibration.weights[row] > 0.0) || displacement < 0.0) continue;
    curve.x.push_back(displacement / radius);
    curve.y.push_back(force / force_unit);
  }
  return curve;
}

}  // namespace

ModelFits model_fits(const Calibration& calibration) {
  ModelFits fits;
  const CurveProcedure* procedure = procedure_of(calibration);
  if (procedure == nullptr || !is_force_curve(calibration)) return fits;
  const XyCurve curve = normalised(calibration);
  if (const std::vector<XyCurve> ways_back = unloadings(curve); !ways_back.empty()) {
    const XyCurve& first = ways_back.front();
    fits.starts = procedure->unloading_starts(model_input(calibration.scenario), {first.x, first.y});
  }
  if (!std::ranges::all_of(procedure->keys,
                           [&](std::string_view key) { return calibration.find_free(key) != nullptr; })) {
    return fits;
  }
  const XyCurve loading = first_loading(curve);
  fits.fits = procedure->fit({loading.x, loading.y});
  if (fits.fits.empty()) return fits;
  fits.keys.assign(procedure->keys.begin(), procedure->keys.end());
  for (std::size_t k = 0; k < fits.keys.size(); ++k) fits.starts.emplace(fits.keys[k], fits.fits.back().parameters[k]);
  return fits;
}

ProcedureFit measured_fit(const Calibration& calibration, const ModelFits& fits,
                          const std::vector<double>& parameters) {
  std::vector<double> values;
  for (const std::string& key : fits.keys) {
    values.push_back(parameters[static_cast<std::size_t>(calibration.find_free(key) - calibration.free.data())]);
  }
  const XyCurve loading = first_loading(normalised(calibration));
  return procedure_of(calibration)->measure({loading.x, loading.y}, values);
}

}  // namespace monograin
