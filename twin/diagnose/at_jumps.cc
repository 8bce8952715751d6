#include "twin/diagnose/at_jumps.h"

#include <cmath>

#include "twin/core/distributions.h"
#include "twin/diagnose/same_pass.h"

namespace twinbench::diagnose {
namespace {

/// What `found` gains from a row to that so many readings behind (before: negative), on the same channel; NaN if that is none of
/// its pass.
double GainTo(const LinearRun& run, const Eigen::VectorXd& found, int row, int behind) {
  const int other = row + behind * run.Channels();
  if (other < 0 || other >= run.Rows()) return kNaN;
  const bool is_same = SamePass(run.schedule, run.ReadingOf(row), run.ReadingOf(other));
  return is_same ? found[other] - found[row] : kNaN;
}

double UsualGain(const LinearRun& run, const Eigen::VectorXd& found) {
  std::vector<double> gains;
  for (int row = 0; row < run.Rows(); ++row) {
    const double gain = std::abs(GainTo(run, found, row, 1));
    if (std::isfinite(gain)) gains.push_back(gain);
  }
  return gains.empty() ? 0.0 : Median(std::move(gains));
}

}  // namespace

std::vector<int> AwayFromJumps(std::vector<int> rows, const LinearRun& run, const Eigen::VectorXd& found,
                               const Eigen::VectorXd& left) {
  constexpr double kJump = 6.0, kNoise = 3.0;  // of the usual gain: a wave has 1.4; standard deviations
  const double usual = UsualGain(run, found);
  std::erase_if(rows, [&](int row) {
    for (const int behind : {-2, -1, 1, 2}) {
      const double gain = GainTo(run, found, row, behind);
      const bool jumps = std::abs(gain) > kJump * usual && gain * left[row] > 0.0;
      if (jumps && std::abs(left[row]) < std::abs(gain) + kNoise * run.sigma[row]) return true;
    }
    return false;
  });
  return rows;
}

}  // namespace twinbench::diagnose
