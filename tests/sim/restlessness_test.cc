#include "twin/sim/restlessness.h"

#include "tests/support/kept_text.h"
#include "tests/support/rotary_scenario.h"
#include "twin/benches/rotary_4dof/twin/table_stack.h"

namespace twinbench::sim {
namespace {

using units::um, units::arcsec;

Scenario Bodies(const std::string& fidelity) { return Altered(Quiet(), {"mechanics.fidelity=" + fidelity}); }

TEST(VibrationCriterion, HasThePublishedVelocities) {
  for (const auto& [name, velocity_um_s] : {std::pair{"VC-A", 50.0},
                                            {"VC-B", 25.0}, {"VC-C", 12.5}, {"VC-D", 6.25}, {"VC-E", 3.12},
                                            {"VC-F", 1.56}, {"VC-G", 0.78}}) {
    for (const VibrationBand& band : VibrationCriterion(name)) {
      if (band.centre_Hz > 7.9) {
        EXPECT_DOUBLE_EQ(band.velocity_m_s, velocity_um_s * um) << name;
      }
      EXPECT_LT(band.centre_Hz, 90.0);
    }
  }
  // A and B: 260 and 130 ug between 4 and 8 Hz, so twice the velocity at 4 Hz.
  const VibrationBand lowest = VibrationCriterion("VC-A").front();
  EXPECT_NEAR(2.0 * units::kPi * lowest.centre_Hz * lowest.velocity_m_s, 260e-6 * 9.81, 0.03 * 260e-6 * 9.81);
  EXPECT_NEAR(VibrationCriterion("VC-G").front().centre_Hz, 1.0, 1e-12);
  EXPECT_THROW(VibrationCriterion("VC-H"), std::invalid_argument);
}

TEST(BaseVibration, HasTheStatedVelocityInEveryBandAndDirection) {
  const std::vector<VibrationBand> bands = VibrationCriterion("VC-D");
  const BaseVibration vibration(bands, 7);
  for (const VibrationBand& band : bands) {
    Eigen::Vector3d square = Eigen::Vector3d::Zero();
    for (const BaseVibration::Line& line : vibration.lines()) {
      if (std::abs(std::log10(line.frequency_Hz / band.centre_Hz)) > 0.05) continue;
      const double rate_rad_s = 2.0 * units::kPi * line.frequency_Hz;
      square += 0.5 * (line.acceleration_m_s2 / rate_rad_s).cwiseAbs2();
    }
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(std::sqrt(square[axis]), band.velocity_m_s, 1e-12);
  }
  EXPECT_NE(BaseVibration(bands, 8).lines()[0].acceleration_m_s2, vibration.lines()[0].acceleration_m_s2);
}

TEST(ShakenStack, SwaysAtRestAsItsAnswersAndTheSpectrumSay) {
  for (const std::string fidelity : {"kinematic", "linear", "bullet"}) {
    const Scenario s = Altered(Bodies(fidelity), {"mechanics.vibration=listed", "mechanics.vibration_frequency_Hz=[10, 63]",
                                                  "mechanics.vibration_velocity_um_s=[20, 5]"});
    EventQueue queue;
    Axes axes(RotaryTableStack(s), queue);
    double expected = 0.0;  // mean square of the target's radial deflection along x
    const mechanics::StackParameters stack = StackOf(RotaryTableStack(s));
    const BaseVibration vibration(VibrationOf(RotaryOf(s).mechanics), s.seed);
    for (const BaseVibration::Line& line : vibration.lines()) {
      const auto response = mechanics::RespondToBase(stack, line.frequency_Hz);
      expected += 0.5 * std::norm((response.row(0) * line.acceleration_m_s2).value());
    }
    double found = 0.0;
    constexpr int kLooks = 20000;
    for (int i = 0; i < kLooks; ++i) {
      queue.RunUntil(Time{} + std::chrono::microseconds(1370) * i);  // 27 s: 100 beats of lines 4 Hz apart
      const double x_m = axes.Look().target_bearing.x_m;
      found += x_m * x_m / kLooks;
    }
    EXPECT_NEAR(found / expected, 1.0, 0.05) << fidelity;
    EXPECT_GT(std::sqrt(expected), 0.5e-9);
  }
}

TEST(ShakenStack, IsTheSameHoweverTimeIsCut) {
  const Scenario s =
      Altered(Bodies("bullet"), {"mechanics.vibration=VC-C", "mechanics.payload_mass_kg=1.5", "mechanics.payload_radius_mm=40"});
  std::vector<double> found_m;
  for (const int looks : {1, 13, 700}) {
    EventQueue queue;
    Axes axes(RotaryTableStack(s), queue);
    axes.StartMove(mechanics::Axis::kTarget, 0.1);
    for (int i = 1; i <= looks; ++i) {
      queue.RunUntil(Time{} + std::chrono::milliseconds(1500) * i / looks);
      axes.Look();
    }
    found_m.push_back(axes.Look().reference_bearing.y_m);
  }
  EXPECT_EQ(found_m[0], found_m[1]);
  EXPECT_EQ(found_m[0], found_m[2]);
}

TEST(ShakenStack, TurnsWithTheReferencesBodyAndNotWithoutAPayload) {
  // The floor pushes along x of the laboratory; the reference's body has turned with the target by a quarter.
  Scenario s = Bodies("kinematic");
  const mechanics::StackParameters stack = StackOf(RotaryTableStack(s));
  ShakenStack shaken(stack, BaseVibration({{20.0, 50.0 * um}}, 3));
  mechanics::StackState straight, turned;
  turned.target_rad = 0.5 * units::kPi;
  const Time when = Time{} + std::chrono::milliseconds(1234);
  shaken.AddTo(straight, when);
  shaken.AddTo(turned, when);
  const mechanics::BearingPose &a = straight.reference_bearing, &b = turned.reference_bearing;
  EXPECT_NEAR(straight.target_bearing.x_m, turned.target_bearing.x_m, 1e-20);
  EXPECT_NEAR(b.x_m, a.y_m, 1e-9 * std::hypot(a.x_m, a.y_m));
  EXPECT_NEAR(b.y_m, -a.x_m, 1e-9 * std::hypot(a.x_m, a.y_m));
  EXPECT_GT(std::hypot(a.x_m, a.y_m), 1e-10);
}

TEST(Restlessness, ShakesBodiesByBulletUnlessToldOtherwise) {
  MechanicsSettings m;
  m.vibration = "auto";
  EXPECT_TRUE(VibrationOf(m).empty());
  m.fidelity = "bullet";
  EXPECT_EQ(VibrationOf(m).size(), VibrationCriterion("VC-E").size());
  m.vibration = "none";
  EXPECT_TRUE(VibrationOf(m).empty());
}

TEST(AsynchronousMotion, HasTheStatedSizeOverManyTurnsAndRepeatsInNone) {
  const AsynchronousMotion motion({0.1 * um, 0.02 * um, 0.05 * arcsec}, 5, "target");
  std::array<double, 5> square{};
  double repeated_m = 0.0;  // the part that averages at the same angle of 200 turns
  constexpr int kTurns = 200, kAngles = 90;
  for (int k = 0; k < kAngles; ++k) {
    double mean_m = 0.0;
    for (int turn = 0; turn < kTurns; ++turn) {
      const mechanics::BearingPose at = motion.At(2.0 * units::kPi * (turn + 1.0 * k / kAngles));
      const std::array<double, 5> value = {at.x_m, at.y_m, at.z_m, at.rx_rad, at.ry_rad};
      for (std::size_t m = 0; m < 5; ++m) square[m] += value[m] * value[m] / (kTurns * kAngles);
      mean_m += at.x_m / kTurns;
    }
    repeated_m = std::max(repeated_m, std::abs(mean_m));
  }
  // 24 waves, nowhere nearer than 0.15 of an order to one another's alias: 30 beats in 200 turns.
  const std::array<double, 5> stated = {0.1 * um, 0.1 * um, 0.02 * um, 0.05 * arcsec, 0.05 * arcsec};
  for (std::size_t m = 0; m < 5; ++m) EXPECT_NEAR(std::sqrt(square[m]) / stated[m], 1.0, 0.05) << m;
  EXPECT_LT(repeated_m, 0.1 * 0.1 * um);
}

}  // namespace
}  // namespace twinbench::sim
