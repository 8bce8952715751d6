#pragma once

#include "twin/benches/encoder_comparison/diagnosis/large_causes.h"

namespace twinbench::diagnose::encoder {

/// Of a latency: whether a lag of first order would leave nearly as much as the delay, or a delay as the lag. It is one
/// cause either way.
void TellOtherLag(const LargeCauses& large, Diagnosis& diagnosis);

}  // namespace twinbench::diagnose::encoder
