#pragma once

#include <Eigen/Core>

#include "tests/foreign/machine.h"

/// Courses of an angle comparison, off every grid, and what can be wrong with its device, in closed form.
namespace twinbench::foreign {

inline constexpr double kDegree = M_PI / 180.0;

/// One reading of an angle device and where the shaft is.
struct Instant {
  double t_s = 0.0, angle_deg = 0.0, speed_deg_s = 0.0;
  int direction = 1, pass = 0, position = 0;
  double temperature_degC = 20.0;
  double travelled_deg = 0.0;  // since the start, either way
  double since_reversal_deg = 0.0,
         since_reversal_s = 0.0;  // travel and time; before the first one: since the start
  int sense = 1;                  // of the last motion, at rest too
};
using Track = std::vector<Instant>;

/// What two runs of one machine have in common.
struct AngleDesign {
  bool in_motion = false;
  double stops_per_turn = 60.0, turns = 2.0, start_deg = 0.0;
  std::vector<int> passes = {1, -1, -1, 1};
  double interval_s = 4.0;                          // between readings, on average
  std::vector<double> speeds_deg_s = {40.0, 15.0};  // of the passes in turn
  double jitter = 0.3;                              // of stops and intervals, share of a step
};
AngleDesign DrawStops(Dice& dice);
AngleDesign DrawMotion(Dice& dice);

/// One run: another seed, other stops and times, and a little more or less of them.
Track DrawTrack(const AngleDesign& design, Dice& dice);

double Duration_s(const Track& track);

/// A fault as drawn: all but its size and the run.
struct AngleFault {
  Truth truth;
  /// What it adds to each reading [deg]. It grows with the size, which has the dimension that suits the fault.
  std::function<Eigen::VectorXd(const Track& track, double size)> shown_deg;
  double smallest = 1e-9, largest = 100.0;  // sizes that make sense
};

enum class Where { kStops, kMotion, kBoth };

struct AngleKind {
  std::string name;
  Where where;
  /// @param example  A run of the machine: for times and angles within it.
  AngleFault (*draw)(Dice& dice, const Track& example);
};

/// Causes that the catalogue has.
const std::vector<AngleKind>& ListedAngleKinds();
/// Causes that it lacks, or that are known to be taken for one that it has.
const std::vector<AngleKind>& UnlistedAngleKinds();
std::vector<AngleKind> LockedKinds();

/// One value a reading, in their order.
template <class Of>
Eigen::VectorXd Along(const Track& track, Of of) {
  Eigen::VectorXd shown(std::ssize(track));
  for (std::size_t i = 0; i < track.size(); ++i) shown[static_cast<Eigen::Index>(i)] = of(track[i]);
  return shown;
}

/// size * shape of each reading.
AngleFault Linear(Truth truth, std::function<double(const Instant&)> shape);

}  // namespace twinbench::foreign
