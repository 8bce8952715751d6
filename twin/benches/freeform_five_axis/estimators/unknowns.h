#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "twin/benches/freeform_five_axis/settings.h"

/// The unknowns of an identification, in um and arcsec: four coefficients of each of the 30 errors, 7 squareness
/// errors, six of how the artefact stands in each set-up.
namespace twinbench::benches::freeform::estimators {

inline constexpr int kInputs = kMachineAxes * kBodyErrors + kSquarenesses + kBodyErrors;  // that one reading sees
inline constexpr int kOfMachine = kMachineAxes * kBodyErrors * kCubicTerms + kSquarenesses;

constexpr int CubicAt(int axis, int error, int term) {
  return (axis * kBodyErrors + error) * kCubicTerms + term;
}
constexpr int SquarenessAt(int k) {
  return kMachineAxes * kBodyErrors * kCubicTerms + k;
}
constexpr int MountingAt(int setup, int error) {
  return kOfMachine + setup * kBodyErrors + error;
}

/// SI of one: a um or an arcsec.
double UnitOf(int unknown);

/// "x.tx0", "syx", "mount0.tx", ...
std::vector<std::string> NamesOf(int setups);

}  // namespace twinbench::benches::freeform::estimators
