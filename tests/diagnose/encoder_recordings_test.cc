#include "tests/diagnose/encoder_fit.h"
#include "tests/diagnose/encoder_record.h"
#include "tests/diagnose/ring_run.h"
#include "twin/benches/encoder_comparison/diagnosis/wander.h"
#include "twin/benches/encoder_comparison/estimators/angle_comparison.h"
#include "twin/diagnose/part_of_readings.h"

namespace twinbench::diagnose::encoder {
namespace {

using namespace lab;
using testing::HasSubstr;

// What recordings of others have beside a cause: glitches, a part of a turn, targets of a stage, joints whose
// friction remembers. Closed forms.

using Glitches = std::map<int, double>;

/// A device that wraps and shows something else at some readings: what it finds is as without them.
Row Glitched(const std::string& name, const Glitches& shown_deg, const std::vector<unsigned>& seeds) {
  const auto record = [=](unsigned seed) {
    Noise noise_deg(0.01, seed);
    return Listed({0.6, 1.2, 300, 2}, [&](const Place& at) {
      const double right_deg = at.deg + Sum({{1, 0.9, 20.0}, {2, 0.25, -80.0}}, at.deg) + noise_deg();
      const auto glitch = shown_deg.find(static_cast<int>(at.t_s));
      return glitch == shown_deg.end() ? right_deg - 360.0 * std::floor(right_deg / 360.0) : glitch->second;
    });
  };
  return {name,
          record,
          {Order(1, 0.9, 0.004), Order(2, 0.25, 0.004), NotNamed({"slip"}), HasUnnamed(false), Named("outliers"),
           Size("outliers", "fraction", static_cast<double>(shown_deg.size()) / 600.0, 1e-8),
           Notes(std::to_string(shown_deg.begin()->first)), kSilentAgain},
          seeds};
}

/// One order of which a part of a turn is seen, however high it is.
Row PartOfATurn(int order, double travel_deg, int stops) {
  return OfCourse(
      fmt::format("APartOfATurnShowsOneOrderHoweverHighItIs_{}", order), {33.0, travel_deg / stops, stops}, 0.002,
      Of({{order, 0.01, 75.0}}),
      {HasCauses(1), Size("periodic", "order", order, 0.1 * 360.0 / travel_deg),  // of what the travel resolves
       Size("periodic", "amplitude", 0.01, 0.0005), kSilentAgain},
      {5});
}

struct JointCourse {
  int readings = 2400;
  double every_s = 0.04, settles_deg = 0.0;
};

/// A joint that swings by two frequencies, which grow and die away, with a gap and friction of some memory.
Record Joint(double gap_deg, double noise_deg, double memory_s, bool is_walk, unsigned seed,
             const JointCourse& course = {}) {
  const double end_s = course.readings * course.every_s,
               kept = is_walk ? 1.0 : std::exp(-course.every_s / memory_s);
  Noise new_deg(noise_deg * (is_walk ? 1.0 : std::sqrt(1.0 - kept * kept)), seed);
  Record record;
  double last_deg = 0.0, shaft_deg = 0.0, behind_deg = 0.0, friction_deg = 0.0;
  int direction = 1, pass = 0;
  for (int k = 0; k < course.readings; ++k) {
    const double t_s = course.every_s * k;
    const double swell = std::pow(std::clamp(std::min(t_s, end_s - t_s) / (0.4 * end_s), 0.0, 1.0), 2);
    const double angle_deg = swell * (24.0 * std::sin(2.0 * units::kPi * 0.041 * t_s) +
                                      15.0 * std::sin(2.0 * units::kPi * 0.063 * t_s + 0.7));
    shaft_deg = std::clamp(shaft_deg, angle_deg - 0.5 * gap_deg, angle_deg + 0.5 * gap_deg);
    const double way_deg = std::abs(angle_deg - last_deg);
    behind_deg +=
        (course.settles_deg > 0.0 ? -std::expm1(-way_deg / course.settles_deg) : 1.0) * (shaft_deg - behind_deg);
    friction_deg = kept * friction_deg + new_deg();
    const int sense = angle_deg < last_deg ? -1 : 1;
    pass += sense != direction ? 1 : 0;
    direction = sense;
    last_deg = angle_deg;
    record.Add(t_s, angle_deg, behind_deg + friction_deg, direction, pass);
  }
  return record;
}

const Row kRecordings[] = {
    Glitched("OneReadingFarOffTakesNothingFromTheOthers_0", {{417, 89.7}}, {1, 2}),
    Glitched("OneReadingFarOffTakesNothingFromTheOthers_1", {{0, 50.0}}, {1, 2}),
    Glitched("OneReadingFarOffTakesNothingFromTheOthers_2", {{31, 200.0}, {290, 5.0}, {511, 170.0}}, {1, 2}),
    Glitched("ATableInterpolatedAcrossItsWrapIsNoSlip_0", {{297, 270.0}, {298, 180.0}, {299, 90.0}}, {3}),
    Glitched("ATableInterpolatedAcrossItsWrapIsNoSlip_1", {{597, 90.0}, {598, 180.0}, {599, 270.0}}, {4}),
    PartOfATurn(2048, 60.0, 3000),
    PartOfATurn(180, 40.0, 250),
    PartOfATurn(900, 47.0, 1200),
    // A wave and a fault whose signature begins with it: what is told has a size, and the file has it.
    OfCourse("AnOrderFourBesideLargerOnesHasASize", {0.3, 360.0 / 588.0, 588}, 0.02,
             Of({{1, 1.8, 20.0}, {2, 0.5, -80.0}, {4, 0.07, 130.0}}),
             {Size("periodic", "amplitude", 0.07, 0.006), kSilentAgain}, {1, 2, 3}),
    // A stage of 11 targets whose scale errs, each target by a little of its own.
    {"AScaleIsToldBeforeErrorsOfTargets",
     [](unsigned seed) {
       Noise normal(1.0, seed);
       std::array<double, 11> own_deg;
       for (double& e : own_deg) e = 0.004 * normal();
       return Listed({10.0, 20.0, 11, 10}, [&](const Place& at) {
         return 1.001 * at.deg + own_deg[static_cast<std::size_t>(at.stop)] + 0.0008 * normal();
       });
     },
     {Is(Verdict::kNamed), Found("scale", "ratio", 1e-3, 5e-5),
      Says(HasSubstr("error of its own at each of 11 targets")),
      [](const Answer& a) { EXPECT_EQ(a.run.diagnosis.causes.at(0).effect, "scale"); }, kSilentAgain},
     {1, 2, 3}},
    // A servo that follows late, read by a resolver whose order 4 is large: 8 and 12 are there by the lateness
    // alone.
    {"ALargeOrderFourThatIsLateIsNoClipping",
     [](unsigned seed) {
       const Swing swing{300.0, 40.0, 20.0};
       return Swung(swing, 1.0, 41.0, 0.02, 0.02, seed, [&](double t_s) {
         const double shaft_deg = swing.At(t_s - 0.15);
         return shaft_deg + Sum({{4, 8.0, 35.0}}, shaft_deg);
       });
     },
     {NotNamed({"signal_clipping"}), Named("latency"), Named("periodic"), Size("latency", "delay", 0.15, 0.003),
      Size("periodic", "amplitude", 8.0, 0.05)},
     {7}},
    // Four fifths of the variance are play: a walk may follow all of it, and is not asked first.
    {"AWalkTakesNothingOfPlayBesideFrictionThatRemembers",
     [](unsigned seed) { return Joint(3.6, 0.8, 0.35, false, seed); },
     {Named("backlash"), Size("backlash", "width", 3.6, 0.6), Is(Verdict::kNamed)},
     {1, 2, 4}},
    // Neither of the catalogue's loops, and not both of them.
    {"PlayWithACourseOfItsOwnIsNamedAsOneLoop",
     [](unsigned seed) {
       return Joint(5.3, 0.6, 0.6, false, seed, {900, 0.1, 2.0});
     },
     {[](const Answer& a) { EXPECT_NE(a.Names("backlash", 0.5), a.Names("hysteresis", 0.5)); }},
     {9, 13, 14, 29}},
    {"AWalkOfAJointWithoutPlayIsNoPlay",
     [](unsigned seed) { return Joint(0.0, 0.06, 0.0, true, seed); },
     {NotNamed({"backlash", "hysteresis"}, 0.5)},
     {11, 12, 13}}};
INSTANTIATE_TEST_SUITE_P(Recordings, EncoderAnswer, testing::ValuesIn(kRecordings), NameOfRow);

TEST(EncoderRecordings, WholeTurnsAreContinuedBehindAGlitch) {
  std::vector<Reading> readings(12);
  for (int i = 0; i < 12; ++i) readings[i].reference_rad = i * units::deg;
  for (int i = 0; i < 12; ++i) readings[i].measured_rad = (i + 170.0) * units::deg;
  readings[5].measured_rad += 100.0 * units::deg;  // a turn is made up in three steps
  readings[6].measured_rad += 200.0 * units::deg;
  readings[7].measured_rad += 300.0 * units::deg;
  const Eigen::VectorXd error_rad = measure::CompareAngles(readings).error_rad;
  EXPECT_NEAR(error_rad[4], 170.0 * units::deg, 1e-12);
  EXPECT_NEAR(error_rad[8], 170.0 * units::deg, 1e-12) << "360 deg more without the level before";
}

/// What a walk and another shape make against each other is in neither of them, and no word of it stays.
TEST(EncoderWalk, SaysNothingOfAShapeThatItTakesBack) {
  Noise step_deg(0.05, 3);
  double walk_deg = 0.0;
  const Record record =
      Listed({0.0, 0.06, 600, 1, 0.1}, [&](const Place& at) { return at.deg + (walk_deg += step_deg()); });
  DiagnosisRun result;
  result.run = RunOf(record.readings, record.Believed()).run;
  const Eigen::VectorXd shape = Eigen::VectorXd::LinSpaced(600, 0.0, 6.0).array().cos();
  result.accepted = {test::TermOf("", shape, 5.0 * units::deg, Kind::kUnknown)};
  result.accepted[0].family.describe = [](int, const auto&, const auto&) { return std::string("by the speed"); };
  result.diagnosis.unknown.signature = "by the speed";
  TellWander({}, result);
  EXPECT_THAT(result.diagnosis.unknown.signature,
              testing::AllOf(HasSubstr("random walk"), testing::Not(HasSubstr("speed"))));
}

// Tables by which a stepper's driver corrects its encoder: one turn, an angle of two decimals for every count of 14
// bits, without a clock, between 200 steps that were measured. The motor began at another angle than it ended at,
// and is bent there.

/// @param jump_deg  Where the table of the motor begins and ends, and dies away on either side.
Record TableOfCounts(const std::vector<Wave>& waves, double jump_deg, double noise_deg, unsigned seed) {
  Noise noise(noise_deg, seed);
  std::vector<double> step_deg;
  for (int k = 0; k < 200; ++k) {
    const double x = std::remainder(1.8 * k - 358.2, 360.0);
    step_deg.push_back(std::copysign(0.5 * jump_deg * std::exp(-std::abs(x) / 4.0), x) + noise());
  }
  return Listed({170.7, 360.0 / 16384.0, 16384}, [&](const Place& at) {
    const double steps = (at.deg - 170.7) / 1.8, k = std::floor(steps);
    const double before_deg = step_deg[static_cast<std::size_t>(k) % 200],
                 behind_deg = step_deg[(static_cast<std::size_t>(k) + 1) % 200];
    const double shown_deg = at.deg + Sum(waves, at.deg) + before_deg + (steps - k) * (behind_deg - before_deg);
    return 0.01 * std::round(shown_deg / 0.01);
  });
}

Row OfTable(const std::string& name, const std::vector<Wave>& waves, double jump_deg) {
  std::vector<Check> checks = {NotNamed({"slip", "scale"}), IsNot(Verdict::kUnknown)};
  for (const Wave& w : waves) checks.push_back(Order(w.order, w.size_deg, 0.02 * w.size_deg + 0.002));
  return {name, [=](unsigned seed) { return TableOfCounts(waves, jump_deg, 0.006, seed); }, checks, {5, 4, 7, 1}};
}

const std::vector<Wave> kOfMotor = {{1, 0.142, 75.0},    {2, 0.186, 264.0},   {4, 0.044, 259.0},
                                    {48, 0.0146, 162.0}, {50, 0.0156, 343.0}, {100, 0.009, 331.0}};

const Row kTables[] = {OfTable("ATableOfOneTurnIsItsOrdersBesideATransientWhereItBegan", kOfMotor, 0.1),
                       OfTable("ATableOfLargeErrorsHasNoScaleAndNoSlipWhereItCloses",
                               {{1, 0.84, 310.0}, {2, 0.207, 1.0}, {3, 0.057, 236.0}}, 0.3)};
INSTANTIATE_TEST_SUITE_P(Tables, EncoderAnswer, testing::ValuesIn(kTables), NameOfRow);

/// Orders that are not in the table of twelve lie across groups of readings, and not across all of them.
TEST(EncoderOrders, AreThoseOfAllReadingsWhereSomeWereLookedAt) {
  Noise noise(0.002, 6);
  const std::vector<Wave> waves = {{1, 0.1, 20.0}, {3, 0.03, 200.0}, {50, 0.06, 10.0}, {100, 0.03, 80.0}};
  const Answer answer = Ask(Listed({0.3, 0.06, 6000, 1, 0.01, "sweep"},
                                   [&](const Place& at) { return at.deg + Sum(waves, at.deg) + noise(); }));
  const std::vector<Harmonic>& table = answer.run.diagnosis.harmonics;
  ASSERT_EQ(table.size(), 12U);
  for (const Harmonic& h : table)
    EXPECT_NEAR(h.amplitude_rad / units::deg, h.order == 1 ? 0.1 : h.order == 3 ? 0.03 : 0.0, 0.0003) << h.order;
}

/// Looked at in groups, the table's steps have no line that stands out.
TEST(EncoderWalk, IsNotWhatAFewOrdersOfATurnShow) {
  const Record table = TableOfCounts(kOfMotor, 0.1, 0.03, 5);
  EXPECT_FALSE(IsNothingButWalk(RunOf(PartOf(table.readings, {.enough = 2500}), table.Believed()).run));
  for (const unsigned seed : {1U, 2U, 3U}) {
    Noise step_deg(0.004, seed);
    double walk_deg = 0.0;
    const Record walk =
        Listed({0.0, 0.15, 2400}, [&](const Place& at) { return at.deg + (walk_deg += step_deg()); });
    EXPECT_TRUE(IsNothingButWalk(RunOf(walk.readings, walk.Believed()).run)) << seed;
  }
}

}  // namespace
}  // namespace twinbench::diagnose::encoder
