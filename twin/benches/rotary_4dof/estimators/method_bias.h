#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "twin/benches/rotary_4dof/estimators/separate.h"

/// What the published equations do to the errors of the tables beyond the noise of the readings: their result
/// against the rigorous one from the same readings. The published uncertainty propagates noise only, and is wrong
/// by that.
namespace twinbench::separate {

enum class MethodStatus {
  kWithinNoise,    // the difference is what noise makes of it
  kBiased,         // more than twice that: the equations do not describe this bench
  kNotDetermined,  // no combination of the readings determines it, although the equations give numbers
};

/// Of one error motion of one table, about the positions that both have [rad or m].
struct ComponentBias {
  Table table = Table::kTarget;
  Component component = Component::kEz;
  double rms = kNaN;
  double u_noise = kNaN;  // expected of the difference, both results taken as independent: rather too large
  MethodStatus status = MethodStatus::kNotDetermined;
};
using MethodBias = std::vector<ComponentBias>;

/// Compares both results without what the design cannot separate, and makes the published one honest: its losses
/// become those of the design, its uncertainty gains the rms difference (cov_systematic; no uncertainty where
/// nothing is determined), and its notes name every component that is biased.
MethodBias ApplyMethodBias(const Separation& rigorous, Separation& published);

/// {"target": {"ez_arcsec": {"rms", "u_noise", "status"}, ...}, "reference": ...}
nlohmann::json ToJson(const MethodBias& bias);

}  // namespace twinbench::separate
