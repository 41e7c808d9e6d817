#include "scenario/faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "scenario/overrides.hpp"

namespace monograin {
namespace {

std::string one_line_each(const std::vector<Fault>& faults) {
  std::string text;
  for (const Fault& fault : faults) {
    if (!text.empty()) text += '\n';
    text += fmt::format("{}:{}:{}: {}", fault.where.file, fault.where.line, fault.where.column, fault.message);
  }
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
  const auto is_same = [&](const Fault& fault) {
    return std::tie(fault.message, fault.where.file, fault.where.line, fault.where.column) ==
           std::tie(message, where.file, where.line, where.column);
  };
  if (std::ranges::none_of(faults_, is_same)) faults_.push_back({std::move(where), std::move(message)});
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
