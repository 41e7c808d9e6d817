/// Fits that a model brings along: procedures that know its equations, and find where a general search should begin.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace monograin {

struct Calibration;

/// A fit by one procedure, with the error measures of its source.
struct ProcedureFit {
  std::string procedure;
  std::vector<double> parameters;  ///< in the order of ModelFits::keys
  double area_error = 0.0;         ///< 001_3cd85d3b0dc520cf.txt, eq. 7, over displacement/R0
  double peak_error = 0.0;         ///< eq. 8 of the same, the absolute value added
};

struct ModelFits {
  std::vector<std::string> keys;         ///< of the parameters, as of `--set`
  std::vector<ProcedureFit> fits;        ///< to the first loading
  std::map<std::string, double> starts;  ///< by key: where to begin [SI]; also of keys that only unloading tells
};

/// Those of the calibration's model; none where it has no procedure for these parameters and data.
///
/// `compressible`: the source's nested procedure and the joint fit, where k, delta_t and a are free and displacements
/// drive forces; alpha and beta from the first unloading, where they are free too.
[[nodiscard]] ModelFits model_fits(const Calibration& calibration);

/// What the fitted parameters are by the same measures, as a further fit; to be called where there are others.
[[nodiscard]] ProcedureFit measured_fit(const Calibration& calibration, const ModelFits& fits,
                                        const std::vector<double>& parameters);

}  // namespace monograin
