/// A source's own procedure for finding parameters of its law from a curve of forces over displacements.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "system/model.hpp"

namespace monograin {

/// Fit by one procedure, with the error measures of its source.
struct ProcedureFit {
  std::string procedure;
  std::vector<double> parameters;  ///< in the order of the procedure's keys
  double area_error = 0.0;         ///< over displacement/R0
  double peak_error = 0.0;
};

/// Displacements over R0 and forces over the procedure's unit.
struct ForceCurve {
  std::span<const double> displacement;
  std::span<const double> force;
};

struct CurveProcedure {
  std::span<const std::string_view> keys;        ///< that it finds, as of `--set`
  std::span<const std::string_view> fixed_keys;  ///< that must not be free, because the unit of force depends on them
  double (*force_unit)(const ModelInput& input) = nullptr;  ///< [N]
  /// Fits to the first loading, the best one last; none where there is none.
  std::vector<ProcedureFit> (*fit)(const ForceCurve& loading) = nullptr;
  /// Measures parameters that are given as those of a fit are measured.
  ProcedureFit (*measure)(const ForceCurve& loading, std::span<const double> parameters) = nullptr;
  /// Values of further keys, from the first unloading [SI].
  std::map<std::string, double> (*unloading_starts)(const ModelInput& input, const ForceCurve& unloading) = nullptr;
};

}  // namespace monograin
