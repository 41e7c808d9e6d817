#include "study/sweep/sweep_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include "history/run.hpp"
#include "scenario/document.hpp"
#include "scenario/overrides.hpp"
#include "scenario/section.hpp"
#include "scenario/text_file.hpp"
#include "scenario/words.hpp"
#include "study/sweep/band_section.hpp"
#include "study/sweep/column_section.hpp"
#include "study/sweep/constraint_section.hpp"
#include "study/sweep/design_table.hpp"
#include "study/sweep/factor.hpp"
#include "study/sweep/joint_normal.hpp"
#include "study/sweep/planned_runs.hpp"
#include "study/sweep/scenario_section.hpp"
#include "study/sweep/sweep_language.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

class SweepReader {
 public:
  explicit SweepReader(NamedText source) : source_(std::move(source)), reading_{faults_} {}

  [[nodiscard]] Sweep read() {
    const toml::table tree = parse_document(source_.text, source_.file.string());
    expect_type(tree, source_.file.string(), DocumentType::sweep);
    const std::vector<KeySpec> keys = sweep::root_keys(tree["scenario"].is_table());
    const SourceLocation top{source_.file.string()};
    const Section root(reading_, {&tree, top, "the sweep"}, keys);
    design_ = root.text("design");
    check_keys_of_design(root, keys);
    scenario_ = sweep::scenario_in(reading_, root, tree, source_);
    if (!scenario_.made) faults_.throw_if_any();  // without a scenario the keys are not known
    if (scenario_.file) take_file(*scenario_.file);

    read_factors(root);
    if (!root.text("calibration").empty()) read_calibrated(root);
    const std::vector<sweep::PlacedConstraint> constraints = sweep::constraints_in(reading_, root);
    columns_ = sweep::columns_of_results(reading_, root);
    std::vector<std::string> varied;
    for (const Factor& factor : factors_) varied.push_back(factor.key);
    std::ranges::move(sweep::columns_of_formulas(reading_, root, varied), std::back_inserter(columns_));
    if (root.has("bands")) bands_ = sweep::bands_in(reading_, root);
    std::optional<std::uint64_t> seed;
    if (design_ != "table" && design_ != "grid") seed = static_cast<std::uint64_t>(root.number("seed").value_or(1.0));
    sweep::PlannedRuns planned(faults_, root, factors_, constraints, scenario_.radius);
    make_runs(root, constraints, seed, planned);
    faults_.throw_if_any();
    check_runs(planned.runs());
    faults_.throw_if_any();
    take_varied_files(planned.runs());
    std::vector<std::string> doubts = doubts_about(*scenario_.made, factors_);
    std::vector<std::string> models = scenario_.models;
    if (models.empty()) models.push_back(scenario_.model());
    std::string determining = fmt::format("monograin {}\n{}", version(), sweep::text_of_runs(tree));
    for (const FileKey& file : files_) determining += '\n' + file.text;
    std::string digest = text_digest(determining);

    return {.name = source_.file.stem().string(),
            .title = root.text("title"),
            .design = design_,
            .models = std::move(models),
            .factors = sweep_factors(),
            .runs = std::move(planned.runs()),
            .left_out = planned.left_out(),
            .points = std::move(planned.points()),
            .scenario = std::move(*scenario_.made),
            .scenario_name = scenario_.name,
            .keeps_histories = bands_.has_value() || root.toggle("histories").value_or(false),
            .columns = root.texts("columns"),
            .results = root.texts("results"),
            .bands = bands_ ? std::optional(std::move(bands_->request)) : std::nullopt,
            .doubts = std::move(doubts),
            .text = std::move(source_.text),
            .files = std::move(files_),
            .seed = seed,
            .digest = std::move(digest)};
  }

 private:
  void check_keys_of_design(const Section& root, const std::vector<KeySpec>& keys) {
    for (const KeySpec& spec : keys) {
      if (!spec.only_with.empty() && !sweep::is_one_of(design_, spec.only_with) && root.has(spec.name)) {
        faults_.add(root.key_place(spec.name),
                    fmt::format("key '{}' goes with design = {} only", spec.name, spec.only_with));
      }
    }
    std::vector<std::string_view> needed{"vary"};
    if (sweep::is_one_of(design_, sweep::k_filling_designs)) needed = {"runs", "vary"};
    if (sweep::is_one_of(design_, sweep::k_index_designs)) needed = {"samples", "results", "vary"};
    if (design_ == "table") needed = {"table"};
    for (const std::string_view key : needed) {
      if (root.has_or_misspells(key) || (key == "vary" && root.has("calibration"))) continue;
      faults_.add(root.place(), fmt::format("key '{}' is missing for design = \"{}\"; expected for example {}", key,
                                            design_, example_line(*find_key(keys, key))));
    }
  }

  /// Keeps a file that determines the results, once. The first run names files that are varied, too.
  void take_file(FileKey file) {
    const auto is_same = [&](const FileKey& other) { return other.path == file.path && other.name == file.name; };
    if (std::ranges::none_of(files_, is_same)) files_.push_back(std::move(file));
  }

  // --- the factors

  [[nodiscard]] std::optional<Factor> make_factor(const std::string& key, const SourceLocation& where) {
    std::optional<Factor> factor = scenario_.factor(key, where, faults_);
    are_keys_known_ = are_keys_known_ && factor;
    return factor;
  }

  void read_factors(const Section& root) {
    if (!root.has("vary")) return;
    const Section::Origin vary = root.table("vary", "[vary]");
    std::vector<std::pair<SourceLocation, std::string>> entries;
    for (const auto& [key, node] : *vary.table) entries.emplace_back(place_of(key.source(), vary.place), key.str());
    std::ranges::sort(entries, {}, [](const auto& entry) { return std::pair(entry.first.line, entry.first.column); });
    for (const auto& [where, key] : entries) {
      std::optional<Factor> factor = make_factor(key, where);
      if (!factor) continue;
      const toml::node& node = *vary.table->get(key);
      const SourceLocation place = place_of(node.source(), where);
      if (const toml::table* table = node.as_table()) {
        read_levels(reading_, *table, place, levels_of_design(), *factor);
      } else {
        faults_.add(place, fmt::format("{} = {}: expected {} or {{ values = [...] }}", shown(key), shown(node),
                                       k_example_range));
      }
      factors_.push_back(std::move(*factor));
    }
  }

  /// Adds the numbers of a calibration as factors that are varied jointly.
  void read_calibrated(const Section& root) {
    const SourceLocation where = root.value_place("calibration");
    const std::string named = fmt::format("calibration = \"{}\"", shown(root.text("calibration")));
    try {
      const std::string text = text_of_calibration(source_.file.parent_path() / root.text("calibration"));
      sweep::JointFactors joint{.distribution = read_joint_normal(text), .first = factors_.size()};
      const JointNormal& of = joint.distribution;
      for (std::size_t k = 0; k < of.keys.size(); ++k) {
        if (std::ranges::find(factors_, of.keys[k], &Factor::key) != factors_.end()) {
          throw std::runtime_error(fmt::format("'{}' is varied in [vary], too; expected one of them", of.keys[k]));
        }
        std::optional<Factor> factor = make_factor(of.keys[k], where);
        if (!factor) continue;
        factor->distribution = FactorDistribution{.shape = FactorDistribution::Shape::normal,
                                                  .parameters = {of.means[k], of.standard_errors[k], 0.0}};
        factors_.push_back(std::move(*factor));
      }
      take_file({"calibration", root.text("calibration"), text});
      joint_ = std::move(joint);
    } catch (const std::runtime_error& error) {
      faults_.add(where, fmt::format("{}: {}", named, error.what()));
    }
  }

  [[nodiscard]] Levels levels_of_design() const {
    if (design_ == "grid") return Levels::points;
    return design_ == "table" || design_ == "maxpro" ? Levels::whole : Levels::shares;
  }

  // --- the runs

  void make_runs(const Section& root, std::span<const sweep::PlacedConstraint> constraints,
                 std::optional<std::uint64_t> seed, sweep::PlannedRuns& planned) {
    std::optional<DesignTable> table;
    std::vector<std::string> units;
    if (design_ == "table") {
      table = read_table(root);
      if (!table) return;
      units = take_columns(*table);
      if (faults_.size() > 0) return;
    }
    // A name may be a key that is misspelt in [vary].
    if (are_keys_known_) sweep::check_names(constraints, factors_, design_ != "maxpro", faults_);
    if (table) {
      planned.make_rows(*table, units);
    } else if (sweep::is_one_of(design_, sweep::k_random_designs) && design_ != "maxpro") {
      planned.make_samples(design_, *seed, joint_);
    } else if (faults_.size() == 0) {
      design_ == "grid" ? planned.make_grid() : planned.make_maxpro(*seed);
    }
  }

  /// The design's table; none, with a fault, if it cannot be read.
  [[nodiscard]] std::optional<DesignTable> read_table(const Section& root) {
    const std::string name = root.text("table");
    if (name.empty()) return std::nullopt;
    const fs::path file = source_.file.parent_path() / name;
    const auto [text, problem] = read_text_file(file, k_largest_text);
    if (!problem.empty() || text.size() > k_largest_text) {
      faults_.add(
          root.value_place("table"),
          fmt::format("table = \"{}\": {} ({}); expected a table with a column for each key, its path relative "
                      "to the sweep's folder",
                      shown(name), problem.empty() ? "the file is too large" : problem, on_one_line(file.string())));
      return std::nullopt;
    }
    take_file({"table", name, text});
    return parse_design_table(text, file.string(), faults_);
  }

  /// Puts the factors into the order of the columns; factors in [vary] keep their ranges and lists.
  /// @return units of the columns
  std::vector<std::string> take_columns(const DesignTable& table) {
    for (std::size_t column = 0; column < table.headings.size(); ++column) {
      if (parse_design_heading(table.headings[column].text).key != "model") continue;
      for (const auto& row : table.rows) {
        std::vector<std::string>& models = scenario_.models;
        if (std::ranges::find(models, row[column].text) == models.end()) models.push_back(row[column].text);
      }
    }
    std::vector<Factor> declared = std::exchange(factors_, {});
    std::vector<std::string> units;
    for (const DesignTable::Cell& cell : table.headings) {
      const auto [key, unit] = parse_design_heading(cell.text);
      if (std::ranges::find(factors_, key, &Factor::key) != factors_.end()) {
        faults_.add(cell.where, fmt::format("two columns are for '{}'", shown(key)));
        continue;
      }
      const auto known = std::ranges::find(declared, key, &Factor::key);
      std::optional<Factor> factor = known != declared.end() ? *known : scenario_.factor(key, cell.where, faults_);
      if (!factor) continue;
      if (const std::string problem = unit_problem(factor->spec, unit); !problem.empty()) {
        faults_.add(cell.where, fmt::format("{}: {}", shown(cell.text), problem));
      }
      factors_.push_back(std::move(*factor));
      units.push_back(unit);
    }
    for (const Factor& factor : declared) {
      if (!table.headings.empty() && std::ranges::find(factors_, factor.key, &Factor::key) == factors_.end()) {
        faults_.add(factor.where, fmt::format("the table has no column for '{}'", factor.key));
      }
    }
    return units;
  }

  /// Reports the faults of the scenario itself, which occur whatever values a run sets. The first accepted run shows
  /// which files the scenario names; they determine the results, too.
  void check_runs(const SweepRuns& runs) {
    const std::vector<SweepFactor> factors = sweep_factors();
    std::optional<std::vector<Fault>> own;
    for (std::size_t run = 0; run < runs.size(); ++run) {
      try {
        const CheckedScenario scenario = scenario_with(*scenario_.made, factors, runs[run]);
        for (FileKey& file : named_files(scenario)) take_file(std::move(file));
        // Runs with other words, such as another configuration, may have other columns.
        if (std::ranges::all_of(factors_, &Factor::is_number)) sweep::check_columns(columns_, scenario, faults_);
        if (bands_) sweep::check_columns(bands_->columns, scenario, faults_);
        return;
      } catch (const ScenarioError& error) {
        if (own && own->empty()) continue;
        own.emplace();
        std::ranges::copy_if(error.faults(), std::back_inserter(*own),
                             [](const Fault& fault) { return !is_override(fault.where); });
      }
    }
    for (const Fault& fault : own.value_or(std::vector<Fault>{})) faults_.add(fault.where, fault.message);
  }

  void take_varied_files(const SweepRuns& runs) {
    for (std::size_t f = 0; f < factors_.size(); ++f) {
      if (factors_[f].spec.kind != KeySpec::Kind::file) continue;
      std::set<std::string> names;
      for (std::size_t run = 0; run < runs.size(); ++run) names.insert(std::get<std::string>(runs[run][f]));
      for (const std::string& name : names) {
        take_file({factors_[f].key, name, read_text_file(scenario_.folder / name, k_largest_text).text});
      }
    }
  }

  [[nodiscard]] std::vector<SweepFactor> sweep_factors() const {
    std::vector<SweepFactor> factors;
    for (const Factor& factor : factors_) factors.push_back({factor.key, factor.unit(), factor.is_toggle()});
    return factors;
  }

  NamedText source_;
  FaultList faults_;
  Reading reading_;
  std::string design_;
  sweep::VariedScenario scenario_;
  std::vector<Factor> factors_;
  bool are_keys_known_ = true;  ///< every key in [vary] exists
  std::optional<sweep::JointFactors> joint_;
  std::vector<sweep::PlacedColumn> columns_;
  std::optional<sweep::PlacedBands> bands_;
  std::vector<FileKey> files_;  ///< that determine the results, too
};

}  // namespace

Sweep read_sweep(const fs::path& file) { return parse_sweep(read_named_text(file, "a sweep file")); }

Sweep parse_sweep(NamedText source) { return SweepReader(std::move(source)).read(); }

CheckedScenario scenario_of(const Sweep& sweep, std::size_t run) {
  return scenario_with(sweep.scenario, sweep.factors, sweep.runs[run]);
}

}  // namespace monograin
