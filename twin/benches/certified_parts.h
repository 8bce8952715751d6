#pragma once

#include <string>

#include "twin/report/certificate/certified.h"

namespace twinbench::benches {

/// How a bench measures, and what of its results.json is a result of a calibration.
/// @param where  For the message.
/// @throws InputError for a bench whose results nobody has said this of.
const certificate::CertifiedBench& CertifiedPartsOf(const std::string& bench, const std::string& where);

}  // namespace twinbench::benches
