/// The table [data] of a calibration file: how the data are written, which columns it names, and the machine between
/// sensor and particle. For readers of TOML files: includes the library.
#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "scenario/measured_data.hpp"
#include "scenario/section.hpp"
#include "study/calibrate/calibration.hpp"
#include "study/calibrate/calibration_language.hpp"
#include "study/calibrate/machine.hpp"

namespace monograin::calibration {

/// Kinds of the keys that may be names, numbers, lists or tables, as they are written in a table.
[[nodiscard]] DataKinds kinds_of(const toml::table& data);

/// Format of the measured file, as far as the user gives it.
[[nodiscard]] TableFormat format_of(Reading& reading, const Section& data, const DataKinds& kinds);

/// A column by which the file names it, with its quantity and unit.
struct ColumnSpec {
  ColumnRequest request;
  std::string quantity{};  ///< empty: that of the column's heading
  std::string unit{};      ///< empty: that of the column's heading
  double scale = 1.0;      ///< factor of its numbers
  SourceLocation quantity_at;
  SourceLocation unit_at;
};
[[nodiscard]] ColumnSpec column_spec(Reading& reading, const Section& data, std::string_view key, KeySpec::Kind kind);

/// The column of standard deviations of y that `noise` names; none if it names none.
[[nodiscard]] std::optional<ColumnSpec> noise_column_in(const Section& data);

/// Reads the parts that `noise` gives, and reports faults in them. @param of_x, of_y  dimensions
[[nodiscard]] NoiseParts read_noise(Reading& reading, const Section& data, Dimension of_x, Dimension of_y);

/// Reads a compliance written with its unit, and reports a fault if the text is no compliance.
[[nodiscard]] ParsedCompliance compliance_in(Reading& reading, const Section& section, std::string_view key);

/// Reads the machine: offsets, compliance and deflections. @param folder  to which the path of a table is relative
[[nodiscard]] Machine machine_in(Reading& reading, const Section& data, KeySpec::Kind kind,
                                 const std::filesystem::path& folder);

}  // namespace monograin::calibration
