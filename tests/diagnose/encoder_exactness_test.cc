#include <gtest/gtest.h>

#include "tests/diagnose/encoder_record.h"
#include "twin/core/reading_clock.h"

namespace twinbench::diagnose::encoder {
namespace {

using namespace lab;

// How far a formula, a walk or a sum of waves may be believed. Closed forms.

/// A list without a clock: `stops` from `from_deg` over `travel_deg`, and back, `passes` in all.
Record ListedBothWays(double from_deg, double travel_deg, int stops, int passes,
                      const std::function<double(double angle_deg, int stop, int pass)>& error_deg) {
  Record record{"stops"};
  for (int k = 0; k < passes * stops; ++k) {
    const int pass = k / stops, stop = pass % 2 == 0 ? k % stops : stops - 1 - k % stops;
    const double angle_deg = from_deg + travel_deg * stop / stops;
    record.Add(k, angle_deg, angle_deg + error_deg(angle_deg, stop, pass), pass % 2 == 0 ? 1 : -1, pass);
    record.readings.back().extra[kClockColumn] = kNoClock;
  }
  return record;
}

/// Of what has no name; NaN if these words are not there.
double AmplitudeBehind(const std::string& words, const Answer& answer) {
  const std::string& signature = answer.run.diagnosis.unknown.signature;
  const std::size_t at = signature.find(words);
  return at == std::string::npos ? kNaN : std::stod(signature.substr(at + words.size()));
}

TEST(EncoderExactness, AFollowerThatIsLateToFirstOrderHasNoWrongScale) {
  // r - tau v of a swing: a delay of tau, less its second order, which is like a scale.
  const Swing swing{100.0, 6.0};
  const double late_s = 0.03, w = 2.0 * units::kPi / swing.period_s;
  for (const unsigned seed : Seeds({1u, 2u, 3u})) {
    const Answer answer = Ask(Swung(swing, 0.0, 12.0, 0.02, 0.04, seed, [&](double t_s) {
      return swing.At(t_s) - late_s * 0.5 * swing.range_deg * w * std::sin(w * t_s);
    }));
    SCOPED_TRACE(answer.Words());
    EXPECT_EQ(answer.run.diagnosis.causes.size(), 1u);
    EXPECT_NEAR(answer.Value("latency", "delay"), late_s, 4.0 * answer.Uncertainty("latency", "delay"));
    EXPECT_EQ(answer.Again().verdict, Verdict::kNone);
  }
}

TEST(EncoderExactness, AWaveIsNoLessAnOffsetOfTheSignalsForBeingOne) {
  for (const double size_deg : {1.2, 2.4}) {
    Noise noise_deg(0.01, 4);
    const Answer answer = Ask(ListedBothWays(0.9, 360.0, 200, 2, [&](double a, int, int) {
      return size_deg * std::cos((a + 40.0) * units::deg) + noise_deg();
    }));
    SCOPED_TRACE(answer.Words());
    EXPECT_EQ(answer.run.diagnosis.verdict, Verdict::kTie);
    EXPECT_EQ(answer.run.diagnosis.causes.size(), 2u) << "one mounting tells no eccentricity from an offset";
    EXPECT_EQ(answer.Again().verdict, Verdict::kNone);
  }
}

TEST(EncoderExactness, ACurveByTheAngleThatIsShownIsNoWalk) {
  // Of orders 1 and 2 by the shown angle, orders 1 to 4 by the shaft's.
  const Answer answer = Ask(ListedBothWays(0.0, 360.0, 200, 1, [](double a, int, int) {
    double error_deg = 0.0;
    for (int step = 0; step < 20; ++step) {
      const double shown = (a + error_deg) * units::deg;
      error_deg = 0.55 * std::cos(shown + 3.7) + 0.42 * std::cos(2.0 * shown + 3.3);
    }
    return std::round(error_deg * 65536.0 / 360.0) * 360.0 / 65536.0;
  }));
  SCOPED_TRACE(answer.Words());
  EXPECT_EQ(answer.run.diagnosis.unknown.signature.find("walk"), std::string::npos);
  EXPECT_NEAR(answer.Value("eccentricity", "amplitude"), 0.55, 0.01);
  EXPECT_EQ(answer.Again().verdict, Verdict::kNone);
}

TEST(EncoderExactness, WhatAlternatesWithTheDirectionHasTheSizeThatItShows) {
  for (const unsigned seed : Seeds({6u, 7u})) {
    Noise noise_deg(0.01, seed);
    const Answer answer = Ask(ListedBothWays(1.8, 360.0, 200, 2, [&](double a, int stop, int pass) {
      return 0.9 * std::cos(a * units::deg) + (stop % 2 == pass % 2 ? 0.1 : -0.1) + noise_deg();
    }));
    SCOPED_TRACE(answer.Words());
    EXPECT_NE(answer.run.diagnosis.unknown.signature.find("direction times order 100"), std::string::npos);
    EXPECT_NEAR(AmplitudeBehind("angle, amplitude ", answer), 0.1, 0.003);
    EXPECT_EQ(answer.Again().verdict, Verdict::kNone);
  }
}

TEST(EncoderExactness, AWalkHasTheSizeThatTheReadingsShowAndNoOtherName) {
  for (const unsigned seed : Seeds({8u, 9u})) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::vector<double> walk_deg;
    const Record record = Swung({360.0, 40.0}, 0.0, 15.0, 0.01, 0.005, seed, [&](double t_s) {
      walk_deg.push_back((walk_deg.empty() ? 0.0 : walk_deg.back()) + 0.004 * normal(random));
      return Swing{360.0, 40.0}.At(t_s) + walk_deg.back();
    });
    double mean = 0.0, squares = 0.0;
    for (const double w : walk_deg) mean += w / static_cast<double>(walk_deg.size());
    for (const double w : walk_deg) squares += std::pow(w - mean, 2) / static_cast<double>(walk_deg.size());
    const Answer answer = Ask(record);
    SCOPED_TRACE(answer.Words());
    EXPECT_NEAR(AmplitudeBehind("random walk, function of time, on angle, amplitude ", answer),
                std::sqrt(2.0 * squares), 0.25 * std::sqrt(2.0 * squares))
        << "some of it may be like a cause";
    for (const Cause& cause : answer.run.diagnosis.causes) EXPECT_LT(cause.probability, 0.5) << cause.effect;
  }
}

TEST(EncoderExactness, ASlowCourseBesideLargeCausesIsToldAndWritten) {
  // What follows the square of a temperature of the room.
  for (const unsigned seed : Seeds({21u, 22u})) {
    const Answer answer = Ask(Stops(0.002, 0.0, seed, [](double t_s, double a) {
      const double room_K = std::sin(t_s / 300.0) + 0.4 * std::sin(t_s / 90.0 + 1.0);
      return (t_s < 1100.0 ? 0.0 : 0.01) + 0.007 * std::cos(2.0 * a * units::deg) + 0.0025 * room_K * room_K;
    }));
    answer.Again();
    SCOPED_TRACE(answer.Words());
    EXPECT_TRUE(answer.Find("ellipticity"));
    EXPECT_NE(answer.run.diagnosis.unknown.signature.find("function of time"), std::string::npos);
    EXPECT_EQ(answer.Again().verdict, Verdict::kNone);
  }
}

/// 9 targets of a stage, five times there and back, while its zero goes on from pass to pass.
TEST(EncoderExactness, OffsetsOfPassesHideNoReversal) {
  for (const unsigned seed : Seeds({11u, 12u, 13u})) {
    Noise normal(1.0, seed);
    std::vector<double> curve_deg(9), pass_deg(10);
    for (double& c : curve_deg) c = 0.02 * normal();
    for (int k = 0; k < 10; ++k)
      pass_deg[static_cast<std::size_t>(k)] = 0.01 * (1.0 - 0.1 * k) + 0.0006 * normal();
    const Answer answer = Ask(ListedBothWays(-20.0, 45.0, 9, 10, [&](double, int stop, int pass) {
      return curve_deg[static_cast<std::size_t>(stop)] + pass_deg[static_cast<std::size_t>(pass)] +
             (pass % 2 == 0 ? -0.0065 : 0.0065) + 0.0015 * normal();
    }));
    SCOPED_TRACE(answer.Words());
    EXPECT_TRUE(answer.Names("backlash", 0.5) || answer.Names("hysteresis", 0.5));
    EXPECT_NEAR(answer.Value("backlash", "width"), 0.013, 0.002) << "offsets of ten passes are a little like it";
  }
}

/// Of which a part is looked at.
TEST(EncoderExactness, AStepInALongRecordingIsWhereItIs) {
  constexpr int kReadings = 5000, kStep = 2893;
  Noise noise_deg(0.0005, 21);
  Record record;
  for (int k = 0; k < kReadings; ++k) {
    const double angle_deg = 0.2 * k, error_deg = 0.01 * std::cos(angle_deg * units::deg) + (k < kStep ? 0.0 : 0.03);
    record.Add(0.01 * k, angle_deg, angle_deg + error_deg + noise_deg(), 1, 0);
  }
  const Answer answer = Ask(record);
  SCOPED_TRACE(answer.Words());
  EXPECT_TRUE(answer.Names("slip", 0.8));
  EXPECT_NEAR(answer.Value("slip", "at_reading"), kStep, 1.0);
  EXPECT_FALSE(answer.Names("outliers", 0.1));
}

TEST(EncoderExactness, ACurveOverAPartOfATurnIsNoSumOfOrders) {
  for (const unsigned seed : Seeds({15u, 16u})) {
    Noise normal(1.0, seed);
    std::vector<double> knots_deg(30);
    for (double& k : knots_deg) k = 0.05 * normal();
    const Answer answer = Ask(ListedBothWays(12.0, 45.0, 450, 1, [&](double, int stop, int) {
      const double at = stop / 16.0, share = 0.5 * (1.0 - std::cos(units::kPi * (at - std::floor(at))));
      const auto k = static_cast<std::size_t>(at);
      return std::lerp(knots_deg[k], knots_deg[k + 1], share) + 0.001 * normal();
    }));
    SCOPED_TRACE(answer.Words());
    EXPECT_EQ(answer.run.diagnosis.verdict, Verdict::kUnknown);
    EXPECT_EQ(answer.Find("periodic"), nullptr);
    EXPECT_NE(answer.run.diagnosis.unknown.signature.find("error curve over a part of a turn"), std::string::npos);
  }
}

TEST(EncoderExactness, ASingleFarReadingThatNoOtherPassCheckedMayBeOfItsPlace) {
  for (const double between_deg : {0.0, 1.3}) {
    Noise noise_deg(0.002, 18);
    Record record;
    for (int k = 0; k < 800; ++k) {
      const int pass = k / 200;
      const double turned_deg = 3.6 * (pass % 2 == 0 ? k % 200 : 199 - k % 200) + between_deg * pass;
      record.Add(0.1 * k + pass, turned_deg, turned_deg + noise_deg() + (k == 333 ? 0.04 : 0.0),
                 pass % 2 == 0 ? 1 : -1, pass);
    }
    const Answer answer = Ask(record);
    SCOPED_TRACE(answer.Words());
    EXPECT_TRUE(answer.Names("outliers", 0.5));
    EXPECT_EQ(answer.Names("outliers", 0.8), between_deg == 0.0) << "others were at the place";
    EXPECT_EQ(answer.run.diagnosis.unknown.signature.empty(), between_deg == 0.0);
    EXPECT_EQ(answer.Again().verdict, Verdict::kNone);
  }
}

TEST(EncoderExactness, AWormIsNoPieceOfACurve) {
  Noise normal(1.0, 17);
  std::vector<double> knots_deg(17);
  for (double& k : knots_deg) k = 0.01 * normal();
  const Answer answer = Ask(ListedBothWays(12.0, 45.0, 800, 1, [&](double a, int stop, int) {
    const double at = stop / 50.0, share = 0.5 * (1.0 - std::cos(units::kPi * (at - std::floor(at))));
    const auto k = static_cast<std::size_t>(at);
    return std::lerp(knots_deg[k], knots_deg[k + 1], share) + 0.004 * std::cos(400.0 * a * units::deg) +
           0.0003 * normal();
  }));
  SCOPED_TRACE(answer.Words());
  EXPECT_EQ(answer.Value("periodic", "order"), 400.0);
  EXPECT_NEAR(answer.Value("periodic", "amplitude"), 0.004, 0.0001);
  EXPECT_NE(answer.run.diagnosis.unknown.signature.find("error curve over a part of a turn"), std::string::npos);
}

}  // namespace
}  // namespace twinbench::diagnose::encoder
