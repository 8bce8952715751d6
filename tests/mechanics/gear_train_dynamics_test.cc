#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <functional>
#include <vector>

#include "tests/mechanics/gear_train_runs.h"

// What the bodies do: servos, torsion, inertia. Expected values are the linear systems' transfer functions.
namespace twinbench::mechanics {
namespace {

using Complex = std::complex<double>;

/// C of Re C exp(j 2 pi f t) in `value` over `time_s`, a whole number of its periods. t is the train's time.
Complex Line(GearTrain& train, double f_Hz, double time_s,
             const std::function<double(const GearTrainState&)>& value) {
  const int samples = static_cast<int>(std::lround(time_s / 1e-3));
  Complex sum = 0.0;
  for (int i = 0; i < samples; ++i) {
    const GearTrainState s = train.State();
    sum += value(s) * std::polar(2.0 / samples, -2.0 * kPi * f_Hz * s.time_s);
    train.Advance(1e-3);
  }
  return sum;
}

/// The same of the transmission error [arcsec], at constant speed.
Complex ErrorLine_arcsec(const GearTrainParameters& p, double hob_speed_rad_s, double f_Hz, double time_s) {
  const auto train = Steady(Fidelity::kBullet, p, hob_speed_rad_s);
  return Line(*train, f_Hz, time_s, [&](const GearTrainState& s) { return TransmissionError_rad(p, s) / kArcsec; });
}

/// H of PositionLoop's header.
Complex ServoResponse(const DriveParameters& drive, double f_Hz) {
  const double w = 2.0 * kPi * drive.servo_Hz;
  const Complex s(0.0, 2.0 * kPi * f_Hz);
  return 5.0 * w * (s + w) * (w + drive.feed_forward * s) /
         (s * s * s + 5.0 * w * s * s + 10.0 * w * w * s + 5.0 * w * w * w);
}

/// Table over wheel.
Complex Torsion(const GearTrainParameters& p, double f_Hz) {
  const double omega = 2.0 * kPi * f_Hz, k = p.stiffness_Nm_rad, inertia = p.table_inertia_kg_m2;
  const Complex push(k, omega * 2.0 * p.damping_ratio * std::sqrt(k * inertia));
  return push / (push - inertia * omega * omega);
}

TEST(GearTrain, ServoPassesErrorsOfTheMachinesEncoderByItsTransferFunction) {
  for (const double feed_forward : {0.0, 1.0}) {
    for (const double f_Hz : {2.0, 8.0, 20.0}) {
      GearTrainParameters p = Frictionless();
      p.motor.feed_forward = feed_forward;
      p.motor.inertia_kg_m2 = 10.0;  // 4000 times the table's at the motor: the table's reaction does not count
      p.servo_period_s = 0.1e-3;
      p.errors.hob_encoder = {{f_Hz, 10.0 * kArcsec, 0.0}};  // at one turn of the hob a second
      const Complex line = ErrorLine_arcsec(p, 2.0 * kPi, f_Hz, 2.0);
      // The hob's angle is 2 pi (t - ramp / 2): whole turns behind t.
      const Complex expected = 10.0 * ServoResponse(p.motor, f_Hz) * Torsion(p, f_Hz);
      const double held = 2.0 * kPi * f_Hz * p.servo_period_s;  // commands are held for a period: as if later by it
      EXPECT_LT(std::abs(line - expected), 10.0 * held + 0.002) << f_Hz << " Hz, " << feed_forward;
    }
  }
}

/// Table over error of the gears, with a motor that gives way as far as its servo lets it.
Complex TableOverGears(const GearTrainParameters& p, double f_Hz) {
  const double w = 2.0 * kPi * p.motor.servo_Hz, worm = p.WormRatio();
  const Complex s(0.0, 2.0 * kPi * f_Hz);
  const Complex push =
      p.stiffness_Nm_rad + s * 2.0 * p.damping_ratio * std::sqrt(p.stiffness_Nm_rad * p.table_inertia_kg_m2);
  const Complex table = p.table_inertia_kg_m2 * s * s;
  const Complex motor = worm * worm * p.motor.inertia_kg_m2 * (s * s + 5.0 * w * (s + w) * (s + w) / s);
  return push / (1.0 + push * (1.0 / motor + 1.0 / table)) / table;
}

TEST(GearTrain, MotorGivesWayToTheTable) {
  for (const double f_Hz : {5.0, 20.0, 50.0}) {
    GearTrainParameters p = Frictionless();
    p.motor.inertia_kg_m2 = 0.004;  // at the table 32 kg m^2 beside its 20
    p.motor.servo_Hz = 2.0;
    p.servo_period_s = 0.1e-3;
    p.errors.worm = {{1.0, 2.0 * kArcsec, 0.0}};
    const Complex line = ErrorLine_arcsec(p, 2.0 * kPi * f_Hz / p.WormRatio() / p.ratio, f_Hz, 1.0);
    const Complex expected = 2.0 * TableOverGears(p, f_Hz);
    // A step of 0.1 ms puts the torsion's frequency off by some 1e-4 and the damper's speed 0.05 ms early.
    EXPECT_LT(std::abs(line - expected), 5e-3 * std::abs(expected)) << f_Hz;
    EXPECT_GT(std::abs(expected - 2.0 * Torsion(p, f_Hz)), 0.3);
  }
}

TEST(GearTrain, TakesStepsThatItsStiffestModeAllows) {
  for (const double times : {10.0, 1000.0}) {
    GearTrainParameters p;
    p.stiffness_Nm_rad *= times;  // 1000: omega h = 17 at the servo's period, where the leapfrog's limit is 2
    const auto train = Steady(Fidelity::kBullet, p);
    const GearTrainState s = train->State();
    EXPECT_NEAR(s.wheel_rad - s.table_rad, 100.0 / p.stiffness_Nm_rad, 1e-5 * kArcsec) << times;
  }
}

TEST(GearTrain, TableSwingsAtTheFrequencyOfItsTorsionAndKeepsItsEnergy) {
  GearTrainParameters p = Frictionless();
  p.damping_ratio = 0.0;
  p.motor.inertia_kg_m2 = 1e5;  // at the table 8.1e8 kg m^2: neither speeds the table up nor damps it by its servo
  p.step_s = 0.1e-3;
  auto train = MakeGearTrain(Fidelity::kBullet, p);
  train->Run(1.0, 5e-3);
  train->Advance(2.0);
  std::vector<double> rises_s;
  double first_rad = 0.0, last_rad = 0.0;
  GearTrainState a = train->State();
  for (int i = 0; i < 10000; ++i) {
    train->Advance(1e-3);
    const GearTrainState b = train->State();
    const double from = a.wheel_rad - a.table_rad, to = b.wheel_rad - b.table_rad;
    if (from < 0.0 && to >= 0.0) rises_s.push_back(a.time_s + 1e-3 * from / (from - to));
    double& peak_rad = i < 5000 ? first_rad : last_rad;
    peak_rad = std::max(peak_rad, std::abs(to));
    a = b;
  }
  const double f_Hz = static_cast<double>(rises_s.size() - 1) / (rises_s.back() - rises_s.front());
  const double expected_Hz = std::sqrt(5e6 / 20.0) / (2.0 * kPi);
  // Leapfrog: (omega h)^2 / 24 = 1e-4 too fast; the crossings at the ends are interpolated to 0.1 ms of 10 s.
  EXPECT_NEAR(f_Hz / expected_Hz, 1.0 + 1.04e-4, 2e-5);
  EXPECT_GT(first_rad, 0.1 * kArcsec);
  // Energy goes with the square. 12.6 samples a period find the peak to a part in 10^4 within seconds.
  EXPECT_NEAR(last_rad / first_rad, 1.0, 1e-3);
}

}  // namespace
}  // namespace twinbench::mechanics
