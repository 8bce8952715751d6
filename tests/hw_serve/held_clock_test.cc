#include <gtest/gtest.h>

#include "tests/hw_serve/serving.h"

/// While a client holds the clock, every request is one call of the bench: the answers are those of the same calls
/// on a twin in this process, bit for bit.
namespace twinbench::test {
namespace {

Scenario Lively() {
  Scenario scenario = test::RotaryScenario();
  RotaryOf(scenario).amplifier.hum_V = 0.02;
  scenario.environment.drift_K_h = 3.0;
  RotaryOf(scenario).target.backlash_rad = 3.0 * units::arcsec;
  RotaryOf(scenario).reference.repeatability_sd = {1e-6, 1e-6, 1e-6, 1e-7, 1e-7, 1e-7};
  RotaryOf(scenario).procedure.clamping = "reclamp";
  return scenario;
}

class HeldClock : public testing::TestWithParam<const char*> {
 protected:
  static Scenario Its() {
    Scenario scenario = Lively();
    RotaryOf(scenario).mechanics.fidelity = GetParam();
    return scenario;
  }
  HeldClock() { scpi.Ask("CLOC:HOLD ON;:SIM:PACE OFF;REST;*OPC?"); }

  ServedTwin served{OnFreePorts(1.0), Its()};
  TcpClient scpi{served.at().scpi_port};
  BufferClient adc{served.at().iiod_port, 500};
  sim::Twin twin{Its()};
  RotaryBench bench = twin.Bench();

  double Angle(const std::string& text) { return ParseInUnit(text, units::deg).value(); }
  static void ExpectSameBits(double one, double other) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(one), std::bit_cast<std::uint64_t>(other));
  }
};

TEST_P(HeldClock, GivesTheAnswersOfTheSameCallsInProcess) {
  for (int stop = 1; stop <= 4; ++stop) {
    const double angle_rad = stop * 10.0 * units::deg / 3.0;
    scpi.Send("ROT1:ANGL " + PrintInUnit(angle_rad, units::deg) + ";:ROT2:ANGL " +
              PrintInUnit(-angle_rad, units::deg) + "\n");
    bench.target.StartMove(angle_rad);
    bench.reference.StartMove(-angle_rad);
    EXPECT_EQ(scpi.Ask("ROT1:SETT? 0.25"), bench.target.Settles(FromSeconds(0.25)) ? "1" : "0");
    ExpectSameBits(Angle(scpi.Ask("ROT2:ANGL?")), bench.reference.State().encoder_rad);
    EXPECT_EQ(scpi.Ask("ROT1:SETT? 60"), bench.target.Settles(FromSeconds(60)) ? "1" : "0");
    EXPECT_EQ(scpi.Ask("ROT2:SETT? 60"), bench.reference.Settles(FromSeconds(60)) ? "1" : "0");
    bench.clock.Wait(Duration(333'333'333));
    EXPECT_EQ(scpi.AskNumber("CLOC:WAIT? 333333333"), bench.clock.Now().time_since_epoch().count());
    ExpectSameBits(ParseInUnit(scpi.Ask("TEMP?"), 1.0).value(), bench.thermometer.Read_degC());
    const Acquisition block = bench.adc.Acquire(500, true);
    const Scans scans = adc.Read(500);
    EXPECT_EQ(scans.raw, block.raw);
    EXPECT_EQ(scans.stamps_ns.front(), block.start.time_since_epoch().count());
    if (stop == 2) {
      scpi.Send("FIXT:MOUN 1,0.01,0;:GON:MOVE 12.5,-7\n");
      scpi.Ask("*OPC?");
      bench.fixture.Mount(1, 0.01 * units::deg, 0.0);
      bench.goniometer.MoveTo(12.5 * units::arcsec, -7.0 * units::arcsec);
    }
  }
}

TEST_P(HeldClock, ARestartedBenchRepeatsItsBitsAndAsAnotherRunThoseOfThatRunOfTheTwin) {
  Scenario third = Its();
  third.repeat = 3;
  sim::Twin other(third);
  const Scans own = adc.Read(100);
  EXPECT_EQ(scpi.AskNumber("SIM:REST 3;CLOC:NOW?"), 0);
  const Scans scans = adc.Read(100);
  EXPECT_NE(scans.raw, own.raw);
  EXPECT_EQ(scans.raw, other.Bench().adc.Acquire(100, true).raw);
  EXPECT_EQ(scpi.AskNumber("SIM:REST;CLOC:NOW?"), 0);
  const Scans again = adc.Read(100);
  EXPECT_EQ(again.raw, own.raw);
  EXPECT_EQ(again.stamps_ns, own.stamps_ns);
}

INSTANTIATE_TEST_SUITE_P(Fidelities, HeldClock, testing::Values("kinematic", "linear"),
                         [](const auto& fidelity) { return std::string(fidelity.param); });

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
