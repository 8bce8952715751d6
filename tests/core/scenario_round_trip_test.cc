#include <random>

#include "tests/core/input_error.h"
#include "twin/benches/circular_motion/settings.h"
#include "twin/benches/encoder_comparison/settings.h"
#include "twin/benches/hob_transmission/settings.h"
#include "twin/benches/names.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/turntable_autocollimator/settings.h"
#include "twin/core/scenario_schema.h"
#include "twin/core/signal_effect.h"

namespace twinbench {
namespace {

using Random = std::mt19937_64;

/// Within the bounds of a key, in SI; not the bounds themselves.
double AnyNumber(const Bounds& bounds, double to_SI, Random& random) {
  const double lower = std::max(bounds.lower, -1e12), upper = std::min(bounds.upper, 1e12);
  return std::uniform_real_distribution<double>(lower, upper)(random) * to_SI;
}

int AnyWholeNumber(const Bounds& bounds, Random& random) {
  return std::uniform_int_distribution<int>(static_cast<int>(bounds.lower), static_cast<int>(bounds.upper))(random);
}

TableErrors AnyErrors(Random& random) {
  TableErrors errors;
  std::normal_distribution<double> normal;
  for (int i = 0; i < 12; ++i) {
    errors.position_rad.push_back(normal(random));
    for (auto& column : errors.value) column.push_back(1e-5 * normal(random));
  }
  return errors;
}

CompensationTable AnyCompensation(Random& random) {
  CompensationTable compensation;
  std::normal_distribution<double> normal;
  for (int i = 0; i < 12; ++i) {
    compensation.position_rad.push_back(0.5 * i + 0.01 * std::abs(normal(random)));
    compensation.correction_rad.push_back(1e-5 * normal(random));
  }
  return compensation;
}

/// Gives every place a random value that the key allows: one overload a type.
struct Randomise {
  const ScenarioKey& key;
  Random& random;
  const std::string& file;  // that exists

  void operator()(double* field) const { *field = AnyNumber(key.bounds, key.unit.to_SI, random); }
  void operator()(int* field) const { *field = AnyWholeNumber(key.bounds, random); }
  void operator()(std::uint64_t* field) const { *field = random(); }
  void operator()(bool* field) const { *field = random() % 2 == 0; }
  void operator()(std::string* field) const {
    if (!key.choices.empty() && key.name != "bench") *field = key.choices[random() % key.choices.size()];
    if (key.name == "title") *field = "a \"b\" \\ c\n\t\x01 \xC3\xA9 # [x] = 1";
    if (key.name.ends_with("_file") && key.name != "errors_file" && key.name != "compensation_file") *field = file;
  }
  void operator()(std::span<double> field) const {
    for (double& entry : field) (*this)(&entry);
  }
  void operator()(std::vector<double>* field) const {
    const bool one_a_setup = key.table == "turntable_procedure" && key.name != "dwell";
    field->resize(one_a_setup ? 3 : 1 + random() % 5);
    (*this)(std::span<double>(*field));
  }
  void operator()(std::vector<int>* field) const {
    if (key.name.ends_with("passes")) *field = {-1, 1, 1};
    if (key.name == "shifts") *field = {1, 0};
    if (key.name == "shifts_teeth") *field = {1, 0, 7};
  }
  void operator()(std::vector<std::string>* field) const {
    if (key.name == "scan_list") {
      std::shuffle(field->begin(), field->end(), random);
      return;
    }
    *field = {key.choices[random() % key.choices.size()], key.choices[0]};
  }
  void operator()(std::vector<HarmonicSettings>* field) const {
    const bool of_a_table =
        std::set<std::string>{"target", "reference", "turntable", "multitooth"}.contains(key.table);
    for (int i = 0; i < 4; ++i)
      field->push_back({of_a_table ? static_cast<Component>(random() % kComponents) : Component::kEz, 0.1 * i,
                        AnyNumber({-1e-4, 1e-4}, 1, random), AnyNumber({-7, 7}, 1, random)});
  }
  void operator()(std::optional<TableErrors>* field) const { *field = AnyErrors(random); }
  void operator()(std::optional<CompensationTable>* field) const { *field = AnyCompensation(random); }
  void operator()(const RecordList& list) const {
    list.start_anew(3);
    for (std::size_t i = 0; i < list.size(); ++i) {
      for (const ScenarioKey& inner : list.keys_of(i)) std::visit(Randomise{inner, random, file}, inner.field);
    }
  }
};

/// Every bit of what a key is bound to, or of what a block holds.
struct Bits {
  std::vector<std::string> parts;
  bool operator==(const Bits&) const = default;

  template <class Place>
  void operator()(const Place* place) {
    Add(*place);
  }
  void operator()(std::span<double> place) { Add(place); }
  void operator()(const RecordList& list) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      for (const ScenarioKey& inner : list.keys_of(i)) std::visit(*this, inner.field);
    }
    Add(list.size());
  }

  template <class Number>
  requires(std::is_arithmetic_v<Number> || std::is_enum_v<Number>) void Add(Number number) {
    parts.emplace_back(reinterpret_cast<const char*>(&number), sizeof number);
  }
  void Add(const std::string& text) { parts.push_back(text); }
  template <std::ranges::range List>
  void Add(const List& list) {
    Add(std::ranges::size(list));
    for (const auto& entry : list) Add(entry);
  }
  template <class One>
  void Add(const std::optional<One>& one) {
    if (one) Add(*one);
  }
  void Add(const std::pair<const std::string, double>& named) { All(named.first, named.second); }
  void Add(const HarmonicSettings& h) { All(h.component, h.order, h.amplitude, h.phase_rad); }
  void Add(const TableErrors& errors) { All(errors.position_rad, errors.value); }
  void Add(const CompensationTable& table) { All(table.position_rad, table.correction_rad); }
  void Add(const EffectFinding& f) { All(f.u, f.log_evidence, f.probability, f.provenance); }
  void Add(const EffectSettings& effect) { All(effect.name, effect.where, effect.parameters, effect.finding); }
  template <class... Parts>
  void All(const Parts&... all) {
    (Add(all), ...);
  }
};

/// Of all places that the keys of a description are bound to.
void ExpectSameBits(const std::vector<ScenarioKey>& keys_a, const std::vector<ScenarioKey>& keys_b) {
  for (std::size_t i = 0; i < keys_a.size(); ++i) {
    Bits bits_a, bits_b;
    std::visit(bits_a, keys_a[i].field);
    std::visit(bits_b, keys_b[i].field);
    EXPECT_TRUE(bits_a == bits_b) << keys_a[i].Path();
  }
}

void ExpectSameBits(Scenario a, Scenario b) {
  ExpectSameBits(KeysOf(a), KeysOf(b));
  ASSERT_EQ(a.fixtures.size(), b.fixtures.size());
  for (std::size_t i = 0; i < a.fixtures.size(); ++i) ExpectSameBits(KeysOf(a.fixtures[i]), KeysOf(b.fixtures[i]));
  ASSERT_EQ(a.effects.size(), b.effects.size());
  for (std::size_t i = 0; i < a.effects.size(); ++i) {
    Bits bits_a, bits_b;
    bits_a(&a.effects[i]);
    bits_b(&b.effects[i]);
    EXPECT_TRUE(bits_a == bits_b) << a.effects[i].name;
  }
  ASSERT_EQ(a.empiricals.size(), b.empiricals.size());
  for (std::size_t i = 0; i < a.empiricals.size(); ++i)
    ExpectSameBits(KeysOf(a.empiricals[i]), KeysOf(b.empiricals[i]));
}

EffectFinding AnyFinding(const EffectEntry& entry, Random& random) {
  EffectFinding finding;
  for (const EffectParameter& p : entry.parameters) finding.u[p.name] = AnyNumber({0.0, p.upper_SI}, 1.0, random);
  finding.log_evidence = AnyNumber({-50, 1000}, 1.0, random);
  finding.probability = AnyNumber({0, 1}, 1.0, random);
  finding.provenance = "run \"a\"";
  return finding;
}

EffectSettings AnyEffect(const EffectEntry& entry, Random& random) {
  EffectSettings effect;
  effect.name = entry.name;
  if (!entry.places.empty()) effect.where = entry.places[random() % entry.places.size()];
  for (const EffectParameter& p : entry.parameters)
    effect.parameters[p.name] =
        p.BelongsTo(effect.where) ? AnyNumber({p.lower_SI, p.upper_SI}, 1.0, random) : p.default_SI;
  if (random() % 2 == 0) effect.finding = AnyFinding(entry, random);
  return effect;
}

EmpiricalSettings AnyEmpirical(const std::string& bench, Random& random) {
  EmpiricalSettings empirical;
  empirical.signature = "order 7 synchronous with the \"reference\" angle";
  const std::vector<std::string>& channels = FormatOf(bench).channels;
  empirical.channel = channels[random() % channels.size()];
  if (random() % 2 == 0) empirical.by = "time";
  for (int i = 0; i < 5; ++i) {
    if (empirical.by == "reading") empirical.reading.push_back(3 * i);
    empirical.time_s.push_back(AnyNumber({10.0 * i, 10.0 * i + 9.0}, 1.0, random));
    ValuesOf(empirical, FormatOf(bench).signal).push_back(AnyNumber({-1e-5, 1e-5}, 1.0, random));
  }
  empirical.provenance = "a run";
  return empirical;
}

FixtureSettings AnyFixture(bool is_box, Random& random, const std::string& file) {
  FixtureSettings fixture;
  for (const ScenarioKey& key : KeysOf(fixture)) std::visit(Randomise{key, random, file}, key.field);
  fixture.name = "\"a\" housing";
  if (is_box) {
    fixture.mesh_file.clear();
    fixture.mesh_unit_m = FixtureSettings{}.mesh_unit_m;
  } else {
    fixture.box_m = FixtureSettings{}.box_m;
  }
  return fixture;
}

/// What the loader wants of keys together.
void MakeWholeTeethAndLines(Scenario& s) {
  if (s.bench == kRotaryBench) {
    MechanicsSettings& m = RotaryOf(s).mechanics;
    m.encoder_periods = 100;
    RotaryOf(s).chain.dnl_lsb = 0.0;  // a file says it
    m.vibration_velocity_m_s.resize(m.vibration_frequency_Hz.size(), 1e-6);
  }
  // A spindle that coasts must not stop; tests/own_scenario has its keys.
  if (s.bench == kEncoderBench && EncoderOf(s).encoder_procedure.kind == "coast")
    EncoderOf(s).encoder_procedure.kind = "sweep";
  if (s.bench == kEncoderBench) {
    EncoderProcedureSettings& p = EncoderOf(s).encoder_procedure;
    p.read_s = 0.5 * p.stop_interval_s / p.readings_per_stop;  // they have to fit into a stop
    p.turns = std::min(p.turns, 0.5);                          // and all of them into memory
    p.stops = std::min(p.stops, 360);
  }
  if (s.bench == kHobBench) HobOf(s).table_encoder.lines = 5 * HobOf(s).hob_procedure.samples_per_turn;
  // Bodies and the closed form of what they do exclude each other; tests/own_scenario has every key of either.
  if (s.bench == kCircularBench) CircularOf(s).mechanics.fidelity = "kinematic";
  if (s.bench != kTurntableBench) return;
  TurntableOf(s).multitooth.teeth = 360;
  TurntableOf(s).turntable_procedure.positions = 72;
  TurntableOf(s).turntable_procedure.verification_positions = 100;
  TurntableOf(s).polygon.faces = 0;
  TurntableOf(s).turntable_procedure.polygon_offsets_rad = {0.0};
}

Scenario AnyScenario(const std::string& bench, Random& random, const std::string& file) {
  Scenario scenario;
  scenario.bench = bench;
  for (const ScenarioKey& key : KeysOf(scenario)) std::visit(Randomise{key, random, file}, key.field);
  MakeWholeTeethAndLines(scenario);
  for (const bool is_box : {true, false}) {
    if (bench == kRotaryBench) scenario.fixtures.push_back(AnyFixture(is_box, random, file));
  }
  for (const EffectEntry& entry : EffectCatalogue(bench)) scenario.effects.push_back(AnyEffect(entry, random));
  for (int i = 0; i < 2; ++i) scenario.empiricals.push_back(AnyEmpirical(scenario.bench, random));
  return scenario;
}

TEST(WriteScenario, IsReadBackToTheSameBitsForEveryKey) {
  const TemporaryFolder folder;
  const std::string file = folder.Write("exists.txt", "x");
  Random random(5);
  for (int run = 0; run < 30; ++run) {
    const std::vector<std::string> benches = BenchNames();
    const Scenario scenario = AnyScenario(benches[run % benches.size()], random, file);
    ExpectSameBits(ParseScenario(WriteScenario(scenario), "resolved.toml", "/elsewhere"), scenario);
  }
}

TEST(WriteScenario, OfTheDefaultsIsReadBackAndReadsWell) {
  Scenario defaults;
  defaults.bench = kRotaryBench;
  const std::string text = WriteScenario(defaults);
  EXPECT_THAT(text,
              testing::StartsWith(
                  "bench = \"rotary_4dof\"\ntitle = \"\"\nseed = 1\nrepeat = 0\nnoise_free = false\n\n[laser]\n"
                  "wavelength_nm = 650.0\npower_mW = 5.0\n"));
  EXPECT_THAT(text, testing::HasSubstr("sweep_arcsec = 300.0\n"));
  ExpectSameBits(ParseScenario(text, "resolved.toml", "."), defaults);
  EXPECT_EQ(WriteScenario(ParseScenario(text, "resolved.toml", ".")), text);
}

}  // namespace
}  // namespace twinbench
