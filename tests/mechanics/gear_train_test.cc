#include "mechanics/gear_train.h"

#include "tests/mechanics/plant_runs.h"

namespace twinbench::mechanics {
namespace {

// Machines and runs that the tests of the gear train share.

constexpr Fidelity kBoth[] = {Fidelity::kKinematic, Fidelity::kBullet};
constexpr double kHobSpeed_rad_s = 50.0 * 2.0 * kPi / 60.0;
constexpr double kRamp_s = 2.0;

/// No friction, and drives that do not lag: what is left are the gears.
GearTrainParameters Frictionless() {
  GearTrainParameters p;
  p.friction.coulomb_Nm = 0.0;
  p.hob.feed_forward = p.motor.feed_forward = 1.0;
  return p;
}

GearErrors SomeErrors() {
  return {.worm_wheel = {{1.0, 8.0 * kArcsec, 0.3}, {2.0, 1.0 * kArcsec, -0.5}},
          .worm = {{1.0, 2.0 * kArcsec, 0.7}}, .tooth_mesh = {{2.0, 0.5 * kArcsec, 2.0}},
          .hob_drive = {{1.0, 3.0 * kArcsec, 1.1}}};
}

double TransmissionError_rad(const GearTrainParameters& p, const GearTrainState& s) {
  return s.table_rad - p.ratio * s.hob_rad;
}

/// A train that has run at constant speed for so long that its transients are gone: servo and torsion decay with
/// 0.72 x 2 pi 20 Hz and 0.03 x 80 Hz x 2 pi, e^-45 or better.
std::unique_ptr<GearTrain> Steady(Fidelity fidelity, const GearTrainParameters& p,
                                  double hob_speed_rad_s = kHobSpeed_rad_s) {
  auto train = MakeGearTrain(fidelity, p);
  train->Run(hob_speed_rad_s, kRamp_s);
  train->Advance(kRamp_s + 3.0);
  return train;
}

TEST(GearTrain, KinematicTransmissionErrorIsTheSumOfItsGears) {
  GearTrainParameters p = Frictionless();
  p.errors = SomeErrors();
  p.worm_wheel_teeth = 96;
  p.worm_starts = 2;
  const auto train = Steady(Fidelity::kKinematic, p);
  for (int i = 0; i < 100; ++i) {
    train->Advance(0.31);
    const GearTrainState s = train->State();
    const double hob = kHobSpeed_rad_s * (s.time_s - 0.5 * kRamp_s);  // a symmetric ramp costs half its time
    const double th = hob / 22.0;
    const double expected_arcsec = 8.0 * std::cos(th + 0.3) + std::cos(2.0 * th - 0.5) +
                                   2.0 * std::cos(48.0 * th + 0.7) + 0.5 * std::cos(2.0 * 96.0 * th + 2.0) +
                                   3.0 * std::cos(hob + 1.1);
    // Angles of 200 rad have 3e-14 rad, ten times 1e-9 arcsec.
    EXPECT_NEAR(TransmissionError_rad(p, s) / kArcsec, expected_arcsec, 1e-7) << s.time_s;
    EXPECT_NEAR(s.wheel_rad, s.table_rad, 1e-15);
  }
}

TEST(GearTrain, BulletKeepsToTheKinematicTrainAtSlowSpeed) {
  GearTrainParameters p;
  p.errors = SomeErrors();
  const auto kinematic = Steady(Fidelity::kKinematic, p);
  const auto bullet = Steady(Fidelity::kBullet, p);
  // The table follows a line of frequency f with the gain 1 / (1 - (f / f0)^2), f0 = sqrt(k / I) / 2 pi = 79.6 Hz:
  // worm 3.4 Hz, 2 arcsec; mesh 6.8 Hz, 0.5 arcsec. The motor gives way to the reaction, of (f / f0)^2 of the same
  // and not more than the table has inertia beside it.
  const double bound_arcsec = 1.3 * (2.0 * 0.00183 + 0.5 * 0.0073);
  double worst = 0.0, apart = 0.0;
  for (int i = 0; i < 2640; ++i) {  // one turn
    kinematic->Advance(0.01);
    bullet->Advance(0.01);
    const GearTrainState a = kinematic->State(), b = bullet->State();
    worst = std::max(worst, std::abs(b.table_rad - a.table_rad) / kArcsec);
    apart = std::max(apart, std::abs(b.hob_rad - a.hob_rad));
  }
  EXPECT_LT(worst, bound_arcsec);
  EXPECT_LT(apart, 1e-10);  // no force acts on the hob but its servo's
}

TEST(GearTrain, LagIsProportionalToTheSpeed) {
  for (const Fidelity fidelity : kBoth) {
    for (const double feed_forward : {0.0, 0.6, 1.0}) {
      for (const double speed : {1.0, 5.0, -5.0}) {
        GearTrainParameters p = Frictionless();
        p.motor.feed_forward = feed_forward;
        const auto train = Steady(fidelity, p, speed);
        const double lag = (1.0 - feed_forward) * p.ratio * speed / (2.0 * kPi * p.motor.servo_Hz);
        // The integral leaves no error; a millionth of an arcsec is 2e-9 of the largest lag.
        EXPECT_NEAR(TransmissionError_rad(p, train->State()), -lag, 1e-6 * kArcsec) << speed;
      }
    }
  }
}

TEST(GearTrain, WindUpAndBacklashFollowTheDirectionAndStayWhenTheTableStops) {
  for (const Fidelity fidelity : kBoth) {
    for (const double backlash : {0.0, 6.0 * kArcsec}) {
      GearTrainParameters p;
      p.backlash_rad = backlash;
      auto train = Steady(fidelity, p);
      const auto wind_up = [&] { return train->State().wheel_rad - train->State().table_rad; };
      const double expected = 0.5 * backlash + 100.0 / 5e6;  // torque / stiffness: 4.1 arcsec
      // exp(-(0.24 rad/s / 1 mrad/s)^2) of the static excess is left: nothing
      EXPECT_NEAR(wind_up(), expected, 1e-5 * kArcsec) << backlash;
      train->Run(-kHobSpeed_rad_s, kRamp_s);
      train->Advance(kRamp_s + 3.0);
      EXPECT_NEAR(wind_up(), -expected, 1e-5 * kArcsec) << backlash;
      train->Run(0.0, kRamp_s);
      train->Advance(kRamp_s + 3.0);
      EXPECT_LT(std::abs(train->State().table_rad_s), 1e-9);
      // Bristles share it with the torsion as springs in line and have been at their higher static torque.
      EXPECT_LT(wind_up(), -0.5 * backlash);
      EXPECT_GT(wind_up(), -0.5 * backlash - 1.2 * 100.0 / 5e6 * (1.0 + 1e-9));
    }
  }
}

/// Speeds, a reversal through backlash and friction, and a ramp broken off, with time told in pieces of `piece_s`.
std::vector<GearTrainState> Story(Fidelity fidelity, double piece_s) {
  GearTrainParameters p;
  p.errors = SomeErrors();
  p.backlash_rad = 5.0 * kArcsec;
  const auto train = MakeGearTrain(fidelity, p);
  std::vector<GearTrainState> states;
  const auto pass = [&](double time_s) {
    for (long left = std::lround(time_s * 1e9); left > 0;) {
      const long piece = std::min(left, std::lround(piece_s * 1e9));
      train->Advance(static_cast<double>(piece) * 1e-9);
      left -= piece;
    }
    states.push_back(train->State());
  };
  train->Run(3.0, 0.5);
  pass(1.0000003);
  train->Run(-2.0, 0.3);
  pass(0.2123456);
  train->Run(1.0, 0.1234);
  pass(0.7);
  train->Run(0.0, 0.2);
  pass(0.5);
  return states;
}

std::array<double, 5> Bits(const GearTrainState& s) {
  return {s.time_s, s.hob_rad, s.table_rad, s.table_rad_s, s.wheel_rad};
}

TEST(GearTrain, HasTheSameBitsHoweverTimeIsSliced) {
  for (const Fidelity fidelity : kBoth) {
    const std::vector<GearTrainState> whole = Story(fidelity, 10.0);
    for (const double piece_s : {1e-3, 0.37e-3, 2.7182818e-3}) {
      const std::vector<GearTrainState> sliced = Story(fidelity, piece_s);
      for (std::size_t i = 0; i < whole.size(); ++i) EXPECT_EQ(Bits(sliced[i]), Bits(whole[i])) << piece_s << " s, state " << i;
    }
  }
}

TEST(GearTrain, WithinAServoPeriodInterpolatesBetweenItsEnds) {
  const auto train = MakeGearTrain(Fidelity::kBullet, {});
  train->Run(kHobSpeed_rad_s, 0.1);
  train->Advance(0.05);
  const GearTrainState before = train->State();
  train->Advance(0.3e-3);
  const GearTrainState within = train->State();
  train->Advance(0.7e-3);
  const GearTrainState expected = Between(before, train->State(), within.time_s);
  EXPECT_EQ(within.table_rad, expected.table_rad);
  EXPECT_EQ(within.hob_rad, expected.hob_rad);
  EXPECT_EQ(within.wheel_rad_s, expected.wheel_rad_s);
}

TEST(GearTrain, KinematicPlayKnowsAReversalOfMicroseconds) {
  GearTrainParameters p;
  p.hob.feed_forward = p.motor.feed_forward = 1.0;
  const auto train = Steady(Fidelity::kKinematic, p);
  const GearTrainState before = train->State();
  train->Run(-kHobSpeed_rad_s, 1e-5);
  train->Advance(1e-4);
  const GearTrainState after = train->State();
  // 0.24 rad/s: on by less than a quarter of the ramp's way, then back by less than the play of 2 x 20 urad.
  EXPECT_LT(after.wheel_rad, before.wheel_rad - 20e-6);
  EXPECT_NEAR(after.table_rad, before.table_rad, 0.25 * before.table_rad_s * 1e-5);
  EXPECT_EQ(after.table_rad_s, 0.0);
}

TEST(GearTrain, SpeedsAreTheDerivativesOfTheAngles) {
  for (const Fidelity fidelity : kBoth) {
    GearTrainParameters p;
    p.errors = SomeErrors();
    p.errors.hob_encoder = {{2.0, 5.0 * kArcsec, 0.0}};
    const auto train = MakeGearTrain(fidelity, p);
    train->Run(kHobSpeed_rad_s, kRamp_s);
    train->Advance(1.2);  // on the ramp
    for (int i = 0; i < 50; ++i) {
      const GearTrainState a = train->State();
      train->Advance(1e-3);
      const GearTrainState middle = train->State();
      train->Advance(1e-3);
      const GearTrainState b = train->State();
      // Central differences leave h^2 / 6 times the third derivative: the table's is below 20 rad/s^3 x 1e-2 here.
      EXPECT_NEAR((b.hob_rad - a.hob_rad) / 2e-3, middle.hob_rad_s, 1e-5);
      EXPECT_NEAR((b.table_rad - a.table_rad) / 2e-3, middle.table_rad_s, 1e-6);
      EXPECT_NEAR((b.wheel_rad - a.wheel_rad) / 2e-3, middle.wheel_rad_s, 1e-6);
    }
  }
}

GearTrainState OnASine(double time_s) {
  GearTrainState s{.time_s = time_s, .table_rad = 40.0 + 0.3 * time_s + 1e-3 * std::sin(20.0 * time_s),
                   .table_rad_s = 0.3 + 0.02 * std::cos(20.0 * time_s)};
  s.hob_rad = 22.0 * s.table_rad;
  s.hob_rad_s = 22.0 * s.table_rad_s;
  return s;
}

TEST(GearTrain, StatesBetweenTwoAreGoodToTheFourthOrder) {
  const double h_s = 0.01;
  const double bound = std::pow(20.0 * h_s, 4.0) / 384.0 * 1e-3;
  for (double t = 0.0; t < 0.3; t += h_s) {
    const GearTrainState middle = Between(OnASine(t), OnASine(t + h_s), t + 0.5 * h_s);
    EXPECT_NEAR(middle.table_rad, OnASine(t + 0.5 * h_s).table_rad, 1.01 * bound);
    EXPECT_NEAR(middle.hob_rad, OnASine(t + 0.5 * h_s).hob_rad, 1.01 * 22.0 * bound);
    EXPECT_NEAR(middle.table_rad_s, OnASine(t + 0.5 * h_s).table_rad_s, 20.0 * bound);
  }
}

TEST(GearTrain, EveryAngleIsPassedOnceAndOnTime) {
  const double h_s = 0.01;
  for (const double sense : {1.0, -1.0}) {
    const auto at = [&](int i) {
      GearTrainState s = OnASine(sense * i * h_s);  // backwards: the film run the other way
      s.time_s *= sense;
      s.table_rad_s *= sense;
      return s;
    };
    for (const double angle : {at(3).table_rad, 40.0 + sense * 0.02, 40.0 + sense * 0.05712}) {
      int found = 0;
      for (int i = 0; i < 30; ++i) {
        const auto time_s = PassingTime_s(at(i), at(i + 1), angle);
        if (!time_s) continue;
        ++found;
        // h^4 / 384 of the fourth derivative over the speed: 2e-8 s
        EXPECT_NEAR(OnASine(sense * *time_s).table_rad, angle, std::pow(20.0 * h_s, 4.0) / 384.0 * 1e-3 * 1.1);
      }
      EXPECT_EQ(found, 1) << angle;
    }
  }
}

TEST(GearTrain, RefusesWhatIsNoMachine) {
  using P = GearTrainParameters;
  using Change = void (*)(P&);
  const Change changes[] = {
      [](P& p) { p.ratio = 0.0; }, [](P& p) { p.ratio = std::nan(""); },
      [](P& p) { p.worm_wheel_teeth = 0; }, [](P& p) { p.worm_starts = -1; },
      [](P& p) { p.hob.inertia_kg_m2 = 0.0; }, [](P& p) { p.table_inertia_kg_m2 = -1.0; },
      [](P& p) { p.motor.servo_Hz = 0.0; }, [](P& p) { p.motor.servo_Hz = 26.0; },  // with a period of 1 ms
      [](P& p) { p.motor.feed_forward = 1.1; }, [](P& p) { p.backlash_rad = std::nan(""); },
      [](P& p) { p.stiffness_Nm_rad = HUGE_VAL; }, [](P& p) { p.damping_ratio = -0.1; },
      [](P& p) { p.friction.coulomb_Nm = -1.0; }, [](P& p) { p.friction.presliding_rad = 0.0; },
      [](P& p) { p.servo_period_s = 0.0; }, [](P& p) { p.step_s = std::nan(""); },
      [](P& p) { p.errors.worm = {{1.0, std::nan(""), 0.0}}; },
      [](P& p) { p.errors.worm = {{1.0, 0.01, 0.0}}; }};  // 0.9 of the table's speed
  for (const Change change : changes) {
    P p;
    change(p);
    for (const Fidelity fidelity : kBoth) EXPECT_THROW(MakeGearTrain(fidelity, p), std::invalid_argument);
  }
  EXPECT_THROW(MakeGearTrain(Fidelity::kLinear, {}), std::invalid_argument);
}

TEST(GearTrain, RefusesTimeThatRunsBackAndRampsThatAreNone) {
  for (const Fidelity fidelity : kBoth) {
    const auto train = MakeGearTrain(fidelity, {});
    EXPECT_THROW(train->Advance(-1e-3), std::invalid_argument);
    EXPECT_THROW(train->Run(1.0, 0.0), std::invalid_argument);
    EXPECT_THROW(train->Run(std::nan(""), 1.0), std::invalid_argument);
    train->Advance(1.0);
    EXPECT_EQ(train->State().table_rad, 0.0) << "a refused run moved the table";
  }
}

// What the bodies do: servos, torsion, inertia. Expected values are the linear systems' transfer functions.

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
