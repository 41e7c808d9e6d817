/// The scenario language as one table: every key with its kind, range, default and meaning.
///
/// The reader checks files against these tables, and the JSON Schema is made from them, so that both agree.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "catalogue.hpp"
#include "scenario/scenario.hpp"

namespace monograin {

/// A key of the language with the values that it accepts.
struct KeySpec {
  enum class Kind {
    text,
    identifier,  ///< a name that can stand in a column of the output
    toggle,
    mark,  ///< `true`, and nothing else
    choice,
    file,
    column,  ///< of a table of numbers: its heading, or its number from 1
    integer,
    quantity,   ///< a number in SI, or a text with a unit where the dimension has units
    pair,       ///< one quantity, or a list of two
    instants,   ///< strictly ascending list of quantities
    direction,  ///< three numbers, not all zero
    texts,      ///< list of texts; a number in it is read as its text
    table,
    tables,  ///< not empty
    any,     ///< a value that is not checked
  };
  using Default = std::variant<std::monostate, bool, double, std::string_view>;

  std::string_view name;
  std::string_view meaning;
  Kind kind = Kind::text;
  bool is_required = false;
  Dimension dimension = Dimension::none;
  Range range{};
  bool knows_initial_radius = true;  ///< R0 may be used as a unit
  int multiple_of = 1;               ///< of an integer
  bool may_be_empty = true;          ///< of a table
  std::vector<std::string_view> choices{};
  std::vector<std::string_view> reserved{};  ///< choices that the language knows but that are not available here
  std::string reserved_where{};              ///< where they are unavailable: "in this version"
  Default default_value{};
  std::string example{};                   ///< as written in a file; empty: that of the dimension, or the first choice
  std::string_view only_with{};            ///< `[loading]`: the configuration that the key belongs to; empty: any
  std::span<const QuantityKey> columns{};  ///< of a file that is not a curve of two columns
  bool may_be_table = false;               ///< of a quantity: a table may stand in its place, which the caller checks
  /// Former names of choices with the present ones.
  std::vector<std::pair<std::string_view, std::string_view>> renamed{};
};

/// Key of a kind that needs neither range nor choices.
/// @param example  as written in a file
[[nodiscard]] inline KeySpec key_of(KeySpec::Kind kind, std::string_view name, std::string_view meaning,
                                    std::string example) {
  return {.name = name, .meaning = meaning, .kind = kind, .example = std::move(example)};
}
[[nodiscard]] inline KeySpec choice_key(std::string_view name, std::string_view meaning,
                                        std::span<const std::string_view> choices) {
  return {.name = name, .meaning = meaning, .kind = KeySpec::Kind::choice, .choices = {choices.begin(), choices.end()}};
}
/// Makes the first choice the one of files that name none.
[[nodiscard]] inline KeySpec first_by_default(KeySpec key) {
  key.default_value = key.choices.front();
  return key;
}
[[nodiscard]] inline KeySpec required(KeySpec key) {
  key.is_required = true;
  return key;
}

/// A key of the language that does not belong where it was found, with the reason.
struct ForeignKey {
  std::string_view name;
  std::string reason;  ///< goes on from "key 'x' ..."
};

/// Reason of a foreign key: none if no list names the key.
[[nodiscard]] std::string_view reason_of(std::span<const ForeignKey> foreign, std::string_view key) noexcept;

/// Keys of a table in the place of a step's target: values over time from a file, or a sine.
struct CourseForm {
  std::vector<KeySpec> table;  ///< keys beside each other
  std::vector<KeySpec> sine;   ///< the one key `sine`
  std::vector<KeySpec> in_sine;
  std::vector<ForeignKey> foreign_to_sine;
};

/// One form of a step: the key that marks it, and its other keys.
struct StepForm {
  std::optional<Step::Kind> kind;  ///< none: a cycle
  std::string_view key;
  std::vector<KeySpec> keys;
  bool takes_duration_or_rate = false;  ///< exactly one of the two is required
  std::span<const DriveKey> lateral{};  ///< keys for the lateral direction, at most one of which is allowed
  std::vector<ForeignKey> foreign{};    ///< keys of other forms and of other models
  std::optional<CourseForm> course{};   ///< none: the target is a value
};

/// Words of Loading::Configuration, in its order.
inline constexpr std::array<std::string_view, 7> k_configurations{"simple", "die",      "hydrostatic", "oblique-die",
                                                                  "walls",  "triaxial", "strain-path"};
/// Keys of conditions that compare a quantity, in the order of Quantity.
inline constexpr std::array<std::string_view, 8> k_quantity_keys{"force",          "displacement",    "pressure",
                                                                 "contact_radius", "apparent_radius", "stress_axial",
                                                                 "stress_lateral", "relative_density"};

inline constexpr int k_most_points = 1'000'000;
inline constexpr double k_most_rows = 2e7;        ///< of a history, events not counted
inline constexpr int k_most_steps = 100'000;      ///< of all programs, cycles written out
inline constexpr int k_most_walls = 200;          ///< limits the time of a run, which grows like the cube
inline constexpr int k_most_columns = 1'000'000;  ///< of a table of numbers
inline constexpr double k_least_normal = 1e-6;    ///< least magnitude of a normal's largest component
inline constexpr double k_greatest_normal = 1e6;

/// The language of one model.
struct Language {
  const Model* model = nullptr;  ///< null: the file names no valid model
  std::vector<KeySpec> root;
  std::vector<KeySpec> particle;  ///< empty if the model has no particle
  std::vector<KeySpec> material;  ///< empty without a model
  std::vector<KeySpec> options;   ///< empty without a model
  std::vector<KeySpec> ludwik;    ///< the table in `[material]`; empty if the model does not have it
  std::vector<KeySpec> loading;
  std::vector<KeySpec> wall;
  std::vector<KeySpec> until;
  std::vector<KeySpec> output;
  std::vector<KeySpec> numerics;
  std::vector<KeySpec> sensitivities;
  std::vector<StepForm> steps;

  std::vector<ForeignKey> foreign_tables;  ///< tables of other models
  std::vector<ForeignKey> foreign_material;
  std::vector<ForeignKey> foreign_loading;
  std::vector<ForeignKey> foreign_step_keys;
  std::vector<ForeignKey> foreign_until_keys;

  std::vector<ForeignKey> homes;  ///< all keys, each with the table that it belongs in
};

/// Language of a model; every call returns one and the same object.
/// @param model  name as written in the file, valid or not
[[nodiscard]] const Language& language_of(std::string_view model);

/// The spec with a name, or nullptr.
[[nodiscard]] const KeySpec* find_key(std::span<const KeySpec> keys, std::string_view name) noexcept;

[[nodiscard]] std::vector<std::string_view> names_of(std::span<const KeySpec> keys);

/// Spec of a number that a model has.
[[nodiscard]] KeySpec quantity_key(const QuantityKey& key);

/// Text of the accepted values, to follow "expected ": `a stress, for example "50 MPa"`.
[[nodiscard]] std::string expectation(const KeySpec& spec);

/// Example of a line with the key: `youngs_modulus = "50 MPa"`.
[[nodiscard]] std::string example_line(const KeySpec& spec);

/// The finite range of a quantity or integer.
[[nodiscard]] Range finite_range(const KeySpec& spec) noexcept;

}  // namespace monograin
