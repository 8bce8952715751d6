#pragma once

#include <string>
#include <vector>

namespace twinbench::plan {

inline constexpr bool kSameKind = false, kOtherKind = true;

/// A run that could be made next: the scenario with other keys. What no key says (a wavemeter, another bench) is no
/// run of this bench.
struct NextRun {
  std::string name;               // one word, of its folder: "sweeps"
  std::string words;              // what is done: "both tilts swept, the tables at rest"
  std::vector<std::string> sets;  // "procedure.passes=[1, -1]"
  /// Under circumstances that the scenario's own run has not: speeds, dwells, temperature, distances. What looks like
  /// a known cause without being one need not do so there.
  bool is_of_another_kind = false;
};

}  // namespace twinbench::plan
