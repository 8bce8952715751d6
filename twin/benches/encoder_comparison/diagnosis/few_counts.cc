#include "twin/benches/encoder_comparison/diagnosis/few_counts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "twin/core/rounding.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose::encoder {
namespace {

struct Levels {
  std::vector<double> values;  // ascending
  std::size_t readings = 0;    // that show them
};

/// Values that come more than once.
Levels LevelsOf(const Eigen::VectorXd& shown_rad) {
  const double same_rad = 1e-8 * shown_rad.cwiseAbs().maxCoeff();
  std::vector<double> values(shown_rad.begin(), shown_rad.end());
  std::ranges::sort(values);
  Levels levels;
  for (std::size_t i = 0; i < values.size();) {
    std::size_t end = i + 1;
    while (end < values.size() && values[end] - values[i] <= same_rad) ++end;
    if (end - i > 1) {
      levels.values.push_back(values[i]);
      levels.readings += end - i;
    }
    i = end;
  }
  return levels;
}

}  // namespace

double CountOfFewValues(const Eigen::VectorXd& shown_rad) {
  constexpr std::size_t kFewest = 3, kMost = 16;
  constexpr double kMostly = 0.67, kOff = 0.05;  // of the readings; of a count
  const Levels levels = LevelsOf(shown_rad);
  const std::vector<double>& values = levels.values;
  if (values.size() < kFewest || values.size() > kMost || CommonStep(shown_rad) > 0.0) return 0.0;
  if (static_cast<double>(levels.readings) < kMostly * static_cast<double>(shown_rad.size())) return 0.0;
  double count_rad = values.back() - values.front();
  for (std::size_t i = 1; i < values.size(); ++i) count_rad = std::min(count_rad, values[i] - values[i - 1]);
  const auto is_off = [&](double value) {
    const double counts = (value - values.front()) / count_rad;
    return std::abs(counts - std::round(counts)) > kOff;
  };
  const bool is_every_value = values.back() - values.front() < static_cast<double>(values.size()) * count_rad;
  return is_every_value || std::ranges::any_of(values, is_off) ? 0.0 : count_rad;
}

void DoubtFewCounts(const Eigen::VectorXd& shown_rad, DiagnosisRun& result) {
  constexpr double kCounts = 2.1;  // one too few here, one too many there, as they are printed
  const double most_rad = kCounts * CountOfFewValues(shown_rad);
  if (!(most_rad > 0.0)) return;
  Diagnosis& d = result.diagnosis;
  const auto is_within = [most_rad](const Eigen::VectorXd& rows) { return rows.maxCoeff() - rows.minCoeff() <= most_rad; };
  bool is_doubted = false;
  const bool are_all_within = is_within(result.run.residual);
  for (const Accepted& accepted : result.accepted) {
    if (!are_all_within && !is_within(accepted.columns * accepted.amplitudes)) continue;
    is_doubted = true;
    if (accepted.family.kind == Kind::kUnknown) d.unknown.probability = std::min(d.unknown.probability, tuning::kNotProven);
    for (Cause& cause : d.causes) {
      if (cause.effect == accepted.family.effect) cause.probability = std::min(cause.probability, tuning::kNotProven);
    }
  }
  if (is_doubted)
    d.notes.push_back(fmt::format("the device shows few values, {:.3g} {} apart: what is no larger than two such counts may be no more than where it came to rest",
                                  most_rad / kCounts / result.run.to_SI, result.run.unit));
}

}  // namespace twinbench::diagnose::encoder
