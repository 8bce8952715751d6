#include "twin/benches/hob_transmission/diagnosis/hob_answers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/benches/hob_transmission/diagnosis/family_parts.h"
#include "twin/benches/hob_transmission/diagnosis/harmonic_table.h"
#include "twin/benches/hob_transmission/format.h"
#include "twin/core/units.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose::hob {
namespace {

bool IsOutliers(const Cause& cause) {
  return cause.effect == "outliers";
}

bool Continues(const Schedule& s, std::size_t a, std::size_t b) {
  return b < s.pass.size() && s.setup[a] == s.setup[b] && s.pass[a] == s.pass[b] &&
         s.direction[a] == s.direction[b];
}

/// The number of the reading in the middle of each group.
Eigen::VectorXd Middles(const HobRun& hob) {
  const std::vector<int>& readings = hob.context.schedule.reading;
  Eigen::VectorXd numbers(std::ssize(readings));
  std::copy(readings.begin(), readings.end(), numbers.begin());
  return hob.context.groups.Mean(numbers);
}

/// One value a group (of m) at every reading: on straight lines between the groups of a pass, and on beyond the
/// outermost.
Eigen::VectorXd AtReadings(const HobRun& hob, const Eigen::VectorXd& of_groups) {
  const Schedule rows = Grouped(hob.context.schedule, hob.context.groups);
  const Eigen::VectorXd middle = Middles(hob);
  Eigen::VectorXd values(hob.context.Samples());
  for (Eigen::Index g = 0; g < of_groups.size(); ++g) {
    const auto at = static_cast<std::size_t>(g);
    const int first = hob.context.groups.start[at];
    for (int i = first; i < first + hob.context.groups.Size(g); ++i) {
      const double number = hob.context.schedule.reading[static_cast<std::size_t>(i)];
      const bool later = number > middle[g];
      const bool has = later ? Continues(rows, at, at + 1) : g > 0 && Continues(rows, at - 1, at);
      const Eigen::Index other = has ? (later ? g + 1 : g - 1) : g;
      const double part = has ? (number - middle[g]) / (middle[other] - middle[g]) : 0.0;
      values[i] = of_groups[g] + part * (of_groups[other] - of_groups[g]);
    }
  }
  return values;
}

void SpreadUnnamed(const HobRun& hob, Accepted& accepted) {
  const Eigen::VectorXd rows = accepted.columns * accepted.amplitudes;
  const int channels = hob.context.channels;
  const Eigen::VectorXd of_m =
      Eigen::Map<const Eigen::MatrixXd>(rows.data(), channels, rows.size() / channels).row(0);
  accepted.readings = hob.context.schedule.reading;
  accepted.times_s = hob.context.schedule.time_s;
  accepted.at_readings = AtReadings(hob, of_m);
}

Cause OutlierCause(double count, double size_rad, double log_bayes, double of) {
  Cause cause;
  cause.effect = "outliers";
  cause.probability = tuning::kListed;
  cause.log_evidence = log_bayes;
  cause.rho = std::sqrt(2.0 * std::max(0.0, log_bayes));
  const Catalogue catalogue(benches::hob::Format().effects);
  cause.parameters = {catalogue.Estimate("outliers", "fraction", count / of, std::sqrt(count) / of),
                      catalogue.Estimate("outliers", "size", size_rad, size_rad / std::sqrt(2.0 * count))};
  return cause;
}

/// Outliers of groups are outliers of one of their samples, which is farther out by the size of a group.
void MergeOutliers(const HobRun& hob, Diagnosis& diagnosis) {
  if (std::ranges::count_if(diagnosis.causes, IsOutliers) == 0) return;
  const double rows = static_cast<double>(hob.context.groups.Groups()), samples = hob.outliers.of;
  double count = 0.0, square = 0.0, log_bayes = 0.0;
  for (const Cause& cause : diagnosis.causes) {
    if (!IsOutliers(cause)) continue;
    const bool of_samples = cause.log_evidence == hob.outliers.log_bayes;
    const double n = cause.parameters[0].value * (of_samples ? samples : rows);
    count += n;
    square += n * std::pow(cause.parameters[1].value * (of_samples ? 1.0 : samples / rows), 2);
    log_bayes += cause.log_evidence;
  }
  std::erase_if(diagnosis.causes, IsOutliers);
  diagnosis.causes.insert(diagnosis.causes.begin(),
                          OutlierCause(count, std::sqrt(square / count), log_bayes, samples));
}

/// Fitted signal of a term, whitened and projected.
Eigen::VectorXd Projected(const HobRun& hob, const Analysis& analysis, const Term& term) {
  const Eigen::MatrixXd signal = term.columns * term.amplitudes;
  return analysis.projector->Apply(analysis.noise.Whiten(hob.run, signal)).col(0);
}

int CountFirstOrder(const HobRun& hob, const Analysis& analysis) {
  constexpr double kSame = 1e-3;  // of the power of a signal, beside those taken before
  const double rows = static_cast<double>(hob.run.schedule.Readings());
  std::vector<Eigen::VectorXd> taken;  // orthonormal
  for (const Term& term : analysis.found.terms) {
    if ((term.columns * term.amplitudes).norm() < std::sqrt(rows) * hob.second_order_rad) continue;
    Eigen::VectorXd left = Projected(hob, analysis, term);
    const double power = left.squaredNorm();
    for (const Eigen::VectorXd& other : taken) left -= other.dot(left) * other;
    if (left.squaredNorm() > kSame * power) taken.push_back(left.normalized());
  }
  return static_cast<int>(std::ssize(taken));
}

}  // namespace

int NullRuns(const HobRun& hob, int wanted) {
  constexpr int kFewest = 150;
  constexpr double kRows = 1e6;  // of all simulated runs
  const int affordable = static_cast<int>(kRows / hob.run.Rows());
  return std::min(wanted, std::max(affordable, kFewest));
}

std::vector<Cause> OutlierCauses(const HobRun& hob, const std::vector<std::string>& excluded) {
  if (hob.outliers.readings.empty() || std::ranges::count(excluded, std::string("outliers")) > 0) return {};
  return {OutlierCause(static_cast<double>(hob.outliers.readings.size()), hob.outliers.size_rad,
                       hob.outliers.log_bayes, hob.outliers.of)};
}

Analysis AnalyseToFirstOrder(const HobRun& hob, const std::vector<Family>& families, AnalysisOptions how) {
  Analysis analysis = Analyse(hob.run, families, how);
  const int first_order = CountFirstOrder(hob, analysis);
  if (first_order == std::ssize(analysis.found.terms)) return analysis;
  const NullCalibration null = analysis.null;
  how.null = &null;
  how.most_causes = first_order;
  analysis = Analyse(hob.run, families, how);
  analysis.found.last_statistic = std::min(analysis.found.last_statistic, 0.0);
  if (first_order == 0) analysis.found.first_statistic = std::min(analysis.found.first_statistic, 0.0);
  return analysis;
}

void ToReadings(const HobRun& hob, DiagnosisRun& result) {
  Diagnosis& d = result.diagnosis;
  for (Accepted& accepted : result.accepted) {
    if (accepted.family.kind == Kind::kUnknown) SpreadUnnamed(hob, accepted);
  }
  MergeOutliers(hob, d);
  d.readings = static_cast<int>(hob.context.Samples());
  d.left_out = hob.left_out;
  d.harmonics = HarmonicTable(hob, result.noise);
  const double size = static_cast<double>(hob.context.Samples()) / static_cast<double>(hob.context.groups.Groups());
  if (size > 1.5)
    d.notes.push_back(fmt::format("the search and its gain are over means of {:.0f} neighbouring readings", size));
}

}  // namespace twinbench::diagnose::hob
