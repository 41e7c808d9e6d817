// Reading of calibration files.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>
#include <utility>

#include "scenario/document.hpp"
#include "scenario/measured_data.hpp"
#include "scenario/plain_paths.hpp"
#include "scenario/section.hpp"
#include "scenario/text_file.hpp"
#include "scenario/units.hpp"
#include "scenario/words.hpp"
#include "study/calibrate/calibration.hpp"
#include "study/calibrate/calibration_language.hpp"
#include "study/calibrate/data_report.hpp"
#include "study/calibrate/data_section.hpp"
#include "study/calibrate/parameter_section.hpp"
#include "study/calibrate/scenario_section.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;
using namespace calibration;

constexpr std::size_t k_most_zeros = 20;       // of weights, that are reported one by one
constexpr double k_largest_deflection = 10.0;  // of the machine, over the measured travel

class CalibrationReader {
 public:
  CalibrationReader(NamedText source, const FileTexts& data)
      : file_(std::move(source.file)), data_(data), reading_{faults_} {
    made_.text = std::move(source.text);
    made_.file = file_.string();
    made_.name = file_.stem().string();
  }

  Calibration read() {
    const toml::table tree = parse_document(made_.text, made_.file);
    expect_type(tree, made_.file, DocumentType::calibration);
    const bool scenario_is_table = tree["scenario"].is_table();
    const Keys keys = root_keys(scenario_is_table, tree["data"].is_array());
    const SourceLocation top{made_.file};
    const Section root(reading_, {&tree, top, "the calibration"}, keys);
    made_.title = root.text("title");
    has_scenario_ = read_own_scenario(root, scenario_is_table);
    read_fit(root);
    if (root.has("data")) {
      read_data(root);
      check_given_data(root.value_place("data"));
    }
    if (root.has("free") && has_scenario_) {
      made_.free = free_in(reading_, root, {made_.scenario, made_.scenario_text, named_scenario_.file});
    }
    note_overridden();
    if (root.has("prior") && !made_.free.empty()) read_priors(reading_, root, made_.scenario, made_.free);
    faults_.throw_if_any();
    check_lengths(root);
    check_machine(root);
    check_loss(root);
    check_count(root);
    faults_.throw_if_any();
    return std::move(made_);
  }

 private:
  bool read_own_scenario(const Section& root, bool is_table) {
    auto found = scenario_in(reading_, root, is_table, made_.text, made_.file);
    if (!found) return false;
    named_scenario_ = std::move(*found);
    made_.scenario = named_scenario_.checked;
    made_.scenario_text = named_scenario_.text;
    try {
      measurable_ = measurable_in(made_.scenario);
    } catch (const ScenarioError& error) {
      for (const Fault& fault : error.faults()) faults_.add(fault.where, fault.message);
      return false;
    }
    reading_.initial_radius = made_.scenario.radius;
    check_walls(root);
    return true;
  }

  /// Checks the walls: the data give one program, which all moving walls have to follow.
  void check_walls(const Section& root) {
    for (const WallSpec& wall : made_.scenario.loading.walls) {
      if (wall.is_fixed || wall.steps.empty()) continue;
      faults_.add(root.value_place("scenario"),
                  fmt::format("wall '{}' of the scenario has steps of its own, and the data drive all walls alike; "
                              "expected walls that are fixed or follow [[loading.steps]]",
                              wall.name));
    }
    if (measurable_.drives.empty()) faults_.add(root.value_place("scenario"), "the scenario has no wall that moves");
    check_lateral(made_.scenario, root.value_place("scenario"));
  }

  /// Checks the steps: the data replace all of them, and give one direction only.
  void check_lateral(const CheckedScenario& scenario, const SourceLocation& where) {
    const bool has_lateral =
        std::ranges::any_of(scenario.loading.steps, [](const Step& step) { return step.lateral.has_value(); });
    if (!has_lateral) return;
    faults_.add(where,
                "the scenario's steps prescribe the lateral direction too, and the data drive the axial one alone; "
                "expected a scenario whose configuration says what happens laterally: simple, die or hydrostatic");
  }

  void read_fit(const Section& root) {
    const Keys keys = fit_keys();
    const std::size_t before = faults_.size();
    const Section fit(reading_, root.table("fit", "[fit]"), keys);
    if (faults_.size() > before) return;
    const std::string loss = fit.text("loss");
    made_.loss.kind = static_cast<Loss>(std::ranges::find(k_losses, loss) - k_losses.begin());
    made_.loss.scale = fit.number("loss_scale").value_or(1.0);
    made_.confidence = fit.number("confidence").value_or(made_.confidence);
    const std::string intervals = fit.text("intervals");
    made_.intervals = static_cast<IntervalMethod>(std::ranges::find(k_intervals, intervals) - k_intervals.begin());
    const bool is_linear = made_.loss.kind == Loss::linear;
    if (is_linear && fit.has("loss_scale")) {
      faults_.add(fit.key_place("loss_scale"), "key 'loss_scale' is not used by the linear loss");
    } else if (!is_linear && !fit.has("loss_scale")) {
      faults_.add(fit.value_place("loss"), fmt::format("loss = \"{}\" needs a scale; expected for example "
                                                       "loss_scale = 0.01, a share of the largest |y|",
                                                       loss));
    }
  }

  void check_loss(const Section& root) {
    const bool has_noise_of_x =
        std::ranges::any_of(made_.curves, [](const MeasuredCurve& curve) { return curve.noise.x > 0.0; });
    if (made_.loss.kind == Loss::linear || !has_noise_of_x) return;
    faults_.add(root.value_place("fit"),
                fmt::format("loss = \"{}\" with noise of x: errors of turns are those of least squares; expected the "
                            "linear loss, or noise without x",
                            k_losses[static_cast<std::size_t>(made_.loss.kind)]));
  }

  // --- data

  void read_data(const Section& root) {
    const std::vector<Section::Origin> curves = root.tables("data", "[[data]]");
    if (curves.empty()) return read_curve(root.table("data", "[data]"));
    for (const Section::Origin& origin : curves) read_curve(origin);
  }

  void read_curve(const Section::Origin& origin) {
    const DataKinds kinds = kinds_of(*origin.table);
    const Keys keys = data_keys(kinds);
    const std::size_t before = faults_.size();
    const auto has_failed = [&] { return faults_.size() > before; };
    const Section data(reading_, origin, keys);
    const bool keys_are_known = !has_failed();
    const bool has_noise = data.has(k_noise);
    const std::string weighting = weighting_of(data);
    std::vector<ColumnSpec> specs{column_spec(reading_, data, "x", kinds.x), column_spec(reading_, data, "y", kinds.y)};
    if (weighting == "column") {
      if (!data.has_or_misspells("weight_column")) {
        faults_.add(data.value_place("weights"),
                    "weights = \"column\" needs the column; expected for example weight_column = \"weight[-]\"");
      }
      specs.push_back(column_spec(reading_, data, "weight_column", kinds.weight_column));
    } else if (keys_are_known && data.has("weight_column")) {
      faults_.add(data.key_place("weight_column"),
                  fmt::format("key 'weight_column' belongs to weights = \"column\"; this is \"{}\"", weighting));
    }
    const std::optional<ColumnSpec> deviations = has_noise ? noise_column_in(data) : std::nullopt;
    if (deviations) specs.push_back(*deviations);

    MeasuredCurve curve;
    const std::optional<MeasuredData> measured = read_file(data, kinds, specs, curve);
    if (!measured) return;
    curve.machine = machine_in(reading_, data, kinds.compliance, file_.parent_path());
    curve.overrides = data.texts("set");
    curve.scales = {specs[0].scale, specs[1].scale};
    take_scenario(data, curve);
    const MeasuredQuantity x = quantity(specs[0], measured->columns[0]);
    const MeasuredQuantity y = quantity(specs[1], measured->columns[1]);
    if (!x.observable.empty()) check_drive(specs[0], x, curve);
    std::vector<double> weights;
    if (!has_failed() && !y.values.empty()) {
      if (has_noise) {
        curve.noise = read_noise(reading_, data, dimension_of(x.si).value_or(Dimension::none),
                                 dimension_of(y.si).value_or(Dimension::none));
      }
      if (!has_failed()) {
        weights = has_noise ? weights_by_noise(deviations ? &*deviations : nullptr, *measured, y, curve)
                            : weights_of(*measured, x, y, curve.file);
      }
    }
    if (has_failed()) return;
    curve.begin = made_.lines.size();
    curve.end = curve.begin + measured->lines.size();
    append(measured->lines, made_.lines);
    append(weights, made_.weights);
    add_quantity(x, specs[0], made_.x);
    add_quantity(y, specs[1], made_.y);
    note_reading(curve, specs, {&x, &y}, measured->columns);
    made_.curves.push_back(std::move(curve));
  }

  /// How the data of a curve are weighted: as those of the first one.
  std::string weighting_of(const Section& data) {
    const bool has_noise = data.has(k_noise);
    if (has_noise && data.has("weights")) {
      faults_.add(data.key_place("weights"),
                  "key 'weights' does not go with 'noise': weights say how the noise is shared, noise how large it is");
    }
    std::string weighting = has_noise ? std::string(k_noise) : data.text("weights");
    if (made_.curves.empty()) made_.weighting = weighting;
    if (weighting != made_.weighting) {
      faults_.add(data.value_place("weights"),
                  fmt::format("weights = \"{}\": those of the first curve are \"{}\"; expected the same for all",
                              weighting, made_.weighting));
    }
    return weighting;
  }

  /// Reads the file of a curve; none if there is none.
  std::optional<MeasuredData> read_file(const Section& data, const DataKinds& kinds,
                                        const std::vector<ColumnSpec>& specs, MeasuredCurve& curve) {
    const std::string name = data.text("file");
    if (name.empty()) return {};
    data_files_.push_back(name);
    const fs::path path = file_.parent_path() / name;
    const auto [text, problem] = text_of_data(name, path);
    if (!problem.empty()) {
      faults_.add(data.value_place("file"),
                  fmt::format("file = \"{}\": {} ({}); expected a table, such as CSV, its path relative to this file",
                              shown(name), problem, on_one_line(path.string())));
      return {};
    }
    curve.file = path.string();
    std::vector<ColumnRequest> wanted;
    for (const ColumnSpec& spec : specs) wanted.push_back(spec.request);
    MeasuredData measured = parse_measured(text, curve.file, wanted, faults_, format_of(reading_, data, kinds));
    curve.text = std::move(measured.text);
    curve.layout = std::move(measured.layout);
    curve.columns = {measured.columns[0].number, measured.columns[1].number};
    curve.left_out = std::move(measured.left_out);
    curve.trailer = std::move(measured.trailer);
    return measured;
  }

  /// Checks that the data use all texts that were given for them.
  void check_given_data(const SourceLocation& where) {
    for (const auto& [name, text] : data_) {
      if (std::ranges::find(data_files_, name) != data_files_.end()) continue;
      faults_.add(where, fmt::format("'{}' was given as data in memory, but no data have this file; expected the name "
                                     "of one of theirs{}",
                                     shown(name),
                                     data_files_.empty() ? "" : fmt::format(": '{}'", fmt::join(data_files_, "', '"))));
    }
  }

  /// Text of a file of data, or why there is none.
  [[nodiscard]] FileText text_of_data(const std::string& name, const fs::path& path) const {
    const auto given = data_.find(name);
    if (path.extension() == ".toml") return {{}, "this is a TOML file, not measured data"};
    FileText read = given != data_.end() ? FileText{given->second, {}} : read_text_file(path, k_largest_data);
    if (read.problem.empty() && read.text.size() > k_largest_data) {
      read.problem = fmt::format("the file is too large; expected at most {} MiB", k_largest_data >> 20U);
    }
    return read;
  }

  template <class T>
  static void append(const std::vector<T>& part, std::vector<T>& whole) {
    whole.insert(whole.end(), part.begin(), part.end());
  }

  /// Takes a column of a further curve. Residuals can be combined only if all curves measure one quantity.
  void add_quantity(const MeasuredQuantity& added, const ColumnSpec& spec, MeasuredQuantity& quantity) {
    if (made_.curves.empty()) {
      quantity = added;
    } else if (added.observable != quantity.observable) {
      faults_.add(spec.quantity_at, fmt::format("'{}' is not what the first curve has, '{}'; expected the same columns",
                                                added.observable, quantity.observable));
    } else {
      append(added.values, quantity.values);
    }
  }

  /// Takes the scenario with the curve's overrides, and the quantities that can be measured in it.
  void take_scenario(const Section& data, MeasuredCurve& curve) {
    if (!has_scenario_) return;
    try {
      curve.scenario = curve.overrides.empty() ? made_.scenario : named_scenario_.with(curve.overrides);
      measurable_ = measurable_in(curve.scenario);
      if (!curve.overrides.empty()) check_lateral(curve.scenario, data.value_place("set"));
    } catch (const ScenarioError& error) {
      for (const Fault& fault : error.faults()) faults_.add(data.value_place("set"), fault.message);
      return;
    }
    if (curve.scenario.model != made_.scenario.model) {
      faults_.add(data.value_place("set"),
                  fmt::format("the scenario's model is '{}'; expected the same for every curve", made_.scenario.model));
    }
  }

  /// A column in SI; without an observable if the column or the scenario has a fault.
  [[nodiscard]] MeasuredQuantity quantity(const ColumnSpec& spec, const MeasuredColumn& column) {
    MeasuredQuantity result;
    if (column.number == 0 || !has_scenario_ || measurable_.drives.empty()) return result;
    const std::string name = spec.quantity.empty() ? std::string(name_in(column.heading)) : spec.quantity;
    if (name.empty()) {
      faults_.add(spec.quantity_at,
                  fmt::format("{}: the column has no heading that says what it holds; expected for example {{ column = "
                              "{}, quantity = \"displacement\", unit = \"mm\" }}",
                              spec.request.naming, column.number));
      return result;
    }
    const Measurable::Column* found = measurable_.find(measurable_.prefix() + name);
    if (found == nullptr) found = measurable_.find(name);
    if (found == nullptr) {
      unknown_quantity(name, spec);
      return result;
    }
    result.unit = spec.unit.empty() ? column.unit : spec.unit;
    result.si = found->unit;
    const auto factor = unit_factor(result, spec);
    if (!factor) return result;
    result.unit_factor = *factor;
    result.observable = found->name;
    result.values = column.values;
    for (double& value : result.values) value *= *factor * spec.scale;
    return result;
  }

  void unknown_quantity(const std::string& name, const ColumnSpec& spec) {
    const std::string own = measurable_.prefix();
    std::vector<std::string_view> names;
    for (const Measurable::Column& column : measurable_.columns) {
      std::string_view known = column.name;
      if (known.starts_with(own)) known.remove_prefix(own.size());
      names.push_back(known);
    }
    const std::string hint = did_you_mean(name, names);
    faults_.add(
        spec.quantity_at,
        fmt::format("'{}' is no quantity of this scenario; expected one of {}{}{}", shown(name), listed(names), hint,
                    spec.quantity.empty() ? ", or { column = \"...\", quantity = \"...\", unit = \"...\" }" : ""));
  }

  [[nodiscard]] std::optional<double> unit_factor(const MeasuredQuantity& column, const ColumnSpec& spec) {
    if (column.unit == column.si) return 1.0;
    const auto dimension = dimension_of(column.si);
    if (!dimension) {
      faults_.add(spec.unit_at, fmt::format("unknown unit '{}'; expected '{}'", shown(column.unit), column.si));
      return std::nullopt;
    }
    const ParsedQuantity one = parse_quantity("1 " + column.unit, *dimension, made_.scenario.radius);
    if (!one.value) {
      const std::string_view noun = dimension_info(*dimension).noun;
      faults_.add(
          spec.unit_at,
          column.unit.empty()
              ? fmt::format("{}: the heading has no unit; expected {} such as '{}[{}]', or {{ column = \"...\", "
                            "quantity = \"...\", unit = \"...\" }}",
                            spec.request.naming, noun, shown(spec.request.name), column.si)
              : fmt::format("{}: {}", spec.request.naming, one.problem));
    }
    return one.value;
  }

  // --- lengths of the scenario

  [[nodiscard]] bool is_free(std::string_view path) const {
    return std::ranges::any_of(made_.free, [&](const FreeParameter& free) {
      const std::vector<std::string> paths = plain_paths(free.key.path);
      return std::ranges::find(paths, path) != paths.end();
    });
  }

  /// Displacements count from first touch, whatever the gap before it: no fitted gap can belong to the driven wall.
  void check_lengths(const Section& root) {
    for (MeasuredCurve& curve : made_.curves) {
      if (is_free(k_radius_key)) curve.scenario.variants = named_scenario_.variants(curve.overrides);
      const std::vector<WallSpec>& walls = curve.scenario.loading.walls;
      for (std::size_t wall = 0; wall < walls.size(); ++wall) {
        if (walls[wall].name != curve.driven.substr(0, curve.driven.rfind('.')) || !is_free(gap_path(wall))) continue;
        faults_.add(root.value_place("free"),
                    fmt::format("'{}' cannot be free: displacements of wall '{}', which x drives, count from first "
                                "touch; expected \"{}\", or the gap of another wall",
                                gap_path(wall), walls[wall].name, k_offset));
      }
    }
  }

  // --- the machine

  /// Checks that there is a displacement to which the machine adds, and a force that deflects it. Both are known only
  /// when everything is read.
  void check_machine(const Section& root) {
    const auto is_deflecting = [](const MeasuredCurve& curve) {
      return curve.machine.compliance > 0.0 || !curve.machine.forces.empty();
    };
    const bool has_compliance = std::ranges::any_of(made_.curves, is_deflecting);
    const bool has_offset =
        std::ranges::any_of(made_.curves, [](const MeasuredCurve& curve) { return curve.machine.offset != 0.0; });
    const bool has_force_offset =
        std::ranges::any_of(made_.curves, [](const MeasuredCurve& curve) { return curve.machine.force_offset != 0.0; });
    for (const auto& [path, is_given] : {std::pair(k_offset, has_offset), std::pair(k_force_offset, has_force_offset),
                                         std::pair(k_compliance, has_compliance)}) {
      if (is_given && is_free(path)) {
        faults_.add(root.value_place("free"),
                    fmt::format("'{}' is free and given in [data]; expected one of them", path));
      }
    }
    const std::string& x = made_.x.observable;
    const std::string& y = made_.y.observable;
    constexpr std::string_view k_displacement = ".displacement";
    const bool has_displacement = x.ends_with(k_displacement) || y.ends_with(k_displacement);
    const std::string& moved = x.ends_with(k_displacement) ? x : y;
    const std::string& other = x.ends_with(k_displacement) ? y : x;
    const bool has_both = has_displacement && other == moved.substr(0, moved.rfind('.')) + ".force";
    if ((has_compliance || is_free(k_compliance)) && !has_both) {
      faults_.add(
          root.value_place("data"),
          fmt::format("a compliance takes force and displacement of the same walls; x and y are '{}' and '{}'", x, y));
    } else if ((has_offset || is_free(k_offset)) && !has_displacement) {
      faults_.add(root.value_place("data"),
                  fmt::format("an offset takes a displacement; x and y are '{}' and '{}'", x, y));
    } else if ((has_force_offset || is_free(k_force_offset)) && !x.ends_with(".force") && !y.ends_with(".force")) {
      faults_.add(root.value_place("data"),
                  fmt::format("a force_offset takes a force; x and y are '{}' and '{}'", x, y));
    }
    if (has_both) {
      check_deflections(root.value_place("data"), x.ends_with(k_displacement) ? made_.x.values : made_.y.values,
                        x.ends_with(k_displacement) ? made_.y.values : made_.x.values);
    }
  }

  /// Reports a frame that would yield by far more than what was measured together with the particle.
  void check_deflections(const SourceLocation& where, const std::vector<double>& displacements,
                         const std::vector<double>& forces) {
    for (const MeasuredCurve& curve : made_.curves) {
      const auto [least, most] = std::ranges::minmax(curve.rows_of(forces));
      const auto [first, last] = std::ranges::minmax(curve.rows_of(displacements));
      const double deflection = std::abs(curve.machine.addition(most) - curve.machine.addition(least));
      if (first == last || deflection <= k_largest_deflection * (last - first)) continue;
      faults_.add(
          where, fmt::format("compliance: the frame would yield by {:.4g} m under the forces of {}, where the measured "
                             "displacement changes by {:.4g} m; expected a compliance below {:.2g} m/N, for example "
                             "\"20 nm/N\"",
                             deflection, on_one_line(curve.file), last - first, (last - first) / (most - least)));
    }
  }

  // --- notes

  void note_reading(const MeasuredCurve& curve, const std::vector<ColumnSpec>& specs,
                    const std::array<const MeasuredQuantity*, 2>& quantities,
                    const std::vector<MeasuredColumn>& columns) {
    const std::string name = on_one_line(fs::path(curve.file).filename().string());
    if (!is_plain(curve.layout)) made_.notes.push_back(fmt::format("{}: {}", name, describe(curve.layout)));
    for (std::size_t k = 0; k < 2; ++k) {
      const std::string& own = columns[k].unit;
      const auto dimension = dimension_of(quantities[k]->si);
      if (specs[k].unit.empty() || !dimension) continue;
      const ParsedQuantity one = parse_quantity("1 " + own, *dimension, std::nullopt);
      if (!one.value || *one.value == quantities[k]->unit_factor) continue;
      made_.notes.push_back(fmt::format("{}: {} says '{}', and the file '{}'; the first was taken", name,
                                        specs[k].request.naming, specs[k].unit, shown(own)));
    }
    if (const std::string text = trailer_text(curve.trailer); !text.empty()) {
      made_.notes.push_back(fmt::format("{}: {} below the table left out", name, text));
    }
    if (curve.left_out.empty()) return;
    made_.notes.push_back(
        fmt::format("{}: {} row{} without a number in x, y or weights left out of {}, the first in line {}", name,
                    curve.left_out.size(), curve.left_out.size() == 1 ? "" : "s",
                    curve.left_out.size() + curve.end - curve.begin, curve.left_out.front()));
  }

  void check_drive(const ColumnSpec& spec, const MeasuredQuantity& x, MeasuredCurve& curve) {
    const auto drive = std::ranges::find(measurable_.drives, x.observable, &Measurable::Drive::column);
    if (drive == measurable_.drives.end()) {
      std::vector<std::string_view> columns;
      for (const Measurable::Drive& possible : measurable_.drives) columns.push_back(possible.column);
      return faults_.add(spec.quantity_at, fmt::format("'{}' cannot drive the particle; expected one of {}",
                                                       x.observable, listed(columns)));
    }
    curve.driven = drive->column;
    curve.control = drive->kind;
    curve.start = drive->start;
    const DataPath path = path_through(x.values);
    if (!path.x.empty() && program_along(path, path.x, curve.control, curve.start).steps.empty()) {
      faults_.add(spec.request.where,
                  fmt::format("{}: it never changes; expected data along a loading path", spec.request.naming));
    }
  }

  [[nodiscard]] std::vector<double> weights_of(const MeasuredData& measured, const MeasuredQuantity& x,
                                               const MeasuredQuantity& quantity, const std::string& file) {
    const std::vector<double>& y = quantity.values;
    double largest = 0.0;
    for (const double value : y) largest = std::max(largest, std::abs(value));
    const auto at = [&](std::size_t row, std::size_t column) {
      return SourceLocation{file, measured.lines[row], measured.columns[column].at[row]};
    };
    if (largest == 0.0) {
      faults_.add(at(0, 1), "y is zero in every row; there is nothing to fit");
      return {};
    }
    std::vector<double> weights(y.size(), 1.0 / largest);
    if (made_.weighting == "area") weigh_by_path(x.values, weights);
    std::size_t found = 0;
    for (std::size_t row = 0; row < y.size() && found < k_most_zeros; ++row) {
      if (made_.weighting == "relative") {
        weights[row] = 1.0 / std::abs(y[row]);
        if (y[row] != 0.0) continue;
        ++found;
        faults_.add(at(row, 1), "y = 0 has no relative weight; expected other weights, or a file without this row");
      } else if (made_.weighting == "column") {
        const double factor = measured.columns[2].values[row];
        weights[row] *= factor;
        if (factor >= 0.0) continue;
        ++found;
        faults_.add(at(row, 2),
                    fmt::format("weight = {}: expected 0 (the row only drives the particle) or more", factor));
      }
    }
    return weights;
  }

  /// Notes overrides of a curve that set a parameter of the fit.
  void note_overridden() {
    for (const MeasuredCurve& curve : made_.curves) {
      for (const std::string& text : curve.overrides) {
        const std::string_view path = trimmed(std::string_view(text).substr(0, text.find('=')));
        if (made_.find_free(path) == nullptr) continue;
        made_.notes.push_back(fmt::format("set = '{}' has no effect: [free] has '{}'", shown(text), path));
      }
    }
  }

  /// Weights from the noise: one over the standard deviations.
  /// @param column  with the deviations; null: the curve has their parts
  [[nodiscard]] std::vector<double> weights_by_noise(const ColumnSpec* column, const MeasuredData& measured,
                                                     const MeasuredQuantity& y, const MeasuredCurve& curve) {
    double factor = 0.0;  // unit of the column, and scale of y
    if (column != nullptr) {
      MeasuredQuantity quantity{.unit = measured.columns[2].unit, .si = y.si};
      const std::optional<double> unit = unit_factor(quantity, *column);
      if (!unit) return std::vector<double>(y.values.size(), 1.0);
      factor = *unit * std::abs(curve.scales[1]);
    }
    std::vector<double> weights;
    std::size_t found = 0;
    for (std::size_t row = 0; row < y.values.size() && found < k_most_zeros; ++row) {
      const double deviation = column != nullptr
                                   ? factor * measured.columns[2].values[row]
                                   : std::hypot(curve.noise.absolute, curve.noise.relative * y.values[row]);
      weights.push_back(1.0 / deviation);
      if (deviation > 0.0) continue;
      ++found;
      faults_.add({curve.file, measured.lines[row], measured.columns[column != nullptr ? 2 : 1].at[row]},
                  column != nullptr ? "a standard deviation has to be above zero"
                                    : "y = 0 has no relative noise; expected an absolute part, too");
    }
    return weights;
  }

  /// Square roots of the trapezoidal rule's weights along the path of x; 1 on the mean.
  static void weigh_by_path(const std::vector<double>& x, std::vector<double>& weights) {
    double path = 0.0;
    for (std::size_t row = 1; row < x.size(); ++row) path += std::abs(x[row] - x[row - 1]);
    for (std::size_t row = 0; row < x.size(); ++row) {
      const double before = row > 0 ? std::abs(x[row] - x[row - 1]) : 0.0;
      const double after = row + 1 < x.size() ? std::abs(x[row + 1] - x[row]) : 0.0;
      weights[row] *= std::sqrt(0.5 * (before + after) / path * static_cast<double>(x.size()));
    }
  }

  void check_count(const Section& root) {
    const std::size_t points = made_.counted();
    if (points >= made_.free.size()) return;
    faults_.add(root.value_place("free"),
                fmt::format("{} parameters cannot be fitted to {} point{}; expected at least as many points",
                            made_.free.size(), points, points == 1 ? "" : "s"));
  }

  fs::path file_;
  const FileTexts& data_;
  std::vector<std::string> data_files_;  ///< names of the files of data, as the calibration has them
  FaultList faults_;
  Reading reading_;
  Calibration made_;
  NamedScenario named_scenario_;
  Measurable measurable_;
  bool has_scenario_ = false;
};

}  // namespace

Calibration read_calibration(const fs::path& file) {
  return parse_calibration(read_named_text(file, "a calibration file"));
}

Calibration parse_calibration(NamedText source, const FileTexts& data) {
  return CalibrationReader(std::move(source), data).read();
}

}  // namespace monograin
