/// A source's own procedure for finding parameters of its law from a curve of forces over displacements.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "system/model_input.hpp"

namespace monograin {

/// Parameters that a procedure has found, with the error measures of its source.
struct ProcedureFit {
  std::string procedure;
  std::vector<double> parameters;  ///< values in the order of CurveProcedure::keys
  double area_error = 0.0;         ///< area error as the source defines it, over displacement/R0
  double peak_error = 0.0;         ///< peak error as the source defines it
};

/// A curve of forces, over CurveProcedure::force_unit, against displacements over R0.
struct ForceCurve {
  std::span<const double> displacement;
  std::span<const double> force;
};

/// A source's procedure as functions.
struct CurveProcedure {
  std::span<const std::string_view> keys;        ///< keys that the procedure determines, spelled as for `--set`
  std::span<const std::string_view> fixed_keys;  ///< keys that must not be free: the unit of force depends on them
  double (*force_unit)(const ModelInput& input) = nullptr;  ///< unit of ForceCurve::force [N]
  /// Fits the parameters to the first loading, by each variant of the procedure; the best fit is last. Empty if no fit
  /// exists.
  std::vector<ProcedureFit> (*fit)(const ForceCurve& loading) = nullptr;
  /// Computes the error measures of given parameters, as fit() does for the fitted ones.
  ProcedureFit (*measure)(const ForceCurve& loading, std::span<const double> parameters) = nullptr;
  /// Estimates values of further keys [SI] from the first unloading, as starting values of a calibration.
  std::map<std::string, double> (*unloading_starts)(const ModelInput& input, const ForceCurve& unloading) = nullptr;
};

}  // namespace monograin
