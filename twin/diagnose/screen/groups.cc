#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/tests.h"
#include "twin/diagnose/screen/variance_components.h"
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

/// Sums of the whitened residual by group: groups x columns.
Eigen::MatrixXd GroupSums(const Sample& s, const std::vector<int>& group, int channel, int groups) {
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(groups, s.Columns());
  for (std::size_t i = 0; i < group.size(); ++i) {
    sums.row(group[i]) += s.levelled.row(static_cast<Eigen::Index>(i) * s.run.Channels() + channel);
  }
  return sums;
}

int GroupsIn(const std::vector<int>& group) {
  return *std::max_element(group.begin(), group.end()) + 1;
}

/// Sortings that sort: more than one group, and groups of more than one reading.
std::vector<Sorting> UsefulSortings(const Schedule& schedule) {
  std::vector<Sorting> useful;
  for (Sorting& sorting : SortingsOf(schedule)) {
    const int groups = GroupsIn(sorting.group);
    if (groups > 1 && groups < schedule.Readings()) useful.push_back(std::move(sorting));
  }
  return useful;
}

/// Sums of squares of the groups' sums, channels x columns: the slope of the restricted likelihood where all
/// components are zero, but for a constant, and so the most powerful statistic against small ones.
Eigen::MatrixXd SlopesAtZero(const Sample& s, const Sorting& sorting) {
  const int channels = s.run.Channels(), readings = s.run.schedule.Readings(), groups = GroupsIn(sorting.group);
  Eigen::MatrixXd values(channels, s.Columns());
  for (int c = 0; c < channels; ++c) {
    values.row(c) = GroupSums(s, sorting.group, c, groups).colwise().squaredNorm();
    // Groups whose offsets are free unknowns: nothing is left but rounding and the width of the priors.
    if (values.row(c).tail(s.Columns() - 1).mean() < 1e-3 * readings) values.row(c).setZero();
  }
  return values;
}

/// Groups of the first sortings that together are few enough for a dense likelihood.
std::vector<std::vector<int>> FewGroups(const std::vector<Sorting>& sortings) {
  constexpr int kMostGroups = 600;
  std::vector<std::vector<int>> few;
  int groups = 0;
  for (const Sorting& sorting : sortings) {
    groups += GroupsIn(sorting.group);
    if (groups > kMostGroups) break;
    few.push_back(sorting.group);
  }
  return few;
}

/// The components of one channel in words, and as deviations in SI: NaN for sortings of too many groups.
class Components {
 public:
  Components(const Sample& s, const std::vector<Sorting>& sortings, int channel)
      : run_(s.run), channel_(channel), sortings_(sortings) {
    const std::vector<std::vector<int>> few = FewGroups(sortings);
    if (!few.empty()) fit_ = FitVarianceComponents(s, few, channel);
  }
  double Deviation_SI(std::size_t sorting) const {
    const auto k = static_cast<Eigen::Index>(sorting);
    return k < fit_.variance.size() ? InSI(fit_.variance[k]) : kNaN;
  }

  std::vector<std::string> Lines() const {
    const std::string& on = run_.channels[static_cast<std::size_t>(channel_)];
    std::vector<std::string> lines;
    for (Eigen::Index k = 0; k < fit_.variance.size(); ++k) {
      const double variance = fit_.variance[k], u = fit_.u_variance[k];
      const std::string by = fmt::format("{}, by {}: ", on, sortings_[static_cast<std::size_t>(k)].name);
      lines.push_back(by + (std::isnan(u) ? "part of the free unknowns"
                                          : fmt::format("{} rms, at most {}", Amount(run_, InSI(variance)),
                                                        Amount(run_, InSI(variance + 2.0 * u)))));
    }
    if (lines.empty()) return lines;
    lines.push_back(fmt::format("{}, single readings: {} rms, stated {}", on, Amount(run_, InSI(fit_.repeat)),
                                Amount(run_, InSI(1.0))));
    return lines;
  }

 private:
  double InSI(double variance) const { return TypicalSigma(run_, channel_) * std::sqrt(variance); }

  const LinearRun& run_;
  int channel_;
  const std::vector<Sorting>& sortings_;
  VarianceComponents fit_;
};

}  // namespace

/// Variance components: offsets that differ from set-up to set-up, pass to pass, place to place. Found by the slope
/// of the restricted likelihood at zero, with its nulls; sized by its maximum, all components together.
Tests TestGroups(const Sample& sample) {
  const LinearRun& run = sample.run;
  const std::vector<Sorting> sortings = UsefulSortings(run.schedule);
  std::map<int, Components> fitted;  // by channel
  Tests tests;
  for (std::size_t k = 0; k < sortings.size(); ++k) {
    auto found = TestMoments(SlopesAtZero(sample, sortings[k]), run.channels, "offsets by " + sortings[k].name,
                             Sides::kUpper);
    if (!found) continue;
    const int channel = found->item;
    const Components& components = fitted.try_emplace(channel, sample, sortings, channel).first->second;
    SetEffect(run, channel, components.Deviation_SI(k), found->test);
    found->test.reading = fmt::format("each {} has an offset of its own on {}: {}", sortings[k].name,
                                      run.channels[static_cast<std::size_t>(channel)], sortings[k].causes);
    for (std::string& line : components.Lines()) found->test.tables.push_back(std::move(line));
    tests.push_back(std::move(found->test));
  }
  return tests;
}

}  // namespace twinbench::diagnose::screen
