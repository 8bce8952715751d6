#include "tests/circular_motion/written_circles.h"
#include "twin/benches/evaluated.h"
#include "twin/core/stream.h"

// The pitch of a screw and the time after which a spike is largest are the machine's, whatever a scenario states.
namespace twinbench::benches::circular {
namespace {

using units::arcsec, units::mm, units::um;

constexpr double kShaped_m = 90.0 * mm, kShapedFeed_m_s = 1200.0 * mm / 60.0;

struct ShapedErrors {
  double squareness_rad = 5.0 * arcsec, cyclic_y_m = 0.0, pitch_m = 6.0 * mm, spike_x_m = 0.0, spike_time_s = 0.15, lobes_m = 0.0;
};

/// A radius each quarter of a degree.
nlohmann::json ResultsOfShaped(const ShapedErrors& e) {
  Stream noise(23, "bar");
  const auto show = [&](Reading& r, double a) {
    const double x_m = kCommandedX_m(r), y_m = kCommandedY_m(r), turned_rad = units::turn * (r.position + 0.5) / 1440;
    // X turns round at 0 and at 180 deg, and goes down behind the former.
    const double along_rad = std::fmod(turned_rad, units::kPi), sense = turned_rad < units::kPi ? -1.0 : 1.0;
    const double times = along_rad * kShaped_m / kShapedFeed_m_s / e.spike_time_s;
    const double dx_m = -e.squareness_rad * y_m - sense * e.spike_x_m * times * std::exp(1.0 - times);
    const double dy_m = e.cyclic_y_m * std::sin(units::turn * y_m / e.pitch_m + 0.8);
    kBar_m(r) = std::hypot(x_m + dx_m, y_m + dy_m) - kShaped_m + e.lobes_m * std::cos(7.0 * a) +
                0.08 * um * noise.Normal();
  };
  const std::vector<Reading> readings = test::Written({kShaped_m, kShapedFeed_m_s, 1440}, show);
  return EvaluationOf(test::ToldOfCircles("radial_bar", kShaped_m), readings, Estimator::kRigorous).results;
}

TEST(FoundShapes, ArePitchAndTimeOfTheMachine) {
  ShapedErrors errors;
  errors.cyclic_y_m = 1.2 * um;
  errors.spike_x_m = 3.0 * um;
  const nlohmann::json results = ResultsOfShaped(errors);
  EXPECT_NEAR(results.at("as_read").at("cyclic_pitch_mm").get<double>(), 6.0, 0.01);
  EXPECT_NEAR(results.at("as_read").at("spike_time_s").get<double>(), 0.15, 0.01);
  test::ExpectCircleError(results, "machine.cyclic_y_um", 1.2, 0.2);
  test::ExpectCircleError(results, "machine.spike_x_um", 3.0, 0.2);
  test::ExpectCircleError(results, "machine.backlash_x_um", 0.0, 0.2);
  test::ExpectCircleError(results, "machine.backlash_y_um", 0.0, 0.2);
  test::ExpectCircleError(results, "machine.squareness_arcsec", 5.0, 0.2);
}

TEST(FoundShapes, AreAsStatedWhereTheyAreSoOrNoneDescribesWhatIsLeft) {
  ShapedErrors stated;
  stated.cyclic_y_m = 1.2 * um;
  stated.pitch_m = 10.0 * mm;
  EXPECT_FALSE(ResultsOfShaped(stated).contains("as_read"));
  ShapedErrors lobes;
  lobes.lobes_m = 3.0 * um;
  EXPECT_FALSE(ResultsOfShaped(lobes).contains("as_read"));
}

}  // namespace
}  // namespace twinbench::benches::circular
