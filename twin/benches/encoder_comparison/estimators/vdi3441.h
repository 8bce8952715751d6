#pragma once

#include <array>
#include <string>
#include <vector>

#include "twin/benches/encoder_comparison/estimators/iso230_2.h"

/// How well an axis positions, in the terms of VDI/DGQ 3441:1977, which ISO 230-2 has replaced and which is still asked for. Units as in
/// iso230_2.h. The formulas are those in common use; the text of the guideline was not at hand.
namespace twinbench::measure {

/// What the guideline states of an axis, of targets i with the mean m_i of both sides, the standard deviation s_i as mean of those of
/// both sides and the reversal U_i = |forward - backward|:
///   positional uncertainty  P = max(m_i + (U_i + Ps_i) / 2) - min(m_i - (U_i + Ps_i) / 2)
///   positional scatter      Ps = max Ps_i, Ps_i = 6 s_i, and its mean
///   positional deviation    Pa = max m_i - min m_i
///   reversal                U = max U_i, and its mean
enum class VdiValue { kP, kPs, kMeanPs, kPa, kU, kMeanU };
inline constexpr int kVdiValues = 6;
inline constexpr std::array<const char*, kVdiValues> kVdiValueNames = {"P", "Ps", "mean Ps", "Pa", "U", "mean U"};

struct VdiPositioning {
  std::array<ScatteredValue, kVdiValues> axis;

  const ScatteredValue& operator[](VdiValue value) const { return axis[static_cast<std::size_t>(value)]; }
};

/// The same runs after VDI/DGQ 3441.
/// @param targets  As EvaluatePositioning has summarised them.
/// @return NaN what needs a direction that some target lacks, or two runs where some target has one.
///
/// Uncertainty: as EvaluatePositioning, with what it leaves out.
VdiPositioning EvaluateVdi3441(const std::vector<TargetPositioning>& targets, const PositioningBootstrap& bootstrap = {});

/// The values of the axis in one line; "-" is not available.
std::string VdiText(const VdiPositioning& positioning, const ToldIn& told = {});

}  // namespace twinbench::measure
