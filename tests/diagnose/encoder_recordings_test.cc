#include "tests/diagnose/encoder_record.h"
#include "twin/benches/encoder_comparison/estimators/angle_comparison.h"

namespace twinbench::diagnose::encoder {
namespace {

using namespace lab;
using testing::HasSubstr;

// What recordings of others have beside a cause: glitches, a part of a turn, targets of a stage. Closed forms.

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
      [=](const Place& at) {
        return Sum({{order, 0.01, 75.0}}, at.deg);
      },
      {HasCauses(1), Size("periodic", "order", order, 0.1 * 360.0 / travel_deg),  // of what the travel resolves
       Size("periodic", "amplitude", 0.01, 0.0005), kSilentAgain},
      {5});
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
             [](const Place& at) {
               return Sum({{1, 1.8, 20.0}, {2, 0.5, -80.0}, {4, 0.07, 130.0}}, at.deg);
             },
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
     {7}}};
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

}  // namespace
}  // namespace twinbench::diagnose::encoder
