#include "tests/hw_serve/serving.h"

/// What a held clock makes of scans; that all else is as in this process tests/contract/same_result_test.cc asks.
namespace twinbench::test {
namespace {

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
  Scenario scenario = test::RotaryScenario();
  RotaryOf(scenario).adc.rate_Hz = 3e5;  // 75 kHz a channel: 13333.3 ns from scan to scan
  ServedTwin served(OnFreePorts(kAtOnce), scenario);
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
