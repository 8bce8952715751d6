#pragma once

#include <string>
#include <vector>

#include "twin/core/reading.h"
#include "twin/report/evaluation.h"

/// What may be told of a result: a number that is one, and an uncertainty only of a fit that describes its readings.
namespace twinbench::report {

/// A fit that leaves more than this many of its stated standard uncertainties, rms, does not describe the readings.
constexpr double kMostMisfit = 5.0;

/// A fit that widens its uncertainty by what it leaves (Birge) states that scatter: tables may repeat so many times worse
/// than the instrument's noise, which nobody need state. Beyond this it is no scatter.
constexpr double kMostWidening = 100.0;

/// @param factor  Of the widening, or what the fit leaves over the noise.
inline Misfit WidenedMisfit(const std::string& of, double factor) {
  return {of, factor > kMostWidening ? factor : 1.0};
}

/// Results from this size on, in the units of files, are no measurement: 1e9 um are a kilometre.
constexpr double kAbsurd = 1e9;

/// Whether readings say anything about a number: not where its u is half of what is possible. No bounds, or no u: they do.
inline bool IsDetermined(double u, double lower, double upper) {
  return !(u > 0.5 * (upper - lower));
}

/// Text for people: the units of columns and keys as they are written in print, "um" as "µm", and a true minus before numbers.
std::string InPrint(const std::string& text);

/// The text with `absent` in the place of every nan, inf and absurd number, and of a value whose uncertainty is one.
/// @param absent  Empty: the text is a file's, and its units stay as they are. Else the text is for people (InPrint).
std::string WithoutNoNumbers(const std::string& text, const std::string& absent = "-");

/// Nulls in the place of every nan, inf and absurd number, and of a value whose uncertainty is one; counts may be large.
/// @return how many there were.
int ClearNoNumbers(nlohmann::json& results);

/// Takes from an evaluation what is no result: numbers that are none become null in JSON and `-` in text, with one
/// line that says why; a fit beyond kMostMisfit, and one that determines nothing, loses its separation and every `u`, and
/// `not_separated` says so.
/// @param readings  Behind the evaluation.
void KeepSound(const std::vector<Reading>& readings, Evaluation& evaluation);

/// In the words of a refusal's "expected": what it would take for readings that come to nothing (Evaluation::IsRefuted) to come to something.
std::string WhatItWouldTake(const Evaluation& evaluation);

}  // namespace twinbench::report
