#include "tests/diagnose/encoder_record.h"

namespace twinbench::diagnose::encoder {
namespace {

using namespace lab;
using testing::HasSubstr;

// Two series with a clock each, of which one runs fast: the shaft is where it was at another time.

constexpr Swing kSwing{500.0, 37.0};

/// What the device shows when the reference's clock says t.
Row ReadBy(const std::string& name, const std::function<double(double t_s)>& shows_deg,
           const std::vector<Check>& checks, unsigned seed) {
  return {name, [=](unsigned s) { return Swung(kSwing, 0.03, 130.0, 0.13, 0.004, s, shows_deg); }, checks, {seed}};
}

double Speed_deg_s(double t_s) { return (kSwing.At(t_s + 1e-3) - kSwing.At(t_s - 1e-3)) / 2e-3; }

Rows ClockRows() {
  Rows rows = {ReadBy(
                   "AClockThatRunsFastAndAReadingThatIsLateAreBoth",
                   [](double t_s) { return kSwing.At(t_s * (1.0 - 4e-4) - 0.012); },
                   {Found("clock_rate", "ratio", 4e-4), Found("latency", "delay", 0.012), kSilentAgain}, 71),
               ReadBy(
                   "AClockIsNotToBlameForAScale", [](double t_s) { return 1.0002 * kSwing.At(t_s); },
                   {Named("scale"), NotNamed({"clock_rate"})}, 72),
               ReadBy(
                   "AClockIsNotToBlameForAResonance",
                   [](double t_s) {
                     const double v = Speed_deg_s(t_s), x = (std::abs(v) - 22.0) / 4.0;
                     return kSwing.At(t_s) + std::copysign(0.05, v) / (1.0 + x * x);
                   },
                   {NotNamed({"clock_rate"}, 0.5)}, 73),
               ReadBy(
                   "AClockIsNotToBlameForWhatGrowsWithTheSpeed",
                   [](double t_s) {
                     const double v = Speed_deg_s(t_s);
                     return kSwing.At(t_s) + 3e-5 * v * std::abs(v) * t_s / 130.0;
                   },
                   {NotNamed({"clock_rate"}, 0.5)}, 74)};
  for (const double ratio : {2e-5, -3e-4, 2e-3}) {
    // A clock that shows t when t / (1 + ratio) has passed is late by ratio t to first order.
    rows.push_back(ReadBy(
        fmt::format("AClockThatRunsFastIsFoundWithItsRate_{}", rows.size()),
        [=](double t_s) { return kSwing.At(t_s / (1.0 + ratio)); },
        {Named("clock_rate"), Size("clock_rate", "ratio", ratio, ratio * ratio, 4.0), HasCauses(1), kSilentAgain},
        70));
  }
  return rows;
}
INSTANTIATE_TEST_SUITE_P(Clock, EncoderAnswer, testing::ValuesIn(ClockRows()), NameOfRow);

const Row kMotion[] = {
    // A plate over 10 deg at 1 Hz: late, and with a rest of its own that goes on from reading to reading and is a
    // tenth of the
    // variance.
    {"AServoOverAPartOfATurnIsLateBesideARestThatWanders",
     [](unsigned seed) {
       const Swing plate{10.0, 1.0, -5.0};
       Noise step(0.3 * std::sqrt(1.0 - 0.9 * 0.9), seed);
       double rest_deg = 0.0;
       return Swung(plate, 0.01, 17.0, 0.0233, 0.01, seed, [&](double t_s) {
         rest_deg = 0.9 * rest_deg + step();
         return plate.At(t_s - 0.045) + rest_deg;
       });
     },
     {Found("latency", "delay", 0.045, 0.006)},
     {81, 82, 83}},
    // Ever faster to and fro: at the end the delay is a third of a period, and the speed of the moment says nothing
    // of how far it
    // is behind.
    {"LateByAPartOfAPeriodIsALatencyAndAScale",
     [](unsigned seed) {
       const auto chirp_deg = [](double t_s) {
         return 1.45 * std::sin(2.0 * units::kPi * (2.0 * t_s + 1.5 * t_s * t_s));
       };
       Noise noise_deg(0.02, seed);
       return Chirped(0.03, 4.0, 0.0031, chirp_deg,
                      [&](double t_s) { return 0.79 * chirp_deg(t_s - 0.025) + noise_deg(); });
     },
     {Named("latency"), Named("scale"), NotNamed({"hysteresis", "backlash"}),
      Size("latency", "delay", 0.025, 0.02 * 0.025), Size("scale", "ratio", -0.21, 0.02)},
     {84}},
    // An arm that sags with the cosine of its angle, about the level: hardly any of it is a scale, all is bend, which takes nothing
    // from the friction beside it.
    {"TheBendOfAScaleThatIsNoneElseTakesNothingFromAHysteresis",
     [](unsigned seed) {
       const Swing arm{120.0, 20.0, -50.0};
       double last_deg = arm.At(0.0), settled = -1.0;
       return Swung(arm, 0.02, 60.0, 0.05, 0.02, seed, [&](double t_s) {
         const double at_deg = arm.At(t_s), way_deg = at_deg - last_deg;
         settled += (std::copysign(1.0, way_deg) - settled) * (1.0 - std::exp(-std::abs(way_deg) / 2.4));
         last_deg = at_deg;
         return at_deg - 0.208 * settled + 0.83 * std::cos((at_deg - 2.0) * units::deg);
       });
     },
     {Found("hysteresis", "lag", 0.208), Found("hysteresis", "settles_over", 2.4), NotNamed({"backlash"})},
     {85, 86}}};
INSTANTIATE_TEST_SUITE_P(Motion, EncoderAnswer, testing::ValuesIn(kMotion), NameOfRow);

// There and back over 180 deg at one speed, turned at once between two readings: but for the few about the turns, a delay shows what
// a loop shows.

double Turned_deg(double t_s) { return 180.0 * std::abs(std::fmod(t_s / 4.8314 + 0.0962, 2.0) - 1.0); }

/// @param error_deg  Of the device, from a reading of the reference to the next.
Record TurnedAtOnce(const std::function<double(double t_s, double from_deg, double to_deg)>& error_deg, unsigned seed) {
  Noise noise_deg(0.0275, seed);
  Record record;
  double last_deg = Turned_deg(0.0);
  for (int i = 0, pass = 0, direction = -1; i < 3000; ++i) {
    const double t_s = 0.01 * i, at_deg = Turned_deg(t_s);
    if ((at_deg - last_deg) * direction < 0.0) direction = -direction, ++pass;
    record.Add(t_s, at_deg, at_deg + error_deg(t_s, last_deg, at_deg) + noise_deg(), direction, pass);
    last_deg = at_deg;
  }
  return record;
}

const Row kOneSpeed[] = {
    {"APlayOfFourReadingsIsNoLatency",
     [](unsigned seed) {
       double follower_deg = Turned_deg(0.0);
       return TurnedAtOnce(
           [follower_deg](double, double, double to_deg) mutable {
             follower_deg = std::clamp(follower_deg, to_deg - 0.745, to_deg + 0.745);
             return follower_deg - to_deg;
           },
           seed);
     },
     {Found("backlash", "width", 1.49, 0.02), NotNamed({"latency", "hysteresis"})},
     {91, 92}},
    {"ALagThatTurnsWithTheMotionIsNoLatency",
     [](unsigned seed) {
       return TurnedAtOnce([](double, double from_deg, double to_deg) { return to_deg > from_deg ? -0.33 : 0.33; }, seed);
     },
     {NotNamed({"latency"}, 0.6), [](const Answer& a) { EXPECT_TRUE(a.Names("hysteresis", 0.3) || a.Names("backlash", 0.3)); }},
     {93, 94}},
    {"ALatencyMayAsWellBeALoop",
     [](unsigned seed) {
       return TurnedAtOnce([](double t_s, double, double to_deg) { return Turned_deg(t_s + 10.0 * 2 * 4.8314 - 0.00886) - to_deg; }, seed);
     },
     {Named("latency", 0.3), Size("latency", "delay", 0.00886, 0.0001), NotNamed({"backlash", "hysteresis"}, 0.6)},
     {95, 96}}};
INSTANTIATE_TEST_SUITE_P(OneSpeed, EncoderAnswer, testing::ValuesIn(kOneSpeed), NameOfRow);

// Counters that lose counts, written down as they count.

/// Of a counter, from the reading before to this one.
using Lost = std::function<double(double t_s, double from_deg, double to_deg)>;

/// There and back in motion, two turns and a bit, twice.
Row Counted(const std::string& name, const Lost& lost_deg, const std::vector<Check>& checks, unsigned seed) {
  const auto record = [=](unsigned s) {
    const Swing swing{790.0, 80.0, 11.0};
    double last_deg = kNaN, lost = 0.0;
    return Swung(swing, 0.05, 160.0, 0.11, 0.003, s, [&](double t_s) {
      const double at_deg = swing.At(t_s);
      if (std::isfinite(last_deg)) lost += lost_deg(t_s, last_deg, at_deg);
      last_deg = at_deg;
      return at_deg + lost;
    });
  };
  return {name, record, checks, {seed}};
}

std::vector<Check> OneUnknown(const std::string& words) {
  return {Is(Verdict::kUnknown), Says(HasSubstr(words)), NotNamed({"slip"}, 0.01), NotNamed({"scale"}, 0.5),
          kSilentAgain};
}

double Whole(double angle_deg, double spot_deg) { return std::floor((angle_deg - spot_deg) / 360.0); }

/// Once, at the first reading from then on.
bool At(double event_s, double t_s) { return t_s >= event_s && t_s < event_s + 0.11 - 1e-9; }

const Row kCounts[] = {
    Counted(
        "CountsLostAtOneSpotInOneSenseAreOneUnknown",
        [](double, double from, double to) { return -0.02 * std::max(0.0, Whole(to, 137.0) - Whole(from, 137.0)); },
        OneUnknown("lost counts, the same each time that 13"), 60),
    Counted(
        "CountsThatComeBackOnTheWayBackAreOneUnknown",
        [](double, double from, double to) { return -0.0125 * (Whole(to, 0.0) - Whole(from, 0.0)); },
        OneUnknown("which come back"), 61),
    Counted(
        "CountsOfATurnThatIsNotWholeAreNoScale",
        [](double, double from, double to) {
          return 0.03 * ((to - from) / 360.0 - (Whole(to, 77.0) - Whole(from, 77.0)));
        },
        OneUnknown("put right at 7"), 62),
    Counted(
        "EqualStepsAreOneUnknownWithSeveralEvents",
        [](double t_s, double, double) {
          return At(31.0, t_s) || At(58.0, t_s) ? -0.022 : At(117.0, t_s) ? 0.022 : At(140.0, t_s) ? -0.044 : 0.0;
        },
        OneUnknown("4 steps of one size"), 63),
    Counted(
        "TwoStepsThatAreNotAlikeAreTwoSlips",
        [](double t_s, double, double) { return At(31.0, t_s) ? -0.05 : At(117.0, t_s) ? 0.033 : 0.0; },
        {[](const Answer& a) { EXPECT_EQ(std::ranges::count(a.run.diagnosis.causes, "slip", &Cause::effect), 2); },
         kSilentAgain},
        64)};
INSTANTIATE_TEST_SUITE_P(Counts, EncoderAnswer, testing::ValuesIn(kCounts), NameOfRow);

// Devices that come to rest after their reference, in time, beside what goes by the way.

/// 36 stops there and back twice, each read six times while it comes to rest.
/// @param left_deg  Of a move when it has ended.
/// @param over_s  In which 63 % of it are gone.
/// @param warm_up_deg  Of a drift that settles in 300 s.
Row ComesToRest(const std::string& name, double left_deg, double over_s, double warm_up_deg,
                const std::vector<Check>& checks, unsigned seed) {
  const auto record = [=](unsigned s) {
    Noise noise(0.0015, s);
    Record r{"stops"};
    for (const Reading& stop : Listed({0.7, 10.0, 36, 4}, [](const Place&) { return 0.0; }).readings) {
      const double at_deg = stop.reference_rad / units::deg;
      for (int again = 0; again < 6; ++again) {
        const double now_s = 3.0 + 7.0 * stop.reading + 0.8 * again;
        const double error_deg = -stop.direction * left_deg * std::exp(-0.8 * again / over_s) +
                                 warm_up_deg * (1.0 - std::exp(-now_s / 300.0));
        r.Add(now_s, at_deg, at_deg + error_deg + noise(), stop.direction, stop.pass);
      }
    }
    return r;
  };
  return {name, record, checks, {seed}};
}

Rows SettlingRows() {
  Rows rows = {ComesToRest("SettlingIsFoundBesideAWarmUp", 0.02, 1.2, 0.025,
                           {Found("settling", "amplitude", 0.02), Found("drift", "warm_up", 300.0),
                            NotNamed({"hysteresis"}), kSilentAgain},
                           121)};
  for (const double over_s : {0.6, 1.7})
    rows.push_back(ComesToRest(fmt::format("SettlingIsNoHysteresis_{}", rows.size() - 1), 0.03, over_s, 0.0,
                               {Found("settling", "amplitude", 0.03), Found("settling", "time_constant", over_s),
                                HasCauses(1), kSilentAgain},
                               120));
  return rows;
}
INSTANTIATE_TEST_SUITE_P(Settling, EncoderAnswer, testing::ValuesIn(SettlingRows()), NameOfRow);

// Tests of positioning as ISO 230-2 has them: targets that are no even way apart, approached from both sides again
// and again, an axis with a curve of its own and a reversal. A mm is written as a degree.

struct Axis {
  double length_mm;
  int targets;
  double curve_um, reversal_um, noise_um, warm_up_um = 0.0;

  double Curve_um(double x_mm) const {
    const double u = x_mm / length_mm;
    return curve_um * (4.0 * u * (1.0 - 0.8 * u) + 0.13 * std::sin(10.7 * u + 1.0) + 0.07 * std::cos(27.0 * u));
  }
};

Row Positioned(const std::string& name, const Axis& axis, const std::vector<Check>& checks, unsigned seed) {
  const auto record = [=](unsigned s) {
    Noise normal(1.0, s), uneven(0.09, s + 1);
    std::vector<double> targets_mm;
    for (int k = 0; k < axis.targets; ++k)
      targets_mm.push_back(axis.length_mm / axis.targets * (k + std::clamp(uneven(), -0.15, 0.15)));
    Record r{"stops"};
    for (const Reading& stop :
         Listed({0.0, 1.0, axis.targets, 10}, [](const Place& at) { return at.stop; }).readings) {
      const double x_mm = targets_mm[static_cast<std::size_t>(std::lround(stop.measured_rad / units::deg))],
                   t_s = 7.0 * stop.reading;
      const double error_um = axis.Curve_um(x_mm) - 0.5 * stop.direction * axis.reversal_um +
                              axis.warm_up_um * (1.0 - std::exp(-t_s / 400.0)) + axis.noise_um * normal();
      r.Add(t_s, x_mm, x_mm + 1e-3 * error_um, stop.direction, stop.pass);
    }
    return r;
  };
  return {name, record, checks, {seed}};
}

const Check kNoOrders = NotNamed({"eccentricity", "ellipticity", "periodic", "signal_offset"});
const Row kPositioned[] = {
    Positioned("ACurveThatRepeatsAtEveryTargetHidesNoReversal_25", {400.0, 21, 94.0, 25.0, 0.8},
               {Found("backlash", "width", 25e-3, 0.5e-3), kNoOrders, kSilentAgain}, 81),
    Positioned("ACurveThatRepeatsAtEveryTargetHidesNoReversal_9", {240.0, 12, 60.0, 9.0, 0.6},
               {Found("backlash", "width", 9e-3, 0.5e-3), kNoOrders, kSilentAgain}, 82),
    Positioned("AWarmUpBesideTheReversalIsADriftThatSettles", {400.0, 21, 94.0, 25.0, 0.8, 15.0},
               {Found("drift", "warm_up", 400.0), Found("backlash", "width", 25e-3), NotNamed({"hysteresis"}),
                kSilentAgain},
               90),
    OfCourse("FewOrdersKeepTheirNames", {0.0, 15.0, 24, 4, 4.0}, 0.001,
             Of({{1, 0.03, 40.0}, {5, 0.012, 0.0}}) + ByDirection(-0.006),
             {Named("eccentricity", 0.0), Named("periodic"), Named("backlash"), kSilentAgain}, {91})};
INSTANTIATE_TEST_SUITE_P(Targets, EncoderAnswer, testing::ValuesIn(kPositioned), NameOfRow);

}  // namespace
}  // namespace twinbench::diagnose::encoder
