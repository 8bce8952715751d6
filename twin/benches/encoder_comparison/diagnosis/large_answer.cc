#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "twin/benches/encoder_comparison/diagnosis/large_causes.h"
#include "twin/benches/encoder_comparison/diagnosis/wander.h"
#include "twin/diagnose/engine/answer.h"
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
  if (const std::optional<double> order = WaveOrderOf(cause.effect))
    accepted.shape = Eigen::VectorXd::Constant(1, *order);
  return accepted;
}

/// What has no name beside the large causes, as it is fitted with them, each without what an offset takes of it. Beside free
/// sizes a shape may be larger than all that there is to explain, and they smaller by as much, a walk most easily: it is no more
/// than they leave.
std::vector<Eigen::VectorXd> UnnamedOf(const LargeCauses& large) {
  const Searched& last = large.Last();
  const Eigen::VectorXd all = last.encoder.BesideSetUps(large.first->encoder.run.residual);
  Eigen::VectorXd left = all;
  for (const LargeCause& cause : large.causes) left -= last.encoder.BesideSetUps(cause.shown);
  std::vector<Eigen::VectorXd> unnamed;
  for (const Term& term : last.analysis.found.terms) {
    const Family& family = last.families[static_cast<std::size_t>(term.family)];
    if (family.kind != Kind::kUnknown) continue;
    const Eigen::VectorXd shown = last.encoder.BesideSetUps(term.columns * term.amplitudes);
    const Eigen::VectorXd& most = FollowsWalk(family, term.columns) ? left : all;
    unnamed.push_back(shown.squaredNorm() > most.squaredNorm() ? left : shown);
  }
  return unnamed;
}

double PowerOf(const std::vector<Eigen::VectorXd>& shown) {
  double power = 0.0;
  for (const Eigen::VectorXd& rows : shown) power += rows.squaredNorm();
  return power;
}

/// How sure a size is that it is one, beside all else and with the memory that the rest has; an onset may have been at
/// any reading.
double ChanceOf(const LargeCause& cause, double readings) {
  const bool is_event = cause.effect.parameters.contains("at_reading");
  return ChanceOfSize(Deviations(cause.effect), (is_event ? 1.0 : 0.5) * std::log(readings));
}

/// What has no name beside the large causes is said; it makes an unknown of the whole only if it explains more than
/// they do. A cause that is like it, or as small as what it leaves, may then be no more than a piece of it: it is as
/// sure as it is large beside it.
void WeighTheRest(const LargeCauses& large, Diagnosis& d, std::vector<Cause>& causes) {
  if (d.verdict != Verdict::kUnknown) return;
  const std::vector<Eigen::VectorXd> shapes = UnnamedOf(large);
  const double unnamed = PowerOf(shapes);
  double named = 0.0;
  for (const LargeCause& cause : large.causes)
    named += large.first->encoder.BesideSetUps(cause.shown).squaredNorm();
  if (unnamed <= named) {
    d.verdict = Verdict::kNamed;
    return;
  }
  auto at = causes.begin();
  for (const LargeCause& cause : large.causes) {
    const Eigen::VectorXd shown = large.first->encoder.BesideSetUps(cause.shown);
    const bool may_be_piece =
        shown.squaredNorm() < tuning::kSmallRest * unnamed ||
        std::ranges::any_of(shapes, [&](const Eigen::VectorXd& shape) { return Likeness(shown, shape) > kAlike; });
    const double share = may_be_piece ? shown.squaredNorm() / (shown.squaredNorm() + unnamed) : 1.0;
    for (std::size_t k = 0; k < cause.causes.size(); ++k, ++at) at->probability *= share;
  }
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
    for (auto member = causes.end() - std::ssize(cause.causes); member != causes.end(); ++member)
      member->probability *= ChanceOf(cause, large.first->encoder.run.Rows());
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
