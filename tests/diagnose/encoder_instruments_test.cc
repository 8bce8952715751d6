#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "twin/benches/encoder_comparison/settings.h"
#include "twin/benches/names.h"
#include "twin/benches/registry.h"
#include "twin/core/units.h"
#include "twin/diagnose/diagnose.h"
#include "twin/diagnose/extend.h"

// Instruments as they are found in laboratories, by closed forms that share nothing with the twin or the engine.
namespace twinbench::diagnose::encoder {
namespace {

using units::deg;

constexpr double kRad = units::kPi / 180.0;

/// A comparison in the making, all in deg and s.
struct Record {
  std::string kind = "sweep";  // what the scenario says of it
  std::vector<Reading> readings;

  void Add(double time_s, double reference_deg, double measured_deg, int direction, int pass) {
    Reading r;
    r.reading = static_cast<int>(readings.size());
    r.time = Time(FromSeconds(time_s));
    r.pass = pass;
    r.direction = direction;
    r.position = r.reading;
    r.reference_rad = reference_deg * deg;
    r.measured_rad = measured_deg * deg;
    readings.push_back(r);
  }
  Scenario Believed() const {
    Scenario scenario;
    scenario.bench = kEncoderBench;
    EncoderOf(scenario).encoder_procedure.kind = kind;
    return scenario;
  }
};

struct Answer {
  DiagnosisRun run;
  Diagnosis again;  // of the same readings, with the file that was written

  const Cause* Find(const std::string& effect) const {
    const auto found = std::ranges::find(run.diagnosis.causes, effect, &Cause::effect);
    return found == run.diagnosis.causes.end() ? nullptr : &*found;
  }
  /// In deg, s or 1.
  double Value(const std::string& effect, const std::string& parameter) const {
    const Cause* const cause = Find(effect);
    if (!cause) return kNaN;
    const auto found = std::ranges::find(cause->parameters, parameter, &ParameterEstimate::name);
    return found == cause->parameters.end() ? kNaN : found->value / found->to_SI;
  }
  bool Names(const std::string& effect, double from = 0.8) const {
    const Cause* const cause = Find(effect);
    return cause && cause->probability >= from;
  }
  std::string Words() const {
    std::string words = VerdictName(run.diagnosis.verdict);
    for (const Cause& c : run.diagnosis.causes) words += fmt::format(" [{} {:.2f}]", c.effect, c.probability);
    return words + " " + run.diagnosis.unknown.signature + " | again: " + VerdictName(again.verdict) + " " +
           again.unknown.signature;
  }
};

Answer Ask(const Record& record) {
  DiagnoseOptions options;
  options.null_runs = 100;  // of what is far beyond any threshold
  Answer answer{Diagnose(record.readings, record.Believed(), options), {}};
  answer.again = Diagnose(record.readings, Extend(record.Believed(), answer.run, "test"), options).diagnosis;
  return answer;
}

/// To and fro, as a hand wheel is turned: there and back over `range_deg` in `period_s`.
struct Swing {
  double range_deg, period_s;
  double At(double t_s) const { return 0.5 * range_deg * (1.0 - std::cos(2.0 * units::kPi * t_s / period_s)); }
  int Direction(double t_s) const { return std::sin(2.0 * units::kPi * t_s / period_s) >= 0.0 ? 1 : -1; }
  int Pass(double t_s) const { return static_cast<int>(2.0 * t_s / period_s); }
};

/// Whole turns put back where the angle of two signals has none.
double Near(double angle_deg, double of_deg) {
  return angle_deg + 360.0 * std::round((of_deg - angle_deg) / 360.0);
}

struct Resolver {
  double level, zero_deg, delay_s;

  double Shows_deg(const Swing& swing, double t_s) const {
    const double at_deg = swing.At(t_s - delay_s) - zero_deg, p = at_deg * kRad;
    const double sine = std::clamp(std::sin(p), -level, level), cosine = std::clamp(std::cos(p), -level, level);
    return zero_deg + Near(std::atan2(sine, cosine) / kRad, at_deg);
  }
};

Record Resolved(const Resolver& resolver, unsigned seed) {
  const Swing swing{900.0, 46.0};
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise_deg(0.0, 0.01);
  Record record;
  for (double t_s = 0.037; t_s < 69.0; t_s += 0.083)
    record.Add(t_s, swing.At(t_s), resolver.Shows_deg(swing, t_s) + noise_deg(random), swing.Direction(t_s),
               swing.Pass(t_s));
  return record;
}

TEST(EncoderInstruments, AResolverThatIsClippedAndReadLateIsBoth) {
  for (const double level : {0.45, 0.86}) {
    const Answer answer = Ask(Resolved({.level = level, .zero_deg = 31.0, .delay_s = 0.023}, 7));
    EXPECT_TRUE(answer.Names("signal_clipping") && answer.Names("latency")) << level << ": " << answer.Words();
    EXPECT_NEAR(answer.Value("signal_clipping", "level"), level, 1e-3);
    EXPECT_NEAR(answer.Value("latency", "delay"), 0.023, 2e-4);
    EXPECT_EQ(answer.again.verdict, Verdict::kNone) << level << ": " << answer.Words();
  }
}

/// A follower with play on a shaft that goes to and fro in even steps.
Record Played(double width_deg, double step_deg, int turns_back, double first_share, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise_deg(0.0, 0.01 * width_deg);
  Record record;
  record.kind = "stops";
  const int steps = 40 + 3 * static_cast<int>(width_deg / step_deg);
  double shaft_deg = 3.0, follower_deg = shaft_deg + 0.5 * first_share * width_deg;
  for (int pass = 0; pass <= turns_back; ++pass) {
    for (int k = 0; k < steps; ++k) {
      shaft_deg += pass % 2 == 0 ? step_deg : -step_deg;
      const double ahead_deg = shaft_deg + 0.5 * width_deg, behind_deg = shaft_deg - 0.5 * width_deg;
      if (follower_deg > ahead_deg) follower_deg = ahead_deg;
      if (follower_deg < behind_deg) follower_deg = behind_deg;
      record.Add(0.02 * static_cast<double>(record.readings.size()), shaft_deg,
                 follower_deg + noise_deg(random) - 5.0, pass % 2 == 0 ? 1 : -1, pass);
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
    EXPECT_EQ(answer.again.verdict, Verdict::kNone) << readings << ": " << answer.Words();
  }
}

/// Stops of 6 deg, two turns there and back twice; the error is a function of time and angle.
template <class Error>
Record Stops(double noise_deg, double step_deg, unsigned seed, Error error_deg) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0.0, noise_deg);
  Record record;
  record.kind = "stops";
  for (int pass = 0; pass < 4; ++pass) {
    for (int k = 0; k < 120; ++k) {
      const double reference_deg = 0.4 + 6.0 * (pass % 2 == 0 ? k : 119 - k);
      const double time_s = 5.0 * static_cast<double>(record.readings.size());
      double measured_deg = reference_deg + error_deg(time_s, reference_deg) + noise(random);
      if (step_deg > 0.0) measured_deg = step_deg * std::round(measured_deg / step_deg);
      record.Add(time_s, reference_deg, measured_deg, pass % 2 == 0 ? 1 : -1, pass);
    }
  }
  return record;
}

TEST(EncoderInstruments, AWarmUpIsADriftThatSettlesAndNoHysteresis) {
  for (const double tau_s : {150.0, 600.0}) {
    const auto warming = [tau_s](double t_s, double) { return 0.03 * (1.0 - std::exp(-t_s / tau_s)); };
    const Answer answer = Ask(Stops(0.0015, 0.0, 21, warming));
    EXPECT_TRUE(answer.Names("drift")) << tau_s << ": " << answer.Words();
    EXPECT_NEAR(answer.Value("drift", "warm_up"), tau_s, 0.15 * tau_s);
    EXPECT_FALSE(answer.Names("hysteresis", 0.1)) << answer.Words();
    EXPECT_EQ(answer.again.verdict, Verdict::kNone) << answer.Words();
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

TEST(EncoderInstruments, AMagneticEncoderMayHaveManyOrders) {
  const Swing swing{720.0, 60.0};
  std::mt19937_64 random(50);
  std::normal_distribution<double> noise_deg(0.0, 0.02);
  Record record;
  for (double t_s = 0.011; t_s < 60.0; t_s += 0.05) {
    const double a = swing.At(t_s) * kRad;
    const double error_deg = 0.8 * std::cos(a + 1.0) + 0.35 * std::cos(2.0 * a) + 0.12 * std::cos(3.0 * a - 2.0) +
                             0.21 * std::cos(4.0 * a + 0.4) + 0.08 * std::cos(50.0 * a + 0.2);
    record.Add(t_s, swing.At(t_s), swing.At(t_s) + error_deg + noise_deg(random), swing.Direction(t_s),
               swing.Pass(t_s));
  }
  const Answer answer = Ask(record);
  std::vector<double> orders;
  for (const Cause& cause : answer.run.diagnosis.causes) {
    if (cause.effect != "periodic") continue;
    for (const ParameterEstimate& p : cause.parameters) {
      if (p.name == "order") orders.push_back(p.value);
    }
  }
  for (const double order : {3.0, 4.0, 50.0}) EXPECT_EQ(std::ranges::count(orders, order), 1) << answer.Words();
  EXPECT_TRUE(answer.Find("eccentricity") && answer.Find("ellipticity")) << answer.Words();
  EXPECT_EQ(answer.again.verdict, Verdict::kNone) << answer.Words();
}

}  // namespace
}  // namespace twinbench::diagnose::encoder
