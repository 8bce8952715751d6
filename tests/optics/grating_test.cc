#include "optics/grating.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/optics/example_bench.h"

namespace twinbench::optics {
namespace {

using Eigen::Vector3d;
constexpr double kPi = std::numbers::pi;

Vector3d RandomUnit(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return Vector3d(normal(random), normal(random), normal(random)).normalized();
}

/// A random grating frame and light that meets it from the side of its normal.
struct Case {
  Vector3d normal, across, along, d;
};

Case RandomCase(std::mt19937_64& random) {
  Case c;
  c.normal = RandomUnit(random);
  c.across = c.normal.cross(RandomUnit(random)).normalized();
  c.along = c.across.cross(c.normal);
  c.d = RandomUnit(random);
  if (c.d.dot(c.normal) > 0.0) c.d = -c.d;
  return c;
}

/// The reference set-up of the RAY-UI comparison tables: grating and image plane, all in mm.
struct RayUi {
  Vector3d grating_normal, grooves_normal, image_centre, image_x, image_y, image_normal;
};

struct RayUiRow {
  int ray;
  double ox, oy, dx, dy, dz;
};

/// Matrix source 0.065 x 0.04 mm, 1 x 1 mrad, 4 x 4 rays.
Ray RayUiSource(int i) {
  const int column = i % 4, row = i / 4;
  const double phi = -0.5e-3 + 1e-3 / 3.0 * column, psi = 0.5e-3 - 1e-3 / 3.0 * row;
  return {{-0.0325 + 0.065 / 3.0 * column, -0.02 + 0.04 / 3.0 * row, 0.0},
          {std::cos(psi) * std::sin(phi), std::sin(psi), std::cos(psi) * std::cos(phi)}};
}

void ExpectRayUi(const RayUi& setup, const RayUiRow& row) {
  const Ray ray = RayUiSource(row.ray);
  const double wavelength_mm = 1239.841984332002622 / 100.0 * 1e-6, lines_per_mm = 1000.0;
  Eigen::Isometry3d X_WS = Eigen::Isometry3d::Identity();
  X_WS.translation() = Vector3d(0, 0, 10000);
  X_WS.linear() << setup.grooves_normal.cross(-setup.grating_normal), setup.grooves_normal, setup.grating_normal;
  const SurfaceHit hit = Meet(RectangularPlane(X_WS, 1e6, 1e6), ray, 0.0);
  const Vector3d point = ray.origin_m + hit.t_m * ray.direction;
  const OrderDirection out =
      Diffract(ray.direction, setup.grating_normal, setup.grooves_normal, -wavelength_mm * lines_per_mm);
  ASSERT_EQ(out.status, OrderStatus::kOk);
  const double t = (setup.image_centre - point).dot(setup.image_normal) / out.direction.dot(setup.image_normal);
  const Vector3d on_image = point + t * out.direction - setup.image_centre;
  // 1e-9 mm over 11 m of path is 1e-13 relative; the published table itself has 15 digits.
  EXPECT_NEAR(on_image.dot(setup.image_x), row.ox, 1e-9);
  EXPECT_NEAR(on_image.dot(setup.image_y), row.oy, 1e-9);
  // 15 printed digits of numbers up to one.
  EXPECT_NEAR(out.direction.dot(setup.image_x), row.dx, 2e-15);
  EXPECT_NEAR(out.direction.dot(setup.image_y), row.dy, 2e-15);
  EXPECT_NEAR(out.direction.dot(setup.image_normal), row.dz, 2e-15);
}

TEST(Diffract, AgreesWithRayUiInPlaneAndForConicalIncidence) {
  const RayUi in_plane{{0, 0.09335326512785988, -0.9956330488136518}, {0, 0.9956330488136518, 0.09335326512785988},
                       {0, 173.6481776669305077, 9015.1922469877918047}, {1, 0, 0},
                       {0, -0.9848077530122080, -0.1736481776669305}, {0, 0.1736481776669305, -0.9848077530122080}};
  for (const RayUiRow& row : std::initializer_list<RayUiRow>{
       {0, -5.53253146713303, -5.48491095785322, -0.000499999916666671, -0.000499452700558831, 0.99999975027351},
       {1, -1.84417701990672, -5.48491172782582, -0.000166666645061729, -0.000499454082753384, 0.999999861383915},
       {4, -5.53251079430642, -1.82829583392418, -0.000499999972222223, -0.000166483553543206, 0.999999861141618},
       {8, -5.53249012265316, 1.82829229813978, -0.000499999972222223, 0.000166487013798289, 0.999999861141041}})
    ExpectRayUi(in_plane, row);
  const RayUi conical{{-0.0121850462284485, 0.0925546150034836, -0.9956330488136518},
                      {-0.1299561907100867, 0.9871152700602351, 0.0933532651278599},
                      {-22.6656354168154408, 172.1625934348047053, 9015.1922469877918047},
                      {0.9661846579205290, 0.2568530236733497, 0.0226656354168154},
                      {0.2568530236733498, -0.9509924109327369, -0.1721625934348047},
                      {-0.0226656354168154, 0.1721625934348047, -0.9848077530122080}};
  for (const RayUiRow& row : std::initializer_list<RayUiRow>{
       {0, -3.92496552781674, -6.73066866932713, -0.000353633413471921, -0.000611763989440052, 0.999999750344084},
       {1, -0.362342158002859, -5.77562338542598, -3.16518362643767e-05, -0.000525539310034621, 0.999999861403288},
       {2, 3.20027728515205, -4.82057837601166, 0.000290329578373872, -0.000439313255130701, 0.99999986135629},
       {3, 6.76289358871801, -3.86553342995404, 0.000612310794669029, -0.00035308583432352, 0.999999750202911}})
    ExpectRayUi(conical, row);
}

TEST(Diffract, AgreesWithLensDesignNumbersOfAMirroredTransmission) {
  const double shift = -0.587 / 5.0;  // order -1, 0.587 um, pitch 5 um
  const auto field = [](double x_deg, double y_deg) {
    return Vector3d(std::tan(x_deg * kPi / 180), std::tan(y_deg * kPi / 180), 1.0).normalized();
  };
  const auto through = [&](const Vector3d& d) {
    return Vector3d(Diffract(d, Vector3d::UnitZ(), Vector3d::UnitY(), shift).direction.cwiseProduct(Vector3d(1, 1, -1)));
  };
  // Ten printed digits.
  EXPECT_LT((through(field(0, 0)) - Vector3d(0, -0.1174, 0.9930847094)).norm(), 1e-10);
  EXPECT_LT((through(field(2, 8)) - Vector3d(0.0345602649, 0.0216899611, 0.9991672201)).norm(), 1e-10);
}

TEST(Diffract, SendsPositiveOrdersTowardsAcrossWhicheverWayTheNormalPoints) {
  for (const Vector3d& normal : {Vector3d(Vector3d::UnitY()), Vector3d(-Vector3d::UnitY())}) {
    const OrderDirection out = Diffract({0, -1, 0}, normal, Vector3d::UnitX(), 0.39);
    EXPECT_NEAR(out.direction.x(), 0.39, 1e-16);
    EXPECT_NEAR(out.direction.y(), std::sqrt(1 - 0.39 * 0.39), 2e-16);
  }
}

TEST(Diffract, KeepsTheComponentAlongTheGroovesMirrorsTurnsAndIsReciprocalFromAnyDirection) {
  std::mt19937_64 random(2);
  int met = 0;
  for (int i = 0; i < 1000; ++i) {
    const Case c = RandomCase(random);
    const auto mirror = [&](const Vector3d& v) { return Vector3d(v - 2.0 * v.dot(c.across) * c.across); };
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.1 * i, RandomUnit(random)).toRotationMatrix();
    const OrderDirection out = Diffract(c.d, c.normal, c.across, 0.39);
    const OrderDirection minus = Diffract(mirror(c.d), c.normal, c.across, -0.39);
    const OrderDirection turned = Diffract(turn * c.d, turn * c.normal, turn * c.across, 0.39);
    ASSERT_EQ(minus.status, out.status);
    if (out.status != OrderStatus::kOk || turned.status != OrderStatus::kOk) continue;
    ++met;
    const double steep = out.direction.dot(c.normal);  // sqrt(q) near grazing
    EXPECT_GT(steep, 0.0);
    EXPECT_NEAR(out.direction.dot(c.along), c.d.dot(c.along), 4e-16);  // a few roundings of numbers below one
    EXPECT_NEAR(out.direction.norm(), 1.0, 1e-15);
    EXPECT_LT((out.direction - mirror(minus.direction)).norm(), 2e-15 / steep);
    EXPECT_LT((turn * out.direction - turned.direction).norm(), 1e-14 / steep);
    // Light sent back along the order returns along the incident ray, in the same order.
    const OrderDirection back = Diffract(-out.direction, c.normal, c.across, 0.39);
    ASSERT_EQ(back.status, OrderStatus::kOk);
    EXPECT_LT((back.direction + c.d).norm(), 4e-15 / std::abs(c.d.dot(c.normal)));
  }
  EXPECT_GT(met, 500);
}

TEST(Diffract, CallsAnOrderBeyondGrazingEvanescent) {
  // Normal incidence, 600 l/mm, 650 nm: order 2 leaves at 51.3 deg, order 3 cannot (3 * 0.39 > 1).
  EXPECT_EQ(Diffract({0, -1, 0}, Vector3d::UnitY(), Vector3d::UnitX(), 2 * 0.39).status, OrderStatus::kOk);
  const OrderDirection third = Diffract({0, -1, 0}, Vector3d::UnitY(), Vector3d::UnitX(), 3 * 0.39);
  EXPECT_EQ(third.status, OrderStatus::kEvanescent);
  EXPECT_TRUE(std::isnan(third.direction.x()));
}

Grating ExampleGrating() {
  return {.lines_per_m = 600e3, .width_m = 0.025, .height_m = 0.025, .reflectance = 0.9,
          .table = {{0.0, {-2, {0.0999, 0.3385, 0.0997, 0.3385, 0.0999}}}}, .form = {}};  // a sinusoid's
}

TEST(Efficiencies, NeverExceedTheReflectanceAndGiveThePowerOfEvanescentOrdersToTheOthers) {
  const Grating grating = ExampleGrating();
  std::mt19937_64 random(5);
  for (int i = 0; i < 300; ++i) {
    Vector3d d_G = RandomUnit(random);
    d_G.y() = -std::abs(d_G.y());
    const OrderEfficiencies orders = EfficienciesAt(grating, 650e-9, d_G);
    EXPECT_LE(orders.Sum(), 0.9 + 1e-15);
    for (int m = -2; m <= 2; ++m) {
      const bool exists = Diffract(d_G, Vector3d::UnitY(), Vector3d::UnitX(), m * 0.39).status == OrderStatus::kOk;
      EXPECT_EQ(orders.Of(m) > 0.0, exists);
      EXPECT_DOUBLE_EQ(orders.Of(m), EfficiencyOf(grating, 650e-9, d_G, m));
    }
  }
  const double tabulated = grating.table[0].orders.Sum();
  const Vector3d oblique(std::sin(kPi / 6), -std::cos(kPi / 6), 0.0);  // order 2 gone: 0.5 + 0.78 > 1
  const OrderEfficiencies orders = EfficienciesAt(grating, 650e-9, oblique);
  EXPECT_EQ(orders.Of(2), 0.0);
  EXPECT_NEAR(orders.Sum(), 0.9 * tabulated, 1e-15);
}

TEST(Efficiencies, FollowTheTableInIncidence) {
  Grating grating = ExampleGrating();
  grating.reflectance = 1.0;
  grating.table = {{-0.1, {-1, {0.2, 0.1, 0.4}}}, {0.1, {-1, {0.4, 0.1, 0.2}}}};
  const Vector3d d_G(0.05, -std::sqrt(1 - 0.05 * 0.05), 0.0);
  EXPECT_NEAR(EfficiencyOf(grating, 650e-9, d_G, -1), 0.35, 1e-15);  // three quarters of the way
  EXPECT_NEAR(EfficiencyOf(grating, 650e-9, {-0.5, -std::sqrt(0.75), 0}, 1), 0.4, 1e-15);  // held beyond the ends
}

TEST(Grating, RefusesWhatIsMissing) {
  EXPECT_THROW(Validate(Grating{}), std::invalid_argument);
  Grating grating = ExampleGrating();
  grating.table[0].orders.share[0] = -0.1;
  EXPECT_THROW(Validate(grating), std::invalid_argument);
}

constexpr double kDistance_m = 0.12, kSine = 0.39;
const double kCosine = std::sqrt(1.0 - kSine * kSine);

GratingForm Plain() {
  GratingForm form;
  form.half_width_m = 12.5e-3;
  return form;
}

/// What the form changes, with the beam at a place of the grating, in both fidelities.
struct Moved {
  double ua_m, va_m, ub_m, vb_m;
};

PsdSignals Seen(const std::optional<GratingForm>& form, double x_m, double z_m, Fidelity fidelity) {
  RotaryOpticsParameters parameters = ExampleBench();
  parameters.grating.form = form;
  parameters.fidelity = fidelity;
  Eigen::Isometry3d X_LG = Eigen::Isometry3d::Identity();
  X_LG.translation() = Eigen::Vector3d(-x_m, 0.0, -z_m);
  return RotaryOptics(parameters).Trace(X_LG, ExampleSource());
}

Moved MovedBy(const GratingForm& form, double x_m, double z_m, Fidelity fidelity) {
  const PsdSignals with = Seen(form, x_m, z_m, fidelity), without = Seen({}, x_m, z_m, fidelity);
  return {with.a.u_m - without.a.u_m, with.a.v_m - without.a.v_m, with.b.u_m - without.b.u_m,
          with.b.v_m - without.b.v_m};
}

class FormedGrating : public testing::TestWithParam<Fidelity> {
 protected:
  void Expect(const GratingForm& form, double x_m, double z_m, const Moved& expected) const {
    const Moved moved = MovedBy(form, x_m, z_m, GetParam());
    const double within_m = 1e-3 * std::hypot(std::hypot(expected.ua_m, expected.va_m), 1e-7);
    EXPECT_NEAR(moved.ua_m, expected.ua_m, within_m);
    EXPECT_NEAR(moved.va_m, expected.va_m, within_m);
    EXPECT_NEAR(moved.ub_m, expected.ub_m, within_m);
    EXPECT_NEAR(moved.vb_m, expected.vb_m, within_m);
  }
};

// A slope g of the height along x turns the normal by -g: each order follows by g (1 + 1 / cos) of its distance.
TEST_P(FormedGrating, ASphereTurnsBothOrdersAlikeAndAstigmatismTheOtherWayAlongTheGrooves) {
  const double slope = 2.0 * 200e-9 * 2e-3 / std::pow(12.5e-3, 2);
  const double u_m = -kDistance_m * slope * (1.0 + 1.0 / kCosine), v_m = -kDistance_m * slope * (1.0 + kCosine);
  GratingForm sphere = Plain(), astigmatic = Plain();
  sphere.sphere_m = astigmatic.astigmatism_m = 200e-9;
  Expect(sphere, 2e-3, 0.0, {u_m, 0.0, u_m, 0.0});
  Expect(sphere, 0.0, 2e-3, {0.0, v_m, 0.0, v_m});
  Expect(astigmatic, 2e-3, 0.0, {u_m, 0.0, u_m, 0.0});
  Expect(astigmatic, 0.0, 2e-3, {0.0, -v_m, 0.0, -v_m});
}

// sin(theta) = wavelength x lines: grooves further apart by the share e turn the orders inwards by e tan(theta).
TEST_P(FormedGrating, AChirpTurnsTheOrdersInwards) {
  GratingForm form = Plain();
  form.chirp_per_m = 50e-6 / 1e-3;
  const double u_m = -kDistance_m * 3.0 * 50e-6 * kSine / kCosine;
  Expect(form, 3e-3, 1e-3, {u_m, 0.0, -u_m, 0.0});
}

// Grooves turned by r move an order along them by sin(theta) r.
TEST_P(FormedGrating, AFanLiftsOneOrderAndLowersTheOther) {
  GratingForm form = Plain();
  form.fan_rad_m = 20e-6 / 1e-3;
  const double v_m = -kDistance_m * kSine * 2.0 * 20e-6;
  Expect(form, 2e-3, 0.0, {0.0, v_m, 0.0, -v_m});
}

HeightMap MapOf(const std::function<double(double x_m, double z_m)>& value_m) {
  HeightMap map{101, 101, 0.25e-3, {}};
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      const double x_m = (column - 50) * map.pitch_m, z_m = (50 - row) * map.pitch_m;
      map.height_um.push_back(static_cast<float>(value_m(x_m, z_m) * 1e6));
    }
  }
  return map;
}

TEST_P(FormedGrating, MapsSayTheSameAsFormulas) {
  GratingForm formula = Plain(), maps = Plain();
  formula.sphere_m = 200e-9;
  formula.astigmatism_m = 90e-9;
  formula.chirp_per_m = 50e-6 / 1e-3;
  formula.fan_rad_m = 20e-6 / 1e-3;
  const double a2 = std::pow(12.5e-3, 2);
  maps.flatness_um = MapOf([&](double x, double z) { return (290e-9 * x * x + 110e-9 * z * z) / a2; });
  maps.ruling_um = MapOf([&](double x, double z) { return 0.025 * x * x + 0.02 * x * z; });
  Expect(maps, 2.1e-3, -1.3e-3, MovedBy(formula, 2.1e-3, -1.3e-3, GetParam()));
}

INSTANTIATE_TEST_SUITE_P(TracedAndClosed, FormedGrating, testing::Values(Fidelity::kTraced, Fidelity::kClosed));

}  // namespace
}  // namespace twinbench::optics
