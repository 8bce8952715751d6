#include <algorithm>
#include <cmath>

#include "tests/foreign/angle_fault.h"

// Faults of angle devices that are locked to an angle.
namespace twinbench::foreign {
namespace {

double Wave(const Instant& at, double order, double phase) {
  return std::cos(order * at.angle_deg * kDegree + phase);
}

/// The eccentricity that was there becomes another one.
AngleFault EccentricityJump(Dice& dice, const Track& example) {
  const double from_s = Duration_s(example) * dice.Between(0.25, 0.75);
  const double before = dice.Phase(), after = before + dice.Between(1.0, 2.5);
  return Linear(Unlisted({"eccentricity", "signal_offset"}),
                [=](const Instant& at) { return Wave(at, 1.0, at.t_s < from_s ? before : after); });
}

AngleFault OrderThatAppears(Dice& dice, const Track& example) {
  const double from_s = Duration_s(example) * dice.Between(0.3, 0.7), phase = dice.Phase();
  const int order = dice.Whole(3, 13);
  return Linear(Unlisted({"periodic"}),
                [=](const Instant& at) { return at.t_s < from_s ? 0.0 : Wave(at, order, phase); });
}

AngleFault ModulatedOrder(Dice& dice, const Track& example) {
  const double beat_Hz = dice.Between(1.3, 4.0) / Duration_s(example), phase = dice.Phase(), other = dice.Phase();
  const int order = dice.Whole(3, 13);
  return Linear(Unlisted({"periodic"}), [=](const Instant& at) {
    return (1.0 + std::cos(2.0 * M_PI * beat_Hz * at.t_s + other)) * Wave(at, order, phase);
  });
}

/// A belt that creeps: an order whose phase runs away.
AngleFault SlippingBelt(Dice& dice, const Track& example) {
  const double turns_s = dice.Between(0.7, 2.0) / Duration_s(example), phase = dice.Phase();
  const int order = dice.Whole(2, 9);
  return Linear(Unlisted(), [=](const Instant& at) {
    return std::cos(order * at.angle_deg * kDegree + 2.0 * M_PI * turns_s * at.t_s + phase);
  });
}

/// A tooth mesh whose size depends on the side of the teeth that bears.
AngleFault OneSidedMesh(Dice& dice, const Track&) {
  const double phase = dice.Phase(), share = dice.Between(0.1, 0.5);
  const int order = dice.Whole(4, 15);
  return Linear(Unlisted({"periodic", "gear_mesh"}),
                [=](const Instant& at) { return (at.sense > 0 ? 1.0 : share) * Wave(at, order, phase); });
}

double ErrorOfSignals_deg(double phase, double sine, double cosine) {
  return std::remainder(std::atan2(sine, cosine) - phase, 2.0 * M_PI) / kDegree;
}

AngleFault OfSignals(Truth truth, double largest, std::function<double(double phase, double size)> error_deg,
                     double zero) {
  const auto shown_deg = [=, error_deg = std::move(error_deg)](const Track& track, double size) {
    return Along(track, [&](const Instant& at) { return error_deg(at.angle_deg * kDegree - zero, size); });
  };
  return {std::move(truth), shown_deg, 1e-4, largest};
}

/// One of the two signals saturates, softly, on one side.
AngleFault OneChannelSaturates(Dice& dice, const Track&) {
  const auto error_deg = [](double phase, double size) {
    const double above = std::max(0.0, std::sin(phase) - (1.0 - size));
    return ErrorOfSignals_deg(phase, std::sin(phase) - above, std::cos(phase));
  };
  return OfSignals(Unlisted({"signal_clipping"}), 0.9, error_deg, dice.Phase());
}

/// A converter of few bits of which one code never comes: it shows the next one.
AngleFault MissingCode(Dice& dice, const Track&) {
  const double code = dice.Between(-0.7, 0.7);
  const auto error_deg = [code](double phase, double size) {
    const double sine = std::sin(phase);
    return ErrorOfSignals_deg(phase, std::abs(sine - code) < size ? code + size : sine, std::cos(phase));
  };
  return OfSignals(Unlisted(), 0.5, error_deg, dice.Phase());
}

/// Once a turn the device does not move for `size` degrees, and then catches up.
AngleFault DeadZone(Dice& dice, const Track&) {
  const double middle_deg = dice.Between(0.0, 360.0);
  const auto shown_deg = [middle_deg](const Track& track, double size) {
    return Along(track, [&](const Instant& at) {
      const double off_deg = std::remainder(at.angle_deg - middle_deg, 360.0);
      return std::abs(off_deg) < 0.5 * size ? -off_deg : 0.0;
    });
  };
  return {Unlisted(), shown_deg, 1e-4, 60.0};
}

/// A turn of the device is not quite 360 deg, and its zero puts that right.
AngleFault WrapError(Dice& dice, const Track&) {
  const double zero_deg = dice.Between(0.0, 360.0), sign = dice.Sign();
  return Linear(Unlisted(), [=](const Instant& at) {
    const double turns = (at.angle_deg - zero_deg) / 360.0;
    return sign * (turns - std::floor(turns));
  });
}

/// A spot on the scale where counts get lost, each time it is passed forward.
AngleFault LostCounts(Dice& dice, const Track& example) {
  const double spot_deg = example.front().angle_deg + dice.Between(40.0, 300.0);
  const auto turn = [spot_deg](const Instant& at) { return std::floor((at.angle_deg - spot_deg) / 360.0); };
  const auto shown_deg = [turn](const Track& track, double size) {
    double lost_deg = 0.0, last_turn = turn(track.front());
    return Along(track, [&](const Instant& at) {
      lost_deg += size * std::max(0.0, turn(at) - last_turn);
      last_turn = turn(at);
      return -lost_deg;
    });
  };
  return {Unlisted({"slip", "scale"}), shown_deg};
}

}  // namespace

std::vector<AngleKind> AngleLockedKinds() {
  return {
      {"eccentricity jump", Where::kBoth, EccentricityJump},
      {"order that appears", Where::kBoth, OrderThatAppears}, {"modulated order", Where::kBoth, ModulatedOrder},
      {"slipping belt", Where::kBoth, SlippingBelt}, {"one-sided mesh", Where::kBoth, OneSidedMesh},
      {"one channel saturates", Where::kBoth, OneChannelSaturates}, {"missing code", Where::kBoth, MissingCode},
      {"dead zone", Where::kMotion, DeadZone}, {"wrap error", Where::kBoth, WrapError},
      {"lost counts", Where::kBoth, LostCounts}};
}

}  // namespace twinbench::foreign
