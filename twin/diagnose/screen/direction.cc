#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "twin/diagnose/screen/angles.h"
#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/tests.h"
#include "twin/diagnose/screen/words.h"

namespace twinbench::diagnose::screen {
namespace {

constexpr int kLeastPairs = 4;
constexpr int kMostOrders = 6;

/// Direction of each reading, 0 where its place was not visited the other way round. Continuous motion hardly ever
/// comes back to a place: if there are no pairs, every reading counts that was taken outside the calibration.
Eigen::VectorXd PairedDirection(const Schedule& s) {
  std::vector<PlaceKey> keys;
  for (int i = 0; i < s.Readings(); ++i) keys.push_back(PlaceOfReading(s, i));
  const std::vector<int> place = Numbered(keys);
  std::vector<std::array<int, 2>> visits(place.size(), {0, 0});
  for (std::size_t i = 0; i < place.size(); ++i) ++visits[static_cast<std::size_t>(place[i])][s.direction[i] > 0];
  int pairs = 0;
  for (const auto& v : visits) pairs += v[0] > 0 && v[1] > 0;
  Eigen::VectorXd direction = Eigen::VectorXd::Zero(s.Readings());
  for (std::size_t i = 0; i < place.size(); ++i) {
    const auto& v = visits[static_cast<std::size_t>(place[i])];
    const bool counts = pairs >= kLeastPairs ? v[0] > 0 && v[1] > 0 : s.phase[i] != Phase::kCalibration;
    if (counts) direction[static_cast<Eigen::Index>(i)] = s.direction[i];
  }
  return direction;
}

void TestMean(const Sample& s, const Eigen::VectorXd& direction, Tests& tests) {
  Keep(TestScan(s, {{direction}, 1},
                {"direction: mean", {"the direction of travel"}, "backlash, hysteresis or settling"}),
       tests);
}

/// Direction times harmonics of the angle: backlash that differs around the turn.
void TestAround(const Sample& s, const Eigen::VectorXd& direction, Tests& tests) {
  for (const AngleArgument& argument : AnglesOf(s.run)) {
    if (argument.name != "target angle" && argument.name != "reference angle") continue;
    const std::vector<double> orders = OrdersUpTo(std::min(kMostOrders, HighestOrder(argument.angle_rad)));
    if (orders.empty()) continue;
    const Eigen::MatrixXd shapes = direction.asDiagonal() * Harmonics(argument.angle_rad, orders);
    ScanWords words{
        "direction: harmonics of the " + argument.name, {}, "backlash or hysteresis that varies around the turn"};
    for (double h : orders) {
      words.items.push_back(fmt::format("the direction of travel with order {:g} of the {}", h, argument.name));
    }
    Keep(TestScan(s, {{shapes}, 2}, words), tests);
  }
}

/// What is left of the move after the dwell, 1 at the shortest. Its mean is taken out: plain backlash is silent.
void TestDwell(const Sample& s, const Eigen::VectorXd& direction, Tests& tests) {
  const Eigen::VectorXd& dwell_s = s.run.schedule.dwell_s;
  if (!Varies(dwell_s)) return;
  constexpr std::array<double, 4> kTimes_s = {0.5, 1.0, 2.0, 5.0};
  Eigen::MatrixXd shapes(dwell_s.size(), std::ssize(kTimes_s));
  ScanWords words{"direction: dwell", {}, "settling or creep after the move (amplitude at the shortest dwell)"};
  const double weight = std::max(1.0, direction.squaredNorm());
  const double shortest_s = dwell_s.array().isFinite().select(dwell_s.array(), INFINITY).minCoeff();
  for (double time_s : kTimes_s) {
    Eigen::VectorXd rest =
        dwell_s.unaryExpr([&](double v) { return std::isfinite(v) ? std::exp(-(v - shortest_s) / time_s) : 0.0; });
    rest.array() -= direction.cwiseAbs2().dot(rest) / weight;
    shapes.col(std::ssize(words.items)) = direction.cwiseProduct(rest);
    words.items.push_back(fmt::format("the direction times exp(-dwell / {:g} s)", time_s));
  }
  Keep(TestScan(s, {{shapes}, 1}, words), tests);
}

/// Error in proportion to velocity, in excess of what only its sign explains.
void TestSpeed(const Sample& s, const Eigen::VectorXd& direction, Tests& tests) {
  const Eigen::VectorXd& velocity_rad_s = s.run.schedule.velocity_rad_s;
  if (!Varies(velocity_rad_s.cwiseAbs())) return;
  Eigen::VectorXd velocity = velocity_rad_s.unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; });
  const double fastest = velocity.cwiseAbs().maxCoeff(), weight = std::max(1.0, direction.squaredNorm());
  velocity /= fastest;
  velocity -= direction * (direction.dot(velocity) / weight);
  Keep(TestScan(s, {{velocity}, 1},
                {"direction: speed",
                 {"the velocity (amplitude at the highest speed, the mean of each direction apart)"},
                 "latency between the two devices, lag of a servo, viscous wind-up"}),
       tests);
}

}  // namespace

Tests TestDirection(const Sample& sample) {
  Tests tests;
  const Eigen::VectorXd direction = PairedDirection(sample.run.schedule);
  if (direction.minCoeff() >= 0.0 || direction.maxCoeff() <= 0.0) return tests;
  TestMean(sample, direction, tests);
  TestAround(sample, direction, tests);
  TestDwell(sample, direction, tests);
  TestSpeed(sample, direction, tests);
  return tests;
}

}  // namespace twinbench::diagnose::screen
