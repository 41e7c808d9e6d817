#include "scenario/scenario.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <optional>
#include <utility>

#include "scenario/document.hpp"
#include "scenario/faults.hpp"
#include "scenario/key_path.hpp"
#include "scenario/language.hpp"
#include "scenario/numbers.hpp"
#include "scenario/overrides.hpp"
#include "scenario/reader.hpp"
#include "scenario/rules.hpp"
#include "scenario/words.hpp"

namespace monograin {
namespace {

std::string name_of(const std::string& origin) {
  const std::string stem = std::filesystem::path(origin).stem().string();
  return stem.empty() ? "scenario" : stem;
}

/// A table of a document, with its positions.
toml::table parse_table(std::string_view text, std::string_view key, const std::string& origin) {
  toml::table document = parse_document(text, origin);
  toml::table* const table = document[key].as_table();
  if (table == nullptr) throw_fault({origin}, fmt::format("there is no table [{}]; expected a scenario there", key));
  return std::move(*table);
}

/// The tree of a source, with overrides applied.
toml::table tree_of(const ScenarioSource& source, const std::vector<std::string>& overrides, FaultList& faults) {
  toml::table root = source.table.empty() ? parse_document(source.text, source.origin)
                                          : parse_table(source.text, source.table, source.origin);
  if (source.table.empty()) expect_type(root, source.origin, DocumentType::scenario);
  for (const std::string& override_text : overrides) apply_override(root, override_text, faults);
  return root;
}

/// @param overrides  which the tree contains already, for the record
CheckedScenario check_tree(const toml::table& root, const ScenarioSource& source, std::vector<std::string> overrides,
                           FaultList& faults) {
  CheckedScenario scenario = read_tree(root, source.origin, source.files ? &*source.files : nullptr, faults);
  faults.throw_if_any();
  scenario.name = name_of(source.origin);
  scenario.text = source.text;
  if (!scenario.sensitivities.empty()) scenario.variants = std::make_shared<ScenarioTemplate>(source, overrides);
  scenario.overrides = std::move(overrides);
  return scenario;
}

CheckedScenario parse_source(const ScenarioSource& source, const std::vector<std::string>& overrides) {
  FaultList faults;
  const toml::table root = tree_of(source, overrides, faults);
  return check_tree(root, source, overrides, faults);
}

/// True if a change of the material's numbers changes nothing else in the scenario.
bool may_set_material(const toml::table& tree, const CheckedScenario& scenario) {
  return !tree["material"]["ludwik"] && scenario.sensitivities.empty();
}

/// The scenario with other numbers of its material, at the keys that belong to the material; none if one of these is no
/// such number, or if a check objects.
/// @param tree  from which the scenario was made
std::optional<CheckedScenario> with_material(const CheckedScenario& made, const toml::table& tree,
                                             const std::string& origin, std::span<const std::string> keys,
                                             std::span<const double> numbers) {
  const Language& language = language_of(made.model);
  std::optional<CheckedScenario> scenario = made;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    if (!keys[k].starts_with(k_of_material)) continue;
    const std::string name = keys[k].substr(k_of_material.size());
    if (std::ranges::find(language.model->material, name, &QuantityKey::name) == language.model->material.end() ||
        !finite_range(*find_key(language.material, name)).contains(numbers[k])) {
      return std::nullopt;
    }
    scenario->material.insert_or_assign(name, numbers[k]);
  }
  FaultList faults;
  Reading reading{faults};
  check_rules(reading, tree, origin, language, *scenario);
  if (faults.size() > 0) return std::nullopt;
  return scenario;
}

}  // namespace

struct ScenarioTemplate::Document {
  /// A checked scenario, with the inputs from which it was made.
  struct Made {
    std::vector<std::string> overrides;
    std::vector<std::string> keys;
    std::vector<double> numbers;  ///< at keys outside the material
    toml::table tree;
    CheckedScenario scenario;
  };

  ScenarioSource source;
  std::vector<std::string> overrides;
  toml::table root;
  mutable std::mutex mutex{};
  mutable std::shared_ptr<const Made> last{};  ///< changed under the mutex

  /// The last scenario, if its inputs are equal except for numbers of the material at the keys.
  [[nodiscard]] std::shared_ptr<const Made> find(const std::vector<std::string>& more,
                                                 std::span<const std::string> keys,
                                                 const std::vector<double>& numbers) const {
    const std::lock_guard lock(mutex);
    const bool is_same =
        last && last->overrides == more && std::ranges::equal(last->keys, keys) && last->numbers == numbers;
    return is_same ? last : nullptr;
  }
};

ScenarioTemplate::ScenarioTemplate(ScenarioSource source, std::vector<std::string> overrides) {
  FaultList faults;
  toml::table root = tree_of(source, overrides, faults);
  faults.throw_if_any();
  document_.reset(new Document{std::move(source), std::move(overrides), std::move(root)});
}

ScenarioTemplate::~ScenarioTemplate() = default;
ScenarioTemplate::ScenarioTemplate(ScenarioTemplate&&) noexcept = default;
ScenarioTemplate& ScenarioTemplate::operator=(ScenarioTemplate&&) noexcept = default;

CheckedScenario ScenarioTemplate::with(const std::vector<std::string>& overrides, std::span<const std::string> keys,
                                       std::span<const double> numbers) const {
  const ScenarioSource& source = document_->source;
  std::vector<std::string> all = document_->overrides;
  all.insert(all.end(), overrides.begin(), overrides.end());
  for (std::size_t k = 0; k < keys.size(); ++k) all.push_back(fmt::format("{}={}", keys[k], numbers[k]));
  std::vector<double> other_numbers;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    if (!keys[k].starts_with(k_of_material)) other_numbers.push_back(numbers[k]);
  }
  if (const auto made = document_->find(overrides, keys, other_numbers)) {
    if (auto scenario = with_material(made->scenario, made->tree, source.origin, keys, numbers)) {
      scenario->overrides = std::move(all);
      return *std::move(scenario);
    }
  }
  try {
    toml::table copy = document_->root;
    FaultList faults;
    for (const std::string& text : overrides) apply_override(copy, text, faults);
    const std::size_t first = all.size() - keys.size();
    for (std::size_t k = 0; k < keys.size(); ++k) apply_number(copy, all[first + k], numbers[k], faults);
    CheckedScenario scenario = check_tree(copy, source, all, faults);
    if (other_numbers.size() < keys.size() && may_set_material(copy, scenario)) {
      auto made = std::make_shared<Document::Made>(
          Document::Made{overrides, {keys.begin(), keys.end()}, std::move(other_numbers), std::move(copy), scenario});
      const std::lock_guard lock(document_->mutex);
      document_->last = std::move(made);
    }
    return scenario;
  } catch (const ScenarioError&) {
    return parse_source(source, all);  // only a parsed source gives positions in messages
  }
}

std::string ScenarioTemplate::problem_of_number(const std::string& key) const {
  using Kind = KeySpec::Kind;
  const toml::table& root = document_->root;
  const KeyAnswer answer = key_at(key, root, root["model"].value_or(std::string()));
  if (!answer.spec) return answer.problem;
  const Kind kind = answer.spec->kind;
  if (kind == Kind::quantity || kind == Kind::integer || kind == Kind::pair) return {};
  return fmt::format("'{}' takes no number", shown(key));
}

double angle_between(const std::array<double, 3>& a, const std::array<double, 3>& b) noexcept {
  const double cross = std::hypot(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
  return std::atan2(cross, a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}

std::size_t count_steps(std::span<const Step> program) noexcept {
  return static_cast<std::size_t>(std::ranges::count_if(program, [](const Step& step) { return step.leg.is_first(); }));
}

std::vector<std::span<const Step>> steps_with_legs(std::span<const Step> program) {
  std::vector<std::span<const Step>> steps;
  for (std::size_t first = 0, k = 0; k < program.size(); ++k) {
    if (!program[k].leg.is_last()) continue;
    steps.push_back(program.subspan(first, k + 1 - first));
    first = k + 1;
  }
  return steps;
}

std::optional<Control> control_of(Step::Kind kind) noexcept {
  switch (kind) {
    case Step::Kind::displacement:
      return Control::displacement;
    case Step::Kind::force:
      return Control::force;
    case Step::Kind::strain:
      return Control::strain;
    case Step::Kind::stress:
      return Control::stress;
    case Step::Kind::packing_fraction:
      return Control::packing_fraction;
    case Step::Kind::hold:
    case Step::Kind::detach:
      break;
  }
  return std::nullopt;
}

Step::Kind ramp_of(Control control) noexcept {
  switch (control) {
    case Control::displacement:
      return Step::Kind::displacement;
    case Control::force:
      return Step::Kind::force;
    case Control::strain:
      return Step::Kind::strain;
    case Control::stress:
      return Step::Kind::stress;
    case Control::packing_fraction:
      return Step::Kind::packing_fraction;
  }
  return Step::Kind::hold;
}

CheckedScenario read_scenario(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                              FileKind kind) {
  const auto [text, name] = read_named_text(file, "a scenario file", kind);
  return parse_scenario(text, name.string(), overrides);
}

CheckedScenario parse_scenario(std::string_view text, const std::string& origin,
                               const std::vector<std::string>& overrides) {
  return parse_source({.text = std::string(text), .origin = origin}, overrides);
}

CheckedScenario parse_recorded_scenario(std::string_view text, const std::string& origin,
                                        const std::vector<std::string>& overrides, const FileTexts& files) {
  return parse_source({.text = std::string(text), .origin = origin, .files = files}, overrides);
}

CheckedScenario parse_scenario_table(std::string_view text, std::string_view key, const std::string& origin,
                                     const std::vector<std::string>& overrides) {
  return parse_source({.text = std::string(text), .origin = origin, .table = std::string(key)}, overrides);
}

}  // namespace monograin
