#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "twin/diagnose/screen/sample.h"
#include "twin/diagnose/screen/scan.h"
#include "twin/diagnose/screen/screen.h"
#include "twin/diagnose/screen/sizes.h"

/// From scores to a ScreenTest: p-value, size, place and words.
namespace twinbench::diagnose::screen {

/// Where a fitted shape shows: in a pattern of the run, on one channel, or on several without a known pattern.
struct Place {
  std::string words;         // "in yaw", "on psd_a_x", "on several channels"
  double effect_m = kNaN;    // largest amplitude of a channel; NaN where readings are angles
  double effect_rad = kNaN;  // amplitude of the pattern if that is an angle, else the channel's (AsAngle)
};

/// A pattern or channel is named if it alone explains most of what free amplitudes in all channels explain beyond
/// noise.
/// @param patterns  False if each channel has a shape of its own, which no motion makes.
Place PlaceOf(const LinearRun& run, const Fit& fit, bool patterns);

/// How a test is written down. Item words follow the test's: "residual follows" + item + place + ": " + causes.
struct ScanWords {
  std::string name;
  std::vector<std::string> items;  // one an item of the scan
  std::string causes;
};

/// The largest score of a scan.
struct ScanTest {
  ScreenTest test;
  int item = 0;
  Fit fit;  // of the item, in the run
};
/// @return nothing if the free unknowns absorb every item.
std::optional<ScanTest> TestScan(const Sample& sample, const Scan& scan, const ScanWords& words);

/// The same of scores (items x columns) that were computed elsewhere.
/// @param fit  Fit of an item to the run, all channels sharing its shape.
std::optional<ScanTest> FromScores(const Sample& sample, const Eigen::MatrixXd& scores,
                                   const std::function<Fit(int item)>& fit, const ScanWords& words);

/// Adds what applies.
void Keep(std::optional<ScanTest> found, std::vector<ScreenTest>& tests);

/// Which deviations of a moment speak: a variance component is never negative.
enum class Sides { kBoth, kUpper };

/// Loudest of several moments (items x columns), compared with its own nulls.
struct MomentTest {
  ScreenTest test;      // statistic, p and tables; effect and reading are the caller's
  int item = 0;         // the loudest
  double excess = 0.0;  // its value minus the mean of the nulls
};
/// @return nothing if no item varies between the nulls.
std::optional<MomentTest> TestMoments(const Eigen::MatrixXd& values, const std::vector<std::string>& items,
                                      const std::string& name, Sides sides);

}  // namespace twinbench::diagnose::screen
