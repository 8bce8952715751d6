#include <gtest/gtest.h>

#include "optics/irradiance.h"
#include "tests/support/angle_benches.h"
#include "tests/support/small_scenario.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/follow.h"

namespace twinbench::sim {
namespace {

using model::Disturbance;
using units::arcsec;

constexpr double kVolts_per_metre = 2000.0;

/// The errors that the run's tables had at each reading, at the points where they enter.
std::vector<Disturbance> TablesOf(const test::TwinRun& run) {
  const char* const names[] = {"ex", "ey", "ez", "dx", "dy", "dz"};
  const int positions = RotaryOf(run.scenario).procedure.positions;
  const auto row = [positions](double angle_rad) {
    const long k = std::lround(angle_rad / (2.0 * units::kPi) * positions) % positions;
    return static_cast<std::size_t>(k < 0 ? k + positions : k);
  };
  std::vector<Disturbance> disturbances;
  for (const bool target : {true, false}) {
    const TableErrors& errors = target ? run.truth.target : run.truth.reference;
    for (std::size_t c = 0; c < kComponents; ++c) {
      Eigen::VectorXd value(std::ssize(run.readings));
      for (std::size_t i = 0; i < run.readings.size(); ++i) {
        const Reading& r = run.readings[i];
        value[static_cast<Eigen::Index>(i)] = errors.value[c][row(target ? r.target_rad : r.reference_rad)];
      }
      disturbances.push_back({(target ? "target." : "reference.") + std::string(names[c]), value});
    }
  }
  return disturbances;
}

/// The largest difference between what the twin showed and what it says that it should have shown.
double Apart_m(const test::TwinRun& run) {
  const Eigen::MatrixXd followed_V =
      FollowRotary(run.scenario, run.readings, std::make_shared<DrivesOnce>())->Predict(TablesOf(run));
  double apart_V = 0.0;
  for (std::size_t i = 0; i < run.readings.size(); ++i) {
    if (run.readings[i].status != ReadingStatus::kOk) continue;
    for (int c = 0; c < kChannels; ++c)
      apart_V =
          std::max(apart_V, std::abs(followed_V(static_cast<Eigen::Index>(i), c) - run.readings[i].mean_V[c]));
  }
  return apart_V / kVolts_per_metre;
}

/// A bench of which nothing is at its ideal value.
Scenario RichBench() {
  return Altered(
      test::SmallNoiseFree(),
      {"target.harmonics=[{ component = \"ez\", order = 1, amplitude_arcsec = 20, phase_deg = 17 }, "
       "{ component = \"dy\", order = 2, amplitude_um = 3, phase_deg = 57 }]",
       "reference.harmonics=[{ component = \"ex\", order = 1, amplitude_arcsec = 10, phase_deg = 6 }, "
       "{ component = \"dx\", order = 1, amplitude_um = 2 }]",
       "reference.centring_um=[4, -3]",
       "reference.mount_tilt_arcsec=[15, -10]",
       "target.half_frequency_tilt_arcsec=1",
       "target.backlash_arcsec=2",
       "laser.position_mm=[0.5, 200, 0]",
       "laser.yaw_mrad=0.05",
       "laser.pointing_yaw_per_kelvin_urad=20",
       "laser.wavelength_per_kelvin_nm=0.1",
       "psd_a.tilt_u_mrad=20",
       "psd_b.tilt_v_mrad=30",
       "amplifier.hum_mV=20",
       "amplifier.offset_mV=[10, -20, 30, 5]",
       "autocollimator.gain_error=0.002",
       "environment.drift_K_h=0.4",
       "environment.swing_mK=200",
       "mechanics.payload_mass_kg=5",
       "mechanics.payload_radius_mm=50",
       "procedure.dwell_s=[0.5, 1, 4]"});
}

// What is left is rounding in the chain and Newton's last step at the autocollimator.
constexpr double kRounding_m = 1e-12;
// A rotor in its backlash stands an arcsecond or two beside its stop, where its table errs by some 1e-10 rad more
// or less than at the stop; TablesOf looks at the stop.
constexpr double kBesideTheStop_m = 4e-10;

TEST(RotaryFollow, SaysWhatThePlainTwinShows) {
  EXPECT_LT(Apart_m(test::RunTwin(test::SmallNoiseFree())), kRounding_m);
}

TEST(RotaryFollow, SaysWhatARichTwinShowsReclampedAndThroughAWedgedWindowToo) {
  Scenario reclamped = RichBench(), wedged = RichBench();
  RotaryOf(reclamped).procedure.clamping = "reclamp";
  RotaryOf(wedged).psd_a.window = true;
  RotaryOf(wedged).psd_a.window_wedge_rad = 0.010;
  for (const Scenario& s : {RichBench(), reclamped, wedged}) EXPECT_LT(Apart_m(test::RunTwin(s)), kBesideTheStop_m);
}

/// A lopsided beam as a camera would have seen it.
std::string BeamFile() {
  optics::IrradianceMap map;
  map.width = map.height = 64;
  map.pitch_m = 25.0 * units::um;
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      const double x = map.U(column) / (0.2 * units::mm), y = map.V(row) / (0.15 * units::mm);
      map.irradiance_W_m2.push_back(static_cast<float>(std::exp(-0.5 * (x * x + y * y)) *
                                                       (1.2 + std::sin(2.0 * x) + 0.2 * std::cos(5.0 * y))));
    }
  }
  const std::string path = testing::TempDir() + "twinbench_beam.exr";
  optics::WriteIrradianceMaps(path, {map});
  return path;
}

TEST(RotaryFollow, SaysWhatAMeasuredBeamShowsToANanometre) {
  Scenario s = RichBench();
  RotaryOf(s).laser.beam = "profile";
  RotaryOf(s).laser.profile_file = BeamFile();
  RotaryOf(s).psd_a.cubic_per_m2 = RotaryOf(s).psd_b.cubic_per_m2 = 1000.0;
  RotaryOf(s).procedure.positions = 6;
  const test::TwinRun run = test::RunTwin(s);
  EXPECT_GT(run.rays_traced, 4u * 4096u * run.readings.size());  // every pixel, at four slopes
  EXPECT_LT(Apart_m(run), 1e-9);
}

TEST(RotaryFollow, KnowsTheDynamicsOfTheLinearStackAndItsFriction) {
  Scenario rich = RichBench(), rubbing = test::SmallNoiseFree();
  RotaryOf(rich).mechanics.fidelity = RotaryOf(rubbing).mechanics.fidelity = "linear";
  RotaryOf(rubbing).mechanics.friction_Nm = {0.2, 0.1};
  // The record says when a reading was taken, not for how long the servo had rung.
  for (const Scenario& s : {rich, rubbing}) EXPECT_LT(Apart_m(test::RunTwin(s)), 1e-9);
}

TEST(RotaryFollow, SaysWhatBodiesByBulletShow) {
  Scenario s = RichBench();
  RotaryOf(s).mechanics.fidelity = "bullet";
  RotaryOf(s).procedure.positions = 4;
  RotaryOf(s).procedure.shifts = {0, 1};
  EXPECT_LT(Apart_m(test::RunTwin(s)), 1e-9);
  RotaryOf(s).target.backlash_rad = RotaryOf(s).reference.backlash_rad = 0.0;
  RotaryOf(s).mechanics.cable_stiffness_Nm_rad = {0.3, 0.2};
  RotaryOf(s).mechanics.encoder_subdivision_rad = {0.3 * units::arcsec, 0.2 * units::arcsec};
  EXPECT_LT(Apart_m(test::RunTwin(s)), 1e-10);
}

class RotaryFollowEffect : public testing::TestWithParam<EffectEntry> {};

TEST_P(RotaryFollowEffect, IsFollowed) {
  for (const std::string& where : GetParam().places.empty() ? std::vector<std::string>{""} : GetParam().places) {
    Scenario s = RichBench();
    EffectSettings effect = test::PlainEffect(GetParam());
    effect.where = where;
    s.effects = {effect};
    // Labels that are not the rotors' angles change which of the tables' errors act; those are free here.
    if (where.starts_with("reverse") || where == "index_offset")
      RotaryOf(s).target.harmonics = RotaryOf(s).reference.harmonics = {};
    EXPECT_LT(Apart_m(test::RunTwin(s)), kBesideTheStop_m) << effect.name << " " << where;
  }
}

std::vector<EffectEntry> ForeseeableRotaryEffects() {
  std::vector<EffectEntry> entries = EffectCatalogue(kRotaryBench);
  std::erase_if(entries, [](const EffectEntry& e) { return e.name == "outliers"; });
  return entries;
}

INSTANTIATE_TEST_SUITE_P(All, RotaryFollowEffect, testing::ValuesIn(ForeseeableRotaryEffects()),
                         [](const auto& tested) { return tested.param.name; });

// At 20 Hz a block of 16 ms holds 0.84 of a tone's amplitude, a sixth of a turn later than at its begin.
TEST(RotaryFollow, AveragesAToneOverTheBlock) {
  Scenario s = RichBench();
  RotaryOf(s).adc.samples = 1000;
  s.effects = {{"tone", "all", {{"amplitude", 1e-6}, {"frequency", 20.0}, {"phase", 0.3}}, "test"}};
  constexpr double kMultiplexer_m = 2e-9;  // channels are converted up to 12 us one after the other
  EXPECT_LT(Apart_m(test::RunTwin(s)), kMultiplexer_m);
}

TEST(RotaryFollow, DoesNotForeseeSingleOutliers) {
  Scenario s = test::SmallNoiseFree();
  s.effects = {{"outliers", "", {{"fraction", 0.3}, {"size", 50e-6}}, ""}};
  EXPECT_GT(Apart_m(test::RunTwin(s)), 20e-6);
}

// A fixed beam on a grating that yaws by e turns the orders by e (1 + 1 / cos theta), one that tilts by e (1 + cos
// theta); a lateral shift d moves the orders by d sin theta across themselves; the laser's pitch has its own lever
// beside the way to the PSD. Signs: formats.md.
TEST(RotaryFollow, HasTheSlopesOfTheClosedForms) {
  const test::TwinRun run = test::RunTwin(test::SmallNoiseFree());
  const auto follow = FollowRotary(run.scenario, run.readings, std::make_shared<DrivesOnce>());
  const Eigen::Index stop = std::ssize(run.readings) - 1;
  const double sine = 0.39, cosine = std::sqrt(1.0 - sine * sine), l1_m = 0.120, lever_m = 0.2;
  const auto slope = [&](const char* point) {
    return Eigen::RowVector4d(model::Slope(*follow, model::PointNamed(*follow, point)).row(stop) /
                              kVolts_per_metre);
  };
  const double yaw = l1_m * (1.0 + 1.0 / cosine), tilt = l1_m * (1.0 + cosine), pitch = lever_m + l1_m;
  const std::tuple<const char*, int, double> expected[] = {{"mount.ez", 0, -yaw}, {"mount.ez", 2, -yaw},
                                                           {"grating.tilt", 1, tilt}, {"grating.tilt", 3, tilt},
                                                           {"grating.roll", 1, -l1_m * sine},
                                                           {"grating.roll", 3, l1_m * sine},
                                                           {"grating.lateral", 0, -sine},
                                                           {"grating.lateral", 2, sine}, {"laser.pitch", 1, pitch}};
  for (const auto& [point, channel, value] : expected)
    EXPECT_NEAR(slope(point)[channel] / value, 1.0, 1e-6) << point;
  EXPECT_NEAR(slope("psd_b_y")[3], 1.0, 1e-9);
  // Target and grating differ by the height of the spot and by where the axes stand.
  EXPECT_NEAR(slope("target.ez")[0] / slope("grating.yaw")[0], 1.0, 1e-3);
}

}  // namespace
}  // namespace twinbench::sim
