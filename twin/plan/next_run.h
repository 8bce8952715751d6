#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

namespace twinbench::plan {

inline constexpr bool kSameKind = false, kOtherKind = true;

/// A run that could be made next: the scenario with other keys. What no key says (a wavemeter, another bench) is no
/// run of this bench.
struct NextRun {
  std::string name;               // one word, of its folder: "sweeps"
  std::string words;              // what is done: "both tilts swept, the tables at rest"
  std::vector<std::string> sets;  // "procedure.passes=[1, -1]"
  /// Under circumstances that the scenario's own run has not: speeds, dwells, temperature, distances. What looks
  /// like a known cause without being one need not do so there.
  bool is_of_another_kind = false;
  /// The scenario's own motion, read at more places of it: what shows in one of the two shows in the other.
  bool is_denser = false;
};

/// Of "longer-readings" and "denser": a quarter of the noise, where another run of the same time leaves 0.7 of it.
inline constexpr int kTimesTheReadings = 16;

/// The same run with every reading the mean of `count` (samples, frames, queries): nobody repeats hours where
/// seconds do.
inline NextRun LongerReadings(std::string words, const std::string& key, int count) {
  return {"longer-readings", std::move(words), {fmt::format("{}={}", key, count)}, kSameKind};
}

/// The same motion, read more often: `set` says how often.
inline NextRun DenserReadings(std::string words, std::string set) {
  return {"denser", std::move(words), {std::move(set)}, kSameKind, true};
}

}  // namespace twinbench::plan
