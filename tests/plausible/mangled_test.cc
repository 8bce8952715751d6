#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "tests/support/angle_benches.h"
#include "tests/support/kept_text.h"
#include "twin/benches/expected.h"

namespace twinbench::plausible {
namespace {

using Rows = std::vector<Reading>;

/// The shipped scenarios of the benches, the larger ones shortened.
const std::vector<Scenario>& Benches() {
  static const std::vector<Scenario> scenarios = [] {
    std::vector<Scenario> all;
    const std::pair<const char*, std::vector<std::string>> benches[] = {
        {"rotary_4dof", {"mechanics.fidelity=\"kinematic\"", "mechanics.vibration=\"none\""}},
        {"turntable_autocollimator", {}},
        {"encoder_comparison", {}},
        {"hob_transmission", {"hob_procedure.samples_per_turn=180"}},
        {"circular_motion", {"circular_procedure.points=60"}},
        {"freeform_five_axis", {"freeform_procedure.poses=30"}}};
    for (const auto& [name, set] : benches) all.push_back(LoadScenario(test::ScenarioPath(std::string(name) + ".toml"), set));
    return all;
  }();
  return scenarios;
}

const Rows& Good(std::size_t bench) {
  static std::vector<Rows> runs(Benches().size());
  if (runs[bench].empty()) runs[bench] = test::ReadingsOf(Benches()[bench]);
  return runs[bench];
}

/// What is shown, but the scatter of samples: an outsider changes what he takes for the values.
std::vector<const ReadingColumn*> Values(const Scenario& scenario) {
  std::vector<const ReadingColumn*> columns;
  for (const ReadingColumn& column : FormatOf(scenario.bench).columns) {
    const bool is_same_clock =
        column.name == "table_encoder_deg" || column.name.starts_with("grid_") || column.name.starts_with("interfero");
    if (column.IsShown() && column.number && !column.name.ends_with("_std_V") && column.name != "qpd_sum_V" && !is_same_clock)
      columns.push_back(&column);
  }
  return columns;
}

Rows EachValue(Rows readings, const Scenario& scenario, const std::function<double(double)>& change) {
  for (Reading& r : readings)
    for (const ReadingColumn* column : Values(scenario)) column->number(r) = change(column->number(r));
  return readings;
}

Rows EachAngle(Rows readings, const Scenario& scenario, double times) {
  for (const ReadingColumn& column : FormatOf(scenario.bench).columns) {
    if (column.role != ColumnRole::kRequired || !column.number || !column.name.ends_with("_deg") || column.name == "head_deg")
      continue;
    for (Reading& r : readings) column.number(r) *= times, r.extra.clear();
  }
  return readings;
}

Rows Shuffled(const Rows& readings, const Scenario& scenario) {
  Rows shuffled = readings;
  Stream stream(1, "test.shuffle");
  for (std::size_t i = readings.size(); i-- > 1;)
    for (const ReadingColumn* column : Values(scenario))
      std::swap(column->number(shuffled[i]),
                column->number(shuffled[static_cast<std::size_t>(stream.Uniform() * static_cast<double>(i))]));
  return shuffled;
}

Rows Twice(const Rows& readings) {
  Rows twice;
  for (const Reading& r : readings) twice.insert(twice.end(), 2, r);
  for (std::size_t i = 0; i < twice.size(); ++i) twice[i].reading = static_cast<int>(i);
  return twice;
}

/// A channel shows a value to the last digit from the third of the readings on.
Rows Stuck(Rows readings, const Scenario& scenario) {
  const ReadingColumn& column = *Values(scenario).front();
  Reading last = readings[readings.size() / 3];
  for (std::size_t i = readings.size() / 3; i < readings.size(); ++i)
    if (std::isfinite(column.number(readings[i]))) column.number(readings[i]) = column.number(last);
  return readings;
}

/// The axis stands at its third stop, and its controller counts on.
Rows Standing(Rows readings) {
  for (std::size_t i = 3; i < readings.size(); ++i)
    readings[i].reference_rad = readings[3].reference_rad,
    readings[i].measured_rad = readings[3].measured_rad + 1e-6 * static_cast<double>(i % 5);
  return readings;
}

/// The first finding of each kind, without the numbers, which are the twin's.
std::string Said(const Rows& readings, const Scenario& scenario) {
  const std::vector<Finding> findings = DoubtsAbout(readings, scenario);
  return findings.empty() ? "-" : (findings[0].fatal ? "cannot be: " : "doubtful: ") + findings[0].line;
}

TEST(Mangled, ReadingsOfAnyBenchAreRefusedOrSaidAndGoodOnesAreNot) {
  using Mangling = std::function<Rows(const Rows&, const Scenario&)>;
  const std::pair<const char*, Mangling> changes[] = {
      {"good", [](const Rows& r, const Scenario&) { return r; }},
      {"all zero", [](const Rows& r, const Scenario& s) { return EachValue(r, s, [](double x) { return 0.0 * x; }); }},
      {"a thousandth", [](const Rows& r, const Scenario& s) { return EachValue(r, s, [](double x) { return 1e-3 * x; }); }},
      {"a thousand times", [](const Rows& r, const Scenario& s) { return EachValue(r, s, [](double x) { return 1e3 * x; }); }},
      {"negative", [](const Rows& r, const Scenario& s) { return EachValue(r, s, [](double x) { return -x; }); }},
      {"stuck", Stuck},
      {"shuffled", Shuffled},
      {"twice", [](const Rows& r, const Scenario&) { return Twice(r); }},
      {"angles in mdeg", [](const Rows& r, const Scenario& s) { return EachAngle(r, s, 1e3); }},
      {"angles in rad", [](const Rows& r, const Scenario& s) { return EachAngle(r, s, units::deg); }}};
  for (const auto& [what, change] : changes) {
    std::string said;
    for (std::size_t bench = 0; bench < Benches().size(); ++bench)
      said += Benches()[bench].bench + ": " + Said(change(Good(bench), Benches()[bench]), Benches()[bench]) + "\n";
    EXPECT_KEPT(std::string(what) + "\n" + said);
  }
}

TEST(Mangled, AShaftThatStandsWhileItsEncoderCountsIsRefused) {
  const Scenario scenario = LoadScenario(test::ScenarioPath("encoder_comparison.toml"));
  EXPECT_KEPT(Said(Standing(test::ReadingsByRecord(scenario)), scenario));
}

}  // namespace
}  // namespace twinbench::plausible
