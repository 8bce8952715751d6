#include "tests/support/rotary_scenario.h"
#include "tests/support/twin_run.h"
#include "twin/benches/rotary_4dof/twin/effect.h"
#include "twin/core/effect_catalogue.h"

namespace twinbench::sim {
namespace {

using Volts = std::array<double, kChannels>;

constexpr double kL1_m = 0.12;
constexpr double kSinTheta = 0.39;
const double kCosTheta = std::sqrt(1.0 - kSinTheta * kSinTheta);
/// Spot motion per radian of yaw and of tilt, and volts per metre.
const double kYaw_m = kL1_m * (1.0 + 1.0 / kCosTheta);
const double kTilt_m = kL1_m * (1.0 + kCosTheta);
constexpr double kV_m = 2000.0;

/// An effect block as the loader would fill it: the catalogue's defaults with these values on top.
EffectSettings Effect(const std::string& name, const std::string& where, std::map<std::string, double> values) {
  EffectSettings effect{name, where, {}, "test"};
  for (const EffectParameter& p : FindEffect(name, kRotaryBench)->parameters)
    effect.parameters[p.name] = p.default_SI;
  for (const auto& [key, value] : values) effect.parameters.at(key) = value;
  return effect;
}

Volts Read(Twin& twin, int samples = 1) {
  const Acquisition block = twin.Bench().adc.Acquire(samples, false);
  EXPECT_EQ(block.status, ReadingStatus::kOk);
  Volts volts;
  for (int c = 0; c < kChannels; ++c) volts[c] = block.channel[c].mean_V;
  return volts;
}

/// Drives a bench with this effect and one without through the same actions; the difference is what the effect did.
struct Pair {
  explicit Pair(const EffectSettings& effect, Scenario scenario = Quiet())
      : without(scenario), with(Add(scenario, effect)) {}
  static Scenario Add(Scenario scenario, const EffectSettings& effect) {
    scenario.effects.push_back(effect);
    return scenario;
  }
  void Do(const std::function<void(RotaryBench)>& action) {
    action(without.Bench());
    action(with.Bench());
  }
  Volts Difference() {
    const Volts a = Read(without), b = Read(with);
    Volts d;
    for (int c = 0; c < kChannels; ++c) d[c] = b[c] - a[c];
    return d;
  }
  Twin without, with;
};

const auto kTurnGrating = [](RotaryBench bench) {
  bench.goniometer.MoveTo(300.0 * units::arcsec, -200.0 * units::arcsec);
};

void MoveBoth(RotaryBench bench, double target_rad) {
  bench.target.StartMove(target_rad);
  bench.reference.StartMove(-target_rad);
  bench.target.WaitSettled();
  bench.reference.WaitSettled();
}

TEST(Effects, StretchOrPullTheSpotOfTheirDetectorOnly) {
  Twin plain(Quiet());
  kTurnGrating(plain.Bench());
  const Volts at_V = Read(plain);
  const double r2_m2 = (at_V[0] * at_V[0] + at_V[1] * at_V[1]) / (kV_m * kV_m);
  // The ray's angle is the same, so both coordinates grow with the distance; the offset of the spot on the grating
  // is zero, for it turns about the spot.
  const std::tuple<EffectSettings, std::size_t, double, double> effects[] = {
      {Effect("psd_nonlinearity", "psd_a", {{"cubic", 180000.0}}), 0, 1.0 + 180000.0 * r2_m2, 1e-12},
      {Effect("stray_light", "psd_b", {{"fraction", 0.01}}), 2, 1.0 / 1.01, 1e-12},
      {Effect("psd_distance", "psd_a", {{"distance_error", 0.001}}), 0, 121.0 / 120.0, 1e-9}};
  for (const auto& [effect, first, factor, within] : effects) {
    Twin twin(Pair::Add(Quiet(), effect));
    kTurnGrating(twin.Bench());
    const Volts seen_V = Read(twin);
    for (const std::size_t c : {first, first + 1}) EXPECT_NEAR(seen_V[c] / at_V[c], factor, within) << effect.name;
    EXPECT_EQ(seen_V[2 - first], at_V[2 - first]) << effect.name;
  }
}

TEST(Effects, ABackgroundPullsTheSpotByItsShareOfTheCurrentAsThePowerDriftsAndNothingElseDoes) {
  Scenario scenario = Quiet();
  RotaryOf(scenario).laser.power_drift_per_s = -0.3 / units::hour;
  const double current_A = 8e-6, light_A = 0.45 * 5e-3 * 0.339;
  Pair pair(Effect("background", "psd_b", {{"current", current_A}}), scenario);
  pair.Do(kTurnGrating);
  const Volts first = Read(pair.without);
  Read(pair.with);
  for (const double left : {1.0, 0.7}) {
    const Volts plain = Read(pair.without), pulled = Read(pair.with);
    EXPECT_NEAR(pulled[2] / plain[2], 1.0 / (1.0 + current_A / (left * light_A)), 1e-7);
    EXPECT_NEAR(pulled[3] / plain[3], 1.0 / (1.0 + current_A / (left * light_A)), 1e-7);
    EXPECT_NEAR(plain[3], first[3], 1e-12);
    EXPECT_EQ(pulled[0], plain[0]);
    pair.Do([](RotaryBench bench) { bench.clock.Wait(std::chrono::hours(1)); });
  }
}

// The front stands aslant by 2 h x / (half width)^2 where the beam meets it; orders follow as they follow a yaw
// and, turned the other way along z by a saddle, a tilt.
TEST(Effects, AGratingOfAnotherFormTurnsTheOrdersWhereTheBeamIsBesideItsMiddle) {
  Scenario scenario = Quiet();
  RotaryOf(scenario).laser.position_m.x() = 1.0 * units::mm;
  RotaryOf(scenario).laser.position_m.z() = 0.5 * units::mm;
  const double height_m = 600.0 * units::nm, half_m = 12.5 * units::mm;
  const double x_slope = 2.0 * height_m * 1e-3 / (half_m * half_m), z_slope = 0.5 * x_slope;
  for (const bool is_sphere : {true, false}) {
    Pair pair(Effect("grating_form", is_sphere ? "sphere" : "astigmatism", {{"height", height_m}}), scenario);
    const Volts d = pair.Difference();
    for (const int psd : {0, 1}) {
      EXPECT_NEAR(std::abs(d[2 * psd]) / kV_m, kYaw_m * x_slope, 0.02 * kYaw_m * x_slope) << is_sphere;
      EXPECT_NEAR(std::abs(d[2 * psd + 1]) / kV_m, kTilt_m * z_slope, 0.02 * kTilt_m * z_slope) << is_sphere;
    }
  }
}

TEST(Effects, AnEncodersSubdivisionErrorIsTheTablesIndexError) {
  Scenario scenario = Quiet();
  RotaryOf(scenario).mechanics.encoder_periods = 36001;  // at 36 stops as once a turn
  const double amplitude_rad = 0.1 * units::arcsec;      // 0.017 of a period: the sine is bent by as much
  for (const char* table : {"target", "reference"}) {
    Pair pair(Effect("encoder_subdivision", table, {{"amplitude", amplitude_rad}}), scenario);
    for (const double angle_rad : {10.0 * units::deg, 100.0 * units::deg, 230.0 * units::deg}) {
      pair.Do([=](RotaryBench bench) { MoveBoth(bench, angle_rad); });
      const double sine = std::sin(table == std::string("target") ? angle_rad : -angle_rad);
      // The rotor stands behind by what its encoder shows too much.
      EXPECT_NEAR(pair.Difference()[0] / kV_m, kYaw_m * amplitude_rad * sine, 0.03 * kYaw_m * amplitude_rad)
          << table;
    }
  }
  RotaryOf(scenario).mechanics.encoder_periods = 100000;
  EXPECT_THROW(Pair(Effect("encoder_subdivision", "target", {{"amplitude", 3.0 * units::arcsec}}), scenario),
               InputError);
}

/// u of PSD A for light that leaves the grating's place x with this sine of its angle.
double SpotA_m(double x_m, double sine) {
  const Eigen::Vector2d centre = kL1_m * Eigen::Vector2d(kSinTheta, kCosTheta);
  const Eigen::Vector2d direction(sine, std::sqrt(1.0 - sine * sine)), normal(kSinTheta, kCosTheta);
  const Eigen::Vector2d from(x_m, 0.0);
  const Eigen::Vector2d hit = from + direction * (centre - from).dot(normal) / direction.dot(normal);
  return (hit - centre).dot(Eigen::Vector2d(kCosTheta, -kSinTheta));
}

struct Moved {
  const char* claim;
  EffectSettings effect;
  std::function<void(RotaryBench)> action;
  Volts expected_V;  // NaN: not asked for
  double within_V = 1e-9;
};

TEST(Effects, MoveTheSpotsByTheirClosedForms) {
  const auto nothing = [](RotaryBench) {};
  const auto wait = [](int seconds) { return [=](RotaryBench b) { b.clock.Wait(std::chrono::seconds(seconds)); }; };
  const double apart_V = kV_m * SpotA_m(0.0, kSinTheta + 600e3 * 2e-9);
  const double drift = 20e-6 / 3600.0, raised_V = kV_m * 20e-6 * (0.2 + kL1_m);  // along the grooves it is kept
  using units::arcsec;
  const double behind_V = kV_m * kYaw_m * arcsec;  // yaw is negative on x
  const double crept_V = 3.0 * kV_m * kTilt_m * arcsec * std::log(2.0);
  const auto go = [](RotaryBench b) { MoveBoth(b, 10.0 * units::deg); };
  const auto go_and_come_back = [=](RotaryBench b) { go(b), MoveBoth(b, 0.0); };
  const auto read = [](int times) {
    return [=](RotaryBench b) {
      for (int k = 0; k < times; ++k) b.adc.Acquire(1, false);
    };
  };
  const auto turn = [](double yaw_rad) { return [=](RotaryBench b) { b.goniometer.MoveTo(yaw_rad, 0.0); }; };
  const auto clamp_and_wait = [=](RotaryBench b) { b.fixture.Mount(0, 0.0, 0.0), wait(600)(b); };
  const EffectSettings creep =
      Effect("mount_creep", "tilt", {{"amplitude", 3.0 * arcsec}, {"time_constant", 600.0}});
  const auto play = [](const char* table) { return Effect("backlash", table, {{"half_width", units::arcsec}}); };
  const EffectSettings slip = Effect("slip", "lateral", {{"shift", 5e-6}, {"at_reading", 2.0}});
  const EffectSettings step = Effect("adc_step", "psd_a_x", {{"step", 5e-3}, {"at_voltage", 0.0}});
  const Moved cases[] = {
      {"another wavelength moves the orders apart",
       Effect("wavelength_offset", "", {{"wavelength_error", 2e-9}}), nothing, {apart_V, kNaN, -apart_V, kNaN}},
      {"an incidence offset keeps the spot and turns the orders",
       Effect("incidence_offset", "", {{"incidence", 0.002}}), nothing,
       {kV_m * SpotA_m(0.0, kSinTheta - std::sin(0.002)), 0.0, kNaN, kNaN}},
      {"the laser drifts about its own place, 0.2 m from the grating",
       Effect("laser_drift", "yaw", {{"drift", drift}}), wait(3600),
       {kV_m * SpotA_m(0.2 * std::tan(20e-6), kSinTheta + std::sin(20e-6)), 0.0, kNaN, kNaN}},
      {"a drift in pitch moves the spots up together",
       Effect("laser_drift", "pitch", {{"drift", drift}}), wait(3600), {kNaN, raised_V, kNaN, raised_V}, 1e-6},
      {"what settles decays with the dwell: the window of 0.4 s has passed when the move returns",
       Effect("settling", "", {{"amplitude", 5.0 * arcsec}, {"time_constant", 1.0}}), go,
       {5.0 * behind_V * std::exp(-0.4), kNaN, kNaN, kNaN}, 1e-5},
      {"a mount creeps", creep, clamp_and_wait, {kNaN, crept_V, kNaN, kNaN}, 1e-7},
      {"... and does so anew after every mounting", creep,
       [=](RotaryBench b) { clamp_and_wait(b), clamp_and_wait(b); }, {kNaN, crept_V, kNaN, kNaN}, 1e-7},
      {"backlash leaves the target behind", play("target"), go, {behind_V, kNaN, kNaN, kNaN}, 1e-6},
      {"... on either side", play("target"), go_and_come_back, {-behind_V, kNaN, kNaN, kNaN}, 1e-6},
      {"the reference goes the other way", play("reference"), go, {-behind_V, kNaN, kNaN, kNaN}, 1e-6},
      {"... on either side", play("reference"), go_and_come_back, {behind_V, kNaN, kNaN, kNaN}, 1e-6},
      // Towards the laser both orders meet their PSDs nearer to the normal: -sin theta per metre on A, + on B.
      {"a slip is not there before its reading", slip, read(1), {0.0, 0.0, 0.0, 0.0}},
      {"... comes at it", slip, read(2), {-kV_m * 5e-6 * kSinTheta, kNaN, kV_m * 5e-6 * kSinTheta, kNaN}},
      {"... and stays", slip, read(3), {-kV_m * 5e-6 * kSinTheta, kNaN, kV_m * 5e-6 * kSinTheta, kNaN}},
      {"the converter steps above its voltage", step, turn(-100.0 * arcsec), {5e-3, 0.0, 0.0, 0.0}},
      {"... and not below", step, turn(100.0 * arcsec), {0.0, 0.0, 0.0, 0.0}},
      {"a tone is a sine in time", Effect("tone", "yaw", {{"frequency", 0.01}, {"amplitude", 0.5e-6}}), wait(25),
       {0.5e-6 * kV_m, 0.0, 0.5e-6 * kV_m, 0.0}}};
  for (const Moved& moved : cases) {
    Pair pair(moved.effect);
    pair.Do(moved.action);
    const Volts d = pair.Difference();
    for (std::size_t c = 0; c < kChannels; ++c) {
      if (std::isnan(moved.expected_V[c])) continue;
      EXPECT_NEAR(d[c], moved.expected_V[c], moved.within_V) << moved.claim << ", channel " << c;
    }
  }
}

TEST(Effects, AThermalTiltFollowsTheRoomWithItsLagAndTheAutocollimatorSeesItToo) {
  Scenario warming = Quiet();
  warming.environment.drift_K_h = 1.0;
  const double per_kelvin = 5.0 * units::arcsec, lag_s = 900.0;
  // Answer of a first-order lag to a ramp from rest: slope (t - lag (1 - exp(-t / lag))).
  const double lagged_K = (3600.0 - lag_s * (1.0 - std::exp(-3600.0 / lag_s))) / 3600.0;
  for (const std::size_t channel : {0u, 1u}) {
    const double metres = channel == 0 ? -kYaw_m : kTilt_m;
    Pair pair(
        Effect("thermal_tilt", channel == 0 ? "yaw" : "tilt", {{"tilt_per_kelvin", per_kelvin}, {"lag", lag_s}}),
        warming);
    EXPECT_NEAR(pair.Difference()[channel], 0.0, 1e-12);
    pair.Do([](RotaryBench b) { b.clock.Wait(std::chrono::hours(1) - b.clock.Now().time_since_epoch()); });
    EXPECT_NEAR(pair.Difference()[channel] / (kV_m * metres * per_kelvin * lagged_K), 1.0, 1e-3);
    const AutocollimatorReading with = pair.with.Bench().autocollimator.Read(),
                                without = pair.without.Bench().autocollimator.Read();
    const double seen_rad = channel == 0 ? with.yaw_rad - without.yaw_rad : with.tilt_rad - without.tilt_rad;
    EXPECT_NEAR(seen_rad / (pair.Difference()[channel] / (kV_m * metres)), 1.0, 1e-2);
  }
}

TEST(Effects, ReclampFrameMakesAReseatRunReadLikeAReclampRun) {
  const Scenario scenario = Altered(Quiet(), {"procedure.phases=[\"full_circle\"]", "procedure.positions=12",
                                              "procedure.shifts=[0, 4]", "reference.random.ex_arcsec=5"});
  const Scenario reclamp = Altered(scenario, {"procedure.clamping=reclamp"});
  Scenario hidden = scenario;
  hidden.effects = {Effect("reclamp_frame", "", {})};
  const auto expected = test::RunTwin(reclamp).readings, shown = test::RunTwin(hidden).readings;
  const auto honest = test::RunTwin(scenario).readings;
  double differs_V = 0.0;
  for (std::size_t k = 0; k < shown.size(); ++k) {
    for (int c = 0; c < kChannels; ++c) {
      EXPECT_NEAR(shown[k].mean_V[c], expected[k].mean_V[c], 1e-12);
      differs_V = std::max(differs_V, std::abs(shown[k].mean_V[c] - honest[k].mean_V[c]));
    }
  }
  EXPECT_GT(differs_V, 1e-3);
}

TEST(Effects, CrosstalkBringsTheChannelBeforeInTheScanList) {
  Scenario usual = Quiet(), other = usual;
  RotaryOf(other).adc.scan_list = {"psd_b_y", "psd_a_y", "psd_b_x", "psd_a_x"};
  for (const auto& [scenario, before] : {std::pair(usual, 0), {other, 3}}) {
    Pair pair(Effect("crosstalk", "psd_a_y", {{"fraction", 0.02}}), scenario);
    pair.Do(kTurnGrating);
    const Volts plain = Read(pair.without), mixed = Read(pair.with);
    EXPECT_NEAR(mixed[1], plain[1] + 0.02 * plain[before], 1e-12);
    for (const int c : {0, 2}) EXPECT_EQ(mixed[c], plain[c]);
  }
}

TEST(Effects, ConventionsExchangeAndInvertChannelsAndAReversedScaleReadsTheMirroredError) {
  const auto shown = [](const char* what, const Scenario& scenario,
                        const std::function<void(RotaryBench)>& action) {
    Pair pair(Effect("convention", what, {}), scenario);
    pair.Do(action);
    return std::pair(Read(pair.without), Read(pair.with));
  };
  const auto [plain, swapped] = shown("swap_xy_a", Quiet(), kTurnGrating);
  EXPECT_EQ(swapped, (Volts{plain[1], plain[0], plain[2], plain[3]}));
  EXPECT_EQ(shown("swap_psds", Quiet(), kTurnGrating).second, (Volts{plain[2], plain[3], plain[0], plain[1]}));
  EXPECT_EQ(shown("negate_psd_b_y", Quiet(), kTurnGrating).second,
            (Volts{plain[0], plain[1], plain[2], -plain[3]}));
  Scenario scenario = Quiet();
  RotaryOf(scenario).target.harmonics = {
      {Component::kEz, 1.0, 10.0 * units::arcsec, 0.5 * units::kPi}};  // -sin(angle)
  const auto to_90 = [](RotaryBench bench) { MoveBoth(bench, 90.0 * units::deg); };
  const auto [honest, reversed] = shown("reverse_target", scenario, to_90);
  EXPECT_NEAR(reversed[0], -honest[0], 1e-5);
  // One step of 10 deg later: cos(10 deg) of it.
  EXPECT_NEAR(shown("index_offset", scenario, to_90).second[0], honest[0] * std::cos(10.0 * units::deg), 1e-5);
}

}  // namespace
}  // namespace twinbench::sim
