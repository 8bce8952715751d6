#include <cmath>

#include "tests/foreign/angle_fault.h"

// Disturbances of angle devices that are random themselves.
namespace twinbench::foreign {
namespace {

/// Random, and another in every run: the dice go on.
AngleFault Random(Truth truth, Dice& dice, std::function<Eigen::VectorXd(const Track& track, Dice& noise)> unit) {
  truth.repeats = false;
  const auto seed = static_cast<std::uint64_t>(dice.Whole(1, 1 << 30));
  return {std::move(truth), [seed, unit = std::move(unit)](const Track& track, double size) {
            Dice noise(seed, "random fault");
            return Eigen::VectorXd(size * unit(track, noise));
          }};
}

AngleFault NoiseOfSpeed(Dice& dice, const Track&) {
  Truth truth = Unlisted({"outliers"});
  truth.only_noise = true;
  return Random(truth, dice, [](const Track& track, Dice& noise) {
    return Along(track, [&](const Instant& at) { return std::abs(at.speed_deg_s) / 30.0 * noise.Normal(); });
  });
}

/// Sum of first-order processes with time constants in equal ratios.
AngleFault Flicker(Dice& dice, const Track&) {
  return Random(Unlisted({"drift"}), dice, [](const Track& track, Dice& noise) {
    constexpr int kProcesses = 6;
    Eigen::VectorXd state(kProcesses);
    for (double& s : state) s = noise.Normal();
    double last_s = track.front().t_s;
    return Along(track, [&](const Instant& at) {
      double over_s = Duration_s(track) / 300.0;
      for (double& s : state) {
        const double keep = std::exp(-(at.t_s - last_s) / over_s);
        s = keep * s + std::sqrt(1.0 - keep * keep) * noise.Normal();
        over_s *= 3.0;
      }
      last_s = at.t_s;
      return state.sum();
    });
  });
}

/// Now and then the device's filter holds back a share of the motion for a few readings.
AngleFault HeldReadings(Dice& dice, const Track&) {
  return Random(Unlisted({"outliers", "latency"}), dice, [](const Track& track, Dice& noise) {
    Eigen::VectorXd shown = Eigen::VectorXd::Zero(std::ssize(track));
    const int last = static_cast<int>(track.size()) - 1;
    for (int episode = 0; episode < 6; ++episode) {
      const int from = noise.Whole(5, last - 12), length = noise.Whole(3, 10);
      for (int k = 0; k < length; ++k) {
        const auto now = static_cast<std::size_t>(from + k), held = static_cast<std::size_t>(from);
        shown[from + k] = track[held].angle_deg - track[now].angle_deg;
      }
    }
    return shown;
  });
}

}  // namespace

std::vector<AngleKind> NoiseKinds() {
  return {
      {"noise of speed", Where::kMotion, NoiseOfSpeed}, {"1/f noise", Where::kBoth, Flicker},
      {"held readings", Where::kMotion, HeldReadings}};
}

}  // namespace twinbench::foreign
