#include <map>
#include <vector>

#include "twin/benches/turntable_autocollimator/bench.h"
#include "twin/diagnose/splits.h"

namespace twinbench::benches::turntable {
namespace {

constexpr const char* kBothWays = "passes + - - + in every mounting";
constexpr const char* kDwells = "measuring positions with dwells from 0.5 to 20 s";
constexpr const char* kLifts = "twenty lifts of the multi-tooth table at one position";
constexpr const char* kWarm = "a run at a temperature changed by 1 K, with the temperature recorded";
constexpr const char* kIdle = "an hour of readings at rest, nothing moved nor mounted";

/// What depends on what stands on the turntable.
struct Standing {
  const char *other_tilt, *sweep, *wide_sweep, *off_centre;
};

constexpr Standing kMultitooth = {
    "the same circle again with another tilt of the multi-tooth table and the autocollimator left alone",
    "a sweep: the turntable alone by ±200 arcsec in steps that are no whole number of pixels, the multi-tooth "
    "table "
    "left seated",
    "a sweep over the whole range of the autocollimator",
    "the multi-tooth table set a millimetre off the turntable's axis, and on it again"};
/// A face that is nulled shows one place of the instrument's range only.
constexpr Standing kPolygon = {
    "the same circle again with another tilt of the polygon and the autocollimator left alone",
    "the multi-tooth table in the polygon's place and a sweep of the turntable by ±200 arcsec",
    "the multi-tooth table in the polygon's place and a sweep over the whole range of the autocollimator",
    "the polygon set some tenths of a millimetre off the turntable's axis, and on it again"};

const Standing& StandingOf(bool has_polygon) {
  return has_polygon ? kPolygon : kMultitooth;
}

/// The first that fits counts.
std::vector<diagnose::Split> Splits(const Standing& s) {
  return {{{"backlash", "settling"}, kDwells},
          {{"multitooth_seating", "outliers"}, kLifts},
          {{"autocollimator_temperature", "autocollimator_drift", "mount_creep", "tone"}, kWarm},
          {{"autocollimator_drift", "mount_creep", "slip", "tone"}, kIdle},
          {{"autocollimator_scale", "autocollimator_nonlinearity", "autocollimator_periodic"}, s.sweep},
          {{"autocollimator_roll"}, s.other_tilt},
          {{"mirror_flatness"}, s.off_centre},
          {{"autocollimator_scale"}, s.sweep},
          {{"autocollimator_nonlinearity"}, s.sweep},
          {{"autocollimator_periodic"}, s.sweep},
          {{"multitooth_seating"}, kLifts},
          {{"backlash"}, kBothWays},
          {{"settling"}, kBothWays}};
}

}  // namespace

std::string NextMeasurement(const std::string& effect, const std::string& rival, bool has_polygon) {
  return diagnose::WhatSplits(Splits(StandingOf(has_polygon)), effect, rival, kIdle);
}

std::string WhatWouldShow(const std::string& effect, bool has_polygon) {
  const Standing& s = StandingOf(has_polygon);
  const std::map<std::string, const char*> shown_by = {{"autocollimator_roll", s.other_tilt},
                                                       {"autocollimator_scale", s.sweep},
                                                       {"autocollimator_nonlinearity", s.wide_sweep},
                                                       {"autocollimator_periodic", s.sweep},
                                                       {"mirror_flatness", s.off_centre},
                                                       {"autocollimator_drift", kBothWays},
                                                       {"autocollimator_temperature", kWarm},
                                                       {"mount_creep", kBothWays},
                                                       {"backlash", kBothWays},
                                                       {"settling", kDwells}};
  const auto found = shown_by.find(effect);
  return found == shown_by.end() ? "" : found->second;
}

}  // namespace twinbench::benches::turntable
