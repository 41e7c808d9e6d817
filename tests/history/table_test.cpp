#include "history/table.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "system/resolution.hpp"

namespace monograin::table_test {
namespace {

/// A CSV file in a temporary directory of its own, gone with the test.
class CsvFile : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              (std::string("monograin-table-") + test->name() + "-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::filesystem::path file() const { return folder_ / "history.csv"; }
  void write(const std::string& text) const { std::ofstream(file(), std::ios::binary) << text; }
  [[nodiscard]] Table read(const std::string& text) const {
    write(text);
    return read_csv(file());
  }
  [[nodiscard]] Table round_trip(const Table& table) const {
    std::ostringstream text;
    text << csv_text(table);
    return read(text.str());
  }
  /// What reading complains about, without the folder.
  [[nodiscard]] std::string fault_of(const std::string& text) const {
    try {
      static_cast<void>(read(text));
    } catch (const std::runtime_error& fault) {
      const std::string what = fault.what();
      return what.substr(what.find("history.csv"));
    }
    return "no fault";
  }

 private:
  std::filesystem::path folder_;
};

std::string text_of(const Table& table) {
  std::ostringstream text;
  text << csv_text(table);
  return text.str();
}

Table one_column(std::vector<std::string> labels = {}) {
  return Table(std::vector<Column>{{"x", "", std::move(labels)}});
}

Table small_history() {
  Table table(
      {{"time", "s", {}}, {"row", "", {}}, {"axial.force", "N", {}}, {"axial.regime", "", {"open", "elastic"}}});
  table.header = {{"model", "mdr"}, {"R0", "0.01"}};
  table.append(std::array{0.0, 0.0, k_nan, 0.0});
  table.append(std::array{0.1, -1.0, 2.5, 1.0});
  return table;
}

TEST(Table, WritesHeaderHeadingsAndAsFewDigitsAsRestoreANumber) {
  EXPECT_EQ(text_of(small_history()),
            "# model: mdr\n"
            "# R0: 0.01\n"
            "time[s],row,axial.force[N],axial.regime\n"
            "0,0,nan,open\n"
            "0.1,-1,2.5,elastic\n");
}

TEST(Table, WritesEveryNanWithoutSign) {
  Table table = one_column();
  table.append(std::array{-k_nan});
  EXPECT_EQ(text_of(table), "x\nnan\n");
}

TEST(Table, KeepsALineBreakOutOfTheHeader) {
  Table table = one_column();
  table.header = {{"title", "two\nlines"}};
  EXPECT_EQ(text_of(table), "# title: two lines\nx\n");
}

TEST_F(CsvFile, HasNoValueWhereACellAmongNumbersIsEmpty) {
  const Table table = read("x[m],word,nothing\n1,,\n,a,\n");
  EXPECT_FALSE(table.columns()[0].holds_words());
  EXPECT_EQ(table.at(0, 0), 1.0);
  EXPECT_TRUE(std::isnan(table.at(1, 0)));
  EXPECT_EQ(table.word(0, 1), "");
  EXPECT_EQ(table.word(1, 1), "a");
  EXPECT_EQ(table.word(1, 2), "") << "a column without numbers";
}

TEST(Table, RefusesWordsThatWouldBreakTheRows) {
  Table table = one_column({"top,left"});
  table.append(std::array{0.0});
  EXPECT_THROW(text_of(table), std::invalid_argument);
}

TEST(Table, FindsAColumnByNameAndByHeading) {
  const Table table = small_history();
  EXPECT_EQ(table.find("axial.force"), 2u);
  EXPECT_EQ(table.find("axial.force[N]"), 2u);
  EXPECT_EQ(table.find("row"), 1u);
  EXPECT_FALSE(table.find("axial.force[kN]"));
  EXPECT_FALSE(table.find("axial"));
  EXPECT_FALSE(table.find("axial.force["));
  EXPECT_FALSE(table.find("row[]"));
}

TEST(Table, NamesTheColumnsThereAreWhenOneIsMissing) {
  try {
    static_cast<void>(small_history().column("lateral.force"));
    FAIL() << "no exception";
  } catch (const std::out_of_range& fault) {
    EXPECT_STREQ(fault.what(), "no column 'lateral.force'; there are: time[s], row, axial.force[N], axial.regime");
  }
}

TEST(Table, RefusesARowOfTheWrongLength) {
  Table table = small_history();
  EXPECT_THROW(table.append(std::array{1.0, 2.0}), std::logic_error);
}

TEST(Table, HasNoWordForAnUndefinedCell) {
  Table table = one_column({"open"});
  table.append(std::array{k_nan});
  EXPECT_THROW(static_cast<void>(table.word(0, 0)), std::out_of_range);
}

TEST(Table, GivesAnEmptyViewForAnUnknownHeaderKey) { EXPECT_EQ(small_history().header_value("Y"), ""); }

TEST_F(CsvFile, ComesBackAsItWasWritten) {
  const Table table = small_history();
  const Table copy = round_trip(table);
  EXPECT_EQ(copy.header, table.header);
  ASSERT_EQ(copy.columns().size(), table.columns().size());
  for (std::size_t k = 0; k < table.columns().size(); ++k) {
    EXPECT_EQ(copy.columns()[k].name, table.columns()[k].name);
    EXPECT_EQ(copy.columns()[k].unit, table.columns()[k].unit);
    EXPECT_EQ(copy.columns()[k].labels, table.columns()[k].labels);
  }
  EXPECT_EQ(text_of(copy), text_of(table));
}

TEST_F(CsvFile, GivesBackEveryDoubleBitByBit) {
  using Limits = std::numeric_limits<double>;
  Table table = one_column();
  for (const double value : {0.0, -0.0, 0.1, 1.0 / 3.0, 1e15, 1e17, -123456789012345678.0, Limits::max(), Limits::min(),
                             Limits::denorm_min(), Limits::infinity(), -Limits::infinity()}) {
    table.append(std::array{value});
  }
  std::mt19937_64 bits(20240229);
  while (table.row_count() < 20000) {
    const auto value = std::bit_cast<double>(static_cast<std::uint64_t>(bits()));
    if (!std::isnan(value)) table.append(std::array{value});
  }
  const Table copy = round_trip(table);
  ASSERT_EQ(copy.row_count(), table.row_count());
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    ASSERT_EQ(std::bit_cast<std::uint64_t>(copy.at(row, 0)), std::bit_cast<std::uint64_t>(table.at(row, 0)))
        << table.at(row, 0);
  }
}

TEST_F(CsvFile, TakesAnyCellThatIsNoNumberForAWord) {
  const Table table = read("time[s],class\n0,\n1,axial/lateral\n2,\n");
  ASSERT_TRUE(table.columns()[1].holds_words());
  EXPECT_FALSE(table.columns()[0].holds_words());
  EXPECT_EQ(table.word(0, 1), "");
  EXPECT_EQ(table.word(1, 1), "axial/lateral");
  EXPECT_EQ(table.at(0, 1), table.at(2, 1));
}

TEST_F(CsvFile, MayHaveForeignLineEndsBlankLinesAndBlanks) {
  const Table table = read("\xEF\xBB\xBF# R0: 0.01\r\n\r\n time[s] , force[N]\r\n\r\n0, 1\r\n 1 ,+2e0\r\n");
  EXPECT_EQ(table.header_value("R0"), "0.01");
  EXPECT_EQ(table.column("force"), (std::vector{1.0, 2.0}));
}

TEST_F(CsvFile, MayBeWrittenByASpreadsheet) {
  for (const char* text : {"# R0: 1\ntime[s];force[N];regime\n0,5;-2,5e-3;elastic, soft\n1;;plastic\n",
                           "# R0: 1\ntime[s]\tforce[N]\tregime\n0,5\t-2,5e-3\telastic, soft\n1\t\tplastic\n"}) {
    const Table table = read(text);
    EXPECT_EQ(table.column("time"), (std::vector{0.5, 1.0})) << text;
    EXPECT_EQ(table.column("force[N]").front(), -2.5e-3);
    EXPECT_TRUE(std::isnan(table.column("force[N]").back()));
    EXPECT_EQ(table.word(0, 2), "elastic, soft");
    EXPECT_EQ(table.header_number("R0"), 1.0);
  }
  std::string wide = "\xFF\xFE";
  for (const char c : std::string("a,b\n1,2\n")) wide.append({c, '\0'});
  EXPECT_EQ(read(wide).column("b"), std::vector{2.0});
  EXPECT_EQ(fault_of(wide + 'x'),
            "history.csv:1:1: it begins as UTF-16LE and is not: it may be cut off; expected a table (CSV)");
}

TEST_F(CsvFile, NeedsNoLineBreakAtTheEnd) { EXPECT_EQ(read("x\n1\n2").row_count(), 2u); }

TEST_F(CsvFile, KeepsCommentsWithoutAKey) {
  const Table table = read("# just a remark\n# note: a: b\n# empty:\nx\n1\n");
  using Header = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(table.header, (Header{{"just a remark", ""}, {"note", "a: b"}, {"empty", ""}}));
}

TEST_F(CsvFile, MayHaveHeadingsAndNoRows) {
  const Table table = read("time[s],event\n");
  EXPECT_EQ(table.columns().size(), 2u);
  EXPECT_EQ(table.row_count(), 0u);
}

TEST_F(CsvFile, TakesNumbersBeyondTheRangeOfDoubleAsStrtodDoes) {
  const Table table = read("x\n1e-400\n-1e400\n");
  EXPECT_EQ(table.column("x"), (std::vector{0.0, -k_infinity}));
}

TEST_F(CsvFile, SaysWhichLineIsRagged) {
  EXPECT_EQ(fault_of("# R0: 1\n\na,b\n1,2\n1,2,3\n"), "history.csv:5:1: the row has 3 cells, but there are 2 headings");
}

TEST_F(CsvFile, SaysThatHeadingsAreMissing) {
  EXPECT_EQ(fault_of(""), "history.csv:1:1: no row of headings");
  EXPECT_EQ(fault_of("# R0: 1\n"), "history.csv:1:1: no row of headings");
  EXPECT_EQ(fault_of("0,1\n2,3\n"), "history.csv:1:1: numbers where a row of headings is expected");
  EXPECT_EQ(fault_of("a,,c\n"), "history.csv:1:1: column 2 has no heading");
}

TEST_F(CsvFile, SaysThatAHeadingComesTwice) {
  EXPECT_EQ(fault_of("x[m],y,x[m]\n1,2,3\n"), "history.csv:1:1: two columns are called 'x[m]'");
}

TEST_F(CsvFile, SaysThatAFileOrItsNameIsWrong) {
  try {
    static_cast<void>(read_csv(file()));
    FAIL() << "no exception";
  } catch (const std::runtime_error& fault) {
    EXPECT_EQ(std::string(fault.what()), file().string() + ":1:1: there is no such file; expected a table (CSV)");
  }
  EXPECT_THROW(static_cast<void>(read_csv(file().parent_path())), std::runtime_error);
}

}  // namespace
}  // namespace monograin::table_test
