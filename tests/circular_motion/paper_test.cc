#include "tests/circular_motion/circle_run.h"
#include "tests/circular_motion/oracle.h"
#include "tests/support/night.h"
#include "tests/support/over_seeds.h"
#include "tests/support/thresholds.h"
#include "twin/benches/circular_motion/analysis.h"
#include "twin/benches/circular_motion/bench.h"
#include "twin/benches/circular_motion/twin/factory.h"
#include "twin/diagnose/by_twin.h"

// The figures of the bar's paper, and what stands behind the uncertainties that are stated beside them: many runs.
namespace twinbench::benches::circular {
namespace {

using namespace separate::circular;
using units::um;

/// The paper's instrument: 0.1 um, 18000 lines read to 1/4096; everything else as well as it is usually.
Scenario Instrument(std::uint64_t seed, const std::vector<std::string>& settings) {
  Scenario scenario =
      ParseScenario("bench = \"circular_motion\"\n[environment]\nswing_mK = 700.0\nswing_period_s = 7000.0\n",
                    "instrument", ".", settings);
  scenario.seed = seed;
  return scenario;
}

/// Largest distance of the radius at any of 36 stops, in any of three runs on one mounting, from their mean.
double Unrepeated_m(std::uint64_t seed) {
  constexpr int kRuns = 3, kStops = 36;
  Eigen::MatrixXd radial_m(kStops, kRuns);
  for (int run = 0; run < kRuns; ++run) {
    const std::vector<Reading> readings = test::CircleReadings(
        Instrument(kRuns * seed + static_cast<std::uint64_t>(run),
                   {"circular_procedure.setups=[{ instrument = \"bar\", radius_mm = 156.278 }]",
                    "circular_procedure.feeds_mm_min=[1000.0]", "circular_procedure.points=3",
                    "circular_procedure.directions=[1]", "mounting.offset_um=0.0", "mounting.zero_deg=0.0",
                    "mounting.length_um=0.0"}));
    for (int k = 0; k < kStops; ++k)
      radial_m(k, run) = kBar_m(readings[readings.size() - kStops + static_cast<std::size_t>(k)]);
  }
  return (radial_m.colwise() - radial_m.rowwise().mean()).cwiseAbs().maxCoeff();
}

TEST(PaperOfTheBar, RepeatsWithinAMicrometreAt156Millimetres) {
  constexpr int kSets = 200;
  std::vector<double> largest_m;
  for (std::uint64_t seed = 1; seed <= kSets; ++seed) largest_m.push_back(Unrepeated_m(seed));
  std::ranges::sort(largest_m);
  EXPECT_LT(largest_m.back(), 1.0 * um) << "the paper's claim";
  // Another implementation of the same noise has 0.64 um in 95 of 100 sets; of 200 sets that quantile scatters
  // 0.03.
  EXPECT_NEAR(largest_m[kSets * 95 / 100] / um, 0.64, 0.08);
}

/// e' cov^-1 e of all fitted errors of machine, bar and encoder, and how many they are.
Eigen::Array2d ChiSquared(std::uint64_t seed) {
  const Scenario scenario = Instrument(seed, {"circular_procedure.points=60"});
  const CircleFit fit = Analyse(scenario, test::CircleReadings(scenario), Estimator::kRigorous).fit;
  const Eigen::Index count = std::ssize(fit.fitted);
  Eigen::VectorXd error(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const CircleUnknown& unknown = CircleUnknowns()[fit.fitted[static_cast<std::size_t>(k)]];
    CircleErrors found = fit.errors;
    const double truth = unknown.key.starts_with("machine.lag") ? 1e-3 : 0.0;  // as scenarios have it unsaid
    error[k] = unknown.in(found)-truth;
  }
  EXPECT_EQ(fit.shared.hidden.cols(), 0) << "two radii, two feeds and the grid tell all apart";
  return {error.dot(fit.shared.cov.topLeftCorner(count, count).inverse() * error), static_cast<double>(count)};
}

TEST(RigorousCircle, StatesUncertaintiesThatMatchItsErrors) {
  const int seeds = test::ByNight(20, 6);
  const Eigen::Array2d chi2_and_dof = seeds * test::MeanOverSeeds(seeds, ChiSquared);
  // Chi-squared per degree of freedom: standard deviation sqrt(2 / dof), about 0.06 with 20 runs.
  EXPECT_NEAR(chi2_and_dof[0] / chi2_and_dof[1], 1.0, 4.0 * std::sqrt(2.0 / chi2_and_dof[1])) << chi2_and_dof[1];
}

Scenario Believed() {
  return ParseScenario(
      "bench = \"circular_motion\"\nseed = 7\n[environment]\nswing_mK = 700.0\nswing_period_s = 7000.0", "believed",
      ".", {"circular_procedure.points=72", "circular_procedure.stops=18"});
}

std::string NameOf(const diagnose::Diagnosis& d) {
  if (d.verdict == diagnose::Verdict::kNone) return "none";
  return d.causes.empty() ? "unknown" : d.causes.front().effect + d.causes.front().where;
}

/// What a run of the one is diagnosed as by who believes the other.
std::string NameOf(const Scenario& is, const Scenario& believed) {
  return NameOf(Diagnose(test::CircleReadings(is), believed, test::QuickOptions(100)).diagnosis);
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
  const diagnose::DiagnoseOptions options = test::QuickOptions(100);
  const std::vector<Reading> readings = WithAngles(test::CircleReadings(scenario));
  EXPECT_EQ(NameOf(diagnose::DiagnoseByTwin(readings, scenario, options, comparison).diagnosis), "none");
}

}  // namespace
}  // namespace twinbench::benches::circular
