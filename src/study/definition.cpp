#include "study/definition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>

#include "scenario/document.hpp"
#include "scenario/overrides.hpp"
#include "scenario/section.hpp"
#include "scenario/words.hpp"
#include "study/definition_language.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;
using namespace definition;
using Style = figure::ChartSeries::Style;

template <std::size_t N>
[[nodiscard]] std::size_t place_of_word(const std::array<std::string_view, N>& words, std::string_view word) {
  const auto place = static_cast<std::size_t>(std::ranges::find(words, word) - words.begin());
  return place < N ? place : 0;  // a word that is none of them has been reported
}

/// The formulas and axes that a panel takes from the definition where it has none.
struct Inherited {
  std::optional<PlacedExpression> x;
  std::optional<PlacedExpression> y;
};

class DefinitionReader {
 public:
  DefinitionReader(const fs::path& file, FaultList& faults) : file_(file), faults_(faults), reading_{faults} {}

  [[nodiscard]] Definition read() {
    text_ = contents();
    const toml::table tree = parse_document(text_, file_.string());
    const Keys keys = root_keys();
    const SourceLocation top{file_.string()};
    const Section root(reading_, {&tree, top, "the definition"}, keys);
    has_scenario_ = root.has("scenario");

    Definition definition{.name = file_.stem().string(),
                          .title = root.text("title"),
                          .source = root.text("source"),
                          .format = root.text("format"),
                          .adhesion_map = {},
                          .panels = {},
                          .tables = {}};
    if (root.has("adhesion_map")) definition.adhesion_map = adhesion_map(root);
    const Inherited inherited{formula(root, "x"), formula(root, "y")};
    for (const auto& table : root.tables("panel", "[[panel]]")) {
      definition.panels.push_back(panel(table, root, inherited));
    }
    for (const auto& table : root.tables("table", "[[table]]")) {
      definition.tables.push_back(comparison_table(table, inherited));
    }
    const auto shows = [&root](std::string_view key) { return root.has_or_misspells(key); };
    if (!shows("panel") && !shows("table") && !shows("adhesion_map")) {
      faults_.add(root.place(), "the definition shows nothing; expected [[panel]], [[table]] or [adhesion_map]");
    }
    return definition;
  }

 private:
  [[nodiscard]] std::string contents() const {
    std::ifstream in(file_, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(in), {}};
    if (!in.is_open() || in.bad()) throw_fault({file_.string()}, "the file cannot be read");
    return text;
  }

  [[nodiscard]] std::optional<PlacedExpression> formula(const Section& section, std::string_view key) {
    if (!section.has(key) || section.text(key).empty()) return std::nullopt;
    SourceLocation where = section.value_place(key);
    ++where.column;  // after the quote
    try {
      return PlacedExpression{Expression(section.text(key)), where};
    } catch (const ExpressionError& error) {
      where.column += error.offset();
      faults_.add(where, fmt::format("{} = \"{}\": {}", key, shown(section.text(key)), error.what()));
      return PlacedExpression{};
    }
  }

  /// The section's own formula, else the inherited one; a fault where there is neither.
  [[nodiscard]] PlacedExpression formula(const Section& section, std::string_view key,
                                         const std::optional<PlacedExpression>& inherited) {
    if (auto own = formula(section, key)) return *own;
    if (inherited) return *inherited;
    if (!section.has_or_misspells(key)) {
      faults_.add(section.place(), fmt::format("there is no '{0}' for this curve; expected {0} = {1}", key,
                                               key == "x" ? k_example_x : k_example_y));
    }
    return {};
  }

  [[nodiscard]] static figure::ChartAxis axis(const Section& panel, const Section& root, char name) {
    const auto key = [name](std::string_view what) { return fmt::format("{}_{}", name, what); };
    const auto number = [&](const std::string& which) {
      return panel.has(which) ? panel.number(which) : root.number(which);
    };
    const Section& labelled = panel.has(key("label")) ? panel : root;
    const Section& scaled = panel.has(key("log")) ? panel : root;
    return {.label = labelled.text(key("label")),
            .lowest = number(key("min")),
            .highest = number(key("max")),
            .is_logarithmic = scaled.toggle(key("log")).value_or(false)};
  }

  void check_range(const Section& panel, const figure::ChartAxis& axis, char name) {
    if (axis.is_logarithmic && ((axis.lowest && *axis.lowest <= 0.0) || (axis.highest && *axis.highest <= 0.0))) {
      faults_.add(panel.place(), fmt::format("a logarithmic axis has no place for {}_min or {}_max = 0", name, name));
    } else if (axis.lowest && axis.highest && *axis.lowest >= *axis.highest) {
      faults_.add(panel.place(), fmt::format("{0}_min is not below {0}_max", name));
    }
  }

  [[nodiscard]] AdhesionMapSettings adhesion_map(const Section& root) {
    static const Keys keys = adhesion_map_keys();
    const Section section(reading_, root.table("adhesion_map", "[adhesion_map]"), keys);
    AdhesionMapSettings settings;
    settings.least_modulus = section.number("least_modulus").value_or(settings.least_modulus);
    settings.least_yield_stress = section.number("least_yield_stress").value_or(settings.least_yield_stress);
    settings.decades = section.number("decades").value_or(settings.decades);
    settings.points = static_cast<std::size_t>(section.number("points").value_or(2.0));
    settings.poisson_ratio = section.number("poisson_ratio").value_or(settings.poisson_ratio);
    settings.control = section.text("control") == "force" ? Control::force : Control::displacement;
    return settings;
  }

  [[nodiscard]] PanelSpec panel(const Section::Origin& table, const Section& root, const Inherited& inherited) {
    static const Keys keys = panel_keys();
    const Section section(reading_, table, keys);
    PanelSpec spec{.x = axis(section, root, 'x'),
                   .y = axis(section, root, 'y'),
                   .note = section.text("note"),
                   .curves = {},
                   .points = {}};
    check_range(section, spec.x, 'x');
    check_range(section, spec.y, 'y');
    const auto own_x = formula(section, "x");
    const auto own_y = formula(section, "y");
    const Inherited formulas{own_x ? own_x : inherited.x, own_y ? own_y : inherited.y};
    for (const auto& entry : section.tables("curve", "[[panel.curve]]")) spec.curves.push_back(curve(entry, formulas));
    for (const auto& entry : section.tables("points", "[[panel.points]]")) spec.points.push_back(points(entry));
    if (!section.has_or_misspells("curve") && !section.has_or_misspells("points")) {
      faults_.add(section.place(), "the panel is empty; expected [[panel.curve]] or [[panel.points]]");
    }
    return spec;
  }

  [[nodiscard]] CurveSpec curve(const Section::Origin& table, const Inherited& inherited) {
    static const Keys keys = curve_keys();
    const Section section(reading_, table, keys);
    CurveSpec spec{.scenarios = {},
                   .legends = {section.text("legend")},
                   .x = formula(section, "x", inherited.x),
                   .y = formula(section, "y", inherited.y),
                   .rows = static_cast<RowChoice>(place_of_word(k_rows, section.text("rows"))),
                   .style = static_cast<Style>(place_of_word(k_styles, section.text("style"))),
                   .colour = colour(section),
                   .profile_at = section.number("profile_at"),
                   .parameter = {}};
    if (section.has("parameter")) spec.parameter = parameter(section);
    if (section.has("vary")) {
      vary(section, spec);
    } else if (!spec.parameter || has_scenario_ || section.has("scenario")) {
      add_scenario(section, {}, section.place(), spec);
    }
    return spec;
  }

  [[nodiscard]] static std::optional<std::size_t> colour(const Section& section) {
    const auto number = section.number("colour");
    return number ? std::optional(static_cast<std::size_t>(*number) - 1) : std::nullopt;
  }

  [[nodiscard]] CurveSpec::Parameter parameter(const Section& curve) {
    static const Keys keys = parameter_keys();
    const Section section(reading_, curve.table("parameter", "parameter"), keys);
    return {section.number("from").value_or(0.0), section.number("to").value_or(1.0)};
  }

  void vary(const Section& curve, CurveSpec& spec) {
    static const Keys keys = vary_keys();
    const Section section(reading_, curve.table("vary", "vary"), keys);
    const std::string key = section.text("key");
    const std::vector<std::string> values = section.texts("values");
    std::vector<std::string> legends = section.texts("legends");
    if (section.has("legends") && legends.size() != values.size()) {
      faults_.add(section.value_place("legends"),
                  fmt::format("{} legends for {} values", legends.size(), values.size()));
    }
    const bool is_named = !legends.empty() || !spec.legends.front().empty();
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (!is_named) legends.push_back(fmt::format("{} = {}", key.substr(key.rfind('.') + 1), values[k]));
      add_scenario(curve, fmt::format("{}={}", key, values[k]), section.value_place("values", k), spec);
    }
    if (!legends.empty()) spec.legends = std::move(legends);
  }

  /// The curve's scenario, with its overrides and one more; that one stands at `where`.
  void add_scenario(const Section& curve, const std::string& varied, const SourceLocation& where, CurveSpec& spec) {
    std::vector<std::string> overrides = curve.texts("set");
    const std::size_t own = overrides.size();
    if (!varied.empty()) overrides.push_back(varied);
    try {
      spec.scenarios.push_back(scenario(curve, overrides));
    } catch (const ScenarioError& error) {
      for (const Fault& fault : error.faults()) {
        if (!is_override(fault.where)) {
          faults_.add(fault.where, fault.message);
          continue;
        }
        // The override is known by its text; that of the varied key is none of those in the list.
        std::size_t entry = 0;
        while (entry < own && fault.where.file.find(overrides[entry]) == std::string::npos) ++entry;
        faults_.add(entry < own ? curve.value_place("set", entry) : where,
                    fmt::format("{}: {}", entry < own ? overrides[entry] : varied, fault.message));
      }
    }
  }

  [[nodiscard]] Scenario scenario(const Section& curve, const std::vector<std::string>& overrides) {
    if (!curve.has("scenario")) {
      if (!has_scenario_) {
        throw_fault(curve.place(), "the curve has no scenario; expected scenario = \"FILE\" or a table [scenario]");
      }
      return parse_scenario_table(text_, "scenario", file_.string(), overrides);
    }
    const fs::path file = file_.parent_path() / curve.text("scenario");
    if (!fs::is_regular_file(file)) {
      throw_fault(curve.value_place("scenario"), fmt::format("{}: there is no such file", file.string()));
    }
    return read_scenario(file, overrides);
  }

  [[nodiscard]] PointsSpec points(const Section::Origin& table) {
    static const Keys keys = points_keys();
    const Section section(reading_, table, keys);
    PointsSpec spec{.table = {},
                    .x = formula(section, "x").value_or(PlacedExpression{}),
                    .y = formula(section, "y").value_or(PlacedExpression{}),
                    .rows = static_cast<RowChoice>(place_of_word(k_rows, section.text("rows"))),
                    .every = static_cast<std::size_t>(section.number("every").value_or(1.0)),
                    .legend = section.text("legend"),
                    .colour = colour(section)};
    if (section.text("file").empty()) return spec;
    try {
      spec.table = read_csv(file_.parent_path() / section.text("file"));
    } catch (const std::runtime_error& error) {
      faults_.add(section.value_place("file"), error.what());
    }
    return spec;
  }

  [[nodiscard]] TableSpec comparison_table(const Section::Origin& table, const Inherited& inherited) {
    static const Keys keys = comparison_table_keys();
    const Section section(reading_, table, keys);
    const auto own_x = formula(section, "x");
    const auto own_y = formula(section, "y");
    const Inherited formulas{own_x ? own_x : inherited.x, own_y ? own_y : inherited.y};
    TableSpec spec{.title = plain(section, "title"), .rows = {}};
    for (const auto& row : section.tables("row", "[[table.row]]")) {
      static const Keys row_keys = comparison_keys();
      const Section entry(reading_, row, row_keys);
      spec.rows.push_back({plain(entry, "label"),
                           entry.has("curve") ? curve(entry.table("curve", "curve"), formulas) : CurveSpec{},
                           entry.has("points") ? points(entry.table("points", "points")) : PointsSpec{}});
      if (spec.rows.back().curve.scenarios.size() > 1) {
        faults_.add(entry.value_place("curve"), "'vary' gives several curves; expected one curve in each row");
      }
    }
    return spec;
  }

  /// A text that will be a cell of a CSV file.
  [[nodiscard]] std::string plain(const Section& section, std::string_view key) {
    const std::string text = section.text(key);
    if (text.find_first_of(",\"|\r\n") != std::string::npos) {
      faults_.add(section.value_place(key),
                  fmt::format("{} = \"{}\": commas, quotes, bars and line breaks cannot stand "
                              "in a table",
                              key, shown(text)));
    }
    return text;
  }

  fs::path file_;
  FaultList& faults_;
  Reading reading_;
  std::string text_;
  bool has_scenario_ = false;
};

}  // namespace

Definition read_definition(const fs::path& file, FaultList& faults) { return DefinitionReader(file, faults).read(); }

}  // namespace monograin
