#include "optics/bench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/optics/example_bench.h"
#include "tests/support/csv_rows.h"

namespace twinbench::optics {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Translation3d;
using Eigen::Vector3d;

using test::Number;
using Row = test::CsvRow;

/// Rotations in rad and translations in m of one table, as the table's six error columns give them.
struct Error {
  Vector3d rotation, translation;
};

Error ErrorOf(const Row& row, const std::string& table) {
  const auto at = [&](const char* name) { return Number(row, table + name); };
  return {kArcsec * Vector3d(at("_ex_arcsec"), at("_ey_arcsec"), at("_ez_arcsec")),
          1e-6 * Vector3d(at("_dx_um"), at("_dy_um"), at("_dz_um"))};
}

Isometry3d Rz(double angle) {
  return Isometry3d(AngleAxisd(angle, Vector3d::UnitZ()));
}

Isometry3d Pose(const Error& e) {
  return Translation3d(e.translation) * AngleAxisd(e.rotation.z(), Vector3d::UnitZ()) *
         AngleAxisd(e.rotation.y(), Vector3d::UnitY()) * AngleAxisd(e.rotation.x(), Vector3d::UnitX());
}

Isometry3d GratingPose(const Row& row) {
  const auto angle = [&](const char* name) { return Number(row, name) * kDegree; };
  const bool reclamp = row.at("mode") == "reclamp";
  const double reference = angle("reference_deg"), shift = angle("shift_deg");
  return Translation3d(0, -0.030, -0.130) * Pose(ErrorOf(row, "target")) * Rz(angle("target_deg")) *
         Translation3d(0, 0, 0.080) * Rz(reclamp ? 0.0 : -shift) * Pose(ErrorOf(row, "reference")) * Rz(reference) *
         Rz(reclamp ? -shift : 0.0) * Translation3d(0, 0.030, 0.050);
}

TEST(RotaryOptics, AgreesWithTheIndependentOracleToOneNanometre) {
  const std::vector<Row> rows = test::ReadCsvRows(std::string(TWINBENCH_TEST_DATA) + "/oracle/poses.csv");
  ASSERT_EQ(rows.size(), 300u);
  for (const Fidelity fidelity : {Fidelity::kTraced, Fidelity::kClosed}) {
    RotaryOpticsParameters parameters = ExampleBench();
    parameters.fidelity = fidelity;
    const RotaryOptics optics(parameters);
    for (const Row& row : rows) {
      const PsdSignals signals = optics.Trace(GratingPose(row), ExampleSource());
      ASSERT_EQ(signals.a.status, PsdStatus::kOk);
      // Demanded is 1 nm; the table's nine decimals of a micrometre allow 1e-15 m, the sums behind them 1e-14 m.
      EXPECT_NEAR(signals.a.u_m, Number(row, "psd_a_u_um") * 1e-6, 1e-13);
      EXPECT_NEAR(signals.a.v_m, Number(row, "psd_a_v_um") * 1e-6, 1e-13);
      EXPECT_NEAR(signals.b.u_m, Number(row, "psd_b_u_um") * 1e-6, 1e-13);
      EXPECT_NEAR(signals.b.v_m, Number(row, "psd_b_v_um") * 1e-6, 1e-13);
    }
    EXPECT_EQ(optics.rays_traced(), fidelity == Fidelity::kTraced ? 4u * rows.size() : 0u);
  }
}

TEST(RotaryOptics, ShowsPublishedSensitivityToRotationAboutTheGrooves) {
  RotaryOpticsParameters parameters = ExampleBench();
  parameters.psd_a.distance_m = 0.150;
  const RotaryOptics optics(parameters);
  const double step = 1.0 * kArcsec;
  const double u = optics.Trace(Rz(step), ExampleSource()).a.u_m;
  EXPECT_NEAR(std::abs(u), 1.517e-6, 0.5e-9);  // um per arcsec at 150 mm, four digits given
  // d beta = d gamma (1 + sec beta): the order turns by more than twice the angle.
  EXPECT_NEAR(std::abs(u), 0.150 * step * (1.0 + 1.0 / std::sqrt(1.0 - 0.39 * 0.39)), 2e-11);
}

TEST(RotaryOptics, ResolvesAMicroArcsecond) {
  const RotaryOptics optics(ExampleBench());
  const double step = 1e-6 * kArcsec;
  const double gain = 0.120 * (1.0 + 1.0 / std::sqrt(1.0 - 0.39 * 0.39));
  const double u0 = optics.Trace(Isometry3d::Identity(), ExampleSource()).a.u_m;
  // Rounding of coordinates of 0.1 m is 1e-17 m, six orders below the 1e-12 m step.
  EXPECT_NEAR((u0 - optics.Trace(Rz(step), ExampleSource()).a.u_m) / (gain * step), 1.0, 1e-4);
}

TEST(RotaryOptics, RotatesTheReadingWithARolledDetectorAndStretchesUWithTiltAboutV) {
  const auto seen = [](const Isometry3d& pose, double roll_rad, double tilt_v_rad) {
    RotaryOpticsParameters parameters = ExampleBench();
    parameters.psd_a.roll_rad = roll_rad;
    parameters.psd_a.tilt_v_rad = tilt_v_rad;
    return RotaryOptics(parameters).Trace(pose, ExampleSource()).a;
  };
  const Isometry3d pose = Pose({{20 * kArcsec, -30 * kArcsec, 50 * kArcsec}, {1e-6, 2e-6, 3e-6}});
  const PsdSignal straight = seen(pose, 0.0, 0.0), rolled = seen(pose, 0.01, 0.0);
  EXPECT_NEAR(rolled.u_m, std::cos(0.01) * straight.u_m + std::sin(0.01) * straight.v_m, 1e-16);
  EXPECT_NEAR(rolled.v_m, -std::sin(0.01) * straight.u_m + std::cos(0.01) * straight.v_m, 1e-16);
  // Similar triangles: the spot 30 um off centre meets a plane tilted by 0.1; second order is 0.1 u / distance.
  const double u_m = seen(Rz(20 * kArcsec), 0.0, 0.0).u_m;
  EXPECT_NEAR(seen(Rz(20 * kArcsec), 0.0, 0.1).u_m, u_m / std::cos(0.1), 3e-5 * std::abs(u_m));
}

TEST(RotaryOptics, TellsWhyThereIsNoReading) {
  RotaryOpticsParameters parameters = ExampleBench();
  const RotaryOptics optics(parameters);
  // 7.5 mm away from the centre, and 12 mm: the package ends at 9 mm.
  for (const double yaw : {0.03, 0.05})
    EXPECT_EQ(optics.Trace(Rz(yaw), ExampleSource()).a.status, PsdStatus::kMissed);
  const Isometry3d aside(Translation3d(0.013, 0, 0));
  EXPECT_EQ(optics.Trace(aside, ExampleSource()).a.status, PsdStatus::kNoLight);  // the laser misses the grating
  EXPECT_EQ(optics.Trace(Rz(std::numbers::pi), ExampleSource()).a.status, PsdStatus::kNoLight);  // its back
  SourceState red = ExampleSource();
  red.wavelength_m = 1700e-9;
  EXPECT_EQ(optics.Trace(Isometry3d::Identity(), red).b.status, PsdStatus::kNoLight);  // evanescent: 1.02 > 1
  SourceState dark = ExampleSource();
  dark.power_W = 0.0;
  EXPECT_EQ(optics.Trace(Isometry3d::Identity(), dark).a.status, PsdStatus::kNoLight);
}

TEST(RotaryOptics, ABlockerThatCutsTheOrderMakesDarknessOnThatDetectorOnly) {
  RotaryOpticsParameters parameters = ExampleBench();
  // Half way to detector A, on the order's line.
  const Isometry3d pose(Translation3d(0.06 * 0.39, 0.06 * std::sqrt(1 - 0.39 * 0.39), 0.0));
  parameters.blockers = {{BoxMesh({-2e-3, -2e-3, -2e-3}, {2e-3, 2e-3, 2e-3}), pose, false}};
  const PsdSignals signals = RotaryOptics(parameters).Trace(Isometry3d::Identity(), ExampleSource());
  EXPECT_EQ(signals.a.status, PsdStatus::kNoLight);
  EXPECT_EQ(signals.b.status, PsdStatus::kOk);
}

class EdgeInTheBeam : public ::testing::TestWithParam<Fidelity> {};

TEST_P(EdgeInTheBeam, PullsTheCentroidAsTheClosedFormSays) {
  RotaryOpticsParameters parameters = ExampleBench();
  parameters.fidelity = GetParam();
  parameters.beam = {.kind = BeamKind::kGaussian, .radius_m = 0.5e-3, .divergence_rad = 0.0, .profile = {}};
  // A plate that covers the upper half of the collimated beam, riding on the grating.
  parameters.blockers = {{BoxMesh({-5e-3, 0.01, 0.0}, {5e-3, 0.012, 5e-3}), Isometry3d::Identity(), true}};
  const PsdSignal a = RotaryOptics(parameters).Trace(Isometry3d::Identity(), ExampleSource()).a;
  EXPECT_EQ(a.status, PsdStatus::kClipped);
  EXPECT_NEAR(a.power_W, 0.5 * 0.339 * 5e-3, 1e-9);
  // Mean of the lower half of a normal of 0.25 mm: -0.25 mm sqrt(2/pi); equal slices keep the mean exactly.
  EXPECT_NEAR(a.v_m, -0.25e-3 * std::sqrt(2.0 / std::numbers::pi), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(BothWays, EdgeInTheBeam, ::testing::Values(Fidelity::kTraced, Fidelity::kClosed));

TEST(RotaryOptics, IrradianceHasTheCentroidAndPowerOfTheSignal) {
  RotaryOpticsParameters parameters = ExampleBench();
  parameters.beam = {.kind = BeamKind::kGaussian, .radius_m = 0.5e-3, .divergence_rad = 0.5e-3, .profile = {}};
  const RotaryOptics optics(parameters);
  const PsdSignals signals = optics.Trace(Rz(200 * kArcsec), ExampleSource());
  const std::vector<IrradianceMap> maps = optics.Irradiance(Rz(200 * kArcsec), ExampleSource(), 128);
  ASSERT_EQ(maps.size(), 2u);
  EXPECT_NEAR(Centroid(maps[0]).u_m, signals.a.u_m, 1e-10);  // float pixels: 1e-7 of the 0.25 mm spot
  EXPECT_NEAR(Centroid(maps[1]).v_m, signals.b.v_m, 1e-10);
  EXPECT_NEAR(Centroid(maps[0]).power_W, signals.a.power_W, 1e-9);
}

TEST(RotaryOptics, RefusesMissingParameters) {
  EXPECT_THROW(RotaryOptics(RotaryOpticsParameters{}), std::invalid_argument);
  RotaryOpticsParameters parameters = ExampleBench();
  parameters.nominal_wavelength_m = 1700e-9;
  EXPECT_THROW(RotaryOptics{parameters}, std::invalid_argument);
}

}  // namespace
}  // namespace twinbench::optics
