#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/angle_benches.h"
#include "tests/support/small_scenario.h"
#include "twin/core/bench_format.h"
#include "twin/core/reading_column.h"

// What holds of the twin of every bench that has few readings.
namespace twinbench {
namespace {

using units::arcsec;

struct QuickBench {
  std::string name;
  void (*shorten)(Scenario&);
  double least;  // that every effect does to some reading, in SI
};

const QuickBench kQuickBenches[] = {
    {kRotaryBench,
     [](Scenario& s) {
       s = test::SmallNoiseFree();
       s.environment.drift_K_h = 1.0;
       RotaryOf(s).laser.position_m.x() = units::mm;   // a front that is no plane is so beside its middle
       RotaryOf(s).mechanics.encoder_periods = 36001;  // stops are not on whole periods
       RotaryOf(s).target.random_rms[2] = RotaryOf(s).reference.random_rms[0] = 5.0 * arcsec;
     },
     1e-4},  // 50 nm on the PSD
    {kEncoderBench,
     [](Scenario& s) {
       s.environment.drift_K_h = 10.0;
       EncoderOf(s).encoder_procedure.kind = "sweep";
       EncoderOf(s).device.lines = 90;
     },
     1e-4 * units::deg},
    {kTurntableBench,
     [](Scenario& s) {
       s.environment.drift_K_h = 0.5;
       TurntableOf(s).turntable_procedure.phases = {"calibration", "full_circle"};
       TurntableOf(s).turntable_procedure.positions = 12;
       TurntableOf(s).turntable_procedure.tilts_rad = {60.0 * arcsec, 100.0 * arcsec};
       TurntableOf(s).turntable_procedure.eccentricities_m = {0.0};
       TurntableOf(s).turntable_procedure.passes = {1, -1};
     },
     1e-3 * arcsec},
    {kHobBench,
     [](Scenario& s) {
       HobOf(s).hob_procedure.heads_rad = {0.0};
       HobOf(s).hob_procedure.turns = 1;
       HobOf(s).hob_procedure.samples_per_turn = 180;
       HobOf(s).table_encoder.noise_rad = 0.3 * arcsec;
       HobOf(s).hob_encoder.lines = 8192;  // what repeats with whole lines between samples would be hidden
     },
     1e-3 * arcsec}};

class EveryTwin : public testing::TestWithParam<QuickBench> {
 protected:
  static Scenario Short(bool noise_free) {
    Scenario s;
    s.bench = GetParam().name;
    GetParam().shorten(s);
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

INSTANTIATE_TEST_SUITE_P(Bench, EveryTwin, testing::ValuesIn(kQuickBenches),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace twinbench
