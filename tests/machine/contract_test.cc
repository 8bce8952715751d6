#include "tests/core/input_error.h"
#include "tests/machine/benches.h"
#include "tests/support/angle_benches.h"
#include "tests/support/kept_text.h"
#include "tests/support/machine_run.h"
#include "twin/benches/circular_motion/twin/live.h"

/// Same scenario, same seed, same readings: on the twin in this program and through the network.
namespace twinbench::test {
namespace {

/// A bench of few readings, and its name.
struct ShortBench {
  const char* name;
  Scenario (*scenario)();
};

std::string NameOf(const ::testing::TestParamInfo<ShortBench>& bench) { return bench.param.name; }

class MachineContract : public ::testing::TestWithParam<ShortBench> {
 protected:
  const Scenario scenario_ = GetParam().scenario();
  const std::vector<Reading> in_process_ = DrivenInProcess(scenario_);
};

TEST_P(MachineContract, GivesTheSameBitsThroughTheNetworkAndWritesDownWhatItAskedOfTheDevices) {
  const ServedMachineTwin served(scenario_);
  for (const char* machine : {"esp", "pty"}) {
    const MachineRun run = RunServedMachine(served, scenario_, served.BenchFile(machine));
    EXPECT_EQ(run.stopped_by, "") << run.said;
    EXPECT_EQ(TextOf(run.log.readings, scenario_), TextOf(in_process_, scenario_)) << machine;
    EXPECT_TRUE(run.log.attempts.empty());
    for (const char* device : {"machine", "instruments"})
      EXPECT_GT(std::ranges::count(run.log.calls, device, &DeviceCall::device), 0) << device;
    EXPECT_EQ(run.log.events.size(), 2u) << "two mountings were mounted";
  }
}

TEST_P(MachineContract, IsWhatRunCarriesOut) {
  EXPECT_EQ(TextOf(RunBench(scenario_).readings, scenario_), TextOf(in_process_, scenario_));
}

TEST_P(MachineContract, AResumedRunMakesTheSameReadings) {
  const ServedMachineTwin served(scenario_);
  for (const std::size_t kept : {std::size_t{1}, in_process_.size() / 2, in_process_.size() - 1}) {
    const std::vector<Reading> before(in_process_.begin(), in_process_.begin() + static_cast<long>(kept));
    const MachineRun run = RunServedMachine(served, scenario_, served.BenchFile(), {}, before);
    EXPECT_EQ(run.stopped_by, "") << run.said;
    EXPECT_EQ(TextOf(run.log.readings, scenario_), TextOf(in_process_, scenario_)) << kept;
  }
}

TEST_P(MachineContract, ARecordOfAnotherBenchIsNotGoneOnWith) {
  std::vector<Reading> before(in_process_.begin(), in_process_.begin() + 3);
  before[1].time += Duration(1);
  const ServedMachineTwin served(scenario_);
  EXPECT_THROW(RunServedMachine(served, scenario_, served.BenchFile(), {}, before), InputError);
}

constexpr ShortBench kBenches[] = {{"Circles", ShortCircles}, {"Freeform", ShortFreeform}, {"Stops", ShortStops}, {"Sweep", ShortSweep},
                                   {"Turntable", ShortTurntable}, {"Polygon", ShortPolygon}, {"Hob", ShortHob}};
INSTANTIATE_TEST_SUITE_P(Benches, MachineContract, ::testing::ValuesIn(kBenches), NameOf);

/// Of those whose axes go along lines and arcs.
TEST(DrivenContract, EveryDeviceSchedulesEvents) {
  for (Scenario (*make)() : {ShortCircles, ShortFreeform, ShortStops, ShortSweep}) {
    DrivenTwin twin(make());
    twin.Drive();
    const auto& scheduled = dynamic_cast<const sim::DrivenMachine&>(*twin.devices).Scheduled();
    EXPECT_GE(scheduled.at("instruments"), twin.log.readings.size());
    for (const char* device : {"axes", "fixture"}) EXPECT_GT(scheduled.at(device), 0U) << device;
  }
}

TEST(TurningAxis, CannotBeSentAnywhereOnTheTwinAndIsNoneOfAMachineThatIsSent) {
  EXPECT_THROW(DrivenTwin(ShortHob()).bench.machine.StartMove({1.0}, 0.0), DeviceFault);
  EXPECT_THROW(DrivenTwin(ShortStops()).bench.machine.StartTurning(0, 1.0, std::chrono::seconds(1)), DeviceFault);
}

TEST(Comparison, ACoastingSpindleIsRefusedWithWhatCanBeDoneInstead) {
  Scenario scenario = ShortStops();
  EncoderOf(scenario).encoder_procedure.kind = "coast";
  EXPECT_KEPT(MessageOf([&] { BenchOf(scenario).make_devices(scenario); }));
}

/// A shaft that was left behind somewhere goes its pass again from where that begins, and takes what is missing.
TEST(Comparison, ARealSweepIsGoneAgainFromItsBeginning) {
  DrivenTwin twin(ShortSweep());
  twin.bench.simulation = nullptr;
  twin.options.stop_requested = [&] { return twin.log.readings.size() == 5; };
  EXPECT_EQ(twin.Fault(), "stopped");
  twin.bench.machine.StartMove({1.0}, 0.0);
  twin.bench.clock.Wait(std::chrono::minutes(5));
  twin.options.stop_requested = {};
  twin.options.kept = twin.log.readings;
  twin.Drive();
  const std::vector<Reading> planned = DrivenInProcess(twin.scenario);
  ASSERT_EQ(twin.log.readings.size(), planned.size());
  for (std::size_t k = 0; k < planned.size(); ++k) {
    EXPECT_NEAR(twin.log.readings[k].reference_rad, planned[k].reference_rad, 1e-6) << k;
    EXPECT_TRUE(std::isnan(twin.log.readings[k].velocity_rad_s)) << "of a real shaft it is not known";
  }
}

/// What answers more slowly than the interval is none to sweep with.
TEST(Comparison, ASweepWhoseReadingsComeLateIsNoRun) {
  DrivenTwin twin(ShortSweep());
  struct Slow : PassingInstruments {
    explicit Slow(const MachineBench& bench) : PassingInstruments(bench.instruments), clock(bench.clock) {}
    Reading Read() override {
      const Reading shown = inner_.Read();
      clock.Wait(std::chrono::milliseconds(850));
      return shown;
    }
    Clock& clock;
  } slow(twin.bench);
  EXPECT_EQ(twin.FaultOn(AsHardware(twin.bench, slow)), "overrun");
}

TEST(Comparison, SeveralHeadsAreReadOnATwinOnly) {
  for (Scenario (*make)() : {ShortStops, ShortSweep}) {
    Scenario scenario = make();
    EncoderOf(scenario).encoder_procedure.heads_rad = {0.0, 1.0};
    EXPECT_EQ(TextOf(DrivenInProcess(scenario), scenario), TextOf(RunBench(scenario).readings, scenario));
    DrivenTwin twin(scenario);
    twin.bench.simulation = nullptr;
    EXPECT_NE(twin.Fault(), "");
  }
}

/// Somebody who turns the multi-tooth table by hand is not asked to while the turntable moves.
TEST(MultitoothByHand, IsTurnedOnceTheTurntableStandsAndWithoutAnIndexerIsRefused) {
  DrivenTwin twin(ShortTurntable());
  struct Hands : Indexer {
    Hands(MachineBench& its_bench) : bench(its_bench), inner(*its_bench.indexer) {}
    void IndexTo(int tooth, double angle_rad) override {
      EXPECT_FALSE(bench.machine.State()[0].moving);
      EXPECT_NEAR(angle_rad, tooth * units::deg, 1e-12);
      EXPECT_NEAR(std::remainder(bench.machine.State()[0].commanded + angle_rad, units::deg), 0.0, 300 * units::arcsec);
      inner.IndexTo(tooth, angle_rad);
      ++times;
    }
    bool IsByHand() const override { return true; }
    MachineBench& bench;
    Indexer& inner;
    int times = 0;
  } hands(twin.bench);
  twin.bench.indexer = &hands;
  twin.Drive();
  EXPECT_EQ(hands.times, 33) << "a stop each";
  twin.bench.indexer = nullptr;
  EXPECT_NE(twin.Fault(), "") << "there is nobody who turns it";
}

/// Off the plan everything is computed anew from what was taken before; on it the plan's own course is used. Both
/// must be one physics: 3 ns beside every planned instant the machine shows the same to 1 pm, for it needs
/// microseconds to go as far.
TEST(DrivenCircles, ShowBesideThePlanWhatTheyShowOnIt) {
  using namespace benches::circular;
  Scenario scenario = ShortCircles();
  scenario.noise_free = true;  // no digits that could turn over
  const auto physics = sim::MakeCirclePhysics(scenario);
  const sim::CircleRun run(scenario);
  double largest_m = 0.0, largest_rad = 0.0;
  for (int k = 0; k < run.Readings(); ++k) {
    const Reading planned = run.Take(k);
    const sim::DrivenInstant at{k, planned.time + Duration(3), planned.setup, planned.direction, kFeed_m_s(planned),
                                {kCommandedX_m(planned), kCommandedY_m(planned)}};
    const Reading beside = physics->Show(at);
    EXPECT_EQ(beside.time, at.time) << "it was not taken for the planned one";
    for (const Quantity* q : {&kBar_m, &kGridX_m, &kGridY_m}) {
      EXPECT_EQ(std::isfinite((*q)(planned)), std::isfinite((*q)(beside)));
      if (std::isfinite((*q)(planned))) largest_m = std::max(largest_m, std::abs((*q)(beside) - (*q)(planned)));
    }
    if (std::isfinite(kEncoder_rad(planned)))
      largest_rad = std::max(largest_rad,
                             std::abs(std::remainder(kEncoder_rad(beside) - kEncoder_rad(planned), units::turn)));
  }
  EXPECT_LT(largest_m, 1e-12);
  EXPECT_LT(largest_rad, 1e-11);
}

}  // namespace
}  // namespace twinbench::test
