#include "twin/diagnose/encoder/named_parts.h"

namespace twinbench::diagnose::encoder {

std::vector<Family> NamedFamilies(const Context& context, double plausible_rad) {
  std::vector<Family> families;
  AddPeriodic(*context, families);
  AddSignals(context, plausible_rad, families);
  AddMotion(context, plausible_rad, families);
  AddTime(context, families);
  return families;
}

}  // namespace twinbench::diagnose::encoder
