// Tables that a scenario takes a curve from: what is read, and every fault at its place in the table.

#include "scenario/curve_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "scenario/support.hpp"
#include "support/temporary_folder.hpp"

namespace monograin::curve_file_test {
namespace {

constexpr const char* k_good_table = "delta_max_over_R,p_over_Y\n0,2.75\n0.1,2.1\n0.2,1.7\n0.5,1.2\n";

std::vector<std::string> table_faults(const std::string& text) {
  FaultList faults;
  static_cast<void>(parse_curve(text, "p.csv", faults));
  std::vector<std::string> lines;
  try {
    faults.throw_if_any();
  } catch (const ScenarioError& error) {
    std::istringstream messages(error.what());
    for (std::string line; std::getline(messages, line);) lines.push_back(line);
  }
  return lines;
}

SampledCurve curve_in(const std::string& text) {
  FaultList faults;
  SampledCurve curve = parse_curve(text, "p.csv", faults);
  EXPECT_EQ(faults.size(), 0U) << text;
  return curve;
}

TEST(CurveFile, GivesItsSamplesAndItsText) {
  const SampledCurve curve = curve_in(k_good_table);
  EXPECT_EQ(curve.x, (std::vector{0.0, 0.1, 0.2, 0.5}));
  EXPECT_EQ(curve.y, (std::vector{2.75, 2.1, 1.7, 1.2}));
  EXPECT_EQ(curve.text, k_good_table);
}

TEST(CurveFile, MayHaveCommentsBlanksAndForeignLineEnds) {
  const SampledCurve curve =
      curve_in("\xEF\xBB\xBF# made by hand\r\n\r\nx,p\r\n 0 ,\t2.75\r\n  # here\r\n0.1,+2.1\r\n2e-1,1.7 \r\n0.5,1.2");
  EXPECT_EQ(curve.x, (std::vector{0.0, 0.1, 0.2, 0.5}));
  EXPECT_EQ(curve.y, (std::vector{2.75, 2.1, 1.7, 1.2}));
}

struct TableRow {
  const char* name;
  const char* table;
  std::vector<std::string> messages;
};

class CurveFaults : public ::testing::TestWithParam<TableRow> {};

TEST_P(CurveFaults, AreReportedAtTheirPlace) { EXPECT_EQ(table_faults(GetParam().table), GetParam().messages); }

const std::vector<TableRow> k_rows{
    TableRow{
        "Empty",
        "",
        {"p.csv:1:1: the table is empty; expected a row of headings, for example delta_max_over_R,p_over_Y, and at "
         "least 4 rows of numbers"}},
    TableRow{
        "OnlyComments",
        "# one\n# two\n",
        {"p.csv:2:1: the table is empty; expected a row of headings, for example delta_max_over_R,p_over_Y, and at "
         "least 4 rows of numbers"}},
    TableRow{"OnlyHeadings", "x,p\n", {"p.csv:1:1: the table ends after 0 rows; expected at least 4"}},
    TableRow{"TooShort", "x,p\n0,3\n0.1,2\n0.2,1\n", {"p.csv:4:1: the table ends after 3 rows; expected at least 4"}},
    TableRow{"NoHeadings",
             "0,3\n0.1,2\n0.2,2\n0.3,1\n",
             {"p.csv:1:1: numbers where a row of headings is expected, for example delta_max_over_R,p_over_Y"}},
    TableRow{"ThreeColumns",
             "x,p,q\n0,3\n0.1,2\n0.2,2\n0.3,1\n",
             {"p.csv:1:1: 3 cells where 2 are expected, for example delta_max_over_R,p_over_Y"}},
    TableRow{"RaggedRow",
             "x,p\n0,3\n  0.1\n0.2,2\n0.3,1,1\n0.4,1\n",
             {"p.csv:3:3: 1 cell where 2 are expected, for example 0.1,2.1",
              "p.csv:5:1: 3 cells where 2 are expected, for example 0.1,2.1"}},
    TableRow{"NotNumbers",
             "x,p\n0, high\n0.1,\n0.2,nan\n0.3,inf\n0.4,1e999\n",
             {"p.csv:2:4: p = high: expected a number from 1e-09 to 1e+09",
              "p.csv:3:5: p = (nothing): expected a number from 1e-09 to 1e+09",
              "p.csv:4:5: p = nan: expected a number from 1e-09 to 1e+09",
              "p.csv:5:5: p = inf: expected a number from 1e-09 to 1e+09",
              "p.csv:6:5: p = 1e999: expected a number from 1e-09 to 1e+09"}},
    TableRow{"BeginsLate", "x,p\n0.05,3\n0.1,2\n0.2,2\n0.3,1\n", {"p.csv:2:1: x = 0.05: expected 0 in the first row"}},
    TableRow{"NotAscending",
             "x,p\n0,3\n0.2,2\n0.1,2\n0.1,1\n0.3,1\n",
             {"p.csv:4:1: x = 0.1: not above the one before, 0.2; expected ascending values at least 1e-09 apart",
              "p.csv:5:1: x = 0.1: not above the one before, 0.1; expected ascending values at least 1e-09 apart"}},
    TableRow{"NegativeOrZero",
             "x,p\n-1,3\n0.1,0\n0.2,-2\n0.3,1\n",
             {"p.csv:2:1: x = -1: expected a number from 0 to 1e+09",
              "p.csv:3:5: p = 0: expected a number from 1e-09 to 1e+09",
              "p.csv:4:5: p = -2: expected a number from 1e-09 to 1e+09"}},
    TableRow{"ControlCharacters",
             "x,p\n0,3\n0.1,\x01\n0.2,2\n0.3,1\n",
             {"p.csv:3:5: p = ?: expected a number from 1e-09 to 1e+09"}},
};

INSTANTIATE_TEST_SUITE_P(CurveFile, CurveFaults, ::testing::ValuesIn(k_rows),
                         [](const auto& row) { return std::string(row.param.name); });

TEST(CurveFile, WithFaultsThroughoutIsNotReadToTheEnd) {
  std::string text = "x,p\n";
  for (int i = 0; i < 1000; ++i) text += "a,b\n";
  const auto faults = table_faults(text);
  EXPECT_LE(faults.size(), 25U);
  EXPECT_NE(faults.back().find("the rest of the table is not checked"), std::string::npos) << faults.back();
}

// --- named by a scenario

class PressureTable : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path() / name, std::ios::binary) << text;
  }
  /// A scenario in the folder, whose [mdr] has this line; its faults, with the folder's path cut out.
  [[nodiscard]] CheckedScenario read(const std::string& line, const std::vector<std::string>& overrides = {}) const {
    write("s.toml", with_more("[mdr]\n" + line + "\n"));
    return read_scenario(folder_.path() / "s.toml", overrides);
  }
  [[nodiscard]] std::vector<std::string> faults(const std::string& line,
                                                const std::vector<std::string>& overrides = {}) const {
    std::vector<std::string> lines;
    try {
      static_cast<void>(read(line, overrides));
    } catch (const ScenarioError& error) {
      const std::string folder = folder_.path().string() + "/";
      std::istringstream messages(error.what());
      for (std::string text; std::getline(messages, text);) {
        for (std::size_t at = 0; (at = text.find(folder)) != std::string::npos;) text.erase(at, folder.size());
        lines.push_back(text);
      }
    }
    return lines;
  }

  TemporaryFolder folder_;
};

TEST_F(PressureTable, IsSoughtInTheScenariosFolder) {
  write("p.csv", k_good_table);
  const CheckedScenario scenario = read("pressure_table = \"p.csv\"");
  ASSERT_EQ(scenario.curves.count("pressure_table"), 1U);
  EXPECT_EQ(scenario.curves.at("pressure_table").text, k_good_table);
  EXPECT_EQ(std::get<std::string>(scenario.options.at("pressure_table")), "p.csv");
}

TEST_F(PressureTable, MayBeNamedByItsFullPath) {
  write("p.csv", k_good_table);
  const CheckedScenario scenario = read("pressure_table = \"" + (folder_.path() / "p.csv").string() + "\"");
  EXPECT_EQ(scenario.curves.at("pressure_table").x.size(), 4U);
}

TEST_F(PressureTable, MayBeNamedByAnOverride) {
  write("p.csv", k_good_table);
  EXPECT_EQ(read("", {"mdr.pressure_table=p.csv"}).curves.at("pressure_table").x.size(), 4U);
  EXPECT_EQ(
      faults("", {"mdr.pressure_table=q.csv"}),
      std::vector<std::string>{
          "override 'mdr.pressure_table=q.csv':1:20: pressure_table = \"q.csv\": there is no such file (q.csv); "
          "expected a table of two columns such as delta_max_over_R,p_over_Y, its path relative to the scenario's "
          "folder"});
}

TEST_F(PressureTable, WithoutOneThereIsNoCurve) { EXPECT_TRUE(read("strict = true").curves.empty()); }

TEST_F(PressureTable, ThatIsNoFileIsAFaultOfTheKey) {
  std::filesystem::create_directory(folder_.path() / "d");
  EXPECT_EQ(
      faults("pressure_table = \"d\""),
      std::vector<std::string>{
          "s.toml:15:18: pressure_table = \"d\": this is a directory (d); expected a table of two columns such as "
          "delta_max_over_R,p_over_Y, its path relative to the scenario's folder"});
}

TEST_F(PressureTable, FaultsStandBesideThoseOfTheScenario) {
  write("p.csv", "x,p\n0,3\n0.1,low\n0.2,2\n0.3,1\n");
  EXPECT_EQ(faults("pressure_table = \"p.csv\"\nstrict = 1"),
            (std::vector<std::string>{"p.csv:3:5: p = low: expected a number from 1e-09 to 1e+09",
                                      "s.toml:16:10: strict = 1: expected true or false"}));
}

TEST_F(PressureTable, ThatIsHugeIsRefused) {
  write("p.csv", std::string(3U << 20U, '#'));
  EXPECT_EQ(faults("pressure_table = \"p.csv\""),
            std::vector<std::string>{"p.csv:1:1: the table is too large; expected at most 1 MiB"});
}

// --- tables with more columns, read by their headings

class UnloadingTable : public ::testing::Test {
 protected:
  [[nodiscard]] std::vector<std::string> faults(const std::string& table, const std::string& options = {}) const {
    std::ofstream(folder_.path() / "u.csv", std::ios::binary) << table;
    return messages([&] { static_cast<void>(read(options)); });
  }

  [[nodiscard]] CheckedScenario read(const std::string& options = {}) const {
    const auto file = folder_.path() / "s.toml";
    std::ofstream(file, std::ios::binary)
        << "model = \"compressible\"\n[particle]\nradius = 1\n[material]\nstiffness_ratio = 100\nshear_ratio = 1\n"
           "nu0 = 0.3\nyield_pressure = 1\n[loading]\nconfiguration = \"simple\"\n[[loading.steps]]\n"
           "displacement = 0.1\nduration = 1\n[compressible]\nunloading_table = \"u.csv\"\n"
        << options;
    return read_scenario(file);
  }

  template <class Call>
  [[nodiscard]] std::vector<std::string> messages(const Call& call) const {
    std::vector<std::string> lines;
    try {
      call();
    } catch (const ScenarioError& error) {
      for (const Fault& fault : error.faults()) {
        lines.push_back(std::filesystem::path(fault.where.file).filename().string() + ":" +
                        std::to_string(fault.where.line) + ":" + std::to_string(fault.where.column) + ": " +
                        fault.message);
      }
    }
    return lines;
  }

  TemporaryFolder folder_;
};

TEST_F(UnloadingTable, GivesTheColumnsThatItsOptionNames) {
  EXPECT_EQ(faults("# own\nbeta,stiffness_over_shear[-],other,alpha[-],delta_max_over_R0\n2,10,x,1.5,0.1\n3,10,y,1.4,"
                   "0.3\n"),
            std::vector<std::string>());
  const SampledCurve table = read().curves.at("unloading_table");
  EXPECT_EQ(table.x, (std::vector{10.0, 10.0}));
  EXPECT_EQ(table.y, (std::vector{0.1, 0.3}));
  EXPECT_EQ(table.values, (std::vector<std::vector<double>>{{1.5, 1.4}, {2.0, 3.0}}));
}

TEST_F(UnloadingTable, IsRefusedWithThePlaceOfEachFault) {
  const std::string head = "stiffness_over_shear,delta_max_over_R0,alpha,beta\n";
  EXPECT_EQ(
      faults(head + "10,0.1,0.5,2\n-1,0.6,1.5,0\n10,0.1,1.5,2\n"),
      (std::vector<std::string>{
          "u.csv:2:8: alpha = 0.5: expected a number from 1 to 1e+100",
          "u.csv:3:1: stiffness_over_shear = -1: expected a number above 0 and up to 1e+100",
          "u.csv:3:4: delta_max_over_R0 = 0.6: expected a number above 0 and up to 0.5",
          "u.csv:3:12: beta = 0: expected a number above 0 and up to 1e+100",
          "u.csv:4:1: stiffness_over_shear = 10 with delta_max_over_R0 = 0.1 stands in line 2 already; expected one "
          "row for each pair"}));
  const auto missing = faults("stiffness_over_shear,delta_max_over_R0,alfa,beta\n10,0.1,1.5,2\n");
  ASSERT_EQ(missing.size(), 1U);
  EXPECT_TRUE(missing[0].starts_with("s.toml:15:19: unloading_table = \"u.csv\": column 'alpha': ")) << missing[0];
  EXPECT_NE(missing[0].find("did you mean 'alfa'"), std::string::npos) << missing[0];
}

TEST_F(UnloadingTable, DoesNotGoWithTheNumbersItStandsFor) {
  EXPECT_EQ(
      faults("stiffness_over_shear,delta_max_over_R0,alpha,beta\n10,0.1,1.5,2\n", "alpha = 1.5\n"),
      (std::vector<std::string>{"s.toml:16:9: key 'alpha' does not go with 'unloading_table', which stands for it; "
                                "expected one of them"}));
  std::filesystem::remove(folder_.path() / "u.csv");
  const auto none = messages([&] { static_cast<void>(read()); });
  ASSERT_EQ(none.size(), 1U);
  EXPECT_NE(none[0].find("expected a table of columns such as stiffness_over_shear,delta_max_over_R0,alpha,beta"),
            std::string::npos)
      << none[0];
}

}  // namespace
}  // namespace monograin::curve_file_test
