/// Identifiability before the experiment: the standard errors of a fit to planned measurements, computed from the
/// derivatives of the measured quantity (Fisher information; Fedorov (1972), Theory of Optimal Experiments).
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "numerics/uncertainty.hpp"
#include "study/identify/identify_file.hpp"

namespace monograin {

/// Information on the parameters in the measured rows of a program.
struct ProgramInformation {
  Eigen::MatrixXd jacobian;        ///< d(y)/d(parameter) over the standard deviation of y, a row for each datum [1/SI]
  double largest = 0.0;            ///< maximum over the rows of |y| over its standard deviation
  std::size_t left_out = 0;        ///< rows without a derivative at a fixed instant
  double noise = 0.0;              ///< relative error of the runs whose differences are the derivatives
  std::vector<std::string> notes;  ///< remarks on the run for the user
};

/// Runs a program and differentiates y at its measured instants. With a machine, rows are the sums of the particle's
/// and the machine's displacements, and derivatives those of a calibration to such rows.
/// @throws ScenarioError where the standard deviation of y is zero in a row, or a calibration cannot follow the rows
[[nodiscard]] ProgramInformation information_of(const ExperimentPlan& plan, const ExperimentProgram& program);

/// Expected errors of the parameters. J has the rows of all programs and one for each prior; the noise is known:
///
///   covariance = (J^T J)^-1
struct ExpectedErrors {
  Uncertainty uncertainty;
  // Criteria count the scenario's parameters, each over its value. The machine's are nuisance parameters, which widen
  // the errors of the others (D_s-optimality; Atkinson, Donev and Tobias (2007)).
  double log_determinant = 0.0;     ///< natural logarithm of the determinant of the relative covariance; inf where a
                                    ///< parameter is not determined
  double relative_variances = 0.0;  ///< trace of the relative covariance; inf where a parameter is not determined
};

/// Errors of one fit to all programs together.
/// @param values    true values of the parameters [SI], between their bounds; those of the scenario are not zero
/// @param programs  may be empty: the priors alone count
[[nodiscard]] ExpectedErrors expected_errors(const std::vector<FreeParameter>& free, std::span<const double> values,
                                             std::span<const ProgramInformation* const> programs);

/// Errors with one candidate added to the planned programs.
struct CandidateErrors {
  std::size_t program = 0;
  ExpectedErrors errors;
  double volume = 0.0;  ///< of the confidence ellipsoid, over that of the planned programs; nan where that is infinite
};

struct IdentifyResult {
  std::vector<ProgramInformation> programs;
  std::optional<ExpectedErrors> planned;  ///< absent where no program is planned and there is no prior
  std::vector<CandidateErrors> candidates;
  std::optional<std::size_t> best_by_volume;     ///< D-optimal candidate; absent where none determines all parameters
  std::optional<std::size_t> best_by_variances;  ///< A-optimal candidate
};

/// Runs all programs and compares the candidates.
/// @param before_run  called before each program is run; an exception that it throws ends the work
/// @throws ScenarioError where the standard deviation of y is zero in a row
[[nodiscard]] IdentifyResult identify(const ExperimentPlan& plan, const std::function<void()>& before_run = {});

}  // namespace monograin
