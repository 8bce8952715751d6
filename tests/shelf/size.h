#pragma once

#include <optional>

#include "tests/shelf/truth.h"
#include "twin/diagnose/diagnosis.h"

/// Sizes of causes as a truth has them.
namespace twinbench::shelf {

struct Size {
  double value = kNaN, u = kNaN;  // SI; of a length, the angle it counts as
  std::string kind;               // "angle", "time", "ratio", "rate"
};

/// @throws InputError if there is no such unit.
Size InSI(double size, const std::string& unit);

/// Order of what a cause does once, twice or k times a turn; NaN if it does nothing of the kind.
double OrderOf(const diagnose::Cause& cause);

/// The amplitude of one order that a cause has: of faults of the signals, to first order or by their curve. Nothing
/// if it has no such order, or no size is told.
std::optional<Size> AmplitudeOf(const diagnose::Cause& cause, double order);

/// Of all causes of one order together, as far as amplitude and phase are told: one may be named in two pieces.
std::optional<Size> AmplitudeTogether(const std::vector<diagnose::Cause>& causes, double order);

/// What is told of a cause in place of the expected size: its amplitude, first parameter, ... Nothing if it is not
/// told.
std::optional<Size> SizeOf(const diagnose::Cause& cause, const Expected& expected);

/// The orders are as good as the same.
bool IsSameOrder(double a, double b);

}  // namespace twinbench::shelf
