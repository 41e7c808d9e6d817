#include "scenario/file_keys.hpp"

#include <fmt/format.h>

#include <variant>

#include "scenario/document.hpp"
#include "scenario/edit.hpp"

namespace monograin {
namespace {

/// Adds the keys of the tables that steps follow.
/// @param path  of the node
void add_tables(const toml::node& node, const std::string& path, const FileTexts& files, std::vector<FileKey>& keys) {
  if (const toml::table* table = node.as_table()) {
    for (const auto& [key, value] : *table) {
      const std::string own = fmt::format("{}.{}", path, key.str());
      const auto name = value.value<std::string>();
      const auto file = key.str() == "table" && name ? files.find(*name) : files.end();
      if (file != files.end()) keys.push_back({own, file->first, file->second});
      add_tables(value, own, files, keys);
    }
  } else if (const toml::array* array = node.as_array()) {
    for (std::size_t k = 0; k < array->size(); ++k) {
      add_tables(*array->get(k), fmt::format("{}[{}]", path, k), files, keys);
    }
  }
}

std::vector<FileKey> files_of_options(const CheckedScenario& scenario) {
  std::vector<FileKey> keys;
  for (const auto& [option, curve] : scenario.curves) {
    keys.push_back({scenario.model + '.' + option, std::get<std::string>(scenario.options.at(option)), curve.text});
  }
  return keys;
}

}  // namespace

std::vector<FileKey> named_files(const CheckedScenario& scenario) {
  std::vector<FileKey> files = files_of_options(scenario);
  for (const auto& [name, text] : scenario.loading.files) files.push_back({"loading." + name, name, text});
  return files;
}

std::vector<FileKey> file_keys(const CheckedScenario& scenario) {
  std::vector<FileKey> keys = files_of_options(scenario);
  if (scenario.loading.files.empty()) return keys;
  const toml::table root = parse_document(text_with_overrides(scenario.text, scenario.overrides), {});
  if (const toml::node* loading = root.get("loading")) add_tables(*loading, "loading", scenario.loading.files, keys);
  return keys;
}

}  // namespace monograin
