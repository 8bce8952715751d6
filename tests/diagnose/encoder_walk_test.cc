#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/diagnose/encoder_fit.h"
#include "tests/diagnose/encoder_record.h"
#include "twin/benches/encoder_comparison/diagnosis/wander.h"
#include "twin/core/reading_clock.h"

namespace twinbench::diagnose::encoder {
namespace {

using namespace lab;

// What repeats and what does not: play beside friction that remembers, tables of one turn, a drift that bends.

struct JointCourse {
  int readings = 2400;
  double every_s = 0.04, settles_deg = 0.0;
};

/// A joint that swings by two frequencies, which grow and die away, with a gap and friction of some memory.
Record Joint(double gap_deg, double noise_deg, double memory_s, bool is_walk, unsigned seed, const JointCourse& course = {}) {
  const double end_s = course.readings * course.every_s;
  Noise unit(1.0, seed);
  const double kept = is_walk ? 1.0 : std::exp(-course.every_s / memory_s), new_deg = noise_deg * (is_walk ? 1.0 : std::sqrt(1.0 - kept * kept));
  Record record;
  double last_deg = 0.0, shaft_deg = 0.0, behind_deg = 0.0, friction_deg = 0.0;
  int direction = 1, pass = 0;
  for (int k = 0; k < course.readings; ++k) {
    const double t_s = course.every_s * k, swell = std::pow(std::clamp(std::min(t_s, end_s - t_s) / (0.4 * end_s), 0.0, 1.0), 2);
    const double angle_deg = swell * (24.0 * std::sin(2.0 * units::kPi * 0.041 * t_s) + 15.0 * std::sin(2.0 * units::kPi * 0.063 * t_s + 0.7));
    shaft_deg = std::clamp(shaft_deg, angle_deg - 0.5 * gap_deg, angle_deg + 0.5 * gap_deg);
    const double settled = course.settles_deg > 0.0 ? 1.0 - std::exp(-std::abs(angle_deg - last_deg) / course.settles_deg) : 1.0;
    behind_deg += settled * (shaft_deg - behind_deg);
    friction_deg = kept * friction_deg + new_deg * unit();
    const int sense = angle_deg < last_deg ? -1 : 1;
    if (sense != direction) ++pass;
    direction = sense;
    last_deg = angle_deg;
    record.Add(t_s, angle_deg, behind_deg + friction_deg, direction, pass);
  }
  return record;
}

/// Four fifths of the variance are play: a walk may follow all of it, and is not asked first.
TEST(EncoderWalk, TakesNothingOfPlayBesideFrictionThatRemembers) {
  for (const unsigned seed : Seeds({1u, 2u, 4u})) {
    const Answer answer = Ask(Joint(3.6, 0.8, 0.35, false, seed));
    SCOPED_TRACE(answer.Words());
    EXPECT_TRUE(answer.Names("backlash"));
    EXPECT_NEAR(answer.Value("backlash", "width"), 3.6, 0.6);
    EXPECT_EQ(answer.run.diagnosis.verdict, Verdict::kNamed);
  }
}

/// Play that is gone through with a course of its own is neither of the catalogue's loops, and not both of them.
TEST(EncoderWalk, NamesOneLoopOfPlayWithACourseOfItsOwn) {
  for (const unsigned seed : Seeds({9u, 13u, 14u, 29u})) {
    const Answer answer = Ask(Joint(5.3, 0.6, 0.6, false, seed, {900, 0.1, 2.0}));
    EXPECT_NE(answer.Names("backlash", 0.5), answer.Names("hysteresis", 0.5)) << answer.Words();
  }
}

TEST(EncoderWalk, OfAJointWithoutPlayIsNoPlay) {
  for (const unsigned seed : Seeds({11u, 12u, 13u})) {
    const Answer answer = Ask(Joint(0.0, 0.06, 0.0, true, seed));
    EXPECT_FALSE(answer.Names("backlash", 0.5) || answer.Names("hysteresis", 0.5)) << answer.Words();
  }
}

/// What a walk and another shape make against each other is in neither of them, and no word of it stays.
TEST(EncoderWalk, SaysNothingOfAShapeThatItTakesBack) {
  Noise step_deg(0.05, 3);
  Record record;
  double walk_deg = 0.0;
  for (int k = 0; k < 600; ++k) record.Add(0.1 * k, 20.0 * std::sin(0.01 * k), 20.0 * std::sin(0.01 * k) + (walk_deg += step_deg()), 1, 0);
  DiagnosisRun result;
  result.run = RunOf(record.readings, record.Believed()).run;
  Accepted& shape = result.accepted.emplace_back();
  shape.family.kind = Kind::kUnknown;
  shape.family.describe = [](int, const Eigen::VectorXd&, const Eigen::VectorXd&) { return std::string("by the speed"); };
  shape.columns = Eigen::VectorXd::LinSpaced(600, 0.0, 6.0).array().cos().matrix();
  shape.amplitudes = Eigen::VectorXd::Constant(1, 5.0 * units::deg);
  result.diagnosis.unknown.signature = "by the speed";
  TellWander({}, result);
  EXPECT_THAT(result.diagnosis.unknown.signature, testing::AllOf(testing::HasSubstr("random walk"), testing::Not(testing::HasSubstr("speed"))));
}

}  // namespace
}  // namespace twinbench::diagnose::encoder
