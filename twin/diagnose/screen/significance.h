#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "twin/core/stream.h"
#include "twin/diagnose/screen/screen.h"

/// From a statistic and its nulls to a ScreenTest with words. Entry or column 0 is the run, the others are nulls:
/// the same statistic of noise alone.
namespace twinbench::diagnose::screen {

using Tests = std::vector<ScreenTest>;

/// What a test says: templates of fmt.
struct Words {
  std::string_view test;                  // its name
  std::string_view item;                  // one of the alternatives that it tries
  std::string_view reading;               // what the loudest means
  std::string_view more = {}, less = {};  // and goes on like this if it deviates upwards, or downwards
};

/// @throws std::logic_error if no test has this name.
const Words& WordsOf(std::string_view test);

template <typename... Args>
std::string ItemOf(std::string_view test, const Args&... args) {
  return fmt::format(fmt::runtime(WordsOf(test).item), args...);
}
template <typename... Args>
std::string ReadingOf(std::string_view test, const Args&... args) {
  return fmt::format(fmt::runtime(WordsOf(test).reading), args...);
}
template <typename... Args>
std::string ReadingBySign(std::string_view test, bool up, const Args&... args) {
  const Words& words = WordsOf(test);
  return fmt::format(fmt::runtime(std::string(words.reading) + std::string(up ? words.more : words.less)), args...);
}

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
void TestMoments(const Statistic& moments, Sides sides, const Meaning& meaning, Tests& tests);

/// Standard normals.
Eigen::MatrixXd Normals(Stream& stream, Eigen::Index rows, Eigen::Index columns);

}  // namespace twinbench::diagnose::screen
