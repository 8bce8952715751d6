#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "twin/procedure/machine_options.h"
#include "twin/procedure/options.h"

namespace twinbench::procedure {

/// What a column should do and did where the axes went a short way [SI].
struct ColumnInStep {
  std::string name;
  double should = 0.0, did = 0.0;
  double noise = 0.0;  // of what is shown once
  bool is_of_size =
      true;           // false: by the place that nobody knows so well its size may be any, and its sign is sure
  double back = 0.0;  // what it shows behind coming back, less what it showed before; asked of those of a size
};

/// Proves beside readings at rest that what is shown follows the axes: with their signs, units, zeros and channels,
/// and that no axis stands. What reaches into a channel for good is proved by each; what none moves - the other
/// coordinate of a spot - is not.
class StepProof {
 public:
  /// @param learns  The first step says which sign the columns of a size have and how far they go, within a factor
  /// of three of what
  ///                they should: wiring and gains are the bench's own, and a calibration finds them.
  explicit StepProof(bool learns) : learns_(learns) {}
  /// @throws DeviceFault kMoved where a column did not what it should, or is not what it was behind coming back: by
  /// a quarter of the
  ///         step that shows most, or the other way. kChanged where the last four went otherwise than all
  ///         before.
  void Require(std::vector<ColumnInStep> columns);

 private:
  void Learn(const std::vector<ColumnInStep>& columns, double step);
  void RequireSteady(const std::vector<ColumnInStep>& columns, double step);

  bool learns_;
  std::map<std::string, std::vector<double>>
      went_;                   // of what it should, or of the step where it should stand, by column
  std::vector<double> known_;  // what the columns did in the first step, over what shows most; none yet: empty
};

/// Goes by so much beside where the axes stand, or against it where that leads beyond limits, looks, and goes back.
/// @param by  One entry an axis [m or rad]; becomes the way that was gone.
/// @throws what Watch throws.
Reading ShownBeside(MachineBench& bench, std::vector<double>& by, const MachineOptions& options);
/// Goes away by so much of the first axis [rad] and comes back, which is how it shows what it shows when it comes
/// from there.
Reading ShownAgain(MachineBench& bench, double away_rad, Duration dwell, const MachineOptions& options);
/// Two tables on each other do, the reference the other way round.
void ComeAgain(RotaryBench& bench, double away_rad, Duration dwell, const Options& options);

/// ShownBeside of two tables on each other: the target goes twice as far and the reference back by half of that, so
/// that one which stands, or goes against its command, changes the yaw by no less than all of it.
/// @param yaw_rad  Of what stands on both.
/// @param look     Called beside where they stand.
void LookBeside(RotaryBench& bench, double& yaw_rad, const Options& options, const std::function<void()>& look);

}  // namespace twinbench::procedure
