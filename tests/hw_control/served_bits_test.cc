#include <fmt/format.h>
#include <gmock/gmock.h>

#include "hw_bridge/control/esp_table.h"
#include "hw_bridge/control/scpi.h"
#include "hw_bridge/control/described_devices.h"
#include "hw_bridge/control/scpi_instruments.h"
#include "hw_bridge/control/scpi_table.h"
#include "hw_bridge/control/served_clock.h"
#include "tests/support/rotary_scenario.h"
#include "tests/support/served_twin.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/twin.h"
#include "twin/core/units.h"

namespace twinbench::hw {
namespace {

using test::ServedTwin;
using Trace = std::vector<std::string>;

constexpr Duration kAmpleTime = std::chrono::seconds(5);

/// What is driven here: a bench without its A/D converter.
struct Devices {
  Clock& clock;
  RotaryTable& target;
  RotaryTable& reference;
  Autocollimator& autocollimator;
  Thermometer& thermometer;
  Goniometer& goniometer;
  Fixture& fixture;
};

std::string Text(const TableState& s) {  // {:a}: every bit
  return fmt::format("{:a} {:a} {} {} {} {} \"{}\"", s.commanded_rad, s.encoder_rad, s.moving, s.in_position,
                     s.referenced, s.limit, s.fault);
}

void Settle(const Devices& bench, RotaryTable& table, Trace& trace) {
  bool settled = false;
  for (int k = 0; k < 60 && !settled; ++k) {
    settled = table.Settles(std::chrono::seconds(1));
    trace.push_back(fmt::format("settled {} at {} ns", settled, bench.clock.Now().time_since_epoch().count()));
  }
}

void LookAround(const Devices& bench, Trace& trace) {
  trace.push_back("target " + Text(bench.target.State()));
  trace.push_back("reference " + Text(bench.reference.State()));
  const AutocollimatorReading angles = bench.autocollimator.Read();
  trace.push_back(fmt::format("autocollimator {:a} {:a}", angles.yaw_rad, angles.tilt_rad));
  trace.push_back(fmt::format("thermometer {:a}", bench.thermometer.Read_degC()));
}

void MoveBoth(const Devices& bench, double target_rad, double reference_rad, Trace& trace) {
  bench.target.StartMove(target_rad);
  bench.reference.StartMove(reference_rad);
  trace.push_back("begins " + Text(bench.target.State()));
  Settle(bench, bench.target, trace);
  Settle(bench, bench.reference, trace);
  LookAround(bench, trace);
}

/// Every verb, in the manner of the procedure.
Trace Drive(const Devices& bench) {
  Trace trace;
  LookAround(bench, trace);
  bench.fixture.Mount(0, 0.3 * units::deg, -0.2 * units::deg);
  bench.clock.Wait(std::chrono::nanoseconds(600'000'000'007));
  bench.goniometer.MoveTo(100.123456789 * units::arcsec, -1e3 / 7 * units::arcsec);
  LookAround(bench, trace);
  bench.goniometer.MoveTo(0.0, 0.0);
  for (const double angle_rad : {2.0 * units::kPi / 36, 0.1, -1.0 / 3.0, 30.123456 * units::deg, 1e-9, 7.0})
    MoveBoth(bench, angle_rad, 0.7 - angle_rad, trace);
  bench.target.StartMove(2.0);
  trace.push_back(fmt::format("settles in 0.1 s: {}", bench.target.Settles(std::chrono::milliseconds(100))));
  trace.push_back("under way " + Text(bench.target.State()));
  bench.target.Stop();
  Settle(bench, bench.target, trace);
  LookAround(bench, trace);
  bench.target.Home();
  MoveBoth(bench, 0.0, 0.0, trace);
  return trace;
}

Trace DriveInProcess(const Scenario& scenario) {
  sim::Twin twin(scenario);
  const RotaryBench b = twin.Bench();
  return Drive({b.clock, b.target, b.reference, b.autocollimator, b.thermometer, b.goniometer, b.fixture});
}

void ExpectSame(const Trace& got, const Trace& expected) {
  ASSERT_EQ(got.size(), expected.size());
  for (std::size_t k = 0; k < got.size(); ++k) EXPECT_EQ(got[k], expected[k]) << "entry " << k;
}

Scenario ScenarioOf(const std::string& fidelity) {
  Scenario scenario = test::RotaryScenario();
  const bool is_slow = fidelity == "slow";  // settles long after its profile
  RotaryOf(scenario).mechanics.fidelity = is_slow ? "linear" : fidelity;
  RotaryOf(scenario).mechanics.payload_mass_kg = 3.0;
  if (is_slow) RotaryOf(scenario).mechanics.servo_Hz = {6.0, 7.0};
  if (is_slow) RotaryOf(scenario).target.settle_s = 0.0;
  scenario.environment.drift_K_h = 1.0;
  RotaryOf(scenario).target.random_rms = {1e-6, 1e-6, 1e-6, 1e-7, 1e-7, 1e-7};
  return scenario;
}

/// A served twin driven by our clients, its tables in one of three ways.
class Driven {
 public:
  Driven(const ServedTwin& served, const std::string& tables)
      : scpi_(ParseAddress(served.ScpiAddress()).value(), kScpiIdentity, "twinbench,"),
        clock_talk_(ParseAddress(served.ScpiAddress()).value(), kScpiIdentity, "twinbench,"),
        clock_({clock_talk_, "clock", kAmpleTime}),
        simulation_(clock_),
        autocollimator_({scpi_, "autocollimator", kAmpleTime}, ReadyDialogueNamed("served_autocollimator")),
        thermometer_({scpi_, "thermometer", kAmpleTime}, ReadyDialogueNamed("served_thermometer")),
        goniometer_({scpi_, "goniometer", kAmpleTime}, ReadyDialogueNamed("served_goniometer")),
        fixture_({scpi_, "fixture", kAmpleTime}) {
    clock_.Open();
    simulation_.Restart();
    if (tables != "scpi") {
      const std::string address = tables == "esp" ? served.EspAddress() : served.TerminalAddress();
      esp_ = std::make_unique<Dialogue>(ParseAddress(address).value(), kEspIdentity, "ESP");
    }
    target_ = MakeTable("target", 1);
    reference_ = MakeTable("reference", 2);
  }

  Devices Bench() { return {clock_, *target_, *reference_, autocollimator_, thermometer_, goniometer_, fixture_}; }
  ScpiSimulation& simulation() { return simulation_; }
  DeviceLine Line(const std::string& device) { return {scpi_, device, kAmpleTime}; }

 private:
  std::unique_ptr<RotaryTable> MakeTable(const std::string& name, int axis) {
    if (esp_)
      return std::make_unique<EspTable>(DeviceLine(*esp_, name, kAmpleTime), axis, TableLimits{}, CommandNumbers{},
                                        true);
    return std::make_unique<ScpiTable>(DeviceLine(scpi_, name, kAmpleTime), axis, TableLimits{});
  }

  Dialogue scpi_, clock_talk_;
  std::unique_ptr<Dialogue> esp_;
  ScpiClock clock_;
  ScpiSimulation simulation_;
  DescribedAutocollimator autocollimator_;
  DescribedThermometer thermometer_;
  DescribedGoniometer goniometer_;
  ScpiFixture fixture_;
  std::unique_ptr<RotaryTable> target_, reference_;
};

struct Way {
  std::string tables, fidelity;
};
void PrintTo(const Way& way, std::ostream* out) {
  *out << way.tables << way.fidelity;
}

class Served : public testing::TestWithParam<Way> {};
INSTANTIATE_TEST_SUITE_P(Ways, Served,
                         testing::Values(Way{"scpi", "kinematic"}, Way{"scpi", "linear"}, Way{"scpi", "slow"},
                                         Way{"esp", "kinematic"}, Way{"esp", "linear"}, Way{"pty", "kinematic"}),
                         [](const auto& way) { return way.param.tables + "_" + way.param.fidelity; });

TEST_P(Served, EveryVerbGivesTheTwinsOwnBitsAndTakesItsOwnTime) {
  const Scenario scenario = ScenarioOf(GetParam().fidelity);
  ServedTwin served(scenario);
  Driven driven(served, GetParam().tables);
  ExpectSame(Drive(driven.Bench()), DriveInProcess(scenario));
}

TEST_P(Served, ARestartedBenchRepeatsItsBits) {
  ServedTwin served(ScenarioOf(GetParam().fidelity));
  Driven driven(served, GetParam().tables);
  const Trace first = Drive(driven.Bench());
  driven.simulation().Restart();
  driven.simulation().SetPaced(false);
  ExpectSame(Drive(driven.Bench()), first);
}

}  // namespace
}  // namespace twinbench::hw
