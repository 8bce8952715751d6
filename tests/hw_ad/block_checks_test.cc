#include "hw_bridge/ad/block_checks.h"
#include "hw_bridge/ad/clock_watch.h"
#include "hw_bridge/ad/mains_hum.h"
#include "hw_bridge/ad/scan_stamps.h"
#include "hw_bridge/ad/volts.h"
#include "tests/hw_ad/blocks.h"
#include "tests/support/faults.h"
#include "tests/support/night.h"
#include "twin/core/block_statistics.h"

namespace twinbench::hw {
namespace {

using test::FourLevels, test::kLsb_V, test::kNoise_V, test::RawBlock;

CheckSettings Known(double noise_V) { return {.noise_lsb = noise_V / kLsb_V}; }

int Alarms(const BlockFindings& found) {
  return (found.stuck_mask != 0) + (found.floating_mask != 0) + (found.slip.scan >= 0);
}

/// Blocks of honest noise that raise an alarm, by whether the noise is known beforehand.
int FalseAlarms(const sim::AdInput& input, int scans, int blocks, double noise_V, const AdcSettings& adc = {}) {
  int alarms = 0;
  CheckSettings known{.bits = adc.bits, .noise_lsb = noise_V / sim::LsbOf(adc)}, unknown{.bits = adc.bits};
  for (int k = 0; k < blocks; ++k) {
    const auto raw = RawBlock(input, scans, static_cast<std::uint64_t>(k), adc);
    alarms += Alarms(CheckBlock(raw, known)) + Alarms(CheckBlock(raw, unknown));
  }
  return alarms;
}

// The stated rate is 1e-9 a block and check: not one alarm is expected in all of the following blocks together.

TEST(BlockChecks, PassCleanBlocksOfTheReferenceBenchAndOfAnyLength) {
  EXPECT_EQ(FalseAlarms(FourLevels(kNoise_V), 100, test::ByNight(100000, 10000), kNoise_V), 0);
  for (const int scans : {1, 2, 3, 7, 8, 10, 30, 1000})
    EXPECT_EQ(FalseAlarms(FourLevels(kNoise_V), scans, 2000, kNoise_V), 0) << scans;
}

TEST(BlockChecks, PassHonestBlocksThatShowFewCodes) {
  // From one code without noise at all to a handful; in 0.05 LSB most blocks have channels of one and of two codes.
  for (const double noise_lsb : {0.0, 0.02, 0.05, 0.2, 0.4, 0.6, 0.8, 1.0, 1.5}) {
    for (const int scans : {100, 2000}) {
      sim::AdInput input = FourLevels(noise_lsb * kLsb_V);
      // On a boundary between codes, near one, and amid them.
      for (std::size_t k = 0; k < kChannels; ++k)
        input.channel[k].level_V = (1000.0 * static_cast<double>(k) + 0.5 - 0.17 * static_cast<double>(k)) * kLsb_V;
      EXPECT_EQ(FalseAlarms(input, scans, test::ByNight(1000, 100), noise_lsb * kLsb_V), 0) << noise_lsb << " LSB, " << scans;
    }
  }
}

TEST(BlockChecks, DoNotTakeThreeFlickeringChannelsForNoiseThatTheFourthMustShow) {
  // 0.05 LSB: whoever stands on a boundary between codes shows two of them, whoever stands amid one shows that.
  sim::AdInput input = FourLevels(0.05 * kLsb_V);
  for (std::size_t k = 0; k < kChannels; ++k) input.channel[k].level_V = (1000.0 + (k < 3 ? 0.5 : 0.0)) * kLsb_V;
  EXPECT_EQ(CheckBlock(RawBlock(input, 2000, 1), {}).stuck_mask, 0);
}

TEST(BlockChecks, PassHumCrosstalkDriftAndEqualLevels) {
  for (const double hum_V : {0.0, 5e-3, 0.1, 1.0}) {
    for (const double slope_V_s : {0.0, 5.0, 60.0}) {
      for (const bool equal : {false, true}) {
        sim::AdInput input = FourLevels(kNoise_V);
        input.hum = {hum_V, 50.0, 0.3};
        for (std::size_t k = 0; k < kChannels; ++k) {
          input.channel[k].crosstalk = 0.01;
          input.channel[k].slope_V_s = k % 2 == 0 ? slope_V_s : 0.3 * slope_V_s;
          if (equal) input.channel[k].level_V = 0.3;
        }
        EXPECT_EQ(FalseAlarms(input, 100, 1000, kNoise_V), 0) << hum_V << " V, " << slope_V_s << " V/s, " << equal;
        EXPECT_EQ(FalseAlarms(input, 5000, 20, kNoise_V), 0) << hum_V << " V, " << slope_V_s << " V/s, " << equal;
      }
    }
  }
}

TEST(BlockChecks, PassTwelveBitsAndLevelsNearTheRail) {
  sim::AdInput input = FourLevels(kNoise_V);
  input.channel[1].level_V = 9.8;
  input.channel[3].level_V = -9.8;
  AdcSettings adc;
  EXPECT_EQ(FalseAlarms(input, 100, 5000, kNoise_V, adc), 0);
  adc.bits = 12;  // 1.2 LSB of noise
  EXPECT_EQ(FalseAlarms(input, 100, 5000, kNoise_V, adc), 0);
}

TEST(BlockChecks, FindAChannelThatSticksFromTheBeginOrHalfWayWhetherTheNoiseIsKnownOrNotButNotInTwoEqualScans) {
  for (const double noise_lsb : {0.0, kNoise_V / kLsb_V}) {
    for (const std::size_t from : {1u, 50u}) {
      auto raw = RawBlock(FourLevels(kNoise_V), 100, 1);
      for (std::size_t scan = from; scan < 100; ++scan) raw[4 * scan + 2] = raw[4 * (from - 1) + 2];
      EXPECT_EQ(CheckBlock(raw, {.noise_lsb = noise_lsb}).stuck_mask, 1 << 2) << from;
    }
  }
  const std::vector<std::int16_t> raw = {1, 2, 3, 4, 1, 2, 3, 4};
  EXPECT_EQ(CheckBlock(raw, Known(kNoise_V)).stuck_mask, 0);
}

TEST(BlockChecks, CallAChannelAtAnEndCodeSaturatedAndNotStuck) {
  sim::AdInput input = FourLevels(kNoise_V);
  input.channel[1].level_V = 11.0;
  input.channel[3].level_V = -11.0;
  const BlockFindings found = CheckBlock(RawBlock(input, 100, 1), Known(kNoise_V));
  EXPECT_EQ(found.saturated_mask, 0b1010);
  EXPECT_EQ(Alarms(found), 0);
}

TEST(BlockChecks, FindOpenInputsAtEveryPhaseOfTheMains) {
  // Near the rail, with pick-up of 5 % of the range and a charge that creeps; in 1.6 ms the mains is but a slope.
  for (int phase_deg = 0; phase_deg < 360; phase_deg += 5) {
    auto raw = RawBlock(FourLevels(kNoise_V), 100, static_cast<std::uint64_t>(phase_deg));
    for (const std::size_t k : {0, 1}) {
      for (std::size_t scan = 0; scan < 100; ++scan) {
        const double t_s = static_cast<double>(scan) * 16e-6;
        const double level = 0.9 + 0.01 * t_s / 1.6e-3 + 0.05 * std::sin(314.16 * t_s + phase_deg * units::deg);
        raw[4 * scan + k] = static_cast<std::int16_t>(level * 32767.0);
      }
    }
    const BlockFindings found = CheckBlock(raw, Known(kNoise_V));
    EXPECT_EQ(found.floating_mask, 0b0011) << phase_deg << " deg";
  }
}

TEST(BlockChecks, ReportTheMainsOfABlockOfAPeriodOrMoreAndDoNotRejectIt) {
  sim::AdInput input = FourLevels(kNoise_V);
  input.hum = {0.05, 50.0, 1.0};
  const BlockFindings found = CheckBlock(RawBlock(input, 6250, 1), Known(kNoise_V));  // 0.1 s: 5 periods
  EXPECT_EQ(Alarms(found), 0);
  // Amplitude from n samples of noise s: standard uncertainty s sqrt(2 / n) = 0.35 LSB; five of them.
  for (const double mains_lsb : found.mains_lsb) EXPECT_NEAR(mains_lsb, 0.05 / kLsb_V, 1.8);
  for (const double mains_lsb : CheckBlock(RawBlock(FourLevels(kNoise_V), 1249, 1), {}).mains_lsb)
    EXPECT_TRUE(std::isnan(mains_lsb));
}

TEST(BlockChecks, EstimateTheNoiseUnderDrift) {
  sim::AdInput input = FourLevels(kNoise_V);
  for (auto& channel : input.channel) channel.slope_V_s = 5.0;
  for (const double noise_lsb : CheckBlock(RawBlock(input, 10000, 1), {}).noise_lsb) {
    // Relative uncertainty sqrt(3 / 4n) = 0.9 %; five of them. The slope adds 80 uV a scan: 0.01 %.
    EXPECT_NEAR(noise_lsb / (kNoise_V / kLsb_V), 1.0, 0.045);
  }
}

TEST(BlockChecks, NameChannels) {
  EXPECT_EQ(ChannelsIn(0b1001), "psd_a_x and psd_b_y");
}

TEST(Volts, AreThePolynomialAboutItsOrigin) {
  const CalibrationPolynomial cubic{2.0, {1.0, 0.5, -0.25, 0.125}};
  EXPECT_DOUBLE_EQ(VoltsOf(5.0, cubic), 1.0 + 0.5 * 3.0 - 0.25 * 9.0 + 0.125 * 27.0);
}

TEST(Volts, OfALinearCalibrationAreThoseOfTheCodesScaledWithoutADeviationOfOneSample) {
  const auto raw = RawBlock(FourLevels(kNoise_V), 1000, 1);
  const ChannelBlock calibrated = CalibratedStatistics(raw, 2, {-7.0, {0.1, 1.01 * kLsb_V}});
  const ChannelBlock plain = StatisticsOf(MomentsOf(raw, kChannels, 2), kLsb_V);
  // Sums of a thousand doubles.
  EXPECT_NEAR(calibrated.mean_V, 0.1 + 1.01 * (plain.mean_V + 7.0 * kLsb_V), 1e-12);
  EXPECT_NEAR(calibrated.std_V, 1.01 * plain.std_V, 1e-12);
  EXPECT_NEAR(calibrated.min_V, 0.1 + 1.01 * (plain.min_V + 7.0 * kLsb_V), 1e-12);
  EXPECT_NEAR(calibrated.max_V, 0.1 + 1.01 * (plain.max_V + 7.0 * kLsb_V), 1e-12);
  const std::vector<std::int16_t> one = {1, 2, 3, 4};
  EXPECT_TRUE(std::isnan(CalibratedStatistics(one, 0, {0.0, {0.0, 1.0}}).std_V));
}

using std::chrono::milliseconds, std::chrono::seconds;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

TEST(ClockWatch, LetsClocksDriftApartByAHundredPpmAllowsForTheTimeThatAsksTakeAndFollowsABenchThatStartsAgain) {
  ClockWatch drifting, slow, again;
  for (int k = 0; k < 100; ++k)
    drifting.Compare(7 * kSecond_ns + k * (60 * kSecond_ns + 3'000'000), Time(seconds(60 * k)), {});
  slow.Compare(0, Time(seconds(0)), milliseconds(300));
  slow.Compare(kSecond_ns + kSecond_ns / 4, Time(seconds(1)), milliseconds(1));
  again.Compare(100 * kSecond_ns, Time(seconds(100)), {});
  again.Compare(kSecond_ns, Time(seconds(1)), {});
}

TEST(ClockWatch, CallsAStepOfASecondAFaultAndGoesOnFromThere) {
  ClockWatch watch;
  watch.Compare(0, Time(seconds(0)), milliseconds(1));
  EXPECT_EQ(test::KindOf([&] { watch.Compare(9 * kSecond_ns, Time(seconds(1)), milliseconds(1)); }),
            FaultKind::kClock);
  watch.Compare(10 * kSecond_ns, Time(seconds(2)), milliseconds(1));
}

TEST(ClockWatch, BelievesNoBlockOfAClockThatStands) {
  ClockWatch watch;
  watch.Compare(0, Time(seconds(0)), milliseconds(1));
  for (int k = 1; k < 4; ++k)
    EXPECT_EQ(test::KindOf([&] { watch.Compare(0, Time(seconds(k)), milliseconds(1)); }), FaultKind::kClock) << k;
}

TEST(ClockWatch, TellsHowFastTheCardsClockGoes) {
  ClockWatch watch;
  EXPECT_TRUE(std::isnan(watch.DriftSoFar().ppm));
  for (int k = 0; k <= 60; ++k)  // 25 ppm fast: 1.5 ms a minute
    watch.Compare(k * (60 * kSecond_ns + 1'500'000), Time(seconds(60 * k)), milliseconds(12));
  const ClockWatch::Drift drift = watch.DriftSoFar();
  EXPECT_NEAR(drift.ppm, 25.0, 1e-9);
  // Two latencies of up to 12 ms, each rectangular, over an hour.
  EXPECT_NEAR(drift.u_ppm, 1e6 * std::sqrt(2.0) * 12e-3 / std::sqrt(12.0) / 3600.0, 1e-9);
  watch.Forget();
  watch.Compare(0, Time(seconds(4000)), {});
  EXPECT_TRUE(std::isnan(watch.DriftSoFar().ppm)) << "a card that came back begins anew";
}

std::vector<std::int64_t> Stamps(int scans, double rate_Hz, std::int64_t start_ns = 0) {
  std::vector<std::int64_t> stamps_ns;
  for (int s = 0; s < scans; ++s) stamps_ns.push_back(start_ns + std::llround(s * 1e9 / rate_Hz));
  return stamps_ns;
}

TEST(ScanStamps, OfAWholeBlockHaveNoGapAndOfOneScanOrNoneSayNothing) {
  for (const double rate_Hz : {1.0, 48e3, 62.5e3, 250e3, 1.0 / 3.0}) {
    const StampFindings found = JudgeStamps(Stamps(1000, rate_Hz), rate_Hz);
    EXPECT_EQ(found.lost_scans, 0);
    EXPECT_EQ(found.first_gap, -1);
    EXPECT_EQ(found.first_back, -1);
  }
  EXPECT_EQ(JudgeStamps({}, 62.5e3).lost_scans, 0);
  EXPECT_EQ(JudgeStamps(Stamps(1, 62.5e3), 62.5e3).lost_scans, 0);
}

TEST(ScanStamps, CountWhatIsMissingAndWhereAndNoteWhereTheyGoBack) {
  auto stamps_ns = Stamps(1000, 62.5e3);
  stamps_ns.erase(stamps_ns.begin() + 700, stamps_ns.begin() + 705);
  stamps_ns.erase(stamps_ns.begin() + 300);
  const StampFindings found = JudgeStamps(stamps_ns, 62.5e3);
  EXPECT_EQ(found.lost_scans, 6);
  EXPECT_EQ(found.first_gap, 300);
  auto back_ns = Stamps(100, 62.5e3, 5'000'000'000);
  for (std::size_t s = 40; s < 100; ++s) back_ns[s] -= 1'000'000'000;
  EXPECT_EQ(JudgeStamps(back_ns, 62.5e3).first_back, 40);
}

TEST(ScanStamps, MayJitterByLessThanHalfAPeriodAndRunFast) {
  auto stamps_ns = Stamps(1000, 62.5e3);
  for (std::size_t s = 0; s < stamps_ns.size(); ++s)
    stamps_ns[s] += (s % 2 == 0 ? 3900 : 0) + std::llround(static_cast<double>(stamps_ns[s]) * 1e-3);
  EXPECT_EQ(JudgeStamps(stamps_ns, 62.5e3).lost_scans, 0);
  EXPECT_EQ(JudgeStamps(stamps_ns, 62.5e3).first_back, -1);
}

}  // namespace
}  // namespace twinbench::hw
