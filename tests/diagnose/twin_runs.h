#pragma once

#include "twin/benches/encoder_comparison/diagnosis/encoder_run.h"
#include "twin/benches/encoder_comparison/twin/factory.h"

/// Readings as a diagnosis takes them, against the twin that follows them.
namespace twinbench::diagnose {

namespace encoder {
inline EncoderRun RunOf(const std::vector<Reading>& readings, const Scenario& scenario) {
  return BuildRun(readings, scenario, benches::encoder::FollowRecord);
}
}  // namespace encoder

}  // namespace twinbench::diagnose
