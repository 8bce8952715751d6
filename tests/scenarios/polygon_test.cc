#include "tests/support/angle_benches.h"
#include "tests/support/night.h"
#include "twin/benches/turntable_autocollimator/bench.h"
#include "twin/benches/turntable_autocollimator/estimators/polygon_analysis.h"
#include "twin/separate/compensation.h"

// The answer that the scenario of the polygon promises, and what the other commands make of such a run.
namespace twinbench {
namespace {

using separate::turntable::AngleSeries, separate::turntable::PolygonAnalysis, units::arcsec;

const std::string kFewClampings = "turntable_procedure.polygon_offsets_deg=[0, 57.6, 129.6, 273.6]";

Scenario PolygonScenario(const std::vector<std::string>& overrides = {}) {
  return LoadScenario(test::ScenarioPath("turntable_polygon.toml"), overrides);
}

PolygonAnalysis Closed(const std::vector<Reading>& readings, const Scenario& scenario,
                       Estimator estimator = Estimator::kRigorous) {
  return separate::turntable::AnalysePolygon(readings, scenario, estimator);
}

report::ScoredRun Scored(const test::BenchRun& run, Estimator estimator = Estimator::kRigorous) {
  return benches::turntable::ScoreRun(run.scenario, run.readings, run.truth, estimator);
}

/// Mean of (error / u)^2, as `score` has it.
double MeanSquare(const report::ScoredRun& scored, const char* curve) {
  double sum = 0.0;
  int count = 0;
  for (const report::ScoredValue& v : scored.values) {
    if (!v.name.starts_with(curve)) continue;
    sum += std::pow((v.value - v.truth) / v.u, 2);
    ++count;
  }
  return sum / count;
}

TEST(TurntablePolygon, KnowsTheEncodersCurveToFourThousandthsOfAnArcsecond) {
  constexpr int kSeeds = 16;
  double expanded = 0.0, encoder = 0.0, faces = 0.0, reading = 0.0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const test::BenchRun run = test::RunBench(PolygonScenario({fmt::format("seed={}", seed)}));
    const PolygonAnalysis a = Closed(run.readings, run.scenario);
    ASSERT_TRUE(a.closure);
    EXPECT_TRUE(a.closure->hidden.empty());
    expanded += 2.0 * std::sqrt(a.closure->turntable.cov_rad2.diagonal().mean()) / arcsec / kSeeds;
    reading += a.closure->noise.u_rad / arcsec / kSeeds;
    const report::ScoredRun scored = Scored(run);
    encoder += MeanSquare(scored, "turntable") / kSeeds;
    faces += MeanSquare(scored, "polygon") / kSeeds;
  }
  // 0.0297 arcsec stated, of which the encoder's step is no normal scatter but nearly so; 1200 degrees of freedom a
  // run.
  EXPECT_NEAR(reading, 0.0297, 0.0004);
  EXPECT_NEAR(expanded, 0.0038, 0.0002);
  // 10 and 23 degrees of freedom a run: deviations sqrt(2 / 160) and sqrt(2 / 368), three of each.
  EXPECT_NEAR(encoder, 1.0, 0.34);
  EXPECT_NEAR(faces, 1.0, 0.23);
}

struct LeaningPolygon {
  double tilt_arcsec, azimuth_deg;
  int faces;
};

TEST(TurntablePolygon, MayLeanByHundredsOfArcseconds) {
  const int seeds = test::ByNight(10, 2);
  for (const LeaningPolygon& p : {LeaningPolygon{60, 0, 24}, {100, 70, 24}, {200, 0, 24}, {150, 200, 18}, {400, 310, 36}}) {
    double encoder = 0.0;
    for (int seed = 1; seed <= seeds; ++seed) {
      const test::BenchRun run = test::RunBench(PolygonScenario(
          {fmt::format("seed={}", seed), fmt::format("turntable_procedure.tilts_arcsec=[{}]", p.tilt_arcsec),
           fmt::format("turntable_procedure.tilt_azimuths_deg=[{}]", p.azimuth_deg), fmt::format("polygon.faces={}", p.faces),
           fmt::format("turntable_procedure.positions={}", p.faces)}));
      encoder += MeanSquare(Scored(run), "turntable") / seeds;
    }
    // 10 degrees of freedom a run.
    EXPECT_GT(encoder, 0.2) << p.tilt_arcsec;
    EXPECT_LT(encoder, 4.0) << p.tilt_arcsec;
  }
}

TEST(TurntablePolygon, IsScoredByWhatItsClampingsSee) {
  const std::string orders = "turntable.harmonics=[{order=1,amplitude_arcsec=1},{order=5,amplitude_arcsec=0.7,phase_deg=20},"
                             "{order=12,amplitude_arcsec=0.9},{order=24,amplitude_arcsec=0.3,phase_deg=50}]";
  for (const char* highest : {"turntable_procedure.highest_order=5", "turntable_procedure.highest_order=12"}) {
    // Twelve faces: orders 12 and 24 are in the constants. Five clampings: order 5 is the faces'.
    const test::BenchRun run = test::RunBench(PolygonScenario({"polygon.faces=12", "turntable_procedure.positions=12", orders, highest,
                                                                   "turntable_procedure.polygon_offsets_deg=[3, 75, 147, 219, 291]"}));
    const report::ScoredRun scored = Scored(run);
    for (const char* curve : {"turntable", "polygon"}) EXPECT_LT(MeanSquare(scored, curve), 4.0) << highest << " " << curve;
  }
}

/// What faces that are not flat make of the eccentricity is order 1 of the encoder in every clamping.
TEST(TurntablePolygon, HasTheUnstatedFlatnessOfItsFacesInFull) {
  const Scenario stated = PolygonScenario({"mirror.flatness_nm=10", "noise_free=true", "encoder.step_arcsec=0",
                                           "autocollimator.deadband_arcsec=0.001"});
  Scenario unstated = stated;
  TurntableOf(unstated).mirror.flatness_m = 0.0;
  const test::BenchRun run = test::RunBench(stated);
  const auto truth = run.truth.at("turntable").at("ez_arcsec").get<std::vector<double>>();
  const AngleSeries known = Closed(run.readings, stated).closure->turntable;
  const AngleSeries taken = Closed(run.readings, unstated).closure->turntable;
  const double walk_arcsec = 8.0 * 10e-9 * 20e-6 / (14e-3 * 14e-3) / arcsec;
  EXPECT_NEAR(walk_arcsec, 0.0017, 0.0001) << "nine tenths of u from the readings";
  for (Eigen::Index i = 0; i < taken.value_rad.size(); i += 7) {
    const auto k = static_cast<std::size_t>(i);
    EXPECT_NEAR(known.value_rad[i] / arcsec, truth[k], 2e-4);
    EXPECT_NEAR(taken.value_rad[i] / arcsec, truth[k] - walk_arcsec * std::cos(taken.position_rad[k]), 2e-4);
  }
}

TEST(TurntablePolygon, StatesTheBiasOfClosureByMeans) {
  const Scenario uneven = PolygonScenario({"turntable_procedure.polygon_offsets_deg=[0, 57.6, 129.6, 150, 171]"});
  const test::BenchRun run = test::RunBench(uneven);
  const PolygonAnalysis published = Closed(run.readings, uneven, Estimator::kPublished);
  const double of_noise_arcsec = 0.03 * std::sqrt(10.0 / 480.0);
  EXPECT_GT(published.method_bias_rad / arcsec, 10.0 * of_noise_arcsec);
  EXPECT_LT(MeanSquare(Scored(run, Estimator::kPublished), "turntable"), 2.0);
  for (const auto& term : published.closure->encoder.terms) {
    const HarmonicSettings& truth =
        TurntableOf(uneven).turntable.harmonics[static_cast<std::size_t>(term.order - 1)];
    EXPECT_LT(std::abs(term.amplitude_rad - truth.amplitude), 3.0 * term.u_amplitude_rad) << term.order;
  }
  EXPECT_LT(MeanSquare(Scored(run), "turntable"), 2.5) << "10 degrees of freedom";
}

TEST(TurntablePolygon, SaysWhatItsUncertaintyIsMadeOf) {
  const Scenario uneven = PolygonScenario({"turntable_procedure.polygon_offsets_deg=[0, 57.6, 129.6, 150, 171]"});
  const test::BenchRun run = test::RunBench(uneven);
  for (const Estimator estimator : {Estimator::kRigorous, Estimator::kPublished}) {
    const nlohmann::json results = benches::turntable::Evaluate(uneven, run.readings, estimator).results;
    for (const char* curve : {"turntable", "polygon"}) {
      const nlohmann::json& parts = results.at("separation").at(curve).at("u_parts");
      EXPECT_EQ(parts.contains("model"), estimator == Estimator::kPublished) << "what closure by means is wrong by";
      double shares = 0.0;
      for (const auto& part : parts) shares += part.at(7).get<double>();
      EXPECT_NEAR(shares, 1.0, 1e-9) << curve;
      EXPECT_GT(parts.at("noise").at(7).get<double>(), parts.at("quantisation").at(7).get<double>());
    }
    double of_order = 0.0;
    for (const auto& share : results.at("model").at("terms").at(1).at("u_parts")) of_order += share.get<double>();
    EXPECT_NEAR(of_order, 1.0, 1e-9);
  }
}

TEST(TurntablePolygon, SaysWhyOneClampingIsNotEnough) {
  const Scenario one = PolygonScenario({"turntable_procedure.polygon_offsets_deg=[0]"});
  const report::Evaluation evaluation =
      benches::turntable::Evaluate(one, test::RunBench(one).readings, Estimator::kRigorous);
  EXPECT_FALSE(evaluation.Separated());
  EXPECT_THAT(evaluation.not_separated, testing::HasSubstr("more clampings"));
}

TEST(TurntablePolygon, RefusesReadingsOfAnotherClamping) {
  const Scenario few = PolygonScenario({kFewClampings});
  const Scenario other = PolygonScenario({"turntable_procedure.polygon_offsets_deg=[0, 67.6, 129.6, 273.6]"});
  const std::vector<Reading> readings = test::RunBench(few).readings;
  EXPECT_THROW(Closed(readings, other), InputError) << "10 deg off, more than half of a face";
  EXPECT_THROW(Closed(readings, PolygonScenario({"turntable_procedure.polygon_offsets_deg=[0]"})), InputError);
}

TEST(TurntablePolygon, CompensatesTheEncoder) {
  Scenario scenario = PolygonScenario();
  const auto measured = [](const Scenario& s) {
    return BenchOf(s).index_errors(s, test::RunBench(s).readings);
  };
  const separate::IndexErrors first = measured(scenario);
  const separate::Compensation compensation = Compensate(first);
  EXPECT_THAT(compensation.Orders(separate::LineFate::kCompensated), testing::ElementsAre(1, 2, 3, 4, 5));
  TurntableOf(scenario).turntable.compensation = compensation.table;
  scenario.seed += 1;
  const auto check = CheckCompensation(first, compensation, measured(scenario));
  // Of the same kind of readings, four in a mean: 0.015 arcsec.
  EXPECT_NEAR(check.remeasured_rms_rad / arcsec, 0.015, 0.002);
  EXPECT_NEAR(check.Ratio(), 1.0, 0.15);
}

TEST(TurntablePolygon, IsDiagnosed) {
  const Scenario scenario = PolygonScenario({kFewClampings});
  const auto diagnosed = [&](const std::string& effect) {
    std::vector<std::string> overrides = {kFewClampings};
    if (!effect.empty()) overrides.push_back("effect=[" + effect + "]");
    auto readings = test::RunBench(PolygonScenario(overrides)).readings;
    for (Reading& r : readings) r.target_rad = std::remainder(r.target_rad, units::turn);  // as encoders show them
    return benches::turntable::Diagnose(readings, scenario, {}).diagnosis;
  };
  EXPECT_EQ(diagnosed("").verdict, diagnose::Verdict::kNone);
  const auto slipped = diagnosed("{name=\"slip\", where=\"x\", step_arcsec=0.1, at_reading=200}");
  ASSERT_EQ(slipped.verdict, diagnose::Verdict::kNamed);
  EXPECT_EQ(slipped.causes.front().effect, "slip");
  const auto is_told_well = testing::Not(testing::AnyOf(testing::HasSubstr("left seated"), testing::HasSubstr("e-")));
  for (const diagnose::Invisible& unseen : slipped.invisible)
    EXPECT_THAT(unseen.could_bias, is_told_well) << unseen.effect;
}

}  // namespace
}  // namespace twinbench
