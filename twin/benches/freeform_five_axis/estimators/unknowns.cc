#include "twin/benches/freeform_five_axis/estimators/unknowns.h"

namespace twinbench::benches::freeform::estimators {

double UnitOf(int unknown) {
  if (unknown >= SquarenessAt(0) && unknown < kOfMachine) return units::arcsec;
  const int error =
      unknown < kOfMachine ? unknown / kCubicTerms % kBodyErrors : (unknown - kOfMachine) % kBodyErrors;
  return IsRotation(error) ? units::arcsec : units::um;
}

std::vector<std::string> NamesOf(int setups) {
  std::vector<std::string> names;
  for (const char* axis : kAxisNames) {
    for (const char* error : kBodyErrorNames) {
      for (int term = 0; term < kCubicTerms; ++term)
        names.push_back(std::string(axis) + "." + error + std::to_string(term));
    }
  }
  names.insert(names.end(), kSquarenessNames.begin(), kSquarenessNames.end());
  for (int setup = 0; setup < setups; ++setup) {
    for (const char* error : kBodyErrorNames) names.push_back("mount" + std::to_string(setup) + "." + error);
  }
  return names;
}

}  // namespace twinbench::benches::freeform::estimators
