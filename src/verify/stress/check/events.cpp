#include "verify/stress/check/events.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <string_view>
#include <utility>

namespace monograin {

EventNames sorted_events(const Run& run) {
  EventNames names;
  const Table& events = run.record.events;
  const auto event = *events.find("event");
  const auto contact_class = *events.find("class");
  for (std::size_t row = 0; row < events.row_count(); ++row) {
    names.push_back(fmt::format("{} {}", events.word(row, contact_class), events.word(row, event)));
  }
  std::ranges::sort(names);
  return names;
}

EventNames missing_from(const EventNames& other, const EventNames& names) {
  EventNames only;
  std::ranges::set_difference(names, other, std::back_inserter(only));
  return only;
}

bool coincide_with_others(const Run& run, const EventNames& names, double share) {
  const Table& events = run.record.events;
  const auto time = *events.find("time");
  const auto event = *events.find("event");
  const auto contact_class = *events.find("class");
  const auto is_asked_for = [&](std::string_view of, const char* what) {
    return std::ranges::find(names, fmt::format("{} {}", of, what)) != names.end();
  };
  double step_start = 0.0;
  std::map<std::string, bool> company;
  std::map<std::string, bool> was_lost_in_company;
  for (std::size_t row = 0; row < events.row_count();) {
    std::size_t end = row;
    while (end < events.row_count() && events.word(end, event) != "step-end") ++end;
    const double step_end = events.at(std::min(end, events.row_count() - 1), time);
    const double near = share * (step_end - step_start);
    for (std::size_t a = row; a < end; ++a) {
      const double at = events.at(a, time);
      bool has_company = at - step_start <= near || step_end - at <= near;
      for (std::size_t b = row; b < end; ++b) has_company |= a != b && std::abs(at - events.at(b, time)) <= near;
      const std::string of(events.word(a, contact_class));
      if (events.word(a, event) == "contact-lost") {
        was_lost_in_company[of] = has_company && is_asked_for(of, "contact-lost");
      } else if (events.word(a, event) == "contact-made") {
        has_company |= std::exchange(was_lost_in_company[of], false);
      }
      if (has_company) company[fmt::format("{} {}", of, events.word(a, event))] = true;
    }
    step_start = step_end;
    row = end + 1;
  }
  return std::ranges::all_of(names, [&](const std::string& name) { return company.contains(name); });
}

std::string first_difference(const EventNames& a, const EventNames& b) {
  const auto first = [](const EventNames& names) { return names.empty() ? std::string("nothing") : names.front(); };
  const EventNames only_a = missing_from(b, a);
  const EventNames only_b = missing_from(a, b);
  return fmt::format("'{}' against '{}' ({} and {} events differ)", first(only_a), first(only_b), only_a.size(),
                     only_b.size());
}

}  // namespace monograin
