#include "tests/circular_motion/circle_run.h"
#include "tests/core/input_error.h"
#include "tests/support/kept_text.h"
#include "twin/benches/circular_motion/columns.h"
#include "twin/benches/circular_motion/twin/beside.h"
#include "twin/benches/circular_motion/twin/factory.h"

// Axes that are bodies, beside the same axes in closed form.
namespace twinbench::benches::circular {
namespace {

using units::mm, units::nm, units::um;

constexpr const char* kBench = R"(
bench = "circular_motion"
noise_free = true
[mounting]
offset_um = 0.0
zero_deg = 0.0
length_um = 0.0
grid_rotation_arcsec = 0.0
[circular_procedure]
setups = [ { instrument = "grid", radius_mm = 110.230 } ]
feeds_mm_min = [1000.0]
points = 24
stops = 4
)";

using Settings = std::vector<std::string>;

Settings Joined(const std::vector<Settings>& parts) {
  Settings all;
  for (const Settings& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

Scenario With(const std::vector<Settings>& parts, const std::string& effects = "") {
  return ParseScenario(kBench + effects, "bodies", ".", Joined(parts));
}
std::vector<Reading> ReadWith(const std::vector<Settings>& parts, const std::string& effects = "") {
  return test::CircleReadings(With(parts, effects));
}

/// Drives without anything that the closed form does not have.
Settings Ideal(const std::string& fidelity) {
  Settings settings = {"mechanics.fidelity=\"" + fidelity + "\""};
  for (const std::string axis : {"x", "y"}) {
    for (const char* setting : {"friction_#_N=0", "viscous_#_N_s_m=0", "feed_forward_#=0", "stiffness_#_N_um=1e4",
                                "torsion_#_Nm_rad=1e6"}) {
      std::string text = std::string("drives.") + setting;
      text.replace(text.find('#'), 1, axis);
      settings.push_back(text);
    }
  }
  return settings;
}

const Settings kErrorsOfPlace = {
    "machine.scale_x_um_m=25",        "machine.squareness_arcsec=4", "machine.straightness_x_um=0.8",
    "machine.straightness3_y_um=0.5", "machine.cyclic_x_um=0.4",     "machine.drift_y_um_K=1.5",
    "environment.swing_mK=700",       "environment.swing_period_s=700"};
const Settings kLate = {"machine.lag_x_s=0.02", "machine.lag_y_s=0.02"};

Deviation WorstBetween(const std::vector<Reading>& a, const std::vector<Reading>& b) {
  Deviation worst{0.0, 0.0};
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Deviation of_a = DeviationOf(a[i]), of_b = DeviationOf(b[i]);
    worst.radial_m = std::max(worst.radial_m, std::abs(of_a.radial_m - of_b.radial_m));
    worst.tangential_m = std::max(worst.tangential_m, std::abs(of_a.tangential_m - of_b.tangential_m));
  }
  return worst;
}

TEST(CircularBodies, AreTheClosedFormWhereTheirDrivesAreIdeal) {
  const auto closed = ReadWith({kErrorsOfPlace, kLate});
  for (const char* fidelity : {"linear", "bullet"}) {
    const auto bodies = ReadWith({kErrorsOfPlace, Ideal(fidelity)});
    ASSERT_EQ(bodies.size(), closed.size());
    const Deviation worst = WorstBetween(bodies, closed);
    // The drive's own s^3 / a is 5e-9 of the radius at 1000 mm/min; 0.33 mm of lag are within it.
    EXPECT_LT(worst.radial_m, 1.0 * nm) << fidelity;
    EXPECT_LT(worst.tangential_m, 2.0 * nm) << fidelity;
  }
}

const Settings kRubbing = {"mechanics.fidelity=\"bullet\"", "drives.play_x_um=1.0", "drives.position_gain_y_per_s=48"};
const Settings kOnABar = {R"(circular_procedure.setups=[ { instrument = "bar", radius_mm = 110.230 } ])"};

TEST(CircularBodies, AreFollowedAsTheyRan) {
  const Scenario scenario = With({kRubbing, kErrorsOfPlace, kOnABar, {"bar.latency_s=0.002", "encoder.latency_s=0.02"}});
  const std::vector<Reading> record = test::CircleReadings(scenario);
  const Eigen::MatrixXd shown_m = FollowRecord(scenario, record)->Predict({});
  for (std::size_t i = 0; i < record.size(); ++i) {
    const Deviation was = DeviationOf(WithAngles(record)[i]);
    EXPECT_NEAR(shown_m(static_cast<Eigen::Index>(i), 0), was.radial_m, 1e-12) << i;
    EXPECT_NEAR(shown_m(static_cast<Eigen::Index>(i), 1), was.tangential_m, 1e-12) << i;
  }
}

TEST(CircularBodies, AreFollowedOnARecordThatRounds) {
  const Scenario scenario = With({kRubbing});
  std::vector<Reading> record = test::CircleReadings(scenario);
  const Eigen::MatrixXd exact_m = FollowRecord(scenario, record)->Predict({});
  const auto round = [](double value, double step) { return step * std::round(value / step); };
  for (Reading& r : record) {
    kCommandedX_m(r) = round(kCommandedX_m(r), 1e-6 * mm);
    kCommandedY_m(r) = round(kCommandedY_m(r), 1e-6 * mm);
    r.time = Time(std::chrono::milliseconds(std::llround(1e3 * ToSeconds(r.time))));
  }
  const Eigen::MatrixXd rounded_m = FollowRecord(scenario, record)->Predict({});
  // 1 nm of commanded place; play and friction make of it as much again beside a reversal.
  EXPECT_LT((rounded_m - exact_m).cwiseAbs().maxCoeff(), 3.0 * nm);
}

TEST(CircularBodies, ALatencyShowsWhereTheyWereThen) {
  const auto now = ReadWith({kRubbing, kOnABar}), late = ReadWith({kRubbing, kOnABar, {"encoder.latency_s=0.01"}});
  int in_motion = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const double back_m = DeviationOf(now[i]).tangential_m - DeviationOf(late[i]).tangential_m;
    const double expected_m = 0.01 * now[i].direction * kFeed_m_s(now[i]);
    // Behind a reversal an axis goes more slowly than commanded or faster, by up to a micrometre in 10 ms.
    EXPECT_NEAR(back_m, expected_m, kFeed_m_s(now[i]) > 0.0 ? 1.0 * um : 0.01 * nm) << i;
    in_motion += kFeed_m_s(now[i]) > 0.0;
    EXPECT_EQ(DeviationOf(now[i]).radial_m, DeviationOf(late[i]).radial_m);
  }
  EXPECT_EQ(in_motion, 2 * 24);
}

TEST(CircularBodies, StandAtTheirStops) {
  // x lags by 1 ms and loses its play of 1 um and 400 N / 143 N/um; y has no play.
  const auto closed = ReadWith({{"machine.lag_y_s=0.00104", "machine.backlash_x_um=3.79", "machine.backlash_y_um=2.79"}});
  const auto three_s = ReadWith({kRubbing}), six_s = ReadWith({kRubbing, {"circular_procedure.dwell_s=6.0"}});
  for (std::size_t i = 0; i < three_s.size(); ++i) {
    if (kFeed_m_s(three_s[i]) > 0.0) continue;
    const Deviation at = DeviationOf(three_s[i]), then = DeviationOf(six_s[i]), formula = DeviationOf(closed[i]);
    EXPECT_NEAR(at.radial_m, then.radial_m, 1.0 * nm) << i;
    EXPECT_NEAR(at.tangential_m, then.tangential_m, 1.0 * nm) << i;
    // Where friction holds a slide it is between the Coulomb and the breakaway force: up to 60 N / 143 N/um more.
    EXPECT_NEAR(at.radial_m, formula.radial_m, 0.6 * um) << i;
    EXPECT_NEAR(at.tangential_m, formula.tangential_m, 0.6 * um) << i;
  }
}

TEST(CircularBodies, EffectsActOnThemAsOnTheClosedForm) {
  for (const char* effect :
       {"name = \"backlash\"\nwhere = \"x\"\nwidth_um = 2.0", "name = \"servo_mismatch\"\nlag_s = 1e-4",
        "name = \"reversal_spike\"\nwhere = \"y\"\nheight_um = 2.0", "name = \"servo_lag\"\nlag_s = 5e-4"}) {
    const std::string block = std::string("\n[[effect]]\n") + effect + "\n";
    const auto on_bodies = ReadWith({Ideal("linear")}, block), on_closed = ReadWith({kLate}, block);
    // A lag is a delay of the bodies: of the loss of radius, R (w lag)^2 / 2 = 9 nm at 0.02 s and 2.5 % more of it
    // with the effect, half is missing.
    EXPECT_LT(WorstBetween(on_bodies, on_closed).radial_m, 30.0 * nm) << effect;
    EXPECT_LT(WorstBetween(on_bodies, on_closed).tangential_m, 5.0 * nm) << effect;
    const Deviation moved = WorstBetween(on_bodies, ReadWith({Ideal("linear")}));
    EXPECT_GT(std::max(moved.radial_m, moved.tangential_m), 500.0 * nm) << effect;
  }
}

TEST(CircularBodies, NothingIsStatedTwice) {
  for (const char* key :
       {"machine.backlash_x_um=2", "machine.spike_y_um=2", "machine.lag_x_s=0.002", "drives.friction_x_N=0",
        "mechanics.fidelity=\"linear\"", "drives.velocity_gain_y_per_s=5000"})
    EXPECT_KEPT(MessageOf([&] { ReadWith({kRubbing, {key}}); }));
  EXPECT_NO_THROW(ReadWith({kRubbing, {"machine.lag_x_s=0.001"}})) << "as every resolved scenario has it";
}

TEST(CircularBodies, TruthSaysWhatTheyDoInTheFormatsWords) {
  const nlohmann::json errors = sim::CircleRun(With({kRubbing})).Truth().at("errors");
  EXPECT_NEAR(errors.at("machine.lag_x_s").get<double>(), 0.001, 1e-15);
  EXPECT_NEAR(errors.at("machine.lag_y_s").get<double>(), 0.05 / 48.0, 1e-15);
  const double twist_um = 400.0 * (1.0 / 150.0 + 1e6 * std::pow(0.01 / units::turn, 2) / 8000.0);
  EXPECT_NEAR(errors.at("machine.backlash_x_um").get<double>(), 1.0 + twist_um, 1e-9);
  EXPECT_FALSE(errors.contains("machine.spike_x_um"));
}

// A machine that is driven by hand is still the machine of the procedure: what remembers goes on.

/// A room that swings, a drift that follows it late, noise, and one set-up of each instrument.
constexpr const char* kRemembering = R"(
bench = "circular_motion"
[environment]
swing_mK = 3000.0
swing_period_s = 60.0
sensor_noise_mK = 50.0
[[effect]]
name = "drift"
where = "y"
drift_um_K = 5.0
lag_s = 30.0
[[effect]]
name = "slip"
where = "x"
step_um = 3.0
at_reading = 60
[circular_procedure]
setups = [ { instrument = "bar", radius_mm = 100.0 }, { instrument = "grid", radius_mm = 110.230 } ]
feeds_mm_min = [1000.0]
points = 24
)";

TEST(CirclesBesideThePlan, ShowWhatThePlanShowsWhereTheyAreTheSame) {
  const sim::CircleRun run(ParseScenario(kRemembering, "remembering", ".", {}));
  const int half = run.Readings() / 2;
  std::vector<Reading> taken;
  for (int i = 0; i < half; ++i) taken.push_back(run.Take(i));
  sim::CircleBeside beside(run, taken);
  for (int i = half; i < run.Readings(); ++i) {
    const Reading planned = run.Take(i), shown = beside.Take(run.Planned(i));
    EXPECT_EQ(shown.temperature_degC, planned.temperature_degC) << i;
    EXPECT_NEAR(DeviationOf(shown).radial_m, DeviationOf(planned).radial_m, 1e-12) << i;
    EXPECT_NEAR(DeviationOf(shown).tangential_m, DeviationOf(planned).tangential_m, 1e-12) << i;
  }
}

}  // namespace
}  // namespace twinbench::benches::circular
