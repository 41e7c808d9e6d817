#include "study/sweep/sweep_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "history/run.hpp"
#include "scenario/document.hpp"
#include "scenario/key_path.hpp"
#include "scenario/overrides.hpp"
#include "scenario/section.hpp"
#include "scenario/text_file.hpp"
#include "scenario/words.hpp"
#include "study/formula/constraint.hpp"
#include "study/formula/expression.hpp"
#include "study/sweep/band_section.hpp"
#include "study/sweep/column_section.hpp"
#include "study/sweep/design_table.hpp"
#include "study/sweep/factor.hpp"
#include "study/sweep/joint_normal.hpp"
#include "study/sweep/sampling.hpp"
#include "study/sweep/sweep_language.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;
using Kind = KeySpec::Kind;

constexpr double k_most_maxpro_runs = 1e5;

class SweepReader {
 public:
  explicit SweepReader(NamedText source)
      : text_(std::move(source.text)), file_(std::move(source.file)), reading_{faults_} {}

  [[nodiscard]] Sweep read() {
    const toml::table tree = parse_document(text_, file_.string());
    expect_type(tree, file_.string(), DocumentType::sweep);
    const std::vector<KeySpec> keys = sweep::root_keys(tree["scenario"].is_table());
    const SourceLocation top{file_.string()};
    const Section root(reading_, {&tree, top, "the sweep"}, keys);
    design_ = root.text("design");
    check_keys_of_design(root, keys);
    read_scenario_of(root, tree);
    if (!scenario_) faults_.throw_if_any();  // without a scenario the keys are not known
    read_radius();

    read_factors(root);
    if (!root.text("calibration").empty()) read_calibrated(root);
    read_constraints(root);
    columns_ = sweep::columns_of_results(reading_, root);
    std::vector<std::string> varied;
    for (const Factor& factor : factors_) varied.push_back(factor.key);
    std::ranges::move(sweep::columns_of_formulas(reading_, root, varied), std::back_inserter(columns_));
    if (root.has("bands")) bands_ = sweep::bands_in(reading_, root);
    if (design_ != "table" && design_ != "grid") seed_ = static_cast<std::uint64_t>(root.number("seed").value_or(1.0));
    if (design_ == "table") {
      read_table(root);
    } else if (design_ == "grid") {
      make_grid();
    } else if (design_ == "maxpro") {
      make_maxpro(root);
    } else {
      make_samples(root);
    }
    faults_.throw_if_any();
    check_runs();
    faults_.throw_if_any();
    take_varied_files();
    std::vector<std::string> doubts = doubts_about(*scenario_, factors_);
    std::vector<std::string> models = models_;
    if (models.empty()) models.push_back(scenario_tree_["model"].value_or(std::string()));
    std::string determining = fmt::format("monograin {}\n{}", version(), sweep::text_of_runs(tree));
    for (const FileKey& file : files_) determining += '\n' + file.text;
    std::string digest = text_digest(determining);

    return {.name = file_.stem().string(),
            .design = design_,
            .models = std::move(models),
            .factors = sweep_factors(),
            .runs = std::move(runs_),
            .left_out = left_out_,
            .points = std::move(points_),
            .scenario = std::move(*scenario_),
            .scenario_name = scenario_name_,
            .keeps_histories = bands_.has_value() || root.toggle("histories").value_or(false),
            .columns = root.texts("columns"),
            .results = root.texts("results"),
            .bands = bands_ ? std::optional(std::move(bands_->request)) : std::nullopt,
            .doubts = std::move(doubts),
            .text = std::move(text_),
            .files = std::move(files_),
            .seed = seed_,
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

  // --- the scenario

  void read_scenario_of(const Section& root, const toml::table& tree) {
    const bool varies_model = tree["vary"].as_table() != nullptr && tree["vary"].as_table()->contains("model");
    if (const toml::table* table = tree["scenario"].as_table()) {
      if (!varies_model && !is_model_known(*table, file_)) return;
      scenario_tree_ = *table;
      scenario_.emplace(ScenarioSource{.text = text_, .origin = file_.string(), .table = "scenario"});
      scenario_name_ = file_.stem().string();
      scenario_folder_ = file_.parent_path();
      return;
    }
    const std::string name = root.text("scenario");
    if (name.empty()) return;
    const fs::path file = file_.parent_path() / name;
    auto [scenario_text, problem] = read_text_file(file, k_largest_text);
    if (!problem.empty()) {
      faults_.add(root.value_place("scenario"),
                  fmt::format("scenario = \"{}\": {} ({}); expected a scenario file, its path relative to the sweep's "
                              "folder",
                              shown(name), problem, on_one_line(file.string())));
      return;
    }
    try {
      scenario_tree_ = parse_document(scenario_text, file.string());
      if (!varies_model && !is_model_known(scenario_tree_, file)) return;
      scenario_.emplace(ScenarioSource{.text = scenario_text, .origin = file.string()});
    } catch (const ScenarioError& error) {
      for (const Fault& fault : error.faults()) faults_.add(fault.where, fault.message);
    }
    scenario_name_ = file.stem().string();
    scenario_folder_ = file.parent_path();
    take_file({"scenario", name, std::move(scenario_text)});
  }

  /// Reports an unknown model, without which no key of a material is known.
  [[nodiscard]] bool is_model_known(const toml::table& scenario, const fs::path& file) {
    const auto model = scenario["model"].value<std::string>();
    if (!model) return true;
    const auto [value, problem] = read_value(*key_at("model", scenario, {}).spec, *model, {});
    if (value) return true;
    faults_.add(place_of(scenario["model"].node()->source(), SourceLocation{file.string()}),
                fmt::format("model = \"{}\": {}", shown(*model), problem));
    return false;
  }

  void read_radius() {
    const KeyAnswer radius = key_at("particle.radius", scenario_tree_, {});
    const toml::node* node = scenario_tree_.at_path("particle.radius").node();
    if (!radius.spec || node == nullptr) return;
    const auto text = node->value<std::string>();
    if (const auto [value, problem] = read_value(*radius.spec, text ? *text : shown(*node), {}); value) {
      base_radius_ = value->number;
    }
  }

  /// The key's spec in the language of the scenario's model, or of a model in the sweep.
  [[nodiscard]] KeyAnswer find_spec(const std::string& key) const {
    KeyAnswer answer = key_at(key, scenario_tree_, scenario_tree_["model"].value_or(std::string()));
    for (const std::string& model : models_) {
      KeyAnswer other = key_at(key, scenario_tree_, model);
      if (!other.spec) continue;
      if (answer.spec) {
        // A choice that one model accepts must not be refused because another lacks it.
        for (const std::string_view choice : other.spec->choices) {
          std::vector<std::string_view>& known = answer.spec->choices;
          if (std::ranges::find(known, choice) == known.end()) known.push_back(choice);
        }
      } else {
        answer = std::move(other);
      }
    }
    return answer;
  }

  /// A factor for the key, or none and a fault at its position.
  [[nodiscard]] std::optional<Factor> make_factor(const std::string& key, const SourceLocation& where) {
    KeyAnswer answer = find_spec(key);
    // A pair is varied as the single number that may replace it.
    if (answer.spec && answer.spec->kind == KeySpec::Kind::pair) answer.spec->kind = KeySpec::Kind::quantity;
    if (answer.spec && !can_be_varied(answer.spec->kind)) {
      const bool is_table = answer.spec->kind == Kind::table;
      answer.problem = is_table ? fmt::format(
                                      "'{0}' is a table; expected the path of one of its keys in quotes, such as "
                                      "\"{0}.KEY\"",
                                      shown(key))
                                : fmt::format("'{}' has no single value that could be varied", shown(key));
    }
    if (!answer.problem.empty()) {
      faults_.add(where, answer.problem);
      return std::nullopt;
    }
    return Factor{.key = key, .spec = std::move(*answer.spec), .where = where};
  }

  // --- [vary]

  void read_factors(const Section& root) {
    if (!root.has("vary")) return;
    const Section::Origin vary = root.table("vary", "[vary]");
    std::vector<std::pair<SourceLocation, std::string>> entries;
    for (const auto& [key, node] : *vary.table) entries.emplace_back(place_of(key.source(), vary.place), key.str());
    std::ranges::sort(entries, {}, [](const auto& entry) { return std::pair(entry.first.line, entry.first.column); });
    read_models(vary);
    for (const auto& [where, key] : entries) {
      std::optional<Factor> factor = make_factor(key, where);
      are_keys_known_ = are_keys_known_ && factor;
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
      const std::string text = text_of_calibration(file_.parent_path() / root.text("calibration"));
      JointNormal joint = read_joint_normal(text);
      first_calibrated_ = factors_.size();
      for (std::size_t k = 0; k < joint.keys.size(); ++k) {
        if (std::ranges::find(factors_, joint.keys[k], &Factor::key) != factors_.end()) {
          throw std::runtime_error(fmt::format("'{}' is varied in [vary], too; expected one of them", joint.keys[k]));
        }
        std::optional<Factor> factor = make_factor(joint.keys[k], where);
        are_keys_known_ = are_keys_known_ && factor;
        if (!factor) continue;
        factor->distribution = FactorDistribution{.shape = FactorDistribution::Shape::normal,
                                                  .parameters = {joint.means[k], joint.standard_errors[k], 0.0}};
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

  /// Reads the models over which the sweep varies; the languages of all of them count.
  void read_models(const Section::Origin& vary) {
    if (const toml::array* models = (*vary.table)["model"]["values"].as_array()) {
      for (const toml::node& model : *models) models_.push_back(model.value_or(std::string()));
    }
  }

  // --- constraints

  void read_constraints(const Section& root) {
    const std::vector<std::string> texts = root.texts("constraints");
    for (std::size_t i = 0; i < texts.size(); ++i) {
      const SourceLocation where = root.value_place("constraints", i);
      try {
        constraints_.push_back({Constraint(texts[i]), texts[i], where});
      } catch (const ExpressionError& error) {
        sweep::add_formula_fault(faults_, where, texts[i], error);
      }
    }
  }

  /// Reports names in the constraints that are not keys with a number.
  void check_constraint_names(bool takes_lists) {
    if (!are_keys_known_) return;  // a name may be a key that is misspelt in [vary]
    std::vector<std::string_view> names;
    for (const Factor& factor : factors_) {
      if (factor.is_number() && (takes_lists || factor.values.empty())) names.push_back(factor.key);
    }
    for (const PlacedConstraint& entry : constraints_) {
      try {
        static_cast<void>(entry.constraint.holds([&](std::string_view name) {
          return std::ranges::find(names, name) == names.end() ? std::nullopt : std::optional(1.0);
        }));
      } catch (const ExpressionError& error) {
        const std::string suggestion = did_you_mean(error.unknown_name(), names);
        sweep::add_formula_fault(faults_, entry.where, entry.text, error,
                                 suggestion.empty() ? "; expected one of " + listed(names) : suggestion);
      }
    }
  }

  /// First constraint that a run breaks, or nullptr.
  [[nodiscard]] const std::string* broken_constraint(const std::vector<SweepValue>& run) const {
    const Constraint::Lookup lookup = [&](std::string_view name) -> std::optional<double> {
      for (std::size_t f = 0; f < factors_.size(); ++f) {
        if (factors_[f].key != name) continue;
        const auto* number = std::get_if<double>(&run[f]);
        return number == nullptr ? std::nullopt : std::optional(*number);
      }
      return std::nullopt;
    };
    for (const PlacedConstraint& entry : constraints_) {
      if (!entry.constraint.holds(lookup)) return &entry.text;
    }
    return nullptr;
  }

  // --- the runs

  /// Values of a run in SI, which needs the run's radius.
  [[nodiscard]] std::vector<SweepValue> resolved(const std::vector<FactorValue>& values) const {
    double radius = base_radius_;
    for (std::size_t f = 0; f < factors_.size(); ++f) {
      if (factors_[f].key == "particle.radius") radius = values[f].number;
    }
    std::vector<SweepValue> run;
    for (std::size_t f = 0; f < factors_.size(); ++f) {
      if (factors_[f].is_number()) {
        run.emplace_back(values[f].is_in_radii ? values[f].number * radius : values[f].number);
      } else {
        run.emplace_back(values[f].word);
      }
    }
    return run;
  }

  void make_grid() {
    check_constraint_names(true);
    if (faults_.size() > 0) return;
    double count = 1.0;
    for (Factor& factor : factors_) {
      if (const std::optional<FactorRange> range = std::exchange(factor.range, std::nullopt)) {
        for (int i = 0; i < range->points; ++i) {
          factor.values.push_back(range->at(static_cast<double>(i) / (range->points - 1)));
        }
      }
      count *= static_cast<double>(factor.values.size());
    }
    if (count > sweep::k_most_runs) {
      faults_.add(factors_.front().where,
                  fmt::format("the grid has {:g} points; expected at most {:g}", count, sweep::k_most_runs));
      return;
    }
    for (std::size_t point = 0; point < static_cast<std::size_t>(count); ++point) add_if_allowed(values_at({}, point));
    if (runs_.size() == 0) faults_.add(constraints_.front().where, "no point of the grid meets the constraints");
  }

  /// Adds a run, or leaves its point out if it breaks a constraint.
  void add_if_allowed(const std::vector<FactorValue>& values) {
    const std::vector<SweepValue> run = resolved(values);
    if (broken_constraint(run) == nullptr) {
      runs_.add(run);
    } else {
      ++left_out_;
    }
  }

  void make_maxpro(const Section& root) {
    check_constraint_names(false);
    if (faults_.size() > 0) return;
    DesignSpace space{.factors = 0, .level_count = 0};
    std::size_t combinations = 1;
    for (const Factor& factor : factors_) {
      if (factor.range) {
        ++space.factors;
      } else {
        combinations *= factor.values.size();
        space.level_count = combinations;
      }
    }
    const auto runs = static_cast<std::size_t>(root.number("runs").value_or(0.0));
    if (space.factors == 0) {
      faults_.add(factors_.front().where, fmt::format("a space-filling design needs a range, for example {}; for lists "
                                                      "alone take design = \"grid\"",
                                                      k_example_range));
    }
    if (static_cast<double>(runs) > k_most_maxpro_runs) {
      faults_.add(root.value_place("runs"), fmt::format("runs = {}: expected at most {:g} of this design, whose time "
                                                        "grows as their square",
                                                        runs, k_most_maxpro_runs));
    }
    if (runs % combinations != 0) {
      faults_.add(root.value_place("runs"),
                  fmt::format("runs = {}: expected a multiple of {}, the number of combinations of listed values", runs,
                              combinations));
    }
    if (faults_.size() > 0) return;
    if (!constraints_.empty()) {
      space.contains = [this](std::span<const double> point) {
        return broken_constraint(resolved(values_at(point, 0))) == nullptr;
      };
    }
    try {
      points_ = maxpro_design(space, runs, *seed_);
    } catch (const std::domain_error& error) {
      faults_.add(root.value_place(constraints_.empty() ? "runs" : "constraints"), error.what());
      return;
    }
    for (std::size_t i = 0; i < runs; ++i) {
      runs_.add(resolved(values_at(points_.point(i), points_.levels.empty() ? 0 : points_.levels[i])));
    }
  }

  void make_samples(const Section& root) {
    const bool is_for_indices = sweep::is_one_of(design_, sweep::k_index_designs);
    if (is_for_indices && !constraints_.empty()) {
      faults_.add(constraints_.front().where, "the points of this design depend on each other: it has no constraints");
    }
    check_constraint_names(true);
    const std::size_t dimensions = factors_.size() * (design_ == "saltelli" ? 2 : 1);
    if (design_ != "lhs" && design_ != "random" && design_ != "morris" && dimensions > k_most_sobol_dimensions) {
      faults_.add(factors_.front().where, fmt::format("{} keys are varied; expected at most {}", factors_.size(),
                                                      k_most_sobol_dimensions * factors_.size() / dimensions));
    }
    const auto count = static_cast<std::size_t>(root.number(is_for_indices ? "samples" : "runs").value_or(0.0));
    const std::size_t each = design_ == "saltelli" ? factors_.size() + 2
                             : design_ == "morris" ? factors_.size() + 1
                                                   : 1;
    if (static_cast<double>(count * each) > sweep::k_most_runs) {
      faults_.add(root.value_place("samples"), fmt::format("{} runs for each of {} samples; expected at most {:g} runs",
                                                           each, count, sweep::k_most_runs));
    }
    if (faults_.size() > 0) return;
    points_ = design_ == "saltelli" ? saltelli_design(factors_.size(), count, *seed_)
              : design_ == "morris" ? morris_design(factors_.size(), count, *seed_)
                                    : sampled_design(design_, factors_.size(), count, *seed_);
    std::vector<FactorValue> values(factors_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const std::span<const double> point = points_.point(i);
      std::vector<double> shares(point.begin(), point.end());
      if (joint_) joint_->correlate(std::span(shares).subspan(first_calibrated_));
      for (std::size_t f = 0; f < factors_.size(); ++f) values[f] = factors_[f].at(shares[f]);
      add_if_allowed(values);
    }
    if (runs_.size() == 0) faults_.add(constraints_.front().where, "no point of the design meets the constraints");
    if (left_out_ > 0) points_ = {};  // the remaining points fill another space
  }

  /// Values at a point of the cube, and at a level of the product of all lists, whose last one changes fastest.
  [[nodiscard]] std::vector<FactorValue> values_at(std::span<const double> point, std::size_t level) const {
    std::vector<FactorValue> values(factors_.size());
    std::size_t axis = point.size();
    for (std::size_t f = factors_.size(); f-- > 0;) {
      const Factor& factor = factors_[f];
      if (factor.range) {
        values[f] = factor.range->at(point[--axis]);
      } else {
        values[f] = factor.values[level % factor.values.size()];
        level /= factor.values.size();
      }
    }
    return values;
  }

  // --- a table

  void read_table(const Section& root) {
    const std::string name = root.text("table");
    if (name.empty()) return;
    const fs::path file = file_.parent_path() / name;
    const auto [text, problem] = read_text_file(file, k_largest_text);
    if (!problem.empty() || text.size() > k_largest_text) {
      faults_.add(
          root.value_place("table"),
          fmt::format("table = \"{}\": {} ({}); expected a table with a column for each key, its path relative "
                      "to the sweep's folder",
                      shown(name), problem.empty() ? "the file is too large" : problem, on_one_line(file.string())));
      return;
    }
    take_file({"table", name, text});
    const DesignTable table = parse_design_table(text, file.string(), faults_);
    const std::vector<std::string> units = take_columns(table);
    if (faults_.size() > 0) return;
    check_constraint_names(true);
    for (const auto& row : table.rows) {
      if (faults_.size() < k_most_table_faults) take_row(row, units);
    }
    for (std::size_t f = 0; f < factors_.size(); ++f) {
      for (const auto* row : {&table.rows.front(), &table.rows.back()}) {
        const std::string& cell = (*row)[f].text;
        factors_[f].ends.push_back(units[f].empty() ? cell : in_quotes(fmt::format("{} {}", cell, units[f])));
      }
    }
    if (faults_.size() == 0) points_ = points_of(table.rows.size());
  }

  /// Puts the factors into the order of the columns; factors in [vary] keep their ranges and lists.
  std::vector<std::string> take_columns(const DesignTable& table) {
    for (const DesignTable::Cell& cell : table.headings) {
      if (cell.text.starts_with("model") && parse_design_heading(cell.text).key == "model") {
        const auto column = static_cast<std::size_t>(&cell - table.headings.data());
        for (const auto& row : table.rows) {
          if (std::ranges::find(models_, row[column].text) == models_.end()) models_.push_back(row[column].text);
        }
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
      std::optional<Factor> factor = known != declared.end() ? *known : make_factor(key, cell.where);
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

  void take_row(const std::vector<DesignTable::Cell>& row, const std::vector<std::string>& units) {
    std::vector<FactorValue> values;
    for (std::size_t f = 0; f < row.size(); ++f) {
      const Factor& factor = factors_[f];
      const auto report = [&](std::string_view problem) {
        faults_.add(row[f].where, fmt::format("{} = {}: {}", factor.key, shown(row[f].text), problem));
      };
      const auto [value, problem] = read_value(factor.spec, row[f].text, units[f]);
      if (!value) {
        report(problem);
        return;
      }
      if (!factor.admits(*value)) report("is outside of what [vary] gives for this key");
      values.push_back(*value);
    }
    std::vector<SweepValue> run = resolved(values);
    if (const std::string* broken = broken_constraint(run)) {
      faults_.add(row.front().where, fmt::format("the row breaks the constraint \"{}\"", *broken));
    }
    raw_.push_back(std::move(values));
    runs_.add(run);
  }

  /// The table's rows as points of the cube. A number is scaled between the ends that [vary] gives, else between its
  /// own smallest and largest value; words and listed values are levels.
  [[nodiscard]] Design points_of(std::size_t rows) const {
    Design design{.factors = 0, .level_count = 0};
    std::vector<std::optional<FactorRange>> ranges;
    for (std::size_t f = 0; f < factors_.size(); ++f) {
      const Factor& factor = factors_[f];
      std::optional<FactorRange> range = factor.range;
      if (!range && factor.is_number() && factor.values.empty()) {
        const auto [least, most] = std::ranges::minmax(raw_, {}, [f](const auto& row) { return row[f].number; });
        range = FactorRange{.from = least[f], .to = most[f]};
      }
      if (range) ++design.factors;
      ranges.push_back(std::move(range));
    }
    std::map<std::vector<FactorValue>, std::size_t> levels;
    for (std::size_t i = 0; i < rows; ++i) {
      std::vector<FactorValue> listed_values;
      for (std::size_t f = 0; f < factors_.size(); ++f) {
        if (ranges[f]) {
          design.coordinates.push_back(ranges[f]->share_of(raw_[i][f].number));
        } else {
          listed_values.push_back(raw_[i][f]);
        }
      }
      if (design.factors < factors_.size()) {
        design.levels.push_back(levels.try_emplace(std::move(listed_values), levels.size()).first->second);
      }
    }
    design.level_count = levels.size();
    return design;
  }

  // --- runs against the scenario

  /// Reports the faults of the scenario itself, which occur whatever values a run sets. The first accepted run shows
  /// which files the scenario names; they determine the results, too.
  void check_runs() {
    const std::vector<SweepFactor> factors = sweep_factors();
    std::optional<std::vector<Fault>> own;
    for (std::size_t run = 0; run < runs_.size(); ++run) {
      try {
        const CheckedScenario scenario = scenario_with(*scenario_, factors, runs_[run]);
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

  void take_varied_files() {
    for (std::size_t f = 0; f < factors_.size(); ++f) {
      if (factors_[f].spec.kind != Kind::file) continue;
      std::set<std::string> names;
      for (std::size_t run = 0; run < runs_.size(); ++run) names.insert(std::get<std::string>(runs_[run][f]));
      for (const std::string& name : names) {
        take_file({factors_[f].key, name, read_text_file(scenario_folder_ / name, k_largest_text).text});
      }
    }
  }

  [[nodiscard]] std::vector<SweepFactor> sweep_factors() const {
    std::vector<SweepFactor> factors;
    for (const Factor& factor : factors_) factors.push_back({factor.key, factor.unit(), factor.is_toggle()});
    return factors;
  }

  struct PlacedConstraint {
    Constraint constraint;
    std::string text;
    SourceLocation where;
  };

  std::string text_;
  fs::path file_;
  FaultList faults_;
  Reading reading_;
  std::string design_;
  std::vector<FileKey> files_;  ///< that determine the results, too
  toml::table scenario_tree_;
  std::optional<ScenarioTemplate> scenario_;
  std::string scenario_name_;
  std::optional<std::uint64_t> seed_;
  fs::path scenario_folder_;
  std::vector<std::string> models_;  ///< models over which the sweep varies
  std::vector<Factor> factors_;
  bool are_keys_known_ = true;  ///< every key in [vary] exists
  std::vector<PlacedConstraint> constraints_;
  std::vector<std::vector<FactorValue>> raw_;  ///< values of a table
  SweepRuns runs_;
  std::vector<sweep::PlacedColumn> columns_;
  std::optional<sweep::PlacedBands> bands_;
  std::optional<JointNormal> joint_;
  std::size_t first_calibrated_ = 0;  ///< index of the first factor that is a number of the calibration
  double base_radius_ = 1.0;  ///< the scenario's own [m]; if it cannot be read, the scenario's check reports that
  std::size_t left_out_ = 0;
  Design points_;
};

}  // namespace

Sweep read_sweep(const fs::path& file) { return parse_sweep(read_named_text(file, "a sweep file")); }

Sweep parse_sweep(NamedText source) { return SweepReader(std::move(source)).read(); }

CheckedScenario scenario_of(const Sweep& sweep, std::size_t run) {
  return scenario_with(sweep.scenario, sweep.factors, sweep.runs[run]);
}

}  // namespace monograin
