#pragma once

#include <string>
#include <vector>

#include "twin/diagnose/diagnose.h"
#include "twin/diagnose/screen/screen.h"
#include "twin/diagnose/shown.h"
#include "twin/report/curve_text.h"

namespace twinbench::report {

/// What there is to be told of one diagnosis.
struct DiagnosisPage {
  const diagnose::DiagnosisRun& found;
  const diagnose::Shown& shown;
  std::string source;                             // the file or folder
  std::vector<diagnose::ResidualTest> residual_tests = {};  // of a run's folder
};

struct PageStyle {
  Letters letters = Letters::kAscii;
  bool verbose = false;
};

/// The diagnosis in the order in which a metrologist reads it: a line with the verdict; a table of causes - one
/// that stands for several that these readings cannot tell apart follows them with "or" -; what to measure next;
/// the significant harmonics; the error curve forward and backward; what the model gains; what limits the answer.
/// The rest - chance, all harmonics, what would have been seen and what cannot be, noise, residual tests - follows
/// if the style is verbose; else a line names it.
///
/// Plain text without escape codes. No line but the verdict's, which has up to 98 letters, is wider than 80.
std::string DiagnosisText(const DiagnosisPage& page, const PageStyle& style);

}  // namespace twinbench::report
