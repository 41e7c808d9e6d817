#include "scenario/scenario.hpp"

#include <array>
#include <fstream>
#include <system_error>
#include <utility>

#include "scenario/document.hpp"
#include "scenario/faults.hpp"
#include "scenario/overrides.hpp"
#include "scenario/reader.hpp"

namespace monograin {
namespace {

std::string read_file(const std::filesystem::path& file) {
  const SourceLocation where{file.string()};
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) throw_fault(where, "there is no such file; expected a scenario file");
  if (std::filesystem::is_directory(status)) throw_fault(where, "this is a directory; expected a scenario file");
  std::ifstream stream(file, std::ios::binary);
  std::string text;
  std::array<char, 65536> chunk{};
  // A text beyond the limit is refused by the parser; pipes and devices need not end.
  while (stream && text.size() <= k_largest_text) {
    stream.read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
    text.append(chunk.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (!stream.is_open() || stream.bad()) throw_fault(where, "the file cannot be read; check its permissions");
  return text;
}

std::string name_of(const std::string& origin) {
  const std::string stem = std::filesystem::path(origin).stem().string();
  return stem.empty() ? "scenario" : stem;
}

}  // namespace

Scenario read_scenario(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return parse_scenario(read_file(file), file.string(), overrides);
}

Scenario parse_scenario(std::string_view text, const std::string& origin, const std::vector<std::string>& overrides) {
  FaultList faults;
  toml::table root = parse_document(text, origin);
  for (const std::string& override_text : overrides) apply_override(root, override_text, faults);
  Scenario scenario = read_tree(root, origin, faults);
  faults.throw_if_any();
  scenario.name = name_of(origin);
  scenario.text = text;
  scenario.overrides = overrides;
  return scenario;
}

}  // namespace monograin
