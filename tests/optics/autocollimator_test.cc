#include "optics/autocollimator.h"

#include <gmock/gmock.h>

#include "optics/collimator_pupil.h"
#include "tests/optics/example_bench.h"

namespace twinbench::optics {
namespace {

using Eigen::AngleAxisd, Eigen::Isometry3d, Eigen::Translation3d, Eigen::Vector2d, Eigen::Vector3d;

constexpr double kWidth_m = 60e-3;       // of the mirror, and
constexpr double kSag_m = 0.079e-6;      // its flatness error: the example of Guo et al. (2014)
constexpr double kRounding_rad = 1e-15;  // slopes below 0.01 in double, averaged over a hundred rays

Isometry3d FromColumns(const Vector3d& x, const Vector3d& y, const Vector3d& z) {
  Isometry3d X = Isometry3d::Identity();
  X.linear() << x, y, z;
  return X;
}

/// Looks along +x_L at a mirror near the origin of L, from 400 mm away.
AutocollimatorParameters ExampleInstrument() {
  return {.X_LA = Translation3d(-0.4, 0.05, 0.2) * FromColumns(Vector3d::UnitY(), Vector3d::UnitZ(), Vector3d::UnitX()),
          .half_field_rad = 410.0 * kArcsec, .low_light_fraction = 0.05};
}

Surface Mirror(double sag_m = 0.0) {
  Surface mirror = RectangularPlane(Isometry3d::Identity(), kWidth_m, kWidth_m);
  mirror.curvature_per_m = 8.0 * sag_m / (kWidth_m * kWidth_m);
  mirror.conic = -1.0;
  return mirror;
}

/// The mirror's normal (along -x_L) tilted upwards, then turned counter-clockwise about z_L, its vertex moved.
Isometry3d Pose(double yaw_rad, double tilt_rad, const Vector3d& shift_m = Vector3d::Zero()) {
  return Translation3d(Vector3d(0.0, 0.05, 0.2) + shift_m) * AngleAxisd(yaw_rad, Vector3d::UnitZ()) *
         AngleAxisd(tilt_rad, Vector3d::UnitY()) *
         FromColumns(-Vector3d::UnitY(), Vector3d::UnitZ(), -Vector3d::UnitX());
}

Vector2d Angles(const AutocollimatorImage& image) {
  EXPECT_EQ(image.status, AutocollimatorStatus::kOk);
  return {image.x_rad, image.y_rad};
}

Vector2d ReadingOf(const AutocollimatorParameters& p, const Surface& mirror, const Isometry3d& X_LM) {
  return Angles(AutocollimatorOptics(p, mirror).Look(X_LM));
}

/// Half the tangents of the deflection of a ray along x_L: the law of reflection written out for the normal
/// (-cos a cos b, -sin a cos b, sin b).
Vector2d HalfTangents(double a, double b) {
  const double back = 2.0 * std::pow(std::cos(a) * std::cos(b), 2) - 1.0;
  return Vector2d(std::sin(a) * std::cos(b), std::sin(b)) * std::cos(a) * std::cos(b) / back;
}

TEST(EqualAreaDisc, HasTheMomentsOfADiscAndTheRightShareOnEachSideOfAChord) {
  const double r = 3.0;
  const auto points = EqualAreaDisc(r, 4);
  ASSERT_EQ(points.size(), 64u);
  Vector2d first = Vector2d::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  double third = 0.0;
  for (const Vector2d& p : points) {
    first += p / 64.0;
    second += p * p.transpose() / 64.0;
    third += p.x() * p.squaredNorm() / 64.0;
  }
  EXPECT_LT(first.norm(), 1e-14);  // rounding
  EXPECT_LT((second - r * r / 4.0 * Eigen::Matrix2d::Identity()).norm(), 1e-13);
  EXPECT_NEAR(third, 0.0, 1e-13);
  const auto unit = EqualAreaDisc(1.0, 5);
  for (double q = -0.9; q < 0.95; q += 0.1) {
    const auto left = std::count_if(unit.begin(), unit.end(), [q](const Vector2d& p) { return p.x() < q; });
    const double share = 0.5 + (std::asin(q) + q * std::sqrt(1.0 - q * q)) / std::numbers::pi;
    // A hundred points, of which those within half a ring (0.1) of the chord fall on either side by chance.
    EXPECT_NEAR(static_cast<double>(left) / 100.0, share, 0.025) << q;
  }
}

TEST(AutocollimatorOptics, ReadsHalfTheTangentOfTheDeflectionByAFlatMirrorWhereverThatIsMoved) {
  AutocollimatorOptics instrument(ExampleInstrument(), Mirror());
  for (const double yaw : {-300.0, -1.0, 0.0, 0.01, 300.0}) {
    for (const double tilt : {-300.0, 0.0, 0.01, 120.0, 300.0}) {
      const double a = yaw * kArcsec, b = tilt * kArcsec;
      const Vector2d read = Angles(instrument.Look(Pose(a, b)));
      EXPECT_LT((read - HalfTangents(a, b)).norm(), kRounding_rad) << yaw << " " << tilt;
    }
  }
  const double a = 100.0 * kArcsec, b = -200.0 * kArcsec;
  for (const Vector3d& shift_mm : {Vector3d(-200, 0, 0), Vector3d(1, 2, 3), Vector3d(0, 35, 0),
                                   Vector3d(0, 0, -35)})
    EXPECT_LT((Angles(instrument.Look(Pose(a, b, 1e-3 * shift_mm))) - HalfTangents(a, b)).norm(), kRounding_rad);
}

TEST(AutocollimatorOptics, IsAsGoodAnywhereInTheLaboratoryAndLooksAtASurfaceWhereverItSitsOnItsBody) {
  const Isometry3d X = Translation3d(0.3, -2.0, 0.7) * AngleAxisd(1.1, Vector3d(1, 2, 3).normalized());
  AutocollimatorParameters p = ExampleInstrument();
  const Vector2d here = ReadingOf(p, Mirror(kSag_m), Pose(1e-4, 2e-4));
  p.X_LA = X * p.X_LA;
  EXPECT_LT((ReadingOf(p, Mirror(kSag_m), X * Pose(1e-4, 2e-4)) - here).norm(), kRounding_rad);
  Surface mirror = Mirror();
  mirror.X_WS = Pose(0.0, 0.0);  // the body's frame is then parallel to L
  const Isometry3d turn(AngleAxisd(50.0 * kArcsec, Vector3d::UnitZ()));
  EXPECT_LT((ReadingOf(ExampleInstrument(), mirror, turn) - HalfTangents(50.0 * kArcsec, 0.0)).norm(),
            kRounding_rad);
}

TEST(AutocollimatorOptics, ReadsTheFlatnessOfTheMirrorWhenTheBeamWalks) {
  AutocollimatorOptics concave(ExampleInstrument(), Mirror(kSag_m)), convex(ExampleInstrument(), Mirror(-kSag_m));
  const double walk_m = 1e-3, expected = 8.0 * kSag_m * walk_m / (kWidth_m * kWidth_m);
  EXPECT_NEAR(expected / kArcsec, 0.036, 0.0005);  // the paper's figure, to its last digit
  // The concave mirror's normals meet in front of it. Moved to the left (+y_L), it shows the beam its right half,
  // whose normals point to the left: clockwise from above.
  const Isometry3d left = Pose(0.0, 0.0, {0.0, walk_m, 0.0}), up = Pose(0.0, 0.0, {0.0, 0.0, walk_m});
  const double kSecondOrder = 1e-6 * expected;  // mirror at 0.4 m instead of infinitely near: squares of slopes
  EXPECT_NEAR(Angles(concave.Look(left)).x(), -expected, kSecondOrder);
  // A convex mirror widens the beam by 2 c L (2 um) and the objective cuts that off: as much less is seen of the
  // walk.
  const double widening = 2.0 * 8.0 * kSag_m / (kWidth_m * kWidth_m) * 0.4;
  EXPECT_NEAR(Angles(convex.Look(left)).x(), expected * (1.0 - widening), 0.15 * widening * expected);
  EXPECT_NEAR(Angles(concave.Look(left)).y(), 0.0, kSecondOrder);
  EXPECT_NEAR(Angles(concave.Look(up)).y(), expected, kSecondOrder);
}

TEST(AutocollimatorOptics, MixesTiltIntoYawByItsRollAsInEquationOne) {
  AutocollimatorParameters p = ExampleInstrument();
  p.roll_rad = 0.6 * kDegree;
  AutocollimatorOptics instrument(p, Mirror());
  const double g = p.roll_rad;
  for (const double yaw : {-200.0, 0.0, 17.82}) {
    const double a = yaw * kArcsec, b = 100.0 * kArcsec;
    const Vector2d read = Angles(instrument.Look(Pose(a, b)));
    const double x = HalfTangents(a, b).x();
    EXPECT_NEAR(read.x(), (x + read.y() * std::sin(g)) / std::cos(g), kRounding_rad);
    EXPECT_NEAR((read.x() - x) / kArcsec, 1.05, 0.02);  // the paper's figure; x (cos g - 1) is 0.01 at 200 arcsec
    EXPECT_NEAR(read.norm(), HalfTangents(a, b).norm(), kRounding_rad);  // a roll only turns
  }
}

TEST(AutocollimatorOptics, EnlargesTheImageByAFocalLengthThatIsNotTheNominalOneAndByDistortion) {
  AutocollimatorParameters longer = ExampleInstrument(), distorting = longer;
  longer.focal_length_m = 1.002 * longer.nominal_focal_length_m;
  distorting.distortion_per_rad2 = -20.0;  // with the square of the field angle
  const Vector2d ideal = HalfTangents(1.5e-3, -1e-3);
  const Isometry3d X_LM = Pose(1.5e-3, -1e-3);
  EXPECT_LT((ReadingOf(longer, Mirror(), X_LM) - 1.002 * ideal).norm(), kRounding_rad);
  EXPECT_LT((ReadingOf(distorting, Mirror(), X_LM) - ideal * (1.0 - 20.0 * 4.0 * ideal.squaredNorm())).norm(),
            kRounding_rad);
}

TEST(AutocollimatorOptics, OutOfFocusDependsOnTheDistanceOfTheMirror) {
  AutocollimatorParameters p = ExampleInstrument();
  p.defocus_m = 0.5e-3;  // so the beam shrinks on its way, by more than it walks aside
  AutocollimatorOptics instrument(p, Mirror());
  const double f = p.focal_length_m, a = 10.0 * kArcsec;
  for (const double distance_m : {0.2, 0.4, 0.6}) {
    const Vector2d read = Angles(instrument.Look(Pose(a, 0.0, {distance_m - 0.4, 0.0, 0.0})));
    // Tilted light comes back 2 a L beside the axis, and the camera at f + defocus sees -defocus / f of that.
    const double expected = a * (f + p.defocus_m - distance_m * p.defocus_m / f) / f;
    EXPECT_NEAR(read.x(), expected, 1e-6 * a);  // squares of the beam's slopes, 1e-4
  }
}

TEST(AutocollimatorOptics, LosesWhatMissesASmallFlatMirrorButReadsTheSameAngle) {
  AutocollimatorParameters p = ExampleInstrument();
  p.pupil_rings = 40;
  Surface strip = Mirror();
  strip.half_x_m = 5e-3;
  AutocollimatorOptics small(p, strip), whole(p, Mirror());
  const Isometry3d X_LM = Pose(30.0 * kArcsec, 40.0 * kArcsec, {0.0, 0.0, 1e-3});
  EXPECT_LT((Angles(small.Look(X_LM)) - Angles(whole.Look(X_LM))).norm(), kRounding_rad);
  const double q = 5e-3 / p.aperture_radius_m;
  const double share = 2.0 / std::numbers::pi * (std::asin(q) + q * std::sqrt(1.0 - q * q));
  // Rings of 0.4 mm on a strip of 10 mm; the walk of 0.1 mm over the objective's edge takes less.
  EXPECT_NEAR(small.Look(X_LM).returned_fraction, share, 0.01);
  EXPECT_NEAR(whole.Look(Pose(0.0, 0.0)).returned_fraction, 1.0, 1e-12);
}

TEST(AutocollimatorOptics, LosesWhatComesBackBesideTheObjective) {
  AutocollimatorOptics instrument(ExampleInstrument(), Mirror());
  for (const double yaw : {0.0, 1.0, 100.0, 400.0}) {
    const double a = yaw * kArcsec, q = 0.4 * std::tan(2.0 * a) / (2.0 * ExampleInstrument().aperture_radius_m);
    const double overlap = 2.0 / std::numbers::pi * (std::acos(q) - q * std::sqrt(1.0 - q * q));  // of two discs
    // The edge is in 52 pieces, each taken as the ring's part at its own azimuth.
    EXPECT_NEAR(instrument.Look(Pose(a, 0.0)).returned_fraction, overlap, 0.01 * (1.0 - overlap) + 1e-12) << yaw;
  }
}

TEST(AutocollimatorOptics, SeesTheOtherSideOfACurvedMirrorWhenTheObjectiveCutsOffOne) {
  AutocollimatorOptics instrument(ExampleInstrument(), Mirror(kSag_m));
  const double curvature = 8.0 * kSag_m / (kWidth_m * kWidth_m);
  for (const double yaw : {-400.0, -50.0, 200.0, 400.0}) {
    const double a = yaw * kArcsec, walk_m = 0.4 * std::tan(2.0 * a);
    // What comes back inside left from a lens that is the overlap of two discs: centred half the walk to the left
    // for light that goes to the right. Normals of a concave mirror point to the right there: more of the same.
    const double expected = curvature * walk_m / 2.0;
    const double read = Angles(instrument.Look(Pose(a, 0.0))).x() - HalfTangents(a, 0.0).x();
    EXPECT_NEAR(read, expected, 0.08 * std::abs(expected)) << yaw;  // lost at the outermost ring, 7 % from the edge
  }
}

TEST(AutocollimatorOptics, InterpolatesBetweenPixelsWithThePixelsPeriod) {
  AutocollimatorParameters p = ExampleInstrument();
  p.interpolation_error_px = 0.03;
  AutocollimatorOptics instrument(p, Mirror()), ideal(ExampleInstrument(), Mirror());
  const double period_rad = p.pixel_pitch_m / (2.0 * p.focal_length_m);
  for (double part = 0.0; part < 3.0; part += 0.125) {
    const Isometry3d X_LM = Pose(part * period_rad, -(part + 0.3) * period_rad);
    const Vector2d error = Angles(instrument.Look(X_LM)) - Angles(ideal.Look(X_LM));
    const double turn = 2.0 * std::numbers::pi;
    const Vector2d expected(std::sin(turn * part), -std::sin(turn * (part + 0.3)));
    // Angle for tangent moves the phase by 4 a^3 / 3, below 1e-9 of a period.
    EXPECT_LT((error - 0.03 * period_rad * expected).norm(), 1e-8 * period_rad) << part;
  }
}

/// Looks at where there is nothing to read. @return how much of the light comes back.
double ReturnedFromNothing(AutocollimatorOptics& instrument, const Isometry3d& X_LM, AutocollimatorStatus status) {
  const AutocollimatorImage image = instrument.Look(X_LM);
  EXPECT_EQ(image.status, status);
  EXPECT_TRUE(std::isnan(image.x_rad) && std::isnan(image.y_rad));
  return image.returned_fraction;
}

TEST(AutocollimatorOptics, ReadsNothingBeyondItsFieldOrWithoutLight) {
  AutocollimatorOptics instrument(ExampleInstrument(), Mirror());
  const double inside = 409.9 * kArcsec, outside = 410.1 * kArcsec;
  EXPECT_EQ(instrument.Look(Pose(inside, -inside)).status, AutocollimatorStatus::kOk);
  for (const Isometry3d& X_LM : {Pose(outside, 0.0), Pose(-outside, 0.0), Pose(0.0, outside), Pose(0.0, -outside)})
    EXPECT_GT(ReturnedFromNothing(instrument, X_LM, AutocollimatorStatus::kOutOfRange), 0.9);
  const Isometry3d away = Pose(5.0 * kDegree, 0.0), back = Pose(std::numbers::pi, 0.0);
  const Isometry3d beside = Pose(0.0, 0.0, {0.0, 0.1, 0.0}), nearly_beside = Pose(0.0, 0.0, {0.0, 0.043, 0.0});
  for (const Isometry3d& X_LM : {away, beside})
    ReturnedFromNothing(instrument, X_LM, AutocollimatorStatus::kNoLight);
  EXPECT_EQ(ReturnedFromNothing(instrument, back, AutocollimatorStatus::kNoLight), 0.0);
  // A segment of 2 mm of 30 mm holds 2.9 % of the disc, which is less than 5 %.
  EXPECT_GT(ReturnedFromNothing(instrument, nearly_beside, AutocollimatorStatus::kNoLight), 0.0);
}

TEST(AutocollimatorOptics, NamesWhatIsWrongWithItsParametersTheMirrorOrItsPose) {
  using Change = std::function<void(AutocollimatorParameters&)>;
  using P = AutocollimatorParameters;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::pair<const char*, Change> cases[] = {
      {"X_LA", [](P& p) { p.X_LA.linear() *= 1.1; }}, {"X_LA", [nan](P& p) { p.X_LA.translation().x() = nan; }},
      {" focal_length_m", [](P& p) { p.focal_length_m = 0.0; }}, {"pupil_rings", [](P& p) { p.pupil_rings = 0; }},
      {"nominal_focal_length_m", [nan](P& p) { p.nominal_focal_length_m = nan; }},
      {"aperture_radius_m", [](P& p) { p.aperture_radius_m = -1e-3; }},
      {"defocus_m", [](P& p) { p.defocus_m = 0.03; }}, {"roll_rad", [nan](P& p) { p.roll_rad = nan; }},
      {"distortion_per_rad2", [nan](P& p) { p.distortion_per_rad2 = nan; }},
      {"pixel_pitch_m", [](P& p) { p.pixel_pitch_m = 0.0; }},
      {"interpolation_error_px", [](P& p) { p.interpolation_error_px = 0.2; }},
      {"half_field_rad", [nan](P& p) { p.half_field_rad = nan; }},
      {"low_light_fraction", [nan](P& p) { p.low_light_fraction = nan; }},
      {"low_light_fraction", [](P& p) { p.low_light_fraction = 1.1; }}};
  for (const auto& [name, change] : cases) {
    AutocollimatorParameters p = ExampleInstrument();
    change(p);
    EXPECT_THAT([&p] { AutocollimatorOptics instrument(p, Mirror()); },
                testing::ThrowsMessage<std::invalid_argument>(testing::HasSubstr(name)));
  }
  EXPECT_THAT([] { AutocollimatorOptics instrument(ExampleInstrument(), Surface{}); },
              testing::ThrowsMessage<std::invalid_argument>(testing::HasSubstr("aperture")));
  AutocollimatorOptics instrument(ExampleInstrument(), Mirror());
  Isometry3d nowhere = Pose(0.0, 0.0);
  nowhere.translation().z() = std::numeric_limits<double>::infinity();
  EXPECT_THAT([&] { instrument.Look(nowhere); },
              testing::ThrowsMessage<std::invalid_argument>(testing::HasSubstr("X_LM")));
}

/// Readings of the same instrument, traced and closed.
void ExpectSameBits(AutocollimatorParameters p, const Surface& mirror) {
  p.defocus_m = 1e-3;
  p.distortion_per_rad2 = 2.0;
  p.interpolation_error_px = 0.01;
  AutocollimatorOptics traced(p, mirror);
  p.fidelity = Fidelity::kClosed;
  AutocollimatorOptics closed(p, mirror);
  for (const double yaw : {-700.0, -400.0, -31.7, 0.0, 1e-3, 12.3, 400.0}) {
    for (const double shift_m : {0.0, 2e-3, 25e-3, 50e-3}) {  // the beam falls on the mirror's edge, and beside it
      const Isometry3d X_LM = Pose(yaw * kArcsec, 0.3 * yaw * kArcsec, {0.0, shift_m, 1e-3});
      const AutocollimatorImage a = traced.Look(X_LM), b = closed.Look(X_LM);
      EXPECT_EQ(a.status, b.status) << yaw << ' ' << shift_m;
      EXPECT_EQ(a.returned_fraction, b.returned_fraction) << yaw << ' ' << shift_m;
      if (a.status != AutocollimatorStatus::kOk) continue;
      EXPECT_EQ(a.x_rad, b.x_rad) << yaw << ' ' << shift_m;
      EXPECT_EQ(a.y_rad, b.y_rad) << yaw << ' ' << shift_m;
    }
  }
}

TEST(AutocollimatorOptics, ClosedGivesTheSameBitsAsTraced) {
  ExpectSameBits(ExampleInstrument(), Mirror());
  ExpectSameBits(ExampleInstrument(), Mirror(-kSag_m));
}

}  // namespace
}  // namespace twinbench::optics
