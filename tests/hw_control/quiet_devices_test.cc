#include <gmock/gmock.h>

#include <cmath>
#include <sstream>

#include "hw_bridge/control/absent.h"
#include "hw_bridge/control/host_clock.h"
#include "hw_bridge/control/operator_devices.h"
#include "tests/hw_control/faults.h"
#include "tests/support/kept_text.h"
#include "tests/support/memory_log.h"
#include "tests/support/restless_bench.h"
#include "twin/benches/rotary_4dof/procedure/procedure.h"
#include "twin/benches/rotary_4dof/twin/twin.h"
#include "twin/core/units.h"

namespace twinbench::hw {
namespace {

using test::KindOf;
using testing::HasSubstr;

/// A computer whose clocks are set by hand.
struct Computer {
  std::int64_t steady_ns = 5'000'000'000, utc_ns = 1'700'000'000'000'000'000;
  std::vector<std::string> notices;

  HostClock Clock(Duration elapsed) {
    return {elapsed, [this](const std::string& notice) { notices.push_back(notice); }, [this] { return steady_ns; },
            [this] { return utc_ns; }, [this](Duration duration) { Pass(duration); }};
  }
  void Pass(Duration duration) {
    steady_ns += duration.count();
    utc_ns += duration.count();
  }
};

TEST(HostClock, BeginsAtZeroOrBehindWhatHasElapsedAndIsNotMovedByTheWallClock) {
  Computer computer;
  const HostClock clock = computer.Clock(Duration(0));
  computer.utc_ns -= 3'600'000'000'000;
  EXPECT_EQ(clock.Now(), Time{});
  EXPECT_EQ(clock.UtcStep(), -std::chrono::hours(1));
  HostClock resumed = computer.Clock(std::chrono::minutes(7));
  resumed.Wait(std::chrono::seconds(3));
  EXPECT_EQ(resumed.Now(), Time(std::chrono::minutes(7) + std::chrono::seconds(3)));
}

TEST(HostClock, HearsAStopWhileItWaits) {
  Computer computer;
  HostClock clock = computer.Clock(Duration(0));
  clock.HearStop([&] { return clock.Now() > Time(std::chrono::seconds(1)); });
  EXPECT_EQ(KindOf([&] { clock.Wait(std::chrono::seconds(5)); }), FaultKind::kStopped);
  EXPECT_LT(clock.Now(), Time(std::chrono::milliseconds(1100)));
}

TEST(HostClock, TellsOnceOfEachStepOfTheWallClockAndNotOfItsSlewing) {
  Computer computer;
  HostClock clock = computer.Clock(Duration(0));
  computer.utc_ns += 400'000'000;
  clock.Wait(std::chrono::seconds(1));
  EXPECT_TRUE(computer.notices.empty());
  computer.utc_ns += 2'000'000'000;
  clock.Wait(std::chrono::seconds(1));
  clock.Wait(std::chrono::seconds(1));
  ASSERT_EQ(computer.notices.size(), 1u);
  EXPECT_THAT(computer.notices[0], HasSubstr("+2.400 s"));
}

/// The world of a twin, whose time a computer reads off a steady clock, while its wall clock is set twice on the way.
TEST(HostClock, AJumpOfTheWallClockDuringARunGoesIntoNoReading) {
  const auto measured = [](std::int64_t first_jump_ns, std::int64_t second_jump_ns, test::MemoryLog& log) {
    const Scenario scenario = test::RestlessBench();
    sim::Twin twin(scenario);
    RotaryBench world = twin.Bench();
    std::int64_t jumped_ns = 0;
    const auto steady_ns = [&] { return world.clock.Now().time_since_epoch().count(); };
    const auto utc_ns = [&] { return 1'700'000'000'000'000'000 + steady_ns() + jumped_ns; };
    const auto wait = [&](Duration duration) {
      world.clock.Wait(duration);
      if (log.readings.size() >= 5) jumped_ns = first_jump_ns;
      if (log.readings.size() >= 11) jumped_ns = second_jump_ns;
    };
    HostClock* host = nullptr;
    HostClock clock({}, [&](const std::string& notice) { log.AppendEvent(host->Now(), "clock", notice); }, steady_ns, utc_ns, wait);
    host = &clock;
    RotaryBench bench = {clock,       world.target,      world.reference,  world.adc, world.autocollimator,
                         world.thermometer, world.goniometer, world.fixture, nullptr};
    procedure::Options options;
    options.log = &log;
    procedure::CarryOut(bench, scenario, log, {}, options);
  };
  test::MemoryLog quiet, jumped;
  measured(0, 0, quiet);
  measured(86'400'000'000'000, -7'200'000'000'000, jumped);
  EXPECT_EQ(test::TextOf(jumped.readings), test::TextOf(quiet.readings)) << "times and all";
  const auto told = [](const test::MemoryLog& log) {
    std::vector<std::string> texts;
    for (const RecordedEvent& event : log.events)
      if (event.device == "clock") texts.push_back(event.text);
    return texts;
  };
  EXPECT_TRUE(told(quiet).empty());
  EXPECT_THAT(told(jumped), testing::ElementsAre(HasSubstr("+86400.000 s"), HasSubstr("-7200.000 s")));
}

TEST(HostClock, OfThisComputerPassesAtLeastWhatItWaits) {
  HostClock clock(Duration(0), [](const std::string&) {});
  const Time before = clock.Now();
  clock.Wait(std::chrono::milliseconds(20));
  EXPECT_GE(clock.Now() - before, std::chrono::milliseconds(20));
}

TEST(ConsoleFixture, SaysWhatToMountAndWaitsForEnter) {
  std::istringstream in("\n\n");
  std::ostringstream out;
  ConsoleFixture fixture(Operator(in, out));
  fixture.Mount(2, 30.0 * units::deg, -10.0 * units::deg);
  EXPECT_KEPT(out.str());
  EXPECT_EQ(in.tellg(), 1);  // one Enter, not both
}

TEST(ConsoleFixture, EndsTheRunWhereNobodyIsAndWhereSomebodySaysStop) {
  for (const char* input : {"", "stop\n"}) {
    std::istringstream in(input);
    std::ostringstream out;
    ConsoleFixture fixture(Operator(in, out));
    EXPECT_EQ(KindOf([&] { fixture.Mount(0, 0.0, 0.0); }), FaultKind::kStopped);
  }
}

TEST(ConsoleGoniometer, SaysTheAngles) {
  std::istringstream in("\n");
  std::ostringstream out;
  ConsoleGoniometer(Operator(in, out)).MoveTo(-300.0 * units::arcsec, 50.0 * units::arcsec);
  EXPECT_KEPT(out.str());
}

TEST(AbsentDevices, SayWhatNeedsThem) {
  EXPECT_TRUE(std::isnan(NoThermometer().Read_degC()));
  EXPECT_KEPT(test::TextOf([] { NoAutocollimator().Read(); }));
  EXPECT_KEPT(test::TextOf([] { NoGoniometer().MoveTo(0.0, 0.0); }));
}

}  // namespace
}  // namespace twinbench::hw
