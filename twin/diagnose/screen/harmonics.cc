#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "twin/diagnose/screen/angles.h"
#include "twin/diagnose/screen/tests.h"
#include "twin/diagnose/screen/words.h"

namespace twinbench::diagnose::screen {
namespace {

/// A bearing's cage turns at 0.38 to 0.5 of the shaft; half turns and their odd multiples repeat every second turn.
const std::vector<double>& HalfTurnOrders() {
  static const std::vector<double> orders = {0.38, 0.40, 0.42, 0.44, 0.46, 0.48, 0.50, 1.5, 2.5, 3.5};
  return orders;
}

const char* CausesOf(const std::string& argument) {
  if (argument == "target angle") return "eccentricity, ellipse, gear or encoder of the target, or of the device";
  if (argument == "reference angle") return "eccentricity, ellipse, gear or encoder of the reference";
  if (argument == "sum of both angles") return "fixed in the laboratory, or wobble of the reference's rotor";
  return "the two tables' errors multiply";
}

void TestOrders(const Sample& s, const AngleArgument& argument, const std::vector<double>& orders,
                const std::string& name, const std::string& causes, Tests& tests) {
  if (orders.empty()) return;
  ScanWords words{name, {}, causes};
  for (double h : orders) words.items.push_back(fmt::format("order {:g} of the {}", h, argument.name));
  Keep(TestScan(s, {{Harmonics(argument.angle_rad, orders)}, 2}, words), tests);
}

/// Whole orders close after a turn; others need more than a turn to be told from them.
bool CoversMoreThanATurn(const Eigen::VectorXd& angle_rad) {
  return angle_rad.maxCoeff() - angle_rad.minCoeff() > 2.5 * std::numbers::pi;
}

}  // namespace

Tests TestHarmonics(const Sample& sample) {
  Tests tests;
  for (const AngleArgument& argument : AnglesOf(sample.run)) {
    TestOrders(sample, argument, OrdersUpTo(HighestOrder(argument.angle_rad)), "harmonics: " + argument.name,
               CausesOf(argument.name), tests);
    const bool bearing = argument.name == "target angle" || argument.name == "reference angle";
    if (!bearing || !CoversMoreThanATurn(argument.angle_rad)) continue;
    TestOrders(sample, argument, HalfTurnOrders(), "half turns: " + argument.name,
               "rolling elements or the cage of a bearing", tests);
  }
  return tests;
}

}  // namespace twinbench::diagnose::screen
