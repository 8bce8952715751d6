#include "tests/core/input_error.h"
#include "tests/core/refusals.h"
#include "twin/core/scenario_uncertainty.h"
#include "twin/core/schema_table.h"
#include "twin/core/toml_reader.h"

/// [[effect]] blocks named "signal": structure that no cause of the catalogue has.
namespace twinbench {
namespace {

using testing::DoubleEq, testing::ElementsAre, testing::FieldsAre;

Scenario Parse(const std::string& bench, const std::string& block) {
  return ParseScenario("bench = \"" + bench + "\"\n[[effect]]\nname = \"signal\"\n" + block, "s.toml", ".");
}

TEST(ScenarioSignal, IsReadInSIWithAnAmplitudeOfItsBenchsKind) {
  const EffectSettings signal = Parse("rotary_4dof",
                                      "point = \"psd_b_y\"\nsignal = \"harmonic\"\nby = \"target\"\n"
                                      "times = \"temperature\"\norder = 3\namplitude_um = 1.5\nphase_deg = 40\n"
                                      "about_K = 0.2\nper_K = 0.5\n")
                                    .effects.at(0);
  EXPECT_EQ(signal.where, "psd_b_y");
  EXPECT_EQ(signal.signal, "harmonic");
  EXPECT_EQ(signal.by, "target");
  EXPECT_EQ(signal.times, "temperature");
  EXPECT_DOUBLE_EQ(signal.parameters.at("amplitude"), 1.5 * units::um);
  EXPECT_DOUBLE_EQ(signal.parameters.at("phase"), 40.0 * units::deg);
  EXPECT_EQ(signal.parameters.at("per"), 0.5);
  const std::string constant =
      "point = \"angle\"\nsignal = \"constant\"\ntimes = \"velocity\"\namplitude_arcsec = 2\n";
  const EffectSettings of_angles = Parse("encoder_comparison", constant).effects.at(0);
  EXPECT_DOUBLE_EQ(of_angles.parameters.at("amplitude"), 2.0 * units::arcsec);
  EXPECT_DOUBLE_EQ(of_angles.parameters.at("per"), 1.0 * units::deg);
}

TEST(ScenarioSignal, IsWrittenAsItIsRead) {
  const Scenario scenario =
      Parse("turntable_autocollimator", "point = \"y\"\nsignal = \"share\"\nby = \"x\"\nshare = 0.01\n");
  const Scenario again = ParseScenario(WriteScenario(scenario), "again.toml", ".");
  EXPECT_EQ(WriteScenario(again), WriteScenario(scenario));
  EXPECT_EQ(again.effects.at(0).by, "x");
  EXPECT_EQ(again.effects.at(0).where, "y");
}

// What a diagnosis adds to a scenario: findings in [[effect]] blocks, and [[empirical]] blocks.

Scenario Parsed(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return ParseScenario("bench = \"rotary_4dof\"\n" + text, "s.toml", "", overrides);
}

TEST(ScenarioFinding, TakesUncertaintiesToSIKeepsTheRestAndIsNotNeeded) {
  const Scenario s = Parsed(
      "[[effect]]\nname = \"psd_roll\"\nwhere = \"psd_a\"\nroll_mrad = 2\nu_roll_mrad = 0.1\n"
      "log_evidence = 31.5\nprobability = 0.97\nprovenance = \"run 7\"\n");
  EXPECT_THAT(s.effects.at(0).finding,
              FieldsAre(ElementsAre(testing::Pair("roll", 0.1 * units::mrad)), 31.5, 0.97, "run 7"));
  const Scenario without = Parsed("[[effect]]\nname = \"psd_roll\"\nwhere = \"psd_a\"\n");
  EXPECT_TRUE(without.effects.at(0).finding.u.empty());
  EXPECT_TRUE(std::isnan(without.effects.at(0).finding.probability));
}

constexpr const char* kEmpirical =
    "[[empirical]]\nsignature = \"order 7\"\nchannel = \"psd_b_y\"\nreading = [3, 5]\nvalue_um = [0.5, -0.25]\n";

TEST(ScenarioEmpirical, IsTabulatedByReadingOrByTime) {
  const EmpiricalSettings by_reading = Parsed(kEmpirical).empiricals.at(0);
  EXPECT_EQ(by_reading.signature, "order 7");
  EXPECT_EQ(by_reading.channel, "psd_b_y");
  EXPECT_THAT(by_reading.reading, ElementsAre(3, 5));
  EXPECT_THAT(by_reading.value_m, ElementsAre(0.5 * units::um, -0.25 * units::um));
  const std::string timed = "channel = \"psd_b_y\"\nby = \"time\"\ntime_s = [1.5, 2]\nvalue_um = [0.5, 1]\n";
  const EmpiricalSettings by_time = Parsed("[[empirical]]\n" + timed).empiricals.at(0);
  EXPECT_EQ(by_time.by, "time");
  EXPECT_THAT(by_time.time_s, ElementsAre(1.5, 2.0));
  EXPECT_THAT(by_time.reading, testing::IsEmpty());
}

TEST(ScenarioUncertainty, IsReadInTheUnitOfItsKeyAlsoOnTheCommandLine) {
  EXPECT_DOUBLE_EQ(Parsed("", {"psd_a.u_distance_mm=0.1"}).uncertainties.at(0).u, 0.1 * units::mm);
  const Scenario s = Parsed(
      "[laser]\nu_wavelength_nm = 0.01\n[psd_a]\nu_distance_mm = { half_width = 0.3, distribution = \"uniform\" "
      "}\n");
  EXPECT_THAT(
      s.uncertainties,
      ElementsAre(FieldsAre("laser.wavelength_nm", DoubleEq(0.01 * units::nm), Distribution::kNormal, INFINITY),
                  FieldsAre("psd_a.distance_mm", DoubleEq(0.3 * units::mm / std::sqrt(3.0)), Distribution::kUniform,
                            INFINITY)));
}

TEST(ScenarioUncertainty, ComesBackFromTheFileThatIsWritten) {
  const Scenario s = Parsed(
      "[psd_b]\nu_distance_mm = { u = 0.25, dof = 8, distribution = \"triangular\" }\n[grating]\nu_point_mm = "
      "0.5\n");
  const Scenario again = ParseScenario(WriteScenario(s), "again.toml", "");
  const auto same = [](const StatedUncertainty& one) {
    return FieldsAre(one.key, one.u, one.distribution, one.dof);
  };
  EXPECT_THAT(again.uncertainties, ElementsAre(same(s.uncertainties.at(0)), same(s.uncertainties.at(1))));
}

TEST(ScenarioUncertainty, FindsTheNumbersOfAKey) {
  Scenario s = Parsed("");
  NumbersAt(s, "psd_a.distance_mm")[0] = 0.2;
  EXPECT_NE(WriteScenario(s).find("distance_mm = 200.0"), std::string::npos);
  EXPECT_EQ(NumbersAt(s, "grating.point_mm").size(), 3U);
  EXPECT_THROW(NumbersAt(s, "laser.beam"), std::logic_error);
}

/// One entry of the list.
struct Place {
  std::string what = "bar";
  double at_m = 0.5;
  int turns = 2;
};

void AddPlace(schema::Table& table, Place& place) {
  table.Text("what", &place.what, {"bar", "grid"}, "");
  table.Add("at", schema::kMm, schema::UpTo(1000), &place.at_m, "");
  table.Add("turns", schema::kPure, {1, 9}, &place.turns, "");
}

std::vector<Place> ReadPlaces(const std::string& text) {
  std::vector<Place> places = {{}};
  schema::Keys keys;
  schema::Table(keys, "run").Records("places", places, AddPlace, "");
  ReadToml(text, "s.toml", keys);
  return places;
}

std::string RecordError(const std::string& text) { return MessageOf([&] { ReadPlaces(text); }); }

TEST(RecordList, IsReplacedAsAWholeAndWhatATableLeavesOutKeepsItsDefault) {
  EXPECT_THAT(ReadPlaces("[run]\nplaces = [{ what = \"grid\", at_mm = 60 }, { turns = 3 }]\n"),
              ElementsAre(FieldsAre("grid", 0.060, 2), FieldsAre("bar", 0.5, 3)));
  EXPECT_EQ(ReadPlaces("").size(), 1u);
}

TEST(RecordList, SaysWhatIsWrongInsideATable) {
  for (const char* places : {"[{ at = 60 }]", "[{ at_mm = 2000 }]", "[{ what = \"ball\" }]", "[7]", "[]"})
    ExpectRefused("s.toml", RecordError, {{2, "[run]\nplaces = " + std::string(places) + "\n"}});
}

}  // namespace
}  // namespace twinbench
