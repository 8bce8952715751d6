#include <random>

#include "tests/diagnose/encoder_record.h"
#include "tests/diagnose/ring_run.h"
#include "twin/benches/encoder_comparison/diagnosis/few_counts.h"
#include "twin/benches/encoder_comparison/diagnosis/large_cause.h"
#include "twin/benches/encoder_comparison/diagnosis/memory.h"
#include "twin/benches/encoder_comparison/diagnosis/told.h"

namespace twinbench::diagnose::encoder {
namespace {

using namespace lab;

namespace servo {

/// An axis that goes to and fro the faster the longer, and a device that is behind its command.
double Chirp_deg(double t_s) { return 17.0 * std::sin(2.0 * units::kPi * (0.2 * t_s + 0.03 * t_s * t_s)); }

/// x' = (command - x) / lag in steps of 0.1 ms; it has been in motion for some seconds.
Record Followed(double lag_s, double gain, unsigned seed) {
  Noise noise_deg(0.02, seed);
  double at_deg = 0.0, at_s = -3.0;
  return Chirped(0.0, 14.0, 0.018, Chirp_deg, [&](double t_s) {
    for (; at_s <= t_s; at_s += 1e-4) at_deg += (Chirp_deg(at_s) - at_deg) * 1e-4 / lag_s;
    return gain * at_deg + noise_deg();
  });
}

/// A servo between two places, three means of each rest: the first began on the way, and where it comes to rest is
/// one count of 0.00307 deg or the next.
Record Rests() {
  const std::array counts = {162, -162, 162, -163, 162, -163, 162, -162};
  const std::array began = {0.145, 0.122, 0.165};
  Record record{"stops"};
  for (int rest = 0; rest < 8; ++rest) {
    for (int k = 0; k < 3; ++k) {
      const double at = counts[static_cast<std::size_t>(rest)],
                   shown = at - (rest == 0 ? began[static_cast<std::size_t>(k)] : 0.0);
      record.Add(1.25 * rest + 0.277 * k, at > 0.0 ? 0.5 : -0.5, 0.00307 * shown,
                 rest % 2 == 0 && rest > 0 ? 1 : -1, std::max(0, rest - 1));
    }
  }
  return record;
}

Rows ServoRows() {
  Rows rows;
  for (const double lag_s : {0.11, 0.19}) {
    rows.push_back({fmt::format("AServoThatFollowsWithALagOfFirstOrderHasATimeConstant_{:.0f}", 1e3 * lag_s),
                    [=](unsigned seed) { return Followed(lag_s, 1.0, seed); },
                    // Straight lines from reading to reading: the square of 18 ms beside the period.
                    {Named("latency"), Size("latency", "time_constant", lag_s, 0.02 * lag_s),
                     Size("latency", "delay", 0.0, 0.0), NotNamed({"backlash", "hysteresis"}, 0.8)},
                    {91}});
  }
  rows.push_back({"AServoThatFallsShortAsWellHasAScale",
                  [](unsigned seed) { return Followed(0.15, 0.93, seed); },
                  {Size("latency", "time_constant", 0.15, 0.004), Size("scale", "ratio", -0.07, 0.004)},
                  {92}});
  // Once through a part of a turn.
  rows.push_back(OfCourse("ACurveThatHasNotRepeatedIsNoOrder", {0.0, 3.0, 36, 1, 1.0}, 0.05,
                          [](const Place& at) {
                            return 8.0 * (1.0 - std::exp(-at.deg / 30.0)) +
                                   4.0 * std::pow((at.deg - 60.0) / 45.0, 3);
                          },
                          {NotNamed({"periodic"}, 0.7)}, {61, 62, 63}));
  rows.push_back(OfCourse("AnOrderThatIsSharperThanAnyCurveIsOne", {0.0, 110.0 / 59.0, 60, 1, 1.0}, 0.01,
                          Of({{5, 0.5, 0.0}}),
                          {Named("periodic"), Size("periodic", "order", 5.0, 0.0)}, {65}));
  rows.push_back({"CountsOfAServoAtRestAreNoSlipAndNoReversal",
                  [](unsigned) { return Rests(); },
                  {NoneFrom(0.8), [](const Answer& a) { EXPECT_LT(a.run.diagnosis.unknown.probability, 0.8); }}});
  return rows;
}
INSTANTIATE_TEST_SUITE_P(Servo, EncoderAnswer, testing::ValuesIn(ServoRows()), NameOfRow);

/// What a controller told an axis: ways of trapezoids to and fro, with rests between them.
struct Trapezoids {
  double speed_deg_s = 70.0, ramp_s = 0.15, steady_s = 0.35, rest_s = 0.3;

  double Way_s() const { return 2.0 * ramp_s + steady_s; }
  /// From the beginning of a way, upward.
  double Along_deg(double t_s) const {
    const double t = std::clamp(t_s, 0.0, Way_s()), from_end_s = Way_s() - t, half = 0.5 * speed_deg_s / ramp_s;
    const double way_deg = speed_deg_s * (ramp_s + steady_s);
    if (t < ramp_s) return half * t * t;
    return from_end_s < ramp_s ? way_deg - half * from_end_s * from_end_s : speed_deg_s * (t - 0.5 * ramp_s);
  }
  double At(double t_s) const {
    const double period_s = Way_s() + rest_s;
    const int way = static_cast<int>(std::floor(t_s / period_s));
    const double along_deg = Along_deg(t_s - way * period_s - rest_s);
    return way % 2 == 0 ? along_deg : Along_deg(Way_s()) - along_deg;
  }
  double Speed_deg_s(double t_s) const { return (At(t_s + 1e-4) - At(t_s - 1e-4)) / 2e-4; }
  double Acceleration_deg_s2(double t_s) const { return (Speed_deg_s(t_s + 1e-3) - Speed_deg_s(t_s - 1e-3)) / 2e-3; }
};

/// Read every 4 ms, as a controller writes it.
template <class Shows>
Record Driven(const Trapezoids& path, double end_s, double noise_deg, unsigned seed, Shows shows_deg) {
  Noise noise(noise_deg, seed);
  Record record;
  int last = 1, pass = 0;
  for (double t_s = 0.002; t_s < end_s; t_s += 0.004) {
    const double speed_deg_s = path.Speed_deg_s(t_s);
    const int goes = std::abs(speed_deg_s) < 0.3 ? 0 : speed_deg_s > 0.0 ? 1 : -1;
    pass += goes * last < 0 ? 1 : 0;
    last = goes == 0 ? last : goes;
    record.Add(t_s, path.At(t_s), shows_deg(t_s, goes) + noise(), goes, pass);
  }
  return record;
}

/// In all, by a delay and a lag.
Check Late(double late_s, double within_s) {
  return [=](const Answer& a) {
    double told_s = 0.0;
    for (const char* part : {"delay", "time_constant"})
      told_s += a.Find("latency", part) ? a.Value("latency", part) : 0.0;
    EXPECT_NEAR(told_s, late_s, within_s);
  };
}

const Row kDriven[] = {
    // Speeds and accelerations are those of readings 4 ms apart: a few readings of each ramp see its ends.
    {"AServoIsBehindInProportionToSpeedAndAccelerationAndByFriction",
     [](unsigned seed) {
       const Trapezoids path;
       return Driven(path, 7.0, 0.002, seed, [&](double t_s, int goes) {
         return path.At(t_s - 0.0024) - 3.1e-4 * path.Acceleration_deg_s2(t_s) - 0.05 * goes;
       });
     },
     {Named("latency"), Named("acceleration_error"), Named("friction"), Late(0.0024, 0.08 * 0.0024),
      Size("acceleration_error", "coefficient", 3.1e-4, 0.08 * 3.1e-4), Size("friction", "lag", 0.05, 0.08 * 0.05),
      IsNot(Verdict::kUnknown)},
     {95}},
    {"AServoThatIsLateAloneHasNoOtherFollowingError",
     [](unsigned seed) {
       const Trapezoids path{.speed_deg_s = 45.0, .ramp_s = 0.2, .steady_s = 0.2, .rest_s = 0.25};
       return Driven(path, 6.0, 0.004, seed, [&](double t_s, int) { return path.At(t_s - 0.0061); });
     },
     {Named("latency"), Late(0.0061, 0.0001), NotNamed({"friction", "acceleration_error", "backlash"}, 0.5)},
     {96}}};
INSTANTIATE_TEST_SUITE_P(Driven, EncoderAnswer, testing::ValuesIn(kDriven), NameOfRow);

LargeCause Latency(double delay_s, double lag_s) {
  LargeCause latency;
  latency.effect.name = "latency";
  latency.effect.parameters = {{"delay", delay_s}, {"time_constant", lag_s}};
  return latency;
}

TEST(EncoderServo, ThatIsBehindDoesNotLeadAsWell) {
  EXPECT_TRUE(LeadsBesideLatency("backlash", -0.1, {Latency(0.0, 0.2)}));
  EXPECT_TRUE(LeadsBesideLatency("hysteresis", -0.1, {Latency(0.2, 0.0)}));
  EXPECT_FALSE(LeadsBesideLatency("backlash", 0.1, {Latency(0.0, 0.2)}));
  EXPECT_FALSE(LeadsBesideLatency("backlash", -0.1, {Latency(-0.2, 0.0)})) << "then it leads";
  EXPECT_FALSE(LeadsBesideLatency("backlash", -0.1, {}));
}

/// To and fro over ten places, with errors that differ by 0.1 from one way to the other.
EncoderRun ToAndFro(double speed_rad_s) {
  EncoderRun encoder;
  SignalContext& c = encoder.context;
  c.setup.assign(20, 0);
  c.reference_rad.resize(20);
  encoder.run.residual.resize(20);
  for (int i = 0; i < 20; ++i) {
    c.reference_rad[i] = i < 10 ? i : 19 - i;
    encoder.run.residual[i] = i < 10 ? 0.05 : -0.05;
  }
  c.velocity_rad_s = Eigen::VectorXd::Constant(20, speed_rad_s);
  return encoder;
}

Cause Named(const char* effect, const char* size, double value) {
  Cause cause;
  cause.effect = effect;
  cause.probability = 0.95;
  cause.parameters.resize(1);
  cause.parameters[0].name = size;
  cause.parameters[0].value = value;
  return cause;
}

/// How sure the loop is that shows so much of what is there, beside another cause.
double ChanceOfLoop(double width, double shown, const char* beside, double speed_rad_s) {
  const EncoderRun encoder = ToAndFro(speed_rad_s);
  DiagnosisRun result;
  result.run.residual = encoder.run.residual;
  result.diagnosis.causes = {Named("backlash", "width", width), Named(beside, "ratio", 0.01)};
  result.accepted = {test::TermOf("backlash", encoder.run.residual, shown)};
  DoubtLeadingLoops(encoder, result);
  return result.diagnosis.causes.front().probability;
}

TEST(EncoderServo, ThatSeemsToLeadOnReversalIsNotSureToHaveALoop) {
  for (const char* beside : {"latency", "scale"}) {
    EXPECT_LE(ChanceOfLoop(-0.1, 1.0, beside, 1.0), 0.6) << beside;
    EXPECT_GT(ChanceOfLoop(0.1, 1.0, beside, 1.0), 0.9) << beside << ": a device that stays behind may well";
  }
  EXPECT_GT(ChanceOfLoop(-0.1, 1.0, "periodic", 1.0), 0.9) << "a reference that stays behind";
  EXPECT_GT(ChanceOfLoop(-0.1, 1.0, "scale", 0.0), 0.9) << "at stops a scale has no direction";
  EXPECT_LE(ChanceOfLoop(-0.15, 1.5, "periodic", 0.0), 0.6) << "wider than errors are apart";
}

TEST(EncoderServo, OfWhichARestSwingsHasTheMemoryOfASwing) {
  constexpr int kPeriod = 60;
  std::vector<int> pass(1200, 0);
  Eigen::VectorXd swing(1200);
  for (int i = 0; i < swing.size(); ++i) swing[i] = std::sin(2.0 * units::kPi * i / kPeriod);
  // 1 + 2 (sum of cosines over a quarter of a period): the period over pi. By neighbours alone it would be 364.
  EXPECT_NEAR(MemoryOf(swing, pass), kPeriod / units::kPi, 1.5);
  std::mt19937_64 random(5);
  std::normal_distribution<double> step;
  Eigen::VectorXd steady(1200);
  steady[0] = 0.0;
  for (int i = 1; i < steady.size(); ++i) steady[i] = 0.5 * steady[i - 1] + step(random);
  EXPECT_NEAR(MemoryOf(steady, pass), 3.0, 0.6) << "(1 + 0.5) / (1 - 0.5)";
}

TEST(EncoderCounts, AreSeenInAFewValuesThatComeAgain) {
  Eigen::VectorXd shown(8);
  shown << 7, 7, 8, 8, -100, -100, -101, -101;
  EXPECT_NEAR(CountOfFewValues(0.0031 * shown), 0.0031, 1e-9);
  shown[4] = shown[5] = -100.4;
  EXPECT_EQ(CountOfFewValues(0.0031 * shown), 0.0) << "not whole counts apart";
  shown << 7, 7.1, 8, 8.1, -100, -100.1, -101, -101.1;
  EXPECT_EQ(CountOfFewValues(0.0031 * shown), 0.0) << "none comes again";
}

}  // namespace servo
}  // namespace
}  // namespace twinbench::diagnose::encoder
