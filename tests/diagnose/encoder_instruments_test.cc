#include "tests/diagnose/encoder_record.h"

namespace twinbench::diagnose::encoder {
namespace {

using namespace lab;

// Instruments as they are found in laboratories, by closed forms that share nothing with the twin or the engine.

constexpr double kRad = units::deg;

/// A follower with play of 0.07 deg on a shaft that goes to and fro four times in even steps.
Record Played(double step_deg, unsigned seed) {
  constexpr double kWidth_deg = 0.07;
  Noise noise_deg(0.01 * kWidth_deg, seed);
  const int steps = 40 + 3 * static_cast<int>(kWidth_deg / step_deg);
  double follower_deg = 3.0 + 0.15 * kWidth_deg;
  return Listed({3.0 + step_deg, step_deg, steps, 4, 0.02}, [&](const Place& at) {
    follower_deg = std::clamp(follower_deg, at.deg - 0.5 * kWidth_deg, at.deg + 0.5 * kWidth_deg);
    return follower_deg + noise_deg() - 5.0;
  });
}

/// Resolvers whose signals are cut off and have every other fault as well, by the closed form of what they show.
struct FaultyResolver {
  double level, zero_deg, offset_sin = 0.0, offset_cos = 0.0, mismatch = 0.0, lead_deg = 0.0;

  double Shows_deg(double shaft_deg) const {
    const double p = (shaft_deg - zero_deg) * kRad;
    const double sine = (1.0 + mismatch) * std::sin(p + lead_deg * kRad) + offset_sin;
    const double cosine = std::cos(p) + offset_cos;
    const double shown_deg =
        zero_deg + std::atan2(std::clamp(sine, -level, level), std::clamp(cosine, -level, level)) / kRad;
    return shown_deg + 360.0 * std::round((shaft_deg - shown_deg) / 360.0);
  }
};

Rows InstrumentRows() {
  Rows rows;
  for (const double readings : {2.3, 7.7, 31.0, 150.0}) {
    rows.push_back({fmt::format("PlayIsPlayHoweverManyReadingsTheGapIsCrossedIn_{:.0f}", readings),
                    [=](unsigned seed) { return Played(0.07 / readings, seed); },
                    {Named("backlash"), Size("backlash", "width", 0.07, 0.002), NotNamed({"hysteresis", "slip"}),
                     kSilentAgain},
                    {11}});
  }
  for (const double tau_s : {150.0, 600.0}) {
    const auto warming = [=](const Place& at) { return 0.03 * (1.0 - std::exp(-at.t_s / tau_s)); };
    rows.push_back(
        {fmt::format("AWarmUpIsADriftThatSettlesAndNoHysteresis_{}", tau_s),
         [=](unsigned seed) { return Stops(0.0015, 0.0, seed, warming); },
         {Named("drift"), Size("drift", "warm_up", tau_s, 0.15 * tau_s), NotNamed({"hysteresis"}), kSilentAgain},
         {21}});
  }
  unsigned seed = 30;
  for (const double step_deg : {0.01, 360.0 / 4096.0}) {
    for (const double noise_in_steps : {0.0, 0.1, 0.3, 1.0}) {
      rows.push_back({fmt::format("RoundedReadingsOfAGoodDeviceRaiseNoAlarm_{}", ++seed),
                      [=](unsigned s) {
                        return Stops(noise_in_steps * step_deg, step_deg, s, [](const Place&) { return 0.0; });
                      },
                      {Is(Verdict::kNone)},
                      {seed}});
    }
  }
  for (const double level : {0.45, 0.86}) {
    rows.push_back(
        {fmt::format("AResolverThatIsClippedAndReadLateIsBoth_{:.0f}", 100.0 * level),
         [=](unsigned s) {
           const Swing swing{900.0, 46.0};
           const FaultyResolver resolver{level, 31.0};
           return Swung(swing, 0.037, 69.0, 0.083, 0.01, s,
                        [&](double t_s) { return resolver.Shows_deg(swing.At(t_s - 0.023)); });
         },
         {Found("signal_clipping", "level", level, 2.5e-4), Found("latency", "delay", 0.023, 5e-5), kSilentAgain},
         {7}});
  }
  seed = 100;
  for (const double level : {0.3, 0.5, 0.7, 0.95}) {
    rows.push_back(
        {fmt::format("AResolverThatIsClippedHasAllItsOtherFaultsAtOnceToo_{:.0f}", 100.0 * level),
         [=](unsigned s) {
           const Swing swing{1100.0, 52.0};
           const FaultyResolver resolver{level, 23.0, 0.06, -0.045, 0.05, 3.0};
           return Swung(swing, 0.029, 78.0, 0.081, 0.01, s,
                        [&](double t_s) { return resolver.Shows_deg(swing.At(t_s - 0.034)); });
         },
         {Found("signal_clipping", "level", level, 3e-3), Found("signal_clipping", "zero", 23.0, 0.1),
          Found("signal_offset", "offset_sin", 0.06, 3e-3), Found("signal_offset", "offset_cos", -0.045, 3e-3),
          Found("amplitude_mismatch", "ratio", 0.05, 3e-3),
          Found("quadrature_error", "angle", 1e3 * 3.0 * kRad, 3.0), Found("latency", "delay", 0.034, 1e-3),
          kSilentAgain},
         {++seed}});
  }
  rows.push_back({"ATouchThatGoesAwayIsNoSlip",
                  [](unsigned s) {
                    return Stops(0.0015, 0.0, s, [](const Place& at) {
                      if (at.t_s < 1200.0) return 0.0;
                      return at.t_s < 1260.0 ? 0.03 : 0.03 * std::exp(-(at.t_s - 1260.0) / 90.0);
                    });
                  },
                  {Is(Verdict::kUnknown), NoneFrom(0.5)},
                  {22}});
  rows.push_back({"AnErrorBeyondTheStepIsFoundInRoundedReadings",
                  [](unsigned s) {
                    return Stops(0.0, 360.0 / 16384.0, s, Of({{1, 0.2, 0.5 / kRad}, {4, 0.06, 0.0}}));
                  },
                  {Size("eccentricity", "amplitude", 0.2, 0.004), Size("periodic", "amplitude", 0.06, 0.004)},
                  {40}});
  rows.push_back({"AMagneticEncoderMayHaveManyOrdersAndNoLineBetweenThem",
                  [](unsigned s) {
                    const Swing swing{720.0, 60.0};
                    return Swung(swing, 0.011, 60.0, 0.05, 0.02, s, [&](double t_s) {
                      const double a = swing.At(t_s) * kRad;
                      return swing.At(t_s) + 0.8 * std::cos(a + 1.0) + 0.35 * std::cos(2.0 * a) +
                             0.12 * std::cos(3.0 * a - 2.0) + 0.21 * std::cos(4.0 * a + 0.4) +
                             0.08 * std::cos(50.0 * a + 0.2);
                    });
                  },
                  {[](const Answer& a) {
                     std::multiset<double> orders;
                     for (const Cause& cause : a.run.diagnosis.causes) {
                       const auto order = std::ranges::find(cause.parameters, "order", &ParameterEstimate::name);
                       if (cause.effect == "periodic" && order != cause.parameters.end())
                         orders.insert(order->value);
                     }
                     for (const double order : {3.0, 4.0, 50.0}) EXPECT_EQ(orders.count(order), 1u) << order;
                   },
                   IsNot(Verdict::kUnknown), Named("eccentricity", 0.0), Named("ellipticity", 0.0), kSilentAgain},
                  {50}});
  return rows;
}
INSTANTIATE_TEST_SUITE_P(Instruments, EncoderAnswer, testing::ValuesIn(InstrumentRows()), NameOfRow);

TEST(EncoderInstruments, OrdersThatTheReadingsDoNotTellApartGetNoSizes) {
  Record record = Stops(0.002, 0.0, 3, [](const Place& at) { return 0.02 * std::cos(20.0 * at.deg * kRad); });
  const auto sizes = [&] { return Diagnose(record.readings, record.Believed()).diagnosis.harmonics; };
  EXPECT_FALSE(sizes().empty());
  std::erase_if(record.readings, [](const Reading& r) { return r.reference_rad > 100.0 * kRad; });  // of a turn
  EXPECT_TRUE(sizes().empty());
}

}  // namespace
}  // namespace twinbench::diagnose::encoder
