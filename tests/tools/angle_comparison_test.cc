#include <fmt/core.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <sstream>

#include "tests/tools/program_here.h"

namespace twinbench::test {
namespace {

using testing::HasSubstr, testing::StartsWith;

class AngleComparison : public ProgramHere {
 protected:
  AngleComparison() {
    Write("angle.toml",
          "bench = \"encoder_comparison\"\n[encoder_procedure]\nturns = 1.0\nstops_per_turn = 36\n"
          "[[effect]]\nname = \"backlash\"\nwidth_deg = 1.0\n");
  }
};

TEST_F(AngleComparison, IsCarriedOutExportedAndImportedToTheSameResults) {
  const std::string summary = Succeed({"run", "angle.toml", "-o", "a"});
  EXPECT_THAT(summary, StartsWith("144 readings\n"));
  const auto truth = nlohmann::json::parse(Read("a/truth.json"));
  EXPECT_EQ(truth.at("effects").at(0).at("effect"), "backlash");
  EXPECT_NEAR(nlohmann::json::parse(Read("a/results.json")).at("mean_forward_deg"), -0.5, 0.001);
  Write("r.csv", ReadingsOf("a"));
  EXPECT_EQ(Succeed({"import", "r.csv", "--scenario", "angle.toml", "-o", "b"}) +
                "compare with the truth: twinbench score a\n",
            summary);
  EXPECT_EQ(Read("b/results.json"), Read("a/results.json"));
  EXPECT_EQ(Read("b/scenario.toml"), Read("a/scenario.toml"));
  EXPECT_EQ(ReadingsOf("b"), ReadingsOf("a"));
}

/// A device with eccentricity 0.5 deg and a reference with 72 arcsec once a turn, at three mountings.
constexpr const char* kMountings =
    "bench = \"encoder_comparison\"\n[encoder_procedure]\nturns = 2.0\nstops_per_turn = 36\n"
    "mounting_deg = [0.0, 100.0, 210.0]\n"
    "[[effect]]\nname = \"eccentricity\"\namplitude_deg = 0.5\nphase_deg = 40.0\n"
    "[[effect]]\nname = \"reference_fault\"\norder = 1.0\namplitude_deg = 0.02\nphase_deg = 75.0\n";

double Amplitude_arcsec(const nlohmann::json& harmonics, int order) {
  for (const auto& h : harmonics) {
    if (h.at("order") == order) return h.at("amplitude_arcsec");
  }
  return std::nan("");
}

TEST_F(AngleComparison, IsSeparatedIntoDeviceAndReferenceByItsMountingsAndScoredAgainstTheCurvesOfItsTruth) {
  Write("m.toml", kMountings);
  Succeed({"run", "m.toml", "-o", "m"});
  const std::string text = Succeed({"separate", "m", "--json", "s.json"});
  EXPECT_THAT(text, HasSubstr("device     order  1"));
  const auto separation = nlohmann::json::parse(Read("s.json"));
  for (const char* which : {"device", "reference"}) {
    for (const char* column : {"position_deg", "ez_arcsec", "u_ez_arcsec"})
      EXPECT_EQ(separation.at(which).at(column).size(), 360u);
  }
  // Noise of 7.2 arcsec in 864 readings leaves an order 0.35 arcsec, three mountings 1.1 times that.
  EXPECT_NEAR(Amplitude_arcsec(separation.at("harmonics").at("device"), 1), 1800.0, 1.5);
  EXPECT_NEAR(Amplitude_arcsec(separation.at("harmonics").at("reference"), 1), 72.0, 1.5);
  EXPECT_TRUE(separation.at("not_separable").empty()) << "only orders of 36 are seen alike";
  EXPECT_NEAR(separation.at("residual_rms").at("x_arcsec"), 7.2, 0.6) << "0.002 deg; three standard deviations";
  EXPECT_EQ(nlohmann::json::parse(Read("m/results.json")).at("device"), separation.at("device"));

  const auto score = nlohmann::json::parse(Succeed({"score", "m", "--json", "-"}));
  for (const char* which : {"device", "reference"}) {
    EXPECT_EQ(score.at(which).at("ez").at("positions"), 360);
    // Mean of 34 parts of orders: standard deviation 0.25.
    EXPECT_NEAR(score.at(which).at("ez").at("mean_chi2"), 1.0, 0.75);
  }
  EXPECT_NEAR(score.at("device").at("ez").at("rms_truth_arcsec"), 1800.0 / std::sqrt(2.0), 0.01);
  EXPECT_NEAR(score.at("reference").at("ez").at("rms_truth_arcsec"), 72.0 / std::sqrt(2.0), 0.01);
}

TEST_F(AngleComparison, OfAPartOfATurnIsEvaluatedButNotSeparated) {
  Succeed({"run", "angle.toml", "-o", "a", "--set", "encoder_procedure.turns=0.5"});
  EXPECT_EQ(nlohmann::json::parse(Read("a/results.json")).at("not_separated"),
            "no mounting has a complete turn in one direction");
  for (const char* command : {"separate", "score"})
    ExpectRefused({command, "a"}, "no mounting has a complete turn in one direction");
}

TEST_F(AngleComparison,
       ReportsTheReversalOfABacklashItsIsoValuesAndWithOneMountingThatItIsTheDifferenceThatItKnows) {
  Succeed({"run", "angle.toml", "-o", "a"});
  const auto results = nlohmann::json::parse(Read("a/results.json"));
  // The gap is 1 deg; noise of 7.2 arcsec in 72 readings each way leaves 1.2 arcsec.
  EXPECT_NEAR(results.at("reversal").at("mean_arcsec"), -3600.0, 5.0);
  EXPECT_EQ(results.at("reversal").at("reversal_arcsec").size(), 360u);
  const auto& iso = results.at("iso230_2").at(0);
  EXPECT_EQ(iso.at("axis").size(), 12u);
  EXPECT_EQ(iso.at("targets").size(), 36u);
  EXPECT_NEAR(iso.at("axis").at("mean B").at("value_arcsec"), -3600.0, 5.0);
  EXPECT_THAT(iso.at("missing").dump(), HasSubstr("2 forward runs"));

  const auto separation = nlohmann::json::parse(Succeed({"separate", "a", "--json", "-"}));
  EXPECT_FALSE(separation.contains("reference"));
  ASSERT_EQ(separation.at("not_separable").size(), 1u);
  EXPECT_EQ(separation.at("not_separable")[0].at("what"), "device and reference");
  EXPECT_THAT(Succeed({"score", "a"}), HasSubstr("with one mounting"));
}

/// The public test of a linear axis as that of a rotary one, a degree for a millimetre.
std::string AsAngles(const std::string& axis_csv) {
  std::istringstream in(axis_csv);
  std::string line, readings = "reading,phase,setup,pass,direction,position,time_s,reference_deg,measured_deg\n";
  for (int reading = 0; std::getline(in, line);) {
    double target = 0.0, actual = 0.0;
    int direction = 0, run = 0;
    if (std::sscanf(line.c_str(), "%lf,%d,%d,%lf", &target, &direction, &run, &actual) != 4) continue;
    const auto position = std::lround((target + 10.0) / 5.12);
    readings += fmt::format("{0},full_circle,0,{1},{2},{3},{0},{4},{5}\n", reading, run, direction, position,
                            target, actual);
    ++reading;
  }
  return readings;
}

TEST_F(AngleComparison, GivesTheIsoValuesOfAPublicTestOfAnAxis) {
  Write("r.csv", AsAngles(Contents(std::string(TWINBENCH_TEST_DATA) + "/iso230_2/linear_axis.csv")));
  const std::string text = Succeed({"import", "r.csv", "--scenario", "angle.toml", "-o", "b"});
  EXPECT_THAT(text, HasSubstr("ISO 230-2"));
  const auto iso = nlohmann::json::parse(Read("b/results.json")).at("iso230_2").at(0);
  EXPECT_THAT(iso.at("missing"), testing::IsEmpty()) << "5 targets over 20 deg, five runs from both sides";
  const std::map<std::string, double> published_deg = {
      {"B", 1.22e-5},  {"mean B", 5.4e-6}, {"R+", 5.033e-5}, {"R-", 6.290e-5}, {"R", 6.882e-5},  {"E+", 2.46e-5},
      {"E-", 3.30e-5}, {"E", 3.68e-5},     {"M", 2.77e-5},   {"A+", 6.428e-5}, {"A-", 8.881e-5}, {"A", 8.881e-5}};
  for (const auto& [name, value] : published_deg)  // half a unit of the last digit printed, and rounding
    EXPECT_NEAR(iso.at("axis").at(name).at("value_arcsec"), value * 3600.0, 0.51e-8 * 3600.0) << name;
  EXPECT_THAT(text, HasSubstr("VDI/DGQ 3441, arcsec: P "));
  const auto vdi = nlohmann::json::parse(Read("b/results.json")).at("vdi3441").at(0);
  EXPECT_EQ(vdi.at("axis").at("Pa").at("value_arcsec"), iso.at("axis").at("M").at("value_arcsec"));
  EXPECT_THAT(vdi.at("missing"), testing::IsEmpty());
}

TEST_F(AngleComparison, RefusesReadingsOfAnotherBenchErrorsOfTablesAndImages) {
  Write("small.toml", kSmall);
  MakeRun("rotary");
  Write("r.csv", ReadingsOf("rotary"));
  ExpectRefused({"import", "r.csv", "--scenario", "angle.toml", "-o", "b"}, "measured_deg");
  ExpectRefused({"run", "angle.toml", "-o", "a", "--errors", "target=t.csv"});
  ExpectRefused({"run", "angle.toml", "-o", "a", "--images"});
}

}  // namespace
}  // namespace twinbench::test
