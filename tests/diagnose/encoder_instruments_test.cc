#include <gtest/gtest.h>

#include "tests/diagnose/encoder_record.h"

namespace twinbench::diagnose::encoder {
namespace {

using namespace lab;

// Instruments as they are found in laboratories, by closed forms that share nothing with the twin or the engine.

constexpr double kRad = units::kPi / 180.0;

/// A follower with play on a shaft that goes to and fro in even steps.
Record Played(double width_deg, double step_deg, int turns_back, double first_share, unsigned seed) {
  Noise noise_deg(0.01 * width_deg, seed);
  Record record{"stops"};
  const int steps = 40 + 3 * static_cast<int>(width_deg / step_deg);
  double shaft_deg = 3.0, follower_deg = shaft_deg + 0.5 * first_share * width_deg;
  for (int pass = 0; pass <= turns_back; ++pass) {
    for (int k = 0; k < steps; ++k) {
      shaft_deg += pass % 2 == 0 ? step_deg : -step_deg;
      const double ahead_deg = shaft_deg + 0.5 * width_deg, behind_deg = shaft_deg - 0.5 * width_deg;
      if (follower_deg > ahead_deg) follower_deg = ahead_deg;
      if (follower_deg < behind_deg) follower_deg = behind_deg;
      record.Add(0.02 * static_cast<double>(record.readings.size()), shaft_deg,
                 follower_deg + noise_deg() - 5.0, pass % 2 == 0 ? 1 : -1, pass);
    }
  }
  return record;
}

TEST(EncoderInstruments, PlayIsPlayHoweverManyReadingsTheGapIsCrossedIn) {
  for (const double readings : {2.3, 7.7, 31.0, 150.0}) {
    const Answer answer = Ask(Played(0.07, 0.07 / readings, 3, 0.3, 11));
    EXPECT_TRUE(answer.Names("backlash")) << readings << ": " << answer.Words();
    EXPECT_NEAR(answer.Value("backlash", "width"), 0.07, 0.002) << readings;
    EXPECT_FALSE(answer.Names("hysteresis", 0.1) || answer.Names("slip", 0.1)) << readings;
    EXPECT_EQ(answer.Again().verdict, Verdict::kNone) << readings << ": " << answer.Words();
  }
}

TEST(EncoderInstruments, AWarmUpIsADriftThatSettlesAndNoHysteresis) {
  for (const double tau_s : {150.0, 600.0}) {
    const auto warming = [tau_s](double t_s, double) { return 0.03 * (1.0 - std::exp(-t_s / tau_s)); };
    const Answer answer = Ask(Stops(0.0015, 0.0, 21, warming));
    EXPECT_TRUE(answer.Names("drift")) << tau_s << ": " << answer.Words();
    EXPECT_NEAR(answer.Value("drift", "warm_up"), tau_s, 0.15 * tau_s);
    EXPECT_FALSE(answer.Names("hysteresis", 0.1)) << answer.Words();
    EXPECT_EQ(answer.Again().verdict, Verdict::kNone) << answer.Words();
  }
}

TEST(EncoderInstruments, ATouchThatGoesAwayIsNoSlip) {
  const auto touched = [](double t_s, double) {
    if (t_s < 1200.0) return 0.0;
    return t_s < 1260.0 ? 0.03 : 0.03 * std::exp(-(t_s - 1260.0) / 90.0);
  };
  const Answer answer = Ask(Stops(0.0015, 0.0, 22, touched));
  EXPECT_EQ(answer.run.diagnosis.verdict, Verdict::kUnknown) << answer.Words();
  for (const Cause& cause : answer.run.diagnosis.causes) EXPECT_LT(cause.probability, 0.5) << cause.effect;
}

TEST(EncoderInstruments, RoundedReadingsOfAGoodDeviceRaiseNoAlarm) {
  const auto nothing = [](double, double) { return 0.0; };
  unsigned seed = 30;
  for (const double step_deg : {0.01, 360.0 / 4096.0}) {
    for (const double noise_in_steps : {0.0, 0.1, 0.3, 1.0}) {
      const Diagnosis d = Ask(Stops(noise_in_steps * step_deg, step_deg, ++seed, nothing)).run.diagnosis;
      EXPECT_EQ(d.verdict, Verdict::kNone) << step_deg << " " << noise_in_steps << " " << d.unknown.signature
                                           << (d.causes.empty() ? "" : d.causes.front().effect);
    }
  }
}

TEST(EncoderInstruments, AnErrorBeyondTheStepIsFoundInRoundedReadings) {
  const double step_deg = 360.0 / 16384.0;
  const Answer answer = Ask(Stops(0.0, step_deg, 40, [](double, double a_deg) {
    return 0.2 * std::cos(a_deg * kRad + 0.5) + 0.06 * std::cos(4.0 * a_deg * kRad);
  }));
  EXPECT_NEAR(answer.Value("eccentricity", "amplitude"), 0.2, 0.004) << answer.Words();
  EXPECT_NEAR(answer.Value("periodic", "amplitude"), 0.06, 0.004) << answer.Words();
}

TEST(EncoderInstruments, AMagneticEncoderMayHaveManyOrdersAndNoLineBetweenThem) {
  const Swing swing{720.0, 60.0};
  const Answer answer = Ask(Swung(swing, 0.011, 60.0, 0.05, 0.02, 50, [&](double t_s) {
    const double a = swing.At(t_s) * kRad;
    return swing.At(t_s) + 0.8 * std::cos(a + 1.0) + 0.35 * std::cos(2.0 * a) + 0.12 * std::cos(3.0 * a - 2.0) +
           0.21 * std::cos(4.0 * a + 0.4) + 0.08 * std::cos(50.0 * a + 0.2);
  }));
  EXPECT_NE(answer.run.diagnosis.verdict, Verdict::kUnknown) << answer.Words();
  std::vector<double> orders;
  for (const Cause& cause : answer.run.diagnosis.causes) {
    if (cause.effect != "periodic") continue;
    for (const ParameterEstimate& p : cause.parameters) {
      if (p.name == "order") orders.push_back(p.value);
    }
  }
  for (const double order : {3.0, 4.0, 50.0}) EXPECT_EQ(std::ranges::count(orders, order), 1) << answer.Words();
  EXPECT_TRUE(answer.Find("eccentricity") && answer.Find("ellipticity")) << answer.Words();
  EXPECT_EQ(answer.Again().verdict, Verdict::kNone) << answer.Words();
}

TEST(EncoderInstruments, OrdersThatTheReadingsDoNotTellApartGetNoSizes) {
  Record record = Stops(0.002, 0.0, 3, [](double, double a_deg) { return 0.02 * std::cos(20.0 * a_deg * kRad); });
  const auto sizes = [&] { return Diagnose(record.readings, record.Believed()).diagnosis.harmonics; };
  EXPECT_FALSE(sizes().empty());
  std::erase_if(record.readings, [](const Reading& r) { return r.reference_rad > 100.0 * kRad; });  // of a turn
  EXPECT_TRUE(sizes().empty());
}

// Resolvers whose signals are cut off and have every other fault as well, by the closed form of what they show.

struct FaultyResolver {
  double level, zero_deg, offset_sin, offset_cos, mismatch, lead_deg;

  double Shows_deg(double shaft_deg) const {
    const double p = (shaft_deg - zero_deg) * kRad;
    const double sine = (1.0 + mismatch) * std::sin(p + lead_deg * kRad) + offset_sin;
    const double cosine = std::cos(p) + offset_cos;
    const double shown_deg =
        zero_deg + std::atan2(std::clamp(sine, -level, level), std::clamp(cosine, -level, level)) / kRad;
    return shown_deg + 360.0 * std::round((shaft_deg - shown_deg) / 360.0);
  }
};

TEST(EncoderResolver, ThatIsClippedAndReadLateIsBoth) {
  const Swing swing{900.0, 46.0};
  for (const double level : {0.45, 0.86}) {
    const FaultyResolver resolver{level, 31.0, 0.0, 0.0, 0.0, 0.0};
    ExpectFound(Ask(Swung(swing, 0.037, 69.0, 0.083, 0.01, 7,
                          [&](double t_s) { return resolver.Shows_deg(swing.At(t_s - 0.023)); })),
                {{"signal_clipping", "level", level, 2.5e-4}, {"latency", "delay", 0.023, 5e-5}});
  }
}

TEST(EncoderResolver, ThatIsClippedHasAllItsOtherFaultsAtOnceToo) {
  const Swing swing{1100.0, 52.0};
  unsigned seed = 100;
  for (const double level : {0.3, 0.5, 0.7, 0.95}) {
    const FaultyResolver resolver{level, 23.0, 0.06, -0.045, 0.05, 3.0};
    ExpectFound(Ask(Swung(swing, 0.029, 78.0, 0.081, 0.01, ++seed,
                          [&](double t_s) { return resolver.Shows_deg(swing.At(t_s - 0.034)); })),
                {{"signal_clipping", "level", level, 3e-3},
                 {"signal_clipping", "zero", 23.0, 0.1},
                 {"signal_offset", "offset_sin", 0.06, 3e-3},
                 {"signal_offset", "offset_cos", -0.045, 3e-3},
                 {"amplitude_mismatch", "ratio", 0.05, 3e-3},
                 {"quadrature_error", "angle", 1e3 * 3.0 * kRad, 3.0},
                 {"latency", "delay", 0.034, 1e-3}});
  }
}

}  // namespace
}  // namespace twinbench::diagnose::encoder
