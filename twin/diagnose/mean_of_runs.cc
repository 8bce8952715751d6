#include "twin/diagnose/mean_of_runs.h"

#include <algorithm>
#include <cmath>

#include "twin/core/reading_column.h"
#include "twin/core/units.h"

namespace twinbench::diagnose {
namespace {

const Quantity kRuns{"runs_in_mean"};

bool IsSameStop(const Reading& a, const Reading& b) {
  return a.setup == b.setup && a.pass == b.pass && a.direction == b.direction && a.position == b.position &&
         a.phase == b.phase;
}

/// A line's time is no reading at a place: a spindle that coasts is elsewhere in every run.
bool IsTimed(const std::vector<Reading>& readings) {
  const Quantity stamp{"stamp_s"};
  return std::ranges::any_of(readings, [&stamp](const Reading& r) { return std::isfinite(stamp(r)); });
}

/// How much more than in `from`: an angle that is shown within a turn may be a turn off.
double Difference(double value, double from, bool is_angle) {
  const double more = value - from;
  return is_angle && std::abs(more) > units::kPi ? std::remainder(more, units::turn) : more;
}

bool IsAngle(const ReadingColumn& column) {
  return column.name.ends_with("_deg") || column.name.ends_with("_arcsec");
}

/// Changes `mean`, the last of the runs, at one stop.
void Average(const std::vector<const std::vector<Reading>*>& runs, std::size_t at, const BenchFormat& format,
             Reading& mean) {
  std::vector<Reading> ones;
  for (const std::vector<Reading>* run : runs) ones.push_back((*run)[at]);
  for (const ReadingColumn& column : format.columns) {
    if (!column.number) continue;
    double& value = column.number(mean);
    double more = 0.0;
    for (Reading& one : ones) more += Difference(column.number(one), value, IsAngle(column));
    value += more / static_cast<double>(runs.size());
  }
}

}  // namespace

bool AreOfOnePlan(const std::vector<Reading>& a, const std::vector<Reading>& b) {
  return std::ranges::equal(a, b, IsSameStop) && !IsTimed(a) && !IsTimed(b);
}

std::optional<std::vector<Reading>> MeanOfRuns(const std::vector<const std::vector<Reading>*>& runs,
                                               const BenchFormat& format) {
  std::vector<Reading> mean = *runs.back();
  if (runs.size() == 1) return mean;
  for (const std::vector<Reading>* run : runs) {
    if (!AreOfOnePlan(*run, mean)) return std::nullopt;
  }
  for (std::size_t i = 0; i < mean.size(); ++i) {
    for (const std::vector<Reading>* run : runs) {
      if ((*run)[i].status != ReadingStatus::kOk) mean[i].status = (*run)[i].status;
    }
    Average(runs, i, format, mean[i]);
    kRuns(mean[i]) = static_cast<double>(runs.size());
  }
  return mean;
}

int RunsIn(const std::vector<Reading>& readings) {
  const double runs = readings.empty() ? kNaN : kRuns(readings.front());
  return std::isfinite(runs) ? static_cast<int>(runs) : 1;
}

void ScaleToMean(const std::vector<Reading>& used, LinearRun& run) {
  const int runs = RunsIn(used);
  if (runs == 1 || !run.sigma_stated) return;
  const double step = run.rounding;
  run.sigma = run.sigma.unaryExpr([=](double sigma) {
    const double noise = std::sqrt(std::max(sigma * sigma - step * step / 12.0, 0.0));
    return std::sqrt(noise * noise / runs + RoundingOf(step, noise, runs).all);
  });
}

}  // namespace twinbench::diagnose
