// Tables as testing machines write them: whatever encoding, separator and decimal sign, the numbers are those of the
// plain file; what cannot be read is reported with its place and what to do.

#include "scenario/measured_data.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scenario/cells.hpp"

namespace monograin::measured_data_test {
namespace {

using Cells = std::vector<std::string>;

const std::vector<Cells> k_rows{{"0.0", "0.00", "-1.5e-3"},   {"0.5", "0.52", "12.25"}, {"1.0", "1.04", "80.125"},
                                {"1.5", "1.56", "+240.0625"}, {"2.0", "1.30", "96.5"},  {"2.5", "1.2", "3"}};
const std::vector<double> k_x{0.0, 0.52, 1.04, 1.56, 1.3, 1.2};
const std::vector<double> k_y{-1.5e-3, 12.25, 80.125, 240.0625, 96.5, 3.0};

// --- files as machines write them

struct Writing {
  char separator;
  char decimal;
  bool is_quoted;
};

std::string cell_of(std::string text, const Writing& writing) {
  for (char& c : text) {
    if (c == '.' && writing.decimal == ',') c = ',';
  }
  return writing.is_quoted ? '"' + text + '"' : text;
}

std::string line_of(const Cells& cells, const Writing& writing) {
  std::string line;
  for (const std::string& cell : cells) line += cell_of(cell, writing) + writing.separator;
  line.pop_back();
  return line;
}

/// Lines above the headings.
enum class Preamble { none, title, specimen, comments };

std::string preamble_text(Preamble preamble, const Writing& writing) {
  switch (preamble) {
    case Preamble::none:
      return "";
    case Preamble::title:
      return line_of({"Results Table 1"}, writing) + '\n';
    case Preamble::specimen:
      return line_of({"Operator", "J. Müller"}, writing) + "\n\n" + line_of({"Rate", "0.5", "mm/min"}, writing) + '\n' +
             line_of({"Date", "2024-03-12"}, writing) + '\n';
    case Preamble::comments:
      return "# made by a machine\n#\n";
  }
  return "";
}

/// Where the units stand.
enum class UnitPlace { heading, row, bracketed_row };

std::string table_text(const Writing& writing, Preamble preamble, UnitPlace place) {
  std::string text = preamble_text(preamble, writing);
  const Cells names{"Time", "Weg", "Kraft"};
  const Cells units{"s", "µm", "mN"};
  Cells headings = names;
  Cells row_units = units;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (place == UnitPlace::heading) headings[k] += fmt::format("[{}]", units[k]);
    if (place == UnitPlace::bracketed_row) row_units[k] = fmt::format("({})", units[k]);
  }
  text += line_of(headings, writing) + '\n';
  if (place != UnitPlace::heading) text += line_of(row_units, writing) + '\n';
  for (const Cells& row : k_rows) text += line_of(row, writing) + '\n';
  return text;
}

/// Code points of a text in UTF-8 of which none is beyond U+07FF.
std::vector<unsigned> code_points(const std::string& text) {
  std::vector<unsigned> points;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const auto byte = static_cast<unsigned char>(text[k]);
    if (byte < 0x80U) {
      points.push_back(byte);
    } else {
      points.push_back(((byte & 0x1FU) << 6U) | (static_cast<unsigned char>(text[++k]) & 0x3FU));
    }
  }
  return points;
}

std::string latin_1(const std::string& text) {
  std::string bytes;
  for (const unsigned point : code_points(text)) bytes += static_cast<char>(point);
  return bytes;
}

std::string utf_16(const std::string& text, bool is_little) {
  std::string bytes;
  for (const unsigned point : code_points(text)) {
    const std::array<char, 2> unit{static_cast<char>(point & 0xFFU), static_cast<char>(point >> 8U)};
    bytes += unit[is_little ? 0 : 1];
    bytes += unit[is_little ? 1 : 0];
  }
  return bytes;
}

struct Encoding {
  const char* name;  ///< as it is reported
  std::function<std::string(const std::string&)> encode;
};

const std::vector<Encoding> k_encodings{
    {"UTF-8", [](const std::string& text) { return text; }},
    {"UTF-8 with BOM", [](const std::string& text) { return "\xEF\xBB\xBF" + text; }},
    {"Windows-1252", latin_1},
    {"UTF-16LE", [](const std::string& text) { return "\xFF\xFE" + utf_16(text, true); }},
    {"UTF-16BE", [](const std::string& text) { return "\xFE\xFF" + utf_16(text, false); }},
    {"UTF-16LE", [](const std::string& text) { return utf_16(text, true); }},
    {"UTF-16BE", [](const std::string& text) { return utf_16(text, false); }},
};

const std::vector<Writing> k_writings{
    {',', '.', false},  {',', '.', true},   {',', ',', true},  {';', '.', false}, {';', ',', false}, {';', ',', true},
    {'\t', '.', false}, {'\t', ',', false}, {'\t', ',', true}, {' ', '.', false}, {' ', ',', false},
};

// --- reading

const std::vector<ColumnRequest> k_by_name{{"Weg", {"c.toml"}, "x = \"Weg\""}, {"Kraft", {"c.toml"}, "y = \"Kraft\""}};

struct Outcome {
  MeasuredData data;
  std::vector<std::string> faults;
};

Outcome read(const std::string& bytes, const TableFormat& format = {},
             const std::vector<ColumnRequest>& wanted = k_by_name) {
  FaultList faults;
  Outcome outcome{parse_measured(bytes, "d.csv", wanted, faults, format), {}};
  try {
    faults.throw_if_any();
  } catch (const ScenarioError& error) {
    for (const Fault& fault : error.faults()) {
      outcome.faults.push_back(
          fmt::format("{}:{}:{}: {}", fault.where.file, fault.where.line, fault.where.column, fault.message));
    }
  }
  return outcome;
}

void expect_the_plain_numbers(const Outcome& outcome, const std::string& what) {
  ASSERT_EQ(outcome.faults, std::vector<std::string>()) << what;
  EXPECT_EQ(outcome.data.columns[0].values, k_x) << what;
  EXPECT_EQ(outcome.data.columns[1].values, k_y) << what;
}

TEST(MachineFiles, InAnyWritingGiveTheNumbersOfThePlainFile) {
  std::size_t variants = 0;
  for (const Encoding& encoding : k_encodings) {
    for (const Writing& writing : k_writings) {
      for (const Preamble preamble : {Preamble::none, Preamble::title, Preamble::specimen, Preamble::comments}) {
        for (const UnitPlace place : {UnitPlace::heading, UnitPlace::row, UnitPlace::bracketed_row}) {
          const std::string text = table_text(writing, preamble, place);
          const std::string what = fmt::format("{}, {}:\n{}", ++variants, encoding.name, text);
          const Outcome outcome = read(encoding.encode(text));
          expect_the_plain_numbers(outcome, what);
          const TableLayout& layout = outcome.data.layout;
          const bool has_signs = text.find("µ") != std::string::npos;
          EXPECT_EQ(layout.encoding, has_signs || encoding.name[0] == 'U' ? encoding.name : "UTF-8") << what;
          EXPECT_EQ(layout.separator, writing.separator) << what;
          EXPECT_EQ(layout.decimal, writing.decimal) << what;
          EXPECT_EQ(layout.units, (Cells{"s", "µm", "mN"})) << what;
          EXPECT_EQ(outcome.data.columns[1].heading.substr(0, 5), "Kraft") << what;
        }
      }
    }
  }
  EXPECT_GE(variants, 900U);
}

TEST(MachineFiles, EndWithLinesOfTextThatAreLeftOut) {
  for (const char* end : {"END\n", "***\n", "End of test;\nOperator;M. Miller\n\n"}) {
    const Outcome outcome = read(std::string("Weg;Kraft\n1;2\n3;4\n") + end);
    EXPECT_EQ(outcome.faults, Cells()) << end;
    EXPECT_EQ(outcome.data.columns[1].values, (std::vector<double>{2.0, 4.0})) << end;
    EXPECT_EQ(outcome.data.trailer.front(), 4U) << end;
  }
  EXPECT_EQ(read("Weg;Kraft\na;b\n").faults.size(), 1U) << "no row above";
}

TEST(MachineFiles, EndWithoutCellsThatBeginNumbers) {
  EXPECT_EQ(read("Weg;Kraft\n1.5;2\n3.5;4\n4,5;5,5\n").faults,
            (Cells{"d.csv:4:1: Weg = 4,5: expected a finite number; the decimal sign of the rows above is '.'",
                   "d.csv:4:5: Kraft = 5,5: expected a finite number; the decimal sign of the rows above is '.'"}));
  for (const char* cell : {"5.5.5", "-3x", "+.5.", ",5e", "−7 N"}) {
    EXPECT_EQ(read(std::string("Weg;Kraft\n1.5;2\n3.5;4\nMax;") + cell + "\n").faults.size(), 2U) << cell;
  }
}

TEST(MachineFiles, EndWithLinesOfTextWhereTheyMayOnly) {
  EXPECT_EQ(
      read("Weg;Kraft\n1;2\n3;4\nEND\n\n", {.may_have_trailer = false}).faults,
      Cells{"d.csv:4:1: 1 cell where there are 2 headings; expected a cell for each, and nothing below the table"});
}

TEST(MachineFiles, MayHaveBlankLinesBetweenRowsAndAtTheirEnd) {
  for (const char separator : {',', ';', '\t', ' '}) {
    std::string text = "Weg;Kraft\n1;2\n\n3;4\n\n  \n\r\n\n";
    for (char& c : text) {
      if (c == ';') c = separator;
    }
    const Outcome outcome = read(text);
    EXPECT_EQ(outcome.faults, Cells()) << text;
    EXPECT_EQ(outcome.data.columns[1].values, (std::vector<double>{2.0, 4.0})) << text;
    EXPECT_TRUE(outcome.data.trailer.empty()) << text;
  }
}

TEST(MachineFiles, MayBeginARowWithAnErrorOfASpreadsheet) {
  const Outcome outcome = read("t,Weg,Kraft\n0,1,2\n#N/A,3,4\n# a comment\n2,5,6\n");
  EXPECT_EQ(outcome.faults, Cells());
  EXPECT_EQ(outcome.data.columns[0].values, (std::vector<double>{1.0, 3.0, 5.0}));
}

TEST(MachineFiles, AreFoundWithoutNamesToo) {
  for (const Writing& writing : k_writings) {
    for (const Preamble preamble : {Preamble::none, Preamble::title, Preamble::specimen, Preamble::comments}) {
      const std::string text = table_text(writing, preamble, UnitPlace::row);
      const Outcome outcome = read(text, {}, {{"", {"c.toml"}, "x = 2", 2}, {"", {"c.toml"}, "y = 3", 3}});
      expect_the_plain_numbers(outcome, text);
      EXPECT_EQ(outcome.data.layout.headings, (Cells{"Time", "Weg", "Kraft"})) << text;
      EXPECT_EQ(outcome.data.layout.units, (Cells{"s", "µm", "mN"})) << text;
    }
  }
}

TEST(MachineFiles, LeaveOutRowsWithoutANumberAndCountThem) {
  for (const Writing& writing : k_writings) {
    if (writing.separator == ' ') continue;  // between blanks a missing cell cannot be seen
    std::string text = table_text(writing, Preamble::title, UnitPlace::row);
    for (const char* missing : {"", "NaN", "n/a", "---", "#N/A", "#WERT!", "#DIV/0!"}) {
      text += line_of({"3.0", missing, "7.5"}, writing) + '\n';
    }
    text += line_of({"", "", ""}, writing) + '\n';        // says nothing
    text += line_of({"", "1.0", "2.0"}, writing) + '\n';  // lacks what is not asked for
    const Outcome outcome = read(text, {.most_missing = 0.5});
    ASSERT_EQ(outcome.faults, Cells()) << text;
    EXPECT_EQ(outcome.data.left_out, (std::vector<std::size_t>{10, 11, 12, 13, 14, 15, 16})) << text;
    EXPECT_EQ(outcome.data.lines.size(), k_x.size() + 1) << text;
    const Outcome strict = read(text);
    ASSERT_EQ(strict.faults.size(), 7U) << text;
  }
}

TEST(MachineFiles, TooManyRowsWithoutANumberAreRefused) {
  const std::string text = "Weg,Kraft\n1,2\n2,\n3,4\n4,5\n";
  EXPECT_EQ(read(text, {.most_missing = 0.25}).faults, Cells());
  EXPECT_EQ(
      read(text, {.most_missing = 0.1}).faults,
      Cells{"d.csv:3:3: Kraft = (nothing): expected a finite number; 1 of 4 rows have none, and no more than 10 % "
            "may be left out"});
}

TEST(MachineFiles, TakeTheUsersWordForTheirWriting) {
  // One column of decimal commas, or two of whole numbers: only the user knows.
  const std::string text = "Weg;Kraft\n1,5;2,5\n3,5;4,5\n";
  EXPECT_EQ(read(text).data.columns[1].values, (std::vector{2.5, 4.5}));
  const std::string whole = "Weg,Kraft\n1,5\n3,4\n";
  EXPECT_EQ(read(whole).data.columns[1].values, (std::vector{5.0, 4.0}));
  EXPECT_EQ(read(text, {.separator = ';', .decimal = ',', .skip = 0}).data.columns[0].values, (std::vector{1.5, 3.5}));
  const std::string preamble = "Weg,Kraft\nis,old\nWeg,Kraft\n1,2\n";
  EXPECT_EQ(read(preamble, {.skip = 2}).data.layout.heading_line, 3U);
  EXPECT_EQ(read(preamble, {.skip = 2}).data.columns[0].values, std::vector{1.0});
  const Outcome forced = read("Weg,Kraft\nfoo,bar\n1,2\n", {.units = TableFormat::Units::row});
  EXPECT_EQ(forced.data.layout.units, (Cells{"foo", "bar"}));
  EXPECT_EQ(read("Weg,Kraft\nmm,N\n1,2\n", {.units = TableFormat::Units::none}).faults.size(), 2U);
  const Outcome listed = read("Weg,Kraft\nmm,N\n1,2\n", {.unit_of = {"um", "kN"}});
  EXPECT_EQ(listed.data.layout.units, (Cells{"um", "kN"}));
  EXPECT_EQ(listed.data.columns[0].values, std::vector{1.0});
}

TEST(MachineFiles, SayOnceThatTheyAreWrittenOtherwiseThanTheUserSays) {
  const std::string points = "Weg,Kraft\n0.5,1.5\n0.6,2.5\n";
  const std::string commas = "Weg;Kraft\n0,5;1,5\n0,6;2,5\n";
  const auto complaint = [](const char* given, const char* separator, const char* decimal) {
    return Cells{
        fmt::format("d.csv:2:1: the table cannot be read with the given {2}; it has {0} between the cells and the "
                    "decimal sign '{1}': expected separator = \"{0}\" and decimal = \"{1}\", or neither key",
                    separator, decimal, given)};
  };
  EXPECT_EQ(read(points, {.decimal = ','}).faults, complaint("decimal", "comma", "."));
  EXPECT_EQ(read(points, {.separator = ';'}).faults, complaint("separator", "comma", "."));
  EXPECT_EQ(read(points, {.separator = ';', .decimal = ','}).faults, complaint("separator and decimal", "comma", "."));
  EXPECT_EQ(read(commas, {.separator = ','}).faults, complaint("separator", "semicolon", ","));
  EXPECT_EQ(read(commas, {.decimal = '.'}).faults, complaint("decimal", "semicolon", ","));
  EXPECT_EQ(read("Weg;Kraft\n0,5;x\n0,6;2,5\n", {.separator = ';'}).faults,
            Cells{"d.csv:2:5: Kraft = x: expected a finite number"})
      << "a fault that no setting causes";
}

TEST(MachineFiles, WithCommasBetweenCellsAndInNumbersAreRefused) {
  const std::string text = "Weg,Kraft\n0,5,1,25\n1,5,2,25\n";
  const std::vector<ColumnRequest> numbered{{"", {"c.toml"}, "x = 1", 1}, {"", {"c.toml"}, "y = 2", 2}};
  EXPECT_EQ(read(text, {}, numbered).faults,
            Cells{"d.csv:2:1: 4 cells below 2 headings: commas seem to separate the cells and to mark decimals; "
                  "expected another separator, or cells in quotes"});
  EXPECT_EQ(read("Weg,Kraft\n\"0,5\",\"1,25\"\n", {}, numbered).data.columns[1].values, std::vector{1.25});
  EXPECT_EQ(read("a,b,c\n0,5,1,25\n1,5,2,25\n", {}, numbered).faults, Cells()) << "three texts are a preamble";
  EXPECT_EQ(read("Operator,Smith\n0.01,2.5,0.1,3.0\n", {}, numbered).faults, Cells()) << "decimal points";
  EXPECT_EQ(read(text, {.decimal = '.'}, numbered).data.columns[1].values, (std::vector{5.0, 5.0})) << "as it is told";
}

TEST(MachineFiles, MayHaveNoHeadings) {
  const Outcome outcome =
      read("A test of one grain\n1 2.5\n2 3.5\n", {}, {{"", {"c.toml"}, "x = 1", 1}, {"", {"c.toml"}, "y = 2", 2}});
  EXPECT_EQ(outcome.faults, Cells());
  EXPECT_EQ(outcome.data.columns[1].values, (std::vector{2.5, 3.5}));
  EXPECT_EQ(outcome.data.layout.heading_line, 0U);
  EXPECT_TRUE(outcome.data.columns[0].heading.empty());
}

TEST(MachineFiles, MayEndTheirLinesAndRowsInAnyManner) {
  std::string text = table_text({';', ',', false}, Preamble::title, UnitPlace::row);
  std::string carriage;
  std::string windows;
  std::string trailing;
  for (const char c : text) {
    carriage += c == '\n' ? '\r' : c;
    if (c == '\n') windows += '\r';
    windows += c;
    if (c == '\n') trailing += ';';
    trailing += c;
  }
  for (const std::string& variant : {carriage, windows, trailing, text + "\n\n", text + ";;\n"}) {
    expect_the_plain_numbers(read(variant), variant);
  }
}

TEST(MachineFiles, MayWriteMinusAsItsOwnSign) {
  EXPECT_EQ(read("Weg,Kraft\n\xE2\x88\x92"
                 "1.5,2\n")
                .data.columns[0]
                .values,
            std::vector{-1.5});
  EXPECT_EQ(read("Weg;Kraft\n\xE2\x88\x92"
                 "1,5;2\n")
                .data.columns[0]
                .values,
            std::vector{-1.5});
  EXPECT_EQ(read("Weg,Kraft\n\xE2\x88\x92-1.5,2\n").faults.size(), 1U);
}

TEST(MachineFiles, MayHaveAColumnThatIsAlwaysEmpty) {
  const std::string text = "Weg [mm];Kraft [N];Remark\n0,5;1,5;\n1,5;2,5;\n";
  EXPECT_EQ(read(text).data.columns[1].values, (std::vector{1.5, 2.5}));
  const std::vector<ColumnRequest> wrong{{"weg", {"c.toml"}, "x = \"weg\""}};
  EXPECT_EQ(read(text, {}, wrong).faults,
            Cells{"c.toml:1:1: x = \"weg\": d.csv has no such column; expected one of Weg [mm], Kraft [N], Remark"});
}

TEST(MachineFiles, MayMarkThousands) {
  const Outcome german = read("Weg;Kraft\n0,5;998,25\n1,5;1.100,5\n-2,5;1.234.567\n");
  EXPECT_EQ(german.faults, Cells());
  EXPECT_EQ(german.data.layout.separator, ';');
  EXPECT_EQ(german.data.columns[1].values, (std::vector{998.25, 1100.5, 1234567.0}));
  const Outcome english = read("Weg,Kraft\n0.5,998.25\n1.5,\"1,100.5\"\n2.5,\"-12,345,678\"\n");
  EXPECT_EQ(english.faults, Cells());
  EXPECT_EQ(english.data.columns[1].values, (std::vector{998.25, 1100.5, -12345678.0}));
  // 1100 or 1.1: only the user knows.
  EXPECT_EQ(read("Weg;Kraft\n0,5;1.100\n1,5;2,5\n").faults.size(), 1U);
  for (const char* text : {"1.10,5", "1100.200,5", ".100,5", "1..100,5", "1.1000,5", "1.100.20"}) {
    EXPECT_EQ(number_in(text, ','), std::nullopt) << text;
  }
}

struct FaultCase {
  const char* name;
  std::string bytes;
  Cells faults;
};

class MachineFileFaults : public ::testing::TestWithParam<FaultCase> {};

TEST_P(MachineFileFaults, NameRowColumnReasonAndWhatToDo) {
  EXPECT_EQ(read(GetParam().bytes).faults, GetParam().faults);
}

const std::vector<FaultCase> k_faults{
    {"Spreadsheet",
     std::string("PK\x03\x04\x14\0\x06\0", 8),
     {"d.csv:1:1: this is a spreadsheet or an archive, not a text; expected the sheet exported as CSV"}},
    {"ZeroBytes",
     std::string("Weg,Kraft\n1,2\0\n", 15),
     {"d.csv:1:1: it holds zero bytes, as no text does; expected the table exported as text, for example as CSV"}},
    {"CutOff", "\xFF\xFEW\0e", {"d.csv:1:1: it begins as UTF-16LE and is not: it may be cut off"}},
    {"Thousands",
     "Weg;Kraft\n0,5;12.34,5\n1,5;2,5\n2,5;2,5\n",
     {"d.csv:2:5: Kraft = 12.34,5: expected a finite number; expected no thousands separators, or groups of three "
      "digits"}},
    {"MixedSigns",
     "Weg;Kraft\n0.5;1.5\n0.6;1,5\n0.7;2.5\n",
     {"d.csv:3:5: Kraft = 1,5: expected a finite number; the decimal sign of the rows above is '.'"}},
    {"ColumnCountedInCharacters", "Weg;Kraft;µ\n1;x;µ\n2;3;4\n", {"d.csv:2:3: Kraft = x: expected a finite number"}},
    {"BetweenRows",
     "Weg,Kraft\n1,2\n3,4\nEnd of test\n5,6\n",
     {"d.csv:4:1: 1 cell where there are 2 headings; expected a cell for each, and nothing below the table"}},
    {"NumberBelowTheTable",
     "Weg;Kraft\n1;2\n3;4\nMax;4;N\n",
     {"d.csv:4:1: 3 cells where there are 2 headings; expected a cell for each, and nothing below the table"}},
    {"Pipes",
     "Weg|Kraft\n1|2\n3|4\n",
     {"c.toml:1:1: x = \"Weg\": d.csv has no such column; expected one of Weg|Kraft; the cells were read with comma "
      "between them, and expected is comma, semicolon, tab or blanks"}},
    {"TwoOfAName",
     "Weg,Kraft,Weg\n1,2,3\n",
     {"c.toml:1:1: x = \"Weg\": columns 1 and 3 of d.csv are both called so; expected the number of one"}},
    {"NoHeadings",
     "1,2\n3,4\n",
     {"d.csv:1:1: a number where a row of headings is expected, for example displacement[m],force[N]; or give the "
      "columns by their numbers, from 1, without quotes"}},
    {"ClockTimes",
     "Weg;Kraft\n00:00:10;1\n",
     {"d.csv:2:1: Weg = 00:00:10: expected a finite number; clock times are not understood, expected times in "
      "one unit, such as seconds"}},
};

INSTANTIATE_TEST_SUITE_P(All, MachineFileFaults, ::testing::ValuesIn(k_faults),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(MachineFiles, AskedForAColumnBeyondTheLastSayHowManyThereAre) {
  EXPECT_EQ(read("a,b\n1,2\n", {}, {{"", {"c.toml"}, "x = 3", 3}}).faults,
            Cells{"c.toml:1:1: x = 3: d.csv has 2 columns"});
}

TEST(MachineFiles, NeedAUnitForEachColumnWhereUnitsAreListed) {
  EXPECT_EQ(
      read("Weg,Kraft\n1,2\n", {.unit_of = {"mm"}}).faults,
      Cells{"d.csv:2:1: 2 columns, but 1 units are given; expected a unit for each, in the order of the columns"});
}

struct HeadingCase {
  std::string heading;
  std::string name;
  std::string unit;
};

TEST(Headings, SayTheirUnitsInSeveralManners) {
  for (const HeadingCase& c : std::vector<HeadingCase>{{"force[N]", "force", "N"},
                                                       {"Force [lbf]", "Force", "lbf"},
                                                       {"Extension (mm)", "Extension", "mm"},
                                                       {"Force (filtered)", "Force (filtered)", ""},
                                                       {"Weg / µm", "Weg", "µm"},
                                                       {"Kraft in kN", "Kraft", "kN"},
                                                       {"Load, N", "Load", "N"},
                                                       {"Strain in die", "Strain in die", ""},
                                                       {"[mm]", "[mm]", ""},
                                                       {"displacement", "displacement", ""}}) {
    EXPECT_EQ(name_in(c.heading), c.name);
    EXPECT_EQ(unit_in(c.heading), c.unit);
  }
}

}  // namespace
}  // namespace monograin::measured_data_test
