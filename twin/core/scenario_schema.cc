#include "twin/core/scenario_schema.h"

#include <fmt/format.h>

#include "twin/core/bench_format.h"
#include "twin/core/schema_table.h"

namespace twinbench {
namespace {

using namespace schema;

void AddTop(Keys& keys, Scenario& s) {
  Table t(keys, "");
  t.Text("bench", &s.bench, BenchNames(), "kind of bench");
  t.Text("title", &s.title, {}, "one line for reports");
  t.Add("seed", kPure, {}, &s.seed, "of every random stream");
  t.Add("repeat", kPure, {0, 1e9}, &s.repeat, "which run of the same bench: noise differs, what it was made with does not");
  t.Flag("noise_free", s.noise_free, "no random contribution and no quantisation");
}

/// Of all benches; which of them a scenario's own bench has is checked when a block is read.
std::vector<std::string> AllChannels() {
  std::vector<std::string> channels;
  for (const BenchFormat* format : BenchFormats())
    channels.insert(channels.end(), format->channels.begin(), format->channels.end());
  return channels;
}

}  // namespace

bool Bounds::Contain(double value) const {
  return value <= upper && (above_lower ? value > lower : value >= lower);
}

std::string Bounds::Text() const {
  if (lower == Bounds{}.lower && upper == Bounds{}.upper) return "";
  if (above_lower) return fmt::format(" above {:.15g} and up to {:.15g}", lower, upper);
  return fmt::format(" from {:.15g} to {:.15g}", lower, upper);
}

std::vector<ScenarioKey> KeysOf(Scenario& s) {
  Keys keys;
  AddTop(keys, s);
  FormatOf(s.bench).add_keys(keys, s);
  return keys;
}

std::vector<ScenarioKey> KeysOf(FixtureSettings& s) {
  Keys keys;
  Table t(keys, "fixture");
  t.Text("name", &s.name, {}, "for messages");
  t.Add("box", kMm, Positive(5000), List(s.box_m), "edges of a box, centred on its position");
  t.Text("mesh_file", &s.mesh_file, {}, "or an STL file, from the scenario's folder");
  t.Add("mesh_unit", kMm, Positive(1e6), &s.mesh_unit_m, "what the number 1 in the file means");
  t.Add("position", kMm, Within(5000), List(s.position_m), "of the box's centre or the file's origin: x, y, z");
  t.Add("yaw", kDeg, Within(360), &s.yaw_rad, "about z");
  t.Flag("rides_on_grating", s.rides_on_grating, "fixed to the grating, its place given in G; else in L");
  return keys;
}

std::vector<ScenarioKey> KeysOf(EmpiricalSettings& s) {
  Keys keys;
  Table t(keys, "empirical");
  t.Text("signature", &s.signature, {}, "what the signal looks like, in words");
  t.Text("channel", &s.channel, AllChannels(), "to which it is added");
  t.Text("by", &s.by, {"reading", "time"}, "what it is tabulated by; between two times it goes straight");
  t.Add("reading", kPure, UpTo(kHuge), &s.reading, "by reading: numbers of those that have it, each once");
  t.Add("time", kSecond, Within(kHuge), &s.time_s, "by time: ascending; by reading: when they were taken");
  t.Add("value", kUm, Within(1e6), &s.value_m, "the signal at these readings or times, on a PSD");
  t.Add("value", kDeg, Within(360), &s.value_rad, "the same of an angle");
  t.Add("value", kPure, Within(1e6), &s.value, "the same of what its column has in another unit");
  t.Text("provenance", &s.provenance, {}, "which run showed it, and when it was diagnosed");
  return keys;
}

}  // namespace twinbench
