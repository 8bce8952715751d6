#include "tests/foreign/answer.h"

#include <algorithm>

namespace twinbench::foreign {
namespace {

using diagnose::Cause;
using diagnose::Diagnosis;
using diagnose::Verdict;

bool IsNamed(const std::string& effect, const std::string& where, const std::string& name) {
  return name == effect || name == effect + " " + where;
}
bool IsAmong(const std::string& effect, const std::string& where, const Names& names) {
  return std::ranges::any_of(names, [&](const std::string& name) { return IsNamed(effect, where, name); });
}

/// That nothing tells from a cause that is there counts: an answer that is surer than that is a matter of the
/// calibration.
bool IsHonest(const Cause& cause, const Truth& truth) {
  return IsAmong(cause.effect, cause.where, truth.honest) ||
         std::ranges::any_of(truth.listed,
                             [&](const Names& names) { return IsAmong(cause.effect, cause.where, names); });
}

bool IsThere(const Cause& cause, const Truth& truth) {
  return IsAmong(cause.effect, cause.where, truth.honest) ||
         std::ranges::any_of(truth.listed,
                             [&](const Names& names) { return IsNamed(cause.effect, cause.where, names.front()); });
}

bool Speaks(const Diagnosis& d, const Names& names) {
  return std::ranges::any_of(d.causes, [&](const Cause& cause) {
    return IsAmong(cause.effect, cause.where, names) ||
           std::ranges::any_of(cause.indistinguishable_from,
                               [&](const diagnose::Rival& r) { return IsAmong(r.effect, r.where, names); });
  });
}

/// Parts of the signature of what has no name.
int UnknownParts(const Diagnosis& d) {
  const std::string& signature = d.unknown.signature;
  if (signature.empty()) return 0;
  int parts = 1;
  for (std::size_t at = signature.find(" | "); at != std::string::npos; at = signature.find(" | ", at + 1)) ++parts;
  return parts;
}

/// What is not found must be said to be there: one unknown part for each. A name that is near stands for a cause
/// that the catalogue lacks.
int MissingIn(const Diagnosis& d, const Truth& truth) {
  if (d.verdict == Verdict::kNone) return static_cast<int>(std::ssize(truth.listed)) + truth.unlisted;
  int missing = Speaks(d, truth.honest) ? std::max(0, truth.unlisted - 1) : truth.unlisted;
  for (const Names& names : truth.listed) missing += Speaks(d, names) ? 0 : 1;
  return std::max(0, missing - UnknownParts(d));
}

std::vector<hidden::Stated> StatedOf(const Diagnosis& d, const Truth& truth) {
  std::vector<hidden::Stated> stated;
  if (d.verdict == Verdict::kUnknown) stated.push_back({d.unknown.probability, truth.unlisted > 0});
  if (d.verdict != Verdict::kNamed && d.verdict != Verdict::kTie) return stated;
  for (const Cause& cause : d.causes) stated.push_back({cause.probability, IsThere(cause, truth)});
  return stated;
}

void FindWrong(const Diagnosis& d, const Truth& truth, Answer& answer) {
  if (d.verdict != Verdict::kNamed && d.verdict != Verdict::kTie) return;
  for (const Cause& cause : d.causes) {
    answer.named_near = answer.named_near || IsHonest(cause, truth);
    if (IsHonest(cause, truth) || cause.probability <= answer.wrong_at) continue;
    answer.wrong = cause.effect + (cause.where.empty() ? "" : " " + cause.where);
    answer.wrong_at = cause.probability;
  }
}

}  // namespace

Answer Judge(const Truth& truth, const Diagnosis& diagnosis) {
  hidden::Hidden hidden;
  for (const Names& names : truth.listed) hidden.causes.push_back({names.front(), "", {}});
  if (truth.unlisted > 0) hidden.unlisted = truth.kind;
  Answer answer;
  answer.truth = truth;
  answer.outcome = hidden::Judge(hidden, diagnosis);
  answer.outcome.stated = StatedOf(diagnosis, truth);
  answer.alarm = diagnosis.verdict != Verdict::kNone;
  FindWrong(diagnosis, truth, answer);
  answer.missing = MissingIn(diagnosis, truth);
  const diagnose::Gain& gain = diagnosis.gain;
  answer.stated_gain = gain.another_run;
  answer.stated_interval = gain.interval95;
  if (gain.another_run != gain.fraction_removed) answer.stated_interval = {gain.another_run, gain.another_run};
  return answer;
}

}  // namespace twinbench::foreign
