#include <gmock/gmock.h>

#include <cmath>
#include <sstream>

#include "hw_bridge/control/absent.h"
#include "hw_bridge/control/host_clock.h"
#include "hw_bridge/control/operator_devices.h"
#include "tests/hw_control/faults.h"
#include "tests/support/kept_text.h"
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
