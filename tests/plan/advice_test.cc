#include <stdexcept>

#include "tests/uncertainty/bench_budget.h"
#include "twin/plan/advice.h"
#include "twin/plan/harmonics.h"
#include "twin/plan/mended.h"
#include "twin/plan/next_run.h"
#include "twin/plan/outlook.h"
#include "twin/plan/unseen.h"
#include "twin/report/not_separable_text.h"
#include "twin/report/plan_advice.h"

namespace twinbench::plan {
namespace {

const nlohmann::json kBefore = nlohmann::json::parse(
    R"({"target": {"ez_arcsec": [0, 0], "u_ez_arcsec": [0.3, 0.4], "dy_um": [0], "u_dy_um": [1.0]}})");
const nlohmann::json kMore =
    nlohmann::json::parse(R"({"target": {"ez_arcsec": [0, 0], "u_ez_arcsec": [0.3, 0.4]}})");

TEST(GainsOf, AddsInverseVariancesPlaceByPlaceOnlyOfWhatIsWanted) {
  const std::vector<Gain> gains = GainsOf(kBefore, kMore, "");
  ASSERT_EQ(gains.size(), 1u);  // dy is not determined again
  EXPECT_EQ(gains.front().name, "target.ez_arcsec");
  EXPECT_NEAR(gains.front().ratio, std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(MeanGain_bit(gains), 0.5, 1e-12);
  EXPECT_EQ(GainsOf(kBefore, kBefore, "target.dy").size(), 1u);
  EXPECT_EQ(GainsOf(kBefore, kBefore, "dy_um").size(), 1u);
  EXPECT_TRUE(GainsOf(kBefore, kBefore, "get.dy").empty());
}

TEST(GainsOf, AddsThePrecisionOfAWholeProgrammeOnlyOfWhatIsWanted) {
  const std::vector<Gain> gains = GainsOf(kBefore, {&kMore, &kBefore, &kMore}, "");
  ASSERT_EQ(gains.size(), 2u);
  EXPECT_NEAR(gains[0].ratio, std::sqrt(0.5), 1e-12) << "dy is determined by one of the three";
  EXPECT_NEAR(gains[1].ratio, 0.5, 1e-12) << "four runs";
}

/// Of u = 0.5 the standard has 0.4: of three further runs the other 0.3 grows half as large, and 0.4 stays.
TEST(GainsOf, WhatAllRunsShareIsNoMeanOfThem) {
  const auto run = nlohmann::json::parse(R"({"ez_arcsec": [0], "u_ez_arcsec": [0.5], "u_parts": {"noise": 0.36, "standard": 0.64}})");
  const std::vector<Gain> gains = GainsOf(run, {&run, &run, &run}, "");
  ASSERT_EQ(gains.size(), 1u);
  EXPECT_NEAR(gains.front().ratio, std::hypot(0.15, 0.4) / 0.5, 1e-12);
  EXPECT_NEAR(gains.front().precision_before, 0.25 / 0.09, 1e-12);
  EXPECT_NEAR(gains.front().precision, 3.0 * 0.25 / 0.09, 1e-12);
  const auto shared = nlohmann::json::parse(R"({"ez_arcsec": [0], "u_ez_arcsec": [0.5], "u_parts": {"standard": 1.0}})");
  EXPECT_EQ(GainsOf(shared, {&shared, &shared}, "").front().ratio, 1.0);
}

/// A run without the standard's error is as good alone as with one that has it.
TEST(GainsOf, AreNoneBelowThatOfTheBestRun) {
  const auto with = nlohmann::json::parse(R"({"ez_arcsec": [0], "u_ez_arcsec": [0.5], "u_parts": {"noise": 0.01, "model": 0.99}})");
  const auto without = nlohmann::json::parse(R"({"ez_arcsec": [0], "u_ez_arcsec": [0.05], "u_parts": {"noise": 1.0}})");
  EXPECT_LE(GainsOf(with, without, "").front().ratio, 0.1 + 1e-12);
}

TEST(GainsOf, TheNextMountingHasAnOffsetOfItsOwn) {
  const auto run = nlohmann::json::parse(R"({"setups": [{"offset_um": 1.0, "u_offset_um": 0.1}], "dy_um": 0.0, "u_dy_um": 1.0})");
  const std::vector<Gain> gains = GainsOf(run, run, "");
  ASSERT_EQ(gains.size(), 1u);
  EXPECT_EQ(gains.front().name, "dy_um");
}

TEST(OutlookOf, AListByRankIsNoResultOfItsOwn) {
  const auto results = nlohmann::json::parse(R"({"errors": {"scale": {"value_um_m": 2.0, "u_um_m": 0.1}},
      "ranked": [{"error": "scale", "value": 2.0, "u": 0.1}, {"error": "squareness", "value": 5.0, "u": 3.0}]})");
  const Outlook outlook = OutlookOf(results, 2, 10.0);
  ASSERT_EQ(outlook.results.size(), 1u);
  EXPECT_EQ(outlook.results.front().name, "errors.scale_um_m");
}

TEST(Rank, PutsWhatBuysMostPerMinuteFirst) {
  std::vector<Advice> advice(2);
  advice[0].of_causes_bit = 10.0;
  advice[0].minutes = 100.0;
  advice[1].of_causes_bit = 4.0;
  advice[1].minutes = 10.0;
  Rank(advice);
  EXPECT_EQ(advice.front().minutes, 10.0);
}

TEST(Rank, WhatWasNotComputedPutsNobodyBehind) {
  std::vector<Advice> advice(2);
  advice[0].of_results_bit = 1.0;
  advice[0].of_causes_bit = 30.0;
  advice[1].of_results_bit = 2.0;
  advice[1].causes_unknown = "not computed";
  for (Advice& one : advice) one.minutes = 10.0;
  Rank(advice);
  EXPECT_EQ(advice.front().of_results_bit, 2.0) << "by results alone, which are known of both";
  const std::string text = report::PlanAdviceText(advice);
  EXPECT_THAT(text, testing::HasSubstr("not computed"));
  EXPECT_THAT(text, testing::Not(testing::HasSubstr(" 0.0 "))) << text;
  EXPECT_TRUE(report::PlanAdviceJson(advice)[0].at("of_causes_bit").is_null());
}

TEST(MinutesText, IsNotNoneOfAShortRun) {
  EXPECT_EQ(report::MinutesText(10.0 / 60.0), "0.17");
  EXPECT_EQ(report::MinutesText(36.4), "36");
}

TEST(NotSeparableText, IsOneParagraphOfOrdersThatAreLostAlike) {
  const std::string text = report::NotSeparableText(
      {"both tables, order 1: seen alike", "both tables, order 2: seen alike", "both tables, order 9: seen alike", "target dx: no detector", "order 3: the sum", "order 4: folded"}, 100);
  EXPECT_EQ(text,
            "Not separable: both tables, orders 1-2, 9: seen alike\nNot separable: target dx: no detector\n"
            "Not separable: order 3: the sum\nNot separable: order 4: folded\n");
}

TEST(BiasesOf, AreChangesByTheirOwnUncertaintyTheMostFirstAndAPhaseComesRound) {
  const auto without = nlohmann::json::parse(
      R"({"ez_arcsec": [1.0, 2.0], "u_ez_arcsec": [0.5, 0.5], "dy_um": [0.0, 0.0], "u_dy_um": [0.1, 0.1]})");
  const auto with = nlohmann::json::parse(
      R"({"ez_arcsec": [4.0, 6.0], "u_ez_arcsec": [0.5, 0.5], "dy_um": [0.1, -0.1], "u_dy_um": [0.1, 0.1]})");
  const std::vector<Bias> biases = BiasesOf(without, with);
  ASSERT_EQ(biases.size(), 2u);
  EXPECT_EQ(biases[0].name, "ez_arcsec");
  EXPECT_NEAR(biases[0].rms, std::sqrt(12.5), 1e-12);
  EXPECT_NEAR(biases[0].per_u, std::sqrt(12.5) / 0.5, 1e-12);
  EXPECT_NEAR(biases[1].per_u, 1.0, 1e-12);
  const auto before = nlohmann::json::parse(R"({"phase_deg": 179.0, "u_phase_deg": 1.0})");
  const auto after = nlohmann::json::parse(R"({"phase_deg": -179.0, "u_phase_deg": 1.0})");
  EXPECT_NEAR(BiasesOf(before, after).front().rms, 2.0, 1e-12);
}

using testing::ElementsAre, testing::IsEmpty;

TEST(HarmonicsOf, ReadsTermsColumnsAndTables) {
  const auto results = nlohmann::json::parse(R"({
    "model": {"terms": [{"order": 1, "amplitude_arcsec": 3.0, "u_amplitude_arcsec": 0.2},
                        {"order": 5, "amplitude_arcsec": 1.0, "u_amplitude_arcsec": 0.3}]},
    "encoder": {"order": [1, 2], "amplitude_arcsec": [1.0, 2.0], "u_amplitude_arcsec": [0.5, null]},
    "target": {"ez_arcsec": [1.0], "u_ez_arcsec": [0.1], "u_harmonics": {"order": [1, 2], "ez_arcsec": [0.7, 0.8]}},
    "against": [{"order": 1, "u_amplitude_difference_arcsec": 0.1}]})");
  const std::vector<HarmonicCertainty> found = HarmonicsOf(results);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].name, "encoder_arcsec");
  EXPECT_THAT(found[0].u, ElementsAre(0.5, testing::IsNan()));
  EXPECT_EQ(found[1].name, "model.terms_arcsec");
  EXPECT_THAT(found[1].orders, ElementsAre(1, 5));
  EXPECT_THAT(found[1].u, ElementsAre(0.2, 0.3));
  EXPECT_EQ(found[2].name, "target.ez_arcsec");
  EXPECT_THAT(found[2].u, ElementsAre(0.7, 0.8));
}

TEST(HarmonicsOf, HasNoneOfResultsThatWereTakenBack) {
  const auto results = nlohmann::json::parse(R"({
    "encoder": {"order": [null, null], "u_amplitude_arcsec": [null, null]},
    "target": {"u_harmonics": {"order": [null, null], "ez_arcsec": [null, null]}}})");
  EXPECT_TRUE(HarmonicsOf(results).empty());
}

TEST(MeanOf, AveragesVariancesOfRunsThatStateThem) {
  Outlook a, b;
  a.results = {{"ez_arcsec", 2, 3.0, 3.0}, {"dy_um", 1, 1.0, 1.0}};
  b.results = {{"ez_arcsec", 2, 4.0, 4.0}};
  a.harmonics = {{"ez_arcsec", {1}, {1.0}}};
  b.harmonics = {{"ez_arcsec", {1}, {7.0}}};
  const Outlook mean = MeanOf({a, b});
  EXPECT_NEAR(mean.results[0].rms_u, std::sqrt(12.5), 1e-12);
  EXPECT_NEAR(mean.results[1].rms_u, 1.0, 1e-12);
  EXPECT_NEAR(mean.harmonics[0].u[0], 5.0, 1e-12);
  EXPECT_NEAR(LargestDifference(a, b), 1.0 / 3.0, 1e-12);
}

TEST(MeanOf, IsKnownByTheScatterOfTheRunsButForPhases) {
  std::vector<Outlook> runs;
  for (const double u : {0.9, 1.1, 0.9, 1.1}) {
    Outlook& run = runs.emplace_back();
    run.results = {{"ez_arcsec", 1, u, u}, {"terms[].phase_deg", 1, u > 1.0 ? 50.0 : 1.0, 50.0}};
  }
  // Standard deviation 0.1 sqrt(4 / 3), of the mean of four half of it; the mean is 1.
  EXPECT_NEAR(UncertaintyOfMean(runs), 0.05 * std::sqrt(4.0 / 3.0), 1e-12);
  EXPECT_NEAR(LargestDifference(runs[0], runs[1]), 0.2 / 0.9, 1e-12);
}

Outlook Losing(std::vector<std::string> lost) {
  Outlook outlook;
  outlook.lost = std::move(lost);
  outlook.separates = true;
  return outlook;
}

/// Half a turn leaves every second order of what one mounting does not separate at all, and says so in other words.
TEST(Mended, IsNothingOfWhichAPartStaysUnderAnotherName) {
  const Outlook own = Losing({"turntable and multi-tooth table"}), good = Losing({}),
                half_turn = Losing({"order 2", "order 4"});
  EXPECT_THAT(WhollyMendedBy(own, half_turn, good), IsEmpty());
  EXPECT_THAT(MendedInWords(own, half_turn),
              ElementsAre("turntable and multi-tooth table but for order 2; order 4"));
  EXPECT_THAT(WhollyMendedBy(own, Losing({}), good), ElementsAre("turntable and multi-tooth table"));
}

TEST(Mended, IsWhatIsWholeBesideAPartOfSomethingElseAndOrder1WhereOrder12Stays) {
  const Outlook own = Losing({"target dy", "reference dx"}), good = Losing({});
  EXPECT_THAT(WhollyMendedBy(own, Losing({"target dy orders 2, 4"}), good), ElementsAre("reference dx"));
  EXPECT_THAT(WhollyMendedBy(own, Losing({"target dy order 0"}), Losing({"target dy order 0"})),
              ElementsAre("target dy", "reference dx"))
      << "no shifts tell order 0";
  EXPECT_THAT(MendedInWords(own, Losing({"target dy order 0"})),
              ElementsAre("target dy but for order 0", "reference dx"));
  const Outlook one_and_twelve = Losing({"device, order 1", "device, order 12"});
  EXPECT_THAT(WhollyMendedBy(one_and_twelve, Losing({"device, order 12"}), good), ElementsAre("device, order 1"));
}

/// One of the runs that a bench offers next, made on the twin beside the scenario's own.
struct Beside {
  std::vector<Reading> own, next;
  Scenario scenario, of_next;
};

Beside RunsOf(const std::string& file, std::vector<std::string> sets, const std::string& name) {
  Beside runs;
  runs.scenario = LoadScenario(test::ScenarioPath(file), sets);
  const std::vector<NextRun> offered = BenchOf(runs.scenario).next_runs(runs.scenario);
  const auto run = std::ranges::find(offered, name, &NextRun::name);
  if (run == offered.end()) throw std::runtime_error("no run " + name);
  sets.insert(sets.end(), run->sets.begin(), run->sets.end());
  runs.of_next = LoadScenario(test::ScenarioPath(file), sets);
  runs.own = test::ReadingsOf(runs.scenario);
  runs.next = test::ReadingsOf(runs.of_next);
  return runs;
}

double MeanVariance(const Scenario& scenario, const std::vector<Reading>& readings, const std::string& kind) {
  double sum = 0.0;
  int count = 0;
  for (const uncertainty::Quantity& q : test::QuantitiesFrom(scenario, readings)) {
    if (uncertainty::KindOf(q.name) != kind) continue;
    sum += q.u * q.u;
    ++count;
  }
  return sum / count;
}

/// Half of the uncertainty in the time of one run, where a second run would leave 0.7 of it.
TEST(NextRuns, OfASweepReadItAsOftenAsAReadingTakes) {
  const Beside runs = RunsOf("encoder_comparison.toml", {"encoder_procedure.kind=sweep"}, "denser");
  EXPECT_EQ(runs.next.size(), 4 * runs.own.size()) << "every 0.02 s, not every 0.08 s";
  EXPECT_NEAR(ToSeconds(runs.next.back().time), ToSeconds(runs.own.back().time), 0.1);
  const std::string kind = "device.ez_arcsec";
  EXPECT_NEAR(MeanVariance(runs.of_next, runs.next, kind) / MeanVariance(runs.scenario, runs.own, kind), 0.25,
              0.03);
}

/// 18000 lines, of which every third may be kept where the computer looks each 2 s, every fifteenth where it does
/// each 10 s.
TEST(NextRuns, OfATransmissionLeaveTheCounterTimeToBeEmptied) {
  for (const auto& [poll, times] : {std::pair{"2.0", 6000.0 / 720.0}, std::pair{"10.0", 1200.0 / 720.0}}) {
    const Beside runs = RunsOf(
        "hob_transmission.toml",
        {"mechanics.fidelity=kinematic", "hob_procedure.turns=1", std::string("hob_procedure.poll_s=") + poll},
        "denser");
    const double count = static_cast<double>(runs.next.size());
    EXPECT_NEAR(count / static_cast<double>(runs.own.size()), times, 0.03 * times) << poll;
    EXPECT_TRUE(std::ranges::all_of(runs.next, [](const Reading& r) { return r.status == ReadingStatus::kOk; }));
  }
}

}  // namespace
}  // namespace twinbench::plan
