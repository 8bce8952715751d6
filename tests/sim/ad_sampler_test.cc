#include "twin/sim/ad_sampler.h"

#include "twin/sim/ad_sampler_direct.h"

namespace twinbench::sim {
namespace {

constexpr double kPi = std::numbers::pi;
const AdcSettings kAdc;  // 16 bits, +-10 V, 250 kHz
const double kLsb_V = 20.0 / 65536.0;

AdInput Levels(double a_V, double b_V, double c_V, double d_V, double noise_V = 0.0) {
  AdInput input;
  const std::array<double, 4> level_V = {a_V, b_V, c_V, d_V};
  for (std::size_t k = 0; k < 4; ++k) {
    input.channel[k].level_V = level_V[k];
    input.channel[k].noise_V = noise_V;
  }
  return input;
}

AdBlock Take(const AdInput& input, const AdRequest& request, std::uint64_t reading = 0,
             const AdcSettings& adc = kAdc) {
  Stream noise(42, "adc.noise");
  noise.Seek(reading << 20);
  return TakeBlock(adc, input, request, noise);
}

/// Hum, slopes and crosstalk at once.
AdInput Rich(double noise_V) {
  AdInput input = Levels(1.0, -2.0, 0.5, 3.0, noise_V);
  input.hum = {.amplitude_V = 5e-3, .frequency_Hz = 50.0, .phase_rad = 0.7};
  input.channel[0].slope_V_s = 4.0;
  input.channel[2].slope_V_s = -3.0;
  input.channel[1].crosstalk = 0.02;
  input.channel[0].crosstalk = 0.01;
  return input;
}

TEST(TakeBlock, TurnsALevelIntoTheNearestCodeWithTiesToEven) {
  AdcSettings coarse;
  coarse.bits = 12;
  coarse.range_V = 5.0;
  EXPECT_EQ(LsbOf(coarse), 10.0 / 4096.0);
  using Numbers = std::array<double, 4>;
  const std::tuple<AdcSettings, Numbers, std::vector<std::int16_t>> cases[] = {
      {kAdc, {1.23456, -7.654321, 0.0, 9.9}, {4045, -25082, 0, 32440}},
      {kAdc, {0.5 * kLsb_V, 1.5 * kLsb_V, -0.5 * kLsb_V, -1.51 * kLsb_V}, {0, 2, 0, -2}},
      {coarse, {1.0, 4.99, -6.0, 0.0}, {410, 2044, -2048, 0}}};
  for (const auto& [adc, level_V, codes] : cases) {
    const AdBlock block =
        Take(Levels(level_V[0], level_V[1], level_V[2], level_V[3]), {.n_samples = 2, .keep_raw = true}, 0, adc);
    std::vector<std::int16_t> twice = codes;
    twice.insert(twice.end(), codes.begin(), codes.end());
    EXPECT_EQ(block.raw, twice);
  }
}

TEST(TakeBlock, ReportsTheStatisticsOfItsRawCodes) {
  for (const int n : {1, 2, 5, 255, 257, 1000}) {
    const AdBlock block = Take(Rich(6e-3), {.n_samples = n, .keep_raw = true});
    ASSERT_EQ(block.raw.size(), 4u * static_cast<std::size_t>(n));
    for (std::size_t k = 0; k < 4; ++k) {
      std::vector<double> x_V;
      for (std::size_t i = k; i < block.raw.size(); i += 4) x_V.push_back(block.raw[i] * kLsb_V);
      double mean = 0.0, squares = 0.0;
      for (const double x : x_V) mean += x / n;
      for (const double x : x_V) squares += (x - mean) * (x - mean);
      EXPECT_NEAR(block.channel[k].mean_V, mean, 1e-14);  // rounding of a thousand additions of a few volts
      EXPECT_EQ(std::isnan(block.channel[k].std_V), n == 1);
      const double std_V = n == 1 ? 0.0 : block.channel[k].std_V;
      EXPECT_NEAR(std_V, std::sqrt(squares / std::max(n - 1, 1)), 1e-13);
      EXPECT_EQ(block.channel[k].min_V, *std::min_element(x_V.begin(), x_V.end()));
      EXPECT_EQ(block.channel[k].max_V, *std::max_element(x_V.begin(), x_V.end()));
    }
  }
}

/// The equations of ad_sampler.h in double, one conversion at a time.
std::vector<int> CodesByTheBook(const AdInput& input, int n_samples, const std::vector<float>& normals) {
  std::vector<int> codes;
  double before_V = kNaN;
  for (int i = -1; i < 4 * n_samples; ++i) {
    const ChannelInput& c = input.channel[static_cast<std::size_t>((i + 4) % 4)];
    const double t = i / 250e3;
    double v = c.level_V + c.slope_V_s * t + c.noise_V * normals[static_cast<std::size_t>(i + 4)];
    v += input.hum.amplitude_V * std::sin(2.0 * kPi * input.hum.frequency_Hz * t + input.hum.phase_rad);
    if (c.extra_V) v += c.extra_V(t);
    double y = v + c.crosstalk * before_V;
    if (c.step_V != 0.0 && y >= c.step_threshold_V) y += c.step_V;
    if (i >= 0) codes.push_back(static_cast<int>(std::clamp(std::nearbyint(y / kLsb_V), -32768.0, 32767.0)));
    before_V = v;
  }
  return codes;
}

TEST(TakeBlock, FollowsItsEquationsSampleBySample) {
  constexpr int kN = 5003;  // neither whole chunks nor whole vectors
  AdInput input = Rich(6e-3);
  for (ChannelInput& c : input.channel) c.crosstalk = 0.3;
  input.channel[3].extra_V = [](double t) { return 2e-3 * std::sin(2e4 * t); };
  input.channel[1].step_V = 4e-3;
  input.channel[1].step_threshold_V = -1.69;  // in the middle of the signal
  const AdBlock block = Take(input, {.n_samples = kN, .keep_raw = true});
  std::vector<float> normals(4 * (kN + 1));
  Stream(42, "adc.noise").FillNormals(normals);
  const std::vector<int> expected = CodesByTheBook(input, kN, normals);
  int n_different = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_NEAR(block.raw[i], expected[i], i % 4 == 1 ? 14 : 1) << i;  // 13 LSB: the step, if y is at its threshold
    n_different += block.raw[i] != expected[i];
  }
  // Float against double: deviations of some 1000 LSB are rounded by 6e-5 LSB, so one sample in 1e4 may tip over.
  EXPECT_LE(n_different, 8);
}

TEST(TakeBlock, FlagsAChannelThatReachesAnEndCodeAlsoWithoutNoise) {
  const AdBlock block = Take(Levels(9.99, -20.0, 50.0, 1.0, 6e-3), {.n_samples = 1000, .keep_raw = true});
  EXPECT_EQ(block.status, ReadingStatus::kSaturated);
  EXPECT_EQ(block.saturated, (std::array<bool, 4>{true, true, true, false}));
  EXPECT_TRUE(std::isnan(block.channel[0].mean_V));
  EXPECT_TRUE(std::isnan(block.channel[0].std_V));
  EXPECT_EQ(block.channel[0].max_V, 32767 * kLsb_V);
  EXPECT_EQ(block.channel[1].min_V, -10.0);
  EXPECT_EQ(block.raw[2], 32767);
  EXPECT_FALSE(std::isnan(block.channel[3].mean_V));
  const AdBlock quiet = Take(Levels(9.9999, 9.99, -9.9999, 0.0), {.n_samples = 4, .noise_free = true});
  EXPECT_EQ(quiet.saturated, (std::array<bool, 4>{true, false, true, false}));
  EXPECT_EQ(quiet.status, ReadingStatus::kSaturated);
}

TEST(TakeBlock, AveragesTheHumAsTheClosedFormSays) {
  AdInput input = Rich(0.0);
  Stream random(1, "cases");
  // 62.5 kHz is the scan rate: the hum stands still. 31.25 kHz changes sign with every scan.
  for (const double hum_Hz : {0.0, 1e-6, 0.01, 1.0, 50.0, 60.0, 1234.5, 31250.0, 62500.0, 62549.9, 125000.0}) {
    for (const int n : {1, 2, 7, 100, 1000}) {
      input.hum = {.amplitude_V = 0.3, .frequency_Hz = hum_Hz, .phase_rad = 6.0 * random.Uniform()};
      const AdBlock block = Take(input, {.n_samples = n, .noise_free = true});
      const auto moments = MomentsOf(kAdc, input, n);
      for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_NEAR(block.channel[k].mean_V, moments[k].mean_V, 1e-12) << hum_Hz << " Hz, " << n;
        // Deviations below 1e-8 V are lost in the rounding of their squares beside those of volts.
        if (n == 1) continue;
        const double std_V = std::sqrt(std::max(moments[k].squares_V2, 0.0) / (n - 1.0));
        EXPECT_NEAR(block.channel[k].std_V, std_V, 1e-8 + 1e-9 * std_V) << hum_Hz << " Hz, " << n;
      }
    }
  }
}

TEST(TakeBlock, StepsWhereTheVoltagePassesTheThresholdAndIsExactWithoutNoise) {
  AdInput input = Levels(0.5, 1.0, 1.5, -1.5);
  for (ChannelInput& c : input.channel) {
    c.step_V = 0.01;
    c.step_threshold_V = 1.0;
  }
  const AdBlock block = Take(input, {.n_samples = 3, .noise_free = true});
  const double expected_V[] = {0.5, 1.01, 1.51, -1.5};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(block.channel[k].mean_V, expected_V[k]);
    EXPECT_EQ(block.channel[k].std_V, 0.0);
  }
  const AdBlock coded = Take(input, {.n_samples = 3});
  EXPECT_EQ(coded.channel[0].mean_V, std::round(0.5 / kLsb_V) * kLsb_V);
  EXPECT_EQ(coded.channel[1].mean_V, std::round(1.01 / kLsb_V) * kLsb_V);
  input.channel[2].step_threshold_V = std::numeric_limits<double>::infinity();
  for (const bool every_sample : {true, false}) {
    for (ChannelInput& c : input.channel) c.noise_V = 1e-3;
    const AdBlock noisy = Take(input, {.n_samples = 10000, .every_sample = every_sample});
    EXPECT_NEAR(noisy.channel[2].mean_V, 1.5, 5e-5);  // five standard deviations of the mean
    EXPECT_NEAR(noisy.channel[1].mean_V, 1.005, 3e-4);  // the threshold cuts its noise in halves, 5 mV +- 0.05 mV
  }
}

TEST(TakeBlock, LosesTheBlockWhenTheFifoRunsOver) {
  AdcSettings adc;
  adc.fifo_samples = 1024;
  adc.drain_rate_Hz = 200e3;
  const AdInput input = Levels(1.0, 1.0, 1.0, 1.0, 1e-3);
  // It fills with 50 000 samples a second: full after 1024 / 0.2 = 5120 conversions, 1280 scans.
  EXPECT_EQ(Take(input, {.n_samples = 1280}, 0, adc).status, ReadingStatus::kOk);
  const AdBlock block = Take(input, {.n_samples = 1281, .keep_raw = true}, 0, adc);
  EXPECT_EQ(block.status, ReadingStatus::kOverrun);
  EXPECT_EQ(block.n_samples, 1280);
  EXPECT_TRUE(std::isnan(block.channel[0].mean_V));
  EXPECT_TRUE(block.raw.empty());
  adc.drain_rate_Hz = 250e3;
  EXPECT_EQ(Take(input, {.n_samples = 100000}, 0, adc).status, ReadingStatus::kOk);
}

bool SameBits(const AdBlock& a, const AdBlock& b) {
  return a.raw == b.raw && a.saturated == b.saturated &&
         std::memcmp(a.channel.data(), b.channel.data(), sizeof a.channel) == 0;  // plain doubles, NaN too
}

/// Noise from less than a code to thousands, whose squares need more than 32 bits, blocks that clip, and a step.
TEST(TakeBlock, CountsTheSameCodesOnEveryInstructionSetWithoutKeepingThemToo) {
  AdInput stepped = Rich(6e-3);
  stepped.channel[1].step_V = 2e-3;
  stepped.channel[1].step_threshold_V = -1.98;
  std::vector<AdInput> inputs = {stepped};
  for (const double noise_V : {1e-4, 6e-3, 0.3, 1.5, 5.0}) {
    inputs.push_back(Levels(1.0, -2.0, 3.0, -4.0, noise_V));
    inputs.push_back(Rich(noise_V));
  }
  for (const AdInput& input : inputs) {
    for (const int n : {1, 2, 3, 4, 63, 255, 256, 260, 1001}) {
      const AdBlock first = Take(input, {.n_samples = n, .keep_raw = true});
      for (const Simd simd : kAllSimd) {
        if (!SimdRuns(simd)) continue;
        for (const bool keep_raw : {true, false}) {
          Stream noise(42, "adc.noise");
          noise.UseSimd(simd);
          AdBlock block = TakeBlock(kAdc, input, {.n_samples = n, .keep_raw = keep_raw}, noise);
          EXPECT_EQ(block.raw.empty(), !keep_raw);
          if (!keep_raw) block.raw = first.raw;
          EXPECT_TRUE(SameBits(block, first)) << input.channel[0].noise_V << " V, " << n;
        }
      }
    }
  }
}

TEST(TakeBlock, RepeatsItselfIsAnotherForAnotherReadingAndUsesOneStreamBlockAScanAndOneInFront) {
  const auto take = [](std::uint64_t reading) {
    return Take(Rich(6e-3), {.n_samples = 500, .keep_raw = true}, reading);
  };
  EXPECT_TRUE(SameBits(take(3), take(3)));
  EXPECT_FALSE(SameBits(take(3), take(4)));
  Stream noise(1, "count");
  TakeBlock(kAdc, Rich(6e-3), {.n_samples = 777}, noise);
  EXPECT_EQ(noise.NextBlock(), 778u);
}

TEST(TakeBlock, DrawsEverySampleWhereItMust) {
  const auto drew_every_sample = [](const AdInput& input, bool keep_raw = false) {
    return Take(input, {.n_samples = 100, .every_sample = false, .keep_raw = keep_raw}).drew_every_sample;
  };
  const AdInput smooth = Levels(1.0, 2.0, 3.0, 4.0, 0.51 * kLsb_V);
  EXPECT_FALSE(drew_every_sample(smooth));
  EXPECT_TRUE(drew_every_sample(smooth, true));
  EXPECT_TRUE(drew_every_sample(Levels(1.0, 2.0, 3.0, 4.0, 0.49 * kLsb_V)));
  const AdRequest few{.n_samples = 60, .every_sample = false};
  EXPECT_TRUE(Take(smooth, few).drew_every_sample) << "mean's lattice too coarse";
  EXPECT_FALSE(drew_every_sample(Levels(9.94, -9.94, 0.0, 0.0, 6e-3)));
  EXPECT_TRUE(drew_every_sample(Levels(9.96, 0.0, 0.0, 0.0, 6e-3)));  // less than 8 sigma from the end code
  EXPECT_TRUE(drew_every_sample(Levels(-9.96, 0.0, 0.0, 0.0, 6e-3)));
  AdInput hooked = smooth;
  hooked.channel[2].extra_V = [](double) { return 0.0; };
  EXPECT_TRUE(drew_every_sample(hooked));
  AdInput stepped = smooth;
  stepped.channel[2].step_V = 0.01;
  stepped.channel[2].step_threshold_V = 3.0005;
  EXPECT_TRUE(drew_every_sample(stepped));
  stepped.channel[2].step_threshold_V = 2.9;
  EXPECT_FALSE(drew_every_sample(stepped));
  EXPECT_NEAR(Take(stepped, {.n_samples = 100, .every_sample = false}).channel[2].mean_V, 3.01, 5e-4);
}

/// Means and deviations of one channel over many blocks, by either way of drawing.
struct Population {
  std::vector<double> mean_V, std_V;
};

Population Draw(const AdInput& input, int n_samples, bool every_sample, std::size_t channel) {
  Population population;
  for (std::uint64_t reading = 0; reading < 4000; ++reading) {
    const AdRequest request{.n_samples = n_samples, .every_sample = every_sample};
    const AdBlock block = Take(input, request, reading + (every_sample ? 0u : 100000u));
    population.mean_V.push_back(block.channel[channel].mean_V);
    population.std_V.push_back(block.channel[channel].std_V);
  }
  return population;
}

/// Two-sample Kolmogorov-Smirnov distance times sqrt(n / 2).
double TwoSampleStatistic(std::vector<double> a, std::vector<double> b) {
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  const auto n = static_cast<double>(a.size());
  double distance = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto below = std::upper_bound(b.begin(), b.end(), a[i]) - b.begin();
    distance = std::max(distance, std::abs(static_cast<double>(i + 1) - static_cast<double>(below)) / n);
  }
  return distance * std::sqrt(0.5 * n);
}

/// Mean of the powers of what is left beside `middle`.
double CentralMoment(const std::vector<double>& x, int power, double middle) {
  double sum = 0.0;
  for (const double v : x) sum += std::pow(v - middle, power);
  return sum / static_cast<double>(x.size());
}

void ExpectSameMoments(const std::vector<double>& a, const std::vector<double>& b) {
  const double mean_a = CentralMoment(a, 1, 0.0), mean_b = CentralMoment(b, 1, 0.0),
               variance = CentralMoment(a, 2, mean_a);
  const double sd = std::sqrt(variance), root = std::sqrt(2.0 / static_cast<double>(a.size()));
  EXPECT_NEAR(mean_a, mean_b, 4.0 * sd * root);  // standard deviation of a difference of two means
  // ... of two deviations: the kurtosis is 3 for means, but 3.9 for the deviations of blocks of two samples.
  const double kurtosis = CentralMoment(a, 4, mean_a) / (variance * variance);
  EXPECT_NEAR(std::sqrt(CentralMoment(b, 2, mean_b)) / sd, 1.0, 4.0 * root * std::sqrt((kurtosis - 1.0) / 4.0));
}

void ExpectSameDistribution(const std::vector<double>& a, const std::vector<double>& b) {
  EXPECT_LT(TwoSampleStatistic(a, b), 1.95);  // exceeded with probability 1e-3
}

TEST(TakeBlock, DrawsDirectlyFromTheDistributionOfItsSamplesAndTheirMomentsDownToHalfACodeOfNoise) {
  for (const int n : {2, 9, 60}) {
    SCOPED_TRACE(n);
    // 6 mV of noise against 5 mV of hum and 4 V/s: signal and noise share the deviation.
    const Population sampled = Draw(Rich(6e-3), n, true, 0), direct = Draw(Rich(6e-3), n, false, 0);
    ExpectSameMoments(sampled.mean_V, direct.mean_V);
    ExpectSameMoments(sampled.std_V, direct.std_V);
    ExpectSameDistribution(sampled.mean_V, direct.mean_V);
    ExpectSameDistribution(sampled.std_V, direct.std_V);
  }
  // Means of sampled codes lie on a lattice of LSB / n, here a fifth of their deviation: only moments are compared.
  const Population sampled = Draw(Rich(0.5 * kLsb_V), 100, true, 0);
  const Population direct = Draw(Rich(0.5 * kLsb_V), 100, false, 0);
  ExpectSameMoments(sampled.mean_V, direct.mean_V);
  ExpectSameMoments(sampled.std_V, direct.std_V);
}

TEST(TakeBlock, CorrelatesNeighboursThroughCrosstalkInBothWaysOfDrawing) {
  AdInput input = Levels(0.0, 0.0, 0.0, 0.0, 6e-3);
  input.channel[1].crosstalk = 0.3;
  for (const bool every_sample : {true, false}) {
    double product = 0.0, square = 0.0;
    for (std::uint64_t reading = 0; reading < 4000; ++reading) {
      const AdBlock block = Take(input, {.n_samples = 20, .every_sample = every_sample}, reading);
      product += block.channel[0].mean_V * block.channel[1].mean_V;
      square += block.channel[0].mean_V * block.channel[0].mean_V;
    }
    EXPECT_NEAR(product / square, 0.3, 4.0 / std::sqrt(4000.0));  // sd of a slope between equal noises
  }
}

TEST(TakeBlock, RefusesWhatMakesNoSense) {
  using Change = void (*)(AdInput&, AdcSettings&, AdRequest&);
  const Change changes[] = {
      [](auto&, auto&, auto& request) { request.n_samples = 0; },
      [](auto& input, auto&, auto&) { input = {}; },  // levels are NaN
      [](auto& input, auto&, auto&) { input.channel[1].noise_V = -1.0; },
      [](auto& input, auto&, auto&) { input.channel[1].extra_V = [](double t) { return std::log(t - 1.0); }; },
      [](auto&, auto& adc, auto&) { adc.bits = 17; },
      [](auto&, auto& adc, auto&) { adc.rate_Hz = 0.0; }};
  for (const Change change : changes) {
    AdInput input = Levels(1.0, 1.0, 1.0, 1.0);
    AdcSettings adc;
    AdRequest request{.n_samples = 1};
    change(input, adc, request);
    EXPECT_THROW(Take(input, request, 0, adc), std::logic_error);
  }
}

}  // namespace
}  // namespace twinbench::sim
