/// Reads programs: lists of steps, cycles written out. Internal: includes the TOML library.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenario/language.hpp"
#include "scenario/scenario.hpp"
#include "scenario/section.hpp"

namespace monograin {

class ProgramReader {
 public:
  ProgramReader(Reading& reading, const Language& language) : reading_(reading), language_(language) {}

  /// Reads the steps below `key` of `parent`; empty if there are none or too many.
  /// @param label  name of a step in messages: "[[loading.steps]]"
  [[nodiscard]] std::vector<Step> read(const Section& parent, std::string_view key, const std::string& label);

  /// A wall that a condition names.
  struct NamedWall {
    std::string name;
    SourceLocation where;
  };
  [[nodiscard]] const std::vector<NamedWall>& named_walls() const noexcept { return named_walls_; }
  /// Texts of the files that steps name.
  [[nodiscard]] const FileTexts& files() const noexcept { return files_; }

 private:
  [[nodiscard]] std::vector<Step> read_list(const Section& parent, std::string_view key, const std::string& label);
  [[nodiscard]] std::vector<Step> read_step(const Section::Origin& table);
  [[nodiscard]] std::vector<Step> read_cycle(const Section& section);
  [[nodiscard]] std::vector<Step> read_plain_step(const Section& section, const StepForm& form);
  void read_targets(const Section& section, const StepForm& form, Step& step);
  [[nodiscard]] std::vector<Until> read_until(const Section& step);
  void check_duration_or_rate(const Section& section, bool has_own_times);
  [[nodiscard]] bool is_within_limit(std::size_t steps, const SourceLocation& where);
  [[nodiscard]] const StepForm* form_of(const toml::table& table) const;
  void report_formless(const Section::Origin& table);

  Reading& reading_;
  const Language& language_;
  std::vector<NamedWall> named_walls_;
  FileTexts files_;
  std::size_t steps_so_far_ = 0;  ///< steps of all programs read so far
};

}  // namespace monograin
