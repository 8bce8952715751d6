#include <algorithm>
#include <cmath>

#include "tests/foreign/angle_fault.h"

// Faults of angle devices that are locked to time or temperature.
namespace twinbench::foreign {
namespace {

double Rest(double t_s, double over_s) {
  return std::exp(-t_s / over_s);
}

AngleFault WarmUp(Dice& dice, const Track& example) {
  const double over_s = Duration_s(example) * dice.Between(0.06, 0.35);
  return Linear(Unlisted({"drift"}), [=](const Instant& at) { return Rest(at.t_s, over_s); });
}

/// A part that heats quickly and one that follows bend against each other.
AngleFault ThermalBend(Dice& dice, const Track& example) {
  const double quick_s = Duration_s(example) * dice.Between(0.03, 0.08), slow_s = quick_s * dice.Between(5.0, 10.0);
  return Linear(Unlisted({"drift"}),
                [=](const Instant& at) { return Rest(at.t_s, slow_s) - Rest(at.t_s, quick_s); });
}

/// Somebody leans on it for a while: it goes aside within seconds, comes back slowly, and all is as before.
AngleFault Touch(Dice& dice, const Track& example) {
  const double duration_s = Duration_s(example), from_s = duration_s * dice.Between(0.15, 0.8);
  const double over_s = duration_s * dice.Between(0.006, 0.03), sign = dice.Sign();
  Truth truth = Unlisted({"outliers"});
  truth.repeats = false;
  return Linear(truth, [=](const Instant& at) {
    const double x = (at.t_s - from_s) / over_s;
    return x <= 0.0 ? 0.0 : sign * x * std::exp(1.0 - x);
  });
}

AngleFault DriftThenRest(Dice& dice, const Track& example) {
  const double until_s = Duration_s(example) * dice.Between(0.25, 0.7);
  return Linear(Unlisted({"drift"}), [=](const Instant& at) { return std::min(at.t_s, until_s) / until_s; });
}

AngleFault Beat(Dice& dice, const Track& example) {
  const double first_Hz = dice.Between(15.0, 40.0) / Duration_s(example);
  const double second_Hz = first_Hz + dice.Between(1.5, 4.0) / Duration_s(example);
  const double first = dice.Phase(), second = dice.Phase();
  return Linear(Unlisted(), [=](const Instant& at) {
    return std::cos(2.0 * M_PI * first_Hz * at.t_s + first) + std::cos(2.0 * M_PI * second_Hz * at.t_s + second);
  });
}

AngleFault Chirp(Dice& dice, const Track& example) {
  const double duration_s = Duration_s(example), cycles = dice.Between(12.0, 30.0), phase = dice.Phase();
  return Linear(Unlisted(), [=](const Instant& at) {
    const double x = at.t_s / duration_s;
    return std::cos(2.0 * M_PI * cycles * (0.3 * x + 0.7 * x * x) + phase);
  });
}

AngleFault TemperatureSquared(Dice& dice, const Track& example) {
  double mean_degC = 0.0;
  for (const Instant& at : example) mean_degC += at.temperature_degC / static_cast<double>(example.size());
  const double about_degC = mean_degC + dice.Between(-0.1, 0.1);
  return Linear(Unlisted({"drift"}), [=](const Instant& at) {
    const double x_K = at.temperature_degC - about_degC;
    return x_K * x_K;
  });
}

/// A body that follows the room with a lag turns with its temperature.
AngleFault LaggedTemperature(Dice& dice, const Track& example) {
  const double lag_s = Duration_s(example) * dice.Between(0.05, 0.2);
  return {Listed({"zero_temperature"}), [lag_s](const Track& track, double size) {
            double body_degC = track.front().temperature_degC, last_s = track.front().t_s;
            return Along(track, [&](const Instant& at) {
              const double keep = Rest(at.t_s - last_s, lag_s);
              body_degC = keep * body_degC + (1.0 - keep) * at.temperature_degC;
              last_s = at.t_s;
              return size * (body_degC - 20.0);
            });
          }};
}

/// The scale's gain takes another value twice.
AngleFault GainSteps(Dice& dice, const Track& example) {
  const double duration_s = Duration_s(example), first_s = duration_s * dice.Between(0.2, 0.45);
  const double second_s = duration_s * dice.Between(0.55, 0.85), back = dice.Between(0.2, 0.7);
  return Linear(Unlisted({"scale"}), [=](const Instant& at) {
    return (at.t_s < first_s ? 0.0 : at.t_s < second_s ? 1.0 : back) * at.angle_deg;
  });
}

}  // namespace

std::vector<AngleKind> TimeKinds() {
  return {
      {"warm-up", Where::kBoth, WarmUp}, {"thermal bend", Where::kBoth, ThermalBend},
      {"touch", Where::kBoth, Touch}, {"drift then rest", Where::kBoth, DriftThenRest},
      {"beat of two tones", Where::kBoth, Beat}, {"chirp", Where::kBoth, Chirp},
      {"temperature squared", Where::kStops, TemperatureSquared},
      {"lagged temperature", Where::kStops, LaggedTemperature}, {"gain steps", Where::kBoth, GainSteps}};
}

}  // namespace twinbench::foreign
