#include "twin/benches/encoder_comparison/estimators/passes.h"

#include <cmath>
#include <map>
#include <tuple>

#include "twin/benches/encoder_comparison/estimators/angle_comparison.h"
#include "twin/core/units.h"

namespace twinbench::separate::encoder {
namespace {

struct PassColumns {
  std::vector<double> reference_rad, error_rad, velocity_rad_s;
};

/// `angle_rad` without a break, `last_rad` having come before.
double Followed(double angle_rad, double last_rad, int direction) {
  const double back_turns = -direction * (angle_rad - last_rad) / units::turn;
  return back_turns > 0.5 ? angle_rad + direction * units::turn * std::round(back_turns) : angle_rad;
}

void Append(const Reading& reading, double error_rad, PassColumns& columns) {
  std::vector<double>& phi_rad = columns.reference_rad;
  phi_rad.push_back(phi_rad.empty() ? reading.reference_rad
                                    : Followed(reading.reference_rad, phi_rad.back(), reading.direction));
  columns.error_rad.push_back(error_rad);
  columns.velocity_rad_s.push_back(reading.velocity_rad_s);
}

Eigen::VectorXd AsVector(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values));
}

/// Half a mean step before the first reading a turn begins, so that its last stop is not the next one's first.
std::vector<int> LapsOf(const Eigen::VectorXd& phi_rad, int direction) {
  const Eigen::VectorXd way_rad = direction * (phi_rad.array() - phi_rad[0]);
  const double step_rad =
      way_rad.tail(1).value() / static_cast<double>(std::max<Eigen::Index>(1, way_rad.size() - 1));
  std::vector<int> laps;
  for (const double way : way_rad)
    laps.push_back(std::max(0, static_cast<int>(std::floor((way + 0.5 * step_rad) / units::turn))));
  return laps;
}

ComparedPass PassOf(int pass, int direction, const PassColumns& columns) {
  ComparedPass result;
  result.pass = pass;
  result.direction = direction;
  result.reference_rad = AsVector(columns.reference_rad);
  result.error_rad = AsVector(columns.error_rad);
  result.velocity_rad_s = AsVector(columns.velocity_rad_s);
  result.lap = LapsOf(result.reference_rad, direction);
  return result;
}

}  // namespace

double ComparedPass::Turns() const {
  return (reference_rad.maxCoeff() - reference_rad.minCoeff()) / units::turn;
}

double ComparedPass::Middle_rad() const {
  return 0.5 * (reference_rad.maxCoeff() + reference_rad.minCoeff());
}

int PassGroup::Readings() const {
  Eigen::Index count = 0;
  for (const ComparedPass& pass : passes) count += pass.reference_rad.size();
  return static_cast<int>(count);
}

SortedPasses SortPasses(const std::vector<Reading>& readings) {
  const measure::AngleComparison comparison = measure::CompareAngles(readings);
  std::map<std::tuple<int, int, int>, PassColumns> sorted;  // set-up, - direction, pass
  SortedPasses result;
  result.left_out = comparison.left_out;
  for (std::size_t i = 0; i < comparison.used.size(); ++i) {
    const Reading& reading = readings[static_cast<std::size_t>(comparison.used[i])];
    if (reading.direction == 0) {
      ++result.left_out;
      continue;
    }
    Append(reading, comparison.error_rad[static_cast<Eigen::Index>(i)],
           sorted[{reading.setup, -reading.direction, reading.pass}]);
  }
  for (const auto& [key, columns] : sorted) {
    const auto [setup, backward, pass] = key;
    std::vector<PassGroup>& groups = result.groups;
    if (groups.empty() || groups.back().setup != setup || groups.back().direction != -backward)
      groups.push_back({setup, -backward, {}});
    groups.back().passes.push_back(PassOf(pass, -backward, columns));
  }
  return result;
}

}  // namespace twinbench::separate::encoder
