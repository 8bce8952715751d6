#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/foreign/machine.h"
#include "tests/foreign/stand_run.h"

/// What can be wrong with the rotary bench, in closed form.
namespace twinbench::foreign {

/// A fault as drawn. Both functions get the whole run, because some faults remember.
struct StandFault {
  Truth truth;
  std::function<void(const StandRun& run, double size, std::vector<Disturbed>& disturbed)> of_body = {};
  std::function<void(const StandRun& run, double size, Eigen::MatrixX4d& shown_m)> of_electronics = {};
  double smallest = 1e-13, largest = 10.0;
};

struct StandKind {
  std::string name;
  StandFault (*draw)(Dice& dice, const StandRun& example);
};
const std::vector<StandKind>& ListedStandKinds();
const std::vector<StandKind>& UnlistedStandKinds();

/// A body that moves with the course of `shape`, by `size`.
/// @param member  &Disturbed::ex_rad, ...
StandFault Moving(Truth truth, double Disturbed::*member, std::function<double(const StandStop&)> shape);
/// The same of the laser's or the light's numbers.
StandFault Shining(Truth truth, double Light::*member, std::function<double(const StandStop&)> shape);
/// One channel, `size` times the shape of what it shows.
StandFault OnChannel(Truth truth, int channel, std::function<double(const StandStop&, double shown_m)> shape);

std::string ChannelName(int channel);

}  // namespace twinbench::foreign
