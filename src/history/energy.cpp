#include "history/energy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "scenario/integrators.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

// Bound of the round-off of an overlap over R0: an overlap is a difference of a few lengths of the order of R0.
constexpr double k_overlap_round_off = 16.0 * k_epsilon;

}  // namespace

std::optional<DissipationFall> largest_dissipation_fall(const Table& history, double radius) {
  const auto work = history.find("work");
  const auto stored = history.find("stored_energy");
  if (!work || !stored) return std::nullopt;
  std::vector<std::size_t> forces;
  for (std::size_t c = 0; c < history.columns().size(); ++c) {
    if (history.columns()[c].name.ends_with(".force")) forces.push_back(c);
  }
  DissipationFall largest;
  double greatest = -k_infinity;
  double time_of_greatest = 0.0;
  double round_off = 0.0;
  for (std::size_t row = 0; row < history.row_count(); ++row) {
    const double dissipation = history.at(row, *work) - history.at(row, *stored);
    largest.scale = std::max({largest.scale, std::abs(history.at(row, *work)), std::abs(history.at(row, *stored))});
    double force = 0.0;
    for (const std::size_t c : forces) force += std::abs(history.at(row, c));
    round_off = std::max(round_off, k_overlap_round_off * force * radius);
    if (dissipation >= greatest) {
      greatest = dissipation;
      time_of_greatest = history.at(row, 0);
    } else if (greatest - dissipation > largest.amount) {
      largest.amount = greatest - dissipation;
      largest.from = time_of_greatest;
      largest.to = history.at(row, 0);
    }
  }
  if (!(largest.amount > round_off)) return std::nullopt;
  return largest;
}

std::optional<std::string> energy_warning(const Table& history, double radius, const std::string& model, double rtol) {
  const auto fall = largest_dissipation_fall(history, radius);
  if (!fall || !(fall->share() > k_least_noted_fall)) return std::nullopt;
  const std::string where =
      fmt::format("dissipation falls by {:.3g} J, {:.2g} of the largest energy, from t = {:.9g} s to t = {:.9g} s",
                  fall->amount, fall->share(), fall->from, fall->to);
  if (fall->share() <= integrators::k_error_over_rtol * rtol) {
    return fmt::format("{}: the integration may be off by as much at rtol = {:g}", where, rtol);
  }
  return fmt::format("the law creates energy: {}; 'monograin models {}' says where it may", where, model);
}

}  // namespace monograin
