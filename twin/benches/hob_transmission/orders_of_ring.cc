#include "twin/benches/hob_transmission/told_orders.h"

#include <fmt/format.h>

#include <algorithm>

namespace twinbench::benches::hob {
namespace {

/// Times per turn of the hob; 0: the cause is none of the hob's ring, or has rivals that say so already.
int TimesPerTurn(const diagnose::Cause& cause) {
  if (cause.where != "hob" || !cause.indistinguishable_from.empty()) return 0;
  if (cause.effect == "ellipticity") return 2;
  const auto order = std::ranges::find(cause.parameters, "order", &diagnose::ParameterEstimate::name);
  return cause.effect == "periodic" && order != cause.parameters.end() ? static_cast<int>(order->value) : 0;
}

}  // namespace

void TellGearsBesideRing(diagnose::Diagnosis& diagnosis) {
  for (const diagnose::Cause& cause : diagnosis.causes) {
    const int times = TimesPerTurn(cause);
    if (times == 0) continue;
    diagnosis.notes.push_back(
        fmt::format("{} at hob may as well be gears that err {} times per turn of the hob (a harmonic drive errs twice): two encoders do not distinguish "
                    "them; the interferometer, or a second reading head on the hob's encoder, does",
                    cause.effect, times));
  }
}

}  // namespace twinbench::benches::hob
