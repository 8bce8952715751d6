#include "tests/foreign/angle_fault.h"

// Causes that the catalogue has, each written down anew.
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
    std::vector<AngleKind> kinds;
    for (const auto& part : {LockedKinds(), MotionKinds()})
      kinds.insert(kinds.end(), part.begin(), part.end());
    return kinds;
  }();
  return all;
}

}  // namespace twinbench::foreign
