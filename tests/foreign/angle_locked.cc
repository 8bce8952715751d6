#include "tests/foreign/angle_fault.h"

// Faults of angle devices that are locked to an angle, to time or to temperature.
namespace twinbench::foreign {
namespace {

double Wave(const Instant& at, double order, double phase) {
  return std::cos(order * at.angle_deg * kDegree + phase);
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

double Rest(double t_s, double over_s) {
  return std::exp(-t_s / over_s);
}

const std::vector<AngleKind> kLocked = {
    {"warm-up", Where::kBoth, [](Dice& dice, const Track& example) {
      const double over_s = Duration_s(example) * dice.Between(0.06, 0.35);
      return Linear(Unlisted({"drift"}), [=](const Instant& at) { return Rest(at.t_s, over_s); });
    }},
    // A part that heats quickly and one that follows bend against each other.
    {"thermal bend", Where::kBoth, [](Dice& dice, const Track& example) {
      const double quick_s = Duration_s(example) * dice.Between(0.03, 0.08), slow_s = quick_s * dice.Between(5.0, 10.0);
      return Linear(Unlisted({"drift"}),
                    [=](const Instant& at) { return Rest(at.t_s, slow_s) - Rest(at.t_s, quick_s); });
    }},
    // Somebody leans on it for a while: it goes aside within seconds, comes back slowly, and all is as before.
    {"touch", Where::kBoth, [](Dice& dice, const Track& example) {
      const double duration_s = Duration_s(example), from_s = duration_s * dice.Between(0.15, 0.8);
      const double over_s = duration_s * dice.Between(0.006, 0.03), sign = dice.Sign();
      Truth truth = Unlisted({"outliers"});
      truth.repeats = false;
      return Linear(truth, [=](const Instant& at) {
        const double x = (at.t_s - from_s) / over_s;
        return x <= 0.0 ? 0.0 : sign * x * std::exp(1.0 - x);
      });
    }},
    {"drift then rest", Where::kBoth, [](Dice& dice, const Track& example) {
      const double until_s = Duration_s(example) * dice.Between(0.25, 0.7);
      return Linear(Unlisted({"drift"}), [=](const Instant& at) { return std::min(at.t_s, until_s) / until_s; });
    }},
    {"beat of two tones", Where::kBoth, [](Dice& dice, const Track& example) {
      const double first_Hz = dice.Between(15.0, 40.0) / Duration_s(example);
      const double second_Hz = first_Hz + dice.Between(1.5, 4.0) / Duration_s(example);
      const double first = dice.Phase(), second = dice.Phase();
      return Linear(Unlisted(), [=](const Instant& at) {
        return std::cos(2.0 * M_PI * first_Hz * at.t_s + first) + std::cos(2.0 * M_PI * second_Hz * at.t_s + second);
      });
    }},
    {"chirp", Where::kBoth, [](Dice& dice, const Track& example) {
      const double duration_s = Duration_s(example), cycles = dice.Between(12.0, 30.0), phase = dice.Phase();
      return Linear(Unlisted(), [=](const Instant& at) {
        const double x = at.t_s / duration_s;
        return std::cos(2.0 * M_PI * cycles * (0.3 * x + 0.7 * x * x) + phase);
      });
    }},
    {"temperature squared", Where::kStops, [](Dice& dice, const Track& example) {
      double mean_degC = 0.0;
      for (const Instant& at : example) mean_degC += at.temperature_degC / static_cast<double>(example.size());
      const double about_degC = mean_degC + dice.Between(-0.1, 0.1);
      return Linear(Unlisted({"drift"}), [=](const Instant& at) {
        const double x_K = at.temperature_degC - about_degC;
        return x_K * x_K;
      });
    }},
    // A body that follows the room with a lag turns with its temperature.
    {"lagged temperature", Where::kStops, [](Dice& dice, const Track& example) -> AngleFault {
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
    }},
    // The scale's gain takes another value twice.
    {"gain steps", Where::kBoth, [](Dice& dice, const Track& example) {
      const double duration_s = Duration_s(example), first_s = duration_s * dice.Between(0.2, 0.45);
      const double second_s = duration_s * dice.Between(0.55, 0.85), back = dice.Between(0.2, 0.7);
      return Linear(Unlisted({"scale"}), [=](const Instant& at) {
        return (at.t_s < first_s ? 0.0 : at.t_s < second_s ? 1.0 : back) * at.angle_deg;
      });
    }},
    // The eccentricity that was there becomes another one.
    {"eccentricity jump", Where::kBoth, [](Dice& dice, const Track& example) {
      const double from_s = Duration_s(example) * dice.Between(0.25, 0.75);
      const double before = dice.Phase(), after = before + dice.Between(1.0, 2.5);
      return Linear(Unlisted({"eccentricity", "signal_offset"}),
                    [=](const Instant& at) { return Wave(at, 1.0, at.t_s < from_s ? before : after); });
    }},
    {"order that appears", Where::kBoth, [](Dice& dice, const Track& example) {
      const double from_s = Duration_s(example) * dice.Between(0.3, 0.7), phase = dice.Phase();
      const int order = dice.Whole(3, 13);
      return Linear(Unlisted({"periodic"}),
                    [=](const Instant& at) { return at.t_s < from_s ? 0.0 : Wave(at, order, phase); });
    }},
    {"modulated order", Where::kBoth, [](Dice& dice, const Track& example) {
      const double beat_Hz = dice.Between(1.3, 4.0) / Duration_s(example), phase = dice.Phase(), other = dice.Phase();
      const int order = dice.Whole(3, 13);
      return Linear(Unlisted({"periodic"}), [=](const Instant& at) {
        return (1.0 + std::cos(2.0 * M_PI * beat_Hz * at.t_s + other)) * Wave(at, order, phase);
      });
    }},
    // A belt that creeps: an order whose phase runs away.
    {"slipping belt", Where::kBoth, [](Dice& dice, const Track& example) {
      const double turns_s = dice.Between(0.7, 2.0) / Duration_s(example), phase = dice.Phase();
      const int order = dice.Whole(2, 9);
      return Linear(Unlisted(), [=](const Instant& at) {
        return std::cos(order * at.angle_deg * kDegree + 2.0 * M_PI * turns_s * at.t_s + phase);
      });
    }},
    // A tooth mesh whose size depends on the side of the teeth that bears.
    {"one-sided mesh", Where::kBoth, [](Dice& dice, const Track&) {
      const double phase = dice.Phase(), share = dice.Between(0.1, 0.5);
      const int order = dice.Whole(4, 15);
      return Linear(Unlisted({"periodic", "gear_mesh"}),
                    [=](const Instant& at) { return (at.sense > 0 ? 1.0 : share) * Wave(at, order, phase); });
    }},
    // One of the two signals saturates, softly, on one side.
    {"one channel saturates", Where::kBoth, [](Dice& dice, const Track&) {
      const auto error_deg = [](double phase, double size) {
        const double above = std::max(0.0, std::sin(phase) - (1.0 - size));
        return ErrorOfSignals_deg(phase, std::sin(phase) - above, std::cos(phase));
      };
      return OfSignals(Unlisted({"signal_clipping"}), 0.9, error_deg, dice.Phase());
    }},
    // A converter of few bits of which one code never comes: it shows the next one.
    {"missing code", Where::kBoth, [](Dice& dice, const Track&) {
      const double code = dice.Between(-0.7, 0.7);
      const auto error_deg = [code](double phase, double size) {
        const double sine = std::sin(phase);
        return ErrorOfSignals_deg(phase, std::abs(sine - code) < size ? code + size : sine, std::cos(phase));
      };
      return OfSignals(Unlisted(), 0.5, error_deg, dice.Phase());
    }},
    // Once a turn the device does not move for `size` degrees, and then catches up.
    {"dead zone", Where::kMotion, [](Dice& dice, const Track&) -> AngleFault {
      const double middle_deg = dice.Between(0.0, 360.0);
      const auto shown_deg = [middle_deg](const Track& track, double size) {
        return Along(track, [&](const Instant& at) {
          const double off_deg = std::remainder(at.angle_deg - middle_deg, 360.0);
          return std::abs(off_deg) < 0.5 * size ? -off_deg : 0.0;
        });
      };
      return {Unlisted(), shown_deg, 1e-4, 60.0};
    }},
    // A turn of the device is not quite 360 deg, and its zero puts that right.
    {"wrap error", Where::kBoth, [](Dice& dice, const Track&) {
      const double zero_deg = dice.Between(0.0, 360.0), sign = dice.Sign();
      return Linear(Unlisted(), [=](const Instant& at) {
        const double turns = (at.angle_deg - zero_deg) / 360.0;
        return sign * (turns - std::floor(turns));
      });
    }},
    // A spot on the scale where counts get lost, each time it is passed forward.
    {"lost counts", Where::kBoth, [](Dice& dice, const Track& example) -> AngleFault {
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
    }}};

}  // namespace

std::vector<AngleKind> LockedKinds() {
  return kLocked;
}

}  // namespace twinbench::foreign
