/// The list of models.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "system/model.hpp"

namespace monograin {

/// All models this version can run, in the order in which they are listed to users.
[[nodiscard]] std::span<const Model> model_catalogue() noexcept;

/// Checks the names of a model, its keys, regimes and events, which go into scenario files, columns and folders, and
/// that the model has the function `bind`.
/// @return the first fault, a sentence; empty if there is none
[[nodiscard]] std::string fault_of(const Model& model);

/// Adds a model behind the others. To be called before a scenario is read, from one thread.
/// @throws std::invalid_argument if the name is taken, or for a model with a fault
void add_model(const Model& model);

/// The entry of that name, or nullptr.
[[nodiscard]] const Model* find_model(std::string_view name) noexcept;

/// Names of the models with a property, in the order of the list.
[[nodiscard]] std::vector<std::string_view> names_of_models(bool (*has_property)(const Model&));

/// Law with a single value that no formula expresses. Definitions of figures may use it by its name.
struct FormulaFunction {
  std::string_view name;
  std::size_t argument_count = 1;
  double (*value)(std::span<const double> arguments) = nullptr;  ///< NaN where the law has none
};
[[nodiscard]] std::span<const FormulaFunction> formula_functions() noexcept;

}  // namespace monograin
