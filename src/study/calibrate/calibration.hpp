/// Calibration: numbers of a scenario fitted to measured data, with what is known of their uncertainty.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "history/staged_folder.hpp"
#include "history/table.hpp"
#include "numerics/intervals.hpp"
#include "numerics/least_squares.hpp"
#include "numerics/uncertainty.hpp"
#include "scenario/numbers.hpp"
#include "scenario/scenario.hpp"
#include "scenario/table_layout.hpp"
#include "study/calibrate/machine.hpp"
#include "study/calibrate/model_fit.hpp"
#include "study/calibrate/prior.hpp"
#include "study/calibrate/replay.hpp"

namespace monograin {

/// A number of the scenario that is sought.
struct FreeParameter : BoundedParameter {
  NumberKey key;
  std::string unit;          ///< that of its lower bound as given, which it is shown in; empty for a pure number
  double unit_factor = 1.0;  ///< one unit in SI
  std::optional<Prior> prior{};
};

/// What a column of the data holds.
struct MeasuredQuantity {
  std::string observable;    ///< as in a history: "axial.force"
  std::string unit;          ///< as given; values are SI
  double unit_factor = 1.0;  ///< one unit in SI
  std::string si;            ///< SI unit
  std::vector<double> values;
};

/// One of the measured curves: rows of the data, and the scenario that follows them.
struct MeasuredCurve {
  std::size_t begin = 0;  ///< its rows among all
  std::size_t end = 0;
  std::string file;
  std::string text;
  TableLayout layout;
  std::array<std::size_t, 2> columns{};  ///< of x and y in the file, from 1
  std::vector<std::size_t> left_out;     ///< lines of the rows without a number in one of the columns
  Machine machine;                       ///< as given, without what is free
  std::vector<std::string> overrides;    ///< of the scenario, for this curve
  CheckedScenario scenario;              ///< with them; has variants where the radius is free
  std::string driven;                    ///< observable that x holds
  Step::Kind control = Step::Kind::displacement;
  double start = 0.0;  ///< of x, before the first step [SI]
};

/// How intervals are found.
enum class IntervalMethod { automatic, covariance, profile, bootstrap };

/// A calibration file with all that it names, checked. The rows of its curves follow one another.
struct Calibration {
  std::string name;  ///< of the file, without folder and extension
  std::string file;
  std::string text;
  std::string title;
  CheckedScenario scenario;  ///< with its own steps
  std::string scenario_text;
  std::vector<MeasuredCurve> curves;  ///< at least one
  MeasuredQuantity x;
  MeasuredQuantity y;
  std::string weighting;           ///< absolute, relative, column, area; noise
  std::vector<double> weights;     ///< factors of y's residuals [1/SI], >= 0; 0: a row that only drives
  std::vector<std::size_t> lines;  ///< of the rows in their data file
  std::vector<FreeParameter> free;
  LossFunction loss;
  double confidence = 0.95;
  IntervalMethod intervals = IntervalMethod::automatic;
  std::vector<std::string> notes;  ///< what was found in the data's files and may not be what was meant

  /// The machine of a curve with these values of the free parameters.
  [[nodiscard]] Machine machine_of(const MeasuredCurve& curve, std::span<const double> parameters) const;
  /// Whether the size of the noise is given, and weights are one over standard deviations.
  [[nodiscard]] bool knows_noise() const noexcept;
  /// Whether the machine adds to the displacement of any curve, or may.
  [[nodiscard]] bool has_machine() const noexcept;
  /// Which of the quantities the machine adds to: the displacement.
  [[nodiscard]] bool machine_moves_x() const noexcept { return x.observable.ends_with(".displacement"); }
  /// Rows that take part in the fit.
  [[nodiscard]] std::size_t counted() const noexcept;
  /// The curve that a row is of.
  [[nodiscard]] const MeasuredCurve& curve_of(std::size_t row) const noexcept;
};

/// Names of the data's files, without their folders.
[[nodiscard]] std::string data_names(const Calibration& calibration);

/// Reads and checks a calibration file, its scenario and its data.
/// @throws ScenarioError with all faults of all three
[[nodiscard]] Calibration read_calibration(const std::filesystem::path& file);

/// A curve of the fitted scenario, with its band.
struct FittedCurve {
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> band;  ///< half its width; nan where there is none
};

struct CalibrationResult {
  LeastSquaresSolution solution;
  Uncertainty uncertainty;
  std::vector<Interval> intervals;                     ///< of the parameters; nan where there is none
  IntervalMethod method = IntervalMethod::covariance;  ///< by which they were found
  std::string method_reason;                           ///< a clause
  std::optional<ResidualTests> residual_tests;         ///< none for few rows, or where the fit is exact
  ModelFits procedures;               ///< of the model's own, and this fit by their measures; empty: it has none
  FittedCurve fit;                    ///< at the data
  std::vector<FittedCurve> curves;    ///< in between, too: one for each measured curve
  std::size_t points = 0;             ///< rows that take part
  std::size_t program_steps = 0;      ///< of the loading made from the data
  double sum_of_squares = 0.0;        ///< of weighted residuals; chi^2 where the noise is known
  double rms = 0.0;                   ///< of residuals [SI of y], over all rows that take part
  double largest = 0.0;               ///< of their magnitudes
  std::size_t largest_at = 0;         ///< its row
  double r_squared = 0.0;             ///< 1 - sum (y - fit)^2 / sum (y - mean)^2, unweighted; nan where y is constant
  double explained = 0.0;             ///< 1 - cost / (cost of the best constant); nan where y is constant
  std::vector<double> particle;       ///< displacement at the particle in every row; empty: the machine adds nothing
  std::vector<std::string> notes;     ///< what the user should know
  std::vector<std::string> warnings;  ///< why the fit is not to be trusted, and the likely cause
};

/// A fit that explains less of the data than this is bad, and warned of. It is R^2 where the loss is linear and the
/// weights are equal.
inline constexpr double k_least_explained = 0.9;

/// Size of a file of data [byte].
inline constexpr std::size_t k_largest_data = 16U * 1024U * 1024U;

/// Share of the rows that may lack a number in x, y or the weights.
inline constexpr double k_most_missing = 0.1;

/// Fits, and looks for the cause of a bad fit in the units, signs and the first touch. @throws ScenarioError where the
/// scenario cannot follow the data with any of the parameters tried
[[nodiscard]] CalibrationResult calibrate(const Calibration& calibration,
                                          const LeastSquaresProblem::Progress& progress = {});

/// Response of the best fit in every row, without its uncertainty and without a search for causes where it is bad.
/// @return nothing where the scenario cannot follow the data with any of the parameters tried
[[nodiscard]] std::optional<std::vector<double>> best_response(const Calibration& calibration);

/// The scenario with the fitted numbers, to 17 digits, and its own loading; all else as its author wrote it.
[[nodiscard]] std::string fitted_scenario_text(const Calibration& calibration, const CalibrationResult& result);

/// Parameters, intervals, correlations and residuals, for a reader.
[[nodiscard]] std::string calibration_text(const Calibration& calibration, const CalibrationResult& result);

/// Data, fit, residuals, confidence band and weights, row by row: what fit.csv holds.
[[nodiscard]] Table fit_table(const Calibration& calibration, const CalibrationResult& result);

/// Parameters, covariance, statistics and data: what calibration.json holds. Numbers that are undefined are null.
[[nodiscard]] std::string calibration_json(const Calibration& calibration, const CalibrationResult& result);

/// The file whose presence tells that a folder holds a calibration.
inline constexpr const char* k_calibration_marker = "calibration.json";

/// Writes fit.csv, fitted.toml with the tables it names, calibration.json and figure.svg with its script and data, all
/// of them or none.
/// @param folder      made with k_calibration_marker
/// @param has_report  report.md and report.pdf, too
/// @return why there is no figure; empty: there is
/// @throws std::runtime_error naming what could not be written
[[nodiscard]] std::string write_calibration(const Calibration& calibration, const CalibrationResult& result,
                                            StagedFolder& folder, bool has_report = false);

}  // namespace monograin
