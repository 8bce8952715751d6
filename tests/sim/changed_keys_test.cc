#include "twin/sim/changed_keys.h"

#include <gtest/gtest.h>

#include "tests/support/angle_benches.h"
#include "twin/benches/names.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/core/bench_format.h"

// What holds of every row of a catalogue that says which key an effect changes.
namespace twinbench::sim {
namespace {

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
