#include "twin/diagnose/rotary/unknown_collector.h"

namespace twinbench::diagnose::rotary {

std::vector<Family> UnknownFamilies(const RotaryRun& rotary, const SignalContext& context,
                                    const SharedSeries& series) {
  Collector collect(rotary, context);
  AddByPass(collect);
  AddByDirection(collect);
  AddByAngle(collect);
  AddInTime(collect);
  AddByDwell(collect);
  AddGains(collect);
  AddBySpot(collect);
  AddOtherPatterns(collect, series);
  return collect.Take();
}

}  // namespace twinbench::diagnose::rotary
