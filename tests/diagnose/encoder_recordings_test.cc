#include <gmock/gmock.h>

#include <set>

#include "tests/diagnose/encoder_record.h"
#include "twin/benches/encoder_comparison/estimators/angle_comparison.h"
#include "twin/core/reading_clock.h"

namespace twinbench::diagnose::encoder {
namespace {

using namespace lab;
using ::testing::Contains;
using ::testing::HasSubstr;

// What recordings of others have beside a cause: glitches, a part of a turn, targets of a stage. Closed forms.

constexpr double kDeg = units::deg;

/// A list without a clock, from `from_deg` on over `travel_deg` and back as often as is said.
template <class Shows>
Record Listed(double from_deg, double travel_deg, int stops, int passes, Shows shows_deg) {
  Record record{"stops"};
  for (int k = 0; k < passes * stops; ++k) {
    const int pass = k / stops, stop = pass % 2 == 0 ? k % stops : stops - 1 - k % stops;
    const double angle_deg = from_deg + travel_deg * (stop + 0.5) / stops;
    record.Add(k, angle_deg, shows_deg(k, angle_deg), pass % 2 == 0 ? 1 : -1, pass);
    record.readings.back().extra[kClockColumn] = kNoClock;
  }
  return record;
}

double FirstTwoOrders_deg(double angle_deg) {
  return 0.9 * std::cos((angle_deg + 20.0) * kDeg) + 0.25 * std::cos((2.0 * angle_deg - 80.0) * kDeg);
}

/// A device that wraps and shows `wrong_deg` at some readings.
Record WithGlitches(const std::vector<std::pair<int, double>>& wrong_deg, unsigned seed) {
  Noise noise_deg(0.01, seed);
  return Listed(0.0, 360.0, 300, 2, [&](int k, double angle_deg) {
    const double right_deg = angle_deg + FirstTwoOrders_deg(angle_deg) + noise_deg();
    const auto glitch = std::ranges::find(wrong_deg, k, [](const auto& g) { return g.first; });
    return glitch == wrong_deg.end() ? right_deg - 360.0 * std::floor(right_deg / 360.0) : glitch->second;
  });
}

void ExpectOrdersAsWithoutGlitches(const Record& record, const std::set<int>& glitches) {
  const Answer answer = Ask(record);
  SCOPED_TRACE(answer.Words());
  EXPECT_NEAR(answer.Value("eccentricity", "amplitude"), 0.9, 0.004);
  EXPECT_NEAR(answer.Value("ellipticity", "amplitude"), 0.25, 0.004);
  EXPECT_FALSE(answer.Names("slip", 0.1));
  EXPECT_FALSE(HasUnmodelled(answer.run.diagnosis));
  EXPECT_TRUE(answer.Names("outliers"));
  EXPECT_NEAR(answer.Value("outliers", "fraction") * 600.0, static_cast<double>(glitches.size()), 1e-6);
  EXPECT_THAT(answer.run.diagnosis.notes, Contains(HasSubstr(std::to_string(*glitches.begin()))));
  EXPECT_EQ(answer.Again().verdict, Verdict::kNone);
}

TEST(EncoderRecordings, OneReadingFarOffTakesNothingFromTheOthers) {
  for (const unsigned seed : Seeds({1u, 2u})) {
    ExpectOrdersAsWithoutGlitches(WithGlitches({{417, 89.7}}, seed), {417});
    ExpectOrdersAsWithoutGlitches(WithGlitches({{0, 50.0}}, seed), {0});
    ExpectOrdersAsWithoutGlitches(WithGlitches({{31, 200.0}, {290, 5.0}, {511, 170.0}}, seed), {31, 290, 511});
  }
}

TEST(EncoderRecordings, ATableInterpolatedAcrossItsWrapIsNoSlip) {
  ExpectOrdersAsWithoutGlitches(WithGlitches({{297, 270.0}, {298, 180.0}, {299, 90.0}}, 3), {297, 298, 299});
  ExpectOrdersAsWithoutGlitches(WithGlitches({{597, 90.0}, {598, 180.0}, {599, 270.0}}, 4), {597, 598, 599});
}

TEST(EncoderRecordings, WholeTurnsAreContinuedBehindAGlitch) {
  std::vector<Reading> readings(12);
  for (int i = 0; i < 12; ++i) readings[i].reference_rad = i * kDeg;
  for (int i = 0; i < 12; ++i) readings[i].measured_rad = (i + 170.0) * kDeg;
  readings[5].measured_rad += 100.0 * kDeg;  // a turn is made up in three steps
  readings[6].measured_rad += 200.0 * kDeg;
  readings[7].measured_rad += 300.0 * kDeg;
  const Eigen::VectorXd error_rad = measure::CompareAngles(readings).error_rad;
  EXPECT_NEAR(error_rad[4], 170.0 * kDeg, 1e-12);
  EXPECT_NEAR(error_rad[8], 170.0 * kDeg, 1e-12) << "360 deg more without the level before";
}

TEST(EncoderRecordings, APartOfATurnShowsOneOrderHoweverHighItIs) {
  Noise noise_deg(0.002, 5);
  for (const auto& [order, travel_deg, stops] :
       {std::tuple{2048, 60.0, 3000}, std::tuple{180, 40.0, 250}, std::tuple{900, 47.0, 1200}}) {
    const Answer answer = Ask(Listed(33.0, travel_deg, stops, 1, [&](int, double angle_deg) {
      return angle_deg + 0.01 * std::cos((order * angle_deg + 75.0) * kDeg) + noise_deg();
    }));
    SCOPED_TRACE(answer.Words());
    EXPECT_EQ(answer.run.diagnosis.causes.size(), 1u);
    EXPECT_NEAR(answer.Value("periodic", "order"), order, 0.1 * 360.0 / travel_deg)
        << "of what the travel resolves";
    EXPECT_NEAR(answer.Value("periodic", "amplitude"), 0.01, 0.0005);
    EXPECT_EQ(answer.Again().verdict, Verdict::kNone);
  }
}

/// A wave and a fault whose signature begins with it: what is told has a size, and the file has it.
TEST(EncoderRecordings, AnOrderFourBesideLargerOnesHasASize) {
  for (const unsigned seed : Seeds({1u, 2u, 3u})) {
    Noise noise_deg(0.02, seed);
    const Answer answer = Ask(Listed(0.0, 360.0, 588, 1, [&](int, double angle_deg) {
      return angle_deg + 2.0 * FirstTwoOrders_deg(angle_deg) + 0.07 * std::cos((4.0 * angle_deg + 130.0) * kDeg) +
             noise_deg();
    }));
    SCOPED_TRACE(answer.Words());
    EXPECT_NEAR(answer.Value("periodic", "amplitude"), 0.07, 0.006);
    EXPECT_EQ(answer.Again().verdict, Verdict::kNone);
  }
}

/// A stage of 11 targets whose scale errs, each target by a little of its own.
TEST(EncoderRecordings, AScaleIsToldBeforeErrorsOfTargets) {
  for (const unsigned seed : Seeds({1u, 2u, 3u})) {
    Noise normal(1.0, seed);
    std::vector<double> own_deg(11);
    for (double& e : own_deg) e = 0.004 * normal();
    const Answer answer = Ask(Listed(0.0, 220.0, 11, 10, [&](int, double angle_deg) {
      return 1.001 * angle_deg + own_deg.at(static_cast<std::size_t>(angle_deg / 20.0)) + 0.0008 * normal();
    }));
    SCOPED_TRACE(answer.Words());
    ASSERT_FALSE(answer.run.diagnosis.causes.empty());
    EXPECT_EQ(answer.run.diagnosis.causes.front().effect, "scale");
    EXPECT_NEAR(answer.Value("scale", "ratio"), 1e-3, 4.0 * answer.Uncertainty("scale", "ratio"));
    EXPECT_LT(answer.Uncertainty("scale", "ratio"), 5e-5);
    EXPECT_EQ(answer.run.diagnosis.verdict, Verdict::kNamed);
    EXPECT_THAT(answer.run.diagnosis.unknown.signature, HasSubstr("error of its own at each of 11 targets"));
    EXPECT_EQ(answer.Again().verdict, Verdict::kNone);
  }
}

/// A servo that follows late, read by a resolver whose order 4 is large: 8 and 12 are there by the lateness alone.
TEST(EncoderRecordings, ALargeOrderFourThatIsLateIsNoClipping) {
  const Swing swing{300.0, 40.0, 20.0};
  const double delay_s = 0.15;
  const Answer answer = Ask(Swung(swing, 1.0, 41.0, 0.02, 0.02, 7, [&](double t_s) {
    const double shaft_deg = swing.At(t_s - delay_s);
    return shaft_deg + 8.0 * std::cos((4.0 * shaft_deg + 35.0) * kDeg);
  }));
  SCOPED_TRACE(answer.Words());
  EXPECT_FALSE(answer.Names("signal_clipping", 0.1));
  EXPECT_TRUE(answer.Names("latency") && answer.Names("periodic"));
  EXPECT_NEAR(answer.Value("latency", "delay"), delay_s, 0.003);
  EXPECT_NEAR(answer.Value("periodic", "amplitude"), 8.0, 0.05);
}

}  // namespace
}  // namespace twinbench::diagnose::encoder
