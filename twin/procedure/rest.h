#pragma once

#include <chrono>
#include <functional>
#include <limits>
#include <vector>

#include "twin/core/machine.h"
#include "twin/core/table_limits.h"
#include "twin/procedure/standstill.h"

namespace twinbench::procedure {

/// A table or axis as one look at it shows it. Angles [rad], places of a linear axis [m].
struct SeenAxis {
  std::string name;
  bool is_rotary = true;
  bool moving = false;      // as its controller says
  double encoder = kNaN;    // NaN: its origin is lost, and the controller's word is all there is
  double in_position = std::numeric_limits<double>::infinity();  // of its limits
};
using HostTime = std::chrono::steady_clock::time_point;
using AxesLook = std::function<std::vector<SeenAxis>()>;

/// What is told to stop by one word and looked at by one question.
struct Stoppable {
  std::function<void()> stop;
  AxesLook look;
};

/// @throws what the table and the machine throw.
std::vector<SeenAxis> LookAt(RotaryTable& table, const std::string& name, const TableLimits& limits);
/// @param limits  One entry an axis; none: nothing is known of them.
std::vector<SeenAxis> LookAt(MachineController& machine, const std::vector<AxisLimits>& limits);

/// Tells everything to stop, whatever state it is in, and watches whether it comes to rest.
///
/// All are told before any is looked at, and told again when the word failed or rest does not come. Rest is seen in three looks
/// within a second: the controller says so and no encoder leaves the width that counts as in position. A word that was refused is
/// no matter where rest is seen. A link is dead behind some seconds of failures; one part that does not answer keeps nobody from
/// stopping the others. Never throws what devices throw.
/// @param now  Of the computer: a bench's clock may fail with its link.
Standstill BringToRest(Clock& clock, const std::vector<Stoppable>& parts, const std::function<HostTime()>& now = std::chrono::steady_clock::now);

/// Whether all are at rest by the same looks; nothing is told to them. Takes a second of real time.
/// @throws what the looks throw.
Standstill WhetherAtRest(const std::vector<AxesLook>& looks);

}  // namespace twinbench::procedure
