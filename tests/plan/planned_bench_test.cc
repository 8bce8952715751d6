#include "tests/plan/plan_claims.h"
#include "tests/support/twin_run.h"
#include "tools/twinbench/passing_run.h"
#include "tools/twinbench/plan_advice.h"
#include "twin/benches/names.h"
#include "twin/benches/registry.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/core/estimator.h"
#include "twin/report/evaluation.h"

namespace twinbench::tools {
namespace {

Patience without_end;

using diagnose::Isolability;

/// 12 stops, two set-ups, on the quick twin.
Scenario SmallRotary(const std::string& clamping) {
  return ParseScenario(
      "bench = \"rotary_4dof\"\nseed = 41\nmechanics.fidelity = \"kinematic\"\noptics.fidelity = \"closed\"\n",
      "small.toml", "",
      {"procedure.positions=12", "procedure.shifts=[0, 1]", "procedure.passes=[1, -1]",
       "procedure.clamping=" + clamping});
}

std::size_t IndexOf(const Isolability& isolability, const std::string& effect) {
  const auto found = std::ranges::find(isolability.causes, effect, &diagnose::ShownCause::effect);
  EXPECT_NE(found, isolability.causes.end()) << effect;
  return static_cast<std::size_t>(found - isolability.causes.begin());
}

bool HasRadial(const nlohmann::json& results) {
  const nlohmann::json& target = results.at("separation").at("target");
  return target.contains("dy_um") && std::ranges::all_of(target.at("u_dy_um"), [](const nlohmann::json& u) {
           return u.is_number() && std::isfinite(u.get<double>());
         });
}

/// Two re-clamped set-ups do not separate the radial errors; every addition that a plan names does,
/// on the twin with the noise of another run, and within what it says of itself.
TEST(Mendings, AreConfirmedByTheTwinEachAndEvery) {
  const Scenario scenario = SmallRotary("reclamp");
  const LookedAt own = LookAtOwn(scenario);
  EXPECT_THAT(own.planned.outlook.lost, testing::Contains("target dy"));
  EXPECT_FALSE(HasRadial(own.results));
  const std::vector<report::Mending> mendings = Mendings(scenario, own, without_end);
  ASSERT_GE(mendings.size(), 5u);
  EXPECT_EQ(mendings.front().run.name, "reseated");  // takes no more time
  EXPECT_NEAR(mendings.front().more_minutes, 0.0, 0.5);
  for (const report::Mending& mending : mendings) {
    EXPECT_NE(mending.run.name, "shift-6") << "a half turn shows the reference's rotor in opposite azimuths only";
    EXPECT_THAT(mending.mended, testing::Contains("target dy")) << mending.run.name;
    Scenario with = Altered(scenario, mending.run.sets);
    with.seed = 977;
    const Bench& bench = BenchOf(with);
    const std::vector<Reading> readings = ReadingsOfTwin(with);
    EXPECT_TRUE(HasRadial(bench.evaluate(with, readings, Estimator::kRigorous).results)) << mending.run.name;
    const nlohmann::json truth = bench.make_twin(with)->Truth();
    double chi2 = 0.0;
    int count = 0;
    for (const report::ScoredValue& v : bench.score(with, readings, truth, Estimator::kRigorous).values) {
      if (v.name.find("target.dy_um") == std::string::npos) continue;
      chi2 += (v.value - v.truth) * (v.value - v.truth) / (v.u * v.u);
      ++count;
    }
    ASSERT_EQ(count, 12) << mending.run.name;
    EXPECT_LT(chi2 / count, 4.0) << mending.run.name;  // smooth curves: about 3 independent values at worst
  }
}

/// What `check` says of the scenario that is proposed: nothing that was not lost before, and nothing of what it is proposed for.
TEST(Mendings, LoseNothingOfWhatTheyAreProposedForOnAnyBench) {
  const std::pair<const char*, std::vector<std::string>> cases[] = {
      {"turntable_shifts.toml", {"turntable_procedure.positions=12", "turntable_procedure.shifts_teeth=[0]", "turntable_procedure.tilts_arcsec=[40]"}},
      {"encoder_mountings.toml", {"encoder_procedure.stops_per_turn=12", "encoder_procedure.mounting_deg=[0, 180]"}},
      {"encoder_heads.toml", {"encoder_procedure.heads_deg=[0, 180]"}}};
  for (const auto& [file, sets] : cases) {
    const Scenario scenario = LoadScenario(test::ScenarioPath(file), sets);
    const LookedAt own = ResultsOfOwn(scenario);
    ASSERT_FALSE(own.planned.outlook.lost.empty()) << file;
    const std::vector<report::Mending> mendings = Mendings(scenario, own, without_end);
    ASSERT_FALSE(mendings.empty()) << file;
    for (const report::Mending& mending : mendings) {
      for (const std::string& lost : OutlookAtOnce(Altered(scenario, mending.run.sets)).lost) {
        EXPECT_THAT(own.planned.outlook.lost, testing::Contains(lost)) << file << " " << mending.run.name;
        EXPECT_THAT(mending.mended, testing::Not(testing::Contains(lost))) << file << " " << mending.run.name;
      }
    }
  }
}

TEST(Mendings, AreNotNeededByARunThatSeparatesAllThatCanBe) {
  const Scenario scenario = SmallRotary("reseat");
  EXPECT_TRUE(Mendings(scenario, LookAtOwn(scenario), without_end).empty());
}

/// Of a run that separates all that can be.
struct Separating {
  Scenario scenario = SmallRotary("reseat");
  std::vector<Reading> readings = ReadingsOfTwin(scenario);
  diagnose::DiagnosisRun seen = SeenBy(scenario, readings);
};

const Separating& Seen() {
  static const Separating seen;
  return seen;
}

/// Both scale the same angle of diffraction; a gain of one channel scales that channel alone.
TEST(IsolabilityOf, NamesWhatNoReadingTellsApartAndNothingThatOneDoes) {
  const Isolability& isolability = *Seen().seen.isolability;
  const std::size_t wavelength = IndexOf(isolability, "wavelength_offset");
  const std::size_t pitch = IndexOf(isolability, "grating_pitch"), gain = IndexOf(isolability, "psd_gain");
  const auto together = [&](std::size_t a, std::size_t b) {
    return std::ranges::any_of(NeverTold(isolability), [&](const std::vector<std::size_t>& set) {
      return std::ranges::count(set, a) > 0 && std::ranges::count(set, b) > 0;
    });
  };
  EXPECT_TRUE(together(wavelength, pitch));
  EXPECT_FALSE(together(wavelength, gain));
  EXPECT_TRUE(plan::MayBeBlamed(isolability, wavelength, pitch, 100.0));
}

TEST(IsolabilityOf, SizesAreThoseOfADiagnosis) {
  const diagnose::DiagnosisRun& seen = Seen().seen;
  for (const diagnose::Detectable& one : seen.diagnosis.detectable) {
    const auto cause = std::ranges::find_if(seen.isolability->causes, [&one](const diagnose::ShownCause& c) {
      return c.effect == one.effect && c.where == one.where && c.smallest.name == one.smallest.name;
    });
    if (cause != seen.isolability->causes.end()) {
      EXPECT_LE(cause->smallest.value, 1.001 * one.smallest.value) << one.effect;
    }
  }
}

TEST(IsolabilityOf, CountsAPairAsSurelyToldOnlyInEveryShape) {
  const Isolability& isolability = *Seen().seen.isolability;
  int in_another_shape = 0;
  for (const diagnose::Confusable& pair : isolability.confusable) {
    EXPECT_GE(pair.surely_told_from, pair.told_from);
    in_another_shape += pair.told_from == 0.0 ? 1 : 0;
  }
  EXPECT_GT(in_another_shape, 0);
}

TEST(IsolabilityOf, IsThatOfTheRunThatTellsLeast) {
  Isolability one, other;
  for (const char* name : {"drift", "creep", "scale"}) {
    one.causes.push_back({name, "", {}});
  }
  other.causes = {one.causes[2], one.causes[0], one.causes[1]};  // in another order
  one.confusable = {{0, 1, 2.0, 4.0}};
  other.confusable = {{1, 2, 8.0, 16.0}, {2, 0, 2.0, 2.0}};  // drift as creep, creep as scale
  KeepSurelyTold(other, one);
  EXPECT_TRUE(plan::MayBeBlamed(one, 0, 1, 15.0));
  EXPECT_FALSE(plan::MayBeBlamed(one, 0, 1, 17.0));
  EXPECT_TRUE(plan::MayBeBlamed(one, 1, 2, 1.5));
  EXPECT_FALSE(plan::MayBeBlamed(one, 2, 1, 1.5));
  EXPECT_EQ(one.confusable.front().told_from, 2.0);
}

/// Four heads at equal division lose every fourth order, and the twin says so; the four that tell most lose none.
TEST(ShiftDesignOf, TakesHeadsForShifts) {
  const Scenario scenario = LoadScenario(test::ScenarioPath("encoder_heads.toml"));
  const plan::ShiftDesign design = ShiftDesignOf(scenario).value();
  EXPECT_EQ(plan::Judged(design.positions, design.shifts).lost.front(), 4);
  const plan::ShiftSet best = plan::BestShifts(design.positions, 4);
  EXPECT_TRUE(best.lost.empty());
  const auto lost_on_twin = [](const Scenario& s) {
    const nlohmann::json results = BenchOf(s).evaluate(s, ReadingsOfTwin(s), Estimator::kRigorous).results;
    return plan::OutlookOf(results, 0, 0.0).lost;
  };
  EXPECT_FALSE(lost_on_twin(scenario).empty());
  EXPECT_TRUE(lost_on_twin(Altered(scenario, design.sets(best.shifts))).empty());
}

TEST(ShiftDesignOf, IsOfMountingsAndOfPlacesOfAHeadWhereThereAreSeveral) {
  EXPECT_FALSE(ShiftDesignOf(LoadScenario(test::ScenarioPath("encoder_comparison.toml"))).has_value());
  for (const char* file : {"encoder_mountings.toml", "hob_transmission.toml"}) {
    const Scenario scenario = LoadScenario(test::ScenarioPath(file));
    const plan::ShiftDesign design = ShiftDesignOf(scenario).value();
    ASSERT_GT(design.shifts.size(), 1u) << file;
    const Scenario other = Altered(scenario, design.sets({0, 3, 7}));
    EXPECT_EQ(ShiftDesignOf(other).value().shifts, (std::vector<int>{0, 3, 7})) << file;
  }
}

/// A gain error of one PSD axis that is just not found moves what that axis measures.
TEST(UnseenEffects, MoveResults) {
  diagnose::DiagnosisRun seen = Seen().seen;
  Isolability one = *seen.isolability;
  const diagnose::ShownCause distance = one.causes[IndexOf(one, "psd_distance")];
  one.causes = {distance};
  seen.isolability = std::make_shared<const Isolability>(one);
  const std::vector<plan::Unseen> unseen = UnseenEffects(Seen().scenario, seen, without_end);
  ASSERT_EQ(unseen.size(), 1u);
  EXPECT_EQ(unseen.front().not_known, "");
  ASSERT_FALSE(unseen.front().biases.empty());
  EXPECT_GT(unseen.front().biases.front().per_u, 0.5);
}

/// Those of an encoder come from the noise of one run, which is known to some per cent.
TEST(CheckSizes, OfAnEncoderAreWhatManyRunsOfTheTwinSay) {
  const Scenario scenario = LoadScenario(test::ScenarioPath("encoder_comparison.toml"));
  const std::vector<plan::SizeCheck> checks = plan::CheckSizes(scenario, 200);
  EXPECT_GE(checks.size(), 8u);
  for (const plan::SizeCheck& check : checks) EXPECT_NEAR(check.ratio, 1.0, 0.25) << check.cause;
}

/// A mount creeps before the first reading is taken; a grating that slips while the calibration is read is followed by the
/// autocollimator and shows nothing: neither is as small as the twin could not have it.
TEST(CheckSizes, OfCreepAndSlipAreWhatManyRunsOfTheTwinSay) {
  Scenario scenario = SmallRotary("reseat");
  RotaryOf(scenario).procedure.shifts = {0, 1, 4};
  constexpr int kRuns = 60;
  const std::vector<plan::SizeCheck> checks = plan::CheckSizes(scenario, kRuns, {"mount_creep", "slip", "psd_distance"});
  EXPECT_GE(checks.size(), 7u);
  // A standard deviation of 60 runs is known to 9 %; four times that.
  for (const plan::SizeCheck& check : checks) EXPECT_NEAR(check.ratio, 1.0, 0.36) << check.cause;
}

/// The paper's own test has no redundancy: a plan says so instead of sizes.
TEST(EffectsIn, SaysWhyNothingWouldBeFound) {
  Scenario scenario = SmallRotary("reclamp");
  RotaryOf(scenario).procedure.positions = 36;
  RotaryOf(scenario).procedure.passes = {1};
  const report::PlannedEffects effects = EffectsIn(scenario, ReadingsOfTwin(scenario), without_end);
  EXPECT_THAT(effects.refused, testing::HasSubstr("degrees of freedom"));
  EXPECT_THAT(PlannedEffectsText(effects), testing::StartsWith("No cause would be found"));
}

TEST(AdviceOf, IsInOrderOfWhatItBuysAndAProgrammeKeepsItsBudget) {
  const Scenario scenario = SmallRotary("reseat");
  const LookedAt own = LookAtOwn(scenario);
  std::vector<LookedAt> others = LookAtOthers(scenario, 2, 1.0, without_end);
  ASSERT_GT(others.size(), 6u);
  others.erase(others.begin() + 6, others.end());  // what each tells of causes takes long
  LookAtCauses(scenario, without_end, others);
  const std::vector<plan::Advice> advice = AdviceOf(own, others, "target.ez");
  ASSERT_GT(advice.size(), 5u);
  for (std::size_t k = 1; k < advice.size(); ++k) EXPECT_GE(RateOf(advice[k - 1], advice), RateOf(advice[k], advice));
  const auto again = std::ranges::find_if(advice, [](const plan::Advice& one) { return one.run.name == "again"; });
  ASSERT_EQ(again->gains.size(), 1u);
  EXPECT_NEAR(again->gains.front().ratio, std::sqrt(0.5), 1e-9);  // the same run once more
  const report::PlannedProgramme programme = ProgrammeOf(own, others, {600.0, true}, "target.ez");
  EXPECT_LE(programme.best.cost, 600.0);
  EXPECT_GT(programme.best.cost, 300.0);
  EXPECT_GT(programme.best.efficiency, 0.5);
  EXPECT_LE(programme.best.efficiency, 1.0);
  EXPECT_FALSE(programme.is_of_results_alone);
  EXPECT_GT(programme.gains.size(), 5u) << "the goal chooses the runs, which tell of other results too";
  others.back().is_looked_at_for_causes = false;
  EXPECT_TRUE(ProgrammeOf(own, others, {600.0, true}, "target.ez").is_of_results_alone);
}

}  // namespace
}  // namespace twinbench::tools
