#include "scenario/faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "scenario/overrides.hpp"

namespace monograin {
namespace {

std::string one_line(const Fault& fault) {
  return fmt::format("{}:{}:{}: {}", fault.where.file, fault.where.line, fault.where.column, fault.message);
}

std::string one_line_each(const std::vector<Fault>& faults) {
  std::string text;
  // A line "and 1 more" could as well show that fault.
  const std::size_t shown = faults.size() <= k_most_shown_faults + 1 ? faults.size() : k_most_shown_faults;
  for (std::size_t k = 0; k < shown; ++k) text += (k == 0 ? "" : "\n") + one_line(faults[k]);
  const std::size_t left = faults.size() - shown;
  if (left > 0) text += fmt::format("\nand {} more faults", left);
  return text;
}

auto order_of(const Fault& fault) {
  const SourceLocation& where = fault.where;
  return std::tuple(is_override(where), std::string_view(where.file), where.line, where.column);
}

}  // namespace

ScenarioError::ScenarioError(std::vector<Fault> faults)
    : std::runtime_error(one_line_each(faults)), faults_(std::move(faults)) {}

void FaultList::add(SourceLocation where, std::string message) {
  Fault fault{std::move(where), std::move(message)};
  if (lines_.insert(one_line(fault)).second) faults_.push_back(std::move(fault));
}

void FaultList::throw_if_any() const {
  if (faults_.empty()) return;
  std::vector<Fault> sorted = faults_;
  std::ranges::stable_sort(sorted, [](const Fault& a, const Fault& b) { return order_of(a) < order_of(b); });
  throw ScenarioError(std::move(sorted));
}

void throw_fault(SourceLocation where, std::string message) {
  throw ScenarioError({{std::move(where), std::move(message)}});
}

}  // namespace monograin
