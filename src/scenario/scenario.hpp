/// A checked scenario: the content of a scenario file as data in SI units.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "monograin/faults.hpp"
#include "scenario/integrators.hpp"
#include "scenario/text_file.hpp"
#include "system/model_input.hpp"
#include "system/walls.hpp"

namespace monograin {

/// Place of a ramp in a step that follows a table or a sine, which is written out as ramps. Any other step has one leg.
struct Leg {
  double begin = 0.0;       ///< share of the step's time at which the ramp begins
  double end = 1.0;         ///< and ends
  bool is_corner = true;    ///< the program has a corner where the ramp begins; false within a curve
  double begin_time = 0.0;  ///< [s] from the beginning of the step; unused where the step has one leg
  double end_time = 0.0;

  [[nodiscard]] bool is_first() const noexcept { return begin == 0.0; }
  [[nodiscard]] bool is_last() const noexcept { return end == 1.0; }
  [[nodiscard]] bool is_whole() const noexcept { return is_first() && is_last(); }
  [[nodiscard]] bool operator==(const Leg&) const = default;
};

/// One step of the program of a wall, a packing or a material point, or one leg of a step. Cycles are written out.
/// Exactly one of duration and rate is given; neither in a channel that follows another one and takes as long.
struct Step {
  enum class Kind { displacement, force, strain, stress, packing_fraction, hold, detach };
  /// Prescribed quantity in the lateral direction.
  struct Lateral {
    Kind kind = Kind::strain;
    double target = 0.0;  ///< [SI]
  };
  Kind kind = Kind::hold;
  double target = 0.0;             ///< value at the end of a ramp [SI]
  std::optional<double> duration;  ///< [s], > 0
  std::optional<double> rate{};    ///< of the ramp [SI], > 0
  std::vector<Until> until{};
  SourceLocation where{};
  std::optional<Lateral> lateral{};  ///< of a material point; none: the lateral quantity keeps its value
  Leg leg{};
  std::optional<double> start{};  ///< value at which the ramp is to begin [SI]; none: the present one
  double share = 1.0;             ///< part of the distance to the target that the ramp covers
};

/// Number of steps of a program, all legs of a step counted as one.
[[nodiscard]] std::size_t count_steps(std::span<const Step> program) noexcept;
/// The steps of a program, each with all its legs.
[[nodiscard]] std::vector<std::span<const Step>> steps_with_legs(std::span<const Step> program);

/// Quantity that a ramp controls; none for a hold or a withdrawal.
[[nodiscard]] std::optional<Control> control_of(Step::Kind kind) noexcept;
/// Kind of the ramp that controls a quantity.
[[nodiscard]] Step::Kind ramp_of(Control control) noexcept;

struct WallSpec {
  std::string name;
  std::array<double, 3> normal{};  ///< outward, as given (not normalised), not zero
  double gap = 0.0;                ///< [m], >= 0
  bool is_fixed = false;
  std::vector<Step> steps{};  ///< empty: the steps of `[loading]` (unless fixed)
  SourceLocation where{};
};

/// Angle between two directions of any length [rad].
[[nodiscard]] double angle_between(const std::array<double, 3>& a, const std::array<double, 3>& b) noexcept;

/// Texts of the files that a scenario names, by their names in the scenario.
using FileTexts = std::map<std::string, std::string>;

struct Loading {
  enum class Configuration { simple, die, hydrostatic, oblique_die, walls, triaxial, strain_path };
  Configuration configuration = Configuration::simple;
  bool centre_is_free = false;  ///< centre = "equilibrium"
  double oblique_angle = 0.0;   ///< [rad]
  int oblique_walls = 2;
  std::vector<Step> steps;
  std::vector<WallSpec> walls;  ///< of configuration `walls`
  FileTexts files;              ///< that steps name
};

struct Output {
  int points = 200;             ///< equal intervals per step; 0: the integrator's own steps
  std::vector<double> times{};  ///< [s], ascending; not empty: used instead of points
};

struct Numerics {
  std::string integrator = integrators::k_auto;
  double rtol = integrators::k_default_rtol;
  double atol = integrators::k_default_atol;  ///< relative to the state's own scale
  SourceLocation integrator_place{};
};

class ScenarioTemplate;

/// A number by which a history is differentiated.
struct SensitivityKey {
  std::string key;     ///< path as of an override
  std::string unit;    ///< SI, "-" of a pure number
  double value = 0.0;  ///< not 0
};

struct CheckedScenario {
  std::string name;  ///< file name without folder and extension; names the run's folder
  std::string text;  ///< content of the file
  std::vector<std::string> overrides;
  std::string title;
  std::string model;
  double radius = 0.0;                         ///< initial radius [m]; 0 where the model has no particle
  std::map<std::string, double> material;      ///< SI, every key of the model (defaults filled in)
  std::map<std::string, OptionValue> options;  ///< table named after the model, defaults filled in
  std::map<std::string, SampledCurve> curves;  ///< by option: content of the files that options name
  Loading loading;
  Output output;
  Numerics numerics;
  std::vector<SensitivityKey> sensitivities;
  std::vector<std::string> doubts;                   ///< values that may not be meant as they are read, a sentence each
  std::shared_ptr<const ScenarioTemplate> variants;  ///< template for other numbers; null without sensitivities
};

/// Source of a scenario.
struct ScenarioSource {
  std::string text;                  ///< TOML
  std::string origin;                ///< replaces the file's name in messages and names the scenario
  std::string table{};               ///< table of the text that is the scenario; empty: the whole text
  std::optional<FileTexts> files{};  ///< texts of the files that it names; none: files are read, beside `origin`
};

/// Text of a scenario, parsed once and checked many times with different values of some keys.
class ScenarioTemplate {
 public:
  /// @param overrides  applied to every scenario that is made
  /// @throws ScenarioError if the text is not TOML; its content is not checked here
  explicit ScenarioTemplate(ScenarioSource source, std::vector<std::string> overrides = {});
  ~ScenarioTemplate();
  ScenarioTemplate(ScenarioTemplate&&) noexcept;
  ScenarioTemplate& operator=(ScenarioTemplate&&) noexcept;

  /// Makes a checked scenario, with `key=value` overrides as in read_scenario. Its steps and walls do not have
  /// positions in the text. May be called from many threads.
  /// @param numbers  in SI, set at `keys` after the overrides, as their texts would be, but without parsing
  /// @throws ScenarioError with every fault of the text and the overrides
  [[nodiscard]] CheckedScenario with(const std::vector<std::string>& overrides, std::span<const std::string> keys = {},
                                     std::span<const double> numbers = {}) const;

  /// Reason why a key cannot be set to a number; empty: it can.
  [[nodiscard]] std::string problem_of_number(const std::string& key) const;

 private:
  struct Document;
  std::unique_ptr<const Document> document_;
};

/// Reads and checks a scenario file.
///
/// @param overrides  `key=value` texts as of `--set`, checked like the file. The value is TOML; a bare word is a
/// string.
///                   Keys are dotted paths; an index in brackets selects from an array:
///                   `loading.steps[0].displacement=0.3`.
/// @throws ScenarioError with every fault found: syntax, unknown or missing keys, types, units, ranges, combinations
[[nodiscard]] CheckedScenario read_scenario(const std::filesystem::path& file,
                                            const std::vector<std::string>& overrides = {},
                                            FileKind kind = FileKind::regular);

/// Reads and checks a scenario from a text in memory. `origin` replaces the file's name in messages and as its name.
[[nodiscard]] CheckedScenario parse_scenario(std::string_view text, const std::string& origin,
                                             const std::vector<std::string>& overrides = {});

/// Reads a scenario that was recorded with the files that it names. Opens no file, and reports one that is not in
/// `files` as missing.
[[nodiscard]] CheckedScenario parse_recorded_scenario(std::string_view text, const std::string& origin,
                                                      const std::vector<std::string>& overrides,
                                                      const FileTexts& files);

/// Reads a scenario from a table of a larger document, which becomes its text. Positions are those in the document.
[[nodiscard]] CheckedScenario parse_scenario_table(std::string_view text, std::string_view key,
                                                   const std::string& origin,
                                                   const std::vector<std::string>& overrides = {});

/// Text of the scenario that `monograin run` uses if no file is named.
[[nodiscard]] std::string_view default_scenario_text() noexcept;

}  // namespace monograin
