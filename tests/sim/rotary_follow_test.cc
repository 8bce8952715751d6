#include "optics/irradiance.h"
#include "tests/core/input_error.h"
#include "tests/support/angle_benches.h"
#include "tests/support/small_scenario.h"
#include "twin/benches/encoder_comparison/twin/twin.h"
#include "twin/benches/rotary_4dof/twin/twin.h"

namespace twinbench::sim {
namespace {

using model::Disturbance;
using units::arcsec;

constexpr double kVolts_per_metre = 2000.0;

/// Readings x channels.
Eigen::MatrixXd Shown_V(const std::vector<Reading>& readings) {
  Eigen::MatrixXd shown_V(std::ssize(readings), kChannels);
  for (Eigen::Index i = 0; i < shown_V.rows(); ++i)
    shown_V.row(i) = Eigen::RowVector4d::Map(readings[static_cast<std::size_t>(i)].mean_V.data());
  return shown_V;
}

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

Eigen::MatrixXd Followed_V(const test::TwinRun& run, const std::vector<Disturbance>& disturbances = {}) {
  return FollowRotary(run.scenario, run.readings, std::make_shared<DrivesOnce>())->Predict(disturbances);
}

/// The largest difference between what the twin showed and what it says that it should have shown.
double Apart_m(const test::TwinRun& run) {
  for (const Reading& r : run.readings) EXPECT_EQ(r.status, ReadingStatus::kOk);
  return (Followed_V(run, TablesOf(run)) - Shown_V(run.readings)).cwiseAbs().maxCoeff() / kVolts_per_metre;
}

/// A bench of which nothing is at its ideal value.
Scenario RichBench() {
  return Altered(test::SmallNoiseFree(),
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
  const Scenario rich = RichBench(), reclamped = Altered(rich, {"procedure.clamping=reclamp"}),
                 wedged = Altered(rich, {"psd_a.window=true", "psd_a.window_wedge_mrad=10"});
  for (const Scenario& s : {rich, reclamped, wedged}) EXPECT_LT(Apart_m(test::RunTwin(s)), kBesideTheStop_m);
}

/// A lopsided beam as a camera would have seen it.
std::string BeamFile() {
  optics::IrradianceMap map{.width = 64, .height = 64, .pitch_m = 25.0 * units::um};
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
  const test::TwinRun run = test::RunTwin(
      Altered(RichBench(), {"laser.beam=profile", "laser.profile_file=" + BeamFile(), "psd_a.cubic_per_m2=1000",
                            "psd_b.cubic_per_m2=1000", "procedure.positions=6"}));
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
  const Scenario s = Altered(RichBench(), {"mechanics.fidelity=bullet", "procedure.positions=4", "procedure.shifts=[0, 1]"});
  EXPECT_LT(Apart_m(test::RunTwin(s)), 1e-9);
  const Scenario cabled = Altered(s, {"target.backlash_arcsec=0", "mechanics.cable_stiffness_Nm_rad=[0.3, 0.2]",
                                      "mechanics.encoder_subdivision_arcsec=[0.3, 0.2]"});
  EXPECT_LT(Apart_m(test::RunTwin(cabled)), 1e-10);
}

/// Single outliers nobody can foresee.
TEST(RotaryFollow, KnowsEveryEffectOfTheCatalogueAtEveryPlaceButNoOutliers) {
  for (const EffectEntry& entry : EffectCatalogue(kRotaryBench)) {
    for (const std::string& where : entry.places.empty() ? std::vector<std::string>{""} : entry.places) {
      Scenario s = RichBench();
      s.effects = {test::PlainEffect(entry)};
      s.effects[0].where = where;
      // Labels that are not the rotors' angles change which of the tables' errors act; those are free here.
      if (where.starts_with("reverse") || where == "index_offset")
        RotaryOf(s).target.harmonics = RotaryOf(s).reference.harmonics = {};
      const double apart_m = Apart_m(test::RunTwin(s));
      EXPECT_EQ(apart_m < kBesideTheStop_m, entry.name != "outliers") << entry.name << " " << where;
    }
  }
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

// A small bench without noise before and after a change of a key: the twin which follows the records shows the same
// difference.

constexpr int kBlockScans = 1000;  // 16 ms
constexpr double kConversion_s = 4e-6, kTone_V = 2e-3;

struct FollowedKey {
  std::string name;
  std::function<void(Scenario&)> prepare;
  std::function<void(RotarySettings&)> change;
  double within_V, at_least_V;  // of each reading's difference; of what the change does to some reading
};

void AddTone(Scenario& s, double frequency_Hz, const std::string& signal = "") {
  s.effects = {{signal.empty() ? "tone" : "signal", signal.empty() ? "all" : signal,
                {{"amplitude", 1e-6}, {"frequency", frequency_Hz}, {"phase", 0.4}}, "test"}};
  if (!signal.empty()) s.effects[0].signal = "tone";
  RotaryOf(s).adc.samples = kBlockScans;
}

FollowedKey PassedTone(double frequency_Hz, double corner_Hz) {
  // Channels are converted up to 12 us one after the other, of which the twin that follows knows nothing.
  const double x = units::kPi * frequency_Hz * kBlockScans * 4.0 * kConversion_s;
  const double open_V = kTone_V * std::abs(std::sin(x) / x);
  return {fmt::format("a low-pass of {} Hz behind a tone of {} Hz", corner_Hz, frequency_Hz),
          [=](Scenario& s) { AddTone(s, frequency_Hz); },
          [=](RotarySettings& s) { s.chain.low_pass_Hz = corner_Hz; },
          1.5 * open_V * units::turn * frequency_Hz * 3.0 * kConversion_s, 0.015 * open_V};
}

/// A table that creeps in with exp(-t / constant), long after it has arrived: 1 / (1 - lag / constant) of it.
FollowedKey PassedCreep(double corner_Hz) {
  return {fmt::format("a low-pass of {} Hz as a table creeps in", corner_Hz),
          [](Scenario& s) {
            s.effects = {{"settling", "", {{"amplitude", 5.0 * units::arcsec}, {"time_constant", 0.2}}, "test"}};
            RotaryOf(s).adc.samples = kBlockScans;
            RotaryOf(s).procedure.dwell_s = {0.02};
          },
          [=](RotarySettings& s) { s.chain.low_pass_Hz = corner_Hz; }, 1e-6, 20e-6};
}

std::vector<FollowedKey> FollowedKeys(const TemporaryFolder& folder) {
  const auto nothing = [](Scenario&) {};
  const std::string inl = folder.Write("inl.csv", "voltage_V,error_mV\n-10,5\n0,0\n10,5\n");
  return {PassedTone(20, 100),
          PassedTone(20, 1000), PassedTone(137, 100), PassedTone(137, 1000), PassedTone(970, 100),
          PassedTone(970, 1000), PassedCreep(5), PassedCreep(50),
          {"a low-pass behind a signal", [](Scenario& s) { AddTone(s, 137.0, "psd_b_y"); },
           [](RotarySettings& s) { s.chain.low_pass_Hz = 100.0; }, 3e-6, 50e-6},
          {"a converter that is not straight", nothing, [=](RotarySettings& s) { s.adc.inl_file = inl; }, 0.02e-3,
           0.2e-3},
          {"speckle", nothing,
           [](RotarySettings& s) {
             s.grating.speckle_m = 2e-6;
             s.grating.speckle_correlation_rad = 130.0 * units::arcsec;
           },
           2e-6, 2000.0 * 2e-6},
          {"a ruling that an eccentric table moves under the beam",
           [](Scenario& s) { RotaryOf(s).centring_m = {1e-3, 0.5e-3}; },
           [](RotarySettings& s) {
             s.grating.ruling_chirp_per_m = 50e-6 / units::mm;
             s.grating.sphere_m = 100e-9;
           },
           2e-6, 1e-3},
          {"a power that drifts beside a background",
           [](Scenario& s) {
             RotaryOf(s).laser.pitch_rad = 5e-3;
             RotaryOf(s).psd_a.background_A = RotaryOf(s).psd_b.background_A = 100e-6;
           },
           [](RotarySettings& s) { s.laser.power_drift_per_s = -0.3 / units::hour; }, 5e-6, 5e-3}};
}

TEST(RotaryFollow, ShowsWhatAKeyChanges) {
  const TemporaryFolder folder;
  for (const FollowedKey& key : FollowedKeys(folder)) {
    SCOPED_TRACE(key.name);
    Scenario scenario = test::SmallNoiseFree();
    key.prepare(scenario);
    const test::TwinRun before = test::RunTwin(scenario);
    key.change(RotaryOf(scenario));
    const test::TwinRun after = test::RunTwin(scenario);
    const Eigen::MatrixXd change_V = Shown_V(after.readings) - Shown_V(before.readings);
    EXPECT_LE((Followed_V(after) - Followed_V(before) - change_V).cwiseAbs().maxCoeff(), key.within_V);
    EXPECT_GT(change_V.cwiseAbs().maxCoeff(), key.at_least_V);
  }
}

Scenario Bench(const std::string& kind) {
  return LoadScenario(test::ScenarioPath("encoder_comparison.toml"),
                      {"encoder_procedure.kind=" + kind, "noise_free=true", "device.lines_per_turn=30",
                       "device.teeth=22", "encoder_procedure.mounting_deg=[0, 57]"});
}

double Apart_rad(const Scenario& scenario) {
  const std::vector<Reading> readings = test::RunEncoderTwin(scenario).readings;
  const Eigen::MatrixXd followed_rad = FollowEncoder(scenario, readings)->Predict();
  double apart_rad = 0.0;
  for (std::size_t i = 0; i < readings.size(); ++i)
    apart_rad =
        std::max(apart_rad, std::abs(followed_rad(static_cast<Eigen::Index>(i), 0) - readings[i].measured_rad));
  return apart_rad;
}

// Where the reference errs, the shaft's angle is solved for; the rest is rounding of angles of some turns.
TEST(EncoderFollow, KnowsEveryEffectOfTheCatalogueAtStopsAndInMotionButNoOutliers) {
  for (const EffectEntry& entry : EffectCatalogue(kEncoderBench)) {
    for (const char* kind : {"stops", "sweep"}) {
      Scenario s = Bench(kind);
      s.effects = {test::PlainEffect(entry)};
      EXPECT_EQ(Apart_rad(s) < 1e-12, entry.name != "outliers") << entry.name << " " << kind;
    }
  }
}

TEST(EncoderFollow, HasAShaftUnderBothAndADeviceBesideIt) {
  const Scenario s = Bench("stops");
  const std::vector<Reading> readings = test::RunEncoderTwin(s).readings;
  const auto follow = FollowEncoder(s, readings);
  for (const model::Point& point : follow->Points())
    EXPECT_TRUE(model::Slope(*follow, point).isOnes(1e-6)) << point.name;
}

}  // namespace
}  // namespace twinbench::sim
