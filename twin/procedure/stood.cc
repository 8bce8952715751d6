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

void RequireOnWay(const std::string& axis, double from, double to, double at) {
  constexpr double kShareOfWay = 0.5, kLeast = 1e-3;  // m or rad: what takes up play, and overshoots
  const double slack = kShareOfWay * std::abs(to - from) + kLeast;
  if (!(at < std::min(from, to) - slack) && !(at > std::max(from, to) + slack)) return;
  throw DeviceFault(FaultKind::kMoved, axis, "is at once elsewhere than on the way that it was sent: somebody set its zero anew");
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
