#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "tests/foreign/angle_track.h"
#include "tests/foreign/machine.h"

/// What can be wrong with an angle device, in closed form.
namespace twinbench::foreign {

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
/// Causes that it lacks, or that are known to be taken for one that it has. In files by what they are locked to.
const std::vector<AngleKind>& UnlistedAngleKinds();
std::vector<AngleKind> TimeKinds();
std::vector<AngleKind> AngleLockedKinds();
std::vector<AngleKind> MotionKinds();

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
