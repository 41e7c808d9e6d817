// The equation indexes of docs/theory: every row names a function that its header declares, and a test that exists.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "support/text_file.hpp"

namespace monograin::equation_index_test {
namespace {

namespace fs = std::filesystem;

fs::path in_tree(const std::string& path) { return fs::path(MONOGRAIN_SOURCE_DIR) / path; }

bool is_of_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

/// Cells of a row of a Markdown table.
std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> cells;
  line = trimmed(line);
  for (line.remove_prefix(1); !line.empty();) {
    const std::size_t end = std::min(line.find('|'), line.size());
    cells.emplace_back(trimmed(line.substr(0, end)));
    line.remove_prefix(std::min(end + 1, line.size()));
  }
  return cells;
}

/// The texts between backticks.
std::vector<std::string> codes_of(const std::string& cell) {
  std::vector<std::string> codes;
  for (std::size_t begin = cell.find('`'); begin != std::string::npos;) {
    const std::size_t end = cell.find('`', begin + 1);
    if (end == std::string::npos) break;
    codes.push_back(cell.substr(begin + 1, end - begin - 1));
    begin = cell.find('`', end + 1);
  }
  return codes;
}

/// One row of an index.
struct Row {
  std::string text;
  std::string equations;
  std::vector<std::string> functions;
  std::vector<std::string> headers;
  std::vector<std::string> tests;
};

/// Rows of the tables under the headings "Equation index" of a page.
std::vector<Row> index_of(const fs::path& page) {
  std::vector<Row> rows;
  std::ifstream stream(page);
  bool is_in_index = false;
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with('#')) is_in_index = line.ends_with(" Equation index");
    if (!is_in_index || !line.starts_with('|')) continue;
    const std::vector<std::string> cells = cells_of(line);
    if (cells.size() != 3) {
      ADD_FAILURE() << page.filename() << ": a row without three cells: " << line;
      continue;
    }
    if (cells[0] == "source equation" || cells[0].starts_with("---")) continue;
    Row row{.text = line, .equations = cells[0], .functions = {}, .headers = {}, .tests = codes_of(cells[2])};
    for (const std::string& code : codes_of(cells[1])) {
      (code.starts_with("models/") ? row.headers : row.functions).push_back(code);
    }
    rows.push_back(row);
  }
  return rows;
}

/// Pages by the name of the model that they are about.
std::map<std::string, fs::path> pages() {
  std::map<std::string, fs::path> found;
  for (const auto& entry : fs::directory_iterator(in_tree("docs/theory"))) {
    if (entry.path().extension() == ".md" && entry.path().stem() != "index") {
      found[entry.path().stem().string()] = entry.path();
    }
  }
  return found;
}

template <class Visit>
void for_each_row(Visit visit) {
  for (const auto& [model, page] : pages()) {
    for (const Row& row : index_of(page)) visit(row);
  }
}

std::string without_comments(const std::string& source) {
  std::istringstream stream(source);
  std::string code;
  for (std::string line; std::getline(stream, line);) code += line.substr(0, line.find("//")) + '\n';
  return code;
}

/// True if the word stands in the code with one of these behind it.
bool has_word(std::string_view code, std::string_view word, std::string_view followers) {
  for (std::size_t at = code.find(word); at != std::string_view::npos; at = code.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    const bool begins = at == 0 || !is_of_word(code[at - 1]);
    if (begins && end < code.size() && followers.find(code[end]) != std::string_view::npos) return true;
  }
  return false;
}

/// True if the header declares a function, written as `name` or as `Class::name`.
bool declares(const std::string& code, const std::string& function) {
  const std::size_t colons = function.rfind("::");
  if (colons == std::string::npos) return has_word(code, function, "(");
  const std::string owner = function.substr(0, colons);
  for (const std::string keyword : {"struct ", "class "}) {
    const std::size_t begin = code.find(keyword + owner + ' ');
    if (begin == std::string::npos) continue;
    const std::size_t end = std::min(code.find("\n};", begin), code.size());
    return has_word(std::string_view(code).substr(begin, end - begin), function.substr(colons + 2), "(");
  }
  return false;
}

/// Names of all tests, as Suite.Name.
std::set<std::string> all_tests() {
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(in_tree("tests"))) {
    if (entry.path().extension() != ".cpp") continue;
    std::ifstream stream(entry.path());
    for (std::string line; std::getline(stream, line);) {
      if (!line.starts_with("TEST")) continue;
      const std::size_t open = line.find('(');
      const std::size_t comma = line.find(',', open);
      const std::size_t close = line.find(')', comma);
      if (open == std::string::npos || comma == std::string::npos || close == std::string::npos) continue;
      const auto part = [&](std::size_t begin, std::size_t end) {
        return std::string(trimmed(std::string_view(line).substr(begin + 1, end - begin - 1)));
      };
      names.insert(part(open, comma) + '.' + part(comma, close));
    }
  }
  return names;
}

/// Names of the models, from the list of their namespaces.
std::set<std::string> all_models() {
  constexpr std::string_view k_line = "\n  MODEL(";
  std::set<std::string> names;
  const std::string code = read_text(in_tree("models/catalogue.cpp"));
  for (std::size_t at = code.find(k_line); at != std::string::npos; at = code.find(k_line, at + 1)) {
    const std::size_t begin = at + k_line.size();
    std::string name = code.substr(begin, code.find(')', begin) - begin);
    std::ranges::replace(name, '_', '-');
    names.insert(name);
  }
  return names;
}

TEST(EquationIndex, StandsOnThePageOfEveryModel) {
  const std::set<std::string> models = all_models();
  EXPECT_GE(models.size(), 10U);
  const std::map<std::string, fs::path> found = pages();
  for (const std::string& model : models) EXPECT_TRUE(found.contains(model)) << "no page docs/theory/" << model;
  for (const auto& [model, page] : found) {
    EXPECT_TRUE(models.contains(model)) << page << " is about no model";
    const std::string text = read_text(page);
    std::size_t equations = 0;
    for (std::size_t at = text.find("\n$$ ("); at != std::string::npos; at = text.find("\n$$ (", at + 1)) ++equations;
    EXPECT_GE(index_of(page).size(), std::max<std::size_t>(1, equations))
        << page << " has an equation index with fewer rows than the page has numbered equations";
    EXPECT_TRUE(read_text(page).starts_with("(theory-" + model + ")=\n")) << page << " has no label";
  }
}

TEST(EquationIndex, NamesAnEquationInEveryRow) {
  for_each_row([](const Row& row) {
    const bool has_number =
        std::any_of(row.equations.begin(), row.equations.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
    EXPECT_TRUE(has_number) << row.text;
  });
}

TEST(EquationIndex, NamesFunctionsThatTheirHeadersDeclare) {
  for_each_row([](const Row& row) {
    EXPECT_FALSE(row.functions.empty()) << row.text;
    ASSERT_EQ(row.headers.size(), 1U) << row.text;
    const fs::path header = in_tree(row.headers.front());
    ASSERT_TRUE(header.extension() == ".hpp" && fs::exists(header)) << row.text;
    const std::string code = without_comments(read_text(header));
    for (const std::string& function : row.functions) {
      EXPECT_TRUE(declares(code, function)) << row.headers.front() << " declares no " << function;
    }
  });
}

TEST(EquationIndex, NamesTestsThatExist) {
  const std::set<std::string> tests = all_tests();
  EXPECT_GT(tests.size(), 1000U);
  for_each_row([&](const Row& row) {
    EXPECT_FALSE(row.tests.empty()) << row.text;
    for (const std::string& test : row.tests) EXPECT_TRUE(tests.contains(test)) << "no test " << test;
  });
}

}  // namespace
}  // namespace monograin::equation_index_test
