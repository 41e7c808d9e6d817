#include "scenario/key_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "scenario/overrides.hpp"
#include "scenario/plain_paths.hpp"
#include "scenario/words.hpp"

namespace monograin {
namespace {

/// Follows a path through the language and the tree at once.
class KeyFinder {
 public:
  KeyFinder(std::string_view path, const std::vector<PathPart>& parts, const Language& language)
      : path_(path), parts_(parts), language_(language) {}

  KeyAnswer find(const toml::table& root) {
    const std::string name = take_name();
    if (name.empty()) return no_such_path();
    if (at_ == parts_.size() || find_key(language_.root, name) == nullptr) {
      return last_key(name, language_.root, language_.foreign_tables);
    }
    if (name == "loading") return find_in_loading(root["loading"]);
    if (name == "particle") return last_key(take_name(), language_.particle);
    if (name == "material") return find_in_material();
    if (name == "output") return last_key(take_name(), language_.output);
    if (name == "numerics") return last_key(take_name(), language_.numerics);
    if (name == "sensitivities") return last_key(take_name(), language_.sensitivities);
    if (language_.model != nullptr && name == language_.model->name) return last_key(take_name(), language_.options);
    return no_such_path();
  }

 private:
  using Node = toml::node_view<const toml::node>;

  /// Takes the next part if it is a key; else an empty text.
  std::string take_name() {
    const auto* name = at_ < parts_.size() ? std::get_if<std::string>(&parts_[at_]) : nullptr;
    return name == nullptr ? std::string() : (++at_, *name);
  }

  [[nodiscard]] bool is_index_next() const {
    return at_ < parts_.size() && std::holds_alternative<std::size_t>(parts_[at_]);
  }

  /// The entry of an array that the next part, an index, selects.
  Node take_entry(Node array) {
    const std::size_t index = std::get<std::size_t>(parts_[at_++]);
    return array[index];
  }

  KeyAnswer find_in_material() {
    const std::string name = take_name();
    const bool goes_on = name == "ludwik" && at_ < parts_.size() && !language_.ludwik.empty();
    return goes_on ? last_key(take_name(), language_.ludwik)
                   : last_key(name, language_.material, language_.foreign_material);
  }

  KeyAnswer find_in_loading(Node loading) {
    const std::string name = take_name();
    if (name == "steps" && is_index_next()) return find_in_step(take_entry(loading["steps"]));
    if (name == "wall" && is_index_next()) {
      const Node wall = take_entry(loading["wall"]);
      const std::string key = take_name();
      if (key == "steps" && is_index_next()) return find_in_step(take_entry(wall["steps"]));
      return wall.is_table() ? last_key(key, language_.wall) : no_such_path();
    }
    return last_key(name, language_.loading);
  }

  KeyAnswer find_in_step(Node step) {
    const toml::table* table = step.as_table();
    if (table == nullptr) return no_such_path();
    const std::string name = take_name();
    if (name == "steps" && is_index_next()) return find_in_step(take_entry(step["steps"]));
    if (name == "until" && at_ < parts_.size()) {
      return last_key(take_name(), language_.until, language_.foreign_until_keys);
    }
    const auto stands = [&](const StepForm& form) { return table->contains(form.key); };
    const auto form = std::ranges::find_if(language_.steps, stands);
    if (form == language_.steps.end()) return no_such_path();
    const bool is_in_target = form->course && name == form->key && at_ < parts_.size();
    return is_in_target ? find_in_course(*form->course) : last_key(name, form->keys, form->foreign);
  }

  KeyAnswer find_in_course(const CourseForm& course) {
    const std::string name = take_name();
    if (name != "sine") return last_key(name, course.table);
    return at_ < parts_.size() ? last_key(take_name(), course.in_sine) : last_key(name, course.sine);
  }

  [[nodiscard]] KeyAnswer last_key(const std::string& name, std::span<const KeySpec> keys,
                                   std::span<const ForeignKey> foreign = {}) const {
    const KeySpec* spec = find_key(keys, name);
    if (spec == nullptr) {
      std::string_view reason = reason_of(foreign, name);
      if (reason.empty()) reason = reason_of(language_.homes, name);
      if (!reason.empty()) return {{}, fmt::format("key '{}' {}", name, reason)};
      const std::vector<std::string_view> names = names_of(keys);
      const std::string suggestion = did_you_mean(name, names);
      return {{},
              fmt::format("unknown key '{}'{}", shown(name.empty() ? path_ : std::string_view(name)),
                          suggestion.empty() ? "; expected one of " + listed(names) : suggestion)};
    }
    if (at_ < parts_.size()) return no_such_path();
    return {*spec, {}};
  }

  [[nodiscard]] KeyAnswer no_such_path() const {
    return {{}, fmt::format("the scenario has nothing at '{}'", shown(path_))};
  }

  std::string_view path_;
  const std::vector<PathPart>& parts_;
  const Language& language_;
  std::size_t at_ = 0;
};

}  // namespace

KeyAnswer key_at(std::string_view path, const toml::table& root, std::string_view model) {
  const Language& language = language_of(model);
  KeyAnswer answer;
  for (const std::string& plain : plain_paths(path)) {
    const auto parts = parse_key_path(plain);
    if (!parts) {
      return {{},
              fmt::format("'{}' is not the path of a key; expected for example material.yield_stress", shown(path))};
    }
    KeyAnswer found = KeyFinder(plain, *parts, language).find(root);
    if (!found.spec) return found;
    if (!answer.spec) answer = std::move(found);
  }
  return answer;
}

}  // namespace monograin
