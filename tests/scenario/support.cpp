#include "scenario/support.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "scenario/scenario.hpp"

namespace monograin {

std::string with_line(std::size_t number, std::string_view line) {
  std::istringstream lines{std::string(k_good_scenario)};
  std::string text;
  std::string own;
  for (std::size_t i = 1; std::getline(lines, own); ++i) text += (i == number ? std::string(line) : own) + '\n';
  return text;
}

std::string with_more(std::string_view lines) { return std::string(k_good_scenario).append(lines); }

std::string with_loading(std::string_view lines) {
  return std::string(k_good_scenario.substr(0, k_good_scenario.find("[loading]"))).append(lines);
}

std::vector<std::string> faults_of(std::string_view text, const std::vector<std::string>& overrides) {
  std::vector<std::string> lines;
  try {
    static_cast<void>(parse_scenario(text, "die.toml", overrides));
  } catch (const ScenarioError& error) {
    std::istringstream messages(error.what());
    for (std::string line; std::getline(messages, line);) lines.push_back(line);
  }
  return lines;
}

std::vector<std::filesystem::path> toml_files(std::string_view folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(MONOGRAIN_SOURCE_DIR) / folder)) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  if (files.empty()) throw std::runtime_error("no files to test in " + std::string(folder));
  std::ranges::sort(files);
  return files;
}

}  // namespace monograin
