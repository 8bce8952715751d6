#include "twin/diagnose/extend.h"

#include "tests/diagnose/found_causes.h"
#include "tests/support/kept_text.h"
#include "tests/support/small_scenario.h"
#include "tests/support/twin_run.h"
#include "twin/diagnose/aliased_orders.h"

namespace twinbench::diagnose {
namespace {

using testing::HasSubstr;
using twinbench::test::RunTwin, twinbench::test::SmallNoiseFree;

/// A diagnosis that found a gain on PSD A x.
DiagnosisRun FoundGain(double gain_error) {
  Cause cause = test::FoundPsdGain(gain_error);
  cause.log_evidence = 44.0;
  DiagnosisRun run = test::NamedRun(cause);
  Accepted accepted;
  accepted.family.kind = Kind::kNamed;
  accepted.family.effect = cause.effect;
  accepted.family.where = cause.where;
  run.accepted = {accepted};
  return run;
}

/// One that found structure on PSD B y alone, at `readings` of a run.
DiagnosisRun FoundStructure(const std::vector<int>& readings, double size_m) {
  DiagnosisRun run;
  run.diagnosis.verdict = Verdict::kUnknown;
  run.run.bench = kRotaryBench;
  run.run.channels = {kChannelNames.begin(), kChannelNames.end()};
  run.run.schedule.reading = readings;
  Accepted accepted;
  accepted.family.kind = Kind::kUnknown;
  accepted.family.amplitudes = {{"size", "um", 1e-6, 1e-6, -1.0, 1.0}};
  run.diagnosis.unknown.signature = "a bump on psd_b_y";
  accepted.amplitudes = Eigen::VectorXd::Constant(1, size_m);
  accepted.columns = Eigen::MatrixXd::Zero(kChannels * static_cast<Eigen::Index>(readings.size()), 1);
  for (std::size_t i = 0; i < readings.size(); ++i)
    accepted.columns(kChannels * static_cast<Eigen::Index>(i) + 3, 0) = 1.0;
  run.accepted = {accepted};
  return run;
}

Scenario Reload(const std::string& toml) {
  return ParseScenario(toml, "extended.toml", "/elsewhere");
}

TEST(Extend, AddsTheEffectWithValueUncertaintyEvidenceAndProvenance) {
  const Scenario extended = Reload(ExtendedToml(SmallNoiseFree(), FoundGain(0.0031), "run 7 of May"));
  ASSERT_EQ(extended.effects.size(), 1u);
  const EffectSettings& effect = extended.effects[0];
  EXPECT_EQ(effect.name, "psd_gain");
  EXPECT_EQ(effect.where, "psd_a_x");
  EXPECT_EQ(effect.parameters.at("gain_error"), 0.0031);
  EXPECT_EQ(effect.finding.u.at("gain_error"), 2e-4);
  EXPECT_EQ(effect.finding.log_evidence, 44.0);
  EXPECT_EQ(effect.finding.probability, 0.97);
  EXPECT_EQ(effect.finding.provenance, "run 7 of May");
}

TEST(Extend, TakesOfATieTheMemberThatTheSearchTookInAndACauseWithoutASignatureToo) {
  DiagnosisRun run = FoundGain(0.001);
  Cause rival = run.diagnosis.causes[0];
  rival.effect = "stray_light";
  rival.where = "psd_a";
  rival.parameters.clear();
  run.diagnosis.causes.insert(run.diagnosis.causes.begin(), rival);
  run.diagnosis.verdict = Verdict::kTie;
  const Scenario extended = Extend(SmallNoiseFree(), run, "");
  ASSERT_EQ(extended.effects.size(), 1u);
  EXPECT_EQ(extended.effects[0].name, "psd_gain");
  run = FoundGain(0.001);
  run.accepted.clear();  // as for swapped channels or outliers, which are no columns
  EXPECT_EQ(Extend(SmallNoiseFree(), run, "").effects.size(), 1u);
}

TEST(Extend, LeavesOutWhatHasNoFittedSizeAndWhatPredictsNothing) {
  DiagnosisRun run = FoundGain(0.001);
  run.diagnosis.gain.positive = false;
  EXPECT_THAT(ExtendedToml(SmallNoiseFree(), run, ""), HasSubstr("# nothing was added"));
  Cause decided;
  decided.effect = "reclamp_frame";  // by evidence alone; there is no size of it
  run.diagnosis.causes.push_back(decided);
  EXPECT_THAT(ExtendedToml(SmallNoiseFree(), run, ""), HasSubstr("# added: effect reclamp_frame\n\n"));
  run.diagnosis.gain.positive = true;
  EXPECT_THAT(ExtendedToml(SmallNoiseFree(), run, ""), HasSubstr("# added: effect psd_gain at psd_a_x\n# added: effect reclamp_frame\n"));
  for (Cause& cause : run.diagnosis.causes) cause.parameters.clear();
  EXPECT_THAT(ExtendedToml(SmallNoiseFree(), run, ""), testing::Not(HasSubstr("psd_gain at")));
}

TEST(AliasesOf, AreOrdersThatEvenStopsDoNotTellApart) {
  constexpr int kStops = 72;
  Cause cause{.effect = "periodic", .rho = 50.0, .parameters = {{"order", "1", 1.0, 13.0}}};
  LinearRun run;
  run.bench = kEncoderBench;
  const auto start_second_turn_at = [&run](double stop) {
    Eigen::VectorXd turns = Eigen::VectorXd::LinSpaced(2 * kStops, 0.01, 2.01 - 1.0 / kStops);
    turns.tail(kStops).array() += stop / kStops;
    run.schedule.reference_rad = 2.0 * M_PI * turns;
  };
  start_second_turn_at(0.0);
  EXPECT_THAT(AliasesOf(cause, run), testing::AllOf(testing::Contains(59), testing::Contains(85), testing::Contains(131), testing::SizeIs(27)));
  Diagnosis told{.verdict = Verdict::kNamed, .causes = {cause}};
  told.gain.another_run = 1.0;
  TellAliases(run, told);
  EXPECT_TRUE(std::isnan(told.gain.another_run));
  EXPECT_EQ(told.verdict, Verdict::kTie);
  EXPECT_KEPT(told.causes[0].indistinguishable_from.at(0).where + "; " + told.causes[0].next_measurement + "; " + told.notes.at(0));
  cause.parameters[0].value = 59.0;
  EXPECT_THAT(AliasesOf(cause, run), testing::Contains(13));
  start_second_turn_at(M_1_PI);  // another start angle; not of a grid that is finer by a whole number
  EXPECT_THAT(AliasesOf(cause, run), testing::IsEmpty());
  cause.effect = "eccentricity";  // has no order
  EXPECT_THAT(AliasesOf(cause, run), testing::IsEmpty());
}

TEST(Extend, KeepsTheEffectsThatTheScenarioHadAndMovesAnImpossibleValueToItsBound) {
  const Scenario once = Extend(SmallNoiseFree(), FoundGain(0.001), "first");
  const Scenario twice = Extend(once, FoundGain(0.002), "second");
  ASSERT_EQ(twice.effects.size(), 2u);
  EXPECT_EQ(twice.effects[0].finding.provenance, "first");
  EXPECT_EQ(Extend(SmallNoiseFree(), FoundGain(3.0), "").effects.at(0).parameters.at("gain_error"), 0.5);
}

TEST(Extend, OfACleanRunIsTheScenarioItself) {
  const std::string toml = ExtendedToml(SmallNoiseFree(), DiagnosisRun{}, "a run");
  EXPECT_THAT(toml, HasSubstr("nothing was added"));
  EXPECT_EQ(WriteScenario(Reload(toml)), WriteScenario(SmallNoiseFree()));
}

TEST(Extend, TabulatesStructureWithoutANameAndTheTwinShowsIt) {
  const std::string toml = ExtendedToml(SmallNoiseFree(), FoundStructure({40, 41, 70}, 0.8e-6), "r\nx");
  EXPECT_THAT(toml, HasSubstr("# r x\n# added: empirical signal on psd_b_y: a bump on psd_b_y\n"));
  const Scenario extended = Reload(toml);
  ASSERT_EQ(extended.empiricals.size(), 1u);
  const auto plain = RunTwin(SmallNoiseFree()).readings, with = RunTwin(extended).readings;
  for (std::size_t k = 0; k < plain.size(); ++k) {
    const int reading = plain[k].reading;
    const double expected_m = reading == 40 || reading == 41 || reading == 70 ? 0.8e-6 : 0.0;
    // 2000 V/m; values are rounded to 10 pm.
    EXPECT_NEAR(with[k].mean_V[3] - plain[k].mean_V[3], 2000.0 * expected_m, 2000.0 * 1e-11);
    EXPECT_EQ(with[k].mean_V[0], plain[k].mean_V[0]);
  }
}

}  // namespace
}  // namespace twinbench::diagnose
