#include "study/atlas/definition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numeric>
#include <string_view>
#include <system_error>
#include <utility>

#include "figure/page.hpp"
#include "scenario/document.hpp"
#include "scenario/overrides.hpp"
#include "scenario/section.hpp"
#include "scenario/text_file.hpp"
#include "scenario/words.hpp"
#include "study/atlas/definition_language.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;
using namespace definition;
using Style = figure::ChartSeries::Style;

template <std::size_t N>
[[nodiscard]] std::size_t place_of_word(const std::array<std::string_view, N>& words, std::string_view word) {
  const auto place = static_cast<std::size_t>(std::ranges::find(words, word) - words.begin());
  return place < N ? place : 0;  // an unknown word has been reported
}

/// Formulas and sections that a curve without its own takes from its panel, and the panel from the definition.
struct Inherited {
  std::optional<PlacedExpression> x{};
  std::optional<PlacedExpression> y{};
  const Section* vary = nullptr;     ///< section with key `vary`; null: none
  const Section* against = nullptr;  ///< section with key `against`; null: none
  const Section* panel = nullptr;    ///< section whose overrides precede the curve's; null: none
};

class DefinitionReader {
 public:
  DefinitionReader(NamedText source, FaultList& faults)
      : file_(std::move(source.file)), faults_(faults), reading_{faults}, text_(std::move(source.text)) {}

  [[nodiscard]] Definition read() {
    const toml::table tree = parse_document(text_, file_.string());
    expect_type(tree, file_.string(), DocumentType::figure);
    const Keys keys = root_keys();
    const SourceLocation top{file_.string()};
    const Section root(reading_, {&tree, top, "the definition"}, keys);
    has_scenario_ = root.has("scenario");

    Definition definition{.name = file_.stem().string(),
                          .title = root.text("title"),
                          .source = root.text("source"),
                          .format = root.text("format")};
    if (root.has("adhesion_map")) definition.adhesion_map = adhesion_map(root);
    const Inherited inherited{.x = formula(root, "x"), .y = formula(root, "y")};
    for (const auto& table : root.tables("panel", "[[panel]]")) {
      definition.panels.push_back(panel(table, root, inherited));
    }
    for (const auto& table : root.tables("table", "[[table]]")) {
      definition.tables.push_back(comparison_table(table, inherited));
    }
    for (const auto& table : root.tables("values", "[[values]]")) definition.value_tables.push_back(value_table(table));
    if (root.has("table") && root.has("values")) {
      faults_.add(root.key_place("values"),
                  "[[values]] does not go with [[table]]: both are written to the same files");
    }
    const auto shows = [&root](std::string_view key) { return root.has_or_misspells(key); };
    if (!shows("panel") && !shows("table") && !shows("values") && !shows("adhesion_map")) {
      faults_.add(root.place(),
                  "the definition shows nothing; expected [[panel]], [[table]], [[values]] or [adhesion_map]");
    }
    return definition;
  }

 private:
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

  /// The section's own formula, else the inherited one; a fault if there is neither.
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

  [[nodiscard]] std::optional<figure::ChartRange> fitted(const Section& section_with_key) {
    if (!section_with_key.has("fitted")) return std::nullopt;
    static const Keys keys = fitted_keys();
    const Section section(reading_, section_with_key.table("fitted", "fitted"), keys);
    figure::ChartRange range{
        .from = section.number("from"), .to = section.number("to"), .legend = section.text("label")};
    const bool is_ordered = !range.from || !range.to || *range.from < *range.to;
    if ((!range.from && !range.to && !section.has_or_misspells("from") && !section.has_or_misspells("to")) ||
        !is_ordered) {
      faults_.add(section_with_key.value_place("fitted"),
                  is_ordered ? "the range has no end; expected 'from', 'to' or both" : "'from' is not below 'to'");
    }
    return range;
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
                   .fitted = fitted(section.has("fitted") ? section : root)};
    check_range(section, spec.x, 'x');
    check_range(section, spec.y, 'y');
    const auto own_x = formula(section, "x");
    const auto own_y = formula(section, "y");
    const auto having = [&](std::string_view key) {
      return section.has(key) ? &section : root.has(key) ? &root : nullptr;
    };
    const Inherited handed_on{.x = own_x ? own_x : inherited.x,
                              .y = own_y ? own_y : inherited.y,
                              .vary = having("vary"),
                              .against = having("against"),
                              .panel = &section};
    for (const auto& entry : root.tables("curve", "[[curve]]")) spec.curves.push_back(curve(entry, handed_on));
    for (const auto& entry : section.tables("curve", "[[panel.curve]]")) spec.curves.push_back(curve(entry, handed_on));
    for (const auto& entry : section.tables("points", "[[panel.points]]")) spec.points.push_back(points(entry));
    if (!root.has("curve") && !section.has_or_misspells("curve") && !section.has_or_misspells("points")) {
      faults_.add(section.place(), "the panel is empty; expected [[panel.curve]] or [[panel.points]]");
    }
    return spec;
  }

  [[nodiscard]] CurveSpec curve(const Section::Origin& table, const Inherited& inherited) {
    static const Keys keys = curve_keys();
    const Section section(reading_, table, keys);
    CurveSpec spec{.sweep = 0,
                   .legends = {section.text("legend")},
                   .x = formula(section, "x", inherited.x),
                   .y = formula(section, "y", inherited.y),
                   .rows = static_cast<RowChoice>(place_of_word(k_rows, section.text("rows"))),
                   .styles = {static_cast<Style>(place_of_word(k_styles, section.text("style")))},
                   .colour = colour(section),
                   .profile_at = section.number("profile_at"),
                   .at_event = section.text("at_event")};
    if (section.has("parameter")) spec.parameter = parameter(section);
    const std::vector<Override> swept = section.has("sweep") ? sweep(section, spec) : std::vector<Override>{};
    const CurveSections sections{.curve = section,
                                 .panel = inherited.panel,
                                 .vary = section.has("vary") ? &section : inherited.vary,
                                 .against = section.has("against") ? &section : inherited.against};
    const bool has_runs = !spec.parameter || has_scenario_ || section.has("scenario");
    if (section.has("vary") || (sections.vary != nullptr && has_runs)) {
      vary(sections, swept, spec);
    } else if (has_runs) {
      add_curve(sections, {}, swept, spec);
    }
    if (!spec.at_event.empty()) check_event(section, spec);
    return spec;
  }

  /// Reports an event that a model of the curve does not have.
  void check_event(const Section& section, const CurveSpec& spec) {
    for (const CheckedScenario& scenario : spec.scenarios) {
      std::vector<std::string_view> names;
      for (const Term& event : find_model(scenario.model)->events) names.push_back(event.name);
      if (std::ranges::find(names, spec.at_event) != names.end()) continue;
      const std::string suggestion = did_you_mean(spec.at_event, names);
      faults_.add(section.value_place("at_event"),
                  fmt::format("model '{}' has no event '{}'{}", scenario.model, shown(spec.at_event),
                              suggestion.empty() ? "; it has " + listed(names) : suggestion));
      return;
    }
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

  /// Sections from which the runs of a curve are made.
  struct CurveSections {
    const Section& curve;
    const Section* panel;    ///< null: none
    const Section* vary;     ///< has the key `vary`; null: none
    const Section* against;  ///< has the key `against`; null: none
  };

  /// An override of a scenario, with its position in the definition.
  struct Override {
    std::string text;
    SourceLocation where;
  };

  /// Overrides for the values of the swept key.
  [[nodiscard]] std::vector<Override> sweep(const Section& curve, CurveSpec& spec) {
    static const Keys keys = sweep_keys();
    const Section section(reading_, curve.table("sweep", "sweep"), keys);
    for (const std::string_view other : {"parameter", "profile_at", "at_event", "against"}) {
      if (curve.has(other)) {
        faults_.add(curve.key_place(other), fmt::format("'{}' does not go with 'sweep', which has no history", other));
      }
    }
    const auto from = section.number("from");
    const auto to = section.number("to");
    if (section.text("key").empty() || !from || !to) return {};
    const bool is_logarithmic = section.toggle("log").value_or(false);
    if (is_logarithmic && (*from <= 0.0 || *to <= 0.0)) {
      faults_.add(section.value_place("log"), "equal ratios need 'from' and 'to' above 0");
      return {};
    }
    spec.sweep = static_cast<std::size_t>(section.number("points").value_or(2.0));
    std::vector<Override> overrides;
    for (std::size_t k = 0; k < spec.sweep; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(spec.sweep - 1);
      // The ends are met exactly: a value beyond them by round-off could be outside of a model's domain.
      const double between = is_logarithmic ? *from * std::pow(*to / *from, share) : std::lerp(*from, *to, share);
      const double value = k + 1 == spec.sweep ? *to : between;
      overrides.push_back({fmt::format("{}={}", section.text("key"), value), section.value_place("key")});
    }
    return overrides;
  }

  void vary(const CurveSections& sections, const std::vector<Override>& swept, CurveSpec& spec) {
    static const Keys keys = vary_keys();
    const Section section(reading_, sections.vary->table("vary", "vary"), keys);
    const std::string key = section.text("key");
    const std::vector<std::string> values = section.texts("values");
    std::vector<std::string> legends = section.texts("legends");
    const std::vector<std::string> styles = section.texts("styles");
    for (const std::string_view list : {"legends", "styles"}) {
      const std::size_t count = section.texts(list).size();
      if (section.has(list) && count != values.size()) {
        faults_.add(section.value_place(list), fmt::format("{} {} for {} values", count, list, values.size()));
      }
    }
    if (!styles.empty()) spec.styles.clear();
    for (std::size_t k = 0; k < styles.size(); ++k) {
      if (std::ranges::find(k_styles, styles[k]) == k_styles.end()) {
        const std::string suggestion = did_you_mean(styles[k], k_styles);
        faults_.add(section.value_place("styles", k),
                    fmt::format("unknown style '{}'{}", shown(styles[k]),
                                suggestion.empty() ? "; expected " + listed(k_styles) : suggestion));
      }
      spec.styles.push_back(static_cast<Style>(place_of_word(k_styles, styles[k])));
    }
    const bool is_named = !legends.empty() || !spec.legends.front().empty();
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (!is_named)
        legends.push_back(figure::verbatim_text(fmt::format("{} = {}", key.substr(key.rfind('.') + 1), values[k])));
      add_curve(sections, {{fmt::format("{}={}", key, values[k]), section.value_place("values", k)}}, swept, spec);
    }
    if (!legends.empty()) spec.legends = std::move(legends);
    spec.variants = section.has("legends") ? section.texts("legends") : values;
  }

  /// Adds the scenarios of one curve: one, or one for each value that is swept.
  void add_curve(const CurveSections& sections, const std::vector<Override>& varied, const std::vector<Override>& swept,
                 CurveSpec& spec) {
    const Section& curve = sections.curve;
    std::vector<Override> overrides;
    const auto add = [&overrides](const std::vector<Override>& more) {
      overrides.insert(overrides.end(), more.begin(), more.end());
    };
    if (sections.panel != nullptr) add(overrides_in(*sections.panel, "set"));
    add(overrides_in(curve, "set"));
    add(varied);
    if (!curve.has("sweep")) {
      auto made = checked_scenario(curve, overrides);
      if (!made) return;
      spec.scenarios.push_back(std::move(*made));
      if (sections.against == nullptr) return;
      add(overrides_in(*sections.against, "against"));
      if (auto reference = checked_scenario(curve, overrides)) spec.references.push_back(std::move(*reference));
      return;
    }
    for (const Override& value : swept) {
      overrides.push_back(value);
      auto made = checked_scenario(curve, overrides);
      if (!made) return;  // the other values would most likely have the same faults
      spec.scenarios.push_back(std::move(*made));
      overrides.pop_back();
    }
  }

  [[nodiscard]] static std::vector<Override> overrides_in(const Section& section, std::string_view key) {
    std::vector<Override> overrides;
    for (const std::string& text : section.texts(key)) {
      overrides.push_back({text, section.value_place(key, overrides.size())});
    }
    return overrides;
  }

  /// The section's scenario; none if it has faults, each of which is reported at its own position.
  [[nodiscard]] std::optional<CheckedScenario> checked_scenario(const Section& section,
                                                                const std::vector<Override>& overrides) {
    std::vector<std::string> texts;
    for (const Override& entry : overrides) texts.push_back(entry.text);
    try {
      return scenario(section, texts);
    } catch (const ScenarioError& error) {
      for (const Fault& fault : error.faults()) {
        if (!is_override(fault.where)) {
          faults_.add(fault.where, fault.message);
          continue;
        }
        // An override is recognized by its text. The search begins at the end: the later "x=0.35" contains "x=0.3",
        // too.
        auto entry = overrides.rbegin();
        while (entry + 1 != overrides.rend() && fault.where.file.find(entry->text) == std::string::npos) ++entry;
        faults_.add(entry->where, fmt::format("{}: {}", entry->text, fault.message));
      }
    }
    return std::nullopt;
  }

  [[nodiscard]] CheckedScenario scenario(const Section& curve, const std::vector<std::string>& overrides) {
    if (!curve.has("scenario")) {
      if (!has_scenario_) {
        throw_fault(curve.place(), "there is no scenario for this; expected scenario = \"FILE\" or a table [scenario]");
      }
      return parse_scenario_table(text_, "scenario", file_.string(), overrides);
    }
    const fs::path file = file_.parent_path() / curve.text("scenario");
    if (!fs::is_regular_file(file)) {
      throw_fault(curve.value_place("scenario"), fmt::format("{}: there is no such file", file.string()));
    }
    return read_scenario(file, overrides);
  }

  /// @param y  formula of points that have none of their own
  [[nodiscard]] PointsSpec points(const Section::Origin& table, const std::optional<PlacedExpression>& y = {}) {
    static const Keys keys = points_keys();
    const Section section(reading_, table, keys);
    if (!y && !section.has_or_misspells("y")) {
      faults_.add(section.place(), "there is no 'y' for these points; expected y = \"force\"");
    }
    auto own_y = formula(section, "y");
    PointsSpec spec{.x = formula(section, "x").value_or(PlacedExpression{}),
                    .y = own_y ? *own_y : y.value_or(PlacedExpression{}),
                    .rows = static_cast<RowChoice>(place_of_word(k_rows, section.text("rows"))),
                    .where = formula(section, "where"),
                    .every = static_cast<std::size_t>(section.number("every").value_or(1.0)),
                    .legend = section.text("legend"),
                    .colour = colour(section)};
    spec.table = table_in(section);
    return spec;
  }

  /// The table in the file that a section names; an empty one if it cannot be read.
  [[nodiscard]] Table table_in(const Section& section) {
    if (section.text("file").empty()) return {};
    try {
      return read_csv(file_.parent_path() / section.text("file"), FileKind::regular);
    } catch (const std::runtime_error& error) {
      faults_.add(section.value_place("file"), error.what());
    }
    return {};
  }

  /// Reference of a value from a file, instead of a printed number.
  [[nodiscard]] PointsSpec reference(const Section& value) {
    static const Keys keys = reference_keys();
    const Section section(reading_, value.table("reference", "reference"), keys);
    if (value.has("printed")) {
      faults_.add(value.key_place("printed"), "key 'printed' does not go with 'reference'; expected one of them");
    }
    PointsSpec spec;
    spec.y = formula(section, "y").value_or(PlacedExpression{});
    spec.x = spec.y;
    spec.where = formula(section, "where");
    spec.table = table_in(section);
    return spec;
  }

  [[nodiscard]] TableSpec comparison_table(const Section::Origin& table, const Inherited& inherited) {
    static const Keys keys = comparison_table_keys();
    const Section section(reading_, table, keys);
    const auto own_x = formula(section, "x");
    const auto own_y = formula(section, "y");
    Inherited inherited_by_rows{.x = own_x ? own_x : inherited.x,
                                .y = own_y ? own_y : inherited.y,
                                .vary = section.has("vary") ? &section : nullptr};
    TableSpec spec{.title = plain(section, "title"), .bands = section.numbers("bands")};
    if (section.has("bands") && spec.bands.size() < 2) {
      faults_.add(section.value_place("bands"), "a band has two ends; expected two numbers at least");
    }
    std::vector<QuantitySpec> quantities;
    for (const auto& quantity : section.tables("quantity", "[[table.quantity]]")) {
      quantities.push_back(quantity_of(quantity, measures(section, default_measures())));
    }
    if (quantities.empty()) quantities.push_back({.measures = measures(section, default_measures())});
    for (const auto& row : section.tables("row", "[[table.row]]")) {
      static const Keys row_keys = comparison_keys();
      const Section entry(reading_, row, row_keys);
      for (const QuantitySpec& quantity : quantities) {
        if (quantity.y) inherited_by_rows.y = quantity.y;
        spec.rows.push_back(
            {.label = plain(entry, "label"),
             .quantity = quantity.name,
             .measures = quantity.measures,
             .least = quantity.least,
             .curve = entry.has("curve") ? curve(entry.table("curve", "curve"), inherited_by_rows) : CurveSpec{},
             .points =
                 entry.has("points") ? points(entry.table("points", "points"), quantity.reference) : PointsSpec{}});
      }
    }
    return spec;
  }

  /// A quantity that is compared in all rows of a table.
  struct QuantitySpec {
    std::string name{};
    std::optional<PlacedExpression> y{};
    std::optional<PlacedExpression> reference{};
    std::optional<PlacedExpression> least{};
    std::vector<std::size_t> measures{};
  };

  [[nodiscard]] QuantitySpec quantity_of(const Section::Origin& table, std::vector<std::size_t> measures_of_table) {
    static const Keys keys = quantity_keys();
    const Section section(reading_, table, keys);
    return {.name = plain(section, "name"),
            .y = formula(section, "y"),
            .reference = formula(section, "reference"),
            .least = formula(section, "least"),
            .measures = measures(section, std::move(measures_of_table))};
  }

  [[nodiscard]] static std::vector<std::size_t> default_measures() {
    std::vector<std::size_t> places(k_default_measures);
    std::iota(places.begin(), places.end(), 0);
    return places;
  }

  /// The measures that a section names; `others` if it names none.
  [[nodiscard]] std::vector<std::size_t> measures(const Section& section, std::vector<std::size_t> others) {
    if (!section.has("measures")) return others;
    std::vector<std::size_t> places;
    for (const std::string& name : section.texts("measures")) {
      const auto found = std::ranges::find(k_measures, name);
      if (found == k_measures.end()) {
        const std::string suggestion = did_you_mean(name, k_measures);
        faults_.add(section.value_place("measures", places.size()),
                    fmt::format("unknown measure '{}'{}", shown(name),
                                suggestion.empty() ? "; expected " + listed(k_measures) : suggestion));
      }
      places.push_back(found == k_measures.end() ? 0 : static_cast<std::size_t>(found - k_measures.begin()));
    }
    return places;
  }

  [[nodiscard]] ValueTableSpec value_table(const Section::Origin& table) {
    static const Keys keys = value_table_keys();
    const Section section(reading_, table, keys);
    ValueTableSpec spec{.title = plain(section, "title")};
    for (const auto& row : section.tables("row", "[[values.row]]")) {
      static const Keys row_keys = value_keys();
      const Section entry(reading_, row, row_keys);
      spec.rows.push_back({.label = plain(entry, "label"),
                           .scenario = checked_scenario(entry, overrides_in(entry, "set")),
                           .value = formula(entry, "value").value_or(PlacedExpression{}),
                           .printed = printed_number(entry),
                           .reference = entry.has("reference") ? std::optional(reference(entry)) : std::nullopt,
                           .remark = plain(entry, "remark")});
    }
    return spec;
  }

  /// A printed number as text, because its digits show how it is rounded.
  [[nodiscard]] std::string printed_number(const Section& section) {
    const std::string text = section.text("printed");
    double value = 0.0;
    const char* const end = text.data() + text.size();
    const auto [last, error] = std::from_chars(text.data(), end, value, std::chars_format::fixed);
    if (!text.empty() && (error != std::errc{} || last != end || !std::isfinite(value))) {
      faults_.add(section.value_place("printed"),
                  fmt::format("printed = \"{}\": expected digits, for example \"-31.76\"", shown(text)));
      return {};
    }
    return text;
  }

  /// A text for a cell of a CSV file; reports characters that a cell cannot contain.
  [[nodiscard]] std::string plain(const Section& section, std::string_view key) {
    const std::string text = section.text(key);
    if (text.find_first_of(",\"|\r\n") != std::string::npos) {
      faults_.add(
          section.value_place(key),
          fmt::format("{} = \"{}\": commas, quotes, bars and line breaks cannot stand in a table", key, shown(text)));
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

Definition parse_definition(NamedText source, FaultList& faults) {
  return DefinitionReader(std::move(source), faults).read();
}

Definition read_definition(const fs::path& file, FaultList& faults) {
  auto [text, problem] = read_text_file(file, k_largest_text);
  if (!problem.empty()) throw_fault({file.string()}, problem + "; expected the definition of a figure");
  return parse_definition({std::move(text), file}, faults);
}

}  // namespace monograin
