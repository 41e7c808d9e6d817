#include "scenario/course_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "scenario/cells.hpp"
#include "scenario/measured_data.hpp"
#include "scenario/text_file.hpp"
#include "scenario/units.hpp"
#include "scenario/words.hpp"

namespace monograin {
namespace {

constexpr int k_ramps_per_quarter =
    16;  // of a sine; a ramp of 1/64 cycle is within 1 - cos(pi/64) = 0.12 % of the amplitude
constexpr int k_ramps_per_cycle = 4 * k_ramps_per_quarter;

/// Instant of a course and the value there [SI].
struct Point {
  double time = 0.0;
  double value = 0.0;
  bool is_corner = true;
};

/// Adds points where the value passes zero upwards: a contact that is lost under a negative force is made again there.
/// The first ramp has none. Only a run shows where it begins, and it begins below zero with a closed contact only.
std::vector<Point> with_zeros(const std::vector<Point>& points) {
  std::vector<Point> result;
  Point last;
  for (const Point& point : points) {
    if (last.value < 0.0 && point.value > 0.0) {
      const double time = std::lerp(last.time, point.time, last.value / (last.value - point.value));
      if (time > last.time && time < point.time) result.push_back({.time = time, .value = 0.0, .is_corner = false});
    }
    result.push_back(last = point);
  }
  return result;
}

/// Ramps from point to point.
/// @param start  value at time 0; none where the course begins with a ramp from the present value
std::vector<Step> ramps_through(std::vector<Point> points, std::optional<double> start, Control control) {
  if (control == Control::force) points = with_zeros(points);
  const double end = points.empty() ? 0.0 : points.back().time;
  std::vector<Step> ramps;
  Point last;
  for (const Point& point : points) {
    Step& ramp = ramps.emplace_back();
    ramp.target = point.value;
    ramp.duration = point.time - last.time;
    ramp.leg = {last.time / end, point.time / end, last.is_corner, last.time, point.time};
    last = point;
  }
  if (!ramps.empty()) ramps.front().start = start;
  return ramps;
}

/// sin(2 pi k / k_ramps_per_cycle), with equal digits in every quarter, and 0 and 1 exactly.
double sine_at(int k) {
  const int within = k % k_ramps_per_quarter;
  const int quarter = k / k_ramps_per_quarter % 4;
  const int rising = quarter % 2 == 0 ? within : k_ramps_per_quarter - within;
  const double sine = std::sin(std::numbers::pi / 2.0 * rising / k_ramps_per_quarter);
  return quarter < 2 ? sine : 0.0 - sine;
}

std::vector<Step> read_sine(Reading& reading, const Section& course, const CourseForm& form, Control control) {
  if (!course.has_table("sine")) return {};
  const Section sine(reading, course.table("sine", "sine"), form.in_sine);
  const auto mean = sine.number("mean");
  const auto amplitude = sine.number("amplitude");
  const auto frequency = sine.number("frequency");
  const auto cycles = sine.number("cycles");
  if (!mean || !amplitude || !frequency || !cycles) return {};
  if (*cycles * k_ramps_per_cycle > k_most_steps) {
    reading.faults.add(sine.value_place("cycles"),
                       fmt::format("cycles = {}: expected at most {}, {} ramps each", *cycles,
                                   k_most_steps / k_ramps_per_cycle, k_ramps_per_cycle));
    return {};
  }
  std::vector<Point> points;
  for (int k = 1; k <= static_cast<int>(*cycles) * k_ramps_per_cycle; ++k) {
    const bool is_turn = k % (2 * k_ramps_per_quarter) == k_ramps_per_quarter;
    points.push_back({k / (k_ramps_per_cycle * *frequency), *mean + *amplitude * sine_at(k), is_turn});
  }
  return ramps_through(std::move(points), *mean, control);
}

/// Reads a table of a file.
class TableReader {
 public:
  TableReader(Reading& reading, const Section& course, const KeySpec& value, Control control)
      : reading_(reading), course_(course), value_(value), control_(control), name_(course.text("table")) {}

  std::vector<Step> read(FileTexts& files) {
    const FileText file = text_of_file(reading_, name_, k_largest_text);
    if (!file.problem.empty()) return fault_of_name(file.problem);
    if (file.text.size() > k_largest_text) {
      return fault_of_name(fmt::format("the file is larger than {} MiB", k_largest_text >> 20U));
    }
    files.insert_or_assign(name_, file.text);
    const std::size_t before = reading_.faults.size();
    data_ = parse_measured(file.text, origin_, {request("time"), request("value")}, reading_.faults,
                           {.may_have_trailer = false});
    if (reading_.faults.size() > before) return {};
    const auto to_seconds = factor_of(0, Dimension::time);
    const auto to_si = factor_of(1, value_.dimension);
    if (!to_seconds || !to_si) return {};
    std::vector<Point> points = points_of(*to_seconds, *to_si);
    if (reading_.faults.size() > before) return {};
    if (data_.columns[1].unit.empty()) doubt_missing_unit_of(points);
    std::optional<double> start;
    if (points.front().time == 0.0) {
      start = points.front().value;
      points.erase(points.begin());
    }
    if (!points.empty()) return ramps_through(std::move(points), start, control_);
    fault(0, 0, "the table ends where it begins; expected a later row");
    return {};
  }

 private:
  [[nodiscard]] ColumnRequest request(std::string_view key) const {
    const std::optional<double> number = course_.column_number(key);
    if (!number) {
      const std::string name = course_.text(key);
      return {name, course_.value_place(key), fmt::format("{} = \"{}\"", key, shown(name))};
    }
    return {{}, course_.value_place(key), fmt::format("{} = {}", key, *number), static_cast<std::size_t>(*number)};
  }

  std::vector<Step> fault_of_name(const std::string& problem) {
    reading_.faults.add(course_.value_place("table"),
                        fmt::format("table = \"{}\": {} ({}); expected a table with a row of headings, such as "
                                    "t[s],x[mm], its path relative to the scenario's folder",
                                    shown(name_), problem, on_one_line(origin_)));
    return {};
  }

  /// SI value of a column's unit; a column without one is in SI units.
  std::optional<double> factor_of(std::size_t column, Dimension dimension) {
    const std::string& unit = data_.columns[column].unit;
    if (unit.empty()) return 1.0;
    const ParsedQuantity one = parse_quantity("1 " + unit, dimension, reading_.initial_radius);
    if (one.value) return one.value;
    reading_.faults.add(place_of_unit(data_.columns[column]),
                        fmt::format("column '{}': {}", shown(data_.columns[column].heading), one.problem));
    return std::nullopt;
  }

  /// Doubts the largest value of a column without a unit.
  void doubt_missing_unit_of(const std::vector<Point>& points) {
    const auto largest = std::ranges::max_element(points, {}, [](const Point& point) { return std::abs(point.value); });
    const std::string& heading = data_.columns[1].heading;
    const std::string name = heading.empty() ? fmt::format("column {}", data_.columns[1].number) : shown(heading);
    const std::size_t line = data_.lines[static_cast<std::size_t>(largest - points.begin())];
    doubt_missing_unit(reading_, value_,
                       {fmt::format("{} = {:.6g} ({}, line {})", name, largest->value, shown(name_), line),
                        largest->value, heading.empty() ? "a heading x[" : name + "[", "]"});
  }

  [[nodiscard]] SourceLocation place_of_unit(const MeasuredColumn& column) const {
    const std::size_t number = std::max(data_.layout.heading_line, data_.layout.unit_line);
    std::string_view rest = data_.text;
    std::string_view line;
    for (std::size_t k = 0; k < number; ++k) line = take_line(rest);
    return {origin_, number, cells_of(line, data_.layout.separator)[column.number - 1].column};
  }

  std::vector<Point> points_of(double to_seconds, double to_si) {
    const Range times = plausible_range(Dimension::time, k_not_negative);
    const Range values = finite_range(value_);
    std::vector<Point> points;
    for (std::size_t row = 0; row < data_.lines.size() && found_ < k_most_shown_faults; ++row) {
      const Point point{data_.columns[0].values[row] * to_seconds, data_.columns[1].values[row] * to_si};
      check_range(row, 0, point.time, Dimension::time, times);
      check_range(row, 1, point.value, value_.dimension, values);
      if (!points.empty() && !(point.time > points.back().time)) {
        fault(row, 0, fmt::format("{:.9g} s: not later than the row before; expected ascending times", point.time));
      }
      points.push_back(point);
    }
    return points;
  }

  void check_range(std::size_t row, std::size_t column, double value, Dimension dimension, const Range& range) {
    if (range.contains(value)) return;
    fault(row, column,
          fmt::format("{}: {:.9g} {} is out of range; expected {}", shown(data_.columns[column].heading), value,
                      dimension_info(dimension).si, describe(dimension, range)));
  }

  void fault(std::size_t row, std::size_t column, std::string message) {
    ++found_;
    reading_.faults.add({origin_, data_.lines[row], data_.columns[column].at[row]}, std::move(message));
  }

  Reading& reading_;
  const Section& course_;
  const KeySpec& value_;
  Control control_;
  std::string name_;
  std::string origin_ = (reading_.folder / name_).string();
  MeasuredData data_;
  std::size_t found_ = 0;
};

}  // namespace

std::vector<Step> read_course(Reading& reading, const Section& step, const StepForm& form, FileTexts& files) {
  const std::string label(form.key);
  const Section::Origin origin = step.table(form.key, label);
  const CourseForm& course = *form.course;
  const Control control = control_of(*form.kind).value_or(Control::displacement);
  std::vector<std::string_view> names = names_of(course.table);
  names.emplace_back("sine");
  const auto is_sine = [&](const auto& entry) { return nearest_word(entry.first.str(), names) == "sine"; };
  if (std::ranges::any_of(*origin.table, is_sine))
    return read_sine(reading, Section(reading, origin, course.sine, course.foreign_to_sine), course, control);
  const Section table(reading, origin, course.table);
  const auto names_column = [&](std::string_view key) {
    return table.column_number(key).has_value() || !table.text(key).empty();
  };
  if (table.text("table").empty() || !names_column("time") || !names_column("value")) return {};
  return TableReader(reading, table, form.keys.front(), control).read(files);
}

}  // namespace monograin
