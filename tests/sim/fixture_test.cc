#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/input_error.h"
#include "tests/support/rotary_scenario.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/twin.h"

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
Vector3 BeforePsdA() {
  return 0.060 * Vector3(kSine, kCosine, 0.0);
}

Acquisition ReadWith(const std::vector<FixtureSettings>& fixtures, const char* beam = "chief_ray") {
  Scenario scenario = test::RotaryScenario();
  RotaryOf(scenario).laser.beam = beam;
  RotaryOf(scenario).laser.yaw_rad = 0.3 * units::mrad;  // spots out of the centres, so that bits can differ
  RotaryOf(scenario).laser.pitch_rad = -0.7 * units::mrad;
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

}  // namespace
}  // namespace twinbench::sim
