#include "tests/core/input_error.h"
#include "tests/support/rotary_scenario.h"
#include "twin/benches/rotary_4dof/twin/twin.h"
#include "twin/model/local_level.h"
#include "twin/sim/environment.h"

namespace twinbench::sim {
namespace {

constexpr double kSine = 0.39;  // of the angle of both orders
const double kCosine = std::sqrt(1.0 - kSine * kSine);

/// A cube with edges of 10 mm.
FixtureSettings CubeAt(const Vector3& position_m) {
  FixtureSettings cube;
  cube.name = "cube";
  cube.box_m = Vector3::Constant(10.0 * units::mm);
  cube.position_m = position_m;
  return cube;
}

/// Half way from the grating to PSD A, in the order's light.
Vector3 BeforePsdA() { return 0.060 * Vector3(kSine, kCosine, 0.0); }

Acquisition ReadWith(const std::vector<FixtureSettings>& fixtures, const char* beam = "chief_ray") {
  Scenario scenario = Altered(test::RotaryScenario(), {std::string("laser.beam=") + beam, "laser.yaw_mrad=0.3",
                                                       "laser.pitch_mrad=-0.7"});  // not centred: bits can differ
  scenario.fixtures = fixtures;
  Twin twin(scenario);
  return twin.Bench().adc.Acquire(20, false);
}

void ExpectSameBits(const Acquisition& a, const Acquisition& b) {
  EXPECT_EQ(a.status, b.status);
  for (std::size_t c = 0; c < kChannels; ++c) {
    EXPECT_EQ(a.channel[c].mean_V, b.channel[c].mean_V);
    EXPECT_EQ(a.channel[c].std_V, b.channel[c].std_V);
  }
}

TEST(Fixture, InFrontOfAPsdOrThatLeavesLessThanTheLowLightFractionLeavesNoLight) {
  const Acquisition block = ReadWith({CubeAt(BeforePsdA())});
  EXPECT_EQ(block.status, ReadingStatus::kNoLight);
  EXPECT_TRUE(std::isnan(block.channel[0].mean_V));
  // A plate whose edge stands 0.6 mm = 2.4 standard deviations above the middle of the beam lets 0.8 % past: less
  // than the 2 % that the amplifier asks of the light without the plate.
  FixtureSettings plate = CubeAt(BeforePsdA() + Vector3(0.0, 0.0, -5.0 * units::mm + 0.6 * units::mm));
  EXPECT_EQ(ReadWith({plate}, "gaussian").status, ReadingStatus::kNoLight);
}

TEST(Fixture, BesideTheLightChangesNoBit) {
  for (const char* beam : {"chief_ray", "gaussian"}) {
    const Acquisition free = ReadWith({}, beam);
    EXPECT_EQ(free.status, ReadingStatus::kOk);
    ExpectSameBits(free, ReadWith({CubeAt(BeforePsdA() + Vector3(0.0, 0.0, 0.020))}, beam));
  }
}

TEST(Fixture, TurnsAboutItsOwnPlace) {
  // A plate along the order's light, beside it by 5 mm, meets the light when it stands across.
  FixtureSettings plate = CubeAt(BeforePsdA() + 5.0 * units::mm * Vector3(kCosine, -kSine, 0.0));
  plate.box_m = Vector3(1.0 * units::mm, 30.0 * units::mm, 30.0 * units::mm);
  plate.yaw_rad = -std::asin(kSine);
  EXPECT_EQ(ReadWith({plate}).status, ReadingStatus::kOk);
  plate.yaw_rad += 90.0 * units::deg;
  EXPECT_EQ(ReadWith({plate}).status, ReadingStatus::kNoLight);
}

TEST(Fixture, ThatRidesOnTheGratingTurnsWithIt) {
  // A yaw of 1 deg turns the order by 1 + 1 / cos = 2.09 deg: seen from the grating by 1.09 deg. The plate's edge
  // stands 1.6 deg beside the order, 1.67 mm at 60 mm. The spot stays on its PSD, at 4.4 of 5 mm.
  FixtureSettings plate = CubeAt(BeforePsdA() - 6.67 * units::mm * Vector3(kCosine, -kSine, 0.0));
  plate.box_m.y() = 1.0 * units::mm;
  plate.yaw_rad = -std::asin(kSine);
  for (const bool rides : {false, true}) {
    plate.rides_on_grating = rides;
    Scenario scenario = test::RotaryScenario();
    scenario.fixtures = {plate};
    Twin twin(scenario);
    EXPECT_EQ(twin.Bench().adc.Acquire(2, false).status, ReadingStatus::kOk);
    twin.Bench().goniometer.MoveTo(1.0 * units::deg, 0.0);
    EXPECT_EQ(twin.Bench().adc.Acquire(2, false).status, rides ? ReadingStatus::kOk : ReadingStatus::kNoLight);
  }
}

TEST(Fixture, OfAMeshFileStandsInTheLightLikeABox) {
  const TemporaryFolder folder;
  FixtureSettings mesh;
  mesh.name = "plate";
  mesh.position_m = BeforePsdA();
  mesh.mesh_file = folder.Write("plate.stl",
                                "solid\nfacet normal 0 1 0\nouter loop\nvertex -5 0 -5\nvertex 5 0 -5\n"
                                "vertex 0 0 5\nendloop\nendfacet\nendsolid\n");
  EXPECT_EQ(ReadWith({mesh}).status, ReadingStatus::kNoLight);
  mesh.mesh_unit_m = 1.0 * units::um;  // 10 um wide: the chief ray, 0.1 mm beside, passes
  EXPECT_EQ(ReadWith({mesh}).status, ReadingStatus::kOk);
}

Time At(double t_s) { return Time{} + FromSeconds(t_s); }

TEST(Environment, AddsDriftAndSwingToItsLevelOrInterpolatesARecord) {
  EnvironmentSettings settings;
  settings.drift_K_h = 0.5;
  settings.swing_K = 0.2;
  settings.swing_period_s = 1200.0;
  Environment room(settings, 1);
  EXPECT_NEAR(room.Temperature_degC(At(0.0)), 20.0, 1e-12);
  EXPECT_NEAR(room.Temperature_degC(At(300.0)), 20.0 + 0.5 / 12.0 + 0.2, 1e-12);
  EXPECT_NEAR(room.AboveReference_K(At(1200.0)), 0.5 / 3.0, 1e-12);
  const TemporaryFolder folder;
  EnvironmentSettings recorded;
  recorded.temperature_file = folder.Write("room.csv", "time_s,temperature_degC\n10,20\n20,21\n");
  EXPECT_DOUBLE_EQ(Environment(recorded, 1).Temperature_degC(At(15.0)), 20.5);
}

TEST(Environment, WalksAsFarAsItsFigureSaysAndTheSameWayWhicheverTimesAreAskedFor) {
  EnvironmentSettings settings;
  settings.random_walk_K_sqrt_h = 0.1;
  Environment often(settings, 7), once(settings, 7);
  for (int k = 0; k < 100; ++k) often.Temperature_degC(At(36.0 * k));
  EXPECT_EQ(often.Temperature_degC(At(3600.0)), once.Temperature_degC(At(3600.0)));
  double sum = 0.0;
  constexpr int kRooms = 400;
  for (std::uint64_t seed = 0; seed < kRooms; ++seed)
    sum += std::pow(Environment(settings, seed).AboveReference_K(At(4.0 * 3600.0)), 2);
  // 0.1 K after one hour is 0.2 K after four; relative deviation of the variance sqrt(2 / 400) = 0.07, 4 of them.
  EXPECT_NEAR(sum / kRooms / 0.04, 1.0, 0.28);
}

// Lengths are those of the scenario at environment.reference_degC and grow from there.

constexpr double kPsd_V_per_m = 2000.0, kWarmer_K = 15.0;

Scenario Warm() {
  Scenario scenario = Quiet();
  scenario.environment.temperature_degC = scenario.environment.reference_degC + kWarmer_K;
  return scenario;
}

/// Places of the spots, in channel order.
std::array<double, kChannels> Spots_m(const Scenario& scenario) {
  Twin twin(scenario);
  const Acquisition block = twin.Bench().adc.Acquire(4, false);
  std::array<double, kChannels> spots_m{};
  for (std::size_t c = 0; c < kChannels; ++c) spots_m[c] = block.channel[c].mean_V / kPsd_V_per_m;
  return spots_m;
}

TEST(ThermalLengths, PostLaserGratingAndDiodeMoveTheSpotsAsTheyWarm) {
  const double cosine = std::sqrt(1.0 - 0.39 * 0.39);
  // sin(theta) = wavelength x lines: grooves further apart by the share e turn the orders inwards by e tan(theta).
  const double inwards_m = 0.12 * 10e-6 * kWarmer_K * 0.39 / cosine,
               apart_m = 0.12 * 600e3 * 0.01e-9 * kWarmer_K / cosine;
  const double post_m = 2e-6 * kWarmer_K;
  const std::tuple<const char*, std::function<void(RotarySettings&)>, std::array<double, kChannels>, double>
      growing[] = {{"a post lowers the spot", [](auto& s) { s.psd_b.post_growth_m_K = 2e-6; },
                    {0.0, 0.0, 0.0, -post_m}, 1e-12},
                   {"the laser's lifts both", [](auto& s) { s.laser.post_growth_m_K = 2e-6; },
                    {0.0, post_m, 0.0, post_m}, 1e-11},
                   {"a grating turns the orders inwards", [](auto& s) { s.grating.expansion_per_K = 10e-6; },
                    {-inwards_m, 0.0, inwards_m, 0.0}, 1e-3 * inwards_m},
                   {"a longer wave turns them apart",
                    [](auto& s) { s.laser.wavelength_per_kelvin_m = 0.01 * units::nm; },
                    {apart_m, 0.0, -apart_m, 0.0}, 1e-3 * apart_m}};
  for (const auto& [claim, change, expected_m, within_m] : growing) {
    Scenario scenario = Warm();
    change(RotaryOf(scenario));
    const auto spots_m = Spots_m(scenario);
    for (std::size_t c = 0; c < kChannels; ++c)
      EXPECT_NEAR(spots_m[c], expected_m[c], within_m) << claim << " " << c;
  }
}

// Behind the grating a beam with the pitch p climbs by p over the distance.
TEST(ThermalLengths, ADistanceThatGrowsMakesALongerWay) {
  Scenario scenario = Warm();
  RotaryOf(scenario).laser.pitch_rad = 5e-3;
  const double before_m = Spots_m(scenario)[1];
  RotaryOf(scenario).psd_a.distance_expansion_per_K = 100e-6;
  const double expected_m = 0.12 * 100e-6 * kWarmer_K * 5e-3;
  EXPECT_NEAR(Spots_m(scenario)[1] - before_m, expected_m, 1e-2 * expected_m);
}

TEST(ThermalLengths, TheDiodeHopsToItsNextModeAsItWarms) {
  Scenario scenario = Altered(Quiet(), {"laser.mode_hop_K=2", "laser.mode_spacing_nm=0.25"});
  const auto wavelengths_off = [&](double above_K) {
    scenario.environment.temperature_degC = scenario.environment.reference_degC + above_K;
    const double turned_rad = 0.25e-9 * 600e3 / std::sqrt(1.0 - 0.39 * 0.39);  // of one hop
    return Spots_m(scenario)[0] / (0.12 * turned_rad);
  };
  EXPECT_NEAR(wavelengths_off(0.9), 0.0, 1e-6);
  EXPECT_NEAR(wavelengths_off(1.1), 1.0, 1e-2);
  EXPECT_NEAR(wavelengths_off(4.5), 2.0, 1e-2);
}

// A room every 40 s for three hours, by a thermometer with a noise of 0.3 K.
TEST(RoomBehindAThermometer, IsSteadyOrGoesItsWay) {
  constexpr double kNoise_K = 0.3;
  const struct {
    const char* claim;
    double drift_K_h, swing_K;
    double most;  // error rms, of the noise
  } rooms[] = {{"steady", 0.0, 0.0, 0.2}, {"drifts", -5.0, 0.0, 0.6}, {"swings in forty readings", 0.0, 2.0, 0.8}};
  for (const auto& room : rooms) {
    Stream noise(7, "thermometer");
    const Eigen::VectorXd time_s = 40.0 * Eigen::VectorXd::LinSpaced(270, 0.0, 269.0);
    const Eigen::VectorXd true_K =
        room.drift_K_h / 3600.0 * time_s.array() + room.swing_K * (time_s.array() * 2.0 * units::kPi / 1600.0).sin();
    const Eigen::VectorXd shown_K = true_K.unaryExpr([&](double K) { return K + kNoise_K * noise.Normal(); });
    const Eigen::VectorXd error_K = model::Smoothed(time_s, shown_K, kNoise_K) - true_K;
    EXPECT_LT(std::sqrt(error_K.squaredNorm() / 270.0), room.most * kNoise_K) << room.claim;
  }
}

}  // namespace
}  // namespace twinbench::sim
