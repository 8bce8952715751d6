#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/estimators.h"
#include "twin/diagnose/screen/tests.h"

namespace twinbench::diagnose::screen {
namespace {

/// A way to sort the readings; each group may have an offset of its own.
struct Sorting {
  std::string name;
  std::vector<int> group;  // by reading

  int Groups() const { return *std::ranges::max_element(group) + 1; }
};

/// Sortings that sort: more than one group, and groups of more than one reading.
std::vector<Sorting> SortingsOf(const Schedule& s) {
  std::vector<PlaceKey> setup, pass, place;
  for (int i = 0; i < s.Readings(); ++i) {
    setup.push_back({s.setup[i], static_cast<long>(s.phase[i])});
    pass.push_back({s.setup[i], static_cast<long>(s.phase[i]), s.pass[i]});
    place.push_back(PlaceOfReading(s, i));
  }
  std::vector<Sorting> all = {{"mounting", Numbered(setup)}, {"pass", Numbered(pass)}, {"place", Numbered(place)}};
  std::erase_if(all, [&](const Sorting& by) { return by.Groups() < 2 || by.Groups() >= s.Readings(); });
  return all;
}

/// Sums of squares of the groups' sums, channels x columns: the slope of the restricted likelihood where all
/// components are zero, but for a constant, and so the most powerful statistic against small ones.
Eigen::MatrixXd SlopesAtZero(const Sample& s, const Sorting& sorting) {
  Eigen::MatrixXd values(s.run.Channels(), s.Columns());
  for (int c = 0; c < s.run.Channels(); ++c) {
    const Eigen::MatrixXd sums = SumsByGroup(s.levelled(RowsOf(s.run, c), Eigen::all), sorting.group);
    values.row(c) = sums.colwise().squaredNorm();
    // Groups whose offsets are free unknowns: nothing is left but rounding and the width of the priors.
    if (values.row(c).tail(s.Columns() - 1).mean() < 1e-3 * s.run.schedule.Readings()) values.row(c).setZero();
  }
  return values;
}

/// The components of one channel, of the first sortings that together are few enough for a dense likelihood.
VarianceComponents ComponentsOn(const Sample& s, const std::vector<Sorting>& sortings, int channel) {
  constexpr int kMostGroups = 600;
  std::vector<std::vector<int>> few;
  int groups = 0;
  for (const Sorting& sorting : sortings) {
    groups += sorting.Groups();
    if (groups > kMostGroups) break;
    few.push_back(sorting.group);
  }
  return few.empty() ? VarianceComponents{} : FitVarianceComponents(s, few, channel);
}

void AddLines(const LinearRun& run, const std::vector<Sorting>& sortings, int channel,
              const VarianceComponents& components, ScreenTest& test) {
  const std::string& on = run.channels[channel];
  const auto rms = [&](double variance) {
    return Amount(run, channel, TypicalSigma(run, channel) * std::sqrt(variance));
  };
  for (Eigen::Index k = 0; k < components.variance.size(); ++k) {
    const double variance = components.variance[k], u = components.u_variance[k];
    test.tables.push_back(fmt::format(
        "{}, by {}: {}", on, sortings[k].name,
        std::isnan(u) ? "part of the free unknowns" : rms(variance) + " rms, at most " + rms(variance + 2.0 * u)));
  }
  if (components.variance.size() > 0)
    test.tables.push_back(
        fmt::format("{}, single readings: {} rms, stated {}", on, rms(components.repeat), rms(1.0)));
}

}  // namespace

/// Variance components: offsets that differ from set-up to set-up, pass to pass, place to place. Found by the slope
/// of the restricted likelihood at zero, with its nulls; sized by its maximum, all components together.
void TestGroups(const Sample& s, Tests& tests) {
  const std::vector<Sorting> sortings = SortingsOf(s.run.schedule);
  std::map<int, VarianceComponents> fitted;  // by channel
  for (int k = 0; k < std::ssize(sortings); ++k) {
    const auto meaning = [&](int channel, double, ScreenTest& test) {
      if (!fitted.contains(channel)) fitted[channel] = ComponentsOn(s, sortings, channel);
      const VarianceComponents& components = fitted[channel];
      const double variance = k < components.variance.size() ? components.variance[k] : kNaN;
      SetEffect(s.run, channel, TypicalSigma(s.run, channel) * std::sqrt(variance), test);
      test.reading = ReadingOf(test.name, s.run.channels[channel]);
      AddLines(s.run, sortings, channel, components, test);
    };
    TestMoments({"offsets by " + sortings[k].name, s.run.channels, SlopesAtZero(s, sortings[k])}, Sides::kUpper,
                meaning, tests);
  }
}

}  // namespace twinbench::diagnose::screen
