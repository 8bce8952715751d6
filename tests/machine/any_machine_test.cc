#include "tests/machine/benches.h"
#include "tests/support/machine_run.h"
#include "twin/procedure/machine_watch.h"

/// The contract of twin/core/machine.h: the twins of the benches with a machine, and benches that are written in Python.
namespace twinbench::test {
namespace {

std::string NameOfMachine(const ::testing::TestParamInfo<AnyMachine>& machine) { return machine.param.name; }

class AnyMachineContract : public ::testing::TestWithParam<AnyMachine> {
 protected:
  void SetUp() override {
    if (!GetParam().missing.empty()) GTEST_SKIP() << GetParam().missing;
  }
  /// A new bench; the one before goes.
  MachineBench NewBench() {
    devices_.reset();
    devices_ = GetParam().make(scenario_);
    return devices_->Devices();
  }
  std::vector<Reading> Driven() {
    MachineBench bench = NewBench();
    MemoryLog log;
    BenchOf(scenario_).drive(bench, scenario_, log, {}, {});
    return log.readings;
  }
  const Scenario scenario_ = GetParam().scenario();

 private:
  std::unique_ptr<MachineDevices> devices_;
};

TEST_P(AnyMachineContract, EveryPlannedReadingIsTakenInTimeAndOnce) {
  const std::vector<Reading> readings = Driven();
  ASSERT_EQ(static_cast<int>(readings.size()), BenchOf(scenario_).planned_readings(scenario_));
  for (std::size_t k = 0; k < readings.size(); ++k) {
    EXPECT_EQ(readings[k].reading, static_cast<int>(k));
    EXPECT_EQ(readings[k].status, ReadingStatus::kOk) << k;
    if (k > 0) {
      EXPECT_GE(readings[k].time, readings[k - 1].time) << k;
    }
  }
}

TEST_P(AnyMachineContract, TheClockNeverGoesBackAndWaitsExactly) {
  MachineBench bench = NewBench();
  for (const Duration wait : {Duration(0), Duration(1), Duration(std::chrono::milliseconds(7)), Duration(std::chrono::seconds(100))}) {
    const Time before = bench.clock.Now();
    bench.clock.Wait(wait);
    EXPECT_EQ(bench.clock.Now() - before, wait);
  }
}

TEST_P(AnyMachineContract, EveryAxisHasAStateAndATravel) {
  MachineBench bench = NewBench();
  ASSERT_EQ(bench.machine.State().size(), bench.machine.Axes().size());
  ASSERT_EQ(bench.machine.Travel().size(), bench.machine.Axes().size());
  for (const AxisState& axis : bench.machine.State()) {
    EXPECT_TRUE(axis.referenced && axis.in_position && !axis.moving);
    EXPECT_TRUE(std::isfinite(axis.encoder));
  }
}

/// A bench that cannot begin again goes on where it is, also in the middle of a sweep: nothing is taken twice, and
/// what is mounted stays mounted.
TEST_P(AnyMachineContract, ARealBenchGoesOnWithTheReadingThatIsMissing) {
  const std::vector<Reading> without_stops = Driven();
  MachineBench bench = NewBench();
  bench.simulation = nullptr;
  MemoryLog log;
  for (const std::size_t stop_at : {std::size_t{5}, std::size_t{17}, without_stops.size() + 1}) {
    procedure::MachineOptions options;
    options.log = &log;
    options.kept = log.readings;
    options.stop_requested = [&] { return log.readings.size() >= stop_at; };
    if (stop_at > without_stops.size()) {
      BenchOf(scenario_).drive(bench, scenario_, log, {}, options);
    } else {
      EXPECT_THROW(BenchOf(scenario_).drive(bench, scenario_, log, {}, options), DeviceFault);
      EXPECT_EQ(log.readings.size(), KeptWhenStoppedAt(stop_at, scenario_)) << "every reading is kept before the operator is heard";
    }
  }
  ASSERT_EQ(log.readings.size(), without_stops.size());
  EXPECT_EQ(log.events.size(), 2u) << "each mounting was mounted once";
  for (std::size_t k = 0; k < without_stops.size(); ++k) {
    EXPECT_EQ(log.readings[k].reading, static_cast<int>(k));
    for (const ReadingColumn& column : InstrumentColumns(BenchOf(scenario_).format->columns))
      EXPECT_EQ(column.print(log.readings[k]).empty(), column.print(without_stops[k]).empty()) << column.name;
  }
}

/// Those whose axes can be sent somewhere.
using SentContract = AnyMachineContract;

TEST_P(SentContract, APathBeyondTheTravelIsRefused) {
  MachineBench bench = NewBench();
  MachineController& machine = bench.machine;
  std::vector<double> to;
  for (const AxisLimits& axis : machine.Travel()) to.push_back(axis.upper + 1e-3);
  EXPECT_THROW(machine.StartMove(to, 0.0), DeviceFault);
  for (const AxisState& axis : machine.State()) EXPECT_FALSE(axis.moving);
}

TEST_P(SentContract, AStopLeavesTheAxesWhereTheyAre) {
  MachineBench bench = NewBench();
  std::vector<double> to;
  const std::vector<AxisState> before = bench.machine.State();
  for (std::size_t k = 0; k < before.size(); ++k) {
    const double way = bench.machine.Axes()[k].is_rotary ? 1.0 : 0.02;  // rad or m
    to.push_back(before[k].encoder - std::min(way, 0.5 * (before[k].encoder - bench.machine.Travel()[k].lower)));
  }
  bench.machine.StartMove(to, 0.01);
  EXPECT_FALSE(bench.machine.Settles(std::chrono::milliseconds(100)));
  bench.machine.Stop();
  bench.clock.Wait(std::chrono::seconds(5));  // bodies come to rest
  const std::vector<AxisState> stopped = bench.machine.State();
  bench.clock.Wait(std::chrono::seconds(5));
  for (std::size_t k = 0; k < stopped.size(); ++k) {
    EXPECT_FALSE(stopped[k].moving);
    EXPECT_GT(std::abs(stopped[k].encoder - to[k]), 0.01) << "it was on its way";
    EXPECT_NEAR(bench.machine.State()[k].encoder, stopped[k].encoder, 1e-6);
  }
}

TEST_P(AnyMachineContract, AReadingBesideThePlanIsOneToo) {
  const std::vector<Reading> planned = Driven();
  MachineBench bench = NewBench();
  const std::vector<ReadingColumn> columns = InstrumentColumns(BenchOf(scenario_).format->columns);
  bench.clock.Wait(std::chrono::seconds(3));  // no reading is due now
  const Reading sample = bench.instruments.Read();
  EXPECT_EQ(sample.time, bench.clock.Now());
  EXPECT_EQ(std::isfinite(sample.temperature_degC), std::isfinite(planned[0].temperature_degC));
  EXPECT_TRUE(std::ranges::any_of(columns, [&](const ReadingColumn& c) { return !c.print(sample).empty(); }));
}

using TurningContract = AnyMachineContract;

/// A spindle that was told to turn does until it is stopped, and the stop is read back; then it stands.
TEST_P(TurningContract, TurnsUntilItIsStopped) {
  MachineBench bench = NewBench();
  bench.machine.StartTurning(0, 5.0, std::chrono::seconds(2));
  EXPECT_FALSE(bench.machine.Settles(std::chrono::seconds(10)));
  EXPECT_TRUE(bench.machine.State()[0].moving);
  EXPECT_NEAR(bench.machine.State()[0].encoder, 45.0, 0.01) << "5 in the mean of the ramp, 40 behind it";
  EXPECT_TRUE(procedure::StopMachine(bench, {}).is_sure);
  EXPECT_FALSE(bench.machine.State()[0].moving);
}

std::vector<AnyMachine> Twins(const std::vector<std::pair<std::string, Scenario (*)()>>& benches) {
  std::vector<AnyMachine> twins;
  for (const auto& [name, scenario] : benches)
    twins.push_back({"Twin" + name, scenario, [](const Scenario& s) { return BenchOf(s).make_devices(s); }});
  return twins;
}

std::vector<AnyMachine> AllSent() {
  std::vector<AnyMachine> machines = Twins({{"Circles", ShortCircles}, {"Freeform", ShortFreeform}, {"Stops", ShortStops},
                                            {"Turntable", ShortTurntable}, {"Polygon", ShortPolygon}});
  for (AnyMachine& machine : PythonMachinesThatAreSent()) machines.push_back(std::move(machine));
  return machines;
}

std::vector<AnyMachine> AllTurning() {
  std::vector<AnyMachine> machines = Twins({{"Hob", ShortHob}, {"Sweep", ShortSweep}});
  machines.push_back(PythonMachineThatTurns());
  return machines;
}

INSTANTIATE_TEST_SUITE_P(Sent, AnyMachineContract, ::testing::ValuesIn(AllSent()), NameOfMachine);
INSTANTIATE_TEST_SUITE_P(Turning, AnyMachineContract, ::testing::ValuesIn(AllTurning()), NameOfMachine);
INSTANTIATE_TEST_SUITE_P(Sent, SentContract, ::testing::ValuesIn(AllSent()), NameOfMachine);
INSTANTIATE_TEST_SUITE_P(BothWays, SentContract, ::testing::ValuesIn(Twins({{"Sweep", ShortSweep}})), NameOfMachine);
INSTANTIATE_TEST_SUITE_P(Turning, TurningContract, ::testing::ValuesIn(AllTurning()), NameOfMachine);

}  // namespace
}  // namespace twinbench::test
