#include "tests/contract/rotary_bench.h"

#include "tests/support/rotary_scenario.h"

/// The contract of twin/core/devices.h. Every backend of a rotary bench goes through the same tests; a new one adds
/// a line to Backends() in backends.cc.
namespace twinbench::test {
namespace {

using std::chrono::milliseconds, std::chrono::seconds;

constexpr double kInPosition_rad = 0.02 * units::arcsec;
constexpr int kSamples = 200;

class RotaryBenchContract : public ::testing::TestWithParam<BenchBackend> {
 protected:
  void SetUp() override {
    if (!GetParam().missing.empty()) GTEST_SKIP() << GetParam().missing;
  }
  /// Sets up a bench of this scenario; the one before goes.
  RotaryBench NewBench(const Scenario& scenario) {
    living_.reset();  // there is one bench
    living_ = GetParam().make(scenario);
    return living_->Bench();
  }
  RotaryBench NewBench() { return NewBench(test::RotaryScenario()); }

  static void GoTo(RotaryTable& table, double to_deg) {
    table.StartMove(to_deg * units::deg);
    table.WaitSettled();
  }
  static void GoTo(RotaryBench& bench, double target_rad, double reference_rad) {
    bench.target.StartMove(target_rad);
    bench.reference.StartMove(reference_rad);
    bench.target.WaitSettled();
    bench.reference.WaitSettled();
  }

 private:
  std::unique_ptr<LivingBench> living_;
};

std::array<double, kChannels> Means(const Acquisition& block) {
  return {block.channel[0].mean_V, block.channel[1].mean_V, block.channel[2].mean_V, block.channel[3].mean_V};
}

/// Standard uncertainty of the difference of two blocks' means.
double SigmaOfDifference(const ChannelBlock& a, const ChannelBlock& b) {
  return std::hypot(a.std_V, b.std_V) / std::sqrt(static_cast<double>(kSamples));
}

/// The same light on two blocks: means apart by noise alone.
void ExpectDifferOnlyByNoise(const Acquisition& a, const Acquisition& b) {
  for (std::size_t c = 0; c < kChannels; ++c) {
    // Five sigma, and one step of a 16-bit converter over 20 V for noise that is smaller than a step.
    EXPECT_NEAR(a.channel[c].mean_V, b.channel[c].mean_V,
                5.0 * SigmaOfDifference(a.channel[c], b.channel[c]) + 20.0 / 65536.0)
        << kChannelNames[c];
  }
}

TEST_P(RotaryBenchContract, TablesReachTheirAnglesAndStayThereAndCounterRotationKeepsTheLightOnThePsds) {
  RotaryBench bench = NewBench();
  for (const double angle_deg : {10.0, 20.0, 180.0, 330.0, -5.0, 365.0, 0.0}) {
    GoTo(bench, angle_deg * units::deg, -angle_deg * units::deg);
    EXPECT_NEAR(bench.target.EncoderAngle_rad(), angle_deg * units::deg, kInPosition_rad) << angle_deg;
    EXPECT_NEAR(bench.reference.EncoderAngle_rad(), -angle_deg * units::deg, kInPosition_rad) << angle_deg;
    EXPECT_EQ(bench.adc.Acquire(kSamples, false).status, ReadingStatus::kOk) << angle_deg;
    bench.clock.Wait(seconds(1));
    EXPECT_NEAR(bench.target.EncoderAngle_rad(), angle_deg * units::deg, kInPosition_rad) << angle_deg;
  }
}

TEST_P(RotaryBenchContract, StartMoveOfOneTableReturnsAtOnceAndWaitSettledTakesTheTimeNoneAtRestAndTheOtherStays) {
  RotaryBench bench = NewBench();
  const Time before = bench.clock.Now();
  bench.target.StartMove(10.0 * units::deg);
  // "At once" is short beside the move's 0.6 s, also for a controller at the end of a serial line.
  EXPECT_LT(bench.clock.Now() - before, milliseconds(100));
  bench.target.WaitSettled();
  EXPECT_GE(bench.clock.Now() - before, milliseconds(600));
  EXPECT_NEAR(bench.reference.EncoderAngle_rad(), 0.0, kInPosition_rad) << "the other stays";
  const Time settled = bench.clock.Now();
  bench.target.WaitSettled();
  GoTo(bench.target, 10.0);  // where it already stands
  EXPECT_LT(bench.clock.Now() - settled, seconds(2));
  EXPECT_NEAR(bench.target.EncoderAngle_rad(), 10.0 * units::deg, kInPosition_rad);
}

TEST_P(RotaryBenchContract, AMoveDuringAMoveIsRefusedOrReplacesItButNeverLost) {
  RotaryBench bench = NewBench();
  bench.target.StartMove(20.0 * units::deg);
  bench.clock.Wait(milliseconds(300));
  double end_deg = 5.0;
  try {
    bench.target.StartMove(end_deg * units::deg);
  } catch (const std::exception&) {
    end_deg = 20.0;  // refused: the first move goes on as if nothing had been asked
  }
  bench.target.WaitSettled();
  EXPECT_NEAR(bench.target.EncoderAngle_rad(), end_deg * units::deg, kInPosition_rad);
  GoTo(bench.target, -5.0);
  EXPECT_NEAR(bench.target.EncoderAngle_rad(), -5.0 * units::deg, kInPosition_rad);
}

TEST_P(RotaryBenchContract, StateTellsOfMotionAndRestAndAStopBringsATableToRestOnItsWayAndTheNextMoveGoesOn) {
  RotaryBench bench = NewBench();
  EXPECT_TRUE(bench.target.State().in_position);
  EXPECT_TRUE(bench.target.State().referenced);
  bench.target.StartMove(90.0 * units::deg);
  bench.clock.Wait(milliseconds(500));
  const TableState state = bench.target.State();
  EXPECT_TRUE(state.moving);
  EXPECT_FALSE(state.in_position);
  EXPECT_NEAR(state.commanded_rad, 90.0 * units::deg, 1e-12);
  EXPECT_LT(state.encoder_rad, 60.0 * units::deg);
  EXPECT_FALSE(bench.target.Settles(milliseconds(1)));
  bench.clock.Wait(milliseconds(1000));
  bench.target.Stop();
  bench.target.WaitSettled();
  const double rest_deg = bench.target.EncoderAngle_rad() / units::deg;
  EXPECT_GT(rest_deg, 5.0);
  EXPECT_LT(rest_deg, 85.0);
  bench.clock.Wait(seconds(2));
  EXPECT_NEAR(bench.target.EncoderAngle_rad() / units::deg, rest_deg, kInPosition_rad / units::deg);
  GoTo(bench.target, 90.0);
  EXPECT_NEAR(bench.target.EncoderAngle_rad(), 90.0 * units::deg, kInPosition_rad);
  EXPECT_FALSE(bench.target.State().moving);
  EXPECT_TRUE(bench.target.State().in_position);
}

TEST_P(RotaryBenchContract, NothingIsMountedWhileATableMoves) {
  RotaryBench bench = NewBench();
  bench.target.StartMove(20.0 * units::deg);
  bench.clock.Wait(milliseconds(300));
  EXPECT_THROW(bench.fixture.Mount(1, 0.0, 0.0), BenchError);
  bench.target.WaitSettled();
  EXPECT_NO_THROW(bench.fixture.Mount(1, 0.0, 0.0));
}

TEST_P(RotaryBenchContract, ASimulatedBenchStartsAgainAsItWas) {
  RotaryBench bench = NewBench();
  if (!bench.simulation) GTEST_SKIP() << "a real bench does not";
  const auto session = [&] {
    GoTo(bench, 0.3, -0.3);
    const double yaw_rad = bench.autocollimator.Read().yaw_rad, room_degC = bench.thermometer.Read_degC();
    const Acquisition block = bench.adc.Acquire(kSamples, false);
    return std::array<double, 5>{block.channel[0].mean_V, block.channel[3].std_V, yaw_rad, room_degC,
                                 ToSeconds(block.start)};
  };
  bench.simulation->Restart();
  const auto first = session();
  bench.target.StartMove(1.0);  // left in the middle of something
  bench.simulation->Restart();
  EXPECT_EQ(bench.clock.Now(), Time{});
  EXPECT_EQ(session(), first);
}

TEST_P(RotaryBenchContract, TheClockNeverGoesBackAndWaitsExactly) {
  RotaryBench bench = NewBench();
  Time last = bench.clock.Now();
  const auto expect_later = [&](const char* call) {
    EXPECT_GE(bench.clock.Now(), last) << call;
    last = bench.clock.Now();
  };
  for (const Duration wait : {Duration(0), Duration(1), Duration(milliseconds(7)), Duration(seconds(100))}) {
    bench.clock.Wait(wait);
    EXPECT_EQ(bench.clock.Now() - last, wait);
    expect_later("wait");
  }
  bench.fixture.Mount(1, 0.0, 0.0);
  expect_later("mount");
  GoTo(bench, 0.1, -0.1);
  expect_later("move");
  bench.adc.Acquire(kSamples, false);
  expect_later("acquire");
  bench.autocollimator.Read();
  bench.thermometer.Read_degC();
  bench.goniometer.MoveTo(1e-4, 0.0);
  expect_later("instruments");
}

TEST_P(RotaryBenchContract, ABlockHasTheSamplesThatWereAskedFor) {
  RotaryBench bench = NewBench();
  for (const int samples : {1, 2, 100, 5000}) {
    const Time request = bench.clock.Now();
    const Acquisition block = bench.adc.Acquire(samples, false);
    EXPECT_EQ(block.status, ReadingStatus::kOk);
    EXPECT_EQ(block.n_samples, samples);
    EXPECT_GE(block.start, request);
    EXPECT_GT(bench.clock.Now(), block.start);  // it took its time
    for (const ChannelBlock& channel : block.channel) {
      EXPECT_LE(channel.min_V, channel.mean_V);
      EXPECT_LE(channel.mean_V, channel.max_V);
      if (samples > 1) {
        EXPECT_GT(channel.std_V, 0.0);
        EXPECT_LE(channel.std_V, channel.max_V - channel.min_V);
      }
    }
  }
}

TEST_P(RotaryBenchContract, RawSamplesComeOnlyWhenAskedForAndAgreeWithTheBlock) {
  RotaryBench bench = NewBench();
  // A real card delivers counts and nothing else; they are always there.
  const bool without = bench.adc.Acquire(kSamples, false).raw.empty();
  EXPECT_NE(without, GetParam().always_has_raw);
  bench.goniometer.MoveTo(100.0 * units::arcsec, 50.0 * units::arcsec);
  const Acquisition block = bench.adc.Acquire(kSamples, true);
  ASSERT_EQ(block.raw.size(), static_cast<std::size_t>(kSamples) * kChannels);
  const double step_V = 20.0 / 65536.0;  // 16 bits over +-10 V
  for (std::size_t c = 0; c < kChannels; ++c) {
    double sum = 0.0;
    std::int16_t lowest = INT16_MAX, highest = INT16_MIN;
    for (std::size_t scan = 0; scan < kSamples; ++scan) {
      const std::int16_t code = block.raw[scan * kChannels + c];
      sum += code;
      lowest = std::min(lowest, code);
      highest = std::max(highest, code);
    }
    // A code stands for a voltage within its step: half a step of convention, the rest is rounding.
    EXPECT_NEAR(sum / kSamples * step_V, block.channel[c].mean_V, 0.51 * step_V);
    EXPECT_NEAR(lowest * step_V, block.channel[c].min_V, 0.51 * step_V);
    EXPECT_NEAR(highest * step_V, block.channel[c].max_V, 0.51 * step_V);
  }
}

TEST_P(RotaryBenchContract, ABlockWithoutLightHasAStatusAndNoNumbers) {
  RotaryBench bench = NewBench();
  bench.goniometer.MoveTo(3.0 * units::deg, 0.0);  // 13 mm on PSDs that reach 5 mm
  const Time request = bench.clock.Now();
  const Acquisition block = bench.adc.Acquire(kSamples, true);
  EXPECT_NE(block.status, ReadingStatus::kOk);
  EXPECT_GE(block.start, request);
  for (const ChannelBlock& channel : block.channel) {
    for (const double value_V : {channel.mean_V, channel.std_V, channel.min_V, channel.max_V})
      EXPECT_TRUE(std::isnan(value_V));
  }
  bench.goniometer.MoveTo(0.0, 0.0);
  EXPECT_EQ(bench.adc.Acquire(kSamples, false).status, ReadingStatus::kOk) << "light again, readings again";
}

TEST_P(RotaryBenchContract, ASaturatedChannelHasNoMeanAndItsBlockAStatus) {
  Scenario scenario = test::RotaryScenario();
  RotaryOf(scenario).amplifier.offset_V[1] = 11.0;
  RotaryBench bench = NewBench(scenario);
  const Acquisition block = bench.adc.Acquire(kSamples, false);
  EXPECT_EQ(block.status, ReadingStatus::kSaturated);
  EXPECT_TRUE(std::isnan(block.channel[1].mean_V));
  EXPECT_TRUE(std::isnan(block.channel[1].std_V));
}

TEST_P(RotaryBenchContract, ReadingTwiceDiffersOnlyByNoise) {
  RotaryBench bench = NewBench();
  bench.goniometer.MoveTo(100.0 * units::arcsec, 50.0 * units::arcsec);
  const Acquisition first = bench.adc.Acquire(kSamples, false), second = bench.adc.Acquire(kSamples, false);
  ExpectDifferOnlyByNoise(first, second);
  EXPECT_NE(Means(first), Means(second)) << "noise of its own in every block";
}

TEST_P(RotaryBenchContract, MountedAgainUnchangedReadsTheSame) {
  RotaryBench bench = NewBench();  // seating scatter is zero by default
  bench.fixture.Mount(0, 0.0, 0.0);
  const Acquisition first = bench.adc.Acquire(kSamples, false);
  for (int setup = 1; setup < 4; ++setup) {
    bench.fixture.Mount(setup, 0.0, 0.0);
    GoTo(bench, 0.0, 0.0);
    ExpectDifferOnlyByNoise(first, bench.adc.Acquire(kSamples, false));
  }
}

TEST_P(RotaryBenchContract, AMountingTakesTheShiftBack) {
  // In both ways of clamping the light is back on the PSDs: reference at `shift`, and that taken back by hand.
  for (const bool reseat : {true, false}) {
    Scenario scenario = test::RotaryScenario();
    RotaryOf(scenario).procedure.clamping = reseat ? "reseat" : "reclamp";
    RotaryBench bench = NewBench(scenario);
    const Acquisition before = bench.adc.Acquire(kSamples, false);
    const double shift_rad = 70.0 * units::deg;
    bench.fixture.Mount(1, reseat ? 0.0 : shift_rad, reseat ? -shift_rad : 0.0);
    GoTo(bench, 0.0, shift_rad);
    const Acquisition after = bench.adc.Acquire(kSamples, false);
    ASSERT_EQ(after.status, ReadingStatus::kOk);
    for (std::size_t c = 0; c < kChannels; ++c) {
      // In position within 0.02 arcsec: 0.1 mV at 2 kV/m and 0.25 m a radian.
      EXPECT_NEAR(after.channel[c].mean_V, before.channel[c].mean_V,
                  5.0 * SigmaOfDifference(before.channel[c], after.channel[c]) + 20.0 / 65536.0 + 1e-4);
    }
  }
}

TEST_P(RotaryBenchContract, TheAutocollimatorReadsTheGoniometerAndTheThermometerARoom) {
  RotaryBench bench = NewBench();
  bench.goniometer.MoveTo(200.0 * units::arcsec, -100.0 * units::arcsec);
  EXPECT_NEAR(bench.thermometer.Read_degC(), 20.0, 10.0);
  const AutocollimatorReading reading = bench.autocollimator.Read();
  // Noise 0.02 arcsec: five sigma.
  EXPECT_NEAR(reading.yaw_rad / units::arcsec, 200.0, 0.1);
  EXPECT_NEAR(reading.tilt_rad / units::arcsec, -100.0, 0.1);
  bench.goniometer.MoveTo(1.0 * units::deg, 0.0);
  EXPECT_TRUE(std::isnan(bench.autocollimator.Read().yaw_rad)) << "out of its range of 410 arcsec";
}

TEST_P(RotaryBenchContract, SameSeedSameBits) {
  if (!GetParam().repeats_its_bits) GTEST_SKIP() << "a real bench has no seed";
  Scenario scenario =
      Altered(RotaryScenario(), {"reference.seating.ez_arcsec=5", "target.repeatability.ex_arcsec=1"});
  const auto session = [&](std::uint64_t seed) {
    scenario.seed = seed;
    RotaryBench bench = NewBench(scenario);
    bench.fixture.Mount(1, 0.0, 0.0);
    GoTo(bench, 0.3, -0.3);
    std::vector<double> numbers;
    for (const double mean_V : Means(bench.adc.Acquire(kSamples, false))) numbers.push_back(mean_V);
    for (const double number : {bench.target.EncoderAngle_rad(), bench.autocollimator.Read().yaw_rad,
                                bench.thermometer.Read_degC(), ToSeconds(bench.clock.Now())})
      numbers.push_back(number);
    return numbers;
  };
  const std::vector<double> first = session(7);
  EXPECT_EQ(first, session(7));
  EXPECT_NE(first, session(8));
}

INSTANTIATE_TEST_SUITE_P(EveryBackend, RotaryBenchContract, ::testing::ValuesIn(Backends()),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace twinbench::test
