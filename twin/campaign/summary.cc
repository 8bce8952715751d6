#include "twin/campaign/summary.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "twin/core/reading.h"

namespace twinbench::campaign {
namespace {

/// "a[3].b[7]" is one number of "a[].b[]".
std::string WithoutIndices(const std::string& name) {
  std::string text;
  bool inside = false;
  for (const char c : name) {
    if (c == ']') inside = false;
    if (!inside) text += c;
    if (c == '[') inside = true;
  }
  return text;
}

/// One bias with its sign; of several, which may cancel, their root mean square.
double BiasOf(const std::vector<double>& biases) {
  if (biases.size() == 1) return biases.front();
  double sum = 0.0;
  for (const double bias : biases) sum += bias * bias;
  return biases.empty() ? kNaN : std::sqrt(sum / static_cast<double>(biases.size()));
}

}  // namespace

void Summary::Sums::Add(const TrialResult& r) {
  if (!std::isfinite(r.value)) return;
  ++count;
  const double from_mean = r.value - mean;
  mean += from_mean / static_cast<double>(count);
  about_mean += from_mean * (r.value - mean);
  if (std::isfinite(r.u)) {
    ++count_u;
    sum_u2 += r.u * r.u;
  }
  if (!std::isfinite(r.error) || !std::isfinite(r.u)) return;
  ++scored;
  sum_error += r.error;
  sum_error2 += r.error * r.error;
  covered += std::abs(r.error) <= r.k * r.u ? 1 : 0;
}

void Summary::Add(const TrialRow& row) {
  ++trials_;
  if (!row.failure.empty()) lost_.push_back({row.trial, row.failure, "", {}});
  if (!row.verdict.empty()) ++verdicts_[row.verdict];
  WorstTrial worst{row.trial, "", 0.0};
  for (const TrialResult& r : row.results) {
    sums_[r.name].Add(r);
    const double normed = std::abs(r.error) / r.u;
    if (std::isfinite(normed) && normed > worst.normed) worst = {row.trial, r.name, normed};
  }
  if (!worst.result.empty()) worst_.push_back(worst);
}

std::map<std::string, ResultSummary> Summary::Results() const {
  struct Pool {
    double sum = 0.0, about_means = 0.0, dof = 0.0, sum_u2 = 0.0, count_u = 0.0, sum_error2 = 0.0, covered = 0.0;
    std::vector<double> biases;
  };
  std::map<std::string, ResultSummary> results;
  std::map<std::string, Pool> pools;
  for (const auto& [name, s] : sums_) {
    if (s.count == 0) continue;
    ResultSummary& result = results[WithoutIndices(name)];
    Pool& pool = pools[WithoutIndices(name)];
    result.count += s.count;
    result.scored += s.scored;
    pool.sum += s.mean * static_cast<double>(s.count);
    pool.about_means += s.about_mean;
    pool.dof += static_cast<double>(s.count - 1);
    pool.sum_u2 += s.sum_u2;
    pool.count_u += static_cast<double>(s.count_u);
    if (s.scored > 0) pool.biases.push_back(s.sum_error / static_cast<double>(s.scored));
    pool.sum_error2 += s.sum_error2;
    pool.covered += static_cast<double>(s.covered);
  }
  for (auto& [name, result] : results) {
    const Pool& pool = pools[name];
    const double scored = result.scored > 0 ? static_cast<double>(result.scored) : kNaN;
    result.mean = pool.sum / static_cast<double>(result.count);
    result.sd = pool.dof > 0.0 ? std::sqrt(pool.about_means / pool.dof) : kNaN;
    result.rms_u = pool.count_u > 0.0 ? std::sqrt(pool.sum_u2 / pool.count_u) : kNaN;
    result.rms_error = std::sqrt(pool.sum_error2 / scored);
    result.bias = BiasOf(pool.biases);
    result.coverage95 = pool.covered / scored;
  }
  return results;
}

std::vector<WorstTrial> Summary::Worst(std::size_t most) const {
  std::vector<WorstTrial> worst = worst_;
  std::ranges::stable_sort(worst, std::greater(), &WorstTrial::normed);
  worst.resize(std::min(worst.size(), most));
  return worst;
}

Summary SummaryOf(const Table& table) {
  Summary summary;
  table.ForEach([&](const TrialRow& row) { summary.Add(row); });
  return summary;
}

}  // namespace twinbench::campaign
