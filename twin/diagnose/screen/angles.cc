#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "twin/core/units.h"
#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/scan.h"
#include "twin/diagnose/screen/tests.h"

namespace twinbench::diagnose::screen {
namespace {

/// A bearing's cage turns at 0.38 to 0.5 of the shaft; half turns and their odd multiples repeat every second turn.
constexpr std::array kHalfTurnOrders = {0.38, 0.40, 0.42, 0.44, 0.46, 0.48, 0.50, 1.5, 2.5, 3.5};

/// Direction of each reading, 0 where its place was not visited the other way round. Continuous motion hardly ever
/// comes back to a place: if there are no pairs, every reading counts that was taken outside the calibration.
Eigen::VectorXd PairedDirection(const Schedule& s) {
  constexpr int kLeastPairs = 4;
  std::map<PlaceKey, std::array<bool, 2>> visited;
  for (int i = 0; i < s.Readings(); ++i) visited[PlaceOfReading(s, i)][s.direction[i] > 0] = true;
  const auto pairs =
      std::ranges::count_if(visited, [](const auto& place) { return place.second[0] && place.second[1]; });
  Eigen::VectorXd direction = Eigen::VectorXd::Zero(s.Readings());
  for (int i = 0; i < s.Readings(); ++i) {
    const auto [back, forth] = visited[PlaceOfReading(s, i)];
    const bool counts = pairs >= kLeastPairs ? back && forth : s.phase[i] != Phase::kCalibration;
    if (counts) direction[i] = s.direction[i];
  }
  return direction;
}

/// Direction times harmonics of the angle: backlash that differs around the turn.
void TestAround(const Sample& s, const Eigen::VectorXd& direction, Tests& tests) {
  for (const AngleArgument& argument : AnglesOf(s.run)) {
    if (!argument.of_a_body) continue;
    Scan scan{"direction: harmonics of the " + argument.name, 2};
    for (double h = 1.0; h <= std::min(6, HighestOrder(argument.angle_rad)); ++h)
      scan.Add(direction.asDiagonal() * Wave(h * argument.angle_rad), h);
    TestScan(s, scan, tests);
  }
}

/// What is left of the move after the dwell, 1 at the shortest. Its mean is taken out: plain backlash is silent.
void TestDwell(const Sample& s, const Eigen::VectorXd& direction, Tests& tests) {
  const Eigen::ArrayXd dwell_s = s.run.schedule.dwell_s;
  if (!Varies(dwell_s)) return;
  Scan scan{"direction: dwell"};
  const double weight = std::max(1.0, direction.squaredNorm());
  const double shortest_s = dwell_s.isFinite().select(dwell_s, INFINITY).minCoeff();
  for (double time_s : {0.5, 1.0, 2.0, 5.0}) {
    Eigen::VectorXd rest = Recorded((-(dwell_s - shortest_s) / time_s).exp());
    rest.array() -= direction.cwiseAbs2().dot(rest) / weight;
    scan.Add(direction.cwiseProduct(rest), time_s);
  }
  TestScan(s, scan, tests);
}

/// Error in proportion to velocity, in excess of what only its sign explains.
void TestSpeed(const Sample& s, const Eigen::VectorXd& direction, Tests& tests) {
  if (!Varies(s.run.schedule.velocity_rad_s.cwiseAbs())) return;
  Eigen::VectorXd velocity = Recorded(s.run.schedule.velocity_rad_s);
  velocity /= velocity.cwiseAbs().maxCoeff();
  velocity -= direction * (direction.dot(velocity) / std::max(1.0, direction.squaredNorm()));
  Scan scan{"direction: speed"};
  scan.Add(velocity);
  TestScan(s, scan, tests);
}

}  // namespace

void TestHarmonics(const Sample& sample, Tests& tests) {
  for (const auto& [name, angle_rad, of_a_body] : AnglesOf(sample.run)) {
    Scan whole{"harmonics: " + name, 2};
    for (double h = 1.0; h <= HighestOrder(angle_rad); ++h) whole.Add(Wave(h * angle_rad), h);
    TestScan(sample, whole, tests);
    // Whole orders close after a turn; others need more than a turn to be told from them.
    if (!of_a_body || !(angle_rad.maxCoeff() - angle_rad.minCoeff() > 2.5 * units::kPi)) continue;
    Scan half{"half turns: " + name, 2};
    for (double h : kHalfTurnOrders) half.Add(Wave(h * angle_rad), h);
    TestScan(sample, half, tests);
  }
}

void TestDirection(const Sample& sample, Tests& tests) {
  const Eigen::VectorXd direction = PairedDirection(sample.run.schedule);
  if (direction.minCoeff() >= 0.0 || direction.maxCoeff() <= 0.0) return;
  Scan mean{"direction: mean"};
  mean.Add(direction);
  TestScan(sample, mean, tests);
  TestAround(sample, direction, tests);
  TestDwell(sample, direction, tests);
  TestSpeed(sample, direction, tests);
}

}  // namespace twinbench::diagnose::screen
