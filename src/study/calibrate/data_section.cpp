#include "study/calibrate/data_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "scenario/text_file.hpp"
#include "scenario/units.hpp"
#include "scenario/words.hpp"
#include "study/calibrate/calibration.hpp"

namespace monograin::calibration {
namespace {

namespace fs = std::filesystem;

struct SeparatorWord {
  std::string_view word;
  char separator;
};
constexpr std::array k_separators{SeparatorWord{"comma", ','}, SeparatorWord{"semicolon", ';'},
                                  SeparatorWord{"tab", '\t'},  SeparatorWord{"blanks", ' '},
                                  SeparatorWord{",", ','},     SeparatorWord{";", ';'},
                                  SeparatorWord{"\t", '\t'},   SeparatorWord{" ", ' '}};

/// Kind of a key that may be a name, a number, a list or a table, as it is written; `otherwise` if it is absent.
KeySpec::Kind kind_of(const toml::table& table, std::string_view key, KeySpec::Kind otherwise) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return otherwise;
  if (node->is_table()) return KeySpec::Kind::table;
  if (node->is_array()) return KeySpec::Kind::texts;
  if (node->is_integer() && otherwise == KeySpec::Kind::text) return KeySpec::Kind::integer;
  return otherwise;
}

ColumnRequest request_of(const Section& section, std::string_view key, KeySpec::Kind kind) {
  ColumnRequest request{.where = section.value_place(key)};
  if (kind == KeySpec::Kind::integer) {
    request.number = static_cast<std::size_t>(section.number(key).value_or(0.0));
    request.naming = fmt::format("{} = {}", key, request.number);
  } else {
    request.name = section.text(key);
    request.naming = fmt::format("{} = \"{}\"", key, shown(request.name));
  }
  return request;
}

void read_deflections(Reading& reading, const Section& data, const fs::path& folder, Machine& machine) {
  const Keys keys = deflection_keys();
  const Section section(reading, data.table("compliance", "compliance"), keys);
  const std::string name = section.text("table");
  if (name.empty()) return;
  const fs::path path = folder / name;
  const auto [text, problem] = read_text_file(path, k_largest_data);
  if (!problem.empty()) {
    return reading.faults.add(section.value_place("table"),
                              fmt::format("table = \"{}\": {} ({}); expected a path relative to this file", shown(name),
                                          problem, on_one_line(path.string())));
  }
  const std::vector<ColumnRequest> wanted{request_of(section, "force", KeySpec::Kind::text),
                                          request_of(section, "displacement", KeySpec::Kind::text)};
  const std::size_t before = reading.faults.size();
  MeasuredData measured = parse_measured(text, path.string(), wanted, reading.faults);
  if (reading.faults.size() > before) return;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    const std::string& unit = measured.columns[k].unit;
    const ParsedQuantity one = parse_quantity("1 " + unit, k == 0 ? Dimension::force : Dimension::length, {});
    if (!one.value) {
      reading.faults.add(wanted[k].where, fmt::format("{}: {}", wanted[k].naming, one.problem));
      continue;
    }
    for (double& value : measured.columns[k].values) value *= *one.value;
  }
  machine.forces = std::move(measured.columns[0].values);
  machine.deflections = std::move(measured.columns[1].values);
  const auto fall = std::ranges::adjacent_find(machine.forces, std::greater_equal<>());
  if (machine.forces.size() < 2 || fall != machine.forces.end()) {
    reading.faults.add(section.value_place("table"),
                       fmt::format("table = \"{}\": expected at least two rows, the forces ascending", shown(name)));
  }
}

}  // namespace

DataKinds kinds_of(const toml::table& data) {
  const auto column = [&data](std::string_view key) {
    const KeySpec::Kind kind = kind_of(data, key, KeySpec::Kind::text);
    return kind == KeySpec::Kind::texts ? KeySpec::Kind::text : kind;
  };
  DataKinds kinds{.x = column("x"), .y = column("y"), .weight_column = column("weight_column")};
  if (kinds.weight_column == KeySpec::Kind::table) kinds.weight_column = KeySpec::Kind::text;
  if (kind_of(data, "units", KeySpec::Kind::choice) == KeySpec::Kind::texts) kinds.units = KeySpec::Kind::texts;
  const toml::node* compliance = data.get("compliance");
  if (compliance != nullptr && compliance->is_number()) kinds.compliance = KeySpec::Kind::quantity;
  if (compliance != nullptr && compliance->is_table()) kinds.compliance = KeySpec::Kind::table;
  return kinds;
}

TableFormat format_of(Reading& reading, const Section& data, const DataKinds& kinds) {
  TableFormat format{.most_missing = k_most_missing};
  if (const std::string word = data.text("separator"); !word.empty()) {
    const auto found = std::ranges::find(k_separators, word, &SeparatorWord::word);
    if (found != k_separators.end()) {
      format.separator = found->separator;
    } else {
      reading.faults.add(data.value_place("separator"),
                         fmt::format("separator = \"{}\": expected comma, semicolon, tab or blanks", shown(word)));
    }
  }
  if (const std::string decimal = data.text("decimal"); !decimal.empty()) format.decimal = decimal.front();
  if (const auto skip = data.number("skip")) format.skip = static_cast<std::size_t>(*skip);
  if (kinds.units == KeySpec::Kind::texts) {
    format.unit_of = data.texts("units");
  } else if (const std::string row = data.text("units"); !row.empty()) {
    format.units = row == "row" ? TableFormat::Units::row : TableFormat::Units::none;
  }
  return format;
}

ColumnSpec column_spec(Reading& reading, const Section& data, std::string_view key, KeySpec::Kind kind) {
  if (kind != KeySpec::Kind::table) {
    return {
        .request = request_of(data, key, kind), .quantity_at = data.value_place(key), .unit_at = data.value_place(key)};
  }
  const Section::Origin origin = data.table(key, std::string(key));
  const KeySpec::Kind column_kind = kind_of(*origin.table, "column", KeySpec::Kind::text);
  const bool is_number = column_kind == KeySpec::Kind::integer;
  const Keys keys = column_keys(is_number ? column_kind : KeySpec::Kind::text);
  const Section column(reading, origin, keys);
  const double scale = column.number("scale").value_or(1.0);
  if (scale == 0.0) reading.faults.add(column.value_place("scale"), "scale = 0: expected a factor other than zero");
  return {.request = request_of(column, "column", column_kind),
          .quantity = column.text("quantity"),
          .unit = column.text("unit"),
          .scale = scale == 0.0 ? 1.0 : scale,
          .quantity_at = column.value_place("quantity"),
          .unit_at = column.value_place(column.has("unit") ? "unit" : "column")};
}

std::optional<ColumnSpec> noise_column_in(const Section& data) {
  const Section::Origin origin = data.table(k_noise, std::string(k_noise));
  const KeySpec::Kind kind = kind_of(*origin.table, "column", KeySpec::Kind::text);
  if (!origin.table->contains("column") || (kind != KeySpec::Kind::text && kind != KeySpec::Kind::integer)) return {};
  FaultList ignored;  // read_noise() reads the section again, and reports its faults
  Reading reading{ignored};
  const Keys keys = noise_keys(Dimension::none, Dimension::none, kind);
  const Section noise(reading, origin, keys);
  return ColumnSpec{.request = request_of(noise, "column", kind),
                    .quantity_at = noise.value_place("column"),
                    .unit_at = noise.value_place("column")};
}

NoiseParts read_noise(Reading& reading, const Section& data, Dimension of_x, Dimension of_y) {
  const Section::Origin origin = data.table(k_noise, std::string(k_noise));
  const Keys keys = noise_keys(of_x, of_y, kind_of(*origin.table, "column", KeySpec::Kind::text));
  const Section noise(reading, origin, keys);
  if (noise.has("column") && (noise.has("absolute") || noise.has("relative"))) {
    reading.faults.add(noise.value_place("column"),
                       "a column has the whole standard deviation of y; expected neither absolute nor relative");
  }
  if (noise.has("x") && !noise.has("column") && !noise.has("absolute") && !noise.has("relative")) {
    reading.faults.add(
        noise.value_place("x"),
        "noise of x changes nothing where y is constant; expected noise of y, too: for example absolute");
  }
  return {.absolute = noise.number("absolute").value_or(0.0),
          .relative = noise.number("relative").value_or(0.0),
          .x = noise.number("x").value_or(0.0)};
}

ParsedCompliance compliance_in(Reading& reading, const Section& section, std::string_view key) {
  const std::string text = section.text(key);
  ParsedCompliance parsed = parse_compliance(text);
  if (parsed.value && !(*parsed.value >= 0.0)) parsed.value.reset();
  if (!parsed.value && !text.empty()) {
    reading.faults.add(section.value_place(key),
                       fmt::format("{} = \"{}\": expected a length over a force, 0 or more, for example \"20 nm/N\"",
                                   key, shown(text)));
  }
  return parsed;
}

Machine machine_in(Reading& reading, const Section& data, KeySpec::Kind kind, const fs::path& folder) {
  Machine machine{.offset = data.number("offset").value_or(0.0),
                  .force_offset = data.number("force_offset").value_or(0.0)};
  if (!data.has("compliance")) return machine;
  if (kind == KeySpec::Kind::quantity) machine.compliance = data.number("compliance").value_or(0.0);
  if (kind == KeySpec::Kind::text) machine.compliance = compliance_in(reading, data, "compliance").value.value_or(0.0);
  if (kind == KeySpec::Kind::table) read_deflections(reading, data, folder, machine);
  return machine;
}

}  // namespace monograin::calibration
