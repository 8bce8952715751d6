#include <gmock/gmock.h>

#include "tests/diagnose/encoder_record.h"

namespace twinbench::diagnose::encoder {
namespace {

using namespace lab;

// Two series with a clock each, of which one runs fast: the shaft is where it was at another time.

constexpr Swing kSwing{500.0, 37.0};

/// What the device shows when the reference's clock says t.
template <class Shows>
Answer ReadBy(unsigned seed, Shows shows_deg) {
  return Ask(Swung(kSwing, 0.03, 130.0, 0.13, 0.004, seed, shows_deg));
}

TEST(EncoderClock, ThatRunsFastIsFoundWithItsRate) {
  for (const double ratio : {2e-5, -3e-4, 2e-3}) {
    const Answer answer = ReadBy(70, [ratio](double t_s) { return kSwing.At(t_s / (1.0 + ratio)); });
    EXPECT_TRUE(answer.Names("clock_rate")) << ratio << ": " << answer.Words();
    // A clock that shows t when t / (1 + ratio) has passed is late by ratio t to first order.
    EXPECT_NEAR(answer.Value("clock_rate", "ratio"), ratio,
                4.0 * answer.Uncertainty("clock_rate", "ratio") + ratio * ratio);
    EXPECT_EQ(answer.run.diagnosis.causes.size(), 1U) << ratio << ": " << answer.Words();
    EXPECT_EQ(answer.Again().verdict, Verdict::kNone) << ratio << ": " << answer.Words();
  }
}

TEST(EncoderClock, ThatRunsFastAndAReadingThatIsLateAreBoth) {
  ExpectFound(ReadBy(71, [](double t_s) { return kSwing.At(t_s * (1.0 - 4e-4) - 0.012); }),
              {{"clock_rate", "ratio", 4e-4}, {"latency", "delay", 0.012}});
}

double Speed_deg_s(double t_s) {
  return (kSwing.At(t_s + 1e-3) - kSwing.At(t_s - 1e-3)) / 2e-3;
}

TEST(EncoderClock, IsNotToBlameForAScaleOrForWhatTheSpeedDoes) {
  const Answer scale = ReadBy(72, [](double t_s) { return 1.0002 * kSwing.At(t_s); });
  EXPECT_TRUE(scale.Names("scale")) << scale.Words();
  EXPECT_FALSE(scale.Names("clock_rate", 0.1)) << scale.Words();
  const Answer resonance = ReadBy(73, [](double t_s) {
    const double v = Speed_deg_s(t_s), x = (std::abs(v) - 22.0) / 4.0;
    return kSwing.At(t_s) + std::copysign(0.05, v) / (1.0 + x * x);
  });
  EXPECT_FALSE(resonance.Names("clock_rate", 0.5)) << resonance.Words();
  const Answer growing = ReadBy(74, [](double t_s) {
    const double v = Speed_deg_s(t_s);
    return kSwing.At(t_s) + 3e-5 * v * std::abs(v) * t_s / 130.0;
  });
  EXPECT_FALSE(growing.Names("clock_rate", 0.5)) << growing.Words();
}

/// A plate on a servo over 10 deg at 1 Hz: late, and with a rest of its own that goes on from one reading to the next and is a
/// tenth of the variance.
TEST(EncoderMotion, OfAServoOverAPartOfATurnIsLateBesideARestThatWanders) {
  constexpr double kLate_s = 0.045, kMemory = 0.9, kRest_deg = 0.3;
  const Swing plate{10.0, 1.0, -5.0};
  for (const unsigned seed : Seeds({81U, 82U, 83U})) {
    Noise step(kRest_deg * std::sqrt(1.0 - kMemory * kMemory), seed);
    double rest_deg = 0.0;
    const Answer answer = Ask(Swung(plate, 0.01, 17.0, 0.0233, 0.01, seed, [&](double t_s) {
      rest_deg = kMemory * rest_deg + step();
      return plate.At(t_s - kLate_s) + rest_deg;
    }));
    EXPECT_TRUE(answer.Names("latency")) << seed << ": " << answer.Words();
    EXPECT_NEAR(answer.Value("latency", "delay"), kLate_s, 4.0 * answer.Uncertainty("latency", "delay")) << seed;
    EXPECT_LT(answer.Uncertainty("latency", "delay"), 0.006) << seed;
  }
}

/// Ever faster to and fro: at the end the delay is a third of a period, and the speed of the moment says nothing of how far it is
/// behind.
TEST(EncoderMotion, LateByAPartOfAPeriodIsALatencyAndAScale) {
  constexpr double kLate_s = 0.025, kGain = 0.79;
  const auto chirp_deg = [](double t_s) { return 1.45 * std::sin(2.0 * units::kPi * (2.0 * t_s + 1.5 * t_s * t_s)); };
  Noise noise_deg(0.02, 84);
  Record record;
  int direction = 1, pass = 0;
  for (double t_s = 0.03; t_s < 4.0; t_s += 0.0031) {
    const int now = chirp_deg(t_s + 1e-4) > chirp_deg(t_s - 1e-4) ? 1 : -1;
    pass += now == direction ? 0 : 1;
    direction = now;
    record.Add(t_s, chirp_deg(t_s), kGain * chirp_deg(t_s - kLate_s) + noise_deg(), direction, pass);
  }
  const Answer answer = Ask(record);
  SCOPED_TRACE(answer.Words());
  EXPECT_TRUE(answer.Names("latency"));
  EXPECT_TRUE(answer.Names("scale"));
  EXPECT_FALSE(answer.Names("hysteresis", 0.1) || answer.Names("backlash", 0.1));
  EXPECT_NEAR(answer.Value("latency", "delay"), kLate_s, 0.02 * kLate_s);
  EXPECT_NEAR(answer.Value("scale", "ratio"), kGain - 1.0, 0.02);
}

// Counters that lose counts, written down as they count.

/// There and back in motion, two turns and a bit, twice; what is lost from the reading before to this one.
template <class Lost>
Answer Counted(unsigned seed, Lost lost_deg) {
  const Swing swing{790.0, 80.0, 11.0};
  double last_deg = kNaN, lost = 0.0;
  return Ask(Swung(swing, 0.05, 160.0, 0.11, 0.003, seed, [&](double t_s) {
    const double at_deg = swing.At(t_s);
    if (std::isfinite(last_deg)) lost += lost_deg(t_s, last_deg, at_deg);
    last_deg = at_deg;
    return at_deg + lost;
  }));
}

void ExpectOneUnknown(const Answer& answer, const std::string& words) {
  EXPECT_EQ(answer.run.diagnosis.verdict, Verdict::kUnknown) << answer.Words();
  EXPECT_THAT(answer.run.diagnosis.unknown.signature, testing::HasSubstr(words)) << answer.Words();
  EXPECT_FALSE(answer.Names("slip", 0.01) || answer.Names("scale", 0.5)) << answer.Words();
  EXPECT_EQ(answer.Again().verdict, Verdict::kNone) << answer.Words();
}

double Whole(double angle_deg, double spot_deg) {
  return std::floor((angle_deg - spot_deg) / 360.0);
}

TEST(EncoderCounts, LostAtOneSpotInOneSenseAreOneUnknown) {
  const Answer answer = Counted(60, [](double, double from_deg, double to_deg) {
    return -0.02 * std::max(0.0, Whole(to_deg, 137.0) - Whole(from_deg, 137.0));
  });
  ExpectOneUnknown(answer, "lost counts, the same each time that 13");
}

TEST(EncoderCounts, ThatComeBackOnTheWayBackAreOneUnknown) {
  const Answer answer = Counted(61, [](double, double from_deg, double to_deg) {
    return -0.0125 * (Whole(to_deg, 0.0) - Whole(from_deg, 0.0));
  });
  ExpectOneUnknown(answer, "which come back");
}

TEST(EncoderCounts, OfATurnThatIsNotWholeAreNoScale) {
  const Answer answer = Counted(62, [](double, double from_deg, double to_deg) {
    return 0.03 * ((to_deg - from_deg) / 360.0 - (Whole(to_deg, 77.0) - Whole(from_deg, 77.0)));
  });
  ExpectOneUnknown(answer, "put right at 7");
}

/// Once, at the first reading from then on.
bool At(double event_s, double t_s) {
  return t_s >= event_s && t_s < event_s + 0.11 - 1e-9;
}

TEST(EncoderCounts, EqualStepsAreOneUnknownWithSeveralEvents) {
  const Answer answer = Counted(63, [](double t_s, double, double) {
    return At(31.0, t_s) || At(58.0, t_s) ? -0.022 : At(117.0, t_s) ? 0.022 : At(140.0, t_s) ? -0.044 : 0.0;
  });
  ExpectOneUnknown(answer, "4 steps of one size");
}

TEST(EncoderCounts, TwoStepsThatAreNotAlikeAreTwoSlips) {
  const Answer answer = Counted(64, [](double t_s, double, double) {
    return At(31.0, t_s) ? -0.05 : At(117.0, t_s) ? 0.033 : 0.0;
  });
  const auto& causes = answer.run.diagnosis.causes;
  EXPECT_EQ(std::ranges::count(causes, "slip", &Cause::effect), 2) << answer.Words();
  EXPECT_EQ(answer.Again().verdict, Verdict::kNone) << answer.Words();
}

// Devices that come to rest after their reference, in time, beside what goes by the way.

struct Rests {
  double left_deg, over_s;  // of a move when it has ended, and the time in which 63 % of it are gone
  double warm_up_deg;       // drift that settles in 300 s
};

/// 36 stops there and back twice, each read six times while it comes to rest.
Record ComesToRest(const Rests& rests, unsigned seed) {
  Noise noise(0.0015, seed);
  Record record{"stops"};
  double t_s = 0.0;
  for (int pass = 0; pass < 4; ++pass) {
    const int sense = pass % 2 == 0 ? 1 : -1;
    for (int k = 0; k < 36; ++k) {
      const double at_deg = 0.7 + 10.0 * (sense > 0 ? k : 35 - k);
      t_s += 3.0;
      for (int again = 0; again < 6; ++again) {
        const double now_s = t_s + 0.8 * again;
        const double error_deg = -sense * rests.left_deg * std::exp(-0.8 * again / rests.over_s) +
                                 rests.warm_up_deg * (1.0 - std::exp(-now_s / 300.0));
        record.Add(now_s, at_deg, at_deg + error_deg + noise(), sense, pass);
      }
      t_s += 4.0;
    }
  }
  return record;
}

TEST(EncoderSettling, IsNoHysteresis) {
  for (const double over_s : {0.6, 1.7}) {
    const Answer answer = Ask(ComesToRest({0.03, over_s, 0.0}, 120));
    ExpectFound(answer, {{"settling", "amplitude", 0.03}, {"settling", "time_constant", over_s}});
    EXPECT_EQ(answer.run.diagnosis.causes.size(), 1U) << over_s << ": " << answer.Words();
  }
}

TEST(EncoderSettling, IsFoundBesideAWarmUp) {
  const Answer answer = Ask(ComesToRest({0.02, 1.2, 0.025}, 121));
  ExpectFound(answer, {{"settling", "amplitude", 0.02}, {"drift", "warm_up", 300.0}});
  EXPECT_FALSE(answer.Names("hysteresis", 0.1)) << answer.Words();
}

// Tests of positioning as ISO 230-2 has them: targets that are no even way apart, approached from both sides again
// and again, an axis with a curve of its own and a reversal. A mm is written as a degree.

struct Axis {
  double length_mm, targets, curve_um, reversal_um, noise_um, warm_up_um;

  double Curve_um(double x_mm) const {
    const double u = x_mm / length_mm;
    return curve_um * (4.0 * u * (1.0 - 0.8 * u) + 0.13 * std::sin(10.7 * u + 1.0) + 0.07 * std::cos(27.0 * u));
  }
};

Record Positioned(const Axis& axis, int passes, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise_um(0.0, axis.noise_um);
  std::uniform_real_distribution<double> uneven(-0.15, 0.15);
  std::vector<double> targets_mm;
  for (int k = 0; k < axis.targets; ++k) targets_mm.push_back(axis.length_mm / axis.targets * (k + uneven(random)));
  Record record{"stops"};
  for (int pass = 0; pass < passes; ++pass) {
    const int sense = pass % 2 == 0 ? 1 : -1;
    for (std::size_t k = 0; k < targets_mm.size(); ++k) {
      const double x_mm = targets_mm[sense > 0 ? k : targets_mm.size() - 1 - k];
      const double t_s = 7.0 * static_cast<double>(record.readings.size());
      const double error_um = axis.Curve_um(x_mm) - 0.5 * sense * axis.reversal_um +
                              axis.warm_up_um * (1.0 - std::exp(-t_s / 400.0)) + noise_um(random);
      record.Add(t_s, x_mm, x_mm + 1e-3 * error_um, sense, pass);
    }
  }
  return record;
}

TEST(EncoderTargets, ACurveThatRepeatsAtEveryTargetHidesNoReversal) {
  unsigned seed = 80;
  for (const Axis& axis : {Axis{400.0, 21, 94.0, 25.0, 0.8, 0.0}, Axis{240.0, 12, 60.0, 9.0, 0.6, 0.0}}) {
    const Answer answer = Ask(Positioned(axis, 10, ++seed));
    ExpectFound(answer, {{"backlash", "width", 1e-3 * axis.reversal_um, 0.5e-3}});
    for (const char* needless : {"eccentricity", "ellipticity", "periodic", "signal_offset"})
      EXPECT_FALSE(answer.Names(needless, 0.1)) << answer.Words();
  }
}

TEST(EncoderTargets, AWarmUpBesideTheReversalIsADriftThatSettles) {
  const Answer answer = Ask(Positioned({400.0, 21, 94.0, 25.0, 0.8, 15.0}, 10, 90));
  ExpectFound(answer, {{"drift", "warm_up", 400.0}, {"backlash", "width", 25e-3}});
  EXPECT_FALSE(answer.Names("hysteresis", 0.1)) << answer.Words();
}

TEST(EncoderTargets, FewOrdersKeepTheirNames) {
  Record record{"stops"};
  Noise noise(0.001, 91);
  for (int pass = 0; pass < 4; ++pass) {
    const int sense = pass % 2 == 0 ? 1 : -1;
    for (int k = 0; k < 24; ++k) {
      const double at_deg = 15.0 * (sense > 0 ? k : 23 - k), a = at_deg * units::deg;
      const double error_deg = 0.03 * std::cos(a + 0.7) + 0.012 * std::cos(5.0 * a) - 0.006 * sense;
      record.Add(4.0 * static_cast<double>(record.readings.size()), at_deg, at_deg + error_deg + noise(),
                 sense, pass);
    }
  }
  const Answer answer = Ask(record);
  EXPECT_TRUE(answer.Find("eccentricity") && answer.Names("periodic") && answer.Names("backlash"))
      << answer.Words();
  EXPECT_EQ(answer.Again().verdict, Verdict::kNone) << answer.Words();
}

}  // namespace
}  // namespace twinbench::diagnose::encoder
