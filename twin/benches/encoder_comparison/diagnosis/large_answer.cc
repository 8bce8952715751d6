#include <fmt/format.h>

#include <algorithm>

#include "twin/benches/encoder_comparison/diagnosis/large_causes.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose::encoder {
namespace {

Accepted AcceptedOf(const LargeCause& cause) {
  Accepted accepted;
  accepted.family.effect = cause.effect.name;
  accepted.family.where = cause.effect.where;
  accepted.family.amplitudes = {{"strength", "1", 1.0, 1.0}};
  accepted.amplitudes = Eigen::VectorXd::Ones(1);
  accepted.columns = cause.shown;
  return accepted;
}

/// Power of what has no name beside the large causes, in units of the noise that was thought of at first.
double UnnamedOf(const LargeCauses& large) {
  const Searched& last = large.Last();
  double unnamed = 0.0;
  for (const Term& term : last.analysis.found.terms) {
    const Family& family = last.families[static_cast<std::size_t>(term.family)];
    if (family.kind == Kind::kUnknown) unnamed += term.explained;
  }
  const double sigma = last.encoder.run.sigma.mean() / large.first->encoder.run.sigma.mean();
  return unnamed * sigma * sigma;
}

/// What has no name beside the large causes is said; it makes an unknown of the whole only if it is no small part.
/// A cause may be no more than a piece of it: it is as sure as it is large beside it.
void WeighTheRest(const LargeCauses& large, Diagnosis& d, std::vector<Cause>& causes) {
  if (d.verdict != Verdict::kUnknown) return;
  const double unnamed = UnnamedOf(large);
  double all = unnamed;
  for (const LargeCause& cause : large.causes) all += cause.explained;
  auto at = causes.begin();
  for (const LargeCause& cause : large.causes) {
    for (std::size_t k = 0; k < cause.causes.size(); ++k, ++at)
      at->probability *= cause.explained / (cause.explained + unnamed);
  }
  if (unnamed > tuning::kSmallRest * all) return;
  d.notes.push_back(fmt::format("beside these, significant but small: {}", d.unknown.signature));
  d.verdict = Verdict::kNamed;
}

}  // namespace

void AddLargeCauses(const LargeCauses& large, DiagnosisRun& result) {
  if (large.causes.empty()) return;
  Diagnosis& d = result.diagnosis;
  if (d.verdict == Verdict::kNone) d.verdict = Verdict::kNamed;
  std::vector<Cause> causes;
  std::vector<Accepted> accepted;
  for (const LargeCause& cause : large.causes) {
    causes.insert(causes.end(), cause.causes.begin(), cause.causes.end());
    accepted.push_back(AcceptedOf(cause));
  }
  WeighTheRest(large, d, causes);
  const bool is_tie = std::ranges::any_of(large.causes, [](const LargeCause& c) { return c.causes.size() > 1; });
  if (is_tie && d.verdict == Verdict::kNamed) d.verdict = Verdict::kTie;
  d.causes.insert(d.causes.begin(), causes.begin(), causes.end());
  d.alarm_p = result.structure_p = large.first->analysis.null.PValue(large.first->analysis.found.first_statistic);
  result.accepted.insert(result.accepted.begin(), accepted.begin(), accepted.end());
  result.run = large.first->encoder.run;
  result.run.sigma = large.Last().encoder.run.sigma;
}

}  // namespace twinbench::diagnose::encoder
