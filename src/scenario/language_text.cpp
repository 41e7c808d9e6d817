// Descriptions of the language's keys for messages.

#include <fmt/format.h>

#include "scenario/language.hpp"
#include "scenario/units.hpp"
#include "scenario/words.hpp"

namespace monograin {
namespace {

using Kind = KeySpec::Kind;

std::string example_of(const KeySpec& spec) {
  if (!spec.example.empty()) return spec.example;
  switch (spec.kind) {
    case Kind::choice:
      return fmt::format("\"{}\"", spec.choices.front());
    case Kind::toggle:
      return "true";
    case Kind::integer:
      return fmt::format("{}", std::get<double>(spec.default_value));
    case Kind::quantity:
      return std::string(dimension_info(spec.dimension).example);
    case Kind::text:
    case Kind::identifier:
    case Kind::mark:
    case Kind::file:
    case Kind::column:
    case Kind::pair:
    case Kind::instants:
    case Kind::direction:
    case Kind::texts:
    case Kind::table:
    case Kind::tables:
    case Kind::any:
      break;
  }
  return "...";
}

}  // namespace

Range finite_range(const KeySpec& spec) noexcept { return plausible_range(spec.dimension, spec.range); }

std::string example_line(const KeySpec& spec) {
  const std::string example = example_of(spec);
  const bool is_header = spec.kind == Kind::tables || (spec.kind == Kind::table && example.front() == '[');
  return is_header ? example : fmt::format("{} = {}", spec.name, example);
}

std::string expectation(const KeySpec& spec) {
  switch (spec.kind) {
    case Kind::text:
      return fmt::format("a text in quotes, for example {}", example_of(spec));
    case Kind::file:
      return fmt::format("the name of a file in quotes, for example {}", example_of(spec));
    case Kind::column:
      return fmt::format("the heading of a column in quotes, for example {}, or its number from 1", example_of(spec));
    case Kind::identifier:
      return fmt::format("a name of letters, digits, '_' and '-' that begins with a letter, for example {}",
                         example_of(spec));
    case Kind::toggle:
      return "true or false";
    case Kind::mark:
      return "true";
    case Kind::choice:
      return spec.choices.size() == 1 ? std::string(spec.choices.front()) : "one of " + listed(spec.choices);
    case Kind::integer: {
      if (spec.range.lower + spec.multiple_of == spec.range.upper) {
        return fmt::format("{:.0f} or {:.0f}", spec.range.lower, spec.range.upper);
      }
      const std::string range = fmt::format("from {:.0f} to {:.0f}", spec.range.lower, spec.range.upper);
      return spec.multiple_of == 1 ? "a whole number " + range
                                   : fmt::format("a multiple of {} {}", spec.multiple_of, range);
    }
    case Kind::quantity:
      if (spec.dimension == Dimension::none) return describe(spec.dimension, finite_range(spec));
      return fmt::format("{}, for example {}", dimension_info(spec.dimension).noun, example_of(spec));
    case Kind::pair:
      return fmt::format("{} or a list of two, for example {}", dimension_info(spec.dimension).noun, example_of(spec));
    case Kind::instants:
      return fmt::format("a list of ascending times, for example {}", example_of(spec));
    case Kind::direction:
      return fmt::format("three numbers, for example {}", example_of(spec));
    case Kind::texts:
      return fmt::format("a list of texts or numbers, for example {}", example_of(spec));
    case Kind::table:
      return fmt::format("a table, written {}", example_line(spec));
    case Kind::tables:
      return fmt::format("an array of tables, written {}", example_line(spec));
    case Kind::any:
      break;
  }
  return {};
}

}  // namespace monograin
