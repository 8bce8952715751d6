#include "twin/diagnose/unknown/collector.h"

namespace twinbench::diagnose::unknown {

std::vector<Family> Families(const Design& design) {
  Collector collect(std::make_shared<const Design>(design));
  AddByLabel(collect);
  AddByDirection(collect);
  AddBySpeed(collect);
  AddByAngle(collect);
  AddInTime(collect);
  AddByReading(collect);
  return collect.Take();
}

}  // namespace twinbench::diagnose::unknown
