#pragma once

#include "twin/benches/encoder_comparison/diagnosis/twin_fit.h"

namespace twinbench::diagnose::encoder {

/// Causes that are one to first order are not when they are large, or beside large ones. Which of them is in the twin
/// is settled with all causes there: what one lacks would be taken for another cause before. Plain waves are, unless
/// another member leaves less or makes a cause needless.
/// @param now  All causes; those that no longer tie are taken out of their ties.
/// @return true if others lead than before.
bool SettleTies(const TwinFit& fit, FittedCauses& now);

}  // namespace twinbench::diagnose::encoder
