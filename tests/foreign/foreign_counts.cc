#include "tests/foreign/foreign_counts.h"

#include <fmt/format.h>

#include <cmath>

namespace twinbench::foreign {

bool IsAny(const Answer&) {
  return true;
}

bool IsClean(const Answer& a) {
  return a.truth.IsClean();
}

bool IsFaulty(const Answer& a) {
  return !a.truth.IsClean();
}

bool HasSeveral(const Answer& a) {
  return std::ssize(a.truth.listed) + a.truth.unlisted > 1;
}

bool IsSingleKind(const Answer& a) {
  return a.truth.unlisted == 1 && a.truth.listed.empty();
}

bool MayNeverBeWrong(const Answer& a) {
  return a.truth.never_wrong;
}

bool IsAlarm(const Answer& a) {
  return a.alarm;
}

bool IsSureAlarm(const Answer& a) {
  return a.alarm && a.outcome.probability >= kSure;
}

bool IsUnknown(const Answer& a) {
  return a.outcome.verdict == diagnose::Verdict::kUnknown;
}

bool NamesNear(const Answer& a) {
  return a.named_near;
}

bool IsWrongSurely(const Answer& a) {
  return IsWrongAt(a, kSureName);
}

bool IsWrongVerySurely(const Answer& a) {
  return IsWrongAt(a, kSure);
}

bool IsNamedWrongly(const Answer& a) {
  constexpr double kMoreLikelyThanNot = 0.5;
  if (a.wrong.empty()) return false;
  return a.outcome.verdict == diagnose::Verdict::kTie ? !a.named_near : a.wrong_at >= kMoreLikelyThanNot;
}

bool SaysAll(const Answer& a) {
  return a.missing == 0;
}

bool WasExtended(const Answer& a) {
  return a.was_extended;
}

bool IsSilentThen(const Answer& a) {
  return a.was_extended && a.second.empty();
}

bool HasGain(const Answer& a) {
  return std::isfinite(a.file_gain) && std::isfinite(a.stated_gain);
}

bool GainHolds(const Answer& a) {
  return std::abs(a.stated_gain - a.file_gain) <= kGainTolerance;
}

hidden::Share ShareOf(const Answers& answers, Condition of, Condition holds) {
  hidden::Share share;
  for (const Answer& a : answers) {
    share.of += of(a) ? 1 : 0;
    share.count += of(a) && holds(a) ? 1 : 0;
  }
  return share;
}

int CountOf(const Answers& answers, Condition holds) {
  return ShareOf(answers, IsAny, holds).count;
}

std::string ShortcomingsOf(const Answer& a) {
  std::string text;
  const auto add = [&](bool is, const std::string& what) { text += is ? (text.empty() ? "" : ", ") + what : ""; };
  add(IsClean(a) && IsAlarm(a), "alarm");
  add(IsFaulty(a) && IsWrongSurely(a), "wrong and sure");
  add(MayNeverBeWrong(a) && IsNamedWrongly(a), "may never be named so");
  add(HasSeveral(a) && !SaysAll(a), fmt::format("{} not said", a.missing));
  add(WasExtended(a) && !IsSilentThen(a), "not silent");
  add(HasGain(a) && !GainHolds(a), "gain");
  return text;
}

}  // namespace twinbench::foreign
