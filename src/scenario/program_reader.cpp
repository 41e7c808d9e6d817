#include "scenario/program_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "scenario/course_reader.hpp"
#include "scenario/words.hpp"

namespace monograin {
namespace {

/// Quantity of a condition's key; none for the key of an event.
std::optional<Quantity> quantity_of(std::string_view key) {
  const auto found = std::ranges::find(k_quantity_keys, key);
  if (found == k_quantity_keys.end()) return std::nullopt;
  return static_cast<Quantity>(found - k_quantity_keys.begin());
}

}  // namespace

std::vector<Step> ProgramReader::read(const Section& parent, std::string_view key, const std::string& label) {
  std::vector<Step> steps = read_list(parent, key, label);
  if (!is_within_limit(steps_so_far_ + steps.size(), parent.key_place(key))) return {};
  steps_so_far_ += steps.size();
  return steps;
}

std::vector<Step> ProgramReader::read_list(const Section& parent, std::string_view key, const std::string& label) {
  std::vector<Step> steps;
  for (const Section::Origin& table : parent.tables(key, label)) {
    std::vector<Step> written_out = read_step(table);
    if (!is_within_limit(steps.size() + written_out.size(), table.place)) return {};
    std::ranges::move(written_out, std::back_inserter(steps));
  }
  return steps;
}

bool ProgramReader::is_within_limit(std::size_t steps, const SourceLocation& where) {
  if (steps <= static_cast<std::size_t>(k_most_steps)) return true;
  reading_.faults.add(
      where,
      fmt::format("the program has {} ramps or more with cycles, tables and sines written out; expected at most {}",
                  steps, k_most_steps));
  return false;
}

std::vector<Step> ProgramReader::read_step(const Section::Origin& table) {
  const StepForm* form = form_of(*table.table);
  if (form == nullptr) {
    report_formless(table);
    return {};
  }
  const Section section(reading_, table, form->keys, form->foreign);
  if (!form->kind) return read_cycle(section);
  if (form->takes_duration_or_rate) check_duration_or_rate(section, form->course && section.has_table(form->key));
  return read_plain_step(section, *form);
}

/// The form that the keys of a step show, else the one whose key is misspelt there.
const StepForm* ProgramReader::form_of(const toml::table& table) const {
  const auto is_misspelt_in = [&](const StepForm& form) {
    const std::vector<std::string_view> names = names_of(form.keys);
    return std::ranges::any_of(table, [&](const auto& entry) {
      const std::string_view key = entry.first.str();
      return find_key(form.keys, key) == nullptr && reason_of(form.foreign, key).empty() &&
             nearest_word(key, names) == form.key;
    });
  };
  auto found = std::ranges::find_if(language_.steps, [&](const StepForm& form) { return table.contains(form.key); });
  if (found == language_.steps.end()) found = std::ranges::find_if(language_.steps, is_misspelt_in);
  return found == language_.steps.end() ? nullptr : &*found;
}

void ProgramReader::report_formless(const Section::Origin& table) {
  std::vector<KeySpec> all_keys;
  std::vector<std::string_view> forms;
  for (const StepForm& form : language_.steps) {
    forms.push_back(form.key);
    for (KeySpec spec : form.keys) {
      spec.is_required = false;
      const auto known = std::ranges::find(all_keys, spec.name, &KeySpec::name);
      if (known == all_keys.end()) {
        all_keys.push_back(std::move(spec));
      } else if (known->dimension != spec.dimension) {
        known->kind = KeySpec::Kind::any;
      }
    }
  }
  const Section section(reading_, table, all_keys, language_.foreign_step_keys);
  if (section.has("until")) static_cast<void>(read_until(section));
  const auto is_unknown = [&](const auto& entry) { return find_key(all_keys, entry.first.str()) == nullptr; };
  // Such a key has been reported, and is most likely what the step is to do.
  if (std::ranges::any_of(*table.table, is_unknown)) return;
  reading_.faults.add(table.place,
                      fmt::format("the step has nothing to do; expected exactly one of {}", fmt::join(forms, ", ")));
}

void ProgramReader::check_duration_or_rate(const Section& section, bool has_own_times) {
  const bool has_duration = section.has_or_misspells("duration");
  const bool has_rate = section.has_or_misspells("rate");
  if (has_own_times) {
    for (const char* key : {"duration", "rate"}) {
      if (!section.has(key)) continue;
      reading_.faults.add(section.key_place(key),
                          fmt::format("key '{}' does not go with a table or a sine, which has times of its own", key));
    }
  } else if (has_duration && has_rate) {
    reading_.faults.add(section.key_place("rate"),
                        "key 'rate' does not go with 'duration'; expected exactly one of them");
  } else if (!has_duration && !has_rate) {
    reading_.faults.add(section.place(),
                        "the step has neither duration nor rate; expected one of them, for example "
                        "duration = \"1 s\"");
  }
}

std::vector<Step> ProgramReader::read_cycle(const Section& section) {
  const std::vector<Step> once = read_list(section, "steps", "the steps of a cycle");
  const auto count = static_cast<std::size_t>(section.number("cycle").value_or(1.0));
  // Both factors are within the limit, so that their product cannot overflow.
  if (!is_within_limit(count * once.size(), section.key_place("cycle"))) return {};
  std::vector<Step> steps;
  steps.reserve(count * once.size());
  for (std::size_t i = 0; i < count; ++i) std::ranges::copy(once, std::back_inserter(steps));
  return steps;
}

std::vector<Step> ProgramReader::read_plain_step(const Section& section, const StepForm& form) {
  std::vector<Until> conditions;
  if (section.has("until")) conditions = read_until(section);
  std::vector<Step> steps;
  if (form.course && section.has_table(form.key)) {
    steps = read_course(reading_, section, form, files_);
  } else {
    Step& step = steps.emplace_back();
    if (form.takes_duration_or_rate) read_targets(section, form, step);
    step.duration = section.number("duration");
    step.rate = section.number("rate");
  }
  for (Step& step : steps) {
    step.where = section.place();
    step.kind = *form.kind;
    step.until = conditions;
  }
  return steps;
}

void ProgramReader::read_targets(const Section& section, const StepForm& form, Step& step) {
  const bool is_pair = form.keys.front().kind == KeySpec::Kind::pair;
  const std::vector<double> targets = is_pair ? section.numbers(form.key) : std::vector<double>{};
  step.target = is_pair ? (targets.empty() ? 0.0 : targets.front()) : section.number(form.key).value_or(0.0);
  std::string_view first;  // key that prescribes the lateral direction
  if (targets.size() == 2) {
    step.lateral = {.kind = *form.kind, .target = targets[1]};
    first = form.key;
  }
  for (const DriveKey& key : form.lateral) {
    if (!section.has(key.name)) continue;
    if (!first.empty()) {
      reading_.faults.add(section.key_place(key.name),
                          fmt::format("key '{}' does not go with '{}', which prescribes the lateral direction already; "
                                      "expected one of them",
                                      key.name, first));
      continue;
    }
    step.lateral = {.kind = ramp_of(key.control), .target = section.number(key.name).value_or(0.0)};
    first = key.name;
  }
}

std::vector<Until> ProgramReader::read_until(const Section& step) {
  const Section section(reading_, step.table("until", "until"), language_.until, language_.foreign_until_keys);
  const std::string wall = section.text("wall");
  std::vector<Until> conditions;
  bool asks_wall = false;
  for (const KeySpec& spec : language_.until) {
    if (!section.has(spec.name) || spec.name == "wall") continue;
    if (const auto quantity = quantity_of(spec.name)) {
      conditions.push_back({.quantity = *quantity, .value = section.number(spec.name).value_or(0.0), .wall = wall});
      asks_wall = asks_wall || *quantity != Quantity::apparent_radius;
    } else {
      conditions.push_back({.event = section.text(spec.name)});
    }
  }
  if (wall.empty()) return conditions;
  named_walls_.push_back({wall, section.value_place("wall")});
  if (!asks_wall) {
    reading_.faults.add(section.key_place("wall"),
                        "key 'wall' says at which wall a quantity counts; expected one beside it, for example "
                        "force = \"10 N\"");
  }
  return conditions;
}

}  // namespace monograin
