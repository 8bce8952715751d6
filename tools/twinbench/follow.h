#pragma once

#include <string>
#include <vector>

#include "tools/twinbench/json_answer.h"
#include "twin/core/estimator.h"

namespace twinbench::tools {

struct FollowOptions {
  std::string folder;    // of a run that is being recorded, or was
  std::string scenario;  // empty: the folder's own
  std::vector<std::string> overrides;
  double false_alarm_rate = 0.01;          // a run
  Estimator model = Estimator::kRigorous;  // sensitivities that are believed
};

/// Watches a run while it is recorded: compares each new reading with what those before it predict, and prints a
/// line to stdout for every alarm as it comes. Ends when the record is complete or at SIGINT, with a summary and the report of the watch.
/// @throws InputError if there is no record, or a complete one cannot be predicted at all.
void Follow(const FollowOptions& options, JsonAnswer& answer);

}  // namespace twinbench::tools
