#include <map>
#include <vector>

#include "twin/benches/turntable_autocollimator/bench.h"
#include "twin/diagnose/splits.h"

namespace twinbench::benches::turntable {
namespace {

constexpr const char* kOtherTilt =
    "the same circle again with another tilt of the multi-tooth table and the autocollimator left alone";
constexpr const char* kSweep =
    "a sweep: the turntable alone by +-200 arcsec in steps that are no whole number of pixels, the multi-tooth "
    "table "
    "left seated";
constexpr const char* kWideSweep = "a sweep over the whole range of the autocollimator";
constexpr const char* kOffCentre =
    "the multi-tooth table set a millimetre off the turntable's axis, and on it again";
constexpr const char* kBothWays = "passes + - - + in every set-up";
constexpr const char* kDwells = "stops with dwells from 0.5 to 20 s";
constexpr const char* kLifts = "twenty lifts of the multi-tooth table at one position";
constexpr const char* kWarm = "a run with the room changed by 1 K and the temperature recorded";
constexpr const char* kIdle = "an hour of readings at rest, nothing moved nor mounted";

/// The first that fits counts.
const std::vector<diagnose::Split>& Splits() {
  static const std::vector<diagnose::Split> splits = {
      {{"backlash", "settling"}, kDwells},
      {{"multitooth_seating", "outliers"}, kLifts},
      {{"autocollimator_temperature", "autocollimator_drift", "mount_creep", "tone"}, kWarm},
      {{"autocollimator_drift", "mount_creep", "slip", "tone"}, kIdle},
      {{"autocollimator_scale", "autocollimator_nonlinearity", "autocollimator_periodic"}, kSweep},
      {{"autocollimator_roll"}, kOtherTilt},
      {{"mirror_flatness"}, kOffCentre},
      {{"autocollimator_scale"}, kSweep},
      {{"autocollimator_nonlinearity"}, kSweep},
      {{"autocollimator_periodic"}, kSweep},
      {{"multitooth_seating"}, kLifts},
      {{"backlash"}, kBothWays},
      {{"settling"}, kBothWays}};
  return splits;
}

}  // namespace

std::string NextMeasurement(const std::string& effect, const std::string& rival) {
  return diagnose::WhatSplits(Splits(), effect, rival, kIdle);
}

std::string WhatWouldShow(const std::string& effect) {
  static const std::map<std::string, const char*> shown_by = {{"autocollimator_roll", kOtherTilt},
                                                              {"autocollimator_scale", kSweep},
                                                              {"autocollimator_nonlinearity", kWideSweep},
                                                              {"autocollimator_periodic", kSweep},
                                                              {"mirror_flatness", kOffCentre},
                                                              {"autocollimator_drift", kBothWays},
                                                              {"autocollimator_temperature", kWarm},
                                                              {"mount_creep", kBothWays},
                                                              {"backlash", kBothWays},
                                                              {"settling", kDwells}};
  const auto found = shown_by.find(effect);
  return found == shown_by.end() ? "" : found->second;
}

}  // namespace twinbench::benches::turntable
