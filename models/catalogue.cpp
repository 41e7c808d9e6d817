#include "catalogue.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "elastic/line_contact.hpp"
#include "nonlocal/coupling.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

/// P/(D E*) of an elastic cylinder between flat walls over delta/D.
double line_contact(std::span<const double> strain) { return line_contact_at_strain(1.0, strain[0]).stress; }

/// Influence of a neighbour's force on a contact radius, over Poisson's ratio, angle and contact radius.
template <nonlocal::RadiusRule rule>
double radius_influence(std::span<const double> of) {
  return nonlocal::radius_influence(rule, of[0], of[1], of[2]);
}

/// Value of a law; NaN beyond its domain.
template <double (*law)(std::span<const double>)>
double where_defined(std::span<const double> arguments) {
  try {
    return law(arguments);
  } catch (const std::domain_error&) {
    return k_nan;
  }
}

using nonlocal::RadiusRule;

constexpr std::array k_functions{
    FormulaFunction{"line_contact", 1, where_defined<line_contact>},
    FormulaFunction{"radius_influence_closed", 3, where_defined<radius_influence<RadiusRule::closed>>},
    FormulaFunction{"radius_influence_integral", 3, where_defined<radius_influence<RadiusRule::integral>>},
    FormulaFunction{"radius_influence_projected", 3, where_defined<radius_influence<RadiusRule::projected>>}};

}  // namespace

// Namespace of every model, in the order in which they are listed to users. It is the name of the model and of its
// folder, with '_' for '-'.
#define MONOGRAIN_MODELS(MODEL) \
  MODEL(hertz)                  \
  MODEL(mdr)                    \
  MODEL(cel)                    \
  MODEL(similarity)             \
  MODEL(semimech)               \
  MODEL(hardening)              \
  MODEL(nonlocal)               \
  MODEL(compressible)           \
  MODEL(material_point)         \
  MODEL(packing)

#define MONOGRAIN_DECLARE(space) \
  namespace space {              \
  Model model() noexcept;        \
  }
MONOGRAIN_MODELS(MONOGRAIN_DECLARE)

namespace {

/// True for a name of letters, digits and a mark, which begins with a letter. Capitals are for keys, whose mark is '_'.
bool is_name(std::string_view text, char mark) {
  const auto is_letter = [mark](char c) { return (c >= 'a' && c <= 'z') || (mark == '_' && c >= 'A' && c <= 'Z'); };
  const auto may_follow = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == mark; };
  return !text.empty() && is_letter(text.front()) && std::ranges::all_of(text, may_follow);
}

std::string rule_of_names(char mark) {
  return mark == '_' ? "a letter, then letters, digits and '_'" : "a small letter, then small letters, digits and '-'";
}

/// Finds a name in one list of a model that no file can have, or that is there twice.
/// @return the fault, a sentence; empty if there is none
template <class Items>
std::string fault_of_names(const Model& model, const Items& items, const std::string& what, char mark) {
  for (std::size_t i = 0; i < items.size(); ++i) {
    const std::string_view name = items[i].name;
    const std::string of_model = "model '" + std::string(model.name) + "' has the " + what + " '" + std::string(name);
    if (!is_name(name, mark)) return of_model + "'; expected " + rule_of_names(mark);
    for (std::size_t k = 0; k < i; ++k) {
      if (items[k].name == name) return of_model + "' twice";
    }
  }
  return {};
}

std::vector<Model>& all_models() {
#define MONOGRAIN_CALL(space) space::model(),
  static std::vector<Model> models{MONOGRAIN_MODELS(MONOGRAIN_CALL)};
  return models;
}

}  // namespace

std::span<const Model> model_catalogue() noexcept { return all_models(); }

std::string fault_of(const Model& model) {
  constexpr std::array<std::string_view, 8> k_tables{"title",   "model",  "particle", "material",
                                                     "loading", "output", "numerics", "sensitivities"};
  if (!is_name(model.name, '-')) {
    return "a model is named '" + std::string(model.name) + "'; expected " + rule_of_names('-');
  }
  if (std::ranges::find(k_tables, model.name) != k_tables.end()) {
    return "'" + std::string(model.name) + "' is a key of every scenario; expected another name for a model";
  }
  if (model.bind == nullptr) return "model '" + std::string(model.name) + "' has no function `bind`";
  std::string fault = fault_of_names(model, model.material, "key", '_');
  if (fault.empty()) fault = fault_of_names(model, model.options, "option", '_');
  if (fault.empty()) fault = fault_of_names(model, model.regimes, "regime", '-');
  return fault.empty() ? fault_of_names(model, model.events, "event", '-') : fault;
}

void add_model(const Model& model) {
  if (const std::string fault = fault_of(model); !fault.empty()) throw std::invalid_argument(fault);
  if (find_model(model.name) != nullptr) {
    throw std::invalid_argument("there is a model '" + std::string(model.name) + "' already; expected another name");
  }
  all_models().push_back(model);
}

const Model* find_model(std::string_view name) noexcept {
  const auto models = model_catalogue();
  const auto found = std::ranges::find(models, name, &Model::name);
  return found == models.end() ? nullptr : &*found;
}

std::vector<std::string_view> names_of_models(bool (*has_property)(const Model&)) {
  std::vector<std::string_view> names;
  for (const Model& model : model_catalogue()) {
    if (has_property(model)) names.push_back(model.name);
  }
  return names;
}

std::span<const FormulaFunction> formula_functions() noexcept { return k_functions; }

}  // namespace monograin
