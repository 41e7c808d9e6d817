// Malformed scenarios, made by hand and by mutation: none passes, and every message says where.

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/json.hpp"
#include "scenario/scenario.hpp"
#include "scenario/support.hpp"
#include "support/text_file.hpp"

namespace monograin::corpus_test {
namespace {

std::size_t take_while(std::string_view text, std::size_t from, bool (*belongs)(char)) {
  while (from < text.size() && belongs(text[from])) ++from;
  return from;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// True if the message begins with origin:line:column.
bool begins_with_a_place(std::string_view message) {
  constexpr std::string_view origin = "die.toml:";
  if (!message.starts_with(origin)) return false;
  const std::size_t line = origin.size();
  const std::size_t line_end = take_while(message, line, is_digit);
  if (line_end == line || !message.substr(line_end).starts_with(':')) return false;
  const std::size_t column_end = take_while(message, line_end + 1, is_digit);
  return column_end > line_end + 1 && message.substr(column_end).starts_with(": ");
}

void expect_refusal(std::string_view text, const std::string& what) {
  const std::vector<std::string> faults = faults_of(text);
  EXPECT_FALSE(faults.empty()) << what << " was accepted:\n" << text;
  for (const std::string& fault : faults) EXPECT_TRUE(begins_with_a_place(fault)) << what << ": " << fault;
}

TEST(Corpus, IsRefusedByTheReader) {
  const auto files = toml_files("tests/scenario/corpus");
  EXPECT_GE(files.size(), 80U);
  for (const auto& file : files) expect_refusal(read_text(file), file.filename().string());
}

TEST(Corpus, IsRefusedByTheSchemaWhereItIsToml) {
  int checked = 0;
  for (const auto& file : toml_files("tests/scenario/corpus")) {
    const std::string text = read_text(file);
    // A key of thousands of parts would overflow the stack when its tables are destroyed.
    if (file.stem() == "deep-keys") continue;
    const auto value = toml_as_json(text);
    if (!value) continue;
    ++checked;
    EXPECT_FALSE(schema_accepts(*value)) << file.filename() << ":\n" << text;
  }
  EXPECT_GE(checked, 80);
}

// --- mutations

using Lines = std::vector<std::string>;
using Random = std::mt19937;

Lines lines_of(std::string_view text) {
  Lines lines;
  std::istringstream stream{std::string(text)};
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::string joined(const Lines& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + '\n';
  return text;
}

std::size_t pick(Random& random, std::size_t count) { return random() % count; }

/// A line `key = value` in which the rules may change key or value; lines of inline tables are left alone.
struct Assignment {
  std::size_t line = 0;
  std::string key;
  std::string value;
};

bool belongs_to_a_key(char c) { return (c >= 'a' && c <= 'z') || c == '_'; }
bool is_space(char c) { return c == ' '; }

std::vector<Assignment> assignments_in(const Lines& lines) {
  std::vector<Assignment> found;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string& line = lines[i];
    const std::size_t key_end = take_while(line, 0, belongs_to_a_key);
    const std::size_t equals = take_while(line, key_end, is_space);
    const bool is_assignment = key_end > 0 && equals < line.size() && line[equals] == '=';
    if (!is_assignment || line.find_first_of("{}") != std::string::npos || line.ends_with('[')) continue;
    found.push_back({i, line.substr(0, key_end), line.substr(take_while(line, equals + 1, is_space))});
  }
  return found;
}

/// True if the value is a text such as "10 mm".
bool has_unit(std::string_view value) {
  return value.size() > 2 && value.front() == '"' && is_digit(value[1]) && value.find(' ') != std::string_view::npos;
}

void assign(Lines& lines, const Assignment& target, std::string_view value) {
  lines[target.line] = target.key + " = " + std::string(value);
}

/// Each rule makes any ready scenario wrong, wherever it strikes.
struct Rule {
  const char* name;
  std::function<std::string(const std::string&, Random&)> apply;
};

std::string on_an_assignment(const std::string& text, Random& random,
                             const std::function<void(Lines&, const Assignment&)>& change) {
  Lines lines = lines_of(text);
  const auto assignments = assignments_in(lines);
  change(lines, assignments[pick(random, assignments.size())]);
  return joined(lines);
}

/// A rule that puts another value in place of one that is there.
Rule value_rule(const char* name, const char* value) {
  return {name, [value](const std::string& text, Random& random) {
            return on_an_assignment(text, random,
                                    [&](Lines& lines, const Assignment& target) { assign(lines, target, value); });
          }};
}

const std::vector<Rule>& rules() {
  static const std::vector<Rule> all{
      value_rule("not a number", "nan"),
      value_rule("infinite", "-inf"),
      value_rule("huge", "1e308"),
      value_rule("overflowing", "1e999"),
      value_rule("a date", "1979-05-27"),
      value_rule("a table", "{ a = 1 }"),
      value_rule("nested arrays", "[[[]]]"),
      value_rule("missing", ""),
      value_rule("bare words", "0.1 R0 mm"),
      {"misspelt key",
       [](const std::string& text, Random& random) {
         return on_an_assignment(text, random, [&](Lines& lines, const Assignment& target) {
           lines[target.line].insert(pick(random, target.key.size()), "zq");
         });
       }},
      {"duplicate key",
       [](const std::string& text, Random& random) {
         return on_an_assignment(text, random, [&](Lines& lines, const Assignment& target) {
           lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(target.line), target.key + " = " + target.value);
         });
       }},
      {"unknown unit",
       [](const std::string& text, Random& random) {
         Lines lines = lines_of(text);
         std::vector<Assignment> with_unit;
         for (const Assignment& target : assignments_in(lines)) {
           if (has_unit(target.value)) with_unit.push_back(target);
         }
         const Assignment& target = with_unit[pick(random, with_unit.size())];
         assign(lines, target, target.value.substr(0, target.value.size() - 1) + "q\"");
         return joined(lines);
       }},
      {"lost quote",
       [](const std::string& text, Random& random) {
         std::vector<std::size_t> quotes;
         for (std::size_t i = text.find("model"); i < text.size(); ++i) {
           if (text[i] == '"') quotes.push_back(i);
         }
         std::string changed = text;
         return changed.erase(quotes[pick(random, quotes.size())], 1);
       }},
      {"cut off inside a string",
       [](const std::string& text, Random& random) {
         Lines lines = lines_of(text);
         std::vector<std::size_t> with_text;
         for (const Assignment& target : assignments_in(lines)) {
           if (target.value.front() == '"') with_text.push_back(target.line);
         }
         lines.resize(with_text[pick(random, with_text.size())] + 1);
         lines.back().pop_back();
         std::string changed = joined(lines);
         changed.pop_back();
         return changed;
       }},
      {"byte that is no text",
       [](const std::string& text, Random& random) {
         std::string changed = text;
         return changed.insert(pick(random, text.size()), 1, static_cast<char>(0xFF));
       }},
      {"lost table header",
       [](const std::string& text, Random&) {
         std::string changed = text;
         return changed.erase(changed.find("[material]"), 10);
       }},
      {"unknown table", [](const std::string& text, Random&) { return text + "\n[walls]\nname = \"x\"\n"; }},
      {"table of another model", [](const std::string& text, Random&) { return text + "\n[packing]\n"; }},
  };
  return all;
}

TEST(Mutations, AreAllRefused) {
  std::vector<std::string> originals;
  for (const auto& file : toml_files("scenarios")) originals.push_back(read_text(file));
  Random random(20240229U);
  int made = 0;
  for (const Rule& rule : rules()) {
    for (int round = 0; round < 4; ++round) {
      for (const std::string& original : originals) {
        expect_refusal(rule.apply(original, random), rule.name);
        ++made;
      }
    }
  }
  EXPECT_GE(made, 300);
}

TEST(Mutations, OfSingleBytesNeverEndTheProgram) {
  const std::string original(default_scenario_text());
  Random random(7U);
  for (int i = 0; i < 2000; ++i) {
    std::string text = original;
    for (std::size_t changes = 1 + pick(random, 4); changes > 0; --changes) {
      text[pick(random, text.size())] = static_cast<char>(random() % 256U);
    }
    for (const std::string& fault : faults_of(text)) EXPECT_TRUE(fault.starts_with("die.toml:")) << fault;
  }
}

}  // namespace
}  // namespace monograin::corpus_test
