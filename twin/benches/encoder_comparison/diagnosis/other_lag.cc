#include "twin/benches/encoder_comparison/diagnosis/told.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "twin/benches/encoder_comparison/diagnosis/lag_guess.h"

namespace twinbench::diagnose::encoder {

void TellOtherLag(const LargeCauses& large, Diagnosis& diagnosis) {
  const EncoderRun& encoder = large.first->encoder;
  const auto latency = std::ranges::find(large.causes, "latency", [](const LargeCause& cause) { return cause.effect.name; });
  if (latency == large.causes.end() || !encoder.context.has_clock || !encoder.context.Moves()) return;
  const double delay_s = latency->effect.parameters.at("delay"), lag_s = latency->effect.parameters.at("time_constant");
  if ((delay_s > 0.0) == (lag_s > 0.0)) return;
  Eigen::VectorXd shown_rad = encoder.context.reference_rad + encoder.run.residual;
  for (const LargeCause& cause : large.causes) {
    const bool is_gain = cause.effect.name == "scale";  // free beside the lag
    if (&cause != &*latency && !is_gain) shown_rad -= cause.shown;
  }
  const std::optional<OtherLag> other = OtherLagOf(encoder, shown_rad, delay_s > 0.0);
  if (!other || other->is_told_apart) return;
  diagnosis.notes.push_back(
      delay_s > 0.0 ? fmt::format("latency: a lag of first order of {:.3g} s instead of the delay leaves nearly as much", other->guess.lag_s)
                    : fmt::format("latency: a delay of {:.3g} s instead of the lag of first order leaves nearly as much", other->guess.delay_s));
}

}  // namespace twinbench::diagnose::encoder
