#pragma once

#include <nlohmann/json.hpp>

#include "twin/benches/circular_motion/columns.h"
#include "twin/benches/circular_motion/estimators/iso230_4.h"
#include "twin/core/scenario.h"
#include "twin/core/units.h"

/// Circles whose readings tests write by formulas of their own.
namespace twinbench::test {

/// One each way, of `a_turn` readings a turn, the first of them `first` of a step behind where the arc begins.
struct WrittenCircles {
  double radius_m, feed_m_s;
  int a_turn = 360;
  double first = 0.5, from_deg = 0.0, arc_deg = 360.0;
  std::vector<int> directions = {1, -1};
};

/// @param show  (reading, angle [rad]): fills in what the instrument shows there.
/// @param readings  After which these are taken.
template <class Show>
std::vector<Reading> Written(const WrittenCircles& c, Show show, std::vector<Reading> readings = {}) {
  using namespace benches::circular;
  const double step_rad = units::turn / c.a_turn;
  for (const int direction : c.directions) {
    const int pass = readings.empty() ? 0 : readings.back().pass + 1;
    const double from_rad = (c.from_deg + (direction > 0 ? 0.0 : c.arc_deg)) * units::deg;
    for (int k = 0; (k + c.first) * step_rad < c.arc_deg * units::deg - 1e-9; ++k) {
      const double a = from_rad + direction * (k + c.first) * step_rad;
      Reading r{.reading = static_cast<int>(readings.size()), .pass = pass, .direction = direction, .position = k};
      r.time = Time(FromSeconds(r.reading * step_rad * c.radius_m / c.feed_m_s));
      kFeed_m_s(r) = c.feed_m_s;
      kCommandedX_m(r) = c.radius_m * std::cos(a);
      kCommandedY_m(r) = c.radius_m * std::sin(a);
      show(r, a);
      readings.push_back(r);
    }
  }
  return readings;
}

/// What is told of them.
inline Scenario ToldOfCircles(const std::string& instrument, double radius_m, std::vector<std::string> more = {}) {
  more.push_back(fmt::format("circular_procedure.setups=[{{instrument=\"{}\", radius_mm={}}}]", instrument,
                             radius_m / units::mm));
  more.push_back("circular_procedure.stops=0");
  return ParseScenario("bench = \"circular_motion\"\n", "written", "", more);
}

/// How far an axis is ahead of where it is sent that stays half its backlash behind the way it goes, but for the stretch in which
/// that is taken up, `from_turn_rad` behind its largest value.
inline double Behind_m(double radius_m, double width_m, double from_turn_rad, int direction) {
  const double along_rad = std::fmod(direction * from_turn_rad + 2.0 * units::turn, units::turn);
  const double since_m = radius_m * (1.0 - std::cos(std::fmod(along_rad, units::kPi)));
  return (along_rad < units::kPi ? 1.0 : -1.0) * (std::min(since_m, width_m) - 0.5 * width_m);
}

/// Within three of its standard uncertainties, which are no larger than the value needs.
inline void ExpectCircleError(const nlohmann::json& results, const std::string& key, double value, double largest_u) {
  ASSERT_TRUE(results.at("errors").contains(key)) << key;
  const double u = results.at("errors").at(key).at("u");
  EXPECT_NEAR(results.at("errors").at(key).at("value").get<double>(), value, 3.0 * u) << key;
  EXPECT_LT(u, largest_u) << key;
}

/// @param fill  (point, unit vector outwards): what is known of one of `count` points of a turn, whose angles grow.
template <class Fill>
separate::circular::CirclePath WrittenPath(int direction, double radius_m, int count, double first_rad, Fill fill) {
  separate::circular::CirclePath path{0, direction > 0 ? 0 : 1, direction, true, radius_m, 0.01, {}, false};
  for (int k = 0; k < count; ++k) {
    separate::circular::PathPoint& point = path.points.emplace_back();
    point.commanded_rad = first_rad + units::turn * k / count;
    const Eigen::Vector2d outwards(std::cos(point.commanded_rad), std::sin(point.commanded_rad));
    point.slope = outwards;
    fill(point, outwards);
  }
  return path;
}

/// Of one unknown that makes the radius larger by as much.
inline separate::circular::SharedUncertainty SharedLength(double u_m) {
  separate::circular::SharedUncertainty shared;
  shared.cov = Eigen::MatrixXd::Constant(1, 1, u_m * u_m);
  shared.hidden = Eigen::MatrixXd(1, 0);
  shared.typical = Eigen::VectorXd::Ones(1);
  shared.of_machine = 0.0 * shared.cov;
  shared.of_steps = 0.0 * shared.cov;
  return shared;
}

}  // namespace twinbench::test
