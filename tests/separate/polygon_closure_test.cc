#include "twin/benches/turntable_autocollimator/estimators/polygon_closure.h"

#include "tests/core/input_error.h"
#include "tests/separate/waves.h"
#include "tests/support/kept_text.h"
#include "twin/benches/turntable_autocollimator/estimators/polygon_means.h"
#include "twin/benches/turntable_autocollimator/estimators/polygon_readings.h"
#include "twin/benches/turntable_autocollimator/estimators/tilt_squared.h"
#include "twin/core/stream.h"
#include "twin/core/units.h"

namespace twinbench::separate::turntable {
namespace {

// A turntable's encoder and a polygon written down in a few lines, independent of the program.

using test::CoefficientOf, test::ValueOf, test::Wave;

struct NulledPolygon {
  int faces = 24;
  std::vector<double> offsets_deg = {};
  std::vector<Wave> encoder = {};
  std::vector<double> face_rad = {};  // zero mean
  double noise_rad = 0.0;
  int passes = 1;
  std::uint64_t seed = 1;

  /// Constants of the clampings: 5, -10, 15 ... arcsec.
  std::vector<FaceReading> Read() const {
    Stream noise(seed, "noise");
    std::vector<FaceReading> readings;
    for (std::size_t c = 0; c < offsets_deg.size(); ++c) {
      for (int pass = 0; pass < passes; ++pass) {
        for (int face = 0; face < faces; ++face) {
          const double angle_rad = (offsets_deg[c] + face * 360.0 / faces) * units::deg;
          const double constant_rad = (c % 2 == 0 ? 5.0 : -5.0) * static_cast<double>(c + 1) * units::arcsec;
          readings.push_back({static_cast<int>(c), face, 1, angle_rad,
                              ValueOf(encoder, angle_rad) + face_rad[static_cast<std::size_t>(face)] +
                                  constant_rad + noise_rad * noise.Normal()});
        }
      }
    }
    return readings;
  }
};

/// So many clampings evenly round the circle.
std::vector<double> EvenOffsets(int clampings) {
  std::vector<double> offsets_deg;
  for (int c = 0; c < clampings; ++c) offsets_deg.push_back(c * 360.0 / clampings);
  return offsets_deg;
}

/// Waves of these orders, faces of half an arcsecond.
NulledPolygon AnyPolygon(int faces, const std::vector<double>& offsets_deg, const std::vector<int>& orders,
                         std::uint64_t seed = 1, double noise_rad = 0.0, int passes = 1) {
  Stream truth(seed, "truth");
  NulledPolygon polygon{.noise_rad = noise_rad, .passes = passes, .seed = seed};
  polygon.faces = faces;
  polygon.offsets_deg = offsets_deg;
  for (const int order : orders)
    polygon.encoder.push_back({order, truth.Normal(), units::turn * truth.Uniform()});
  double mean_rad = 0.0;
  for (int face = 0; face < faces; ++face) {
    polygon.face_rad.push_back(0.5 * units::arcsec * truth.Normal());
    mean_rad += polygon.face_rad.back() / faces;
  }
  for (double& error_rad : polygon.face_rad) error_rad -= mean_rad;
  return polygon;
}

using testing::HasSubstr;
using units::arcsec;

std::vector<int> OrdersUpTo(int highest) {
  std::vector<int> orders;
  for (int k = 1; k <= highest; ++k) orders.push_back(k);
  return orders;
}

/// "24c 25p 60l": hidden orders by constants, polygon, lower orders.
std::string HiddenOf(const PolygonClosure& closure) {
  std::string text;
  for (const HiddenOrder& h : closure.hidden) {
    const char* by = h.by == OrderHidden::kByConstants ? "c" : h.by == OrderHidden::kByPolygon ? "p" : "l";
    text += (text.empty() ? "" : " ") + std::to_string(h.order) + by;
  }
  return text;
}

/// Largest error of a fitted wave [arcsec].
double WorstWave_arcsec(const PolygonClosure& closure, const NulledPolygon& truth) {
  double worst = 0.0;
  for (const Wave& w : truth.encoder) {
    if (w.order > closure.encoder.highest_order) continue;
    const Eigen::Vector2d found =
        closure.encoder.coefficients_rad.segment<2>(2 * w.order - 1);  // of cosine and sine
    worst = std::max(worst, std::abs(std::complex(found[0], -found[1]) - CoefficientOf({w}, w.order)) / arcsec);
  }
  return worst;
}

double WorstFace_arcsec(const PolygonClosure& closure, const NulledPolygon& truth) {
  double worst = 0.0;
  for (std::size_t i = 0; i < closure.face.size(); ++i)
    worst = std::max(worst, std::abs(closure.polygon.value_rad[static_cast<Eigen::Index>(i)] -
                                     truth.face_rad[static_cast<std::size_t>(closure.face[i])]) /
                                arcsec);
  return worst;
}

constexpr double kExact_arcsec = 1e-8;

TEST(ClosePolygon, FindsEncoderAndFacesExactlyWithoutNoiseAlsoWhereAHigherOrderIsHidden) {
  const std::tuple<std::vector<double>, std::vector<int>, int> cases[] = {
      {EvenOffsets(25), OrdersUpTo(20), 20}, {{0.0, 7.3, 101.0, 215.7}, OrdersUpTo(20), 20},
      {EvenOffsets(25), {1, 2, 5, 24}, 6}};
  for (const auto& [offsets_deg, orders, highest] : cases) {
    const NulledPolygon polygon = AnyPolygon(24, offsets_deg, orders);
    const PolygonClosure closure = ClosePolygon(polygon.Read(), 24, highest);
    EXPECT_EQ(HiddenOf(closure), "");
    EXPECT_LT(WorstWave_arcsec(closure, polygon), kExact_arcsec);
    EXPECT_LT(WorstFace_arcsec(closure, polygon), kExact_arcsec);
  }
}

TEST(ClosePolygon, PutsAFaceAtItsOwnAngleOnThePolygon) {
  const NulledPolygon polygon = AnyPolygon(8, EvenOffsets(3), {1});
  const PolygonClosure closure = ClosePolygon(polygon.Read(), 8, 2);
  EXPECT_EQ(closure.face, (std::vector<int>{0, 7, 6, 5, 4, 3, 2, 1}));
  EXPECT_NEAR(closure.polygon.position_rad[1] / units::deg, 45.0, 1e-9) << "face 7 is seen at 315 deg";
}

TEST(ClosePolygon, NamesWhatConstantsAndFacesHide) {
  const auto hidden = [&](const std::vector<double>& offsets_deg, int highest) {
    return HiddenOf(ClosePolygon(AnyPolygon(24, offsets_deg, {1}).Read(), 24, highest));
  };
  EXPECT_EQ(hidden(EvenOffsets(25), 60), "24c 25p 48c 50p");
  EXPECT_EQ(hidden({0.0, 7.3, 101.0, 215.7}, 26), "24c");
  EXPECT_EQ(hidden({0.0}, 3), "1p 2p 3p") << "one clamping tells nothing apart";
  EXPECT_EQ(hidden({0.0, 180.0}, 4), "2p 4p");
}

// 3 clampings of 8 faces are 24 even positions: order k looks like order 24 - k.
TEST(ClosePolygon, NamesOrdersThatTheAnglesDoNotTellFromLowerOnes) {
  const PolygonClosure closure = ClosePolygon(AnyPolygon(8, EvenOffsets(3), {1}).Read(), 8, 14);
  EXPECT_EQ(HiddenOf(closure), "3p 6p 8c 9p 12p 13l 14l");
  EXPECT_THAT(closure.notes, testing::Contains(HasSubstr("orders 13, 14 of the encoder look like lower orders")));
}

// Waves of N even positions are orthogonal with squares of N / 2: each order adds 2 s^2 / N to the variance of the
// curve.
TEST(ClosePolygon, StatesTwiceTheOrdersOverTheReadings) {
  const NulledPolygon polygon = AnyPolygon(24, EvenOffsets(25), {1}, 3, 0.03 * arcsec, 4);
  const PolygonClosure closure = ClosePolygon(polygon.Read(), 24, 5);
  EXPECT_EQ(closure.noise.dof, 600 * 3);
  // The scatter is known to sqrt(1 / 3600), 1.7 %.
  EXPECT_NEAR(closure.noise.u_rad / arcsec, 0.03, 4 * 0.017 * 0.03);
  const double expected_rad = closure.noise.scale * closure.noise.u_rad * std::sqrt(2.0 * 5 / 2400);
  for (Eigen::Index i = 0; i < 600; i += 37) EXPECT_NEAR(closure.turntable.U_rad(i) / expected_rad, 1.0, 1e-9);
  const double face_rad = closure.noise.scale * closure.noise.u_rad * std::sqrt((1.0 - 1.0 / 24) / 100);
  for (Eigen::Index i = 0; i < 24; i += 5) EXPECT_NEAR(closure.polygon.U_rad(i) / face_rad, 1.0, 1e-9);
}

// Estler, J. Res. NIST 103 (1998) 141: dual closure, n clampings a face apart, gives every angle with s sqrt(n - 1)
// / n.
TEST(ClosePolygon, IsDualClosureWhereClampingsAreAFaceApart) {
  const NulledPolygon polygon = AnyPolygon(12, EvenOffsets(12), {1, 5}, 4, 0.1 * arcsec);
  const PolygonClosure closure = ClosePolygon(polygon.Read(), 12, 5);
  EXPECT_FALSE(closure.noise.is_of_repeats);
  EXPECT_EQ(closure.dof, 144 - 12 - 11 - 10);
  EXPECT_NEAR(closure.polygon.U_rad(3), closure.noise.u_rad * std::sqrt(11.0) / 12.0, 1e-9 * arcsec);
}

TEST(ClosePolygon, SaysThatThereAreOrdersAboveTheHighest) {
  const NulledPolygon polygon = AnyPolygon(24, EvenOffsets(25), {1, 9}, 5, 0.03 * arcsec, 2);
  const PolygonClosure closure = ClosePolygon(polygon.Read(), 24, 5);
  EXPECT_GT(closure.noise.scale, 2.0);
  EXPECT_THAT(closure.notes, testing::Contains(HasSubstr("orders above the highest")));
}

/// Orders above repeat in all readings of an angle: twenty-five clampings do not make them less. Even and uneven ones.
TEST(ClosePolygon, StatesACurveNoBetterThanTheOrdersItLacks) {
  for (const std::vector<double>& offsets_deg : {EvenOffsets(25), std::vector{0.0, 3.1, 11.0, 52.4, 140.7, 201.3}}) {
    const NulledPolygon polygon = AnyPolygon(24, offsets_deg, {1, 2, 3, 5, 8}, 21, 0.03 * arcsec, 2);
    const std::vector<FaceReading> readings = polygon.Read();
    const PolygonClosure lacking = ClosePolygon(readings, 24, 3), whole = ClosePolygon(readings, 24, 8);
    double lost_rad2 = 0.0;
    for (const Wave& w : polygon.encoder)
      lost_rad2 += w.order > 3 ? 0.5 * std::pow(w.amplitude_arcsec * arcsec, 2) : 0.0;
    EXPECT_NEAR(lacking.encoder.u_unmodelled_rad, std::sqrt(lost_rad2), 0.05 * std::sqrt(lost_rad2));
    EXPECT_THAT(lacking.notes, testing::Contains(HasSubstr("orders 5, 8 of the turntable's angle stand out")));
    EXPECT_GT(lacking.turntable.cov_rad2.diagonal().minCoeff(), 0.9 * lost_rad2);
    EXPECT_EQ(whole.encoder.u_unmodelled_rad, 0.0);
    EXPECT_THAT(whole.notes, testing::Not(testing::Contains(HasSubstr("stand out"))));
  }
}

TEST(ClosePolygon, RefusesClampingsWithoutACommonFace) {
  std::vector<FaceReading> readings = AnyPolygon(6, {0.0, 20.0}, {1}, 6).Read();
  std::erase_if(readings, [](const FaceReading& r) { return (r.clamping == 0) == (r.face < 3); });
  EXPECT_KEPT(MessageOf([&] { ClosePolygon(readings, 6, 1); }));
  EXPECT_KEPT(MessageOf([&] { ClosePolygon({}, 6, 1); }));
}

TEST(ClosePolygonByMeans, IsLeastSquaresForEvenClampings) {
  const NulledPolygon polygon = AnyPolygon(24, EvenOffsets(25), {1, 2, 7}, 1, 0.03 * arcsec, 2);
  const auto readings = polygon.Read();
  const PolygonClosure means = ClosePolygonByMeans(readings, 24, 8), squares = ClosePolygon(readings, 24, 8);
  EXPECT_LT(ClosureBias_rad(means.turntable, squares.turntable) / arcsec, 1e-9);
  EXPECT_LT(ClosureBias_rad(means.polygon, squares.polygon) / arcsec, 1e-9);
  EXPECT_NEAR(means.turntable.U_rad(100) / squares.turntable.U_rad(100), 1.0, 1e-9);
  EXPECT_NEAR(means.polygon.U_rad(5) / squares.polygon.U_rad(5), 1.0, 1e-9);
  EXPECT_NEAR(means.noise.scale * means.noise.u_rad, squares.noise.scale * squares.noise.u_rad, 1e-12 * arcsec);
}

// The mean of a wave over the clampings is what the faces take of it, and what the encoder loses.
TEST(ClosePolygonByMeans, GivesFacesTheMeanOfTheEncodersWavesOverUnevenClampings) {
  NulledPolygon polygon = AnyPolygon(12, {0.0, 20.0, 50.0}, {2}, 2);
  const PolygonClosure means = ClosePolygonByMeans(polygon.Read(), 12, 3);
  for (std::size_t i = 0; i < means.face.size(); ++i) {
    double expected_rad = polygon.face_rad[static_cast<std::size_t>(means.face[i])];
    for (const double offset_deg : polygon.offsets_deg)
      expected_rad += ValueOf(polygon.encoder, (offset_deg + 30.0 * means.face[i]) * units::deg) / 3.0;
    EXPECT_NEAR(means.polygon.value_rad[static_cast<Eigen::Index>(i)] / arcsec, expected_rad / arcsec, 1e-9);
  }
}

/// Turn about the vertical and pitch of a mirror on an axis that leans, by rotations, as the turntable stands at th.
Eigen::Vector2d TurnAndPitch(double th_rad, double lean_rad, double azimuth_rad, double pitch_rad) {
  const Eigen::Vector3d towards(std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0);
  const double faces_rad = 0.5 * units::kPi - th_rad;
  const Eigen::Vector3d normal(std::cos(faces_rad) * std::cos(pitch_rad), std::sin(faces_rad) * std::cos(pitch_rad), std::sin(pitch_rad));
  const Eigen::Vector3d leans = Eigen::AngleAxisd(lean_rad, Eigen::Vector3d::UnitZ().cross(towards)) * normal;
  const Eigen::Vector3d seen = Eigen::AngleAxisd(th_rad, Eigen::Vector3d::UnitZ()) * leans;
  return {-std::atan2(seen.x(), seen.y()), std::asin(seen.z())};
}

TEST(TiltSquared, IsWhatRotationsMakeOfAnAxisThatLeans) {
  std::vector<TiltReading> readings;
  std::vector<double> turned_rad;
  const auto add = [&](int setup, int face, double th_rad, double lean_rad, double azimuth_rad, double sign) {
    const double pitch_rad = 20.0 * arcsec * std::sin(2.4 * face);
    const Eigen::Vector2d seen = TurnAndPitch(th_rad, lean_rad, azimuth_rad, pitch_rad);
    readings.push_back({setup, face, th_rad, sign * seen[1] + 7e-5});
    turned_rad.push_back(seen[0]);
  };
  for (const double sign : {1.0, -1.0}) {  // of y
    readings.clear();
    turned_rad.clear();
    for (int k = 0; k < 36; ++k) {
      add(0, k, units::turn * k / 36, 600 * arcsec, 0.7, sign);
      add(1, k, units::turn * k / 36 + 0.3, 150 * arcsec, 4.0, sign);
    }
    const Eigen::VectorXd shown_rad = TiltSquared_rad(readings);
    EXPECT_NEAR(shown_rad.maxCoeff() / arcsec, 0.436 + 600 * 20 * arcsec * 0.9, 0.05) << "0.44 at 600 arcsec, and the pitch";
    for (Eigen::Index i = 0; i < shown_rad.size(); ++i)
      EXPECT_NEAR(shown_rad[i] / arcsec, turned_rad[static_cast<std::size_t>(i)] / arcsec, 0.004) << "2 % of a pitch is in the lean";
  }
  readings.resize(3);
  EXPECT_TRUE(TiltSquared_rad(readings).allFinite());
  readings[0].y_rad = kNaN;
  EXPECT_TRUE(TiltSquared_rad(readings).isZero(0.0)) << "two readings tell no lean";
}

}  // namespace
}  // namespace twinbench::separate::turntable
