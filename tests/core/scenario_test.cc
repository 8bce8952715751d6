#include "twin/core/scenario.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/input_error.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/core/nearest_key.h"

namespace twinbench {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* kBench = "bench = \"rotary_4dof\"\n";

Scenario Parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return ParseScenario(kBench + text, "s.toml", ".", overrides);
}

/// The message about a text that begins in line 2 of the file.
std::string ErrorOf(const std::string& text) {
  return MessageOf([&] { Parse(text); });
}

std::string OverrideError(const std::string& override_text, const std::string& text = "") {
  return MessageOf([&] { Parse(text, {override_text}); });
}

// --- good input ---

TEST(Scenario, WithoutKeysIsTheReferenceBench) {
  const Scenario s = Parse("");
  EXPECT_EQ(RotaryOf(s).laser.wavelength_m, 650.0 * units::nm);
  EXPECT_EQ(RotaryOf(s).psd_a.distance_m, 0.120);
  EXPECT_THAT(RotaryOf(s).procedure.shifts, ElementsAre(0, 1, 7, 11));
  EXPECT_EQ(RotaryOf(s).procedure.positions, 36);
  EXPECT_EQ(RotaryOf(s).procedure.clamping, "reseat");
}

TEST(Scenario, TakesNumbersToSI) {
  const Scenario s = Parse(R"(
title = "gain"
seed = 7
[laser]
wavelength_nm = 635
beam = "gaussian"
position_mm = [1, 200.5, -2]
[grating]
lines_per_mm = 1200
[psd_b]
roll_mrad = -3.5
[amplifier]
noise_mV = 6.5
offset_mV = [1, 2, 3, 4]
[adc]
rate_kHz = 100
[reference]
height_mm = 81
centring_um = [10, -20]
[reference.seating]
ez_arcsec = 0.25
dx_um = 1.5
[target.random]
ey_arcsec = 3
orders = 5
[mechanics]
radial_stiffness_N_um = [90, 50]
tilt_stiffness_Nm_mrad = [500, 200]
[procedure]
sweep_arcsec = 200
dwell_s = [0.5, 1, 2]
passes = [1, -1]
)");
  EXPECT_EQ(s.title, "gain");
  EXPECT_EQ(s.seed, 7u);
  EXPECT_EQ(RotaryOf(s).laser.wavelength_m, 635.0 * units::nm);
  EXPECT_EQ(RotaryOf(s).laser.beam, "gaussian");
  EXPECT_EQ(RotaryOf(s).laser.position_m, Vector3(1.0 * units::mm, 200.5 * units::mm, -2.0 * units::mm));
  EXPECT_EQ(RotaryOf(s).grating.lines_per_m, 1200e3);
  EXPECT_EQ(RotaryOf(s).psd_b.roll_rad, -3.5 * units::mrad);
  EXPECT_EQ(RotaryOf(s).psd_a.roll_rad, 0.0);
  EXPECT_EQ(RotaryOf(s).amplifier.noise_V, 6.5 * units::mV);
  EXPECT_EQ(RotaryOf(s).amplifier.offset_V[3], 4.0 * units::mV);
  EXPECT_EQ(RotaryOf(s).adc.rate_Hz, 100e3);
  EXPECT_EQ(RotaryOf(s).reference_height_m, 81.0 * units::mm);
  EXPECT_EQ(RotaryOf(s).centring_m.y(), -20.0 * units::um);
  EXPECT_EQ(RotaryOf(s).reference.seating_sd[2], 0.25 * units::arcsec);
  EXPECT_EQ(RotaryOf(s).reference.seating_sd[3], 1.5 * units::um);
  EXPECT_EQ(RotaryOf(s).target.random_rms[1], 3.0 * units::arcsec);
  EXPECT_EQ(RotaryOf(s).target.random_orders, 5);
  EXPECT_EQ(RotaryOf(s).mechanics.radial_stiffness_N_m[0], 90e6);
  EXPECT_EQ(RotaryOf(s).mechanics.tilt_stiffness_Nm_rad[1], 0.2e6);
  EXPECT_EQ(RotaryOf(s).procedure.sweep_rad, 200.0 * units::arcsec);
  EXPECT_THAT(RotaryOf(s).procedure.dwell_s, ElementsAre(0.5, 1.0, 2.0));
  EXPECT_THAT(RotaryOf(s).procedure.passes, ElementsAre(1, -1));
}

TEST(Scenario, TakesHarmonicsInTheUnitOfTheirComponent) {
  const Scenario s = Parse(R"([target]
harmonics = [ { component = "ez", order = 1, amplitude_arcsec = 5.0, phase_deg = 30.0 },
              { component = "dy", order = 2.5, amplitude_um = -1.5 } ]
)");
  ASSERT_EQ(RotaryOf(s).target.harmonics.size(), 2u);
  EXPECT_EQ(RotaryOf(s).target.harmonics[0].component, Component::kEz);
  EXPECT_EQ(RotaryOf(s).target.harmonics[0].amplitude, 5.0 * units::arcsec);
  EXPECT_EQ(RotaryOf(s).target.harmonics[0].phase_rad, 30.0 * units::deg);
  EXPECT_EQ(RotaryOf(s).target.harmonics[1].component, Component::kDy);
  EXPECT_EQ(RotaryOf(s).target.harmonics[1].order, 2.5);
  EXPECT_EQ(RotaryOf(s).target.harmonics[1].amplitude, -1.5 * units::um);
  EXPECT_EQ(RotaryOf(s).target.harmonics[1].phase_rad, 0.0);
}

TEST(Scenario, TakesEffectsWithTheDefaultsOfTheCatalogue) {
  const Scenario s = Parse(R"([[effect]]
name = "laser_drift"
where = "pitch"
drift_urad_per_h = 36

[[effect]]
name = "backlash"
[[effect]]
name = "tone"
)");
  ASSERT_EQ(s.effects.size(), 3u);
  EXPECT_EQ(s.effects[0].name, "laser_drift");
  EXPECT_EQ(s.effects[0].where, "pitch");
  EXPECT_EQ(s.effects[0].location, "s.toml:2");
  EXPECT_DOUBLE_EQ(s.effects[0].parameters.at("drift"), 1e-8);
  EXPECT_EQ(s.effects[0].parameters.at("curvature"), 0.0);
  EXPECT_EQ(s.effects[1].where, "target");
  EXPECT_EQ(s.effects[1].parameters.at("half_width"), 1.0 * units::arcsec);
  EXPECT_EQ(s.effects[2].where, "all");
}

TEST(Scenario, TakesTheErrorsOfATableFromItsFolder) {
  const TemporaryFolder folder;
  folder.Write("t.csv", "position_deg,ez_arcsec\n0,1\n180,-1\n");
  const std::string path = folder.Write("s.toml", std::string(kBench) + "[target]\nerrors_file = \"t.csv\"\n");
  const Scenario s = LoadScenario(path);
  ASSERT_TRUE(RotaryOf(s).target.errors.has_value());
  EXPECT_EQ((*RotaryOf(s).target.errors)[Component::kEz][1], -1.0 * units::arcsec);
  EXPECT_TRUE(RotaryOf(s).target.errors_file.empty());
  EXPECT_FALSE(RotaryOf(s).reference.errors.has_value());
}

TEST(Scenario, TakesTheErrorsOfATableInline) {
  const Scenario s = Parse("[reference.errors]\nposition_deg = [0, 90]\ndx_um = [1, 2]\n");
  EXPECT_EQ(RotaryOf(s).reference.errors->position_rad[1], 90.0 * units::deg);
  EXPECT_EQ((*RotaryOf(s).reference.errors)[Component::kDx][1], 2.0 * units::um);
  EXPECT_EQ((*RotaryOf(s).reference.errors)[Component::kEx], (std::vector<double>{0.0, 0.0}));
}

// --- overrides ---

TEST(ScenarioOverride, WinsOverTheFileAndOverEarlierOnes) {
  const Scenario s = Parse("[procedure]\npositions = 24\nsweep_arcsec = 100\n",
                           {"procedure.positions=48", "procedure.positions=72", "laser.wavelength_nm = 640"});
  EXPECT_EQ(RotaryOf(s).procedure.positions, 72);
  EXPECT_EQ(RotaryOf(s).procedure.sweep_rad, 100.0 * units::arcsec);
  EXPECT_EQ(RotaryOf(s).laser.wavelength_m, 640.0 * units::nm);
}

TEST(ScenarioOverride, ReplacesListsAsAWhole) {
  const std::string text =
      "[target]\nharmonics = [{ component = \"ez\", order = 1, amplitude_arcsec = 5.0 }]\n"
      "[[effect]]\nname = \"settling\"\n";
  EXPECT_EQ(RotaryOf(Parse(text)).target.harmonics.size(), 1u);
  EXPECT_TRUE(RotaryOf(Parse(text, {"target.harmonics=[]"})).target.harmonics.empty());
  EXPECT_TRUE(Parse(text, {"effect=[]"}).effects.empty());
  EXPECT_THAT(RotaryOf(Parse(text, {"procedure.shifts=[0, 5]"})).procedure.shifts, ElementsAre(0, 5));
}

TEST(ScenarioOverride, NeedsNoQuotesForAWord) {
  EXPECT_EQ(RotaryOf(Parse("", {"procedure.clamping=reclamp"})).procedure.clamping, "reclamp");
  EXPECT_EQ(RotaryOf(Parse("", {"procedure.clamping=\"reclamp\""})).procedure.clamping, "reclamp");
  EXPECT_EQ(RotaryOf(Parse("", {"mechanics.fidelity=linear"})).mechanics.fidelity, "linear");
}

TEST(ScenarioOverride, OfAnErrorsFileReplacesErrorsOfTheFile) {
  const TemporaryFolder folder;
  folder.Write("t.csv", "position_deg,ez_arcsec\n0,3\n");
  const std::string text = std::string(kBench) + "[target.errors]\nposition_deg = [0]\nez_arcsec = [1]\n";
  const Scenario s = ParseScenario(text, "s.toml", folder.path(), {"target.errors_file=t.csv"});
  EXPECT_EQ((*RotaryOf(s).target.errors)[Component::kEz][0], 3.0 * units::arcsec);
}

TEST(ScenarioOverride, IsNamedWhenItIsWrong) {
  EXPECT_EQ(OverrideError("procedure.positions=1"),
            "--set procedure.positions=1: procedure.positions is 1; expected a whole number from 3 to 100000");
  EXPECT_EQ(OverrideError("procedure.positons=12"),
            "--set procedure.positons=12: unknown key procedure.positons; expected a known one; the nearest is "
            "procedure.positions");
  EXPECT_EQ(OverrideError("positions"),
            "--set positions: there is no \"=\"; expected key=value, as in laser.wavelength_nm=640");
  EXPECT_THAT(OverrideError("title=two words"),
              StartsWith("--set title=two words: this is not TOML; expected key="));
  EXPECT_EQ(OverrideError("laser=5"), "--set laser=5: laser is 5; expected a table [laser]");
  EXPECT_EQ(OverrideError("procedure.positions=8"),
            "--set procedure.positions=8: procedure.shifts has 11; expected shifts from 0 to 7 (positions - 1)");
}

// --- bad input: where, what, expected ---

TEST(ScenarioError, NamesTheBenchesThatThereAre) {
  const std::string benches =
      "\"rotary_4dof\", \"encoder_comparison\", \"turntable_autocollimator\", \"hob_transmission\", "
      "\"circular_motion\" or \"freeform_five_axis\"";
  EXPECT_EQ(MessageOf([] { ParseScenario("seed = 1\n", "s.toml", ".", {}); }),
            "s.toml:1: bench is missing; expected bench = " + benches);
  EXPECT_EQ(MessageOf([] { ParseScenario("\nbench = \"lathe\"\n", "s.toml", ".", {}); }),
            "s.toml:2: unknown bench \"lathe\"; expected " + benches + "; the nearest is \"rotary_4dof\"");
  EXPECT_THAT(MessageOf([] { ParseScenario("bench = \"hob_transmision\"\n", "s.toml", ".", {}); }),
              EndsWith("; the nearest is \"hob_transmission\""));
  EXPECT_THAT(MessageOf([] { WriteScenario(Scenario{}); }), StartsWith("bench: no bench is named; expected "));
}

TEST(ScenarioError, NamesTheBenchThatAKeyBelongsTo) {
  const auto encoder = [](const std::string& text) {
    return MessageOf([&] { ParseScenario("bench = \"encoder_comparison\"\n" + text, "s.toml", ".", {}); });
  };
  EXPECT_EQ(encoder("[laser]\nwavelength_nm = 650\n"),
            "s.toml:2: laser belongs to the bench rotary_4dof; expected keys of encoder_comparison");
  EXPECT_EQ(encoder("[[fixture]]\nname = \"plate\"\n"),
            "s.toml:2: fixture belongs to the bench rotary_4dof; expected keys of encoder_comparison");
  EXPECT_EQ(ErrorOf("[device]\nnoise_deg = 0.1\n"),
            "s.toml:2: device belongs to the bench encoder_comparison; expected keys of rotary_4dof");
  EXPECT_THAT(
      encoder("[[effect]]\nname = \"psd_gain\"\n"),
      StartsWith("s.toml:3: the effect psd_gain belongs to the bench rotary_4dof; expected \"eccentricity\""));
  EXPECT_EQ(encoder("[device]\nnoise_dg = 0.1\n"),
            "s.toml:3: unknown key device.noise_dg; expected a known one; the nearest is device.noise_deg");
  EXPECT_EQ(encoder("[encoder_procedure]\npasses = [1, 0]\n"),
            "s.toml:3: encoder_procedure.passes has 0; expected directions 1 or -1");
}

TEST(Scenario, TakesTheEffectsOfItsOwnBench) {
  const Scenario s = ParseScenario(
      "bench = \"encoder_comparison\"\n[[effect]]\nname = \"backlash\"\nwidth_deg = 0.5\n", "s.toml", ".", {});
  EXPECT_EQ(s.effects.at(0).parameters.at("width"),
            0.5 * units::deg);  // the rotary bench's has a half_width_arcsec
}

TEST(ScenarioError, GivesTheLineOfASyntaxError) {
  EXPECT_THAT(ErrorOf("seed = \n"), StartsWith("s.toml:2: "));
  EXPECT_THAT(ErrorOf("seed = 1\nseed = 2\n"), StartsWith("s.toml:3: "));
}

TEST(ScenarioError, NamesTheNearestKnownKey) {
  EXPECT_EQ(ErrorOf("[laser]\nwavelenght_nm = 650\n"),
            "s.toml:3: unknown key laser.wavelenght_nm; expected a known one; the nearest is laser.wavelength_nm");
  EXPECT_EQ(ErrorOf("wavelength_nm = 650\n"),
            "s.toml:2: unknown key wavelength_nm; expected a known one; the nearest is laser.wavelength_nm");
  EXPECT_EQ(ErrorOf("[lasr]\nwavelength_nm = 650\n"),
            "s.toml:2: unknown table lasr; expected a known one; the nearest is laser");
  EXPECT_THAT(ErrorOf("[xyz]\na = 1\n"), testing::Not(EndsWith("is ")))
      << "the nameless top is no table to be near to";
  EXPECT_EQ(ErrorOf("[target.seeting]\nez_arcsec = 1\n"),
            "s.toml:2: unknown table target.seeting; expected a known one; the nearest is target.seating");
}

TEST(ScenarioError, SeesKeysThatQuotesHide) {
  EXPECT_EQ(ErrorOf("\"laser.wavelength_nm\" = 640\n"),
            "s.toml:2: unknown key laser.wavelength_nm; expected a known one; the nearest is laser.wavelength_nm");
  EXPECT_THAT(ErrorOf("\"\" = 1\n"), StartsWith("s.toml:2: unknown key "));
}

TEST(ScenarioError, NamesTheRightUnitOfAKey) {
  EXPECT_EQ(ErrorOf("[laser]\nwavelength_m = 650e-9\n"),
            "s.toml:3: the key laser.wavelength_m has the wrong unit; expected laser.wavelength_nm");
  EXPECT_EQ(ErrorOf("[laser]\nwavelength = 650\n"),
            "s.toml:3: the key laser.wavelength has the wrong unit; expected laser.wavelength_nm");
  EXPECT_EQ(ErrorOf("[procedure]\nsweep_deg = 1\n"),
            "s.toml:3: the key procedure.sweep_deg has the wrong unit; expected procedure.sweep_arcsec");
  EXPECT_EQ(ErrorOf("[target.random]\ndx_arcsec = 1\n"),
            "s.toml:3: the key target.random.dx_arcsec has the wrong unit; expected target.random.dx_um");
}

TEST(ScenarioError, NamesTypeAndBoundsAsTheUserWritesThem) {
  EXPECT_EQ(ErrorOf("[laser]\nwavelength_nm = -5\n"),
            "s.toml:3: laser.wavelength_nm is -5; expected a number of nm from 200 to 2000");
  EXPECT_EQ(ErrorOf("[laser]\nwavelength_nm = \"red\"\n"),
            "s.toml:3: laser.wavelength_nm is \"red\"; expected a number of nm from 200 to 2000");
  EXPECT_EQ(ErrorOf("[psd_a]\ndistance_mm = 0\n"),
            "s.toml:3: psd_a.distance_mm is 0; expected a number of mm above 0 and up to 10000");
  EXPECT_EQ(ErrorOf("[psd_a]\ndistance_mm = [1]\n"),
            "s.toml:3: psd_a.distance_mm is a list; expected a number of mm above 0 and up to 10000");
  EXPECT_EQ(ErrorOf("noise_free = 1\n"), "s.toml:2: noise_free is 1; expected true or false");
  EXPECT_EQ(ErrorOf("title = 5\n"), "s.toml:2: title is 5; expected a text in quotes");
  EXPECT_EQ(ErrorOf("seed = -1\n"), "s.toml:2: seed is -1; expected a whole number, 0 or more");
  EXPECT_EQ(ErrorOf("[procedure]\npositions = 36.0\n"),
            "s.toml:3: procedure.positions is 36.0; expected a whole number from 3 to 100000");
}

TEST(ScenarioError, RefusesNumbersThatAreNotFinite) {
  EXPECT_EQ(ErrorOf("[psd_a]\nroll_mrad = nan\n"),
            "s.toml:3: psd_a.roll_mrad is nan; expected a number of mrad from -3200 to 3200");
  EXPECT_EQ(ErrorOf("[psd_a]\nroll_mrad = -inf\n"),
            "s.toml:3: psd_a.roll_mrad is -inf; expected a number of mrad from -3200 to 3200");
}

TEST(ScenarioError, NamesTheLengthOfAList) {
  EXPECT_EQ(ErrorOf("[amplifier]\noffset_mV = [1, 2, 3]\n"),
            "s.toml:3: amplifier.offset_mV has 3 entries; expected a list of 4, each a number of mV from -20000 to "
            "20000");
  EXPECT_EQ(ErrorOf("[procedure]\ndwell_s = []\n"),
            "s.toml:3: procedure.dwell_s is empty; expected a list, each a number of s from 0 to 86400");
}

TEST(ScenarioError, GivesTheLineOfAnEntryOfAList) {
  EXPECT_EQ(ErrorOf("[amplifier]\noffset_mV = [1,\n  2,\n  \"x\", 4]\n"),
            "s.toml:5: amplifier.offset_mV is \"x\"; expected a number of mV from -20000 to 20000");
}

TEST(ScenarioError, NamesTheChoices) {
  EXPECT_EQ(ErrorOf("[procedure]\nclamping = \"glue\"\n"),
            "s.toml:3: procedure.clamping is \"glue\"; expected \"reseat\" or \"reclamp\"");
  EXPECT_EQ(ErrorOf("[mechanics]\nfidelity = \"best\"\n"),
            "s.toml:3: mechanics.fidelity is \"best\"; expected \"kinematic\", \"linear\" or \"bullet\"");
  EXPECT_EQ(ErrorOf("[laser]\nbeam = \"ray\"\n"),
            "s.toml:3: laser.beam is \"ray\"; expected \"chief_ray\", \"gaussian\" or \"profile\"");
  EXPECT_EQ(
      ErrorOf("[procedure]\nphases = [\"warmup\"]\n"),
      "s.toml:3: procedure.phases is \"warmup\"; expected \"calibration\", \"stability\", \"verification\" or "
      "\"full_circle\"");
}

TEST(ScenarioError, WantsEveryChannelOnceInTheScanList) {
  EXPECT_EQ(ErrorOf("[adc]\nscan_list = [\"psd_a_x\", \"psd_a_x\", \"psd_b_x\", \"psd_b_y\"]\n"),
            "s.toml:3: adc.scan_list names 3 of the 4 channels in 4 entries; expected every channel once");
}

TEST(ScenarioError, ChecksShiftsAndPasses) {
  EXPECT_EQ(ErrorOf("[procedure]\nshifts = [0, 36]\n"),
            "s.toml:3: procedure.shifts has 36; expected shifts from 0 to 35 (positions - 1)");
  EXPECT_EQ(ErrorOf("[procedure]\nshifts = [0, 5, 5]\n"),
            "s.toml:3: procedure.shifts has 5 twice; expected every shift once");
  EXPECT_EQ(ErrorOf("[procedure]\nshifts = [0, -1]\n"),
            "s.toml:3: procedure.shifts is -1; expected a whole number from 0 to 99999");
  EXPECT_EQ(ErrorOf("[procedure]\npasses = [1, 0]\n"),
            "s.toml:3: procedure.passes has 0; expected directions 1 or -1");
  EXPECT_EQ(ErrorOf("[procedure]\npasses = [1, 2]\n"),
            "s.toml:3: procedure.passes is 2; expected a whole number from -1 to 1");
}

TEST(ScenarioError, ChecksHarmonics) {
  const auto error = [](const std::string& entry) { return ErrorOf("[target]\nharmonics = [" + entry + "]\n"); };
  const std::string form = "{ component = \"ez\", order = 1, amplitude_arcsec = 5.0, phase_deg = 30.0 }";
  EXPECT_EQ(error("1"), "s.toml:3: target.harmonics is 1; expected " + form);
  EXPECT_EQ(error("{ order = 1 }"), "s.toml:3: target.harmonics has no amplitude_arcsec; expected " + form);
  EXPECT_EQ(error("{ component = \"ez\", order = 1 }"),
            "s.toml:3: target.harmonics has no amplitude_arcsec; expected " + form);
  EXPECT_EQ(error("{ component = \"ez\", order = 1, amplitude_um = 2 }"),
            "s.toml:3: \"ez\" has an amplitude of the wrong unit; expected amplitude_arcsec");
  EXPECT_EQ(error("{ component = \"rx\", order = 1 }"),
            "s.toml:3: component is \"rx\"; expected \"ex\", \"ey\", \"ez\", \"dx\", \"dy\" or \"dz\"");
  EXPECT_EQ(error("{ component = \"ez\", ordr = 1 }"),
            "s.toml:3: unknown key ordr; expected a known one; the nearest is order");
  EXPECT_EQ(error("{ component = \"ez\", order = 1, amplitude_arcsec = 1, phase_rad = 1 }"),
            "s.toml:3: the key phase_rad has the wrong unit; expected phase_deg");
}

TEST(ScenarioError, ChecksInlineErrors) {
  EXPECT_EQ(ErrorOf("[target.errors]\nez_arcsec = [1]\n"),
            "s.toml:2: target.errors has no position_deg; expected the angle of every value");
  EXPECT_EQ(ErrorOf("[target.errors]\nposition_deg = [0, 1]\nez_arcsec = [1]\n"),
            "s.toml:4: target.errors.ez_arcsec has 1 entries; expected 2, one a position");
  EXPECT_EQ(ErrorOf("[target.errors]\nposition_deg = [0]\nez_urad = [1]\n"),
            "s.toml:4: the key target.errors.ez_urad has the wrong unit; expected target.errors.ez_arcsec");
  EXPECT_EQ(ErrorOf("[target]\nerrors_file = \"t.csv\"\n[target.errors]\nposition_deg = [0]\n"),
            "s.toml:3: target.errors_file is given beside a table target.errors; expected one of them");
}

TEST(ScenarioError, NamesFilesThatCannotBeRead) {
  EXPECT_THAT(ErrorOf("[target]\nerrors_file = \"no_such.csv\"\n"),
              testing::AllOf(StartsWith("s.toml:3: target.errors_file: the file /"),
                             HasSubstr("no_such.csv cannot be read; expected a readable file")));
  EXPECT_THAT(ErrorOf("[environment]\ntemperature_file = \"no_such.csv\"\n"),
              StartsWith("s.toml:3: environment.temperature_file: the file /"));
  EXPECT_EQ(ErrorOf("[laser]\nbeam = \"profile\"\n"),
            "s.toml:3: laser.beam is \"profile\" without a file; expected laser.profile_file = \"beam.exr\"");
  EXPECT_EQ(MessageOf([] { LoadScenario("no_such.toml"); }),
            "no_such.toml: the file cannot be read or is empty; expected a scenario in TOML");
}

// --- bad effects ---

std::string EffectError(const std::string& lines) {
  return ErrorOf("[[effect]]\n" + lines);
}

TEST(ScenarioEffectError, NamesTheNearestEffect) {
  EXPECT_EQ(EffectError("name = \"psd_gian\"\n"),
            "s.toml:3: unknown effect \"psd_gian\"; expected a known one; the nearest is \"psd_gain\"");
  EXPECT_THAT(EffectError("where = \"yaw\"\n"),
              StartsWith("s.toml:2: the effect has no name; expected \"psd_gain\", "));
  EXPECT_EQ(ErrorOf("[effect]\nname = \"tone\"\n"), "s.toml:2: effect is a table; expected [[effect]] blocks");
}

TEST(ScenarioEffectError, ListsWhatTheEffectHas) {
  EXPECT_EQ(
      EffectError("name = \"psd_roll\"\nwhere = \"psd_a\"\nroll_deg = 1\n"),
      "s.toml:5: the effect psd_roll has no roll_deg; expected name, where (\"psd_a\" or \"psd_b\"), roll_mrad");
  EXPECT_EQ(EffectError("name = \"slip\"\nwhere = \"lateral\"\nangle_arcsec = 1\n"),
            "s.toml:5: the effect slip has no angle_arcsec at lateral; expected name, where (\"yaw\", \"tilt\" or "
            "\"lateral\"), angle_arcsec, shift_um, at_reading");
}

TEST(ScenarioEffectError, ChecksThePlace) {
  EXPECT_EQ(EffectError("name = \"psd_roll\"\n"),
            "s.toml:2: psd_roll: where is missing; expected \"psd_a\" or \"psd_b\"");
  EXPECT_EQ(EffectError("name = \"psd_roll\"\nwhere = \"psd_c\"\n"),
            "s.toml:4: psd_roll: where is \"psd_c\"; expected \"psd_a\" or \"psd_b\"");
  EXPECT_EQ(EffectError("name = \"settling\"\nwhere = \"target\"\n"),
            "s.toml:4: the effect settling takes no where; expected name, amplitude_arcsec, time_constant_s");
}

TEST(ScenarioEffectError, ChecksBoundsInTheUnitOfTheKey) {
  EXPECT_EQ(EffectError("name = \"psd_roll\"\nwhere = \"psd_a\"\nroll_mrad = 501\n"),
            "s.toml:5: psd_roll: roll_mrad is 501; expected a number of mrad from -500 to 500");
  EXPECT_EQ(EffectError("name = \"laser_drift\"\nwhere = \"yaw\"\ndrift_urad_per_h = inf\n"),
            "s.toml:5: laser_drift: drift_urad_per_h is inf; expected a number of urad_per_h from -10000 to 10000");
}

// --- fixtures ---

TEST(Scenario, TakesFixturesAsBoxesAndMeshFiles) {
  const TemporaryFolder folder;
  const std::string mesh = folder.Write("housing.stl", "solid");
  const std::string text = std::string(kBench) + R"([[fixture]]
name = "plate"
box_mm = [40, 2, 30]
position_mm = [10, 20, 30]
yaw_deg = -15
[[fixture]]
name = "housing"
mesh_file = "housing.stl"
mesh_unit_mm = 25.4
rides_on_grating = true
)";
  const Scenario s = ParseScenario(text, "s.toml", folder.path());
  ASSERT_EQ(s.fixtures.size(), 2u);
  EXPECT_EQ(s.fixtures[0].box_m, Vector3(40.0 * units::mm, 2.0 * units::mm, 30.0 * units::mm));
  EXPECT_EQ(s.fixtures[0].position_m.z(), 30.0 * units::mm);
  EXPECT_EQ(s.fixtures[0].yaw_rad, -15.0 * units::deg);
  EXPECT_FALSE(s.fixtures[0].rides_on_grating);
  EXPECT_EQ(s.fixtures[0].location, "s.toml:2");
  EXPECT_EQ(s.fixtures[1].mesh_file, mesh);
  EXPECT_EQ(s.fixtures[1].mesh_unit_m, 25.4 * units::mm);
  EXPECT_TRUE(s.fixtures[1].rides_on_grating);
  EXPECT_TRUE(ParseScenario(text, "s.toml", folder.path(), {"fixture=[]"}).fixtures.empty());
}

TEST(ScenarioFixtureError, SaysWhatIsWrongWithAFixture) {
  const auto error = [](const std::string& lines) { return ErrorOf("[[fixture]]\n" + lines); };
  EXPECT_EQ(error("box_mm = [1, 1, 1]\n"), "s.toml:2: the fixture has no name; expected name = \"housing\"");
  EXPECT_EQ(error("name = \"plate\"\n"),
            "s.toml:2: the fixture plate has neither box_mm nor mesh_file; expected one of them");
  EXPECT_EQ(error("name = \"plate\"\nbox_mm = [1, 1, 1]\nmesh_file = \"a.stl\"\n"),
            "s.toml:2: the fixture plate has both box_mm and mesh_file; expected one of them");
  EXPECT_EQ(error("name = \"plate\"\nbox_mm = [1, 0, 1]\n"),
            "s.toml:4: fixture.box_mm is 0; expected a number of mm above 0 and up to 5000");
  EXPECT_EQ(error("name = \"plate\"\nbox_mm = [1, 1]\n"),
            "s.toml:4: fixture.box_mm has 2 entries; expected a list of 3, each a number of mm above 0 and up to "
            "5000");
  EXPECT_EQ(error("name = \"plate\"\nbox_um = [1, 1, 1]\n"),
            "s.toml:4: the key fixture.box_um has the wrong unit; expected fixture.box_mm");
  EXPECT_EQ(error("name = \"plate\"\npositon_mm = [1, 1, 1]\n"),
            "s.toml:4: unknown key fixture.positon_mm; expected a known one; the nearest is fixture.position_mm");
  EXPECT_THAT(
      error("name = \"plate\"\nmesh_file = \"none.stl\"\n"),
      testing::MatchesRegex("s.toml:2: fixture.mesh_file: the file /.*none.stl cannot be read; expected .*"));
  EXPECT_EQ(ErrorOf("[fixture]\nname = \"plate\"\n"), "s.toml:2: fixture is a table; expected [[fixture]] blocks");
  EXPECT_EQ(ErrorOf("fixture = [1]\n"), "s.toml:2: fixture is 1; expected [[fixture]] blocks");
}

// --- help ---

TEST(ScenarioHelp, HasEveryKeyWithUnitDefaultBoundsAndMeaning) {
  const std::string help = DescribeScenarioKeys();
  EXPECT_THAT(help, HasSubstr("[laser]\nwavelength_nm = 650\n    in air; a number of nm from 200 to 2000\n"));
  EXPECT_THAT(help, HasSubstr("\n[target.random]\nex_arcsec = 0\n"));
  EXPECT_THAT(help, HasSubstr("name = \"psd_roll\"\nwhere\n    \"psd_a\" or \"psd_b\"\nroll_mrad = 5\n"));
  EXPECT_THAT(help, HasSubstr("shifts = [0, 1, 7, 11]\n"));
  EXPECT_THAT(help, HasSubstr("box_mm = [20, 20, 20]\n    edges of a box, centred on its position; a list of 3, "));
}

TEST(EditDistance, CountsASwapOfNeighboursOnce) {
  EXPECT_EQ(EditDistance("gian", "gain"), 1);
  EXPECT_EQ(EditDistance("kitten", "sitting"), 3);
  EXPECT_EQ(EditDistance("", "abc"), 3);
  EXPECT_EQ(Nearest("lasr", {"adc", "laser"}), "laser");
  EXPECT_EQ(Nearest("lasr", {}), "");
}

}  // namespace
std::string ErrorOfTurntable(const std::string& procedure) {
  const std::string text = "bench = \"turntable_autocollimator\"\n[turntable_procedure]\n" + procedure + "\n";
  return MessageOf([&] { ParseScenario(text, "s.toml", "."); });
}

TEST(ScenarioError, WantsTurntablePositionsAWholeNumberOfTeethApart) {
  EXPECT_EQ(ErrorOfTurntable("positions = 50"),
            "s.toml:3: 50 positions are no whole number of teeth apart; expected a divisor of the 360 teeth");
  EXPECT_EQ(ErrorOfTurntable("verification_positions = 300"),
            "s.toml:3: 300 check positions; expected at most 288: the teeth that are no position");
  EXPECT_EQ(ErrorOfTurntable("shifts_teeth = [360]"),
            "s.toml:3: turntable_procedure.shifts_teeth has 360; expected shifts from 0 to 359");
}

TEST(ScenarioError, WantsOneEntryASetUpOrOneForAll) {
  EXPECT_EQ(ErrorOfTurntable("tilts_arcsec = [60, 100, 30]\nshifts_teeth = [0, 5]"),
            "s.toml:4: turntable_procedure.shifts_teeth has 2 entries for 3 set-ups; expected 1 or 3");
  EXPECT_EQ(ErrorOfTurntable("passes = [1, 0]"),
            "s.toml:3: turntable_procedure.passes has 0; expected directions 1 or -1");
}

TEST(ScenarioError, WantsWholeNumbersOfLinesBetweenSamplesOfTheHobbingMachine) {
  const auto error = [](const std::string& keys) {
    return MessageOf([&] { ParseScenario("bench = \"hob_transmission\"\n" + keys, "s.toml", "."); });
  };
  EXPECT_EQ(error("hob_procedure.samples_per_turn = 700"),
            "s.toml:2: 700 samples a turn; expected a divisor of the 18000 lines of the table's encoder");
  EXPECT_EQ(error("transmission.harmonics = [{ component = \"ex\", order = 1, amplitude_arcsec = 1 }]"),
            "s.toml:2: transmission.harmonics has a harmonic of another component; expected \"ez\"");
}

TEST(Scenario, OfTheTurntableNamesItsTablesByTheirOwnNames) {
  const Scenario s = ParseScenario(
      "bench = \"turntable_autocollimator\"\n"
      "turntable.harmonics = [{ order = 2, amplitude_arcsec = 3.0 }]\n"
      "multitooth = { teeth = 720, repeatability.ez_arcsec = 0.05 }\n",
      "s.toml", ".");
  EXPECT_EQ(TurntableOf(s).turntable.harmonics.at(0).component, Component::kEz)
      << "of the index error if nothing is said";
  EXPECT_DOUBLE_EQ(TurntableOf(s).turntable.harmonics.at(0).amplitude, 3.0 * units::arcsec);
  EXPECT_EQ(TurntableOf(s).multitooth.teeth, 720);
  EXPECT_DOUBLE_EQ(TurntableOf(s).multitooth_table.repeatability_sd[static_cast<std::size_t>(Component::kEz)],
                   0.05 * units::arcsec);
}

}  // namespace twinbench
