#pragma once

#include <string>
#include <vector>

#include "twin/core/bench_format.h"
#include "twin/core/scenario.h"

/// Structure that no effect of the catalogue has, as a product: what enters at a channel of the bench, times its
/// course. An [[effect]] block with name = "signal", `point`, `signal`, what it goes `by` and what its size follows
/// (`times`).
namespace twinbench {

inline constexpr const char* kSignalEffect = "signal";

/// "constant", "harmonic", "interaction", "tone", "step", "fringes", "power", "share".
std::vector<std::string> SignalKinds();
/// What the size of a signal may follow: "direction", "velocity", "speed", "time", "temperature".
std::vector<std::string> SignalFactors();

/// What a signal of this kind may go by: angles of the bench, channels, or nothing.
std::vector<std::string> SignalArguments(const std::string& kind, const BenchFormat& bench);

/// The parameters of a kind: sizes in um where channels read positions, in arcsec where they read angles, else in
/// the unit of the channel's column.
/// @param times  Empty: its size follows nothing.
EffectEntry SignalEntry(const std::string& kind, const std::string& times, const BenchFormat& bench);

/// The list of values that an [[empirical]] signal has on a bench whose channels read this.
std::vector<double>& ValuesOf(EmpiricalSettings& empirical, SignalKind kind);

/// Of any effect of a scenario.
/// @throws std::logic_error if the catalogue has no such effect.
EffectEntry EntryOf(const EffectSettings& effect, const std::string& bench);

}  // namespace twinbench
