#pragma once

#include <string>

#include "twin/diagnose/diagnose.h"

namespace twinbench::diagnose {

/// The diagnosis in plain words: what was found and how sure that is, what else it could be, what to measure next,
/// what the extended model gains, and what this run cannot see. A few sentences, wrapped at 100 letters.
std::string InWords(const DiagnosisRun& run);

/// The words of `text` in lines of at most 100 letters.
std::string Wrapped(const std::string& text);

/// "0.0031 +- 0.0002 mrad": as many digits as the uncertainty has meaning.
std::string WithUncertainty(const ParameterEstimate& parameter);

}  // namespace twinbench::diagnose
