#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "twin/benches/freeform_five_axis/settings.h"
#include "twin/core/reading.h"

/// A machine of up to two rotary axes as a chain of bodies, and where its poses are on it: what errors of the axes
/// act on. Nothing of the probe and its machine is used here.
namespace twinbench::benches::freeform::estimators {

/// What was commanded, and the displacement that was read there.
struct ShiftRead {
  Eigen::Vector3d at_m, turned_rad;  // X, Y, Z; A, B, C
  Eigen::Vector3d shift_m;           // NaN where a component was not read
  int setup = 0;
  int ball = 0;          // see NumberBalls
  int reading = 0;       // its number
  double elapsed = 0.0;  // of the run: from -1 to 1
};

/// One rotary axis: 0, 1, 2 for A, B, C.
struct RotaryStage {
  int axis = 0;
  double sense = 1.0;  // by the right-hand rule about X, Y, Z; -1: against it
  bool on_table = true;

  char Letter() const { return static_cast<char>('A' + axis); }
};

struct MachineChain {
  std::string topology = "table_table";
  std::vector<RotaryStage> stages;  // of the table from the bed on, then of the head

  bool HasHead() const { return !stages.empty() && !stages.back().on_table; }
  bool HasTable() const { return !stages.empty() && stages.front().on_table; }
};

/// A rotary axis at one pose, in the frame of what carries it.
struct StageAt {
  Eigen::Matrix3d frame;    // of what carries it, in machine axes
  Eigen::Vector3d lever_m;  // in machine axes, from the axis to the ball, of a head to the tool's point
  double turned_rad = 0.0;  // as commanded
};

struct PosePlace {
  int ball = 0;
  Eigen::Vector3d slides_m;     // X, Y, Z of the slides, from where the first axis of the table stands
  Eigen::Vector3d ball_m;       // on the table, in its frame
  Eigen::Matrix3d table, head;  // turned, in machine axes
  std::vector<StageAt> stages;
  double elapsed = 0.0;  // of the run: from -1 to 1
};

struct ChainAtPoses {
  std::vector<PosePlace> places;
  double misfit_m = 0.0;  // of the commanded positions: what the chain leaves of them, rms
};

/// Readings of which at least one component was read. What has elapsed is by their times, or without these by how many
/// there are.
std::vector<ShiftRead> ShiftsOf(const std::vector<Reading>& readings);

/// Readings of one ball share where it stands on the table: one a set-up, or one a place of a set-up.
void NumberBalls(bool by_place, std::vector<ShiftRead>& reads);

/// Whether X, Y and Z stand still, or go to a few places again and again, while rotary axes turn: they are then
/// those of a ball on the workpiece.
bool AreOnWorkpiece(const std::vector<ShiftRead>& reads);

/// Chains that the settings leave open, the usual one first.
/// @throws InputError if the settings contradict the axes that move, or more than two do.
std::vector<MachineChain> ChainsFor(const DisplacementSettings& settings, const std::vector<ShiftRead>& reads);

/// Places by X, Y, Z of the slides: where the axes and the ball are follows from the commanded positions
/// themselves, by least squares. Along an axis its place is that of the other one; alone it is where the coordinate
/// is 0.
ChainAtPoses BySlides(const MachineChain& chain, const std::vector<ShiftRead>& reads);

/// Places by X, Y, Z of the ball on the workpiece, axes through the origin.
ChainAtPoses ByWorkpiece(const MachineChain& chain, const std::vector<ShiftRead>& reads, double tool_m);

}  // namespace twinbench::benches::freeform::estimators
