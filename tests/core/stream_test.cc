#include "twin/core/stream.h"

#include <Random123/philox.h>

#include <cstring>

#include "twin/core/stream_kernel_math.h"

namespace twinbench {
namespace {

PhiloxBlock FromRandom123(const PhiloxBlock& counter, const PhiloxKey& key) {
  const r123::Philox4x32::ctr_type c = {{counter[0], counter[1], counter[2], counter[3]}};
  const r123::Philox4x32::key_type k = {{key[0], key[1]}};
  const auto words = r123::Philox4x32{}(c, k);
  return {words[0], words[1], words[2], words[3]};
}

std::vector<float> Normals(Stream stream, std::size_t n) {
  std::vector<float> out(n);
  stream.FillNormals(out);
  return out;
}

bool SameBits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

double NormalDistribution(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

/// Largest distance between the empirical distribution and the one stated, times sqrt(n).
double KolmogorovStatistic(std::vector<double> values, double (*distribution)(double)) {
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  double distance = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double f = distribution(values[i]), k = static_cast<double>(i);
    distance = std::max({distance, f - k / n, (k + 1.0) / n - f});
  }
  return distance * std::sqrt(n);
}

constexpr double kRare = 1.95;  // exceeded with probability 1e-3

TEST(Philox, GivesThePublishedAnswers) {
  // The three vectors that Salmon et al. publish with their library for philox4x32, 10 rounds.
  EXPECT_EQ(Philox({0, 0, 0, 0}, {0, 0}), (PhiloxBlock{0x6627E8D5, 0xE169C58D, 0xBC57AC4C, 0x9B00DBD8}));
  EXPECT_EQ(Philox({~0u, ~0u, ~0u, ~0u}, {~0u, ~0u}),
            (PhiloxBlock{0x408F276D, 0x41C83B0E, 0xA20BC7C6, 0x6D5451FD}));
  EXPECT_EQ(Philox({0x243F6A88, 0x85A308D3, 0x13198A2E, 0x03707344}, {0xA4093822, 0x299F31D0}),
            (PhiloxBlock{0xD16CFE09, 0x94FDCCEB, 0x5001E420, 0x24126EA1}));
}

TEST(Stream, DependsOnSeedAndNameOnly) {
  EXPECT_EQ(Stream(1, "psd_a.noise").Word(), Stream(1, "psd_a.noise").Word());
  EXPECT_NE(Stream(1, "psd_a.noise").Word(), Stream(2, "psd_a.noise").Word());
  EXPECT_NE(Stream(1, "psd_a.noise").Word(), Stream(1, "psd_b.noise").Word());
  EXPECT_NE(Stream(0, "").Word(), Stream(1, "").Word());
}

TEST(Stream, KeepsItsFirstNumbersFromVersionToVersion) {
  // Golden: records made by an earlier version must stay reproducible. Change only with a new record version.
  Stream stream(20250101, "golden");
  EXPECT_EQ(stream.Word(), 0xDD5D269Du);
  stream.Seek(3);
  EXPECT_EQ(stream.Normal(), 0x1.a70553af77067p-2);
  EXPECT_EQ(stream.ChiSquared(99.0), 0x1.545f3441ecb93p+6);
  EXPECT_EQ(Normals(stream, 3)[2], -0x1.fa468ap-1f);
}

TEST(Stream, GivesNormalsThatDoNotKnowTheirNeighbours) {
  // Both normals of a pair come from one block, so neighbours are the place to look.
  constexpr int kCount = 40000;
  Stream stream(11, "neighbours");
  std::vector<double> x;
  for (int i = 0; i < kCount; ++i) x.push_back(stream.Normal());
  for (const int lag : {1, 2, 3}) {
    double product = 0.0, squares = 0.0;
    for (int i = 0; i + lag < kCount; ++i) {
      product += x[i] * x[i + lag];
      squares += (x[i] * x[i] - 1.0) * (x[i + lag] * x[i + lag] - 1.0);
    }
    EXPECT_NEAR(product / kCount, 0.0, 4.0 / std::sqrt(kCount)) << lag;        // standard deviation 1 / sqrt(n)
    EXPECT_NEAR(squares / kCount, 0.0, 4.0 * 2.0 / std::sqrt(kCount)) << lag;  // of (x^2 - 1): variance 2 each
  }
}

TEST(Stream, GivesTwoNormalsForOneBlockAndForgetsTheSecondOnSeek) {
  Stream stream(3, "pairs");
  const double first = stream.Normal();
  EXPECT_EQ(stream.NextBlock(), 1u);
  stream.Normal();
  EXPECT_EQ(stream.NextBlock(), 1u);
  stream.Normal();
  stream.Seek(0);
  EXPECT_EQ(stream.Normal(), first);
}

TEST(Stream, CanBeEnteredAtAnyBlockAlsoBeyondThirtyTwoBits) {
  Stream through(7, "seek"), jumped(7, "seek");
  for (int i = 0; i < 4 * 1000; ++i) through.Word();
  jumped.Seek(1000);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(through.Word(), jumped.Word());
  const std::uint64_t edge = (std::uint64_t{1} << 32) - 2;
  jumped.Seek(edge);
  const std::vector<float> across = Normals(jumped, 64);
  jumped.Seek(edge + 2);
  const std::vector<float> after = Normals(jumped, 56);
  EXPECT_TRUE(SameBits({across.begin() + 8, across.end()}, after));
  jumped.Seek(0);
  EXPECT_FALSE(SameBits(Normals(jumped, 56), after));
}

TEST(Stream, UniformsFillTheUnitIntervalEvenlyAndNormalsInDoublePassKolmogorov) {
  Stream stream(3, "uniform");
  std::array<int, 100> count{};
  for (int i = 0; i < 200000; ++i) ++count[static_cast<std::size_t>(stream.Uniform() * 100.0)];
  double chi2 = 0.0;
  for (const int n : count) chi2 += (n - 2000.0) * (n - 2000.0) / 2000.0;
  // 99 degrees of freedom: mean 99, standard deviation 14.1; five of them either way.
  EXPECT_NEAR(chi2, 99.0, 70.0);
  Stream normal(4, "normal");
  std::vector<double> values(100000);
  for (double& v : values) v = normal.Normal();
  EXPECT_LT(KolmogorovStatistic(values, NormalDistribution), kRare);
}

TEST(FillNormals, EqualsItselfCutIntoBlocks) {
  const std::vector<float> whole = Normals(Stream(12, "cut"), 4000);
  Stream stream(12, "cut");
  std::vector<float> pieces(4000);
  std::size_t at = 0;
  for (const std::size_t n : {4u, 64u, 12u, 1000u, 2u * 1000u, 920u}) {
    stream.FillNormals(std::span(pieces).subspan(at, n));
    at += n;
  }
  ASSERT_EQ(at, 4000u);
  EXPECT_TRUE(SameBits(pieces, whole));
}

TEST(FillNormals, LeavesTheStreamAtABlockBoundary) {
  Stream stream(13, "boundary");
  stream.Word();
  const std::vector<float> whole = Normals(stream, 16);  // starts with block 1
  std::vector<float> few(6);
  stream.FillNormals(few);  // blocks 1 and 2
  EXPECT_EQ(stream.NextBlock(), 3u);
  EXPECT_TRUE(SameBits(few, {whole.begin(), whole.begin() + 6}));
  EXPECT_EQ(Normals(stream, 4)[0], whole[8]);
  stream.FillNormals({});
  EXPECT_EQ(stream.NextBlock(), 3u);
}

TEST(FillNormals, HasTheSameBitsOnEveryInstructionSet) {
  for (const std::size_t n : {4u, 28u, 64u, 4092u, 400000u}) {
    std::vector<std::vector<float>> results;
    for (const Simd simd : kAllSimd) {
      if (!SimdRuns(simd)) continue;
      results.emplace_back(n);
      FillNormalBlocks(simd, {0xDEADBEEF, 17}, 0xFFFFFFF0u, results.back());
    }
    for (const auto& result : results) EXPECT_TRUE(SameBits(result, results.front())) << n;
  }
}

TEST(FillNormals, IsBoxMullerOfThePhiloxWords) {
  const PhiloxKey key = {21, 22};
  std::vector<float> fast(40000);
  FillNormalBlocks(BestSimd(), key, 0, fast);
  for (std::uint32_t block = 0; block < 10000; ++block) {
    const PhiloxBlock w = FromRandom123({block, 0, 0, 0}, key);
    for (std::size_t pair = 0; pair < 2; ++pair) {
      const double radius = std::sqrt(-2.0 * std::log((std::floor(w[2 * pair] / 2.0) + 0.5) / 2147483648.0));
      const double x = fast[4 * block + 2 * pair], y = fast[4 * block + 2 * pair + 1];
      // Float arithmetic: a few units of 6e-8 on values up to 6.66, and u = exp(-r^2 / 2) near 1 in steps of 6e-8.
      const double tolerance = 1e-6 + 6e-8 / radius;
      ASSERT_NEAR(std::hypot(x, y), radius, tolerance);
      const double angle = static_cast<std::int32_t>(w[2 * pair + 1] << 2) * (portable::kPi / 4.0 / 2147483648.0);
      const bool swapped = (w[2 * pair + 1] >> 30) & 1, mirrored = w[2 * pair + 1] >> 31;
      ASSERT_NEAR(swapped ? y : x, radius * std::cos(angle) * (mirrored ? -1.0 : 1.0), tolerance);
      ASSERT_NEAR(swapped ? x : y, radius * std::sin(angle), tolerance);
    }
  }
}

TEST(ChiSquared, HasItsMeanAndVariance) {
  constexpr int kN = 40000;
  for (const double degrees : {0.5, 1.0, 2.0, 3.0, 99.0, 999.0}) {
    Stream stream(14, "chi");
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < kN; ++i) {
      const double x = stream.ChiSquared(degrees) - degrees;
      sum += x;
      squares += x * x;
    }
    // Mean k, variance 2k, fourth central moment 12k(k + 4): four standard deviations each.
    const double u_mean = std::sqrt(2.0 * degrees / kN);
    const double u_variance = std::sqrt((12.0 * degrees * (degrees + 4.0) - 4.0 * degrees * degrees) / kN);
    EXPECT_NEAR(sum / kN, 0.0, 4.0 * u_mean) << degrees;
    EXPECT_NEAR(squares / kN, 2.0 * degrees, 4.0 * u_variance) << degrees;
  }
}

TEST(ChiSquared, FollowsItsDistributionAndRefusesDegreesThatAreNotPositive) {
  Stream stream(15, "chi2");
  std::vector<double> values(50000);
  for (double& v : values) v = stream.ChiSquared(2.0);
  EXPECT_LT(KolmogorovStatistic(values, [](double x) { return 1.0 - std::exp(-0.5 * x); }), kRare);
  for (const double degrees : {0.0, -1.0, std::nan("")}) EXPECT_THROW(stream.ChiSquared(degrees), std::logic_error);
}

TEST(PortableMath, AgreesWithTheLibraryToItsStatedAccuracy) {
  Stream stream(16, "math");
  for (int i = 0; i < 20000; ++i) {
    const double x = std::ldexp(1.0 - stream.Uniform(), static_cast<int>(stream.Word() % 100) - 60);
    EXPECT_NEAR(portable::Log(x), std::log(x), 1e-15 * std::abs(std::log(x)) + 1e-300);
    const double power = 100.0 * (stream.Uniform() - 0.5);
    EXPECT_NEAR(portable::Exp(power), std::exp(power), 1e-15 * (1.0 + std::abs(power)) * std::exp(power));
    const double turns = 20.0 * (stream.Uniform() - 0.5);
    const portable::Rotation r = portable::Turn(turns);
    EXPECT_NEAR(r.cosine, std::cos(2.0 * portable::kPi * turns), 1e-15 * (1.0 + 6.3 * std::abs(turns)));
    EXPECT_NEAR(r.sine, std::sin(2.0 * portable::kPi * turns), 1e-15 * (1.0 + 6.3 * std::abs(turns)));
  }
}

}  // namespace
}  // namespace twinbench
