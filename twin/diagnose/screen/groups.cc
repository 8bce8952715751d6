#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/tests.h"
#include "twin/diagnose/screen/words.h"

namespace twinbench::diagnose::screen {
namespace {

/// A way to sort the readings; each group may have an offset of its own.
struct Sorting {
  std::string name, causes;
  std::vector<int> group;  // by reading
};

std::vector<Sorting> SortingsOf(const Schedule& s) {
  std::vector<std::vector<int>> setup, pass;
  std::vector<PlaceKey> place;
  for (int i = 0; i < s.Readings(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    setup.push_back({s.setup[k], static_cast<int>(s.phase[k])});
    pass.push_back({s.setup[k], static_cast<int>(s.phase[k]), s.pass[k]});
    place.push_back(PlaceOfReading(s, i));
  }
  return {{"set-up", "mountings that were not free enough in the model", Numbered(setup)},
          {"pass", "something moves or is seated anew between passes", Numbered(pass)},
          {"place", "an error of position that no free table error explains", Numbered(place)}};
}

/// Sums of the whitened residual by group: groups x columns. `share` receives what a unit offset of the group
/// leaves of its sum on average, that is the information S'WS.
Eigen::MatrixXd GroupSums(const Sample& s, const std::vector<int>& group, int channel, int groups) {
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(groups, s.Columns());
  for (std::size_t i = 0; i < group.size(); ++i) {
    sums.row(group[i]) += s.levelled.row(static_cast<Eigen::Index>(i) * s.run.Channels() + channel);
  }
  return sums;
}

/// Variance of the groups' offsets by the method of moments, in units of the noise: the excess of the sum of
/// squares over what it would be for a unit variance, trace (Z'WZ)^2, with the nulls' covariance of the sums as
/// Z'WZ.
double Variance(const Eigen::MatrixXd& sums, double excess) {
  const Eigen::MatrixXd nulls = sums.rightCols(sums.cols() - 1);
  const double diagonal = (nulls.rowwise().squaredNorm() / static_cast<double>(nulls.cols())).squaredNorm();
  return diagonal > 0.0 ? std::max(0.0, excess / diagonal) : 0.0;
}

void TestSorting(const Sample& s, const Sorting& sorting, Tests& tests) {
  const int groups = *std::max_element(sorting.group.begin(), sorting.group.end()) + 1;
  const int readings = static_cast<int>(sorting.group.size());
  if (groups < 2 || groups == readings) return;
  const int channels = s.run.Channels();
  Eigen::MatrixXd values(channels, s.Columns());
  std::vector<Eigen::MatrixXd> sums;
  for (int c = 0; c < channels; ++c) {
    sums.push_back(GroupSums(s, sorting.group, c, groups));
    values.row(c) = sums.back().colwise().squaredNorm();
    // Groups whose offsets are free unknowns: nothing is left but rounding and the width of the priors.
    if (values.row(c).tail(s.Columns() - 1).mean() < 1e-3 * readings) values.row(c).setZero();
  }
  auto found = TestMoments(values, s.run.channels, "offsets by " + sorting.name, Sides::kUpper);
  if (!found) return;
  const auto c = static_cast<std::size_t>(found->item);
  const double size = std::sqrt(Variance(sums[c], found->excess));
  SetEffect(s.run, size * s.level[found->item] * TypicalSigma(s.run, found->item), found->test);
  found->test.reading = fmt::format("each {} has an offset of its own on {}, {} rms: {}", sorting.name,
                                    s.run.channels[c], Amount(s.run, found->test.effect_m), sorting.causes);
  tests.push_back(std::move(found->test));
}

}  // namespace

Tests TestGroups(const Sample& sample) {
  Tests tests;
  for (const Sorting& sorting : SortingsOf(sample.run.schedule)) TestSorting(sample, sorting, tests);
  return tests;
}

}  // namespace twinbench::diagnose::screen
