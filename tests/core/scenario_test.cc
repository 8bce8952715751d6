#include <fmt/ranges.h>

#include "tests/core/input_error.h"
#include "tests/core/refusals.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/core/bench_format.h"
#include "twin/core/nearest_key.h"

namespace twinbench {
namespace {

using testing::ElementsAre, testing::FieldsAre, testing::HasSubstr, testing::StartsWith;

constexpr const char* kBench = "bench = \"rotary_4dof\"\n";

Scenario Parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return ParseScenario(kBench + text, "s.toml", ".", overrides);
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
  const std::tuple<const char*, double (*)(const RotarySettings&), double> keys[] = {
      {"laser.wavelength_nm = 635", [](const auto& s) { return s.laser.wavelength_m; }, 635.0 * units::nm},
      {"laser.position_mm = [1, 200.5, -2]", [](const auto& s) { return s.laser.position_m.y(); },
       200.5 * units::mm},
      {"grating.lines_per_mm = 1200", [](const auto& s) { return s.grating.lines_per_m; }, 1200e3},
      {"psd_b.roll_mrad = -3.5", [](const auto& s) { return s.psd_b.roll_rad; }, -3.5 * units::mrad},
      {"psd_b.roll_mrad = -3.5", [](const auto& s) { return s.psd_a.roll_rad; }, 0.0},
      {"amplifier.noise_mV = 6.5", [](const auto& s) { return s.amplifier.noise_V; }, 6.5 * units::mV},
      {"amplifier.offset_mV = [1, 2, 3, 4]", [](const auto& s) { return s.amplifier.offset_V[3]; },
       4.0 * units::mV},
      {"adc.rate_kHz = 100", [](const auto& s) { return s.adc.rate_Hz; }, 100e3},
      {"reference.height_mm = 81", [](const auto& s) { return s.reference_height_m; }, 81.0 * units::mm},
      {"reference.centring_um = [10, -20]", [](const auto& s) { return s.centring_m.y(); }, -20.0 * units::um},
      {"reference.seating.ez_arcsec = 0.25", [](const auto& s) { return s.reference.seating_sd[2]; },
       0.25 * units::arcsec},
      {"reference.seating.dx_um = 1.5", [](const auto& s) { return s.reference.seating_sd[3]; }, 1.5 * units::um},
      {"target.random.ey_arcsec = 3", [](const auto& s) { return s.target.random_rms[1]; }, 3.0 * units::arcsec},
      {"target.random.orders = 5", [](const auto& s) { return double(s.target.random_orders); }, 5.0},
      {"mechanics.radial_stiffness_N_um = [90, 50]",
       [](const auto& s) { return s.mechanics.radial_stiffness_N_m[0]; }, 90e6},
      {"mechanics.tilt_stiffness_Nm_mrad = [500, 200]",
       [](const auto& s) { return s.mechanics.tilt_stiffness_Nm_rad[1]; }, 0.2e6},
      {"procedure.sweep_arcsec = 200", [](const auto& s) { return s.procedure.sweep_rad; }, 200.0 * units::arcsec}};
  for (const auto& [text, value_of, expected] : keys) EXPECT_EQ(value_of(RotaryOf(Parse(text))), expected) << text;
}

TEST(Scenario, TakesHarmonicsInTheUnitOfTheirComponent) {
  const Scenario s = Parse(R"([target]
harmonics = [ { component = "ez", order = 1, amplitude_arcsec = 5.0, phase_deg = 30.0 },
              { component = "dy", order = 2.5, amplitude_um = -1.5 } ]
)");
  EXPECT_THAT(RotaryOf(s).target.harmonics,
              ElementsAre(FieldsAre(Component::kEz, 1.0, 5.0 * units::arcsec, 30.0 * units::deg),
                          FieldsAre(Component::kDy, 2.5, -1.5 * units::um, 0.0)));
}

TEST(Scenario, TakesEffectsOfItsOwnBenchWithTheDefaultsOfTheCatalogue) {
  const Scenario s = Parse(R"([[effect]]
name = "laser_drift"
where = "pitch"
drift_urad_per_h = 36

[[effect]]
name = "backlash"
[[effect]]
name = "tone"
)");
  const auto at = [](const char* where) { return testing::Field(&EffectSettings::where, where); };
  ASSERT_THAT(s.effects, ElementsAre(at("pitch"), at("target"), at("all")));
  EXPECT_EQ(s.effects[0].name, "laser_drift");
  EXPECT_EQ(s.effects[0].location, "s.toml:2");
  EXPECT_DOUBLE_EQ(s.effects[0].parameters.at("drift"), 1e-8);
  EXPECT_EQ(s.effects[0].parameters.at("curvature"), 0.0);
  EXPECT_EQ(s.effects[1].parameters.at("half_width"), 1.0 * units::arcsec);
  const Scenario other = ParseScenario(
      "bench = \"encoder_comparison\"\n[[effect]]\nname = \"backlash\"\nwidth_deg = 0.5\n", "s.toml", ".", {});
  EXPECT_EQ(other.effects.at(0).parameters.at("width"), 0.5 * units::deg) << "not half_width_arcsec";
}

TEST(Scenario, TakesTheErrorsOfATableFromItsFolderOrInline) {
  const TemporaryFolder folder;
  folder.Write("t.csv", "position_deg,ez_arcsec\n0,1\n180,-1\n");
  const std::string path = folder.Write("s.toml", std::string(kBench) + "[target]\nerrors_file = \"t.csv\"\n");
  const Scenario s = LoadScenario(path);
  ASSERT_TRUE(RotaryOf(s).target.errors.has_value());
  EXPECT_EQ((*RotaryOf(s).target.errors)[Component::kEz][1], -1.0 * units::arcsec);
  EXPECT_TRUE(RotaryOf(s).target.errors_file.empty());
  EXPECT_FALSE(RotaryOf(s).reference.errors.has_value());
  const Scenario told = Parse("[reference.errors]\nposition_deg = [0, 90]\ndx_um = [1, 2]\n");
  EXPECT_EQ(RotaryOf(told).reference.errors->position_rad[1], 90.0 * units::deg);
  EXPECT_EQ((*RotaryOf(told).reference.errors)[Component::kDx][1], 2.0 * units::um);
  EXPECT_EQ((*RotaryOf(told).reference.errors)[Component::kEx], (std::vector<double>{0.0, 0.0}));
}

// --- overrides ---

TEST(ScenarioOverride, WinsOverTheFileAndOverEarlierOnes) {
  const Scenario s = Parse("[procedure]\npositions = 24\nsweep_arcsec = 100\n",
                           {"procedure.positions=48", "procedure.positions=72", "laser.wavelength_nm = 640"});
  EXPECT_EQ(RotaryOf(s).procedure.positions, 72);
  EXPECT_EQ(RotaryOf(s).procedure.sweep_rad, 100.0 * units::arcsec);
  EXPECT_EQ(RotaryOf(s).laser.wavelength_m, 640.0 * units::nm);
}

TEST(ScenarioOverride, ReplacesListsAsAWholeAndNeedsNoQuotesForAWord) {
  const std::string text =
      "[target]\nharmonics = [{ component = \"ez\", order = 1, amplitude_arcsec = 5.0 }]\n"
      "[[effect]]\nname = \"settling\"\n";
  EXPECT_EQ(RotaryOf(Parse(text)).target.harmonics.size(), 1u);
  EXPECT_TRUE(RotaryOf(Parse(text, {"target.harmonics=[]"})).target.harmonics.empty());
  EXPECT_TRUE(Parse(text, {"effect=[]"}).effects.empty());
  EXPECT_THAT(RotaryOf(Parse(text, {"procedure.shifts=[0, 5]"})).procedure.shifts, ElementsAre(0, 5));
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

TEST(ScenarioOverride, IsNamedWhenItIsWrong) {
  const auto error = [](const std::string& override_text) {
    return MessageOf([&] { Parse("", {override_text}); });
  };
  for (const std::string wrong :
       {"procedure.positions=1", "procedure.positons=12", "positions", "laser=5", "procedure.positions=8"}) {
    EXPECT_THAT(error(wrong), StartsWith("--set " + wrong + ": "));
    EXPECT_KEPT(error(wrong));
  }
  EXPECT_THAT(error("title=two words"), StartsWith("--set title=two words: this is not TOML; expected key="));
}

// --- bad input: where, what, expected ---

TEST(ScenarioError, GivesTheLineOfASyntaxErrorAndAsksForABench) {
  EXPECT_KEPT(MessageOf([] { WriteScenario(Scenario{}); }));
  EXPECT_THAT(MessageOf([] { Parse("seed = \n"); }), StartsWith("s.toml:2: "));
  EXPECT_THAT(MessageOf([] { Parse("seed = 1\nseed = 2\n"); }), StartsWith("s.toml:3: "));
}

TEST(ScenarioError, NamesFilesThatCannotBeRead) {
  const TemporaryFolder folder;
  ExpectRefused(
      "s.toml",
      [&](const auto& text) { return MessageOf([&] { ParseScenario(kBench + text, "s.toml", folder.path()); }); },
      {{3, "[target]\nerrors_file = \"no_such.csv\"\n"}, {3, "[environment]\ntemperature_file = \"no_such.csv\"\n"},
       {3, "[laser]\nbeam = \"profile\"\n"}, {2, "[[fixture]]\nname = \"plate\"\nmesh_file = \"none.stl\"\n"}});
  EXPECT_KEPT(MessageOf([] { LoadScenario("no_such.toml"); }));
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

// --- help ---

TEST(ScenarioHelp, HasEveryKeyWithUnitDefaultBoundsAndMeaning) {
  const std::string help = DescribeScenarioKeys();
  for (const char* part : {"[laser]\nwavelength_nm = 650\n    in air; a number of nm from 200 to 2000\n",
                           "\n[target.random]\nex_arcsec = 0\n", "shifts = [0, 1, 7, 11]\n", "[[empirical]]",
                           "name = \"psd_roll\"\nwhere\n    \"psd_a\" or \"psd_b\"\nroll_mrad = 5\n",
                           "box_mm = [20, 20, 20]\n    edges of a box, centred on its position; a list of 3, "})
    EXPECT_THAT(help, HasSubstr(part));
}

TEST(EditDistance, CountsASwapOfNeighboursOnce) {
  EXPECT_EQ(EditDistance("gian", "gain"), 1);
  EXPECT_EQ(EditDistance("kitten", "sitting"), 3);
  EXPECT_EQ(EditDistance("", "abc"), 3);
  EXPECT_EQ(Nearest("lasr", {"adc", "laser"}), "laser");
  EXPECT_EQ(Nearest("lasr", {}), "");
  EXPECT_EQ(Nearest("rotary", {"bar", "rotary_4dof"}), "rotary_4dof") << "it begins so";
}

TEST(EffectCatalogue, HasTheEffectsOfItsBenchOnly) {
  for (const std::string& bench : BenchNames()) {
    std::set<std::string> names;
    for (const EffectEntry& entry : EffectCatalogue(bench)) names.insert(entry.name);
    EXPECT_KEPT(fmt::format("{}: {}", bench, fmt::join(names, ", ")));
  }
  EXPECT_EQ(FindEffect("psd_gain", "encoder_comparison"), nullptr);
  EXPECT_THROW(EffectCatalogue("lathe"), InputError);
}

TEST(EffectCatalogue, HasDefaultsWithinBoundsAndPlacesThatExist) {
  for (const std::string& bench : BenchNames()) {
    for (const EffectEntry& entry : EffectCatalogue(bench)) {
      SCOPED_TRACE(bench + " " + entry.name);
      const std::set<std::string> places(entry.places.begin(), entry.places.end());
      EXPECT_FALSE(entry.title.empty());
      EXPECT_TRUE(entry.default_place.empty() || places.contains(entry.default_place));
      for (const EffectParameter& parameter : entry.parameters) {
        EXPECT_TRUE(std::isfinite(parameter.default_SI)) << parameter.name;
        EXPECT_LE(parameter.lower_SI, parameter.default_SI) << parameter.name;
        EXPECT_GE(parameter.upper_SI, parameter.default_SI) << parameter.name;
        for (const std::string& place : parameter.only_at) EXPECT_TRUE(places.contains(place));
      }
    }
  }
}

/// One scenario of tests/data/refused_scenarios.txt.
struct RefusedScenario {
  std::string checked, place, text;
};

std::vector<RefusedScenario> RefusedScenarios() {
  std::vector<RefusedScenario> all;
  std::ifstream file(TWINBENCH_TEST_DATA "/refused_scenarios.txt");
  std::string checked;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("## "))
      checked = line.substr(3);
    else if (line.starts_with("=>"))
      all.push_back({checked, "s.toml:" + (line.size() > 3 ? line.substr(3) + ": " : ""), ""});
    else if (!checked.empty() && !all.empty())
      all.back().text += line + "\n";
  }
  return all;
}

TEST(RefusedScenario, IsToldByPlaceFaultAndWhatWasExpected) {
  const std::vector<RefusedScenario> all = RefusedScenarios();
  EXPECT_GE(all.size(), 114u);
  for (const RefusedScenario& one : all) {
    const std::string message = MessageOf([&] { ParseScenario(one.text, "s.toml", "."); });
    EXPECT_THAT(message, testing::StartsWith(one.place)) << one.checked << "\n" << one.text;
    EXPECT_KEPT(message) << one.checked << "\n" << one.text;
  }
}

}  // namespace
}  // namespace twinbench
