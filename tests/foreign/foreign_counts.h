#pragma once

#include <string>
#include <vector>

#include "tests/foreign/answer.h"
#include "tests/hidden/share.h"

/// What sections and tests count of answers.
namespace twinbench::foreign {

using Answers = std::vector<Answer>;
using Condition = bool (*)(const Answer&);

inline constexpr double kSureName = 0.8, kSure = 0.9, kGainTolerance = 0.05;

// Which machine it was.
bool IsAny(const Answer& a);
bool IsClean(const Answer& a);
bool IsFaulty(const Answer& a);
bool HasSeveral(const Answer& a);
bool IsSingleKind(const Answer& a);  // one that the catalogue lacks
bool MayNeverBeWrong(const Answer& a);

// What was answered.
bool IsAlarm(const Answer& a);
bool IsSureAlarm(const Answer& a);
bool IsUnknown(const Answer& a);
bool NamesNear(const Answer& a);
bool IsWrongSurely(const Answer& a);
bool IsWrongVerySurely(const Answer& a);
/// A name that is not there at any probability above one half, or a tie without one that is near.
bool IsNamedWrongly(const Answer& a);
bool SaysAll(const Answer& a);

// What became of the written scenario.
bool WasExtended(const Answer& a);
bool IsSilentThen(const Answer& a);
bool HasGain(const Answer& a);
bool GainHolds(const Answer& a);

/// Of those that it is asked of.
hidden::Share ShareOf(const Answers& answers, Condition of, Condition holds);
int CountOf(const Answers& answers, Condition holds);

/// "wrong and sure, not silent": where an answer is less than what is asked; empty: nowhere.
std::string ShortcomingsOf(const Answer& a);

}  // namespace twinbench::foreign
