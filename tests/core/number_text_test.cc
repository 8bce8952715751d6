#include "twin/core/number_text.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "twin/core/units.h"

namespace twinbench {
namespace {

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

TEST(ParseInUnit, GivesTheProductThatTheSourceCodeGives) {
  EXPECT_EQ(ParseInUnit("0.02", units::arcsec), 0.02 * units::arcsec);
  EXPECT_EQ(ParseInUnit("650", units::nm), 650.0 * units::nm);
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

}  // namespace
}  // namespace twinbench
