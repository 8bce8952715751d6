#include "mechanics/plant.h"

#include "mechanics/sag.h"
#include "tests/mechanics/plant_runs.h"

namespace twinbench::mechanics {
namespace {

void StartCounterRotation(Plant& plant, int position, double duration_s = 0.6) {
  plant.StartMove(Axis::kTarget, position * kTenDegrees, duration_s);
  plant.StartMove(Axis::kReference, -position * kTenDegrees, duration_s);
}

double EncoderError(const Plant& plant, double target_rad, double reference_rad) {
  const StackState s = plant.State();
  return std::max(std::abs(s.target_encoder_rad - target_rad), std::abs(s.reference_encoder_rad - reference_rad));
}

/// Time after the end of a counter-rotating step from which the encoders stay within `band_rad`, by looking each
/// half millisecond for `watch_s`.
double SettleTime(const StackParameters& p, Fidelity fidelity, double duration_s, double band_rad,
                  double watch_s = 0.5) {
  const auto plant = MakePlant(fidelity, p);
  StartCounterRotation(*plant, 1, duration_s);
  plant->Advance(duration_s);
  double settled_s = 0.0;
  for (double t = 0.0; t < watch_s && !plant->Settled(); t += 0.5e-3) {
    if (EncoderError(*plant, kTenDegrees, -kTenDegrees) > band_rad) settled_s = t + 0.5e-3;
    plant->Advance(0.5e-3);
  }
  return settled_s;
}

TEST(KinematicPlant, EqualsTheChainOfItsCommandedAngles) {
  const StackParameters p;
  const auto plant = MakePlant(Fidelity::kKinematic, p);
  const Chain chain(p.geometry);
  for (int i = 1; i < 36; ++i) {
    StartCounterRotation(*plant, i);
    plant->Advance(0.6);
    ASSERT_TRUE(plant->Settled());
    const StackState s = plant->State();
    ChainState commanded{.target_rad = i * kTenDegrees, .reference_rad = -i * kTenDegrees};
    ChainState found{.target_rad = s.target_rad, .reference_rad = s.reference_rad,
                     .target_bearing = s.target_bearing, .reference_bearing = s.reference_bearing};
    EXPECT_EQ(chain.GratingPose(found).matrix(), chain.GratingPose(commanded).matrix());  // not a bit differs
  }
}

TEST(Plant, AllFidelitiesRestAtTheSamePose) {
  for (const Fidelity fidelity : kBodies) {
    Both both{MakePlant(Fidelity::kKinematic, ReseatedStack()), MakePlant(fidelity, ReseatedStack())};
    for (int i = 1; i <= 3; ++i) {
      both.Counter(i);
      for (Plant* each : {both.a.get(), both.b.get()}) {
        each->AdvanceUntilSettled(2.0);
        ASSERT_TRUE(each->Settled());
      }
      both.difference.Include(both.a->State(), both.b->State());
    }
    // Settled means within 0.01 arcsec; the bearings have had 60 ms to ring down.
    EXPECT_LT(both.difference.yaw_rad, 0.01 * kArcsec);
    EXPECT_LT(both.difference.tilt_rad, 1e-3 * kArcsec);
    EXPECT_LT(both.difference.position_m, 1e-9);
  }
}

TEST(LinearPlant, FollowsBulletThroughMovesWithinAThousandthOfAnArcsecond) {
  Both both = LinearAndBullet(Fine(ReseatedStack()));
  for (int i = 1; i <= 2; ++i) {  // the second starts from the first one's remainder
    both.Counter(i);
    both.GoOn(350, 2e-3);
  }
  // Asked: 1e-3 arcsec in yaw. Left are RK4's own 1e-6 arcsec and squares of deflections of 1e-6 rad.
  EXPECT_LT(both.difference.yaw_rad, 1e-5 * kArcsec);
  EXPECT_LT(both.difference.tilt_rad, 1e-5 * kArcsec);
  EXPECT_LT(both.difference.position_m, 1e-9);
}

TEST(LinearPlant, FollowsBulletWhenOneTableMovesAndTheOtherHolds) {
  Both both = LinearAndBullet(Fine(ReseatedStack()));
  both.Send(Axis::kReference, kTenDegrees);
  double reaction_rad = 0.0;
  for (int k = 0; k < 350; ++k) {
    both.GoOn(1, 2e-3);
    reaction_rad = std::max(reaction_rad, std::abs(both.b->State().target_rad));
  }
  EXPECT_GT(reaction_rad, 0.5 * kArcsec);   // there is something to agree about
  EXPECT_LT(reaction_rad, 20.0 * kArcsec);  // a few arcsec for 0.6 s (3.7 in the study of such a stack)
  // The payload swings round by 10 deg: Coriolis terms are left out.
  EXPECT_LT(both.difference.yaw_rad, 1e-4 * kArcsec);
  EXPECT_LT(both.difference.tilt_rad, 1e-4 * kArcsec);
}

TEST(LinearPlant, GivesTheSameForKeptResponsesAndStepByStep) {
  StackParameters p = ReseatedStack(), stepped = p;
  stepped.table[0].friction.viscous_Nm_s = 1e-300;  // too small to matter, and rules superposition out
  Both both{MakePlant(Fidelity::kLinear, p), MakePlant(Fidelity::kLinear, stepped)};
  for (int i = 1; i <= 3; ++i) {
    both.Counter(i);
    both.GoOn(700, 1e-3);
  }
  // Exact superposition; the commands' rounding (1e-16 of 10 deg at 0.5 ms) drives the difference.
  EXPECT_LT(both.difference.yaw_rad, 1e-7 * kArcsec);
  EXPECT_LT(both.difference.tilt_rad, 1e-7 * kArcsec);
}

TEST(LinearPlant, CarriesOnWhenAMoveStartsDuringAnother) {
  Both both = LinearAndBullet(ReseatedStack());
  both.Send(Axis::kTarget, kTenDegrees, 0.3);
  both.GoOn(50, 2e-3);
  both.Send(Axis::kReference, -2.0 * kTenDegrees, 0.5);
  both.GoOn(350, 2e-3);
  EXPECT_LT(both.difference.yaw_rad, 1e-3 * kArcsec);  // the leapfrog of this Bullet plant errs by some 1e-4 arcsec
  EXPECT_TRUE(both.a->Settled());
}

TEST(Plant, SettlesFasterWithAFasterServo) {
  StackParameters p = ReseatedStack();
  std::vector<double> coarse_s;
  for (double bandwidth_Hz : {15.0, 30.0, 60.0}) {
    p.table[0].servo_Hz = p.table[1].servo_Hz = bandwidth_Hz;
    coarse_s.push_back(SettleTime(p, Fidelity::kLinear, 0.6, 0.1 * kArcsec));
  }
  // The study of such a stack found 233, 66 and 22 ms for a controller of other gains; a factor of two is
  // agreement.
  EXPECT_GT(coarse_s[0], 0.100);
  EXPECT_LT(coarse_s[0], 0.466);
  EXPECT_GT(coarse_s[1], 0.033);
  EXPECT_LT(coarse_s[1], 0.132);
  EXPECT_LT(coarse_s[2], 0.044);
  const double slow_s = SettleTime(ReseatedStack(), Fidelity::kLinear, 0.6, 0.1 * kArcsec);
  const double fast_s = SettleTime(ReseatedStack(), Fidelity::kLinear, 0.3, 0.1 * kArcsec);
  EXPECT_GT(fast_s, slow_s);  // a shorter move shakes more
}

TEST(Plant, FrictionSlowsSettling) {
  StackParameters p = ReseatedStack();
  for (Fidelity fidelity : kBodies) {
    std::vector<double> settle_s;
    for (double coulomb_Nm : {0.0, 0.05, 0.2}) {
      for (TableParameters& table : p.table) table.friction.coulomb_Nm = coulomb_Nm;
      settle_s.push_back(SettleTime(p, fidelity, 0.6, 0.1 * kArcsec, 1.2));
    }
    EXPECT_GT(settle_s[1], 1.5 * settle_s[0]);
    EXPECT_GT(settle_s[2], 1.5 * settle_s[1]);
    EXPECT_LT(settle_s[2], 1.2);
  }
}

TEST(Plant, ReactionTorqueTurnsTheTableThatHolds) {
  StackParameters p = ReseatedStack();
  const auto deviation = [&](double duration_s) {
    const auto plant = MakePlant(Fidelity::kBullet, p);
    plant->StartMove(Axis::kReference, kTenDegrees, duration_s);
    double worst = 0.0;
    for (double t = 0.0; t < duration_s; t += 1e-3) {
      plant->Advance(1e-3);
      worst = std::max(worst, std::abs(plant->State().target_rad));
    }
    return worst;
  };
  const double plain = deviation(0.6);
  EXPECT_GT(deviation(0.3), 3.0 * plain);  // four times the torque, and faster
  p.reaction_feed_forward = 1.0;
  EXPECT_LT(deviation(0.6), 0.05 * plain);  // the study: 3.7 -> 0.031 arcsec
}

TEST(Plant, BacklashHoldsTheRotorBackByHalfTheGapInBothDirectionsAndEquallyByLinearAndBullet) {
  StackParameters p;
  p.table[0].backlash_rad = 4.0 * kArcsec;
  for (Fidelity fidelity : kAll) {
    const auto plant = MakePlant(fidelity, p);
    const auto lag = [&](double to_rad) {
      plant->StartMove(Axis::kTarget, to_rad, 0.3);
      plant->AdvanceUntilSettled(2.0);
      const StackState s = plant->State();
      EXPECT_EQ(s.reference_rad, s.reference_encoder_rad);
      return (s.target_encoder_rad - s.target_rad) / kArcsec;
    };
    // The servo's overshoot of some arcsec at 0.3 s, which then comes back within the gap, is real at the upper two
    // levels: the rotor may stay up to the whole gap on the far side.
    const double overshoot = fidelity == Fidelity::kKinematic ? 1e-9 : 4.0;
    EXPECT_NEAR(lag(kTenDegrees), 2.0, overshoot);
    EXPECT_NEAR(lag(0.0), -2.0, overshoot);
    EXPECT_LE(std::abs(lag(0.5 * kTenDegrees)), 2.0 + 1e-9);
  }
  p.integrator = Integrator::kRungeKutta4;
  Both both = LinearAndBullet(p);
  both.Counter(1);
  for (Plant* plant : {both.a.get(), both.b.get()}) plant->AdvanceUntilSettled(2.0);
  EXPECT_NEAR(both.a->State().target_rad, both.b->State().target_rad, 1e-4 * kArcsec);  // as their yaw
}

TEST(Plant, SleepsWhenSettledAndWakesForTheNextMove) {
  for (Fidelity fidelity : kAll) {
    const auto plant = MakePlant(fidelity, ReseatedStack());
    EXPECT_TRUE(plant->Settled());
    plant->StartMove(Axis::kTarget, kTenDegrees, 0.3);
    EXPECT_FALSE(plant->Settled());
    plant->AdvanceUntilSettled(2.0);
    ASSERT_TRUE(plant->Settled());
    const StackState before = plant->State();
    plant->Advance(1e6);  // eleven days cost nothing
    Difference decayed;
    decayed.Include(plant->State(), before);
    EXPECT_LT(decayed.yaw_rad, 0.01 * kArcsec) << "what was left when it had settled";
    const auto rest = Numbers(plant->State());
    plant->Advance(1.0);
    EXPECT_EQ(Numbers(plant->State()), rest);
    plant->StartMove(Axis::kTarget, 0.0, 0.3);
    EXPECT_FALSE(plant->Settled());
    plant->AdvanceUntilSettled(2.0);
    EXPECT_NEAR(plant->State().target_rad, 0.0, 0.01 * kArcsec);
  }
}

TEST(Plant, AReactionThatPushesATableOutOfItsWindowUnsettlesIt) {
  for (Fidelity fidelity : kAll) {
    const auto plant = MakePlant(fidelity, ReseatedStack());
    plant->StartMove(Axis::kReference, kTenDegrees, 0.6);
    EXPECT_TRUE(plant->Settled(Axis::kTarget)) << "nothing has happened to it yet";
    plant->Advance(
        0.2);  // some arcsec, see ReactionTorqueTurnsTheTableThatHolds; a kinematic plant knows no torque
    EXPECT_EQ(plant->Settled(Axis::kTarget), fidelity == Fidelity::kKinematic);
    plant->AdvanceUntilSettled(2.0);
    EXPECT_TRUE(plant->Settled(Axis::kTarget));
  }
}

TEST(Plant, TakesOverANewMountingOrMoveOfAnAxisAtRestOnly) {
  StackParameters p = ReseatedStack();
  for (Fidelity fidelity : kAll) {
    const auto plant = MakePlant(fidelity, p);
    StartCounterRotation(*plant, 1);
    plant->Advance(0.1);
    EXPECT_THROW(plant->Mount(p.geometry), std::logic_error);
    EXPECT_THROW(plant->StartMove(Axis::kTarget, 0.0, 0.6), std::logic_error);
    EXPECT_THROW(plant->Advance(-1.0), std::invalid_argument);
    plant->AdvanceUntilSettled(2.0);
    ChainGeometry turned = p.geometry;
    turned.reseat_rad = -1.0;
    plant->Mount(turned);
    StackParameters expected = p;
    expected.geometry = turned;
    const StackState s = plant->State();
    const Vector12 q = StaticDeflection(expected, s.target_rad, s.reference_rad);
    EXPECT_NEAR(s.target_rad, kTenDegrees, 0.01 * kArcsec);
    EXPECT_NEAR(s.target_bearing.rx_rad, q[3], 1e-3 * kArcsec);  // remainder of the ring-down
    EXPECT_NEAR(s.target_bearing.ry_rad, q[4], 1e-3 * kArcsec);
  }
}

TEST(Plant, BreaksAMoveOffAndGoesOnFromThereAndAStopAtRestChangesNothing) {
  for (const Fidelity fidelity : kAll) {
    const auto plant = MakePlant(fidelity, ReseatedStack());
    StartCounterRotation(*plant, 3);
    plant->Advance(0.3);  // half of the way, at full speed
    plant->Stop(Axis::kTarget);
    const double end_rad = plant->CommandedEnd_rad(Axis::kTarget);
    // Mean speed while braking is about half of the peak, 1.875 x 30 deg / 0.6 s.
    EXPECT_NEAR(end_rad, 15.0 * kDegree + 0.5 * 93.75 * kDegree * Plant::kBraking_s, 1e-9);
    plant->AdvanceUntilSettled(10.0);
    ASSERT_TRUE(plant->Settled()) << static_cast<int>(fidelity);
    EXPECT_NEAR(plant->State().target_encoder_rad, end_rad, 0.02 * kDegree / 3600.0);
    EXPECT_NEAR(plant->State().reference_encoder_rad, -30.0 * kDegree, 0.02 * kDegree / 3600.0) << "went on";
    plant->StartMove(Axis::kTarget, 40.0 * kDegree, 0.6);
    plant->AdvanceUntilSettled(10.0);
    EXPECT_NEAR(plant->State().target_encoder_rad, 40.0 * kDegree, 0.02 * kDegree / 3600.0);
    plant->Advance(10.0);
    const auto before = Numbers(plant->State());
    plant->Stop(Axis::kTarget);
    plant->Advance(1.0);
    EXPECT_EQ(Numbers(plant->State()), before);
    EXPECT_TRUE(plant->Settled());
  }
}

}  // namespace
}  // namespace twinbench::mechanics
