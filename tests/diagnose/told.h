#pragma once

#include <string>

#include "twin/report/diagnosis_text.h"

namespace twinbench::diagnose::test {

/// All that a diagnosis says, for the message of a test that fails.
inline std::string Told(const DiagnosisRun& found) {
  return report::DiagnosisText({found, ShownBy(found), "the readings"}, {report::Letters::kAscii, true});
}

}  // namespace twinbench::diagnose::test
