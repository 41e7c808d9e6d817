/// The table [data] of a calibration file: how it is written, which columns it names, and what lies between machine and
/// particle. For readers of TOML files: includes the library.
#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "scenario/measured_data.hpp"
#include "scenario/section.hpp"
#include "study/calibrate/calibration_language.hpp"
#include "study/calibrate/machine.hpp"

namespace monograin::calibration {

/// How its keys are written that may be names, numbers, lists or tables.
[[nodiscard]] DataKinds kinds_of(const toml::table& data);

/// How the measured file is written, as far as the user says.
[[nodiscard]] TableFormat format_of(Reading& reading, const Section& data, const DataKinds& kinds);

/// A column as the file names it.
struct ColumnSpec {
  ColumnRequest request;
  std::string quantity;  ///< empty: that of the heading
  std::string unit;      ///< empty: that of the heading
  SourceLocation quantity_at;
  SourceLocation unit_at;
};
[[nodiscard]] ColumnSpec column_spec(Reading& reading, const Section& data, std::string_view key, KeySpec::Kind kind);

/// The column of standard deviations of y that `noise` names; none where it has none.
[[nodiscard]] std::optional<ColumnSpec> noise_column_in(const Section& data);

/// The two parts of a standard deviation of y, whose squares add.
struct NoiseParts {
  double absolute = 0.0;  ///< [SI of y]
  double relative = 0.0;  ///< over |y|
};
/// Reads the parts that `noise` gives, and reports its faults. @param of_y  dimension of y
[[nodiscard]] NoiseParts noise_in(Reading& reading, const Section& data, Dimension of_y);

/// A compliance written with its unit; a fault where it is none.
[[nodiscard]] ParsedCompliance compliance_in(Reading& reading, const Section& section, std::string_view key);

/// Offset and compliance. @param folder  where a table of deflections is sought
[[nodiscard]] Machine machine_in(Reading& reading, const Section& data, KeySpec::Kind kind,
                                 const std::filesystem::path& folder);

}  // namespace monograin::calibration
