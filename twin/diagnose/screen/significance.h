#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "twin/diagnose/screen/screen.h"

/// From a statistic and its nulls to a ScreenTest. Entry or column 0 is the run, the others are nulls: the same
/// statistic of noise alone.
namespace twinbench::diagnose::screen {

using Tests = std::vector<ScreenTest>;

/// Share of nulls whose statistic is at least the run's, counting the run itself. Beyond the largest tenth of the
/// nulls: an exponential with the mean of their excesses, which is too cautious for statistics with Gaussian tails
/// and never gives 0.
double PValue(const Eigen::VectorXd& statistic);

/// A test without size and words.
ScreenTest Tested(const std::string& name, const Eigen::VectorXd& statistic);

/// Values of several items: orders, onsets, channels.
struct Statistic {
  std::string test;
  std::vector<std::string> items;
  Eigen::MatrixXd values;  // items x columns
};

/// The item of the run with the largest value, compared with the largest of each null.
struct Loudest {
  ScreenTest test;
  int item = 0;
};
Loudest LoudestOf(const Statistic& statistic);

/// Which deviations of a moment speak: a variance component is never negative.
enum class Sides { kBoth, kUpper };

/// Gives a test the size and the words of its loudest item, of which `excess` is the value minus the nulls' mean.
using Meaning = std::function<void(int item, double excess, ScreenTest& test)>;

/// Adds the test of the item that stands out most in units of its nulls' scatter; nothing if none varies in them.
void TestMoments(Statistic moments, Sides sides, const Meaning& meaning, Tests& tests);

}  // namespace twinbench::diagnose::screen
