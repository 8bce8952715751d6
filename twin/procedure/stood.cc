#include "twin/procedure/stood.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/device_fault.h"
#include "twin/core/number_text.h"
#include "twin/core/units.h"

namespace twinbench::procedure {
namespace {

struct InFiles {
  double to_SI;
  const char* unit;
};

InFiles PlaceOf(const Stood& stood) {
  return stood.is_rotary ? InFiles{units::deg, "deg"} : InFiles{units::mm, "mm"};
}

InFiles DistanceOf(const Stood& stood) {
  return stood.is_rotary ? InFiles{units::arcsec, "arcsec"} : InFiles{units::um, "µm"};
}

void EnterPlace(Reading& reading, const Stood& stood, const char* when, double at) {
  const InFiles place = PlaceOf(stood);
  if (std::isfinite(at))
    reading.extra[fmt::format("{}_encoder_{}_{}", stood.axis, when, place.unit)] = PrintInUnit(at, place.to_SI);
}

void RequireOriginAboutReading(const std::string& axis, bool referenced) {
  if (referenced) return;
  throw DeviceFault(FaultKind::kRestarted, axis,
                    "has lost its origin; where it stood while it was read nobody knows");
}

}  // namespace

bool WasAtRest(const Reading& reading) {
  return std::ranges::any_of(reading.extra, [](const auto& column) { return column.first.find("_encoder_before_") != std::string::npos; });
}

double StoodAt(const std::string& table, const TableState& state) {
  RequireOriginAboutReading(table, state.referenced);
  return state.encoder_rad;
}

double StoodAt(const MachineAxis& axis, const AxisState& state) {
  RequireOriginAboutReading(axis.name, state.referenced);
  return state.encoder;
}

double Stood::Off() const {
  return std::fmax(std::abs(before - sent), std::abs(after - sent));
}

void EnterInto(Reading& reading, const Stood& stood) {
  EnterPlace(reading, stood, "before", stood.before);
  EnterPlace(reading, stood, "after", stood.after);
}

double FurthestIn(const MachineAxis& axis, double took_s) {
  constexpr double kLeast = 1e-3;                                             // m or rad
  constexpr double kFastest_rad_s = 10.0 * units::turn, kFastest_m_s = 10.0;  // no axis of such a bench goes so fast
  return kLeast + took_s * (axis.is_rotary ? kFastest_rad_s : kFastest_m_s);
}

void RequireOnWay(const MachineAxis& axis, double from, double to, double at, double took_s) {
  constexpr double kShareOfWay = 0.5, kLeast = 1e-3;              // m or rad: what takes up play, and overshoots
  const double slack = kShareOfWay * std::abs(to - from) + kLeast;
  const bool is_too_far = std::abs(at - from) > FurthestIn(axis, took_s);
  if (!(at < std::min(from, to) - slack) && !(at > std::max(from, to) + slack) && !is_too_far) return;
  throw DeviceFault(is_too_far ? FaultKind::kImplausible : FaultKind::kMoved, axis.name,
                    fmt::format("was at {:.6f} {} and {:.3g} s later at {:.6f}, on the way to {:.6f}, which no axis does: somebody set its zero anew",
                                from / axis.to_SI(), axis.unit(), took_s, at / axis.to_SI(), to / axis.to_SI()));
}

void RequireStood(const Stood& stood) {
  if (!(stood.Off() > stood.tolerance)) return;
  const InFiles place = PlaceOf(stood), distance = DistanceOf(stood);
  const auto off = [&](double at) { return fmt::format("{:.3g} {}", (at - stood.sent) / distance.to_SI, distance.unit); };
  throw DeviceFault(FaultKind::kMoved, stood.axis,
                    fmt::format("does not stand at its measuring position, {:.6f} {}: {} off before the reading, {} off behind it, and {:.3g} "
                                "{} are allowed",
                                stood.sent / place.to_SI, place.unit, off(stood.before), off(stood.after),
                                stood.tolerance / distance.to_SI, distance.unit));
}

}  // namespace twinbench::procedure
