#include <fmt/format.h>

#include <cmath>

#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/tests.h"
#include "twin/diagnose/screen/words.h"

namespace twinbench::diagnose::screen {
namespace {

constexpr int kLags = 5;

/// Products of residuals `lag` readings apart in the same pass and channel, summed; one a column. Their expectation
/// is not zero: a projected white residual is negatively correlated. The nulls carry it.
Eigen::RowVectorXd LagProducts(const Sample& s, int lag, int& pairs) {
  const int channels = s.run.Channels();
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(s.Columns());
  pairs = 0;
  for (int i = lag; i < s.run.schedule.Readings(); ++i) {
    if (!SamePass(s.run.schedule, i, i - lag)) continue;
    pairs += channels;
    for (int j = 0; j < s.Columns(); ++j) {
      const auto column = s.levelled.col(j);
      sum[j] += column.segment(i * channels, channels).dot(column.segment((i - lag) * channels, channels));
    }
  }
  return sum;
}

}  // namespace

Tests TestWhiteness(const Sample& s) {
  Eigen::MatrixXd values(kLags, s.Columns());
  std::vector<std::string> names;
  std::vector<int> pairs(kLags);
  for (int lag = 1; lag <= kLags; ++lag) {
    values.row(lag - 1) = LagProducts(s, lag, pairs[static_cast<std::size_t>(lag - 1)]);
    names.push_back(fmt::format("lag {}", lag));
  }
  auto found = TestMoments(values, names, "whiteness within a pass", Sides::kBoth);
  if (!found) return {};
  const double correlation = found->excess / (s.redundancy.mean() * pairs[static_cast<std::size_t>(found->item)]);
  SetEffect(s.run, AnyChannel(s.run),
            s.level.mean() * TypicalSigma(s.run, 0) * std::sqrt(std::min(1.0, std::abs(correlation))), found->test);
  found->test.reading = fmt::format(
      "readings {} apart are correlated by {:+.3f} beyond what the fit causes: {}", found->item + 1, correlation,
      correlation > 0.0 ? "correlated noise, drift or slow dynamics that are not modelled"
                        : "alternating error, or noise that a filter has differentiated");
  return {std::move(found->test)};
}

}  // namespace twinbench::diagnose::screen
