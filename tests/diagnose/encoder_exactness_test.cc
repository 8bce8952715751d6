#include "tests/diagnose/encoder_record.h"

namespace twinbench::diagnose::encoder {
namespace {

using namespace lab;
using testing::HasSubstr, testing::IsEmpty, testing::Not;

// How far a formula, a walk or a sum of waves may be believed. Closed forms.

/// Of what has no name; NaN if these words are not there.
double AmplitudeBehind(const std::string& words, const Answer& answer) {
  const std::string& signature = answer.run.diagnosis.unknown.signature;
  const std::size_t at = signature.find(words);
  return at == std::string::npos ? kNaN : std::stod(signature.substr(at + words.size()));
}

/// Random levels that go over into each other.
struct Knots {
  Knots(int count, double deviation_deg, Noise& normal) {
    for (int k = 0; k < count; ++k) deg.push_back(deviation_deg * normal());
  }
  double At(double at) const {
    const double share = 0.5 * (1.0 - std::cos(units::kPi * (at - std::floor(at))));
    return std::lerp(deg[static_cast<std::size_t>(at)], deg[static_cast<std::size_t>(at) + 1], share);
  }
  std::vector<double> deg;
};
constexpr const char* kCurveOfAPart = "error curve over a part of a turn";

Rows ExactnessRows() {
  Rows rows;
  for (const double size_deg : {1.2, 2.4}) {  // one mounting tells no eccentricity from an offset
    rows.push_back(OfCourse(fmt::format("AWaveIsNoLessAnOffsetOfTheSignalsForBeingOne_{}", std::round(size_deg)),
                            {0.9, 1.8, 200, 2}, 0.01,
                            Of({{1, size_deg, 40.0}}),
                            {Is(Verdict::kTie), HasCauses(2), kSilentAgain}, {4}));
  }
  for (const double between_deg : {0.0, 1.3}) {
    const bool were_others_there = between_deg == 0.0;
    rows.push_back({fmt::format("ASingleFarReadingThatNoOtherPassCheckedMayBeOfItsPlace_{}", were_others_there),
                    [=](unsigned seed) {
                      Noise noise_deg(0.002, seed);
                      Record record = Listed({0.0, 3.6, 200, 4, 0.1, "sweep"}, [&](const Place& at) {
                        return at.deg + noise_deg() + (std::lround(10.0 * at.t_s) == 333 ? 0.04 : 0.0);
                      });
                      for (Reading& r : record.readings)
                        for (double* rad : {&r.reference_rad, &r.measured_rad})
                          *rad += between_deg * r.pass * units::deg;
                      return record;
                    },
                    {Named("outliers", 0.5), were_others_there ? Named("outliers") : NotNamed({"outliers"}, 0.8),
                     were_others_there ? Says(IsEmpty()) : Says(Not(IsEmpty())), kSilentAgain},
                    {18}});
  }
  return rows;
}
INSTANTIATE_TEST_SUITE_P(Exactness, EncoderAnswer, testing::ValuesIn(ExactnessRows()), NameOfRow);

constexpr Swing kFollowed{100.0, 6.0};

const Row kExact[] = {
    {"AFollowerThatIsLateToFirstOrderHasNoWrongScale",  // r - tau v: a delay, less its second order, which is like
                                                        // a scale
     [](unsigned seed) {
       const double w = 2.0 * units::kPi / kFollowed.period_s;
       return Swung(kFollowed, 0.0, 12.0, 0.02, 0.04, seed, [&](double t_s) {
         return kFollowed.At(t_s) - 0.03 * 0.5 * kFollowed.range_deg * w * std::sin(w * t_s);
       });
     },
     {HasCauses(1), Size("latency", "delay", 0.03, 0.0, 4.0), kSilentAgain},
     {1, 2, 3}},
    {"ACurveByTheAngleThatIsShownIsNoWalk",  // of orders 1 and 2 by the shown angle, orders 1 to 4 by the shaft's
     [](unsigned) {
       return Listed({0.0, 1.8, 200}, [](const Place& at) {
         double error_deg = 0.0;
         for (int step = 0; step < 20; ++step) {
           const double shown = (at.deg + error_deg) * units::deg;
           error_deg = 0.55 * std::cos(shown + 3.7) + 0.42 * std::cos(2.0 * shown + 3.3);
         }
         return at.deg + std::round(error_deg * 65536.0 / 360.0) * 360.0 / 65536.0;
       });
     },
     {Says(Not(HasSubstr("walk"))), Size("eccentricity", "amplitude", 0.55, 0.01), kSilentAgain}},
    OfCourse("WhatAlternatesWithTheDirectionHasTheSizeThatItShows", {1.8, 1.8, 200, 2}, 0.01,
             Of({{1, 0.9, 0.0}}) + [](const Place& at) { return at.stop % 2 == at.pass % 2 ? 0.1 : -0.1; },
             {Says(HasSubstr("direction times order 100")), kSilentAgain,
              [](const Answer& a) { EXPECT_NEAR(AmplitudeBehind("angle, amplitude ", a), 0.1, 0.003); }},
             {6, 7}),
    {"ASlowCourseBesideLargeCausesIsToldAndWritten",  // what follows the square of a temperature of the room
     [](unsigned seed) {
       return Stops(0.002, 0.0, seed, [](const Place& at) {
         const double room_K = std::sin(at.t_s / 300.0) + 0.4 * std::sin(at.t_s / 90.0 + 1.0);
         return (at.t_s < 1100.0 ? 0.0 : 0.01) + Sum({{2, 0.007, 0.0}}, at.deg) + 0.0025 * room_K * room_K;
       });
     },
     {Named("ellipticity", 0.0), Says(HasSubstr("function of time")), kSilentAgain},
     {21, 22}},
    {"OffsetsOfPassesHideNoReversal",  // 9 targets of a stage, five times there and back, while its zero goes on
                                       // from pass to pass
     [](unsigned seed) {
       Noise normal(1.0, seed);
       std::vector<double> curve_deg(9), pass_deg(10);
       for (double& c : curve_deg) c = 0.02 * normal();
       for (int k = 0; k < 10; ++k)
         pass_deg[static_cast<std::size_t>(k)] = 0.01 * (1.0 - 0.1 * k) + 0.0006 * normal();
       return Listed({-20.0, 5.0, 9, 10}, [&](const Place& at) {
         return at.deg + curve_deg[static_cast<std::size_t>(at.stop)] +
                pass_deg[static_cast<std::size_t>(at.pass)] - 0.0065 * at.direction + 0.0015 * normal();
       });
     },
     {[](const Answer& a) { EXPECT_TRUE(a.Names("backlash", 0.5) || a.Names("hysteresis", 0.5)); },
      Size("backlash", "width", 0.013, 0.002)},  // offsets of ten passes are a little like it
     {11, 12, 13}},
    // Of which a part is looked at.
    OfCourse("AStepInALongRecordingIsWhereItIs", {0.0, 0.2, 5000, 1, 0.01, "sweep"}, 0.0005,
             Of({{1, 0.01, 0.0}}) + [](const Place& at) { return at.stop < 2893 ? 0.0 : 0.03; },
             {Named("slip"), Size("slip", "at_reading", 2893.0, 1.0), NotNamed({"outliers"})}, {21}),
    {"ACurveOverAPartOfATurnIsNoSumOfOrders",
     [](unsigned seed) {
       Noise normal(1.0, seed);
       const Knots knots(30, 0.05, normal);
       return Listed({12.0, 0.1, 450},
                     [&](const Place& at) { return at.deg + knots.At(at.stop / 16.0) + 0.001 * normal(); });
     },
     {Is(Verdict::kUnknown), NotNamed({"periodic"}, 0.0), Says(HasSubstr(kCurveOfAPart))},
     {15, 16}},
    {"AWormIsNoPieceOfACurve",
     [](unsigned seed) {
       Noise normal(1.0, seed);
       const Knots knots(17, 0.01, normal);
       return Listed({12.0, 45.0 / 800.0, 800}, [&](const Place& at) {
         return at.deg + knots.At(at.stop / 50.0) + Sum({{400, 0.004, 0.0}}, at.deg) + 0.0003 * normal();
       });
     },
     {Size("periodic", "order", 400.0, 0.0), Size("periodic", "amplitude", 0.004, 0.0001),
      Says(HasSubstr(kCurveOfAPart))},
     {17}}};
INSTANTIATE_TEST_SUITE_P(Exact, EncoderAnswer, testing::ValuesIn(kExact), NameOfRow);

TEST(EncoderExactness, AWalkHasTheSizeThatTheReadingsShowAndNoOtherName) {
  constexpr Swing kWheel{360.0, 40.0};
  for (const unsigned seed : Seeds({8u, 9u})) {
    Noise step_deg(0.004, seed);
    std::vector<double> walk_deg;
    const Answer answer = Ask(Swung(kWheel, 0.0, 15.0, 0.01, 0.005, seed, [&](double t_s) {
      walk_deg.push_back((walk_deg.empty() ? 0.0 : walk_deg.back()) + step_deg());
      return kWheel.At(t_s) + walk_deg.back();
    }));
    const Eigen::Map<const Eigen::ArrayXd> walk(walk_deg.data(), std::ssize(walk_deg));
    const double amplitude_deg = std::sqrt(2.0 * (walk - walk.mean()).square().mean());
    SCOPED_TRACE(answer.Words());
    EXPECT_NEAR(AmplitudeBehind("random walk, function of time, on angle, amplitude ", answer), amplitude_deg,
                0.25 * amplitude_deg)
        << "some of it may be like a cause";
    NoneFrom(0.5)(answer);
  }
}

/// A column that a program computed from the other one has rounding, which repeats, and no errors.
TEST(EncoderExactness, WhatIsComputedHasNoCause) {
  Record record;
  for (int k = 0; k < 400; ++k) record.Add(0.1 * k, 0.9 * k, 0.9 * k + 3e-13 * std::cos(12.0 * 0.9 * k * units::deg), 1, 0);
  const Answer answer = Ask(record);
  EXPECT_EQ(answer.run.diagnosis.verdict, Verdict::kNone) << answer.Words();
  EXPECT_THAT(answer.run.diagnosis.notes, testing::Contains(HasSubstr("computed")));
}

/// A degree of this axis is a millimetre.
TEST(EncoderExactness, OfALinearAxisIsToldInLengths) {
  constexpr double kRate_mm_h = 0.6;
  const Error drift_deg = [](const Place& at) { return kRate_mm_h * at.t_s / 3600.0; };
  const Record record = Listed({0.0, 1.8, 200, 2, 5.0, "sweep"}, 0.002, 5, Of({{9, 0.05, 0.0}}) + drift_deg);
  Scenario believed = record.Believed();
  EncoderOf(believed).device.turn_m = 0.36;
  const Diagnosis found = Diagnosed(record, believed).diagnosis;
  const auto drift = std::ranges::find(found.causes, "drift", &Cause::effect);
  ASSERT_NE(drift, found.causes.end());
  EXPECT_EQ(drift->parameters.front().unit, "mm_per_h");
  EXPECT_NEAR(drift->parameters.front().value / drift->parameters.front().to_SI, kRate_mm_h, 0.02);
  EXPECT_THAT(found.notes, testing::Contains(HasSubstr("a period of 40 mm")));
}

}  // namespace
}  // namespace twinbench::diagnose::encoder
