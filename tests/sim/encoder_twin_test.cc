#include "tests/core/input_error.h"
#include "tests/sim/encoder_run.h"
#include "tests/support/kept_text.h"

namespace twinbench {
namespace {

using test::EncoderEffect, test::EncoderScenario, test::ReadingsWith, test::RunEncoderTwin;
using units::deg;

constexpr double kTiny_rad = 1e-11;  // rounding of angles of some turns

double Error_rad(const Reading& reading) { return reading.measured_rad - reading.reference_rad; }

TEST(AngleSchedule, GoesThroughTheSameStopsInBothDirections) {
  const auto readings = procedure::AngleSchedule(EncoderOf(EncoderScenario()).encoder_procedure);
  ASSERT_EQ(readings.size(), 4u * 144u);
  EXPECT_EQ(readings[143].reference_rad, readings[144].reference_rad);
  EXPECT_NEAR(readings[143].reference_rad, 715.0 * deg, 1e-12);
  EXPECT_EQ(readings[144].direction, -1);
  EXPECT_EQ(readings[288].pass, 2);
  EXPECT_EQ(ToSeconds(readings[575].time), 575 * 4.0);
}

TEST(AngleSchedule, OfASweepIsTheMotionOfATableWithConstantAcceleration) {
  const Scenario scenario = Altered(EncoderScenario("sweep"), {"encoder_procedure.passes=[1, -1]"});
  const auto readings = procedure::AngleSchedule(EncoderOf(scenario).encoder_procedure);
  for (std::size_t i = 1; i < readings.size(); ++i) {
    const Reading &a = readings[i - 1], &b = readings[i];
    const double step_s = ToSeconds(b.time - a.time);
    // The trapezium rule is exact but where the acceleration changes within the step: 60 deg/s^2 / 8 * (80 ms)^2.
    EXPECT_NEAR(b.reference_rad - a.reference_rad, 0.5 * step_s * (a.velocity_rad_s + b.velocity_rad_s),
                0.05 * deg);
    EXPECT_LE(std::abs(b.velocity_rad_s), 36.0 * deg * (1.0 + 1e-12));
    EXPECT_EQ(b.direction, b.velocity_rad_s > 0.0 ? 1 : b.velocity_rad_s < 0.0 ? -1 : 0);
  }
  EXPECT_NEAR(readings.back().reference_rad, 0.0, 1e-9) << "forth and back at each speed";
  // 20 s + 2 * 0.6 s + 2 s every 80 ms, and 60 s + ... at the lower speed, forth and back.
  EXPECT_EQ(readings.size(), 2u * 290u + 2u * 790u);
}

TEST(AngleSchedule, TurnsTheDeviceOnTheShaftAtEverySetUp) {
  const auto readings = RunEncoderTwin(Altered(EncoderScenario(), {"encoder_procedure.mounting_deg=[0, 90]"})).readings;
  ASSERT_EQ(readings.size(), 2u * 576u);
  EXPECT_EQ(readings[576].setup, 1);
  EXPECT_NEAR(readings[576].measured_rad - readings[576].reference_rad, 90.0 * deg, 1e-12);
  EXPECT_EQ(ToSeconds(readings[576].time - readings[575].time), 4.0 + 600.0);
}

Scenario Noisy(const std::string& kind = "stops") {
  Scenario scenario = EncoderScenario(kind);
  scenario.noise_free = false;
  return scenario;
}

TEST(EncoderTwin, DrawsTheNoiseOfAReadingFromItsNumberAlone) {
  Scenario scenario = Noisy();
  const auto all = RunEncoderTwin(scenario).readings;
  sim::EncoderTwin twin(scenario);
  Reading alone = procedure::AngleSchedule(EncoderOf(scenario).encoder_procedure)[77];
  twin.Take(alone);
  EXPECT_EQ(alone.measured_rad, all[77].measured_rad);
}

TEST(EncoderTwin, ShowsTheMeanOfAStopsReadingsWhereNoiseTeachesItBetweenItsStepsAndReadsOnceInMotion) {
  Scenario scenario = Noisy();
  EncoderOf(scenario).device.resolution_rad = EncoderOf(scenario).device.noise_rad;
  EncoderOf(scenario).encoder_procedure.readings_per_stop = 16;
  double squares = 0.0;
  const auto readings = RunEncoderTwin(scenario).readings;
  for (const Reading& r : readings) squares += std::pow(r.measured_rad - r.reference_rad, 2);
  const double rms_rad = std::sqrt(squares / static_cast<double>(readings.size()));
  // A step adds 1/12 of its square to that of one reading. 576 readings: 3 % of the deviation; four of these.
  EXPECT_NEAR(rms_rad / (EncoderOf(scenario).device.noise_rad * std::sqrt(13.0 / 12.0) / 4.0), 1.0, 0.12);
  Scenario sweep = Noisy("sweep");
  const auto once = RunEncoderTwin(sweep).readings;
  EncoderOf(sweep).encoder_procedure.readings_per_stop = 16;
  EXPECT_EQ(RunEncoderTwin(sweep).readings[77].measured_rad, once[77].measured_rad);
}

TEST(EncoderTwin, HasNoMoreReadingsAtAStopThanFitIntoIt) {
  const std::string text =
      "bench = \"encoder_comparison\"\n[encoder_procedure]\nstop_interval_s = 4.0\nread_s = 0.5\n";
  EXPECT_NO_THROW(ParseScenario(text + "readings_per_stop = 8\n", "s.toml", "."));
  EXPECT_THROW(ParseScenario(text + "readings_per_stop = 9\n", "s.toml", "."), InputError);
}

TEST(EncoderTwin, TellsItsTruth) {
  Scenario scenario = EncoderScenario();
  scenario.effects.push_back(EncoderEffect("latency"));
  const nlohmann::json truth = sim::EncoderTwin(scenario).Truth();
  EXPECT_EQ(truth.at("effects").at(0).at("effect"), "latency");
  EXPECT_EQ(truth.at("effects").at(0).at("parameters_SI").at("delay"), 0.001);
}

TEST(EncoderTwin, ReadsItsRingWithSeveralHeadsAtOneInstant) {
  const Scenario heads = Altered(EncoderScenario(), {"encoder_procedure.heads_deg=[0, 90]", "encoder_procedure.mounting_deg=[0, 10]"});
  const auto readings = ReadingsWith(heads, EncoderEffect("eccentricity", {{"amplitude", 0.1 * deg}}));
  ASSERT_EQ(readings.size(), 2u * 2u * 576u);
  EXPECT_TRUE(std::isnan(readings.front().temperature_degC)) << "where the room does not change nobody looks";
  for (std::size_t i = 0; i < readings.size(); i += 2) {
    const Reading &first = readings[i], &second = readings[i + 1];
    EXPECT_EQ(first.time, second.time);
    EXPECT_EQ(first.setup + 1, second.setup);
    EXPECT_EQ(second.head_rad, 90.0 * deg);
    const double at = second.reference_rad + (second.setup == 1 ? 0.0 : 10.0 * deg) - 90.0 * deg;
    EXPECT_NEAR(second.measured_rad, at + 0.1 * deg * std::cos(at), 1e-12);
  }
}

TEST(EncoderTwin, HasOneNoiseOfTheReferenceForAllHeadsOfAnInstant) {
  const Scenario scenario =
      Altered(Noisy(), {"encoder_procedure.heads_deg=[0, 90, 100]", "encoder_procedure.reference_noise_arcsec=3600"});
  const auto readings = RunEncoderTwin(scenario).readings;
  const auto exact = procedure::AngleSchedule(EncoderOf(scenario).encoder_procedure);
  double squares = 0.0;
  for (std::size_t i = 0; i < readings.size(); i += 3) {
    EXPECT_EQ(readings[i].reference_rad, readings[i + 2].reference_rad);
    squares += std::pow(readings[i].reference_rad - exact[i].reference_rad, 2);
  }
  // 576 instants: 3 % of the deviation; four of these.
  EXPECT_NEAR(std::sqrt(squares / 576.0) / deg, 1.0, 0.12);
}

TEST(EncoderTwin, HasTheGraduationOfItsBenchInEveryRun) {
  Scenario scenario =
      Altered(EncoderScenario(), {"device.graduation_arcsec=2", "device.graduation_fall=0.5", "device.graduation_orders=100"});
  const auto curve = [](const Scenario& s) {
    return sim::EncoderTwin(s).Truth().at("device").at("ez_arcsec").get<std::vector<double>>();
  };
  const std::vector<double> first = curve(scenario);
  scenario.repeat = 3;
  EXPECT_EQ(curve(scenario), first) << "another run of the same bench";
  double squares = 0.0;
  constexpr int kRings = 100;
  for (int seed = 0; seed < kRings; ++seed) {
    scenario.seed = static_cast<std::uint64_t>(seed);
    for (const double value : curve(scenario)) squares += value * value / 360.0 / kRings;
  }
  // Order 1 has a fifth of the variance: 100 rings, 2 parts each of some ten orders that count: 3 %.
  EXPECT_NEAR(std::sqrt(squares), 2.0, 0.2);
}

/// Amplitude of an order in a curve at every degree.
double Amplitude_arcsec(const nlohmann::json& curve, int order) {
  std::complex<double> sum = 0.0;
  for (int i = 0; i < 360; ++i)
    sum += curve.at("ez_arcsec").at(static_cast<std::size_t>(i)).get<double>() * std::polar(1.0, -order * i * deg);
  return 2.0 * std::abs(sum) / 360.0;
}

TEST(EncoderTwin, TellsWhatRepeatsWithTheAnglesOfDeviceAndReference) {
  Scenario scenario = EncoderScenario();
  scenario.effects = {EncoderEffect("eccentricity", {{"amplitude", 0.5 * deg}}),
                      EncoderEffect("reference_fault", {{"order", 3.0}, {"amplitude", 0.02 * deg}}),
                      EncoderEffect("signal_offset", {{"offset_sin", 0.0}, {"offset_cos", 0.01}}),
                      EncoderEffect("drift"), EncoderEffect("outliers", {{"fraction", 0.5}}),
                      EncoderEffect("slip", {{"at_reading", 0.0}}), EncoderEffect("backlash")};
  EncoderOf(scenario).device.signal_periods = 4;
  const nlohmann::json truth = sim::EncoderTwin(scenario).Truth();
  // What is 1e-9 of 1800 arcsec is rounding.
  EXPECT_NEAR(Amplitude_arcsec(truth.at("device"), 1), 1800.0, 1e-6);
  EXPECT_NEAR(Amplitude_arcsec(truth.at("device"), 0), 0.0, 1e-6) << "drift, slip and outliers are no curve";
  EXPECT_NEAR(Amplitude_arcsec(truth.at("device"), 4), 0.01 / 4 / units::arcsec, 0.1)
      << "offset over amplitude, a quarter of it on the turn; next term 0.01^2 / 2";
  EXPECT_NEAR(Amplitude_arcsec(truth.at("reference"), 3), 72.0, 1e-6);
  EXPECT_NEAR(Amplitude_arcsec(truth.at("reference"), 1), 0.0, 1e-6);
}

// What an effect does to the readings is the course of its family: tests/diagnose/named_families_test.cc.

TEST(EncoderEffects, InterpolationNeedsTheLinesOfTheScale) {
  EXPECT_KEPT(MessageOf([] { ReadingsWith(EncoderScenario(), EncoderEffect("interpolation")); }));
}

TEST(EncoderEffects, SignalsThatBeginLaterErrLater) {
  const auto clipped = [](double zero_rad) {
    return ReadingsWith(EncoderScenario(), EncoderEffect("signal_clipping", {{"level", 0.5}, {"zero", zero_rad}}));
  };
  const auto here = clipped(0.0), later = clipped(5.0 * deg);  // the distance of two stops
  for (std::size_t i = 1; i < 144; ++i) EXPECT_NEAR(Error_rad(later[i]), Error_rad(here[i - 1]), kTiny_rad);
}

TEST(EncoderEffects, OutliersHitTheirShareOfTheReadings) {
  int hits = 0;
  const auto readings =
      ReadingsWith(EncoderScenario("sweep"), EncoderEffect("outliers", {{"fraction", 0.1}, {"size", 0.02}}));
  for (const Reading& r : readings) {
    const double size_rad = std::abs(Error_rad(r));
    if (size_rad < kTiny_rad) continue;
    ++hits;
    EXPECT_GE(size_rad, 0.5 * 0.02 - kTiny_rad);
    EXPECT_LE(size_rad, 1.5 * 0.02 + kTiny_rad);
  }
  // Binomial: deviation sqrt(0.1 * 0.9 / 4320) = 0.0046; three of these.
  EXPECT_NEAR(hits / static_cast<double>(readings.size()), 0.1, 0.014);
}

}  // namespace
}  // namespace twinbench
