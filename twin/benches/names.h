#pragma once

/// What the benches are called in files. Only this folder, scenarios and tests know these names; everything else is
/// told one by its scenario or its record.
namespace twinbench {

inline constexpr const char* kRotaryBench = "rotary_4dof";
inline constexpr const char* kEncoderBench = "encoder_comparison";
inline constexpr const char* kTurntableBench = "turntable_autocollimator";
inline constexpr const char* kHobBench = "hob_transmission";
inline constexpr const char* kCircularBench = "circular_motion";
inline constexpr const char* kFreeformBench = "freeform_five_axis";

}  // namespace twinbench
