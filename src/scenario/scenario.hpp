/// A checked scenario: data, in SI units, of what a scenario file says.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "monograin/faults.hpp"
#include "scenario/integrators.hpp"
#include "scenario/text_file.hpp"
#include "system/model.hpp"
#include "system/walls.hpp"

namespace monograin {

/// One step of the program of a wall, a packing or a material point. Cycles are already written out. Of duration and
/// rate exactly one is given; in a channel that follows another one, none: it takes as long.
struct Step {
  enum class Kind { displacement, force, strain, stress, packing_fraction, hold, detach };
  /// What is prescribed in the lateral direction.
  struct Lateral {
    Kind kind = Kind::strain;
    double target = 0.0;  ///< [SI]
  };
  Kind kind = Kind::hold;
  double target = 0.0;             ///< of a ramp: what its end prescribes [SI]
  std::optional<double> duration;  ///< [s], > 0
  std::optional<double> rate;      ///< of the ramp [SI], > 0
  std::vector<Until> until;
  SourceLocation where;
  std::optional<Lateral> lateral{};  ///< of a material point; none: what is prescribed there is kept
};

/// What a ramp controls; none for a hold or a withdrawal.
[[nodiscard]] std::optional<Control> control_of(Step::Kind kind) noexcept;
/// The ramp that controls it.
[[nodiscard]] Step::Kind ramp_of(Control control) noexcept;

struct WallSpec {
  std::string name;
  std::array<double, 3> normal{};  ///< outward, as given (not normalised), not zero
  double gap = 0.0;                ///< [m], >= 0
  bool is_fixed = false;
  std::vector<Step> steps;  ///< empty: the steps of `[loading]` (unless fixed)
  SourceLocation where;
};

struct Loading {
  enum class Configuration { simple, die, hydrostatic, oblique_die, walls, triaxial, strain_path };
  Configuration configuration = Configuration::simple;
  bool centre_is_free = false;  ///< centre = "equilibrium"
  double oblique_angle = 0.0;   ///< [rad]
  int oblique_walls = 2;
  std::vector<Step> steps;
  std::vector<WallSpec> walls;  ///< of configuration `walls`
};

struct Output {
  int points = 200;           ///< equal intervals per step; 0: the integrator's own steps
  std::vector<double> times;  ///< [s], ascending; not empty: used instead of points
};

struct Numerics {
  std::string integrator = integrators::k_auto;
  double rtol = 1e-8;
  double atol = 1e-12;  ///< relative to the state's own scale
};

class ScenarioTemplate;

/// A number that a history is differentiated by.
struct SensitivityKey {
  std::string key;     ///< path as of an override
  std::string unit;    ///< SI, "-" of a pure number
  double value = 0.0;  ///< not 0
};

struct CheckedScenario {
  std::string name;  ///< file name without folder and extension; names the run's folder
  std::string text;  ///< the file as it was read
  std::vector<std::string> overrides;
  std::string title;
  std::string model;
  double radius = 0.0;                         ///< initial radius [m]; 0 where the model has no particle
  std::map<std::string, double> material;      ///< SI, every key of the model (defaults filled in)
  std::map<std::string, OptionValue> options;  ///< table named after the model, defaults filled in
  std::map<std::string, SampledCurve> curves;  ///< by option: what the files hold that options name
  Loading loading;
  Output output;
  Numerics numerics;
  std::vector<SensitivityKey> sensitivities;
  std::shared_ptr<const ScenarioTemplate> variants;  ///< this scenario, for other numbers; null without sensitivities
};

/// Texts of the files that a scenario names, by the names that it has for them.
using FileTexts = std::map<std::string, std::string>;

/// Where a scenario comes from.
struct ScenarioSource {
  std::string text;                  ///< TOML
  std::string origin;                ///< stands for the file's name in messages and names the scenario
  std::string table{};               ///< of the text that is the scenario; empty: all of it
  std::optional<FileTexts> files{};  ///< of the files that it names; none: they are read, beside `origin`
};

/// A scenario's text, parsed once to be checked many times, each time with other values of some keys.
class ScenarioTemplate {
 public:
  /// @param overrides  of every scenario that is made
  /// @throws ScenarioError where the text is not TOML; what it says is not checked here
  explicit ScenarioTemplate(ScenarioSource source, std::vector<std::string> overrides = {});
  ~ScenarioTemplate();
  ScenarioTemplate(ScenarioTemplate&&) noexcept;
  ScenarioTemplate& operator=(ScenarioTemplate&&) noexcept;

  /// The checked scenario, with `key=value` overrides as read_scenario takes them. Its steps and walls do not know
  /// their places in the text. May be called from many threads.
  /// @param numbers  in SI, at `keys`, after the overrides; as their texts would, which are not read
  /// @throws ScenarioError with every fault of the text and the overrides
  [[nodiscard]] CheckedScenario with(const std::vector<std::string>& overrides, std::span<const std::string> keys = {},
                                     std::span<const double> numbers = {}) const;

  /// Why a key cannot be set to a number; empty: it can.
  [[nodiscard]] std::string problem_of_number(const std::string& key) const;

 private:
  struct Document;
  std::unique_ptr<const Document> document_;
};

/// Reads and checks a scenario file.
///
/// @param overrides  `key=value` texts as of `--set`; the value is TOML, a bare word is a string. Keys are dotted
/// paths, an
///                   index in brackets picks from an array: `loading.steps[0].displacement=0.3`. Checked like the file.
/// @throws ScenarioError with every fault found: wrong syntax, unknown or missing keys, types, units, ranges,
/// combinations
[[nodiscard]] CheckedScenario read_scenario(const std::filesystem::path& file,
                                            const std::vector<std::string>& overrides = {},
                                            FileKind kind = FileKind::regular);

/// The same from a text in memory; `origin` stands for the file's name in messages and names the scenario.
[[nodiscard]] CheckedScenario parse_scenario(std::string_view text, const std::string& origin,
                                             const std::vector<std::string>& overrides = {});

/// A scenario that was recorded with the files that it names. No file is opened: one that is not in `files` is reported
/// as missing.
[[nodiscard]] CheckedScenario parse_recorded_scenario(std::string_view text, const std::string& origin,
                                                      const std::vector<std::string>& overrides,
                                                      const FileTexts& files);

/// The same from a table of a larger document, which is the scenario's text then; places are those in the document.
[[nodiscard]] CheckedScenario parse_scenario_table(std::string_view text, std::string_view key,
                                                   const std::string& origin,
                                                   const std::vector<std::string>& overrides = {});

/// Text of the scenario that `monograin run` takes when no file is named.
[[nodiscard]] std::string_view default_scenario_text() noexcept;

}  // namespace monograin
