#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "twin/core/reading.h"
#include "twin/core/scenario.h"

/// The twin set to a record's circumstances: what the readings should have been, without noise.
namespace twinbench::model {

/// A scalar input of a bench at which a disturbance can enter: "laser.yaw", "target.ez", "psd_a.roll".
struct Point {
  std::string name;
  std::string unit;    // of reports: "urad"
  double to_SI = 1.0;  // factor from `unit` to SI
  double step = kNaN;  // SI: half the distance over which slopes are differenced
  double lower = -std::numeric_limits<double>::infinity();  // SI: of a constant of the bench
};

/// What enters at one point: a value at each reading of the record [SI].
struct Disturbance {
  std::string point;
  Eigen::VectorXd value;
};

/// One bench's twin on the course of one record: times, angles, directions, dwells, temperatures, set-ups, in order
/// and with the history that effects with a memory need. Every key of the scenario and every effect counts, because
/// it is the twin that answers. Errors that a run leaves free (those of tables and mountings) are not the
/// scenario's but whatever `Predict` is given at their points.
class Follow {
 public:
  virtual ~Follow() = default;

  /// Where disturbances can enter; what is no number of one reading (an onset, a wire) is no point.
  virtual const std::vector<Point>& Points() const = 0;

  virtual Eigen::Index Readings() const = 0;

  /// What each reading should have shown: readings x channels, SI, in the bench's own order of channels; NaN where
  /// nothing would be shown.
  /// @throws std::logic_error for a point that does not exist or a value that is not one a reading.
  virtual Eigen::MatrixXd Predict(const std::vector<Disturbance>& disturbances = {}) const = 0;

  /// What the record does not fix and what was taken instead, in words.
  virtual std::vector<std::string> Unfixed() const { return {}; }
};

/// Makes the twin that follows a record, of the bench that the scenario names.
/// @throws InputError if a file that the scenario names cannot be read or does not fit.
using FollowMaker =
    std::function<std::unique_ptr<Follow>(const Scenario& scenario, const std::vector<Reading>& record)>;

/// @throws std::logic_error if there is no point of that name.
const Point& PointNamed(const Follow& follow, const std::string& name);

/// d reading / d point by central differences over the point's step, about `disturbances`: readings x channels.
Eigen::MatrixXd Slope(const Follow& follow, const Point& point, const std::vector<Disturbance>& disturbances = {});

}  // namespace twinbench::model
