#include "twin/diagnose/diagnose.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/circular_motion/circle_run.h"
#include "tests/circular_motion/oracle.h"
#include "tests/support/thresholds.h"
#include "twin/benches/circular_motion/bench.h"
#include "twin/benches/circular_motion/twin/factory.h"
#include "twin/diagnose/by_twin.h"

namespace twinbench::benches::circular {
namespace {

Scenario Believed() {
  return ParseScenario(
      "bench = \"circular_motion\"\nseed = 7\n[environment]\nswing_mK = 700.0\nswing_period_s = 7000.0", "believed",
      ".", {"circular_procedure.points=72", "circular_procedure.stops=18"});
}

diagnose::Diagnosis DiagnosisOf(const std::vector<Reading>& readings, const Scenario& believed) {
  diagnose::DiagnoseOptions options;
  options.null_runs = 100;  // enough for a threshold
  options.cache_folder = test::ThresholdsFolder();
  return Diagnose(readings, believed, options).diagnosis;
}

std::string NameOf(const diagnose::Diagnosis& d) {
  if (d.verdict == diagnose::Verdict::kNone) return "none";
  return d.causes.empty() ? "unknown" : d.causes.front().effect + d.causes.front().where;
}

/// What a run of the one is diagnosed as by who believes the other.
std::string NameOf(const Scenario& is, const Scenario& believed) {
  return NameOf(DiagnosisOf(test::CircleReadings(is), believed));
}

/// Of two small circles, which are soon driven.
Scenario BelievedBodies() {
  return ParseScenario("bench = \"circular_motion\"\nseed = 7\n[mechanics]\nfidelity = \"bullet\"", "believed", ".",
                       {"circular_procedure.points=72", "circular_procedure.stops=18", "drives.play_x_um=1.0",
                        "circular_procedure.setups=[{ instrument = \"bar\", radius_mm = 60.0 }, { instrument = \"grid\", radius_mm = 60.0 }]",
                        "circular_procedure.feeds_mm_min=[1000.0]"});
}

TEST(CircularDiagnosis, TellsWhatBodiesDoFromWhatElseIsWrong) {
  const Scenario believed = BelievedBodies();
  EXPECT_EQ(NameOf(believed, believed), "none");
  Scenario squint = believed;
  CircularOf(squint).machine.squareness_rad = 1.0 * units::arcsec;
  EXPECT_EQ(NameOf(squint, believed), "squareness");
  Scenario late = believed;  // a gain is lag and spike at once, no single cause of the catalogue
  CircularOf(late).drives.position_gain_1_s[0] = 47.0;
  EXPECT_NE(NameOf(late, believed), "none");
  Scenario closed = believed;  // who takes the axes for rigid learns that they are not
  CircularOf(closed).mechanics.fidelity = "kinematic";
  EXPECT_NE(NameOf(believed, closed), "none");
}

TEST(DiagnosisByTwin, NeedsNeitherFreeConstantsNorAngles) {
  Scenario scenario = Believed();
  CircularOf(scenario).mounting = {0.0, 0.0, 0.0, 0.0};
  diagnose::TwinComparison comparison;
  comparison.format = &Format();
  comparison.follow = FollowRecord;
  comparison.unit = "um";
  comparison.to_SI = units::um;
  comparison.shown = [](const Reading& r) -> Eigen::VectorXd {
    const Deviation shown = DeviationOf(r);
    return Eigen::Vector2d(shown.radial_m, shown.tangential_m);
  };
  diagnose::DiagnoseOptions options;
  options.null_runs = 100;
  const std::vector<Reading> readings = WithAngles(test::CircleReadings(scenario));
  EXPECT_EQ(NameOf(diagnose::DiagnoseByTwin(readings, scenario, options, comparison).diagnosis), "none");
}

}  // namespace
}  // namespace twinbench::benches::circular
