#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/tests.h"
#include "twin/diagnose/screen/words.h"

namespace twinbench::diagnose::screen {
namespace {

/// Where a running sum is farthest from zero.
struct Peak {
  double height = 0.0;
  int after = 0;  // readings summed
};

Peak PeakOf(const Sample& s, int channel, int column) {
  const int channels = s.run.Channels(), readings = s.run.schedule.Readings();
  Peak peak;
  double sum = 0.0;
  for (int i = 0; i < readings; ++i) {
    sum += s.levelled(i * channels + channel, column);
    if (std::abs(sum) > std::abs(peak.height)) peak = {sum, i + 1};
  }
  return peak;
}

/// Difference of the means behind and before the peak, in units of the noise.
double Change(const Peak& peak, int readings) {
  const double before = peak.after, behind = readings - peak.after;
  return behind > 0.0 ? -peak.height * (1.0 / before + 1.0 / behind) : 0.0;
}

}  // namespace

/// Cumulative sum (Page, Biometrika 41 (1954) 100-115): a mean that shifts or creeps shows as a bend, whatever its
/// course, where a step or a drift would have to have theirs.
Tests TestCusum(const Sample& s) {
  const LinearRun& run = s.run;
  if (!Varies(run.schedule.time_s)) return {};
  Eigen::MatrixXd values(run.Channels(), s.Columns());
  for (int c = 0; c < run.Channels(); ++c) {
    for (int j = 0; j < s.Columns(); ++j) values(c, j) = std::abs(PeakOf(s, c, j).height);
  }
  auto found = TestMoments(values, run.channels, "time: running sum", Sides::kUpper);
  if (!found) return {};
  const Peak peak = PeakOf(s, found->item, 0);
  const double change = Change(peak, run.schedule.Readings());
  SetEffect(run, found->item, std::abs(change) * s.level[found->item] * TypicalSigma(run, found->item),
            found->test);
  const int at = std::min(peak.after, run.schedule.Readings() - 1);
  found->test.reading = fmt::format(
      "the mean of {} changes near reading {} (at {:.0f} s), at once or slowly: a knock, drift or creep",
      run.channels[static_cast<std::size_t>(found->item)], run.schedule.reading[static_cast<std::size_t>(at)],
      run.schedule.time_s[at]);
  return {std::move(found->test)};
}

}  // namespace twinbench::diagnose::screen
