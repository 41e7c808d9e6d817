/// One table of a TOML file, checked against the language. For readers of such files: includes the TOML library.
#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scenario/faults.hpp"
#include "scenario/language.hpp"

namespace monograin {

/// State that all readers of a scenario share: the list of faults, the length of R0, and numbers without a unit.
struct Reading {
  FaultList& faults;
  double initial_radius = 1.0;          ///< [m]
  bool has_units = false;               ///< some quantity of the file, no time and none in R0, is written with a unit
  std::span<const ForeignKey> homes{};  ///< tables in which keys belong that are found elsewhere
  std::vector<std::string_view> misplaced{};  ///< such keys of the sections so far
  bool is_of_material = false;                ///< the section that is read has constants of the material
  /// Numbers without a unit whose value in SI units is unlikely, a sentence each: paths of many radii; then moduli,
  /// strengths and radii, which a file without any unit may have in units of its own.
  std::vector<std::string> doubtful_paths{};
  std::vector<std::string> doubtful_scales{};
  std::filesystem::path folder{};       ///< of the files that the text names
  const FileTexts* recorded = nullptr;  ///< texts of these files; null: they are read
};

/// Text of a file that a scenario names, or the problem.
[[nodiscard]] FileText text_of_file(const Reading& reading, const std::string& name, std::size_t largest);

/// A number without a unit, as it is written.
struct BareNumber {
  std::string assignment;  ///< with its place: "displacement = 0.4 (line 12)"
  double value = 0.0;
  std::string before_unit;  ///< text before the unit to add: "\"0.4 ", "x["
  std::string after_unit;
};

/// Notes a number that is unlikely in SI units: a path of many radii, a radius that no particle has, or a modulus or a
/// strength that no solid has.
void doubt_missing_unit(Reading& reading, const KeySpec& spec, const BareNumber& number);

/// Reports keys that are neither among `keys` nor, with their reason, among `foreign`.
/// @return the suggestions made for misspelt keys
std::vector<std::string_view> check_names(Reading& reading, const toml::table& table, const SourceLocation& place,
                                          std::string_view label, std::span<const KeySpec> keys,
                                          std::span<const ForeignKey> foreign);

/// Checks a table when it is constructed, by the specs of its keys: names, kinds, units, ranges, required keys.
///
/// Rules between keys are left to the caller. Faulty values read as absent; their faults are already reported.
class Section {
 public:
  struct Origin {
    const toml::table* table = nullptr;
    SourceLocation place;
    std::string label;        ///< for messages: "[particle]"
    bool is_readable = true;  ///< false: another value is in the table's place, which has been reported
  };

  Section(Reading& reading, Origin origin, std::span<const KeySpec> keys, std::span<const ForeignKey> foreign = {});

  /// True if the text contains the key, with a valid value or not.
  [[nodiscard]] bool has(std::string_view key) const { return origin_.table->contains(key); }

  /// True if the text has a table below the key.
  [[nodiscard]] bool has_table(std::string_view key) const;

  /// True if the text contains the key, or a key that was reported as its misspelling, or no readable table.
  [[nodiscard]] bool has_or_misspells(std::string_view key) const;

  /// Value of the key, else its default, else none.
  [[nodiscard]] std::optional<double> number(std::string_view key) const { return get<double>(key); }
  [[nodiscard]] std::optional<bool> toggle(std::string_view key) const { return get<bool>(key); }
  [[nodiscard]] std::string text(std::string_view key) const;
  /// Number of a column, if its key has one and no heading.
  [[nodiscard]] std::optional<double> column_number(std::string_view key) const;
  [[nodiscard]] std::vector<double> numbers(std::string_view key) const { return list<double>(key); }
  [[nodiscard]] std::vector<std::string> texts(std::string_view key) const { return list<std::string>(key); }

  /// The table below a key; if it is absent or faulty, an empty table at this section's position.
  [[nodiscard]] Origin table(std::string_view key, std::string label) const;
  /// The tables of the array below a key, without entries that are no tables.
  [[nodiscard]] std::vector<Origin> tables(std::string_view key, const std::string& label) const;

  /// Reports a number without a unit under these keys if a value beside it has one: 0.1 beside "1 GPa" would be 0.1 Pa.
  /// Zero needs no unit.
  void expect_like_units(std::initializer_list<std::string_view> keys);

  [[nodiscard]] const SourceLocation& place() const noexcept { return origin_.place; }
  [[nodiscard]] SourceLocation key_place(std::string_view key) const;
  [[nodiscard]] SourceLocation value_place(std::string_view key) const;
  /// Position of an entry of the array below a key.
  [[nodiscard]] SourceLocation value_place(std::string_view key, std::size_t entry) const;

 private:
  using Value = std::variant<bool, double, std::string, std::vector<double>, std::vector<std::string>>;

  void check_value(const KeySpec& spec, const toml::node& node);
  void check_required();
  [[nodiscard]] std::optional<Value> read(const KeySpec& spec, const toml::node& node);
  [[nodiscard]] std::optional<Value> read_text(const KeySpec& spec, const toml::node& node);
  [[nodiscard]] std::optional<Value> read_choice(const KeySpec& spec, const toml::node& node);
  [[nodiscard]] std::optional<Value> read_toggle(const KeySpec& spec, const toml::node& node);
  [[nodiscard]] std::optional<double> read_integer(const KeySpec& spec, const toml::node& node);
  [[nodiscard]] std::optional<double> read_quantity(const KeySpec& spec, const toml::node& node);
  [[nodiscard]] std::optional<Value> read_pair(const KeySpec& spec, const toml::node& node);
  [[nodiscard]] std::optional<Value> read_instants(const KeySpec& spec, const toml::node& node);
  [[nodiscard]] std::optional<Value> read_direction(const KeySpec& spec, const toml::node& node);
  [[nodiscard]] std::optional<Value> read_texts(const KeySpec& spec, const toml::node& node);
  void check_tables(const KeySpec& spec, const toml::node& node);
  void doubt_missing_unit(const KeySpec& spec, const toml::node& node, double value) const;
  std::nullopt_t fault(const KeySpec& spec, const toml::node& node, std::string_view problem);
  std::nullopt_t unexpected(const KeySpec& spec, const toml::node& node, std::string_view suggestion = {});

  template <class T>
  [[nodiscard]] std::optional<T> get(std::string_view key) const {
    const auto found = values_.find(key);
    if (found != values_.end()) return std::get<T>(found->second);
    const KeySpec* spec = find_key(keys_, key);
    if (spec != nullptr && std::holds_alternative<T>(spec->default_value)) return std::get<T>(spec->default_value);
    return std::nullopt;
  }

  template <class T>
  [[nodiscard]] std::vector<T> list(std::string_view key) const {
    const auto found = values_.find(key);
    return found == values_.end() ? std::vector<T>{} : std::get<std::vector<T>>(found->second);
  }

  Reading& reading_;
  Origin origin_;
  std::span<const KeySpec> keys_;
  std::vector<std::string_view> misspelt_;  ///< keys that were suggested for unknown names
  std::map<std::string_view, Value> values_;
};

}  // namespace monograin
