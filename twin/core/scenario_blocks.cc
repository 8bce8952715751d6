#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "twin/core/bench_format.h"
#include "twin/core/errors.h"
#include "twin/core/scenario_reader.h"
#include "twin/core/scenario_values.h"
#include "twin/core/signal_effect.h"

namespace twinbench {
namespace {

/// Key of the values in a file.
std::string ValueKey(SignalKind kind) {
  if (kind == SignalKind::kOwn) return "value";
  return kind == SignalKind::kAngle ? "value_deg" : "value_um";
}

void RequireEmpirical(EmpiricalSettings empirical, const BenchFormat& bench) {
  const auto require = [&](bool condition, const std::string& what, const std::string& expected) {
    if (!condition) throw InputError(empirical.location, what, expected);
  };
  require(std::ranges::count(bench.channels, empirical.channel) > 0,
          fmt::format("the empirical signal is for the channel \"{}\"", empirical.channel),
          "a channel of the bench " + bench.name);
  const std::vector<double> values = std::exchange(ValuesOf(empirical, bench.signal), {});
  const std::string key = ValueKey(bench.signal);
  require(empirical.value_m.empty() && empirical.value_rad.empty() && empirical.value.empty(),
          "the empirical signal has values of another kind of channel", key);
  const bool by_time = empirical.by == "time";
  const std::size_t places = by_time ? empirical.time_s.size() : empirical.reading.size();
  require(!values.empty() && values.size() == places,
          fmt::format("the empirical signal has {} {}s and {} values", places, empirical.by, values.size()),
          fmt::format("one {} for each {}", key, empirical.by));
  if (by_time) {
    require(empirical.reading.empty(), "the empirical signal by time names readings", "time_s alone");
    require(std::ranges::is_sorted(empirical.time_s, std::less_equal()),
            "the times of the empirical signal do not ascend", "each time later than the one before");
    return;
  }
  const std::set<int> once(empirical.reading.begin(), empirical.reading.end());
  require(once.size() == values.size(), "the empirical signal names a reading twice", "every reading once");
  require(empirical.time_s.empty() || empirical.time_s.size() == places,
          fmt::format("the empirical signal has {} readings and {} times", places, empirical.time_s.size()),
          "one time_s for each reading, or none");
}

}  // namespace

FixtureSettings ReadFixture(const TomlValue& block) {
  FixtureSettings fixture;
  fixture.location = block.Where();
  ReadKeys(KeysOf(fixture), block, kFixtureTable);
  if (fixture.name.empty()) throw InputError(block.Where(), "the fixture has no name", "name = \"housing\"");
  if (std::isnan(fixture.box_m.x()) == fixture.mesh_file.empty())
    throw InputError(
        block.Where(),
        fmt::format("the fixture {} has {} box_mm {} mesh_file", fixture.name,
                    fixture.mesh_file.empty() ? "neither" : "both", fixture.mesh_file.empty() ? "nor" : "and"),
        "one of them");
  return fixture;
}

EmpiricalSettings ReadEmpirical(const TomlValue& block, const std::string& bench) {
  EmpiricalSettings empirical;
  empirical.location = block.Where();
  ReadKeys(KeysOf(empirical), block, kEmpiricalTable);
  RequireEmpirical(empirical, FormatOf(bench));
  return empirical;
}

}  // namespace twinbench
