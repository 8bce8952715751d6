#include "tests/support/angle_benches.h"
#include "tests/support/small_scenario.h"
#include "twin/sim/changed_keys.h"
#include "twin/sim/own_tables.h"

// What holds of the twin of every bench that has few readings.
namespace twinbench::sim {
namespace {

using units::arcsec;

struct QuickBench {
  std::string name;
  std::vector<std::string> sets;
  double least;  // that every effect does to some reading, in SI
};

/// A front that is no plane is so beside its middle; stops are not on whole periods; what repeats with whole lines between samples
/// would be hidden.
const QuickBench kQuickBenches[] = {
    {kRotaryBench,
     {"environment.drift_K_h=1", "laser.position_mm=[1, 200, 0]", "mechanics.encoder_periods=36001", "mechanics.fidelity=kinematic",
      "procedure.positions=12", "procedure.shifts=[0, 4]", "target.random.ez_arcsec=5", "reference.random.ex_arcsec=5"},
     1e-4},  // 50 nm on the PSD
    {kEncoderBench, {"environment.drift_K_h=10", "encoder_procedure.kind=sweep", "device.lines_per_turn=90"}, 1e-4 * units::deg},
    {kTurntableBench,
     {"environment.drift_K_h=0.5", "turntable_procedure.phases=[\"calibration\", \"full_circle\"]", "turntable_procedure.positions=12",
      "turntable_procedure.eccentricities_um=[0]"},
     1e-3 * arcsec},
    {kHobBench,
     {"hob_procedure.heads_deg=[0]", "hob_procedure.turns=1", "hob_procedure.samples_per_turn=180", "table_encoder.noise_arcsec=0.3",
      "hob_encoder.lines=8192"},
     1e-3 * arcsec}};

class EveryTwin : public testing::TestWithParam<QuickBench> {
 protected:
  static Scenario Short(bool noise_free) {
    Scenario s = ParseScenario("bench = \"" + GetParam().name + "\"\n", "quick.toml", "", GetParam().sets);
    s.noise_free = noise_free;
    return s;
  }

  /// Of all numbers: the largest change of any reading, and how many readings changed.
  static std::pair<double, std::size_t> Change(std::vector<Reading> from, std::vector<Reading> to) {
    double largest = 0.0;
    std::size_t changed = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
      double change = 0.0;
      for (const ReadingColumn& column : FormatOf(GetParam().name).columns) {
        if (column.number) change = std::max(change, std::abs(column.number(to[i]) - column.number(from[i])));
      }
      largest = std::max(largest, change);
      changed += change > 0.0;
    }
    return {largest, changed};
  }
};

TEST_P(EveryTwin, HasEveryEffectOfItsCatalogueAndEachChangesTheReadings) {
  const bool scatter_is_an_effect = GetParam().name == kTurntableBench;
  const Scenario s = Short(!scatter_is_an_effect);
  const auto clean = test::ReadingsOf(s);
  for (const EffectEntry& entry : EffectCatalogue(s.bench)) {
    Scenario with = s;
    with.effects = {test::PlainEffect(entry)};
    EXPECT_GT(Change(clean, test::ReadingsOf(with)).first, GetParam().least) << entry.name;
  }
}

TEST_P(EveryTwin, GivesTheSameBitsForTheSameSeedAndOthersForAnother) {
  Scenario s = Short(false);
  const auto readings = test::ReadingsOf(s);
  EXPECT_EQ(Change(readings, test::ReadingsOf(s)).second, 0u);
  s.seed = 2;
  EXPECT_GT(Change(readings, test::ReadingsOf(s)).second, readings.size() * 4 / 5);
}

/// What the readings of a channel show, which its diagnosis takes off again.
TEST_P(EveryTwin, ShowsAnEmpiricalSignalInTheReadingsItNamesWhichTheDiagnosisTakesOff) {
  const Scenario s = Short(false);
  const auto plain = test::ReadingsOf(s);
  const auto left_of = [](const std::vector<Reading>& readings, const Scenario& believed) {
    return BenchOf(believed).linear_run(readings, believed, Estimator::kRigorous);
  };
  const diagnose::LinearRun left = left_of(plain, s);
  const double size = 2e-6, of_unit = GetParam().name == kRotaryBench ? 2000.0 : 1.0;  // m or rad; V/m
  for (const std::string& channel : FormatOf(s.bench).channels) {
    SCOPED_TRACE(channel);
    Scenario with = s;
    const std::vector<double> twice = {size, size};
    with.empiricals = {{.channel = channel, .reading = {40, 41}, .value_m = twice, .value_rad = twice}};
    const auto shown = test::ReadingsOf(with);
    const auto [largest, changed] = Change(plain, shown);
    EXPECT_NEAR(largest, of_unit * size, 0.01 * of_unit * size) << "converters have steps";
    EXPECT_EQ(changed, 2u);
    EXPECT_LT((left_of(shown, with).residual - left.residual).cwiseAbs().maxCoeff(), 0.01 * size);
    int row = 0;
    EXPECT_GT((left_of(shown, s).residual - left.residual).maxCoeff(&row), 0.1 * size) << "with its sign";
    EXPECT_EQ(left.channels[static_cast<std::size_t>(left.ChannelOf(row))], channel);
  }
}

INSTANTIATE_TEST_SUITE_P(Bench, EveryTwin, testing::ValuesIn(kQuickBenches),
                         [](const auto& tested) { return tested.param.name; });

EmpiricalSettings ByTime() {
  return {.channel = "psd_b_y", .by = "time", .time_s = {10.0, 20.0, 40.0}, .value_m = {1e-6, 3e-6, -1e-6}};
}

TEST(Empirical, GoesStraightBetweenItsTimesAndStaysOutside) {
  const EmpiricalSignal signal({ByTime()}, "psd_b_y");
  for (const auto& [time_s, value_m] :
       {std::pair(9.0, 1e-6), {10.0, 1e-6}, {12.5, 1.5e-6}, {30.0, 1e-6}, {40.0, -1e-6}, {400.0, -1e-6}})
    EXPECT_DOUBLE_EQ(signal.At(7, time_s), value_m) << time_s;
  EXPECT_EQ(EmpiricalSignal({ByTime()}, "psd_a_y").At(1, 20.0), 0.0);
}

TEST(Empirical, ByTimeIsShownByTheTwinThatFollows) {
  Scenario scenario = test::SmallNoiseFree();
  const auto readings = test::RunTwin(scenario).readings;
  const auto shown = [&] { return BenchOf(scenario).follow(scenario, readings)->Predict(); };
  const Eigen::MatrixXd plain = shown();
  EmpiricalSettings table = ByTime();
  table.time_s = {ToSeconds(readings.at(30).time), ToSeconds(readings.at(33).time),
                  ToSeconds(readings.at(50).time)};
  scenario.empiricals = {table};
  const Eigen::MatrixXd change = shown() - plain;
  const EmpiricalSignal signal({table}, "psd_b_y");
  double most_V = 0.0;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const Duration half_block = BlockTime(RotaryOf(scenario).adc, readings[i].n_samples) / 2;
    const double expected_V = 2000.0 * signal.At(readings[i].reading, ToSeconds(readings[i].time + half_block));
    EXPECT_NEAR(change(static_cast<Eigen::Index>(i), 3), expected_V, 1e-9) << i;
    most_V = std::max(most_V, std::abs(expected_V));
  }
  EXPECT_GT(most_V, 1e-3);
}

TEST(OwnTables, AreLeftOutOfARecordThatWasTakenAtOtherTimes) {
  std::vector<Reading> record(3);
  for (int i = 0; i < 3; ++i) record[static_cast<std::size_t>(i)].reading = i;
  for (int i = 0; i < 3; ++i) record[static_cast<std::size_t>(i)].time = Time(FromSeconds(2.0 * i));
  EmpiricalSettings own, other, without, by_time = ByTime();
  own.reading = other.reading = without.reading = {0, 2, 9};
  own.time_s = {0.0, 4.0, 18.0};
  other.time_s = {0.0, 4.001, 18.0};
  std::vector<EmpiricalSettings> tables = {other, own, without, by_time};
  LeaveOutForeignTables(record, tables);
  ASSERT_EQ(tables.size(), 3u);
  EXPECT_EQ(tables[0].time_s, own.time_s);
  EXPECT_TRUE(tables[1].time_s.empty());
  EXPECT_EQ(tables[2].by, "time");
}

// What holds of every row of a catalogue that says which key an effect changes.

EffectSettings AtPlace(const EffectEntry& entry, const std::string& place) {
  EffectSettings effect = test::PlainEffect(entry);
  effect.where = place;
  return effect;
}

std::vector<std::string> PlacesOf(const EffectEntry& entry) {
  return entry.places.empty() ? std::vector<std::string>{""} : entry.places;
}

bool ChangesKeys(const EffectEntry& entry) {
  return std::ranges::any_of(entry.parameters, [](const EffectParameter& p) { return !p.changes.empty(); });
}

/// Text of the scenario without its effects: its keys.
std::string KeysIn(Scenario scenario) {
  scenario.effects.clear();
  return WriteScenario(scenario);
}

TEST(ChangedKeys, EveryRowNamesAKeyOfItsBenchAndChangesItAtEveryPlaceAndAtEachDifferently) {
  int rows = 0;
  for (const std::string& bench : BenchNames()) {
    const Scenario nominal = LoadScenario(test::ScenarioPath(bench + ".toml"));
    for (const EffectEntry& entry : EffectCatalogue(bench)) {
      if (!ChangesKeys(entry)) continue;
      std::set<std::string> seen = {KeysIn(nominal)};
      for (const std::string& place : PlacesOf(entry)) {
        Scenario actual = nominal;
        actual.effects = {AtPlace(entry, place)};
        ChangeKeys(actual);
        EXPECT_TRUE(seen.insert(KeysIn(actual)).second) << bench << " " << entry.name << " " << place;
        ++rows;
      }
    }
  }
  EXPECT_GE(rows, 40);
}

TEST(ChangedKeys, AreAddedToMultipliedAndDividedAsTheirRowsSay) {
  Scenario actual = LoadScenario(test::ScenarioPath("rotary_4dof.toml"));
  const RotarySettings nominal = RotaryOf(actual);
  EffectSettings gain{"psd_gain", "psd_b_x", {{"gain_error", 0.004}}, ""};
  EffectSettings distance{"psd_distance", "both", {{"distance_error", 2e-3}}, ""};
  EffectSettings pitch{"grating_pitch", "", {{"pitch_error", 0.25}}, ""};
  actual.effects = {gain, gain, distance, pitch};
  ChangeKeys(actual);
  const RotarySettings& changed = RotaryOf(actual);
  EXPECT_EQ(changed.amplifier.gain_error[2], nominal.amplifier.gain_error[2] + 0.004 + 0.004);
  EXPECT_EQ(changed.amplifier.gain_error[1], nominal.amplifier.gain_error[1]);
  EXPECT_EQ(changed.psd_a.distance_m, nominal.psd_a.distance_m + 2e-3);
  EXPECT_EQ(changed.psd_b.distance_m, nominal.psd_b.distance_m + 2e-3);
  EXPECT_EQ(changed.grating.lines_per_m, nominal.grating.lines_per_m / 1.25);
}

TEST(ChangedKeys, EffectsThatDoNoMoreNeedNothingElse) {
  Scenario scenario = LoadScenario(test::ScenarioPath("rotary_4dof.toml"));
  for (const char* name : {"psd_roll", "slip", "wavelength_offset"})
    scenario.effects.push_back(test::PlainEffect(*FindEffect(name, kRotaryBench)));
  const std::vector<EffectSettings> left = BeyondKeys(scenario);
  ASSERT_EQ(left.size(), 1u);
  EXPECT_EQ(left.front().name, "slip");
}

}  // namespace
}  // namespace twinbench::sim
