#include "tests/support/night.h"
#include "tests/support/rotary_scenario.h"
#include "twin/benches/rotary_4dof/twin/psd_noise.h"
#include "twin/benches/rotary_4dof/twin/speckle.h"
#include "twin/benches/rotary_4dof/twin/twin.h"
#include "twin/sim/beam_wander.h"
#include "twin/sim/flicker_noise.h"
#include "twin/sim/low_pass.h"

namespace twinbench::sim {
namespace {

constexpr double kRms_m = 2e-6, kCorrelation_rad = 130.0 * units::arcsec;

GratingSettings Rough() {
  GratingSettings grating;
  grating.speckle_m = kRms_m;
  grating.speckle_correlation_rad = kCorrelation_rad;
  return grating;
}

Pose Turned(double yaw_rad, double tilt_rad) {
  Pose pose = Pose::Identity();
  pose.rotate(Eigen::AngleAxisd(yaw_rad, Vector3::UnitZ()) * Eigen::AngleAxisd(tilt_rad, Vector3::UnitX()));
  return pose;
}

std::array<double, kChannels> Displacement_m(std::uint64_t seed, const Pose& X_LG) {
  std::array<double, kChannels> spots_m{};
  Speckle(Rough(), seed).Move(X_LG, spots_m);
  return spots_m;
}

const int kSeeds = test::ByNight(4000, 1000);

/// Over many gratings and all channels: mean of the product at two turns, over the stated variance.
double Correlation(const Pose& a, const Pose& b) {
  double sum = 0.0;
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(kSeeds); ++seed) {
    const auto at_a_m = Displacement_m(seed, a), at_b_m = Displacement_m(seed, b);
    for (std::size_t c = 0; c < kChannels; ++c) sum += at_a_m[c] * at_b_m[c] / (kChannels * kSeeds);
  }
  return sum / (kRms_m * kRms_m);
}

TEST(Speckle, HasTheStatedSizeAndCorrelation) {
  const Pose start = Turned(40.0 * units::arcsec, -70.0 * units::arcsec);
  const double tolerance = 5.0 * std::sqrt(2.0 / (kChannels * kSeeds));
  EXPECT_NEAR(Correlation(start, start), 1.0, tolerance);
  for (const double turn : {0.3, 1.0, 2.0}) {
    const double expected = std::exp(-turn * turn), turn_rad = turn * kCorrelation_rad;
    const Pose yawed = Turned(40.0 * units::arcsec + turn_rad, -70.0 * units::arcsec);
    const Pose both = Turned(40.0 * units::arcsec + 0.6 * turn_rad, -70.0 * units::arcsec + 0.8 * turn_rad);
    EXPECT_NEAR(Correlation(start, yawed), expected, tolerance) << turn;
    EXPECT_NEAR(Correlation(start, both), expected, tolerance) << turn;
  }
}

TEST(Speckle, IsNormalAndOfItsOwnOnEveryChannel) {
  double fourth = 0.0, product = 0.0;
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(kSeeds); ++seed) {
    const auto spots_m = Displacement_m(seed, Turned(0.0, 0.0));
    for (const double spot_m : spots_m) fourth += std::pow(spot_m / kRms_m, 4) / (kChannels * kSeeds);
    product += spots_m[0] * spots_m[2] / (kRms_m * kRms_m) / kSeeds;
  }
  EXPECT_NEAR(fourth, 3.0, 5.0 * std::sqrt(96.0 / (kChannels * kSeeds)));
  EXPECT_NEAR(product, 0.0, 5.0 / std::sqrt(double(kSeeds)));
}

TEST(Ruling, ShowsWhereABeamMeetsTheGratingBesideItsMiddle) {
  Scenario scenario = Quiet();
  RotaryOf(scenario).laser.position_m.x() = 2e-3;
  const double before_V = Twin(scenario).Bench().adc.Acquire(4, false).channel[0].mean_V;
  RotaryOf(scenario).grating.ruling_chirp_per_m = 50e-6 / units::mm;
  const double after_V = Twin(scenario).Bench().adc.Acquire(4, false).channel[0].mean_V;
  const double cosine = std::sqrt(1.0 - 0.39 * 0.39), turned_rad = 2.0 * 50e-6 * 0.39 / cosine;
  // The spot lies 2 mm cos aside on its detector: the way to it is as long, seen from there.
  EXPECT_NEAR(after_V - before_V, -2000.0 * 0.12 * turned_rad, 0.02 * 2000.0 * 0.12 * turned_rad);
}

/// Allan variance of means over `tau_s`, from seconds of its own for each seed. Of flicker noise with power
/// spectral density h / f it is 2 ln 2 h whatever tau is; one decade holds h ln 10 (IEEE Std 1139).
double AllanVariance(double tau_s, int seeds) {
  double sum = 0.0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const FlickerNoise noise(1.0, static_cast<std::uint64_t>(seed), "test");
    constexpr int kPairs = 10, kSamples = 200;
    for (int pair = 0; pair < kPairs; ++pair) {
      double difference = 0.0;
      for (int k = 0; k < kSamples; ++k) {
        const double t_s = (2.0 * pair + (k + 0.5) / kSamples) * tau_s;
        difference += (noise.At(t_s + tau_s) - noise.At(t_s)) / kSamples;
      }
      sum += 0.5 * difference * difference / (kPairs * seeds);
    }
  }
  return sum;
}

TEST(FlickerNoise, HasTheSameAllanVarianceOverSecondsAndMinutesAndIsNothingIfNotAskedFor) {
  const double expected = 2.0 * std::log(2.0) / std::log(10.0);
  const int seeds = test::ByNight(200, 50);
  for (const double tau_s : {1.0, 10.0, 60.0})  // four standard deviations, of some correlated pairs
    EXPECT_NEAR(AllanVariance(tau_s, seeds), expected, 0.12 * std::sqrt(200.0 / seeds) * expected);
  EXPECT_EQ(FlickerNoise(0.0, 1, "test").At(3.0), 0.0);
  EXPECT_TRUE(std::isinf(FlickerNoise(0.0, 1, "test").Shortest_s()));
}

/// Of the mean over `corners` periods of the corner: integral of the stated spectrum times sinc^2(pi f T), by
/// Simpson over the logarithm of the frequency; 0: of a single value.
double VarianceOfMean(double corners) {
  constexpr int kIntervals = 20000;
  const double from = std::log(BeamWander::kLowest), to = std::log(BeamWander::kHighest);
  double total = 0.0, mean = 0.0;
  for (int k = 0; k <= kIntervals; ++k) {
    const double x = std::exp(from + (to - from) * k / kIntervals);
    const double weight = k == 0 || k == kIntervals ? 1.0 : (k % 2 == 1 ? 4.0 : 2.0);
    const double density = weight * std::cbrt(x) / (1.0 + x * x), y = units::kPi * x * corners;
    total += density;
    mean += density * (y == 0.0 ? 1.0 : std::pow(std::sin(y) / y, 2));
  }
  return mean / total;
}

TEST(BeamWander, HasMeansThatScatterAsTheSpectrumSays) {
  constexpr int kWanders = 4000, kPoints = 100;
  for (const double corners : {0.0, 0.1, 1.0, 4.0}) {
    double squares = 0.0;
    for (int seed = 0; seed < kWanders; ++seed) {
      const BeamWander wander(3.0, 50.0, static_cast<std::uint64_t>(seed), "test");
      double mean = 0.0;
      for (int k = 0; k < kPoints; ++k) mean += wander.At((k + 0.5) / kPoints * corners / 50.0) / kPoints;
      squares += mean * mean / kWanders;
    }
    const double expected = 9.0 * VarianceOfMean(corners);
    EXPECT_NEAR(squares, expected, 5.0 * std::sqrt(2.0 / kWanders) * expected) << corners;
  }
}

int Blocks() { return test::ByNight(1500, 400); }

/// Mean of squares of the means of blocks of so many scans on one channel, minutes apart.
double SquareOfMeans_V2(int scans, int channel) {
  Scenario scenario = OnlyTheLightsNoise();
  RotaryOf(scenario).optics.wander_rad = 100e-6;
  RotaryOf(scenario).optics.wander_corner_Hz = 200.0;
  Twin twin(scenario);
  const int blocks = Blocks();
  double squares_V2 = 0.0;
  for (int k = 0; k < blocks; ++k) {
    squares_V2 += std::pow(twin.Bench().adc.Acquire(scans, false).channel[channel].mean_V, 2) / blocks;
    twin.Bench().clock.Wait(FromSeconds(17.3));
  }
  return squares_V2;
}

// Up and down: the pitch at the laser over the whole way, and what the arm's own air does.
TEST(BeamWander, GrowsWithTheWayIsLeftInBlockMeansAsItsSpectrumSaysAndIsNoneInARunWithoutNoise) {
  const double way_m = 0.2, arm_m = 0.12;
  const double by_laser_m = 100e-6 * std::sqrt(way_m) * (way_m + arm_m),
               by_arm_m = 100e-6 * std::sqrt(arm_m) * arm_m;
  const double single_V2 = std::pow(2000.0 * std::hypot(by_laser_m, by_arm_m), 2);
  const double tolerance = 5.0 * std::sqrt(2.0 / Blocks()) * 1.3;  // neighbours are not quite independent
  EXPECT_NEAR(SquareOfMeans_V2(1, 1) / single_V2, 1.0, tolerance);
  const double block_s = 625 * 16e-6;  // two periods of the corner
  EXPECT_NEAR(SquareOfMeans_V2(625, 3) / single_V2 / VarianceOfMean(200.0 * block_s), 1.0, tolerance);
  Scenario scenario = Quiet();
  RotaryOf(scenario).optics.wander_rad = 100e-6;
  EXPECT_EQ(Twin(scenario).Bench().adc.Acquire(100, false).channel[0].std_V, 0.0);
}

constexpr double kStep_s = 4e-6;

// An edge that takes one knot's distance h is followed by 1 - (lag / h) (1 - exp(-h / lag)) exp(-t / lag).
TEST(LowPass, FollowsAStepExponentiallyAndIsOneLagBehindARamp) {
  BlockCourse edge(FromSeconds(kStep_s));
  for (int k = 0; k <= 1000; ++k) edge.Add({k < 600 ? 0.0 : 1.0, 5.0 * k * kStep_s, 2.0, k < 600 ? 0.0 : -3.0});
  const LowPass low_pass(2000.0);
  const double lag_s = 1.0 / (units::turn * 2000.0);
  const BlockCourse passed = low_pass.Passed(edge, FromSeconds(kStep_s), 1000);
  for (int k = 600; k <= 1000; k += 20) {
    const double left =
        lag_s / kStep_s * (1.0 - std::exp(-kStep_s / lag_s)) * std::exp(-(k - 600) * kStep_s / lag_s);
    EXPECT_NEAR(passed.At_V(0, k * kStep_s), 1.0 - left, 1e-9) << k;
    EXPECT_NEAR(passed.At_V(3, k * kStep_s), -3.0 * (1.0 - left), 1e-9) << k;
  }
  EXPECT_NEAR(passed.At_V(0, 0.0), 0.0, 1e-12);  // the edge is 30 lags away
  EXPECT_NEAR(passed.At_V(2, 1e-3), 2.0, 1e-12);
  for (const double t_s : {0.0, 1e-4, 4e-3})
    EXPECT_NEAR(passed.At_V(1, t_s), 5.0 * (t_s - low_pass.Lag_s()), 1e-9) << t_s;
}

Scenario Dim(double low_pass_Hz) {
  Scenario scenario = OnlyTheLightsNoise();
  RotaryOf(scenario).laser.power_W = 1e-7;
  RotaryOf(scenario).chain.low_pass_Hz = low_pass_Hz;
  return scenario;
}

// White noise of a band B behind a pole: variance x (pi / 2) corner / B, correlated by exp(-t / lag).
TEST(LowPass, NarrowsAndCorrelatesTheLightsNoise) {
  constexpr int kScans = 60000;
  const double corner_Hz = 4000.0, lag_s = 1.0 / (units::turn * corner_Hz), scan_s = 16e-6;
  const double open_V = Twin(Dim(0.0)).Bench().adc.Acquire(kScans, false).channel[0].std_V;
  Twin twin(Dim(corner_Hz));
  const Acquisition block = twin.Bench().adc.Acquire(kScans, true);
  const double share = std::sqrt(0.5 * units::kPi * corner_Hz / 100e3);
  // Some 20000 independent samples: 0.5 %; steps of the converter add as little.
  EXPECT_NEAR(block.channel[0].std_V / open_V, share, 0.03 * share);
  const double lsb_V = 20.0 / 65536.0, mean = block.channel[0].mean_V / lsb_V;
  double products = 0.0;
  for (std::size_t s = 1; s < kScans; ++s)
    products += (block.raw[kChannels * s] - mean) * (block.raw[kChannels * (s - 1)] - mean) / (kScans - 1);
  const double variance = block.channel[0].std_V * block.channel[0].std_V / (lsb_V * lsb_V);
  EXPECT_NEAR(products / variance, std::exp(-scan_s / lag_s), 0.03);
}

/// A sine of 137 Hz behind 100 Hz, at its place on the clock, and what the pole makes of it.
constexpr double kTone_Hz = 137.0, kCorner_Hz = 100.0;
double LongTone_V(double t_s, double phase_rad) { return std::sin(units::turn * kTone_Hz * t_s + phase_rad); }

// Mean over a block, of the output less what a pole shows that has seen the sine for ever.
double MeanError_V(double phase_rad, bool remembers) {
  const double step_s = 0.25e-3, block_s = 16e-3;
  const LowPass low_pass(kCorner_Hz);
  BlockCourse course(FromSeconds(step_s)), before(FromSeconds(step_s));
  for (int k = 0; k <= 64; ++k) course.Add({LongTone_V(k * step_s, phase_rad), 0.0, 0.0, 0.0});
  for (int k = -200; k <= 0; ++k) before.Add({LongTone_V(k * step_s, phase_rad), 0.0, 0.0, 0.0});
  const BlockCourse passed = remembers ? low_pass.Passed(course, FromSeconds(kStep_s), 4000, before)
                                       : low_pass.Passed(course, FromSeconds(kStep_s), 4000);
  const double x = kTone_Hz / kCorner_Hz, rate = units::turn * kTone_Hz, behind_rad = phase_rad - std::atan(x);
  const double expected_V =
      (std::cos(behind_rad) - std::cos(rate * block_s + behind_rad)) / (rate * block_s * std::hypot(1.0, x));
  return std::abs(passed.Mean_V(0) - expected_V);
}

TEST(LowPass, RemembersWhatWasBeforeTheBlockOrIsWrongByNoMoreThanIsSaid) {
  const double x2 = std::pow(kTone_Hz / kCorner_Hz, 2), lag_s = LowPass(kCorner_Hz).Lag_s();
  const double said_V = 2.0 * x2 / (1.0 + x2) * lag_s / 16e-3;
  double most_V = 0.0;
  for (const double phase_rad : {0.0, 0.4, 1.2, 1.6, 2.7}) {
    EXPECT_LT(MeanError_V(phase_rad, true), 1e-4) << phase_rad;  // cubics through the knots
    most_V = std::max(most_V, MeanError_V(phase_rad, false));
  }
  EXPECT_LE(most_V, said_V);
  EXPECT_GT(most_V, 0.9 * said_V);
}

PsdSettings ShotNoiseOnly() {
  PsdSettings psd;
  psd.dark_current_A = 0.0;
  psd.electrode_resistance_ohm = 1e15;
  return psd;
}

// (L / 2) sqrt(2 q B / I) in the centre: 1 mW x 0.45 A/W = 0.45 mA, 100 kHz, 10 mm.
TEST(PsdNoise, IsTheShotNoiseOfTheLightAndThatOfDarkCurrentAndResistanceFallsAsTheLight) {
  const double expected_m = 5e-3 * std::sqrt(2.0 * 1.602176634e-19 * 100e3 / 0.45e-3);
  EXPECT_NEAR(PsdNoise_m(ShotNoiseOnly(), 1e-3, 10e-3, 0.0), expected_m, 1e-6 * expected_m);
  EXPECT_NEAR(PsdNoise_m(ShotNoiseOnly(), 1e-3, 10e-3, 4e-3), 0.6 * expected_m, 1e-6 * expected_m);
  PsdSettings psd = ShotNoiseOnly();
  psd.dark_current_A = 1.0;
  EXPECT_NEAR(PsdNoise_m(psd, 1e-9, 10e-3, 0.0) / PsdNoise_m(psd, 4e-9, 10e-3, 0.0), 4.0, 1e-3);
  // Johnson noise of 10 kohm in 100 kHz: 4 k T B / R = 1.62e-19 A^2, at both electrodes.
  psd = ShotNoiseOnly();
  psd.electrode_resistance_ohm = 10e3;
  const double johnson_m = 5e-3 * std::sqrt(2.0 * 1.6190e-19) / (0.45 * 1e-12);
  EXPECT_NEAR(PsdNoise_m(psd, 1e-12, 10e-3, 0.0) / johnson_m, 1.0, 1e-3);
}

/// Root mean square over channels of a block's deviation, nothing being noisy but the light.
double Scatter_V(double power_W) {
  Scenario scenario = OnlyTheLightsNoise();
  RotaryOf(scenario).laser.power_W = power_W;
  for (PsdSettings* psd : {&RotaryOf(scenario).psd_a, &RotaryOf(scenario).psd_b}) {
    psd->dark_current_A = 0.0;
    psd->electrode_resistance_ohm = 1e9;
  }
  Twin twin(scenario);
  const Acquisition block = twin.Bench().adc.Acquire(20000, false);
  double squares_V2 = 0.0;
  for (const ChannelBlock& channel : block.channel) squares_V2 += channel.std_V * channel.std_V / kChannels;
  return std::sqrt(squares_V2);
}

TEST(PsdNoise, ScatterFallsAsOneOverTheRootOfThePower) {
  const double bright_V = Scatter_V(2e-6);
  for (const double share : {0.25, 0.04, 0.01})
    EXPECT_NEAR(Scatter_V(2e-6 * share) / bright_V * std::sqrt(share), 1.0, 0.03) << share;
}

/// The laser's power goes up and down: a PSD's quotient does not see it but where a background counts as signal.
constexpr double kPitch_rad = 5e-3;
constexpr double kCurrent_A = 0.45 * 5e-3 * 0.339, kBackground_A = 100e-6;
constexpr double kShare = kCurrent_A / (kCurrent_A + kBackground_A);

/// Both spots 1.6 mm above the middle.
Scenario Lifted(bool noise_free = true) {
  Scenario scenario = OnlyTheLightsNoise();
  scenario.noise_free = noise_free;
  RotaryOf(scenario).laser.pitch_rad = kPitch_rad;
  return scenario;
}

void LetRoomLightIn(Scenario& scenario) {
  RotaryOf(scenario).psd_a.background_A = RotaryOf(scenario).psd_b.background_A = kBackground_A;
}

Acquisition LongBlock(const Scenario& scenario, bool keep_raw = false) {
  return Twin(scenario).Bench().adc.Acquire(20000, keep_raw);
}

TEST(IntensityNoise, CancelsWithoutABackground) {
  Scenario scenario = Lifted(false);
  const Acquisition quiet = LongBlock(scenario);
  RotaryOf(scenario).laser.rin_dB_Hz = -70.0;  // 10 % in 100 kHz
  const Acquisition noisy = LongBlock(scenario);
  for (std::size_t c = 0; c < kChannels; ++c) {
    EXPECT_EQ(noisy.channel[c].mean_V, quiet.channel[c].mean_V) << c;
    EXPECT_EQ(noisy.channel[c].std_V, quiet.channel[c].std_V) << c;
  }
}

TEST(IntensityNoise, ShowsThroughABackground) {
  Scenario scenario = Lifted(false);
  LetRoomLightIn(scenario);
  const Acquisition quiet = LongBlock(scenario);
  RotaryOf(scenario).laser.rin_dB_Hz = -90.0;
  const Acquisition noisy = LongBlock(scenario);
  const double relative = std::sqrt(1e-9 * 100e3);
  for (const std::size_t c : {1u, 3u}) {
    const double expected_V = std::abs(quiet.channel[c].mean_V) * (1.0 - kShare) * relative;
    const double added_V = std::sqrt(std::pow(noisy.channel[c].std_V, 2) - std::pow(quiet.channel[c].std_V, 2));
    EXPECT_NEAR(added_V, expected_V, 0.03 * expected_V) << c;  // 20000 samples: 0.5 %
    EXPECT_LT(noisy.channel[c - 1].std_V, 0.1 * expected_V) << "in the middle nothing is to be seen";
  }
}

TEST(IntensityNoise, IsCommonToBothDetectorsBehindALowPass) {
  Scenario scenario = Lifted(false);
  LetRoomLightIn(scenario);
  RotaryOf(scenario).laser.rin_dB_Hz = -80.0;
  RotaryOf(scenario).chain.low_pass_Hz = 2000.0;
  const Acquisition block = LongBlock(scenario, true);
  const double lsb_V = 20.0 / 65536.0;
  double products = 0.0;
  for (std::size_t i = 0; i < block.raw.size(); i += kChannels)
    products += (block.raw[i + 1] - block.channel[1].mean_V / lsb_V) *
                (block.raw[i + 3] - block.channel[3].mean_V / lsb_V) / 20000.0;
  const double correlation = products * lsb_V * lsb_V / (block.channel[1].std_V * block.channel[3].std_V);
  // Two conversions apart: exp(-8 us x 2 pi x 2 kHz).
  EXPECT_NEAR(correlation, std::exp(-8e-6 * units::turn * 2000.0), 0.02);
}

}  // namespace
}  // namespace twinbench::sim
