#include "optics/grating_form.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/optics/example_bench.h"

namespace twinbench::optics {
namespace {

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
