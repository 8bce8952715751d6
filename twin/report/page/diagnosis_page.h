#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "twin/report/page/figure.h"

namespace twinbench::report {

/// One sentence: what was found, and how sure that is.
struct PageVerdict {
  std::string text;
  VerdictTone tone = VerdictTone::kPlain;
};
PageVerdict VerdictOf(const nlohmann::json& diagnosis);

/// What a diagnosis says.
/// @param diagnosis  diagnosis.json, or `diagnosis` of results.json, which has the residuals and the remarks too.
/// @return causes with probabilities and doubles, residuals before and after the extension, gain, detectability.
std::vector<PageSection> DiagnosisSections(const nlohmann::json& diagnosis);

}  // namespace twinbench::report
