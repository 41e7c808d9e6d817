/// Fits that a model brings along: procedures that know its equations, and find where a general search should begin.
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
  std::map<std::string, double> starts;  ///< by key: where to begin [SI]; also of keys that only unloading tells
};

/// Those of the calibration's model; none where it has no procedure for these parameters and
/// data: its keys are free, and displacements of a wall drive its forces.
[[nodiscard]] ModelFits model_fits(const Calibration& calibration);

/// What the fitted parameters are by the same measures, as a further fit; to be called where there are others.
[[nodiscard]] ProcedureFit measured_fit(const Calibration& calibration, const ModelFits& fits,
                                        const std::vector<double>& parameters);

}  // namespace monograin
