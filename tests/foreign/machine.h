#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "twin/core/reading.h"
#include "twin/core/scenario.h"

/// Machines with something wrong that nobody told the program of: made from the published form of readings and from
/// closed forms, with neither the twin nor its signals.
namespace twinbench::foreign {

/// Names of the catalogue: "backlash", or with the place that it must have: "psd_gain psd_a_x".
using Names = std::vector<std::string>;

/// What is wrong, and which answers are honest.
struct Truth {
  std::string kind;  // "warm-up"; of several "eccentricity + warm-up"
  std::vector<Names> listed =
      {};                   // causes of the catalogue: its name first, then those that no reading tells from it
  int unlisted = 0;         // causes that the catalogue lacks
  Names honest = {};        // further names that are near enough: "drift" of a warm-up
  bool only_noise = false;  // the noise is unusual and nothing else: silence is right as well
  bool repeats = true;      // another run of the machine shows the same

  bool IsClean() const { return listed.empty() && unlisted == 0; }
};

/// One run of a machine.
struct Run {
  std::uint64_t seed = 1;  // of its schedule and its noise
  bool noise = true;
  bool faults = true;  // false: the same machine in order
};

inline constexpr Run kFirst{1};
inline constexpr Run kAnother{2};
inline constexpr Run kAnotherWithoutNoise{2, false, true};

struct Machine {
  Truth truth;
  Scenario believed;
  std::function<std::vector<Reading>(const Run&)> readings;
  std::function<Scenario(Scenario)> in_another_run = [](Scenario scenario) { return scenario; };  // its schedule
};

/// A machine before it is made.
struct Plan {
  std::string set, name;
  std::function<Machine()> make;
};

/// One that the catalogue lacks.
inline Truth Unlisted(Names honest = {}) {
  Truth truth;
  truth.unlisted = 1;
  truth.honest = std::move(honest);
  return truth;
}
inline Truth Listed(Names names) {
  Truth truth;
  truth.listed = {std::move(names)};
  return truth;
}

/// Puts the faults of a machine together.
inline void Append(const Truth& more, Truth& truth) {
  const bool is_first = truth.kind.empty();
  truth.only_noise = is_first && more.only_noise;
  truth.kind += (is_first ? "" : " + ") + more.kind;
  truth.listed.insert(truth.listed.end(), more.listed.begin(), more.listed.end());
  truth.honest.insert(truth.honest.end(), more.honest.begin(), more.honest.end());
  truth.unlisted += more.unlisted;
  truth.repeats = truth.repeats && more.repeats;
}

/// The size at which `length` of it is `wanted`, or as near as sizes between the bounds come. Bisection in the
/// logarithm, because faults like clipping do not grow with their size in proportion.
inline double SizeOfLength(double wanted, double smallest, double largest,
                           const std::function<double(double size)>& length) {
  constexpr int kHalvings = 40;
  double low = smallest, high = largest;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = std::sqrt(low * high);
    (length(middle) < wanted ? low : high) = middle;
  }
  return std::sqrt(low * high);
}

}  // namespace twinbench::foreign
