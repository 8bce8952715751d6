#include <atomic>
#include <random>

#include "tests/core/input_error.h"
#include "twin/core/digest.h"
#include "twin/core/distributions.h"
#include "twin/core/elapsed_time.h"
#include "twin/core/happened_once.h"
#include "twin/core/number_text.h"
#include "twin/core/side_by_side.h"
#include "twin/core/toml_bounds.h"

namespace twinbench {
namespace {

// FIPS 180-4 examples of NIST, and a message whose padding needs a block of its own.
TEST(Sha256, AgreesWithThePublishedExamples) {
  EXPECT_EQ(Sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(Sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(Sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(Sha256(std::string(1000000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(ChiSquaredExceedance, OfNothingIsCertainAlsoInThousandsOfDegreesOfFreedomAndUnknownWithoutAny) {
  EXPECT_EQ(ChiSquaredExceedance(-1e-17, 3.0), 1.0);
  EXPECT_EQ(ChiSquaredExceedance(0.0, 3.0), 1.0);
  for (const double chi2 : {0.0, 1e-20, 1.0}) EXPECT_EQ(ChiSquaredExceedance(chi2, 10000.0), 1.0) << chi2;
  EXPECT_NEAR(ChiSquaredExceedance(10000.0, 10000.0), 0.5, 0.003);  // skewed by 2 / (3 sqrt(2 pi dof))
  EXPECT_EQ(ChiSquaredExceedance(INFINITY, 3.0), 0.0);
  EXPECT_TRUE(std::isnan(ChiSquaredExceedance(std::nan(""), 3.0)));
  EXPECT_TRUE(std::isnan(ChiSquaredExceedance(5.0, 0.0)));
}

TEST(NormalExceededWith, IsTheInverseOfTheTailAndANumberOfProbabilitiesOnly) {
  for (const double p : {0.4, 0.025, 1e-9})
    EXPECT_NEAR(0.5 * std::erfc(NormalExceededWith(p) / std::sqrt(2.0)) / p, 1.0, 1e-12);
  EXPECT_NEAR(NormalExceededWith(0.025), 1.959964, 1e-6);
  EXPECT_EQ(NormalExceededWith(0.0), INFINITY);
  EXPECT_EQ(NormalExceededWith(1.0), -INFINITY);
  for (const double none : {2.5, -0.1, std::nan("")}) EXPECT_TRUE(std::isnan(NormalExceededWith(none))) << none;
}

TEST(ChiSquaredExceedance, AgreesWithTablesAndIsAnExponentialForTwoDegreesOfFreedomAndRightBetweenWholeOnes) {
  // Upper 0.001 points of printed tables: half a unit of their last digit is 3e-7 of probability, or less.
  EXPECT_NEAR(ChiSquaredExceedance(10.828, 1.0), 0.001, 3e-7);
  EXPECT_NEAR(ChiSquaredExceedance(16.266, 3.0), 0.001, 3e-7);
  EXPECT_NEAR(ChiSquaredExceedance(29.588, 10.0), 0.001, 3e-7);
  EXPECT_NEAR(ChiSquaredExceedance(149.449, 100.0), 0.001, 3e-7);
  EXPECT_DOUBLE_EQ(ChiSquaredExceedance(5.0, 2.0), std::exp(-2.5));
  EXPECT_GT(ChiSquaredExceedance(5.0, 2.5), ChiSquaredExceedance(5.0, 2.0));
  EXPECT_LT(ChiSquaredExceedance(5.0, 2.5), ChiSquaredExceedance(5.0, 3.0));
}

TEST(VarianceRatioExceedance, AgreesWithTablesOfF) {
  // Upper 0.05 and 0.001 points as printed, to half a unit of their last digit.
  EXPECT_NEAR(VarianceRatioExceedance(4.9646, 1.0, 10.0), 0.05, 1e-6);
  EXPECT_NEAR(VarianceRatioExceedance(51.71, 5.0, 4.0), 0.001, 1e-6);
  EXPECT_NEAR(VarianceRatioExceedance(5.0, 2.0, 1e9), std::exp(-5.0), 1e-9);  // chi-squared of 10
  EXPECT_EQ(VarianceRatioExceedance(0.0, 3.0, 4.0), 1.0);
  EXPECT_EQ(VarianceRatioExceedance(std::numeric_limits<double>::infinity(), 3.0, 4.0), 0.0);
  EXPECT_TRUE(std::isnan(VarianceRatioExceedance(1.0, 3.0, 0.0)));
}

TEST(LogDensities, AreThoseOfCauchyForOneDegreeOfFreedomAndOfANormalForVeryMany) {
  EXPECT_NEAR(StudentLogDensity(1.5, 1.0, 0.5), -std::log(M_PI * 0.5 * (1.0 + 9.0)), 1e-14);
  EXPECT_NEAR(NormalLogDensity(0.6, 0.5), std::log(std::exp(-0.72) / (0.5 * std::sqrt(2.0 * M_PI))), 1e-14);
  // The next term of the series is of the order of 1 / dof.
  EXPECT_NEAR(StudentLogDensity(0.6, 1e6, 0.5), NormalLogDensity(0.6, 0.5), 1e-6);
}

TEST(Median, IsOneOfTheValues) {
  EXPECT_EQ(Median({5.0, 1.0, 3.0}), 3.0);
  EXPECT_EQ(Median({5.0, 1.0, 3.0, 2.0}), 3.0);  // the upper one
}

TEST(ParseNumber, TakesTheWholeTextOfAFiniteNumberOrNothing) {
  EXPECT_EQ(ParseNumber(" 1.5e3 "), 1500.0);
  EXPECT_EQ(ParseNumber("+2"), 2.0);
  for (const char* text : {"1.5x", "1,5", "", "+-2", "nan", "inf", "1e999"})
    EXPECT_EQ(ParseNumber(text), std::nullopt) << text;
}

TEST(ParseNumber, OfAWholeNumberRefusesFractionsAndOfASeedGoesToTheLargestOfSixtyFourBits) {
  EXPECT_EQ(ParseWholeNumber("-12"), -12);
  EXPECT_EQ(ParseWholeNumber("1.0"), std::nullopt);
  EXPECT_EQ(ParseWholeNumber("99999999999999999999"), std::nullopt);
  EXPECT_EQ(ParseSeed("18446744073709551615"), std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(ParseSeed("-1"), std::nullopt);
}

TEST(PrintInUnit, WritesWhatAPersonWouldWriteWithTheSignOfZeroAndRefusesWhatIsNotFinite) {
  EXPECT_EQ(PrintInUnit(650.0 * units::nm, units::nm), "650");
  EXPECT_EQ(PrintInUnit(0.02 * units::arcsec, units::arcsec), "0.02");
  EXPECT_EQ(PrintInUnit(-0.1, 1.0), "-0.1");
  const double zero = ParseInUnit(PrintInUnit(-0.0, units::mm), units::mm).value();
  EXPECT_TRUE(zero == 0.0 && std::signbit(zero));
  EXPECT_THROW(PrintInUnit(std::nan(""), 1.0), std::logic_error);
  EXPECT_THROW(PrintInUnit(std::numeric_limits<double>::infinity(), 1.0), std::logic_error);
}

/// Any finite number: random bits.
double AnyFinite(std::mt19937_64& random) {
  for (;;) {
    const double value = std::bit_cast<double>(random());
    // Outside, value / factor or the extended product leaves the normal doubles; no length or angle is there.
    if (std::abs(value) > 1e-280 && std::abs(value) < 1e280) return value;
  }
}

TEST(PrintInUnit, IsReadBackToTheSameBitsWithEveryFactor) {
  std::mt19937_64 random(1);
  for (const double to_SI : {1.0, units::deg, units::arcsec, units::mrad, units::um, units::nm, units::mm, 1e6,
                             units::urad / units::hour}) {
    for (int i = 0; i < 2000; ++i) {
      // First two that need more than 17 digits and have a zero behind them, in degrees.
      const double value = i == 0 ? 0x1.c79cdf9d63f7p+3 : i == 1 ? -0x1.2694c5bd26a4ep+3 : AnyFinite(random);
      const std::string text = PrintInUnit(value, to_SI);
      const auto read = ParseInUnit(text, to_SI);
      ASSERT_TRUE(read) << text;
      ASSERT_EQ(std::bit_cast<std::uint64_t>(*read), std::bit_cast<std::uint64_t>(value)) << text << " * " << to_SI;
    }
  }
}

// How long ago something was, by two marks: tests/tools/resume_test.cc.

TEST(ElapsedTime, KeepsAMarkAsText) {
  const ClockMark now = ClockMarkNow();
  EXPECT_GT(now.since_boot_s, 0.0);
  const auto back = ParseClockMark(TextOf(now));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->boot, now.boot);
  EXPECT_NEAR(back->since_boot_s, now.since_boot_s, 1e-8);
  EXPECT_NEAR(back->utc_s, now.utc_s, 1e-6);
  EXPECT_EQ(ParseClockMark("iio:192.168.1.7"), std::nullopt);
  const auto without = ParseClockMark(TextOf({"", 3.0, 4.0}));
  ASSERT_TRUE(without);
  EXPECT_EQ(without->boot, "");
}

EffectSettings Effect(const std::string& name, const std::map<std::string, double>& parameters) {
  EffectSettings effect;
  effect.name = name;
  effect.parameters = parameters;
  return effect;
}

TEST(HappenedOnce, IsThereInItsRunStaysInLaterOnesAndIsNotYetInEarlierOnes) {
  Scenario scenario;
  scenario.repeat = 2;
  scenario.effects = {Effect("slip", {{"step", 0.1}, {"at_reading", 40.0}}), Effect("drift", {{"rate", 0.2}})};
  EXPECT_EQ(InRun(scenario, 2).effects.front().parameters.at("at_reading"), 40.0);
  const Scenario later = InRun(scenario, 3), earlier = InRun(scenario, 0);
  EXPECT_EQ(later.repeat, 3);
  EXPECT_EQ(later.effects.front().parameters.at("at_reading"), 0.0);
  EXPECT_EQ(later.effects.front().parameters.at("step"), 0.1);
  ASSERT_EQ(earlier.effects.size(), 1u);
  EXPECT_EQ(earlier.effects.front().name, "drift");
}

std::string Repeated(const std::string& text, int times) {
  std::string all;
  for (int k = 0; k < times; ++k) all += text;
  return all;
}

std::string BoundsError(const std::string& text) { return MessageOf([&] { RequireModestKeys(text, "a.toml"); }); }

TEST(TomlBounds, RefuseKeysOfManyPartsHoweverTheyAreWrittenAndOfManyLetters) {
  constexpr int kMany = 100000;
  const std::string too_many = ": a key of 100001 parts; expected at most 64";
  for (const char* part : {"a.", "a . ", "\"a\".", "'a'."}) {
    const std::string parts = Repeated(part, kMany);
    EXPECT_EQ(BoundsError("x = 1\n" + parts + "a = 1\n"), "a.toml:2" + too_many) << part;
    EXPECT_EQ(BoundsError("[" + parts + "a]\n"), "a.toml:1" + too_many);
    EXPECT_EQ(BoundsError("x = {" + parts + "a = 1}"), "a.toml:1" + too_many);
  }
  EXPECT_EQ(BoundsError(std::string(200000, 'k') + "= 1"),
            "a.toml:1: a key of 200000 letters; expected at most 1024");
  EXPECT_EQ(BoundsError("[t]\n\"" + std::string(200000, 'k') + "\"= 1"),
            "a.toml:2: a key of 200001 letters; expected at most 1024");
}

TEST(TomlBounds, LetLongValuesAndCommentsPass) {
  const std::string numbers = Repeated("0.125, ", 100000);
  const std::string words = Repeated("a.b.c ", 100000);
  EXPECT_NO_THROW(RequireModestKeys("x = [" + numbers + "]\ny = \"" + words + "\"\n", "a.toml"));
  EXPECT_NO_THROW(RequireModestKeys("# " + words + "\nx = '''\n" + words + "'''\nz = 1", "a.toml"));
  EXPECT_NO_THROW(RequireModestKeys("x = \"an escaped \\\" and a # that is none = " + words + "\"", "a.toml"));
}

TEST(SideBySide, DoesEachPieceOnceByAnyNumberOfThreads) {
  for (const int threads : {1, 2, 7, 100}) {
    std::vector<int> times(50);
    SideBySide(50, threads, [&](int k) { ++times[static_cast<std::size_t>(k)]; });
    EXPECT_EQ(times, std::vector<int>(50, 1)) << threads;
  }
  SideBySide(0, 3, [](int) { FAIL() << "there is no piece"; });
}

TEST(SideBySide, ThrowsWhatAPieceThrowsAndBeginsNoMore) {
  std::atomic<int> begun = 0;
  const auto work = [&](int) {
    if (++begun > 2) throw std::runtime_error("third");
  };
  EXPECT_THROW(SideBySide(1000, 2, work), std::runtime_error);
  EXPECT_LT(begun, 10);
}

}  // namespace
}  // namespace twinbench
