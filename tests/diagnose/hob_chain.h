#pragma once

#include <map>
#include <string>
#include <vector>

#include "twin/core/reading.h"
#include "twin/core/scenario.h"

/// Readings of a hobbing machine by formulas of the tests' own: the samples are found along the way of the table,
/// rings are circles off their shaft, the hob's signals are a point in a plane, play and torsion follow the path
/// with its ramps. Diagnosis knows all of this to first order only.
namespace twinbench::diagnose::test {

/// One hidden cause of the catalogue, parameters in SI.
struct HiddenCause {
  std::string name, where;
  std::map<std::string, double> value;
};

struct HobChain {
  std::vector<double> heads_deg = {0.0, 177.0};
  std::vector<double> hob_speeds_rev_min = {50.0};
  std::vector<int> passes = {1, -1};
  int turns = 3;
  int samples_per_turn = 720;
  double remount_s = 1800.0;
  bool interferometer = false;
  double table_noise_arcsec = 0.1;
  double hob_noise_arcsec = 0.5;
  double interferometer_noise_arcsec = 0.02;
  bool hob_steps = true;  // the hob's encoder counts whole steps, a hundredth of a line
  bool noise_told = true;
  std::uint64_t seed = 1;
  std::vector<HiddenCause> hidden = {};
};

/// What is told of it: everything but the hidden causes and the free orders of the transmission error.
Scenario ScenarioOf(const HobChain& chain);

/// The transmission error has random waves of orders 1 to 4, and constants in every set-up, by the seed.
std::vector<Reading> ReadingsOf(const HobChain& chain);

}  // namespace twinbench::diagnose::test
