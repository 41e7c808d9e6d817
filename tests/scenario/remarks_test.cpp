// Remarks on a scenario that may be meant otherwise, before it runs.

#include "scenario/remarks.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scenario/support.hpp"

namespace monograin::remarks_test {
namespace {

using Lines = std::vector<std::string>;

Lines remarks_of(const std::string& text) { return remarks_on(parse_scenario(text, "a.toml")); }

TEST(Remarks, SayThatNoWallMovesInwards) {
  const Lines outwards{
      "no wall moves towards the particle or is pressed on it: displacements are positive inwards, forces in "
      "compression"};
  EXPECT_EQ(remarks_of(with_line(12, "displacement = \"-0.1 R0\"")), outwards);
  EXPECT_EQ(remarks_of(with_line(12, "displacement = \"0.1 R0\"")), Lines());
  const std::string adhesive = with_line(8, "yield_stress = \"50 MPa\"\nsurface_energy = \"1 J/m^2\"");
  EXPECT_EQ(remarks_on(parse_scenario(adhesive, "a.toml", {"loading.steps[0].displacement=-1e-6"})), Lines())
      << "pulled off from first touch";
  EXPECT_EQ(remarks_of(with_more("[[loading.steps]]\ndisplacement = \"-0.1 R0\"\nduration = 1\n")), Lines())
      << "unloading beyond first touch";
  EXPECT_EQ(remarks_of(with_line(12, "force = \"1 N\"")), Lines());
}

TEST(Remarks, SayThatAProgramDoesNothing) {
  const auto does_nothing = [](const Lines& remarks) {
    return remarks.size() == 1 && remarks.front().starts_with("the program does nothing");
  };
  EXPECT_TRUE(does_nothing(remarks_of(with_line(12, "displacement = 0"))));
  EXPECT_TRUE(does_nothing(remarks_of(with_line(12, "force = 0"))));
  EXPECT_EQ(remarks_of(with_line(12, "displacement = 1e-9")), Lines());
  EXPECT_EQ(remarks_of(with_more("[[loading.steps]]\ndisplacement = 0\nduration = 1\n")), Lines()) << "unloading";
  const std::string adhesive = with_line(8, "yield_stress = \"50 MPa\"\nsurface_energy = \"1 J/m^2\"");
  EXPECT_EQ(remarks_on(parse_scenario(adhesive, "a.toml", {"loading.steps[0].displacement=0"})), Lines())
      << "adhesion pulls at first touch";
  const std::string walls =
      "model = \"hertz\"\n[particle]\nradius = 1\n[material]\nyoungs_modulus = 1\npoisson_ratio = 0.3\n[loading]\n"
      "configuration = \"walls\"\nwall = [{ name = \"a\", normal = [0, 0, 1], gap = GAP, steps = [{ displacement = 0, "
      "duration = 1 }] }]\n";
  const auto with_gap = [&](const std::string& gap) { return std::string(walls).replace(walls.find("GAP"), 3, gap); };
  EXPECT_TRUE(does_nothing(remarks_of(with_gap("0"))));
  EXPECT_EQ(remarks_of(with_gap("0.1")), Lines()) << "the wall closes its gap";
}

TEST(Remarks, SayThatAPackingStaysElasticOrIsOnlyLoosened) {
  const auto packing = [](const std::string& material, const std::string& step) {
    return "model = \"packing\"\n[material]\nyoungs_modulus = \"10 MPa\"\npoisson_ratio = 0.45\n" + material +
           "\n[loading]\nsteps = [{ " + step + ", duration = 1 }]\n";
  };
  const std::string compaction = "packing_fraction = 0.95";
  const Lines elastic = remarks_of(packing("yield_stress = \"0.3 MPa\"", compaction));
  ASSERT_EQ(elastic.size(), 1U);
  EXPECT_TRUE(elastic.front().starts_with("yield_stress has no effect without hardening_modulus")) << elastic.front();
  EXPECT_EQ(remarks_of(packing("yield_stress = \"0.3 MPa\"\nhardening_modulus = 0", compaction)), Lines());
  EXPECT_EQ(remarks_of(packing("", compaction)), Lines());
  EXPECT_EQ(remarks_of(packing("", "hold = true")).size(), 1U) << "which does nothing";
  EXPECT_EQ(remarks_of(packing("", "strain = -0.15")),
            Lines{"the program only loosens the packing: compression is positive"});
}

TEST(Remarks, SayThatAPowderIsOnlyStretched) {
  const auto powder = [](const std::string& material, const std::string& step) {
    return "model = \"material-point\"\n[material]\npreset = \"Base case\"\n" + material +
           "\n[loading]\nconfiguration = \"die\"\nsteps = [{ " + step + ", duration = 1 }]\n";
  };
  EXPECT_EQ(remarks_of(powder("", "strain = 0.1")),
            Lines{"the program only stretches the material: tension is positive, compression negative"});
  EXPECT_EQ(remarks_of(powder("", "strain = 0")).size(), 1U) << "which does nothing";
  EXPECT_EQ(remarks_of(powder("", "strain = -0.1")), Lines());
  EXPECT_EQ(remarks_of(powder("yield_model = \"vm\"", "strain = 0.1")).size(), 1U) << "growth per density";
  EXPECT_EQ(remarks_of(powder("yield_model = \"vm\"\neta = 0\nxi = 0\nxi1 = 0", "strain = 0.1")), Lines());
}

}  // namespace
}  // namespace monograin::remarks_test
