#include "tests/circular_motion/written_circles.h"
#include "tests/support/thresholds.h"
#include "twin/benches/circular_motion/bench.h"
#include "twin/core/stream.h"

// A grid plate on a circle. Its readings are written here from what each error does to the path.
namespace twinbench::benches::circular::on_grid {
namespace {

using units::deg, units::mm, units::um, units::arcsec;

constexpr double kRadius_m = 80.0 * mm;

/// Squareness turns Y towards -X.
struct Plane {
  double squareness_rad, scale_x, scale_y, backlash_x_m, backlash_y_m;
};

/// @param show  What else is done to a reading.
template <class Show>
diagnose::Diagnosis DiagnosisOf(const Plane& plane, double feed_m_s, Show show) {
  Stream stream(7, "grid");
  const auto readings = test::Written({kRadius_m, feed_m_s, 360, 0.0, 5.7}, [&](Reading& r, double a) {
    const double x_m = kCommandedX_m(r), y_m = kCommandedY_m(r);
    kGridX_m(r) = x_m * (1.0 + plane.scale_x) - plane.squareness_rad * y_m +
                  test::Behind_m(kRadius_m, plane.backlash_x_m, a, r.direction) + 0.05 * um * stream.Normal();
    kGridY_m(r) = y_m * (1.0 + plane.scale_y) + test::Behind_m(kRadius_m, plane.backlash_y_m, a - 90.0 * deg, r.direction) +
                  0.05 * um * stream.Normal();
    show(r, a);
  });
  const Scenario scenario =
      test::ToldOfCircles("grid", kRadius_m, {"machine.lag_x_s=0", "machine.lag_y_s=0", "machine.span_mm=80"});
  return Diagnose(readings, scenario, test::QuickOptions(100)).diagnosis;
}

const diagnose::Cause* Named(const diagnose::Diagnosis& d, const std::string& effect, const std::string& where) {
  for (const diagnose::Cause& cause : d.causes)
    if (cause.effect == effect && cause.where == where) return &cause;
  return nullptr;
}

TEST(GridPlate, HasItsSquarenessScalesAndBacklashesNamedTogether) {
  const Plane plane{12.0 * arcsec, 20e-6, -25e-6, 4.0 * um, 6.0 * um};
  const diagnose::Diagnosis d = DiagnosisOf(plane, 1000.0 * mm / 60.0, [](Reading&, double) {});
  for (const auto& [effect, where, size] :
       {std::tuple{"squareness", "", plane.squareness_rad}, {"scale", "x", plane.scale_x}, {"scale", "y", plane.scale_y},
        {"backlash", "x", plane.backlash_x_m}, {"backlash", "y", plane.backlash_y_m}}) {
    const diagnose::Cause* const cause = Named(d, effect, where);
    ASSERT_TRUE(cause) << effect << " " << where;
    EXPECT_NEAR(cause->parameters[0].value, size, 4.0 * cause->parameters[0].u) << effect << " " << where;
  }
  EXPECT_FALSE(Named(d, "outliers", "")) << "a reading on the way through a reversal is no outlier";
  EXPECT_FALSE(HasUnmodelled(d));
}

TEST(GridPlate, HasTheScaleOfAnAxisBesideLagsThatAreNotAlike) {
  // Of first order: along each axis 1 / (1 + lag s) at the circle's rate.
  constexpr double kLagX_s = 3.0e-3, kLagY_s = 3.6e-3, kScaleX = 20e-6, kFeed = 15.0 * units::mm * 1000.0 / 60.0;
  const diagnose::Diagnosis d = DiagnosisOf({}, kFeed, [&](Reading& r, double a) {
    const auto lagging_m = [&](double from_rad, double lag_s) {
      const double lag_rad = r.direction * kFeed / kRadius_m * lag_s;
      return kRadius_m / std::hypot(1.0, lag_rad) * std::cos(from_rad - std::atan(lag_rad));
    };
    kGridX_m(r) += (1.0 + kScaleX) * lagging_m(a, kLagX_s) - kCommandedX_m(r);
    kGridY_m(r) += lagging_m(a - 90.0 * deg, kLagY_s) - kCommandedY_m(r);
  });
  const diagnose::Cause* const scale = Named(d, "scale", "x");
  ASSERT_TRUE(scale);
  EXPECT_NEAR(scale->parameters[0].value, kScaleX, 4.0 * scale->parameters[0].u);
  EXPECT_FALSE(HasUnmodelled(d));
}

}  // namespace
}  // namespace twinbench::benches::circular::on_grid
