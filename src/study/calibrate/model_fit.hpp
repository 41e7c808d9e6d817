/// Fits by procedures of a model, which use its equations and find where a general search should begin.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "system/curve_procedure.hpp"

namespace monograin {

struct Calibration;

struct ModelFits {
  std::vector<std::string> keys;         ///< of the parameters, as of `--set`
  std::vector<ProcedureFit> fits;        ///< to the first loading
  std::map<std::string, double> starts;  ///< by key: starting value [SI]; also of keys that only unloading determines
};

/// Fits by the procedure of the calibration's model. There are some only if the model has a procedure, all keys of the
/// procedure are free, and the data are forces over displacements of a wall.
[[nodiscard]] ModelFits model_fits(const Calibration& calibration);

/// The fitted parameters with the measures of the model's procedures. Call it only if `fits` contains fits.
[[nodiscard]] ProcedureFit measured_fit(const Calibration& calibration, const ModelFits& fits,
                                        const std::vector<double>& parameters);

}  // namespace monograin
