#include "tests/foreign/angle_fault.h"

// Causes that the catalogue has, each written down anew; and faults of angle devices that are locked to motion -
// speed, travel, reversals - or random themselves.
namespace twinbench::foreign {
namespace {

AngleFault Wave(Truth truth, int order, double phase) {
  return Linear(std::move(truth),
                [=](const Instant& at) { return std::cos(order * at.angle_deg * kDegree + phase); });
}

/// A device dragged behind by a gap that is crossed in full.
Eigen::VectorXd Play(const Track& track, double width_deg) {
  double middle_deg = track.front().angle_deg;
  return Along(track, [&](const Instant& at) {
    middle_deg = std::clamp(middle_deg, at.angle_deg - 0.5 * width_deg, at.angle_deg + 0.5 * width_deg);
    return middle_deg - at.angle_deg;
  });
}

const std::vector<AngleKind> kListed = {
    // Nothing tells these apart: either name is the truth of the case.
    {"once a turn", Where::kBoth, [](Dice& dice, const Track&) {
      const bool mounted = dice.Sign() > 0.0;
      return Wave(Listed(mounted ? Names{"eccentricity", "signal_offset"} : Names{"signal_offset", "eccentricity"}), 1,
                  dice.Phase());
    }},
    {"twice a turn", Where::kBoth, [](Dice& dice, const Track&) {
      Names names = {"ellipticity", "amplitude_mismatch", "quadrature_error"};
      std::swap(names[0], names[static_cast<std::size_t>(dice.Whole(0, 2))]);
      return Wave(Listed(names), 2, dice.Phase());
    }},
    {"periodic", Where::kBoth, [](Dice& dice, const Track&) {
      return Wave(Listed({"periodic"}), dice.Whole(5, 17), dice.Phase());
    }},
    {"backlash", Where::kBoth, [](Dice&, const Track&) -> AngleFault {
      return {Listed({"backlash"}), Play, 1e-6, 5.0};
    }},
    {"hysteresis", Where::kBoth, [](Dice& dice, const Track&) {
      const double over_deg = dice.Between(20.0, 90.0);
      return Linear(Listed({"hysteresis"}), [=](const Instant& at) {
        return -at.sense * (1.0 - 2.0 * std::exp(-at.since_reversal_deg / over_deg));
      });
    }},
    {"scale", Where::kBoth, [](Dice& dice, const Track&) {
      const double sign = dice.Sign();
      return Linear(Listed({"scale"}), [=](const Instant& at) { return sign * at.angle_deg; });
    }},
    {"drift", Where::kBoth, [](Dice& dice, const Track&) {
      const double sign = dice.Sign();
      return Linear(Listed({"drift"}), [=](const Instant& at) { return sign * at.t_s; });
    }},
    {"slip", Where::kBoth, [](Dice& dice, const Track& example) {
      const double from_s = Duration_s(example) * dice.Between(0.15, 0.85), sign = dice.Sign();
      Truth truth = Listed({"slip"});
      truth.repeats = false;
      return Linear(truth, [=](const Instant& at) { return at.t_s < from_s ? 0.0 : sign; });
    }},
    {"latency", Where::kMotion, [](Dice& dice, const Track&) {
      const double sign = dice.Sign();
      return Linear(Listed({"latency"}), [=](const Instant& at) { return -sign * at.speed_deg_s; });
    }},
    // Both signals flat above a share 1 - size of their amplitude.
    {"clipping", Where::kBoth, [](Dice& dice, const Track&) -> AngleFault {
      const double zero = dice.Phase();
      const auto error = [=](const Instant& at, double level) {
        const double phase = at.angle_deg * kDegree - zero;
        const double s = std::clamp(std::sin(phase), -level, level), c = std::clamp(std::cos(phase), -level, level);
        return std::remainder(std::atan2(s, c) - phase, 2.0 * M_PI) / kDegree;
      };
      const auto shown_deg = [error](const Track& track, double size) {
        return Along(track, [&](const Instant& at) { return error(at, 1.0 - size); });
      };
      return {Listed({"signal_clipping"}), shown_deg, 1e-4, 0.29};
    }}};

/// Random, and another in every run: the dice go on.
AngleFault Random(Truth truth, Dice& dice, std::function<Eigen::VectorXd(const Track& track, Dice& noise)> unit) {
  truth.repeats = false;
  const auto seed = static_cast<std::uint64_t>(dice.Whole(1, 1 << 30));
  return {std::move(truth), [seed, unit = std::move(unit)](const Track& track, double size) {
            Dice noise(seed, "random fault");
            return Eigen::VectorXd(size * unit(track, noise));
          }};
}

const std::vector<AngleKind> kInMotion = {
    {"speed bias", Where::kMotion, [](Dice& dice, const Track&) {
      const double sign = dice.Sign(), power = dice.Sign() > 0.0 ? 1.0 : 2.0;
      return Linear(Unlisted(),
                    [=](const Instant& at) { return sign * std::pow(std::abs(at.speed_deg_s) / 30.0, power); });
    }},
    // The device's clock runs at another rate: an age of the reading that grows. It is here for the way in which it
    // was taken for slips and passes of their own.
    {"clock rate", Where::kMotion, [](Dice& dice, const Track& example) {
      const double duration_s = Duration_s(example), sign = dice.Sign();
      return Linear(Listed({"clock_rate"}),
                    [=](const Instant& at) { return sign * at.speed_deg_s / 30.0 * at.t_s / duration_s; });
    }},
    // Sticking: the device is left behind evenly, lets go, and begins anew, by travel and not by angle.
    {"stick-slip", Where::kBoth, [](Dice& dice, const Track&) {
      const double period_deg = dice.Between(17.0, 70.0);
      return Linear(Unlisted(), [=](const Instant& at) {
        const double x = at.travelled_deg / period_deg;
        return -at.sense * (x - std::floor(x));
      });
    }},
    // Friction that remembers the last reversal: the branch of a Rayleigh loop, which settles with a power and not
    // with an exponential.
    {"remembered reversal", Where::kBoth, [](Dice& dice, const Track&) {
      const double over_deg = dice.Between(10.0, 60.0), power = dice.Between(0.4, 0.9);
      return Linear(Unlisted({"hysteresis", "backlash"}), [=](const Instant& at) {
        return -at.sense * (1.0 - 2.0 * std::pow(1.0 + at.since_reversal_deg / over_deg, -power));
      });
    }},
    // After every reversal something comes to rest in time, whatever the travel.
    {"relaxes behind reversals", Where::kBoth, [](Dice& dice, const Track& example) {
      const double over_s = Duration_s(example) * dice.Between(0.03, 0.1);
      return Linear(Unlisted({"hysteresis", "backlash"}),
                    [=](const Instant& at) { return at.sense * std::exp(-at.since_reversal_s / over_s); });
    }},
    // A resonance of the mounting that is met while the speed goes by.
    {"speed resonance", Where::kMotion, [](Dice& dice, const Track& example) {
      double fastest_deg_s = 0.0;
      for (const Instant& at : example) fastest_deg_s = std::max(fastest_deg_s, std::abs(at.speed_deg_s));
      const double at_deg_s = fastest_deg_s * dice.Between(0.3, 0.7), width_deg_s = 0.15 * fastest_deg_s;
      return Linear(Unlisted(), [=](const Instant& at) {
        const double x = (std::abs(at.speed_deg_s) - at_deg_s) / width_deg_s;
        return at.sense / (1.0 + x * x);
      });
    }},
    {"noise of speed", Where::kMotion, [](Dice& dice, const Track&) {
      Truth truth = Unlisted({"outliers"});
      truth.only_noise = true;
      return Random(truth, dice, [](const Track& track, Dice& noise) {
        return Along(track, [&](const Instant& at) { return std::abs(at.speed_deg_s) / 30.0 * noise.Normal(); });
      });
    }},
    // Sum of first-order processes with time constants in equal ratios.
    {"1/f noise", Where::kBoth, [](Dice& dice, const Track&) {
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
    }},
    // Now and then the device's filter holds back a share of the motion for a few readings.
    {"held readings", Where::kMotion, [](Dice& dice, const Track&) {
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
    }}};

}  // namespace

const std::vector<AngleKind>& ListedAngleKinds() {
  return kListed;
}

AngleFault Linear(Truth truth, std::function<double(const Instant&)> shape) {
  return {std::move(truth), [shape = std::move(shape)](const Track& track, double size) {
            return Along(track, [&](const Instant& at) { return size * shape(at); });
          }};
}

const std::vector<AngleKind>& UnlistedAngleKinds() {
  static const std::vector<AngleKind> all = [] {
    std::vector<AngleKind> kinds = LockedKinds();
    kinds.insert(kinds.end(), kInMotion.begin(), kInMotion.end());
    return kinds;
  }();
  return all;
}

}  // namespace twinbench::foreign
