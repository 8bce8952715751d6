#pragma once

#include <limits>
#include <string>

#include "twin/core/devices.h"
#include "twin/core/machine.h"
#include "twin/core/reading.h"

namespace twinbench::procedure {

/// Where an axis stood about a reading, by its encoder. Angles [rad], places of a linear axis [m]; NaN: not known.
struct Stood {
  std::string axis;  // "target", "x"
  bool is_rotary = true;
  double sent = kNaN;                   // where the controller was told to bring it
  double before = kNaN, after = kNaN;   // encoder, at once before and behind what was read
  double tolerance = std::numeric_limits<double>::infinity();  // of encoder against sent

  /// The largest of both distances from where it was sent; NaN: not known.
  double Off() const;
};

/// Adds what the encoder showed to the reading: columns AXIS_encoder_before_deg and AXIS_encoder_after_deg, or _mm. They are
/// columns beside those of the bench: files without them are whole.
void EnterInto(Reading& reading, const Stood& stood);

/// Whether it was entered into the reading where an axis stood: it was taken at rest.
bool WasAtRest(const Reading& reading);

/// Where the encoder of a table or axis that is looked at about a reading says it stands.
/// @throws DeviceFault kRestarted if its controller has lost its origin: what was read meanwhile is no reading.
double StoodAt(const std::string& table, const TableState& state);
double StoodAt(const MachineAxis& axis, const AxisState& state);

/// In that time no axis goes further [m or rad].
double FurthestIn(const MachineAxis& axis, double took_s);

/// @param took_s  At most, since it stood at `from`.
/// @throws DeviceFault kImplausible where an axis that has just been sent from one place to another stands further from its begin than
///         any axis goes in that time, kMoved where it stands beyond that way by half of it: as it was sent its zero was set anew, which
///         nothing else tells, for where it comes to is what it was sent to.
void RequireOnWay(const MachineAxis& axis, double from, double to, double at, double took_s);

/// @throws DeviceFault kMoved if it stood further from its stop than its tolerance, before what was read or behind it.
void RequireStood(const Stood& stood);

}  // namespace twinbench::procedure
