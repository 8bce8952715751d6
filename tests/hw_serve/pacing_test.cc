#include "tests/hw_serve/serving.h"
#include "tests/hw_serve/virtual_bench.h"

/// Bench time against the wall clock: one of the test, or the computer's, which may stand still for a while: there lower bounds
/// are sharp.
namespace twinbench::test {
namespace {

using WallClock = std::chrono::steady_clock;
using std::chrono::milliseconds;

double Elapsed_s(WallClock::time_point since) {
  return std::chrono::duration<double>(WallClock::now() - since).count();
}

TEST(Pacing, ARunningBenchFollowsTheWallClockAtItsSpeed) {
  VirtualBench bench(10.0);
  VirtualScpi scpi(bench);
  const long long before_ns = scpi.AskNumber("CLOC:NOW?");
  bench.Pass(milliseconds(200));
  EXPECT_EQ(scpi.AskNumber("CLOC:NOW?") - before_ns, 2'000'000'000);
}

TEST(Pacing, ASettlingTableTakesItsTime) {
  VirtualBench bench(4.0);
  EXPECT_EQ(VirtualScpi(bench).Ask("ROT1:ANGL 30;SETT? 60"), "1");
  EXPECT_GE(bench.Wall_s(), 1.4 / 4.0);  // 30 deg at 30 deg/s, and the window of 0.4 s
  EXPECT_LE(bench.Wall_s(), 1.4 / 4.0 + 0.004) << "it is looked at every 2 ms";
}

TEST(Pacing, AnEmergencyStopIsServedWhileAnotherClientWaits) {
  VirtualBench bench(1.0);
  VirtualScpi waiting(bench), stopping(bench);
  waiting.Say("ROT1:ANGL 300;SETT? 60\n");  // ten seconds
  bench.Pass(std::chrono::seconds(1));
  stopping.Say("ABOR\n");
  EXPECT_EQ(waiting.Line(), "1");  // settled, where it was stopped
  EXPECT_LT(bench.Wall_s(), 2.0);  // it takes its time to come to rest, and the window of 0.4 s
  EXPECT_LT(std::stod(stopping.Ask("ROT1:ANGL?")), 30.0);
}

TEST(Pacing, HeldTimeIsPaidForByTheReplyAndFreeWithoutPacing) {
  VirtualBench bench(10.0);
  VirtualScpi scpi(bench);
  scpi.Ask("CLOC:HOLD ON;*OPC?");
  scpi.Ask("CLOC:WAIT? 3000000000");
  const double paid_s = bench.Wall_s();
  EXPECT_NEAR(paid_s, 0.3, 1e-8);  // to some ns
  scpi.Ask("SIM:PACE OFF;*OPC?");
  scpi.Ask("CLOC:WAIT? 3600000000000");
  EXPECT_EQ(bench.Wall_s(), paid_s);
}

TEST(Pacing, AHoldEndsWithItsConnection) {
  VirtualBench bench(1.0);
  VirtualScpi other(bench);
  {
    VirtualScpi holding(bench);
    holding.Ask("CLOC:HOLD ON;*OPC?");
    bench.Pass(milliseconds(50));
    EXPECT_EQ(other.AskNumber("CLOC:NOW?"), 0);
  }
  bench.Pass(milliseconds(50));
  EXPECT_EQ(other.AskNumber("CLOC:NOW?"), 50'000'000);
}

TEST(Pacing, ScansOfARunningConverterFollowOneAnother) {
  for (const double speed : {1.0, kAtOnce}) {
    ServedTwin served(OnFreePorts(speed));
    BufferClient adc(served.at().iiod_port, 2000);
    Scans scans;
    for (int block = 0; block < 5; ++block) {
      const Scans next = adc.Read(2000);
      scans.stamps_ns.insert(scans.stamps_ns.end(), next.stamps_ns.begin(), next.stamps_ns.end());
    }
    for (std::size_t s = 1; s < scans.stamps_ns.size(); ++s)
      ASSERT_EQ(scans.stamps_ns[s] - scans.stamps_ns[s - 1], 16000) << s << " at speed " << speed;
  }
}

TEST(Pacing, ARunningConverterKeepsItsRate) {
  ServedTwin served(OnFreePorts(1.0));
  const auto began = WallClock::now();  // before it: a client that is kept waiting takes the next block the sooner
  BufferClient adc(served.at().iiod_port, 6250);
  for (int block = 0; block < 6; ++block) adc.Read(6250);  // a tenth of a second each
  // The first block may come up to one step of the converter (4 ms) early.
  EXPECT_GE(Elapsed_s(began), 0.59);
}

TEST(Pacing, ScansThatASlowClientMissesAreCountedAndSeenInTheTimeStamps) {
  ServedTwin served(OnFreePorts(20.0));
  BufferClient adc(served.at().iiod_port, 100);
  TcpClient iiod(served.at().iiod_port);
  const Scans before = adc.Read(100);
  std::this_thread::sleep_for(milliseconds(300));  // 6 s of bench time; the server keeps one
  const Scans after = adc.Read(100);
  const std::int64_t missed = (after.stamps_ns.front() - before.stamps_ns.back()) / 16000 - 1;
  EXPECT_GT(missed, 4 * 62500);
  iiod.Send("READ psd-adc16 overruns\n");
  iiod.Line();
  const std::int64_t counted = std::stoll(iiod.Line());
  // More than the server keeps: what it missed until it was asked, on a busy machine again, lies before their end.
  const Scans later = adc.Read(80000);
  const std::int64_t missed_later = (later.stamps_ns.back() - before.stamps_ns.back()) / 16000 - 100 - 80000;
  EXPECT_GE(counted, missed - 1);  // both are rounded
  EXPECT_LE(counted, missed_later + 1);
}

TEST(Pacing, TwoClientsOfTheConverterSeeTheSameScans) {
  ServedTwin served(OnFreePorts(1.0));
  BufferClient one(served.at().iiod_port, 1000), other(served.at().iiod_port, 1000);
  const Scans a = one.Read(4000), b = other.Read(4000);
  const auto start = std::find(a.stamps_ns.begin(), a.stamps_ns.end(), b.stamps_ns.front());
  ASSERT_NE(start, a.stamps_ns.end());
  const auto shift = start - a.stamps_ns.begin();
  for (int k = 0; k < kChannels * (4000 - shift); ++k) ASSERT_EQ(a.raw[k + kChannels * shift], b.raw[k]);
}

// What a held clock makes of scans; that all else is as in this process tests/contract/same_result_test.cc asks.

TEST(HeldClockOfTheBench, RestartedAsAnotherRunItHasTheBitsOfThatRunOfTheTwinAndThenItsOwnAgain) {
  Scenario third = test::RotaryScenario();
  third.repeat = 3;
  sim::Twin other(third);
  ServedTwin served(OnFreePorts(1.0), test::RotaryScenario());
  TcpClient scpi(served.at().scpi_port);
  BufferClient adc(served.at().iiod_port, 500);
  scpi.Ask("CLOC:HOLD ON;:SIM:PACE OFF;REST;*OPC?");
  const Scans own = adc.Read(100);
  EXPECT_EQ(scpi.AskNumber("SIM:REST 3;CLOC:NOW?"), 0);
  EXPECT_EQ(adc.Read(100).raw, other.Bench().adc.Acquire(100, true).raw);
  EXPECT_EQ(scpi.AskNumber("SIM:REST;CLOC:NOW?"), 0);
  const Scans again = adc.Read(100);
  EXPECT_EQ(again.raw, own.raw);
  EXPECT_EQ(again.stamps_ns, own.stamps_ns);
}

TEST(HeldClockOfTheBench, ScansAreStampedAtTheirInstants) {
  ServedTwin served(Altered(RotaryScenario(), {"adc.rate_kHz=300"}));  // 75 a channel: 13333.3 ns from scan to scan
  TcpClient scpi(served.at().scpi_port);
  EXPECT_EQ(scpi.Ask("CLOC:HOLD ON;WAIT? 1000"), "1000");
  const Scans scans = BufferClient(served.at().iiod_port, 100).Read(100);
  for (int s = 0; s < 100; ++s) EXPECT_EQ(scans.stamps_ns[s], 1000 + std::llround(s * 1e9 * kChannels / 3e5));
}

TEST(HeldClockOfTheBench, AFifoThatRunsFullLeavesAStepInTheTimeStamps) {
  Scenario scenario = test::RotaryScenario();
  RotaryOf(scenario).adc.fifo_samples = 1024;
  RotaryOf(scenario).adc.drain_rate_Hz = 125e3;  // half of what comes: full after 2048 conversions, 512 scans
  ServedTwin served(OnFreePorts(kAtOnce), scenario);
  TcpClient scpi(served.at().scpi_port), iiod(served.at().iiod_port);
  EXPECT_EQ(scpi.Ask("CLOC:HOLD ON;*OPC?"), "1");
  const Scans scans = BufferClient(served.at().iiod_port, 600).Read(600);
  EXPECT_EQ(scans.stamps_ns[511] - scans.stamps_ns[510], 16000);
  EXPECT_EQ(scans.stamps_ns[512] - scans.stamps_ns[511], 16000 * (1 + 600 - 512));
  EXPECT_EQ(iiod.AskNumber("READ psd-adc16 overruns"), 3);
  EXPECT_EQ(iiod.Line(), std::string("88\0", 3));
}

}  // namespace
}  // namespace twinbench::test
