/// Layout of a table of measured numbers in its file: separator, decimal sign, headings, units. Testing machines differ
/// in all of them; find_layout() finds what the user does not give.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace monograin {

/// Layout as the user gives it; absent parts are found.
struct TableFormat {
  enum class Units { found, row, none };

  std::optional<char> separator{};     ///< ',' ';' '\t', or ' ' for any number of blanks and tabs
  std::optional<char> decimal{};       ///< '.' or ','
  std::optional<std::size_t> skip{};   ///< lines above the headings, or above the data of a table without headings
  Units units = Units::found;          ///< row: a row of units stands below the headings
  std::vector<std::string> unit_of{};  ///< units of the columns in their order; empty: as in the file
  double most_missing = 0.0;           ///< share of the rows that may lack a number in a requested column
  bool may_have_trailer = true;        ///< lines of text may stand below the table
};

/// Layout as it was found. Lines are counted from 1 as an editor does; 0: there is none.
struct TableLayout {
  std::string encoding{};  ///< see DecodedText
  char separator = ',';
  char decimal = '.';
  std::size_t heading_line = 0;
  std::size_t unit_line = 0;
  std::size_t unmatched_line = 0;       ///< of texts above a table without headings, more or fewer than its columns
  std::size_t first_line = 0;           ///< of the data
  std::size_t preamble = 0;             ///< lines above the headings that are neither blank nor comments
  std::vector<std::string> headings{};  ///< one for each column; empty texts where the table has none
  std::vector<std::string> units{};     ///< of each column: as given, or of the row of units, or of its heading
  std::vector<bool> is_numeric{};       ///< true if most cells of the column are numbers
  bool splits_decimals = false;         ///< commas separate cells and mark decimals: rows have two cells a heading
};

/// Finds the layout from the first thousand lines that are neither blank nor comments ('#').
///
/// Separator and decimal sign are those with which the largest share of the cells are numbers. The data begin with the
/// first row that has a number in every column of numbers. The headings are the row that contains all of `names`, else
/// the last row above the data without any number. The next row is one of units if it has no numbers and names a unit.
/// @param text   in UTF-8, without a byte order mark
/// @param names  headings, with or without their units
[[nodiscard]] TableLayout find_layout(std::string_view text, const TableFormat& given,
                                      const std::vector<std::string_view>& names);

/// True for CSV in UTF-8 with commas and decimal points, with the headings first and nothing between them and the data.
[[nodiscard]] bool is_plain(const TableLayout& layout) noexcept;

/// Describes a layout: "UTF-16LE, semicolon between cells, decimal comma, headings in line 3, units in line 4".
[[nodiscard]] std::string describe(const TableLayout& layout);

/// Name of a separator: "comma", "semicolon", "tab", "blanks".
[[nodiscard]] std::string_view separator_word(char separator) noexcept;

/// True for a unit of a quantity that machines measure, also for those that the program does not convert: "%", "V".
[[nodiscard]] bool is_known_unit(std::string_view text);

/// Unit in a heading: "N" of "force[N]" and "force [N]", also of "force (N)", "force / N" and "force in N" if the unit
/// is known. Empty if there is none.
[[nodiscard]] std::string_view unit_in(std::string_view heading) noexcept;
/// The heading without its unit.
[[nodiscard]] std::string_view name_in(std::string_view heading) noexcept;

}  // namespace monograin
