/// Materials and reference data for the tests of the plastic laws.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <ostream>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "history/table.hpp"
#include "models/accuracy.hpp"
#include "plastic/compression.hpp"
#include "support/refusal.hpp"

namespace monograin::plastic {

inline constexpr std::array k_configurations{Configuration::simple, Configuration::die, Configuration::hydrostatic};

inline std::ostream& operator<<(std::ostream& out, Configuration configuration) { return out << name(configuration); }
inline std::ostream& operator<<(std::ostream& out, Regime regime) { return out << name(regime); }

inline Table reference(const std::string& folder, const std::string& file) {
  return read_csv(MONOGRAIN_SOURCE_DIR "/tests/models/" + folder + "/reference/" + file + ".csv");
}

/// The number at the beginning of a header line; a unit may follow.
inline double header_number(const Table& table, std::string_view key) {
  return std::stod(std::string(table.header_value(key)));
}

/// A cell as a word, even if all cells of the column are numbers.
inline std::string word(const Table& table, std::size_t row, std::string_view column) {
  return std::string(table.word(row, table.find(column).value()));
}

/// A cell as a number, even if the column has blank cells, which give NaN.
inline double number(const Table& table, std::size_t row, std::string_view column) {
  const std::size_t index = table.find(column).value();
  if (!table.columns()[index].holds_words()) return table.at(row, index);
  const std::string cell(table.word(row, index));
  return cell.empty() ? std::numeric_limits<double>::quiet_NaN() : std::stod(cell);
}

/// actual - expected| over |expected| plus a scale, because `expected` may vanish; 0 if both are equal.
inline double scaled_error(double actual, double expected, double scale) {
  return actual == expected ? 0.0 : std::abs(actual - expected) / (std::abs(expected) + scale);
}

/// A regime of a law with the boundaries beside it.
struct Stretch {
  Regime regime;
  double begin, end;
};

template <class Law>
std::vector<Stretch> stretches(const Law& law, Regime first, double end) {
  std::vector<Stretch> list;
  double begin = 0.0;
  Regime regime = first;
  for (const Boundary& boundary : boundaries(law)) {
    list.push_back({regime, begin, boundary.approach});
    begin = boundary.approach;
    regime = boundary.beyond;
  }
  if (regime != Regime::undefined) list.push_back({regime, begin, end});
  return list;
}

/// Deviation of a law from a continuous value and slope where its regimes join.
struct JointError {
  double pressure = 0.0, slope = 0.0, radius = 0.0;

  void include(const ContactState& before, const ContactState& after, double approach) {
    pressure = std::max(pressure, relative_error(after.pressure, before.pressure));
    slope = std::max(slope,
                     scaled_error(after.pressure_by_approach, before.pressure_by_approach, before.pressure / approach));
    radius = std::max(radius, relative_error(after.contact_radius, before.contact_radius));
  }
};

template <class Law>
JointError joint_error(const Law& law, const std::vector<Stretch>& list) {
  JointError error;
  for (std::size_t i = 1; i < list.size(); ++i) {
    const double approach = list[i].begin;
    error.include(state_in(law, list[i - 1].regime, approach), state_in(law, list[i].regime, approach), approach);
  }
  return error;
}

/// A random number, uniform in the logarithm.
template <class Generator>
double log_uniform(Generator& generator, double lower, double upper) {
  return std::exp(std::uniform_real_distribution(std::log(lower), std::log(upper))(generator));
}

template <class Generator>
double uniform(Generator& generator, double lower, double upper) {
  return std::uniform_real_distribution(lower, upper)(generator);
}

}  // namespace monograin::plastic
