#include <gmock/gmock.h>

#include <utility>

#include "tests/diagnose/encoder_record.h"
#include "twin/core/reading_clock.h"
#include "twin/diagnose/engine/repeats.h"
#include "twin/model/motion.h"

namespace twinbench::diagnose::encoder {
namespace {

using namespace lab;

// Recordings in which one thing dominates and something else is there too, by closed forms. What is named first must be
// what is largest, in its size, however flexible other shapes are.

struct Wave {
  int order;
  double size_deg, phase_deg;
  double At(double angle_deg) const { return size_deg * std::cos((order * angle_deg + phase_deg) * units::deg); }
};

double Sum(const std::vector<Wave>& waves, double angle_deg) {
  double sum = 0.0;
  for (const Wave& wave : waves) sum += wave.At(angle_deg);
  return sum;
}

/// A list without a clock: `stops` once round and the same back.
template <class Error>
Record ThereAndBack(int stops, double noise_deg, unsigned seed, Error error_deg) {
  Noise noise(noise_deg, seed);
  Record record{"stops"};
  for (int k = 0; k < 2 * stops; ++k) {
    const int stop = k < stops ? k : 2 * stops - 1 - k, direction = k < stops ? 1 : -1;
    const double angle_deg = 360.0 * (stop + 1) / stops;
    record.Add(k, angle_deg, angle_deg + error_deg(angle_deg, stop, direction) + noise(), direction, k / stops);
    record.readings.back().extra[kClockColumn] = kNoClock;
  }
  return record;
}

/// Stops from zero on, there and back twice.
/// @param shown_deg  Of an angle and a direction.
template <class Shown>
Record ThereAndBackTwice(int stops, double step_deg, Shown shown_deg) {
  Record record{"stops"};
  for (int k = 0; k < 4 * stops; ++k) {
    const int pass = k / stops, at = k % stops, direction = pass % 2 == 0 ? 1 : -1;
    const double angle_deg = step_deg * (direction > 0 ? at : stops - 1 - at);
    record.Add(k, angle_deg, shown_deg(angle_deg, direction), direction, pass);
  }
  return record;
}

/// Stops from zero on in one pass that has no clock.
/// @param error_deg  Of an angle.
template <class Error>
Record OnePass(int stops, double step_deg, double noise_deg, unsigned seed, Error error_deg) {
  Noise noise(noise_deg, seed);
  Record record{"stops"};
  for (int k = 0; k < stops; ++k) {
    const double angle_deg = step_deg * k;
    record.Add(k, angle_deg, angle_deg + error_deg(angle_deg) + noise(), 1, 0);
    record.readings.back().extra[kClockColumn] = kNoClock;
  }
  return record;
}

/// Of the wave of this order, whatever its name is.
double SizeOfOrder(const Answer& answer, int order) {
  if (order == 1) return answer.Value("eccentricity", "amplitude");
  if (order == 2) return answer.Value("ellipticity", "amplitude");
  for (const Cause& cause : answer.run.diagnosis.causes) {
    double size = kNaN;
    bool is_it = false;
    for (const ParameterEstimate& p : cause.parameters) {
      if (p.name == "order") is_it = p.value == order;
      if (p.name == "amplitude") size = p.value / p.to_SI;
    }
    if (cause.effect == "periodic" && is_it) return size;
  }
  return kNaN;
}

TEST(EncoderDominant, OrdersThatRepeatThereAndBackAreNoWander) {
  const std::vector<Wave> waves = {{1, 0.3, 20.0}, {2, 0.1, 140.0}, {3, 0.04, -70.0}, {4, 0.03, 260.0}};
  for (const unsigned seed : Seeds({1u, 2u, 3u})) {
    for (const auto& [stops, noise_deg] : {std::pair{200, 0.015}, std::pair{72, 0.003}}) {
      const Answer answer = Ask(ThereAndBack(stops, noise_deg, seed, [&](double a, int, int) { return Sum(waves, a); }));
      SCOPED_TRACE(answer.Words());
      EXPECT_EQ(answer.run.diagnosis.verdict, Verdict::kTie) << "one mounting tells no eccentricity from an offset";
      EXPECT_FALSE(HasUnmodelled(answer.run.diagnosis));
      for (const Wave& wave : waves)
        EXPECT_NEAR(SizeOfOrder(answer, wave.order), wave.size_deg, 4.0 * noise_deg / std::sqrt(stops)) << wave.order;
      EXPECT_EQ(answer.Again().verdict, Verdict::kNone);
    }
  }
}

TEST(EncoderDominant, AsManySmallOrdersAsThereAreAreInTheFile) {
  constexpr double kNoise_deg = 0.005;
  constexpr int kStops = 180, kFirst = 5, kLast = 16;
  std::vector<Wave> waves = {{1, 0.3, 20.0}, {2, 0.2, 140.0}};
  for (int order = kFirst; order <= kLast; ++order) waves.push_back({order, 0.008, 47.0 * order * order});
  const Answer answer = Ask(ThereAndBack(kStops, kNoise_deg, 7, [&](double a, int, int) { return Sum(waves, a); }));
  for (const Wave& wave : waves)
    EXPECT_NEAR(SizeOfOrder(answer, wave.order), wave.size_deg, 4.0 * kNoise_deg / std::sqrt(kStops)) << wave.order;
  EXPECT_EQ(answer.Again().verdict, Verdict::kNone) << answer.Words();
}

/// What is less than a ten-thousandth of the variance is left out; the second diagnosis is no keener.
TEST(EncoderDominant, WhatTheFirstDiagnosisHadForNothingTheSecondHasToo) {
  const std::vector<Wave> waves = {{1, 1.0, 20.0}, {7, 0.006, 70.0}, {11, 0.005, -20.0}};
  const Answer answer = Ask(ThereAndBack(360, 0.003, 8, [&](double a, int, int) { return Sum(waves, a); }));
  EXPECT_NEAR(SizeOfOrder(answer, 1), 1.0, 0.001) << answer.Words();
  EXPECT_EQ(answer.Again().verdict, Verdict::kNone) << answer.Words();
}

TEST(EncoderDominant, WhatHasNoNameStandsBesideWhatDominates) {
  const std::vector<Wave> waves = {{1, 0.5, 5.0}, {2, 0.3, 150.0}};
  const Answer answer = Ask(ThereAndBack(200, 0.01, 4, [&](double a, int stop, int direction) {
    return Sum(waves, a) + (stop % 2 == 0 ? 0.1 : -0.1) * direction;
  }));
  SCOPED_TRACE(answer.Words());
  EXPECT_EQ(answer.run.diagnosis.verdict, Verdict::kTie);
  EXPECT_TRUE(HasUnmodelled(answer.run.diagnosis));
  EXPECT_NEAR(SizeOfOrder(answer, 1), 0.5, 0.01);
  EXPECT_NEAR(SizeOfOrder(answer, 2), 0.3, 0.01);
}

TEST(EncoderDominant, CoggingThatShiftsWithTheDirectionIsAnOrderAndItsProductWithTheDirection) {
  const Answer answer = Ask(ThereAndBack(720, 0.01, 5, [](double a, int, int direction) {
    return 0.1 * std::cos((72.0 * a + (direction > 0 ? 0.0 : 90.0)) * units::deg);
  }));
  EXPECT_NEAR(SizeOfOrder(answer, 72), 0.1 / std::sqrt(2.0), 0.003) << answer.Words();
  EXPECT_NE(answer.run.diagnosis.unknown.signature.find("direction times order 72"), std::string::npos) << answer.Words();
  EXPECT_EQ(answer.Again().verdict, Verdict::kNone) << answer.Words();
}

TEST(EncoderDominant, AServoIsLateAndErrsByItsAcceleration) {
  // measured(t) = r - tau v - kappa a of a swing: r = R / 2 (1 - cos w t)
  const Swing swing{60.0, 2.0};
  const double w = 2.0 * units::kPi / swing.period_s, late_s = 0.004, kappa_s2 = 0.0004;
  const Record record = Swung(swing, 0.0, 12.0, 0.01, 0.02, 6, [&](double t_s) {
    const double v = 0.5 * swing.range_deg * w * std::sin(w * t_s), a = 0.5 * swing.range_deg * w * w * std::cos(w * t_s);
    return swing.At(t_s) - late_s * v - kappa_s2 * a;
  });
  const Answer answer = Ask(record);
  EXPECT_TRUE(answer.Names("latency")) << answer.Words();
  EXPECT_NEAR(answer.Value("latency", "delay"), late_s, 0.02 * late_s) << answer.Words();
}

TEST(EncoderDominant, AnOffsetOfEachPassTakesNothingOfAReversalBesideAHighOrder) {
  const Answer answer = Ask(ThereAndBack(400, 0.01, 13, [](double a, int stop, int direction) {
    const bool is_first_back = direction < 0 && stop == 399;  // inside the gap
    return Sum({{1, 0.2, 10.0}, {50, 0.15, 60.0}}, a) + (is_first_back ? 0.0 : -0.06 * direction);
  }));
  EXPECT_NEAR(SizeOfOrder(answer, 50), 0.15, 0.004) << answer.Words();
  EXPECT_NEAR(answer.Value("backlash", "width"), 0.12, 4.0 * answer.Uncertainty("backlash", "width")) << answer.Words();
}

/// A joint whose targets are met to a part of a step: the first place behind a reversal is not quite the last one.
TEST(EncoderDominant, PlayIsFoundAtTargetsThatAreNotMetExactly) {
  std::mt19937_64 random(14);
  std::normal_distribution<double> noise_deg(0.0, 0.004), off_deg(0.0, 0.02);
  Record record{"stops"};
  for (int k = 0; k < 4 * 120; ++k) {
    const int pass = k / 120, at = k % 120, direction = pass % 2 == 0 ? 1 : -1;
    const double r_deg = -60.0 + 1.0 * (direction > 0 ? at : 119 - at) + off_deg(random);
    record.Add(k, r_deg, 1.001 * r_deg - 0.03 * direction + 0.03 * std::cos(45.0 * r_deg * units::deg) + noise_deg(random), direction, pass);
  }
  const Answer answer = Ask(record);
  EXPECT_NEAR(answer.Value("backlash", "width"), 0.06, 4.0 * answer.Uncertainty("backlash", "width")) << answer.Words();
  EXPECT_NEAR(answer.Value("scale", "ratio"), 0.001, 4.0 * answer.Uncertainty("scale", "ratio")) << answer.Words();
}

TEST(EncoderDominant, AScaleBesideAnOrderOfAPartOfATurnDoesNotBend) {
  for (const unsigned seed : Seeds({15u, 16u, 17u})) {
    Noise noise_deg(0.1, seed);
    const Answer answer = Ask(ThereAndBackTwice(181, 1.5, [&](double r_deg, int) {
      return 1.008 * r_deg + 0.5 * std::cos((r_deg + 200.0) * units::deg) + noise_deg();
    }));
    EXPECT_NEAR(answer.Value("scale", "ratio"), 0.008, 4.0 * answer.Uncertainty("scale", "ratio")) << answer.Words();
    EXPECT_NEAR(SizeOfOrder(answer, 1), 0.5, 0.05) << answer.Words();
  }
}

/// To and fro at one speed a delay jumps where the shaft turns, as play does that is crossed at once.
TEST(EncoderDominant, ADelayOfATriangleIsNoPlay) {
  Noise noise_deg(0.05, 18);
  const auto shaft_deg = [](double t_s) { return 30.0 - std::abs(std::remainder(30.0 * t_s, 120.0)); };
  Record record;
  for (int k = 0; k < 1600; ++k) {
    const double t_s = 1.0 + 0.01 * k;
    const int half = static_cast<int>(t_s / 2.0);
    record.Add(t_s, shaft_deg(t_s), 0.96 * shaft_deg(t_s - 0.06) + noise_deg(), half % 2 == 0 ? -1 : 1, half);
  }
  const Answer answer = Ask(record);
  EXPECT_TRUE(answer.Names("latency")) << answer.Words();
  EXPECT_NEAR(answer.Value("latency", "delay"), 0.06, 0.05 * 0.06) << answer.Words() << ": of the scaled shaft";
  EXPECT_EQ(answer.Find("backlash"), nullptr) << answer.Words();
}

TEST(EncoderDominant, TheNoiseOfAReferenceThatMovesIsNoAcceleration) {
  Noise noise_deg(0.003, 19);
  Record record;
  for (int k = 0; k < 1800; ++k) {
    const int pass = k / 900, direction = pass % 2 == 0 ? 1 : -1;
    const double shaft_deg = -90.0 + 0.2 * (direction > 0 ? k % 900 : 899 - k % 900);
    record.Add(0.02 * k, shaft_deg + noise_deg(), shaft_deg + 0.014 * std::cos(200.0 * shaft_deg * units::deg), direction, pass);
  }
  const Answer answer = Ask(record);
  EXPECT_NEAR(SizeOfOrder(answer, 200), 0.014, 0.0005) << answer.Words();
  EXPECT_FALSE(HasUnmodelled(answer.run.diagnosis)) << answer.Words();
}

TEST(EncoderDominant, AFaultOfAFewPlacesLeavesTheOrdersBesideIt) {
  Noise noise_deg(0.008, 20);
  const Answer answer = Ask(ThereAndBackTwice(360, 1.0, [&](double r_deg, int) {
    const double dirt_deg = 0.4 * std::exp(-0.5 * std::pow((r_deg - 137.0) / 1.2, 2));
    return r_deg + dirt_deg + Sum({{1, 0.06, 30.0}}, r_deg) + noise_deg();
  }));
  EXPECT_NEAR(SizeOfOrder(answer, 1), 0.06, 0.002) << answer.Words();
  EXPECT_NE(answer.run.diagnosis.unknown.signature.find("targets"), std::string::npos) << answer.Words();
}

TEST(EncoderDominant, ALatencyAndTheOrdersBesideItHaveTheirSizes) {
  const std::vector<Wave> waves = {{1, 0.4, 190.0}, {2, 0.4, 60.0}, {4, 0.12, 235.0}};
  const Swing swing{360.0, 16.0};
  const double late_s = 0.035;
  const Record record = Swung(swing, 0.0, 16.0, 0.01, 0.01, 7, [&](double t_s) {
    const double shaft_deg = swing.At(t_s - late_s);
    return shaft_deg + Sum(waves, shaft_deg);
  });
  const Answer answer = Ask(record);
  EXPECT_TRUE(answer.Names("latency")) << answer.Words();
  EXPECT_NEAR(answer.Value("latency", "delay"), late_s, 0.02 * late_s) << answer.Words();
  for (const Wave& wave : waves) EXPECT_NEAR(SizeOfOrder(answer, wave.order), wave.size_deg, 0.05 * wave.size_deg) << answer.Words();
}

/// A servo that follows what was commanded a while ago, at `most_deg_s` at the fastest, in steps of a tenth of a reading's.
Answer FollowedWithin(double most_deg_s, double late_s, unsigned seed) {
  const Swing swing{120.0, 3.0};
  const double step_s = 0.002;
  double at_deg = 0.0, at_s = 0.0;
  return Ask(Swung(swing, 0.0, 15.0, 10.0 * step_s, 0.02, seed, [&](double t_s) {
    for (; at_s < t_s - 0.5 * step_s; at_s += step_s) {
      const double way_deg = swing.At(std::max(0.0, at_s + step_s - late_s)) - at_deg;
      at_deg += std::clamp(way_deg, -most_deg_s * step_s, most_deg_s * step_s);
    }
    return at_deg;
  }));
}

TEST(EncoderDominant, AServoThatIsCommandedFasterThanItCanGoHasASpeedLimit) {
  for (const auto& [most_deg_s, words] : {std::pair{80.0, "speed limit of 80"}, std::pair{95.0, "speed limit of 95"}}) {
    const Answer answer = FollowedWithin(most_deg_s, 0.06, 10);
    SCOPED_TRACE(answer.Words());
    EXPECT_EQ(answer.run.diagnosis.verdict, Verdict::kUnknown);
    EXPECT_EQ(answer.run.diagnosis.unknown.signature.rfind(words, 0), 0U);
    EXPECT_TRUE(answer.run.diagnosis.causes.empty()) << "the rest is no news";
    EXPECT_EQ(answer.Again().unknown.signature.find("speed limit"), std::string::npos) << "the file that was written has it";
  }
  const Answer fast = FollowedWithin(1000.0, 0.06, 10);
  EXPECT_TRUE(fast.Names("latency")) << fast.Words();
  EXPECT_NEAR(fast.Value("latency", "delay"), 0.06, 0.001) << fast.Words();
}

TEST(EncoderDominant, OnePlacePushedFromBothSidesShowsThePlay) {
  Noise noise_deg(0.001, 8);
  Record record{"stops"};
  for (int k = 0; k < 20; ++k) record.Add(k, 30.0, 30.0 - 0.005 * (k % 2 == 0 ? 1 : -1) + noise_deg(), k % 2 == 0 ? 1 : -1, k);
  const Answer answer = Ask(record);
  EXPECT_TRUE(answer.Names("backlash", 0.5)) << answer.Words();
  EXPECT_NEAR(answer.Value("backlash", "width"), 0.01, 4.0 * answer.Uncertainty("backlash", "width"));
  EXPECT_EQ(answer.Again().verdict, Verdict::kNone) << answer.Words();
}

TEST(EncoderDominant, WithoutAClockAScaleThatBendsIsNoDrift) {
  const Answer answer = Ask(OnePass(30, 8.0, 0.001, 9, [](double a_deg) { return 0.001 * a_deg * (1.0 + 0.8 * a_deg / 360.0); }));
  ExpectFound(answer, {{"scale", "ratio", 0.001, 1e-4}, {"scale", "curvature", 0.8, 0.1}});
  EXPECT_EQ(answer.Find("drift"), nullptr) << answer.Words();
  // The straight line through a parabola has its slope in the middle, at 116 deg.
  EXPECT_THAT(answer.run.diagnosis.notes, testing::Contains(testing::HasSubstr("scale: 0.0015")));
}

TEST(EncoderDominant, ACourseInTimeThatDoesNotRepeatIsNoOrder) {
  const auto wanders = [](double t_s, double) { return 0.02 * std::sin(0.0127 * t_s) + 0.01 * std::cos(0.031 * t_s + 1.0); };
  const Answer answer = Ask(Stops(0.001, 0.0, 22, wanders));
  EXPECT_FALSE(answer.Names("periodic", 0.5) || answer.Names("eccentricity", 0.3) || answer.Names("ellipticity", 0.3)) << answer.Words();
  EXPECT_EQ(answer.run.diagnosis.verdict, Verdict::kUnknown) << answer.Words();
}

/// A quarter of a turn: what a scale off its axis shows there is a line and a small bend, too.
TEST(EncoderDominant, AQuarterOfATurnLeavesOpenWhetherItIsOrderOne) {
  Noise noise_deg(0.004, 61);
  const Answer answer = Ask(ThereAndBackTwice(181, 0.5, [&](double r_deg, int) {
    return r_deg + Sum({{1, 0.2, 135.0}}, r_deg - 45.0) + 0.05 * std::cos(24.0 * r_deg * units::deg) + noise_deg();
  }));
  EXPECT_EQ(answer.run.diagnosis.verdict, Verdict::kTie) << answer.Words();
  const auto& notes = answer.run.diagnosis.notes;
  const auto says_it = [](const std::string& note) { return note.find("once per turn (eccentricity) of 0.2") != std::string::npos; };
  EXPECT_TRUE(std::ranges::any_of(notes, says_it)) << answer.Words();
}

/// A place that is dirty, a fifth of a turn wide: the other targets lie on the orders that are there.
TEST(EncoderDominant, AWornPlaceLeavesTheOrdersBesideIt) {
  for (const unsigned seed : Seeds({51u, 52u, 53u})) {
    Noise noise_deg(0.002, seed);
    const Answer answer = Ask(ThereAndBackTwice(121, 3.0, [&](double r_deg, int direction) {
      const double dirt_deg = 0.03 * std::exp(-0.5 * std::pow((r_deg - 180.0) / 20.0, 2));
      return r_deg + Sum({{1, 0.05, 327.0}, {4, 0.02, 270.0}}, r_deg) + dirt_deg + 0.01 * direction + noise_deg();
    }));
    EXPECT_NEAR(SizeOfOrder(answer, 1), 0.05, 0.004) << answer.Words();
    EXPECT_NEAR(SizeOfOrder(answer, 4), 0.02, 0.001) << answer.Words();
    EXPECT_NEAR(std::abs(answer.Value("backlash", "width")), 0.02, 0.001) << answer.Words();
  }
}

/// A scale in one pass and no clock is a scale, whatever part of a turn that is.
TEST(EncoderDominant, ASlopeOfASinglePassIsAScale) {
  for (const double range_deg : {60.0, 270.0, 400.0, 900.0}) {
    const Answer answer = Ask(OnePass(40, range_deg / 39.0, 0.0003, 31, [range_deg](double a_deg) { return 0.01 * a_deg / range_deg; }));
    EXPECT_TRUE(answer.Names("scale", 0.5)) << range_deg << answer.Words();
    EXPECT_NEAR(answer.Value("scale", "ratio"), 0.01 / range_deg, 0.1 * 0.01 / range_deg) << range_deg << answer.Words();
  }
}

/// A rack with a ripple and an arch in one pass that has no clock: nothing of it is a course in time.
TEST(EncoderDominant, OnePassWithoutAClockIsNoWalk) {
  const Answer answer = Ask(OnePass(76, 4.5, 0.005, 5, [](double a_deg) {
    return 0.3 * a_deg / 360.0 * (1.0 - 2.0 * a_deg / 360.0) + 0.02 * std::cos(9.0 * a_deg * units::deg);
  }));
  EXPECT_TRUE(answer.Names("scale")) << answer.Words();
  EXPECT_NEAR(SizeOfOrder(answer, 9), 0.02, 0.004) << answer.Words();
  EXPECT_THAT(answer.run.diagnosis.unknown.signature, testing::Not(testing::HasSubstr("function of time"))) << answer.Words();
}

/// An order and play that explain as much as each other are two causes, and no two names of one.
TEST(EncoderDominant, AnOrderAndPlayOfOneSizeAreBothThere) {
  Noise noise_deg(1e-4, 6);
  const Answer answer = Ask(ThereAndBackTwice(36, 10.0, [&](double a_deg, int direction) {
    return a_deg + 0.0035 * std::cos(a_deg * units::deg) + 0.00085 * std::cos(4.0 * a_deg * units::deg) + 0.0006 * direction + noise_deg();
  }));
  EXPECT_TRUE(answer.Names("periodic")) << answer.Words();
  EXPECT_TRUE(answer.Names("backlash")) << answer.Words();
  EXPECT_NEAR(std::abs(answer.Value("backlash", "width")), 0.0012, 1e-4) << answer.Words();
  EXPECT_FALSE(HasUnmodelled(answer.run.diagnosis)) << answer.Words();
}

/// The worm beside a slope, as stops that have no clock.
TEST(EncoderDominant, AnOrderBesideASlopeIsAskedAgain) {
  for (const unsigned seed : Seeds({1u, 2u, 3u})) {
    Noise noise_deg(0.0002, seed);
    Record record{"stops"};
    for (int k = 0; k < 900; ++k) {
      const double r_deg = 15.0 * k / 900.0;
      record.Add(k, r_deg, r_deg + Sum({{144, 0.0039, 293.0}, {288, 0.0011, 270.0}}, r_deg) - 0.00053 * r_deg + noise_deg(), 1, 0);
      record.readings.back().extra[kClockColumn] = kNoClock;
    }
    const Answer answer = Ask(record);
    EXPECT_NEAR(SizeOfOrder(answer, 144), 0.0039, 0.0001) << answer.Words();
    EXPECT_NEAR(SizeOfOrder(answer, 288), 0.0011, 0.0001) << answer.Words();
  }
}

/// The worm of a mount, seen over a thirtieth of a turn beside a drift: orders next to each other are hardly told apart.
TEST(EncoderDominant, AnOrderOfAPartOfATurnIsOneAndTheRightOne) {
  for (const unsigned seed : Seeds({22u, 23u, 24u})) {
    Noise noise_deg(0.0002, seed);
    Record record;
    for (int k = 0; k < 500; ++k) {
      const double t_s = 6.0 * k, r_deg = 41.2 + 15.041 / 3600.0 * t_s;
      record.Add(t_s, r_deg, r_deg + Sum({{144, 0.00167, 20.0}, {288, 0.0007, 200.0}}, r_deg) - 0.0042 / 3600.0 * t_s + noise_deg(), 1, 0);
    }
    const Answer answer = Ask(record);
    EXPECT_NEAR(SizeOfOrder(answer, 144), 0.00167, 0.00006) << answer.Words();
    const auto is_order = [](const Cause& cause) { return cause.effect == "periodic" && cause.probability >= 0.5; };
    EXPECT_EQ(std::ranges::count_if(answer.run.diagnosis.causes, is_order), 2) << answer.Words();
  }
}

TEST(EncoderDominant, CoarseStepsThatEveryPassRepeatsAreNoCause) {
  constexpr double kStep_deg = 360.0 / 4096.0, kPrint_deg = 1e-4;
  const Answer answer = Ask(ThereAndBackTwice(180, 2.0, [&](double r_deg, int) {
    return std::round(std::round((r_deg + 0.137) / kStep_deg) * kStep_deg / kPrint_deg) * kPrint_deg;
  }));
  EXPECT_EQ(answer.run.diagnosis.verdict, Verdict::kNone) << answer.Words();
}

/// The place at which the shaft turns is read twice, the second time with the device still on the old side.
TEST(EncoderDominant, PlayIsFoundWhereTheTurningPointIsReadTwice) {
  Noise noise_deg(0.0005, 21);
  Record record{"stops"};
  for (int k = 0; k < 4 * 60; ++k) {
    const int pass = k / 60, at = k % 60, direction = pass % 2 == 0 ? 1 : -1, side = pass > 0 && at == 0 ? -direction : direction;
    const double r_deg = 5.0 * (direction > 0 ? at : 59 - at);
    record.Add(60.0 * k, r_deg, r_deg * 1.0001 + 0.00003 * k - 0.006 * side + noise_deg(), direction, pass);
  }
  const Answer answer = Ask(record);
  ExpectFound(answer, {{"backlash", "width", 0.012, 0.001}});
}

TEST(Repeats, PlacesAreTargetsOrBinsAndOnePassHasNone) {
  Eigen::VectorXd there_and_back(40), once = Eigen::VectorXd::LinSpaced(40, 0.0, 6.0);
  for (int k = 0; k < 40; ++k) there_and_back[k] = 0.1 * (k < 20 ? k : 39 - k);
  const std::vector<int> one(40, 0);
  EXPECT_TRUE(PlacesOf(once, one).empty());
  const std::vector<int> place = PlacesOf(there_and_back, one);
  ASSERT_EQ(place.size(), 40u);
  EXPECT_EQ(place[3], place[36]);
  EXPECT_NE(place[3], place[4]);
  std::vector<int> two(40, 0);
  std::fill(two.begin() + 20, two.end(), 1);
  EXPECT_TRUE(PlacesOf(there_and_back, two).empty()) << "another mounting is another place";
}

TEST(Repeats, WhatIsTheSameAtEveryVisitIsNotCounted) {
  std::vector<int> place;
  Eigen::VectorXd same(40), opposite(40);
  for (int k = 0; k < 40; ++k) {
    place.push_back(k < 20 ? k : 39 - k);
    same[k] = std::cos(place.back());
    opposite[k] = k < 20 ? 1.0 : -1.0;
  }
  EXPECT_NEAR(PowerNotRepeating(place, same), 0.0, 1e-12);
  // Every reading differs by one from the mean of its place; 39 visits of 20 places, the two at the turn being one.
  EXPECT_NEAR(PowerNotRepeating(place, opposite), 40.0 * 39.0 / 19.0, 1e-9);
}

TEST(SteadyCourse, SmoothsNoiseAndNeitherCornersNorAMotionWithoutNoise) {
  constexpr int kReadings = 1000;
  Noise noise(0.05, 3);
  model::Course course;
  course.reading.resize(kReadings);
  course.setup.assign(kReadings, 0);
  course.pass.assign(kReadings, 0);
  course.time_s = Eigen::VectorXd::LinSpaced(kReadings, 0.0, 0.001 * (kReadings - 1));
  const Eigen::ArrayXd t = course.time_s;
  const Eigen::VectorXd true_deg = 200.0 * (t - 0.5).abs(), noisy_deg = true_deg + true_deg.unaryExpr([&](double) { return noise(); });
  EXPECT_FALSE(model::SteadyCourseOf(course, true_deg).is_smoothed);
  const model::SteadyCourse steady = model::SteadyCourseOf(course, noisy_deg);
  ASSERT_TRUE(steady.is_smoothed);
  const Eigen::ArrayXd speed_deg_s = (t < 0.5).select(Eigen::ArrayXd::Constant(kReadings, -200.0), 200.0);
  const auto rms = [](const Eigen::ArrayXd& x) { return std::sqrt(x.square().mean()); };
  EXPECT_LT(rms((steady.rate.array() - speed_deg_s).segment(40, 400)), 0.02 * 200.0);
  EXPECT_GT(rms((model::RateOfChange(course, noisy_deg).array() - speed_deg_s).segment(40, 400)), 0.1 * 200.0);
  EXPECT_LT((steady.values - true_deg).segment(480, 40).cwiseAbs().maxCoeff(), 5.0 * 0.05) << "the corner";
}

TEST(RateOfChange, IsExactForAParabolaWithUnevenStepsAlsoWhereItTurnsBack) {
  model::Course course;
  Eigen::VectorXd t(9), y(9), slope(9);
  t << 0.0, 0.1, 0.25, 0.3, 0.4, 0.55, 0.6, 0.7, 5.0;
  for (int k = 0; k < 9; ++k) {
    course.reading.push_back(k);
    course.setup.push_back(0);
    course.pass.push_back(t[k] < 0.35 ? 0 : 1);
    y[k] = std::pow(t[k] - 0.35, 2);
    slope[k] = 2.0 * (t[k] - 0.35);
  }
  course.time_s = t;
  const Eigen::VectorXd rate = model::RateOfChange(course, y);
  EXPECT_NEAR((rate - slope).head(8).cwiseAbs().maxCoeff(), 0.0, 1e-12);
  EXPECT_EQ(rate[8], 0.0) << "after a pause there is no neighbour";
}

}  // namespace
}  // namespace twinbench::diagnose::encoder
