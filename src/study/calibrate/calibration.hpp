/// Calibration: fit of a scenario's numbers to measured data, with their uncertainty. The functions and classes are
/// defined in calibration_data.cpp (data and free numbers), calibration_file.cpp (reading), calibration.cpp (fit),
/// calibration_text.cpp (report) and calibration_files.cpp (files).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "figure/figure.hpp"
#include "history/staged_folder.hpp"
#include "history/table.hpp"
#include "numerics/intervals.hpp"
#include "numerics/least_squares.hpp"
#include "numerics/uncertainty.hpp"
#include "scenario/numbers.hpp"
#include "scenario/scenario.hpp"
#include "scenario/table_layout.hpp"
#include "scenario/text_file.hpp"
#include "study/calibrate/machine.hpp"
#include "study/calibrate/model_fit.hpp"
#include "study/calibrate/prior.hpp"
#include "study/calibrate/replay.hpp"

namespace monograin {

/// A free number of the scenario, which the fit determines.
struct FreeParameter : BoundedParameter {
  NumberKey key;
  std::string unit;          ///< unit of its lower bound as given, in which it is shown; empty for a pure number
  double unit_factor = 1.0;  ///< one unit in SI
  std::optional<Prior> prior{};

  /// True for a number of the testing machine, which is not in the scenario.
  [[nodiscard]] bool is_of_machine() const noexcept;
  /// "'material.youngs_modulus' from 0.1 to 10 GPa".
  [[nodiscard]] std::string bounds_text() const;
};

/// Measured quantity in a column of the data.
struct MeasuredQuantity {
  std::string observable{};  ///< as in a history: "axial.force"
  std::string unit;          ///< as given; values are SI
  double unit_factor = 1.0;  ///< one unit in SI
  std::string si;            ///< SI unit
  std::vector<double> values{};
};

/// Standard deviations of what is measured. The squares of the two parts of y add up.
struct NoiseParts {
  double absolute = 0.0;  ///< of y [SI of y]
  double relative = 0.0;  ///< of y, over |y|
  double x = 0.0;         ///< of x [SI of x]
};

/// One of the measured curves: rows of the data, and the scenario that reproduces them.
struct MeasuredCurve {
  std::size_t begin = 0;  ///< index of its first row among all rows
  std::size_t end = 0;
  std::string file;
  std::string text;
  TableLayout layout;
  std::array<std::size_t, 2> columns{};    ///< of x and y in the file, from 1
  std::array<double, 2> scales{1.0, 1.0};  ///< factors of the numbers in these columns
  std::vector<std::size_t> left_out;       ///< lines in which one of the columns has no number
  std::vector<std::size_t> trailer;        ///< lines of text below the table
  NoiseParts noise;                        ///< zero if it is not known, or if a column has that of y
  Machine machine;                         ///< as given, without its free numbers
  std::vector<std::string> overrides;      ///< of the scenario, for this curve
  CheckedScenario scenario;                ///< with these overrides; has variants if the radius is free
  std::string driven;                      ///< observable that x holds
  Step::Kind control = Step::Kind::displacement;
  double start = 0.0;  ///< of x, before the first step [SI]

  /// Its values, out of values that are stored row by row.
  template <class T>
  [[nodiscard]] std::span<T> rows_of(std::vector<T>& values) const {
    return std::span(values).subspan(begin, end - begin);
  }
  template <class T>
  [[nodiscard]] std::span<const T> rows_of(const std::vector<T>& values) const {
    return std::span(values).subspan(begin, end - begin);
  }
};

/// Method by which intervals are found.
enum class IntervalMethod { automatic, covariance, profile, bootstrap };

/// A checked calibration file with everything that it names. The rows of its curves are consecutive.
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
  std::vector<double> weights;     ///< factors of y's residuals [1/SI], >= 0; 0: a row that only drives the scenario
  std::vector<std::size_t> lines;  ///< of the rows in their data file
  std::vector<FreeParameter> free;
  LossFunction loss;
  double confidence = 0.95;
  IntervalMethod intervals = IntervalMethod::automatic;
  std::vector<std::string> notes;  ///< observations about the data's files that may be mistakes

  /// Machine of a curve, with given values of the free parameters.
  [[nodiscard]] Machine machine_of(const MeasuredCurve& curve, std::span<const double> parameters) const;
  /// True if the size of the noise is given, so that weights are one over standard deviations.
  [[nodiscard]] bool knows_noise() const noexcept;
  /// True if the machine adds, or may add, to displacement or force of any curve.
  [[nodiscard]] bool has_machine() const noexcept;
  /// True if the machine adds to x rather than to y: the quantity that is a displacement.
  [[nodiscard]] bool machine_moves_x() const noexcept { return x.observable.ends_with(".displacement"); }
  /// Indices of the rows that count in the fit: those with a weight.
  [[nodiscard]] std::vector<std::size_t> counted_rows() const;
  /// Their number.
  [[nodiscard]] std::size_t counted() const { return counted_rows().size(); }
  /// The free parameter with a path, or nullptr.
  [[nodiscard]] const FreeParameter* find_free(std::string_view path) const noexcept;
  /// The curve to which a row belongs.
  [[nodiscard]] const MeasuredCurve& curve_of(std::size_t row) const noexcept;
};

/// Names of the data's files, without their folders.
[[nodiscard]] std::string data_names(const Calibration& calibration);

/// Reads and checks a calibration file, its scenario and its data.
/// @throws ScenarioError with all faults of all three
[[nodiscard]] Calibration read_calibration(const std::filesystem::path& file);
/// @param data  texts of files of data by their names; others are read. A name that no data have is a fault.
[[nodiscard]] Calibration parse_calibration(NamedText source, const FileTexts& data = {});

/// The fitted scenario's response to one measured curve, with its confidence band.
struct FittedCurve {
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> band;  ///< half the band's width; nan if there is none
};

/// How closely a fit follows the data.
struct GoodnessOfFit {
  double sum_of_squares = 0.0;  ///< of weighted residuals; chi^2 if the noise is known
  double noise_growth = 0.0;    ///< ln det of the covariance of noise that follows from the fit, less that given
  double rms = 0.0;             ///< of residuals [SI of y], over all rows that count
  double largest = 0.0;         ///< largest magnitude of a residual
  std::size_t largest_at = 0;   ///< row of the largest residual
  double r_squared = 0.0;       ///< 1 - sum (y - fit)^2 / sum (y - mean)^2, unweighted; nan if y is constant
  double explained = 0.0;       ///< 1 - cost / (cost of the best constant); nan if y is constant
};

struct CalibrationResult {
  LeastSquaresSolution solution;
  Uncertainty uncertainty;
  std::vector<Interval> intervals;                     ///< of the parameters; nan if there is none
  IntervalMethod method = IntervalMethod::covariance;  ///< method by which the intervals were found
  std::string method_reason;                           ///< why this method: a clause
  std::optional<ResidualTests> residual_tests;         ///< none for few rows, and for an exact fit
  ModelFits procedures;             ///< fits by the model's own procedures, and this fit by their measures; empty if
                                    ///< the model has none
  FittedCurve fit;                  ///< at the rows of the data
  std::vector<double> weights;      ///< of all rows; those of noise in proportion to y follow from the fit
  std::vector<FittedCurve> curves;  ///< one for each measured curve, with points in between
  std::size_t points = 0;           ///< rows that count
  std::size_t program_steps = 0;    ///< steps of the loading made from the data
  GoodnessOfFit goodness;
  std::vector<double> particle;       ///< displacement at the particle in every row; empty if the machine adds none
  std::vector<std::string> notes;     ///< notes for the user
  std::vector<std::string> warnings;  ///< why the fit is not to be trusted, with the likely cause

  /// True if the data determine an interval of any parameter.
  [[nodiscard]] bool has_intervals() const {
    return std::ranges::any_of(intervals, [](const Interval& interval) { return std::isfinite(interval.lower); });
  }
};

/// Least share of the variation of y that a good fit explains; a fit below it causes a warning. The share is R^2 if the
/// loss is linear and the weights are equal.
inline constexpr double k_least_explained = 0.9;

/// Largest size of a file of data [byte].
inline constexpr std::size_t k_largest_data = 16U * 1024U * 1024U;

/// Largest share of the rows without a number in x, y or the weights.
inline constexpr double k_most_missing = 0.1;

/// Fits, and searches for the cause of a bad fit in units, signs and first touch. @throws ScenarioError if the scenario
/// cannot follow the data with any of the parameters tried
[[nodiscard]] CalibrationResult calibrate(const Calibration& calibration,
                                          const LeastSquaresProblem::Progress& progress = {});

/// Response of the best fit in every row. Computes no uncertainty, and does not search for the cause of a bad fit.
/// @return none if the scenario cannot follow the data with any of the parameters tried
[[nodiscard]] std::optional<std::vector<double>> best_response(const Calibration& calibration);

/// The scenario's text with the fitted numbers, to 17 digits, the overrides that all curves share, and its own loading;
/// the rest as its author wrote it.
[[nodiscard]] std::string fitted_scenario_text(const Calibration& calibration, const CalibrationResult& result);

/// Texts of the files that this scenario names, which lie beside it.
[[nodiscard]] FileTexts fitted_scenario_files(const Calibration& calibration);

/// Parameters, intervals, correlations and residuals as text for the terminal.
[[nodiscard]] std::string calibration_text(const Calibration& calibration, const CalibrationResult& result);

/// Content of fit.csv: data, fit, residuals, confidence band and weights, row by row; with a machine, the data without
/// what it adds, too.
[[nodiscard]] Table fit_table(const Calibration& calibration, const CalibrationResult& result);

/// Content of calibration.json: parameters, covariance, statistics and data. Undefined numbers are null.
[[nodiscard]] std::string calibration_json(const Calibration& calibration, const CalibrationResult& result);

/// File that marks a folder as one of a calibration.
inline constexpr const char* k_calibration_marker = "calibration.json";
/// Other files that every such folder has.
inline constexpr std::array<std::string_view, 2> k_calibration_tables{"fit.csv", "fitted.toml"};

/// Columns of fit.csv that are the data without what the machine adds.
inline constexpr const char* k_particle_displacement = "particle_displacement";
inline constexpr const char* k_particle_force = "particle_force";

/// Line of a fitted scenario that a machine was part of the fit.
inline constexpr const char* k_without_machine =
    "Displacement and force are the particle's, without what the machine adds: those of fit.csv";

/// Writes fit.csv, fitted.toml with the tables it names, calibration.json and a figure with its script and data; all of
/// them or none.
/// @param folder      made with k_calibration_marker
/// @param has_report  true: writes report.md and report.pdf, too
/// @param format      of the figure, one of figure::k_formats
/// @return why there is no figure; empty: there is one
/// @throws std::runtime_error naming what could not be written
[[nodiscard]] std::string write_calibration(const Calibration& calibration, const CalibrationResult& result,
                                            StagedFolder& folder, bool has_report = false,
                                            std::string_view format = figure::k_usual_format);

}  // namespace monograin
