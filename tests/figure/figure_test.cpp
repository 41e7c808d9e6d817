#include "figure/figure.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "figure/run_curves.hpp"
#include "support/text_file.hpp"

namespace monograin::figure_test {
namespace {

namespace fs = std::filesystem;

/// Sets an environment variable and puts the old value back.
class Environment {
 public:
  Environment(const char* name, const std::string& value) : name_(name), before_(std::getenv(name)) {
    setenv(name, value.c_str(), 1);
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;
  ~Environment() { setenv(name_, before_.c_str(), 1); }

 private:
  const char* name_;
  std::string before_;
};

void write(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  write_text(file, text);
}

/// Loading, unloading and reloading of one contact, with an undefined pressure.
constexpr const char* k_mdr_history =
    "# R0: 0.01\n# E: 1e9\n# Y: 5e7\n# status: complete\n"
    "time[s],step,row,apparent_radius[m],axial.displacement[m],axial.force[N],axial.contact_radius[m],"
    "axial.pressure[Pa],axial.regime\n"
    "0,1,0,0.01,0,0,0,nan,elastic\n"
    "1,1,0,0.0101,0.002,1000,0.002,8e7,fully-plastic\n"
    "2,2,0,0.0101,0.001,0,0,0,separated\n"
    "3,3,0,0.0101,0.0015,500,0.001,5e7,unloading\n"
    "4,3,0,0.0102,0.003,2000,0.003,7e7,fully-plastic\n";
constexpr const char* k_mdr_events =
    "time[s],class,event,step,apparent_radius[m],axial.displacement[m],axial.force[N],axial.contact_radius[m],"
    "axial.pressure[Pa],axial.regime\n"
    "0.5,axial,yield,1,0.01,0.001,500,0.001,9e7,fully-plastic\n"
    "0.5,,growth-on,1,0.01,0.001,500,0.001,9e7,fully-plastic\n"
    "1,,step-end,1,0.0101,0.002,1000,0.002,8e7,fully-plastic\n";
constexpr const char* k_hertz_history =
    "# R0: 0.01\n# E: 1e9\n"
    "time[s],step,row,axial.displacement[m],axial.force[N],axial.contact_radius[m],axial.pressure[Pa],axial.regime,"
    "lateral.displacement[m],lateral.force[N],lateral.contact_radius[m],lateral.pressure[Pa],lateral.regime\n"
    "0,1,0,0,0,0,0,elastic,0,0,0,0,open\n"
    "1,1,0,0.001,50,0.001,1.6e7,elastic,0,0,0,0,open\n";

class Figure : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "monograin-figure-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    write(run() / "history.csv", k_mdr_history);
    write(run() / "events.csv", k_mdr_events);
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] fs::path in_folder(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] fs::path run() const {
    return folder_ / "runs" / "it's_a_run";
  }  // a name gnuplot has to be told with care
  [[nodiscard]] std::string fault_of(const std::vector<fs::path>& runs, const fs::path& output) const {
    try {
      draw_runs(runs, output);
    } catch (const FigureError& fault) {
      return fault.what();
    }
    return "no fault";
  }
  /// A program called gnuplot that does what the shell commands say; returns its folder.
  [[nodiscard]] fs::path false_gnuplot(const std::string& commands) const {
    const fs::path program = folder_ / "bin" / "gnuplot";
    write(program, "#!/bin/sh\n" + commands + "\n");
    fs::permissions(program, fs::perms::owner_all);
    return program.parent_path();
  }

 private:
  fs::path folder_;
};

TEST_F(Figure, ShowsTheContactAreaOfTheDeformedParticle) {
  write(run() / "history.csv",
        "# R0: 0.01\n# E: 1e9\ntime[s],step,row,axial.displacement[m],axial.force[N],axial.contact_radius[m],"
        "axial.contact_radius_deformed[m],axial.pressure[Pa],axial.regime\n"
        "0,1,0,0,0,0,0,0,elastic\n1,1,0,0.001,50,0.001,0.002,1.6e7,elastic\n");
  fs::remove(run() / "events.csv");
  write(run() / "events.csv", "time[s],class,event,step,axial.displacement[m]\n");
  const figure::RunCurves curves = figure::read_run(run());
  EXPECT_DOUBLE_EQ(curves.contacts.at(0).states.back()[figure::Quantity::area], std::numbers::pi * 4e-6);
}

TEST_F(Figure, IsWrittenInEachFormat) {
  struct Case {
    const char* name;
    const char* begins;
  };
  for (const auto& [name, begins] : {Case{"a.svg", "<?xml"}, Case{"a.pdf", "%PDF"}, Case{"a.png", "\x89PNG"}}) {
    draw_runs({run()}, in_folder(name));
    EXPECT_TRUE(read_text(in_folder(name)).starts_with(begins)) << name;
  }
}

/// CRC-32 by polynomial division of the whole message, bit by bit.
std::uint32_t checksum(const std::string& bytes) {
  std::uint32_t remainder = 0xFFFFFFFFu;
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    const bool is_set = ((static_cast<unsigned char>(bytes[bit / 8]) >> (bit % 8)) & 1u) != 0;
    const bool divides = ((remainder & 1u) != 0) != is_set;
    remainder >>= 1u;
    if (divides) remainder ^= 0xEDB88320u;
  }
  return ~remainder;
}

std::uint32_t number_at(const std::string& bytes, std::size_t place) {
  std::uint32_t number = 0;
  for (std::size_t k = place; k < place + 4; ++k) number = (number << 8u) | static_cast<unsigned char>(bytes.at(k));
  return number;
}

TEST_F(Figure, StatesTheResolutionOfAPng) {
  draw_runs({run()}, in_folder("a.png"));
  const std::string png = read_text(in_folder("a.png"));
  std::vector<std::string> chunks;
  for (std::size_t place = 8; place < png.size();) {
    const std::uint32_t size = number_at(png, place);
    const std::string chunk = png.substr(place + 4, size + 4);
    EXPECT_EQ(number_at(png, place + 8 + size), checksum(chunk)) << chunk.substr(0, 4);
    chunks.push_back(chunk);
    place += 12 + size;
  }
  EXPECT_EQ(chunks.back(), "IEND");
  ASSERT_GT(chunks.size(), 2U);
  ASSERT_TRUE(chunks[1].starts_with("pHYs"));
  const double per_metre = number_at(chunks[1], 4);
  EXPECT_NEAR(0.0254 * per_metre, 300.0, 0.01) << "dots per inch";
  EXPECT_EQ(number_at(chunks[1], 8), number_at(chunks[1], 4));
  EXPECT_EQ(chunks[1].back(), '\1') << "per metre";
  EXPECT_NEAR(number_at(chunks[0], 4) / per_metre, 0.17, 1e-4) << "width [m]";
}

TEST_F(Figure, IsRefusedWhereNoFontHasALetter) {
  write(in_folder("bin/fc-list"), "#!/bin/sh\necho '20-7e a0-17f 391-3c9 2212 d7'\n");
  fs::permissions(in_folder("bin/fc-list"), fs::perms::owner_all);
  const Environment path("PATH", in_folder("bin").string() + ":" + std::getenv("PATH"));
  for (const char* name : {"压缩", "it's 压缩"}) {
    write(in_folder(name) / "history.csv", k_mdr_history);
    for (const char* file : {"a.pdf", "a.png"}) {
      const std::string fault = fault_of({run(), in_folder(name)}, in_folder(file));
      EXPECT_NE(fault.find("no installed font has '压缩'; install one that does"), std::string::npos) << fault;
      EXPECT_FALSE(fs::exists(in_folder(file)));
    }
    EXPECT_EQ(fault_of({run(), in_folder(name)}, in_folder("a.svg")), "no fault");
  }
  write(in_folder("other/history.csv"), k_mdr_history);
  EXPECT_EQ(fault_of({run(), in_folder("other")}, in_folder("压缩.png")), "no fault") << "only the file is named so";
}

TEST_F(Figure, LeavesScriptAndDataBesideItAndNothingElse) {
  draw_runs({run()}, in_folder("out/die.svg"));
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(in_folder("out"))) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"die.dat", "die.gp", "die.svg"}));
}

TEST_F(Figure, CanBeDrawnAgainFromItsScript) {
  draw_runs({run()}, in_folder("die.svg"));
  const std::string first = read_text(in_folder("die.svg"));
  fs::remove(in_folder("die.svg"));
  const std::string command = "cd '" + in_folder("").string() + "' && gnuplot die.gp 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(read_text(in_folder("die.svg")), first);
}

TEST_F(Figure, TellsLoadingUnloadingAndReloadingApart) {
  draw_runs({run()}, in_folder("die.svg"));
  const std::string data = read_text(in_folder("die.dat"));
  const auto holds = [&](const char* block) { return data.find(block) != std::string::npos; };
  EXPECT_TRUE(holds("# run 1 axial unloading\n0.2 0.01 1.6 0.04 1.01\n0.1 0 0 0 1.01\n")) << data;
  EXPECT_TRUE(holds("# run 1 axial reloading\n0.1 0 0 0 1.01\n0.15 0.005 1 0.01 1.01\n")) << data;
  // Beyond the old largest displacement it is loading again, cut off from the first way by a blank line.
  EXPECT_TRUE(holds("# run 1 axial loading\n0 0 NaN 0 1\n0.2 0.01 1.6 0.04 1.01\n\n0.15 0.005 1 0.01 1.01\n0.3 "))
      << data;
}

TEST_F(Figure, MarksEventsOfContactsAndOfTheParticleButNotOfTheProgram) {
  draw_runs({run()}, in_folder("die.svg"));
  const std::string data = read_text(in_folder("die.dat"));
  EXPECT_NE(data.find("# event yield.\n0.1 0.005 1.8 0.01 NaN\n"), std::string::npos) << data;
  EXPECT_NE(data.find("# event growth-on.\n0.1 NaN NaN NaN 1\n"), std::string::npos) << data;
  EXPECT_EQ(data.find("step-end"), std::string::npos) << data;
}

TEST_F(Figure, NeedsNoEvents) {
  fs::remove(run() / "events.csv");
  EXPECT_EQ(fault_of({run()}, in_folder("die.svg")), "no fault");
  EXPECT_EQ(read_text(in_folder("die.gp")).find("Events"), std::string::npos);
}

TEST_F(Figure, DrawsContactsThatLieOnEachOtherAsOne) {
  const std::string head =
      "time[s],step,row,punch.displacement[m],punch.force[N],anvil.displacement[m],anvil.force[N],"
      "stop.displacement[m],stop.force[N]\n0,1,0,0,0,0,0,0,0\n";
  write(in_folder("alike/history.csv"), head + "1,1,0,0.001,50,0,50.01,0,50\n");
  draw_runs({in_folder("alike")}, in_folder("alike.svg"));
  EXPECT_NE(read_text(in_folder("alike.gp")).find("title 'punch = anvil = stop'"), std::string::npos);
  EXPECT_EQ(read_text(in_folder("alike.gp")).find("'anvil'"), std::string::npos);
  write(in_folder("apart/history.csv"), head + "1,1,0,0.001,50,0,51,0,50\n");
  draw_runs({in_folder("alike"), in_folder("apart")}, in_folder("apart.svg"));
  EXPECT_NE(read_text(in_folder("apart.gp")).find("title 'punch = stop'"), std::string::npos);
  EXPECT_NE(read_text(in_folder("apart.gp")).find("title 'anvil'"), std::string::npos);
}

TEST_F(Figure, SaysWhereUnloadingLiesOnLoading) {
  const std::string loading = "time[s],step,row,axial.displacement[m],axial.force[N]\n0,1,0,0,0\n1,1,0,0.001,10\n";
  write(in_folder("elastic/history.csv"), loading + "2,2,0,0.0005,5\n");
  draw_runs({in_folder("elastic")}, in_folder("elastic.svg"));
  EXPECT_NE(read_text(in_folder("elastic.gp")).find("title 'unloading = loading'"), std::string::npos);
  write(in_folder("plastic/history.csv"), loading + "2,2,0,0.0005,0\n");
  draw_runs({in_folder("plastic")}, in_folder("plastic.svg"));
  EXPECT_NE(read_text(in_folder("plastic.gp")).find("title 'unloading'"), std::string::npos);
}

TEST_F(Figure, LeavesOutWhatARunDoesNotHave) {
  write(in_folder("hertz/history.csv"), k_hertz_history);
  EXPECT_EQ(fault_of({in_folder("hertz")}, in_folder("hertz.svg")), "no fault");
  const std::string script = read_text(in_folder("hertz.gp"));
  EXPECT_EQ(script.find("Apparent radius"), std::string::npos);
  EXPECT_EQ(script.find("'run 1 lateral loading' using 1:3"), std::string::npos) << "pressure of an open contact";
  EXPECT_NE(script.find("'run 1 lateral loading' using 1:2"), std::string::npos) << "force of an open contact";
  EXPECT_NE(script.find("{/:Italic p} / {/:Italic E}"), std::string::npos) << "without Y, the modulus is the scale";
}

TEST_F(Figure, CanShowARunInWhichNothingHappens) {
  write(in_folder("still/history.csv"), "time[s],axial.displacement[m],axial.force[N]\n0,0,0\n1,0,0\n");
  EXPECT_EQ(fault_of({in_folder("still")}, in_folder("still.svg")), "no fault");
}

TEST_F(Figure, OverlaysRunsUnderNamesThatDiffer) {
  write(in_folder("other/it's_a_run/history.csv"), k_mdr_history);
  EXPECT_EQ(fault_of({run(), in_folder("other/it's_a_run/history.csv")}, in_folder("both.svg")), "no fault");
  const std::string script = read_text(in_folder("both.gp"));
  EXPECT_NE(script.find(R"(runs/it's\134_a\134_run")"), std::string::npos) << script;
  EXPECT_NE(script.find(R"(/other/it's\134_a\134_run/history.csv)"), std::string::npos) << script;
}

TEST_F(Figure, StaysInUnitsWhereARunHasNoScales) {
  std::string bare = k_mdr_history;
  bare.erase(0, bare.find("time[s]"));
  write(in_folder("bare/history.csv"), bare);
  EXPECT_EQ(fault_of({run(), in_folder("bare")}, in_folder("bare.svg")), "no fault");
  EXPECT_NE(read_text(in_folder("bare.gp")).find("Force {/:Italic F} [N]"), std::string::npos);
}

TEST_F(Figure, HasRoomForTheNumbersOfItsAxes) {
  std::string stiff = k_mdr_history;
  stiff.replace(stiff.find("1e9"), 3, "1e15");
  stiff.replace(stiff.find("0.001,0,0,0,separated"), 7, "0.001,-10");
  write(in_folder("stiff/history.csv"), stiff);
  draw_runs({in_folder("stiff")}, in_folder("stiff.svg"));
  const std::string script = read_text(in_folder("stiff.gp"));
  EXPECT_NE(script.find("set ytics ('0' 0, '0.5' 5e-09, '1' 1e-08, '1.5' 1.5e-08, '2' 2e-08)"), std::string::npos)
      << script;
  EXPECT_NE(script.find("'×10^{−8}' at graph -0.01"), std::string::npos) << script;
  EXPECT_NE(script.find("set xtics 0.1\n"), std::string::npos) << script;
}

TEST_F(Figure, RefusesAnUnknownFormatAndListsTheKnown) {
  EXPECT_EQ(fault_of({run()}, "a.jpg"), "a.jpg: unknown figure format '.jpg'; expected .svg, .pdf or .png");
  EXPECT_EQ(fault_of({run()}, "a"), "a: unknown figure format ''; expected .svg, .pdf or .png");
}

TEST_F(Figure, SaysWhichRunCannotBeRead) {
  EXPECT_NE(fault_of({in_folder("none")}, in_folder("a.svg")).find("none:1:1: there is no such file"),
            std::string::npos);
  write(in_folder("packing/history.csv"), "time[s],stress[Pa]\n0,1\n");
  EXPECT_NE(fault_of({in_folder("packing")}, in_folder("a.svg")).find("no contacts to draw"), std::string::npos);
  write(in_folder("short/history.csv"), "time[s],axial.displacement[m],axial.force[N]\n0,0,0\n");
  EXPECT_NE(fault_of({in_folder("short")}, in_folder("a.svg")).find("needs two rows"), std::string::npos);
  write(in_folder("blank/history.csv"), "time[s],axial.displacement[m],axial.force[N]\n0,0,nan\n1,1,nan\n");
  EXPECT_NE(fault_of({in_folder("blank")}, in_folder("a.svg")).find("all values are undefined"), std::string::npos);
  EXPECT_FALSE(fs::exists(in_folder("a.gp")));
  EXPECT_EQ(fault_of({}, in_folder("a.svg")), "there is no run to draw");
}

TEST_F(Figure, WithoutGnuplotSaysWhatToInstallAndWritesNothing) {
  const Environment path("PATH", in_folder("").string());
  EXPECT_NE(fault_of({run()}, in_folder("out/a.svg")).find("apt-get install gnuplot-nox"), std::string::npos);
  EXPECT_FALSE(fs::exists(in_folder("out")));
}

TEST_F(Figure, NamesTheFigureThatGnuplotCannotDrawAndKeepsTheOldOne) {
  write(in_folder("a.svg"), "old");
  const Environment path("PATH", false_gnuplot("echo 'line 3: no such terminal'; exit 1").string());
  const std::string fault = fault_of({run()}, in_folder("a.svg"));
  EXPECT_NE(fault.find("gnuplot could not draw " + in_folder("a.svg").string()), std::string::npos) << fault;
  EXPECT_NE(fault.find("no such terminal"), std::string::npos) << fault;
  EXPECT_EQ(read_text(in_folder("a.svg")), "old");
  for (const char* name : {"a.gp", "a.dat"}) EXPECT_FALSE(fs::exists(in_folder(name))) << name;
}

constexpr const char* k_packing_history =
    "# E: 1e7\n# model: packing\n"
    "time[s],step,row,packing_fraction[-],strain[-],stress[Pa],stress_elastic[Pa],coordination_number[-],"
    "plastic_fraction[-],regime\n"
    "0,1,0,0.75,-0.05,0,0,nan,0,unjammed\n"
    "1,1,0,0.8,0.01,1e4,1e4,4,0,elastic\n"
    "2,1,0,0.9,0.12,6e5,6e5,5.4,0,elastic\n";
constexpr const char* k_packing_events =
    "time[s],class,event,step,packing_fraction[-],strain[-],stress[Pa],stress_elastic[Pa],coordination_number[-],"
    "plastic_fraction[-],regime\n"
    "1,,jamming,1,0.8,0.01,1e4,1e4,4,0,elastic\n"
    "2,,step-end,1,0.9,0.12,6e5,6e5,5.4,0,elastic\n";

TEST_F(Figure, OfAModelWithoutWallsShowsItsOwnColumns) {
  for (const char* name : {"first", "second"}) {
    write(in_folder(name) / "history.csv", k_packing_history);
    write(in_folder(name) / "events.csv", k_packing_events);
  }
  draw_runs({in_folder("first")}, in_folder("p.svg"));
  const std::string data = read_text(in_folder("p.dat"));
  EXPECT_NE(data.find("0.9 0.06"), std::string::npos) << data;  // stress over modulus
  EXPECT_NE(data.find("0.8 0.001"), std::string::npos) << data;
  const std::string script = read_text(in_folder("p.gp"));
  EXPECT_NE(script.find("Coordination number"), std::string::npos);
  EXPECT_NE(script.find("jamming"), std::string::npos);
  EXPECT_EQ(script.find("step-end"), std::string::npos);
  EXPECT_NE(script.find("'Events'"), std::string::npos);
  EXPECT_EQ(script.find("first"), std::string::npos);  // one run needs no name
  draw_runs({in_folder("first"), in_folder("second") / "history.csv"}, in_folder("q.svg"));
  EXPECT_NE(read_text(in_folder("q.gp")).find("second"), std::string::npos);
}

// Tension is positive in the file; a compression is drawn as the loading it is.
TEST_F(Figure, OfAMaterialPointGrowsTheWayItsProgramBegins) {
  const std::string head =
      "# yield_pressure: 1e6\ntime[s],step,row,strain_axial[-],stress_axial[Pa],p[Pa],q[Pa],relative_density[-]\n";
  write(in_folder("pressed") / "history.csv",
        head + "0,1,0,0,0,0,0,0.7\n1,1,0,-0.25,-4e6,-3e6,1e6,0.8\n2,2,0,-0.125,-1e6,-1e6,5e5,0.8\n");
  draw_runs({in_folder("pressed")}, in_folder("p.svg"));
  const std::string pressed = read_text(in_folder("p.dat"));
  EXPECT_NE(pressed.find("0.25 4\n"), std::string::npos) << pressed;
  EXPECT_NE(pressed.find("0.25 1\n"), std::string::npos) << "q has no sign";
  EXPECT_NE(read_text(in_folder("p.gp")).find("compression positive"), std::string::npos);
  EXPECT_EQ(read_text(in_folder("p.gp")).find("reloading"), std::string::npos);
  write(in_folder("pulled") / "history.csv", head + "0,1,0,0,0,0,0,0.7\n1,1,0,0.25,4e6,3e6,1e6,0.7\n");
  draw_runs({in_folder("pulled")}, in_folder("q.svg"));
  EXPECT_NE(read_text(in_folder("q.dat")).find("0.25 4\n"), std::string::npos);
  EXPECT_NE(read_text(in_folder("q.gp")).find("tension positive"), std::string::npos);
}

TEST_F(Figure, LeavesOutAPanelWithoutAnyValue) {
  write(in_folder("dense") / "history.csv",
        "time[s],step,row,strain_axial[-],stress_axial[Pa],p[Pa],q[Pa],relative_density[-]\n"
        "0,1,0,0,0,0,0,nan\n1,1,0,-0.25,-4e6,-3e6,1e6,nan\n");
  draw_runs({in_folder("dense")}, in_folder("p.svg"));
  const std::string script = read_text(in_folder("p.gp"));
  EXPECT_NE(script.find("'(c)'"), std::string::npos) << script;
  EXPECT_EQ(script.find("'(d)'"), std::string::npos) << script;
}

TEST_F(Figure, DoesNotMixModelsWithAndWithoutWalls) {
  write(in_folder("packing") / "history.csv", k_packing_history);
  EXPECT_NE(fault_of({in_folder("packing"), run()}, in_folder("p.svg")).find("has no column 'packing_fraction'"),
            std::string::npos);
  EXPECT_NE(fault_of({run(), in_folder("packing")}, in_folder("p.svg")).find("no contacts to draw"), std::string::npos);
}

}  // namespace
}  // namespace monograin::figure_test
