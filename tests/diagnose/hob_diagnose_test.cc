#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/diagnose/hob_chain.h"
#include "tests/diagnose/told.h"
#include "tests/support/thresholds.h"
#include "twin/benches/registry.h"
#include "twin/core/units.h"
#include "twin/diagnose/diagnose.h"
#include "twin/diagnose/extend.h"

/// Readings of a chain with a hidden cause (tests/diagnose/hob_chain.cc), and what the diagnosis says of them.
namespace twinbench::diagnose::hob {
namespace {

using test::HiddenCause, test::HobChain;
using units::arcsec, units::deg;

/// "hob_runout", "eccentricity hob".
std::string NameOf(const std::string& effect, const std::string& where) {
  return where.empty() ? effect : effect + " " + where;
}

/// Thresholds are simulated once a design.
DiagnoseOptions Options() {
  DiagnoseOptions options;
  options.null_runs = 200;
  options.cache_folder = twinbench::test::ThresholdsFolder();
  return options;
}

HobChain Short() {
  HobChain chain;
  chain.turns = 2;
  chain.seed = 7;
  return chain;
}

DiagnosisRun DiagnosisOf(const HobChain& chain) {
  return Diagnose(ReadingsOf(chain), ScenarioOf(chain), Options());
}

std::set<std::string> NamesIn(const Diagnosis& diagnosis) {
  std::set<std::string> names;
  for (const Cause& cause : diagnosis.causes) names.insert(NameOf(cause.effect, cause.where));
  return names;
}

struct Trial {
  HiddenCause cause;
  std::set<std::string> alike = {};  // that these readings cannot tell from it
  bool interferometer = false;
};

void PrintTo(const Trial& trial, std::ostream* out) {
  *out << NameOf(trial.cause.name, trial.cause.where) << (trial.interferometer ? ", watched" : "");
}

class HiddenHobCause : public ::testing::TestWithParam<Trial> {};

TEST_P(HiddenHobCause, IsNamedOrTiedWithWhatLooksTheSame) {
  const Trial& trial = GetParam();
  HobChain chain = Short();
  chain.interferometer = trial.interferometer;
  chain.hidden = {trial.cause};
  const DiagnosisRun run = DiagnosisOf(chain);
  const std::string own = NameOf(trial.cause.name, trial.cause.where);
  const std::set<std::string> names = NamesIn(run.diagnosis);
  SCOPED_TRACE(test::Told(run));
  EXPECT_TRUE(names.contains(own));
  for (const std::string& name : names) EXPECT_TRUE(name == own || trial.alike.contains(name)) << name;
  EXPECT_EQ(run.diagnosis.verdict, names.size() > 1 ? Verdict::kTie : Verdict::kNamed);
  if (own == "hob_runout" && names.size() > 1) {  // what splits a tie
    EXPECT_NE(run.diagnosis.causes[0].next_measurement.find("interferometer"), std::string::npos);
  }
  for (const Cause& cause : run.diagnosis.causes) {
    if (NameOf(cause.effect, cause.where) != own) continue;
    for (const ParameterEstimate& p : cause.parameters) {
      double error = p.value - trial.cause.value.at(p.name);
      if (p.name == "phase") error = std::remainder(error, 2.0 * units::kPi);
      // Whole numbers have no uncertainty.
      EXPECT_LE(std::abs(error), std::max(3.0 * p.u, 1e-12)) << p.name;
    }
  }
}

const std::set<std::string> kBehind = {"backlash", "latency", "hysteresis"};

// Signatures of 20 to 60 times the noise: some tenths of an arcsecond at the table.
INSTANTIATE_TEST_SUITE_P(
    Causes, HiddenHobCause,
    ::testing::Values(
        Trial{{"eccentricity", "table", {{"amplitude", 0.1 * arcsec}, {"phase", 1.0}}}},
        Trial{{"eccentricity", "hob", {{"amplitude", 2.0 * arcsec}, {"phase", 5.0}}}, {"hob_runout"}},
        Trial{{"eccentricity", "hob", {{"amplitude", 2.0 * arcsec}, {"phase", 5.0}}}, {}, true},
        Trial{{"ellipticity", "table", {{"amplitude", 1.5 * arcsec}, {"phase", 2.0}}}},
        Trial{{"ellipticity", "hob", {{"amplitude", 2.0 * arcsec}, {"phase", 0.3}}}, {"gear_mesh"}},
        Trial{{"periodic", "table", {{"order", 7.0}, {"amplitude", 0.1 * arcsec}, {"phase", 4.0}}}},
        Trial{{"periodic", "hob", {{"order", 4.0}, {"amplitude", 3.0 * arcsec}, {"phase", 4.0}}}},
        Trial{{"signal_offset", "", {{"offset_sin", 0.1}, {"offset_cos", -0.05}}}},
        Trial{{"amplitude_mismatch", "", {{"ratio", 0.2}}}}, Trial{{"quadrature_error", "", {{"angle", 0.2}}}},
        Trial{{"hob_runout", "", {{"amplitude", 0.1 * arcsec}, {"phase", 6.0}}}, {"eccentricity hob"}},
        Trial{{"hob_runout", "", {{"amplitude", 0.1 * arcsec}, {"phase", 6.0}}}, {}, true},
        Trial{{"worm", "", {{"amplitude", 0.1 * arcsec}, {"phase", 2.5}}}},
        Trial{{"gear_mesh", "", {{"amplitude", 0.1 * arcsec}, {"phase", 2.5}}}, {"ellipticity hob"}},
        Trial{{"backlash", "", {{"width", 0.2 * arcsec}}}, kBehind},
        Trial{{"latency", "", {{"delay", 2e-6}}}, kBehind}, Trial{{"latency", "", {{"delay", 2e-6}}}, {}, true},
        Trial{{"hysteresis", "", {{"lag", 1.0 * arcsec}, {"settles_over", 40.0 * deg}}}},
        Trial{{"drift", "", {{"rate", 10.0 * arcsec / units::hour}, {"curvature", 0.5}}}},
        Trial{{"slip", "table", {{"step", 72.0 * arcsec}, {"at_reading", 2000.0}}}, {"slip hob"}},
        Trial{{"slip", "hob", {{"step", 5.0 * arcsec}, {"at_reading", 4000.0}}}, {"slip table"}},
        Trial{{"tone", "", {{"amplitude", 0.1 * arcsec}, {"frequency", 0.3}, {"phase", 1.0}}}},
        Trial{{"outliers", "", {{"fraction", 0.003}, {"size", 10.0 * arcsec}}}}));

TEST(HobDiagnosis, TellsADelayFromAGapAtTwoSpeeds) {
  HobChain chain = Short();
  chain.hob_speeds_rev_min = {50.0, 25.0};
  chain.hidden = {{"latency", "", {{"delay", 2e-6}}}};
  EXPECT_EQ(NamesIn(DiagnosisOf(chain).diagnosis), (std::set<std::string>{"latency"}));
  chain.hidden = {{"backlash", "", {{"width", 0.2 * arcsec}}}};
  EXPECT_FALSE(NamesIn(DiagnosisOf(chain).diagnosis).contains("latency"));
}

TEST(HobDiagnosis, FindsStructureWithoutANameAsUnknown) {
  const std::vector<std::pair<HiddenCause, std::string>> unlisted = {
      {{"unlisted_order", "", {{"order", 7.0}, {"amplitude", 0.1 * arcsec}}},
       "harmonic of order 7 synchronous with table"},
      {{"unlisted_order", "", {{"order", 5.4}, {"amplitude", 0.1 * arcsec}}}, "line at 5.4"},
      {{"unlisted_direction", "", {{"order", 3.0}, {"amplitude", 0.1 * arcsec}}}, "direction times order 3"}};
  for (const auto& [cause, signature] : unlisted) {
    HobChain chain = Short();
    chain.hidden = {cause};
    const DiagnosisRun run = DiagnosisOf(chain);
    EXPECT_EQ(run.diagnosis.verdict, Verdict::kUnknown) << test::Told(run);
    EXPECT_NE(run.diagnosis.unknown.signature.find(signature), std::string::npos)
        << run.diagnosis.unknown.signature;
  }
}

TEST(HobDiagnosis, ListsWhatOppositeHeadsCannotSeeWithWhatItWouldBias) {
  HobChain chain = Short();
  chain.heads_deg = {0.0, 180.0};
  chain.hidden = {{"ellipticity", "table", {{"amplitude", 5.0 * arcsec}, {"phase", 1.0}}}};
  const Diagnosis diagnosis = DiagnosisOf(chain).diagnosis;
  EXPECT_EQ(diagnosis.verdict, Verdict::kNone);  // it goes into order 2 of the transmission
  const auto found = std::ranges::find_if(
      diagnosis.invisible, [](const Invisible& i) { return i.effect == "ellipticity" && i.where == "table"; });
  ASSERT_NE(found, diagnosis.invisible.end());
  EXPECT_NE(found->could_bias.find("transmission of order 2"), std::string::npos) << found->could_bias;
  for (const Invisible& i : diagnosis.invisible) EXPECT_FALSE(i.effect == "eccentricity" && i.where == "table");
}

TEST(HobDiagnosis, SeesTheRingOfOneHeadAgainstTheInterferometer) {
  HobChain chain = Short();
  chain.heads_deg = {0.0};
  const Diagnosis blind = DiagnosisOf(chain).diagnosis;
  EXPECT_TRUE(std::ranges::any_of(
      blind.invisible, [](const Invisible& i) { return i.effect == "eccentricity" && i.where == "table"; }));
  chain.interferometer = true;
  chain.hidden = {{"eccentricity", "table", {{"amplitude", 0.2 * arcsec}, {"phase", 1.0}}}};
  EXPECT_EQ(NamesIn(DiagnosisOf(chain).diagnosis), (std::set<std::string>{"eccentricity table"}));
}

TEST(HobDiagnosis, ExtendsTheScenarioSoThatNothingIsLeft) {
  HobChain chain = Short();
  chain.hidden = {{"worm", "", {{"amplitude", 1.0 * arcsec}, {"phase", 2.0}}},
                  {"unlisted_order", "", {{"order", 7.0}, {"amplitude", 0.3 * arcsec}}}};
  const std::vector<Reading> readings = ReadingsOf(chain);
  const Scenario scenario = ScenarioOf(chain);
  const DiagnosisRun run = Diagnose(readings, scenario, Options());
  const std::string toml = ExtendedToml(scenario, run, "a test");
  const Scenario extended = ParseScenario(toml, "extended.toml", ".");
  ASSERT_EQ(extended.effects.size(), 2U);
  EXPECT_EQ(extended.effects[0].name, "worm");
  EXPECT_EQ(extended.effects[1].signal, "harmonic");
  EXPECT_EQ(extended.effects[1].where, "transmission");
  EXPECT_EQ(extended.effects[1].parameters.at("order"), 7.0);
  EXPECT_NEAR(extended.effects[1].parameters.at("amplitude"), 0.3 * arcsec, 0.03 * arcsec);
  EXPECT_TRUE(extended.empiricals.empty());
  EXPECT_EQ(Diagnose(readings, extended, Options()).diagnosis.verdict, Verdict::kNone);
}

TEST(HobDiagnosis, TabulatesTheLinesOfTheChain) {
  HobChain chain = Short();
  chain.hidden = {{"worm", "", {{"amplitude", 1.0 * arcsec}, {"phase", 2.0}}},
                  {"hob_runout", "", {{"amplitude", 2.0 * arcsec}, {"phase", 1.0}}}};
  const Diagnosis diagnosis = DiagnosisOf(chain).diagnosis;
  std::map<int, Harmonic> by_order;
  for (const Harmonic& h : diagnosis.harmonics) by_order[h.order] = h;
  for (const int order : {1, 2, 12, 22, 44, 90}) ASSERT_TRUE(by_order.contains(order)) << order;
  // u = 0.06 arcsec / sqrt(1920 / 2) = 0.002 arcsec.
  EXPECT_NEAR(by_order[22].amplitude_rad / arcsec, 2.0, 0.01);
  EXPECT_NEAR(by_order[90].amplitude_rad / arcsec, 1.0, 0.01);
  EXPECT_NE(by_order[90].meaning.find("worm"), std::string::npos);
}

}  // namespace
}  // namespace twinbench::diagnose::hob
