#include "study/sweep/planned_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include "scenario/words.hpp"
#include "study/sweep/sampling.hpp"
#include "study/sweep/sweep_language.hpp"

namespace monograin::sweep {
namespace {

constexpr double k_most_maxpro_runs = 1e5;

}  // namespace

/// Values of a run in SI, which needs the run's radius.
std::vector<SweepValue> PlannedRuns::resolved(std::span<const FactorValue> values) const {
  double radius = radius_;
  for (std::size_t f = 0; f < factors_.size(); ++f) {
    if (factors_[f].key == "particle.radius") radius = values[f].number;
  }
  std::vector<SweepValue> run;
  for (std::size_t f = 0; f < factors_.size(); ++f) {
    if (factors_[f].is_number()) {
      run.emplace_back(values[f].is_in_radii ? values[f].number * radius : values[f].number);
    } else {
      run.emplace_back(values[f].word);
    }
  }
  return run;
}

/// Values at a point of the cube, and at a level of the product of all lists, whose last one changes fastest.
std::vector<FactorValue> PlannedRuns::values_at(std::span<const double> point, std::size_t level) const {
  std::vector<FactorValue> values(factors_.size());
  std::size_t axis = point.size();
  for (std::size_t f = factors_.size(); f-- > 0;) {
    const Factor& factor = factors_[f];
    if (factor.range) {
      values[f] = factor.range->at(point[--axis]);
    } else {
      values[f] = factor.values[level % factor.values.size()];
      level /= factor.values.size();
    }
  }
  return values;
}

/// Adds a run, or leaves its point out if it breaks a constraint.
void PlannedRuns::add_if_allowed(std::span<const FactorValue> values) {
  const std::vector<SweepValue> run = resolved(values);
  if (broken_constraint(constraints_, factors_, run) == nullptr) {
    runs_.add(run);
  } else {
    ++left_out_;
  }
}

void PlannedRuns::make_grid() {
  double count = 1.0;
  for (Factor& factor : factors_) {
    if (const std::optional<FactorRange> range = std::exchange(factor.range, std::nullopt)) {
      for (int i = 0; i < range->points; ++i) {
        factor.values.push_back(range->at(static_cast<double>(i) / (range->points - 1)));
      }
    }
    count *= static_cast<double>(factor.values.size());
  }
  if (count > k_most_runs) {
    faults_.add(factors_.front().where,
                fmt::format("the grid has {:g} points; expected at most {:g}", count, k_most_runs));
    return;
  }
  for (std::size_t point = 0; point < static_cast<std::size_t>(count); ++point) add_if_allowed(values_at({}, point));
  if (runs_.size() == 0) faults_.add(constraints_.front().where, "no point of the grid meets the constraints");
}

void PlannedRuns::make_maxpro(std::uint64_t seed) {
  DesignSpace space{.factors = 0, .level_count = 0};
  std::size_t combinations = 1;
  for (const Factor& factor : factors_) {
    if (factor.range) {
      ++space.factors;
    } else {
      combinations *= factor.values.size();
      space.level_count = combinations;
    }
  }
  const std::size_t runs = count_of("runs");
  if (space.factors == 0) {
    faults_.add(factors_.front().where, fmt::format("a space-filling design needs a range, for example {}; for lists "
                                                    "alone take design = \"grid\"",
                                                    k_example_range));
  }
  if (static_cast<double>(runs) > k_most_maxpro_runs) {
    faults_.add(root_.value_place("runs"), fmt::format("runs = {}: expected at most {:g} of this design, whose time "
                                                       "grows as their square",
                                                       runs, k_most_maxpro_runs));
  }
  if (runs % combinations != 0) {
    faults_.add(root_.value_place("runs"),
                fmt::format("runs = {}: expected a multiple of {}, the number of combinations of listed values", runs,
                            combinations));
  }
  if (faults_.size() > 0) return;
  if (!constraints_.empty()) {
    space.contains = [this](std::span<const double> point) {
      return broken_constraint(constraints_, factors_, resolved(values_at(point, 0))) == nullptr;
    };
  }
  try {
    points_ = maxpro_design(space, runs, seed);
  } catch (const std::domain_error& error) {
    faults_.add(root_.value_place(constraints_.empty() ? "runs" : "constraints"), error.what());
    return;
  }
  for (std::size_t i = 0; i < runs; ++i) {
    runs_.add(resolved(values_at(points_.point(i), points_.levels.empty() ? 0 : points_.levels[i])));
  }
}

void PlannedRuns::make_samples(std::string_view design, std::uint64_t seed, const std::optional<JointFactors>& joint) {
  const std::size_t count = factors_.size();
  const bool is_for_indices = is_one_of(design, k_index_designs);
  const bool is_saltelli = design == "saltelli";
  if (is_for_indices && !constraints_.empty()) {
    faults_.add(constraints_.front().where, "the points of this design depend on each other: it has no constraints");
  }
  const std::size_t dimensions = count * (is_saltelli ? 2 : 1);
  if ((is_saltelli || design == "sobol" || design == "halton") && dimensions > k_most_sobol_dimensions) {
    faults_.add(factors_.front().where, fmt::format("{} keys are varied; expected at most {}", count,
                                                    k_most_sobol_dimensions * count / dimensions));
  }
  const std::size_t samples = count_of(is_for_indices ? "samples" : "runs");
  const std::size_t each = is_saltelli ? count + 2 : design == "morris" ? count + 1 : 1;
  if (static_cast<double>(samples * each) > k_most_runs) {
    faults_.add(root_.value_place("samples"),
                fmt::format("{} runs for each of {} samples; expected at most {:g} runs", each, samples, k_most_runs));
  }
  if (faults_.size() > 0) return;
  points_ = is_saltelli          ? saltelli_design(count, samples, seed)
            : design == "morris" ? morris_design(count, samples, seed)
                                 : sampled_design(design, count, samples, seed);
  std::vector<FactorValue> values(count);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const std::span<const double> point = points_.point(i);
    std::vector<double> shares(point.begin(), point.end());
    if (joint) joint->distribution.correlate(std::span(shares).subspan(joint->first));
    for (std::size_t f = 0; f < count; ++f) values[f] = factors_[f].at(shares[f]);
    add_if_allowed(values);
  }
  if (runs_.size() == 0) faults_.add(constraints_.front().where, "no point of the design meets the constraints");
  if (left_out_ > 0) points_ = {};  // the remaining points fill another space
}

/// Values of a row; none, with a fault, if a cell cannot be read.
std::optional<std::vector<FactorValue>> PlannedRuns::values_of_row(const std::vector<DesignTable::Cell>& row,
                                                                   std::span<const std::string> units) {
  std::vector<FactorValue> values;
  for (std::size_t f = 0; f < row.size(); ++f) {
    const Factor& factor = factors_[f];
    const auto report = [&](std::string_view problem) {
      faults_.add(row[f].where, fmt::format("{} = {}: {}", factor.key, shown(row[f].text), problem));
    };
    const auto [value, problem] = read_value(factor.spec, row[f].text, units[f]);
    if (!value) {
      report(problem);
      return std::nullopt;
    }
    if (!factor.admits(*value)) report("is outside of what [vary] gives for this key");
    values.push_back(*value);
  }
  return values;
}

void PlannedRuns::make_rows(const DesignTable& table, std::span<const std::string> units) {
  std::vector<std::vector<FactorValue>> rows;
  for (const auto& cells : table.rows) {
    if (faults_.size() >= k_most_shown_faults) break;
    std::optional<std::vector<FactorValue>> values = values_of_row(cells, units);
    if (!values) continue;
    const std::vector<SweepValue> run = resolved(*values);
    if (const PlacedConstraint* broken = broken_constraint(constraints_, factors_, run)) {
      faults_.add(cells.front().where, fmt::format("the row breaks the constraint \"{}\"", broken->text));
    }
    rows.push_back(std::move(*values));
    runs_.add(run);
  }
  for (std::size_t f = 0; f < factors_.size(); ++f) {
    for (const auto* row : {&table.rows.front(), &table.rows.back()}) {
      const std::string& cell = (*row)[f].text;
      factors_[f].ends.push_back(units[f].empty() ? cell : in_quotes(fmt::format("{} {}", cell, units[f])));
    }
  }
  if (faults_.size() == 0) points_ = points_of(rows);
}

/// The rows of a table as points of the cube. A number is scaled between the ends that [vary] gives, else between its
/// own smallest and largest value; words and listed values are levels.
Design PlannedRuns::points_of(const std::vector<std::vector<FactorValue>>& rows) const {
  Design design{.factors = 0, .level_count = 0};
  std::vector<std::optional<FactorRange>> ranges;
  for (std::size_t f = 0; f < factors_.size(); ++f) {
    const Factor& factor = factors_[f];
    std::optional<FactorRange> range = factor.range;
    if (!range && factor.is_number() && factor.values.empty()) {
      const auto [least, most] = std::ranges::minmax(rows, {}, [f](const auto& row) { return row[f].number; });
      range = FactorRange{.from = least[f], .to = most[f]};
    }
    if (range) ++design.factors;
    ranges.push_back(std::move(range));
  }
  std::map<std::vector<FactorValue>, std::size_t> levels;
  for (const std::vector<FactorValue>& row : rows) {
    std::vector<FactorValue> listed_values;
    for (std::size_t f = 0; f < factors_.size(); ++f) {
      if (ranges[f]) {
        design.coordinates.push_back(ranges[f]->share_of(row[f].number));
      } else {
        listed_values.push_back(row[f]);
      }
    }
    if (design.factors < factors_.size()) {
      design.levels.push_back(levels.try_emplace(std::move(listed_values), levels.size()).first->second);
    }
  }
  design.level_count = levels.size();
  return design;
}

}  // namespace monograin::sweep
