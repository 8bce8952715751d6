#include "twin/benches/turntable_autocollimator/estimators/polygon_means.h"

#include <gtest/gtest.h>

#include "tests/separate/nulled_polygon.h"

namespace twinbench::separate::turntable {
namespace {

using units::arcsec;

TEST(ClosePolygonByMeans, IsLeastSquaresForEvenClampings) {
  Stream truth(1, "truth"), noise(1, "noise");
  NulledPolygon polygon = AnyPolygon(24, EvenOffsets(25), {1, 2, 7}, truth);
  polygon.noise_rad = 0.03 * arcsec;
  polygon.passes = 2;
  const auto readings = polygon.Read(noise);
  const PolygonClosure means = ClosePolygonByMeans(readings, 24, 8), squares = ClosePolygon(readings, 24, 8);
  EXPECT_LT(ClosureBias_rad(means.turntable, squares.turntable) / arcsec, 1e-9);
  EXPECT_LT(ClosureBias_rad(means.polygon, squares.polygon) / arcsec, 1e-9);
  EXPECT_NEAR(means.turntable.U_rad(100) / squares.turntable.U_rad(100), 1.0, 1e-9);
  EXPECT_NEAR(means.polygon.U_rad(5) / squares.polygon.U_rad(5), 1.0, 1e-9);
  EXPECT_NEAR(means.noise.scale * means.noise.u_rad, squares.noise.scale * squares.noise.u_rad, 1e-12 * arcsec);
}

// The mean of a wave over the clampings is what the faces take of it, and what the encoder loses.
TEST(ClosePolygonByMeans, GivesFacesTheMeanOfTheEncodersWavesOverUnevenClampings) {
  Stream truth(2, "truth"), noise(2, "noise");
  NulledPolygon polygon = AnyPolygon(12, {0.0, 20.0, 50.0}, {2}, truth);
  const PolygonClosure means = ClosePolygonByMeans(polygon.Read(noise), 12, 3);
  for (std::size_t i = 0; i < means.face.size(); ++i) {
    double expected_rad = polygon.face_rad[static_cast<std::size_t>(means.face[i])];
    for (const double offset_deg : polygon.offsets_deg)
      expected_rad += polygon.Encoder_rad((offset_deg + 30.0 * means.face[i]) * units::deg) / 3.0;
    EXPECT_NEAR(means.polygon.value_rad[static_cast<Eigen::Index>(i)] / arcsec, expected_rad / arcsec, 1e-9);
  }
}

}  // namespace
}  // namespace twinbench::separate::turntable
