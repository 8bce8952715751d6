#include "twin/benches/encoder_comparison/diagnosis/signal_block.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/encoder_comparison/format.h"
#include "twin/diagnose/engine/candidates.h"
#include "twin/diagnose/extend.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose::encoder {
namespace {

/// How well a guess is known: it is where the twin begins to be asked.
constexpr double kFault = 0.01, kLevel = 0.01, kPhase_rad = 0.03;

/// A cause and what is the same to first order.
LargeCause Guessed(const std::string& effect, const std::vector<ParameterEstimate>& parameters,
                   const std::vector<std::string>& doubles, const std::string& bench) {
  LargeCause cause;
  cause.causes.emplace_back();
  cause.causes.front().effect = effect;
  cause.causes.front().parameters = parameters;
  for (const std::string& name : doubles) cause.causes.emplace_back().effect = name;
  for (Cause& c : cause.causes) c.probability = tuning::kListed / static_cast<double>(cause.causes.size());
  cause.effect = EffectOf(cause.causes.front(), bench, "");
  return cause;
}

}  // namespace

std::vector<LargeCause> SignalBlock(const SignalGuess& guess, const EncoderRun& encoder,
                                    const std::vector<std::string>& excluded) {
  const Catalogue words(benches::encoder::Format().effects);
  const SignalContext& c = encoder.context;
  const std::string& bench = encoder.run.bench;
  std::vector<ParameterEstimate> clipping = {
      words.Estimate("signal_clipping", "level", guess.faults.level, kLevel)};
  if (!c.device.signal_zero_known)
    clipping.push_back(
        words.Estimate("signal_clipping", "zero", guess.zero_rad, kPhase_rad / c.device.signal_periods));
  const bool is_turn = c.device.signal_periods == 1;  // else a screw of that order is the double
  const auto doubles = [is_turn](const char* name) {
    return is_turn ? std::vector<std::string>{name} : std::vector<std::string>{};
  };
  std::vector<LargeCause> block = {
      Guessed("signal_clipping", clipping, {}, bench),
      Guessed("signal_offset",
              {words.Estimate("signal_offset", "offset_sin", guess.faults.offset_sin, kFault),
               words.Estimate("signal_offset", "offset_cos", guess.faults.offset_cos, kFault)},
              doubles("eccentricity"), bench),
      Guessed("amplitude_mismatch", {words.Estimate("amplitude_mismatch", "ratio", guess.faults.ratio, kFault)},
              doubles("ellipticity"), bench),
      Guessed("quadrature_error",
              {words.Estimate("quadrature_error", "angle", guess.faults.quadrature_rad, kFault)},
              doubles("ellipticity"), bench)};
  if (c.Moves()) {
    const double as_far_s = kPhase_rad / c.device.signal_periods / c.velocity_rad_s.cwiseAbs().maxCoeff();
    block.push_back(Guessed("latency", {words.Estimate("latency", "delay", guess.delay_s, as_far_s)}, {}, bench));
  }
  std::erase_if(block, [&](const LargeCause& cause) {
    return std::ranges::count(excluded, cause.causes.front().effect) > 0;
  });
  return block;
}

std::vector<ParameterEstimate> LagNumbers(const LagGuess& guess) {
  constexpr double kFine = 0.02;
  const Catalogue words(benches::encoder::Format().effects);
  const auto told = [&](const char* name, double value_s) {
    return words.Estimate("latency", name, value_s, value_s > 0.0 ? kFine * value_s : kNaN);
  };
  if (guess.lag_s == 0.0) return {told("delay", guess.delay_s)};
  if (guess.delay_s == 0.0) return {told("time_constant", guess.lag_s), told("delay", 0.0)};
  return {told("delay", guess.delay_s), told("time_constant", guess.lag_s)};
}

std::vector<LargeCause> LagBlock(const LagGuess& guess, const EncoderRun& encoder) {
  constexpr double kFine = 0.02;  // of the gain
  const Catalogue words(benches::encoder::Format().effects);
  const std::string& bench = encoder.run.bench;
  std::vector<LargeCause> block = {Guessed("latency", LagNumbers(guess), {}, bench),
                                   Guessed("scale", {words.Estimate("scale", "ratio", guess.gain - 1.0, kFine)}, {}, bench)};
  const auto add = [&](const char* effect, const char* parameter, double size) {
    if (size != 0.0) block.push_back(Guessed(effect, {words.Estimate(effect, parameter, size, kFine * std::abs(size))}, {}, bench));
  };
  add("acceleration_error", "coefficient", guess.per_acceleration_s2);
  add("friction", "lag", guess.friction_rad);
  return block;
}

}  // namespace twinbench::diagnose::encoder
