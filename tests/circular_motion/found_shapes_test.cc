#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/benches/circular_motion/columns.h"
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
std::vector<Reading> Turned(const ShapedErrors& e) {
  constexpr int kRadii = 1440;
  Stream noise(23, "bar");
  std::vector<Reading> readings;
  for (const int direction : {1, -1}) {
    for (int k = 0; k < kRadii; ++k) {
      Reading& r = readings.emplace_back();
      const double a = direction * units::turn * (k + 0.5) / kRadii, x_m = kShaped_m * std::cos(a), y_m = kShaped_m * std::sin(a);
      r.reading = static_cast<int>(readings.size()) - 1;
      r.time = Time(FromSeconds(units::turn * kShaped_m / kShapedFeed_m_s / kRadii * r.reading));
      r.pass = direction > 0 ? 0 : 1;
      r.direction = direction;
      r.position = k;
      kFeed_m_s(r) = kShapedFeed_m_s;
      kCommandedX_m(r) = x_m;
      kCommandedY_m(r) = y_m;
      // X turns round at 0 and at 180 deg, and goes down behind the former.
      const double along_rad = std::fmod(units::turn * (k + 0.5) / kRadii, units::kPi);
      const double sense = 2 * k < kRadii ? -1.0 : 1.0, times = along_rad * kShaped_m / kShapedFeed_m_s / e.spike_time_s;
      const double dx_m = -e.squareness_rad * y_m - sense * e.spike_x_m * times * std::exp(1.0 - times);
      const double dy_m = e.cyclic_y_m * std::sin(units::turn * y_m / e.pitch_m + 0.8);
      kBar_m(r) = std::hypot(x_m + dx_m, y_m + dy_m) - kShaped_m + e.lobes_m * std::cos(7.0 * a) + 0.08 * um * noise.Normal();
    }
  }
  return readings;
}

nlohmann::json ResultsOfShaped(const ShapedErrors& errors) {
  const Scenario scenario = ParseScenario("bench = \"circular_motion\"\n", "bar", "",
                                          {"circular_procedure.setups=[{instrument=\"radial_bar\", radius_mm=90}]", "circular_procedure.stops=0"});
  return EvaluationOf(scenario, Turned(errors), Estimator::kRigorous).results;
}

void ExpectShapedError(const nlohmann::json& results, const std::string& key, double value) {
  const nlohmann::json& error = results.at("errors").at(key);
  EXPECT_NEAR(error.at("value").get<double>(), value, 3.0 * error.at("u").get<double>()) << key;
  EXPECT_LT(error.at("u").get<double>(), 0.2) << key;
}

TEST(FoundShapes, ArePitchAndTimeOfTheMachine) {
  ShapedErrors errors;
  errors.cyclic_y_m = 1.2 * um;
  errors.spike_x_m = 3.0 * um;
  const nlohmann::json results = ResultsOfShaped(errors);
  EXPECT_NEAR(results.at("as_read").at("cyclic_pitch_mm").get<double>(), 6.0, 0.01);
  EXPECT_NEAR(results.at("as_read").at("spike_time_s").get<double>(), 0.15, 0.01);
  ExpectShapedError(results, "machine.cyclic_y_um", 1.2);
  ExpectShapedError(results, "machine.spike_x_um", 3.0);
  ExpectShapedError(results, "machine.backlash_x_um", 0.0);
  ExpectShapedError(results, "machine.backlash_y_um", 0.0);
  ExpectShapedError(results, "machine.squareness_arcsec", 5.0);
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
