#include "tests/foreign/stand_fault.h"

// Causes of the rotary bench that the catalogue lacks, or that are known to be taken for one that it has; and causes that
// it has, each written down anew.
namespace twinbench::foreign {
namespace {

double Rest(double t_s, double over_s) {
  return std::exp(-t_s / over_s);
}

const std::vector<StandKind> kUnlistedOfStand = {
    {"both distances", [](Dice& dice, const StandRun&) -> StandFault {
      const double sign = dice.Sign();
      const auto of_body = [sign](const StandRun&, double size, std::vector<Disturbed>& all) {
        for (Disturbed& at : all) {
          at.light.distance_a_m += sign * size;
          at.light.distance_b_m += sign * size;
        }
      };
      return {.truth = Unlisted({"psd_distance", "stray_light", "background"}), .of_body = of_body, .largest = 0.02};
    }},
    {"laser warm-up", [](Dice& dice, const StandRun& example) {
      const double over_s = Duration_s(example) * dice.Between(0.1, 0.35);
      return Shining(Unlisted({"laser_drift pitch"}), &Light::laser_pitch_rad,
                     [=](const StandStop& at) { return Rest(at.t_s, over_s); });
    }},
    {"thermal bend", [](Dice& dice, const StandRun& example) {
      const double quick_s = Duration_s(example) * dice.Between(0.04, 0.1), slow_s = quick_s * dice.Between(3.0, 7.0);
      return Moving(Unlisted(), &Disturbed::ex_rad,
                    [=](const StandStop& at) { return Rest(at.t_s, slow_s) - Rest(at.t_s, quick_s); });
    }},
    {"touch", [](Dice& dice, const StandRun& example) {
      const double from_s = Duration_s(example) * dice.Between(0.2, 0.8), over_s = dice.Between(15.0, 60.0);
      Truth truth = Unlisted({"outliers"});
      truth.repeats = false;
      return Moving(truth, &Disturbed::ex_rad, [=](const StandStop& at) {
        const double x = (at.t_s - from_s) / over_s;
        return x <= 0.0 ? 0.0 : x * std::exp(1.0 - x);
      });
    }},
    // Of the amplifier: what goes above a level is pressed together.
    {"one channel saturates", [](Dice& dice, const StandRun&) {
      const int channel = dice.Whole(0, 3);
      const double level_m = dice.Between(120e-6, 220e-6);
      StandFault fault = OnChannel(Unlisted({"psd_nonlinearity"}), channel, [=](const StandStop&, double shown_m) {
        return -std::max(0.0, std::abs(shown_m) - level_m) * (shown_m > 0.0 ? 1.0 : -1.0);
      });
      fault.largest = 1.0;  // flat
      return fault;
    }},
    {"gain steps", [](Dice& dice, const StandRun& example) {
      const int channel = dice.Whole(0, 3);
      const double first_s = Duration_s(example) * dice.Between(0.2, 0.4), second_s = first_s * dice.Between(1.5, 2.0);
      return OnChannel(Unlisted({"psd_gain " + ChannelName(channel)}), channel,
                       [=](const StandStop& at, double shown_m) {
                         return shown_m * (at.t_s < first_s ? 0.0 : at.t_s < second_s ? 1.0 : -0.5);
                       });
    }},
    // The table sticks and follows in jumps: by travel, not by position.
    {"stick-slip", [](Dice& dice, const StandRun&) {
      const double period = dice.Between(3.3, 9.7);
      return Moving(Unlisted(), &Disturbed::ez_rad, [=](const StandStop& at) {
        if (at.calibration) return 0.0;
        const double x = (at.direction > 0 ? at.position : 1000 - at.position) / period + 0.37 * at.pass;
        return -at.direction * (x - std::floor(x) - 0.5);
      });
    }},
    {"beat of two tones", [](Dice& dice, const StandRun& example) {
      const double first_Hz = dice.Between(40.0, 120.0) / Duration_s(example);
      const double second_Hz = first_Hz + dice.Between(1.5, 4.0) / Duration_s(example);
      return Moving(Unlisted({"tone"}), &Disturbed::ex_rad, [=](const StandStop& at) {
        return std::cos(2.0 * M_PI * first_Hz * at.t_s) + std::cos(2.0 * M_PI * second_Hz * at.t_s + 1.0);
      });
    }},
    {"chirp", [](Dice& dice, const StandRun& example) {
      const double duration_s = Duration_s(example), cycles = dice.Between(30.0, 90.0), phase = dice.Phase();
      return Moving(Unlisted(), &Disturbed::ex_rad, [=](const StandStop& at) {
        const double x = at.t_s / duration_s;
        return std::cos(2.0 * M_PI * cycles * (0.3 * x + 0.7 * x * x) + phase);
      });
    }},
    // A wobble of the target that begins in the middle of the run.
    {"order that appears", [](Dice& dice, const StandRun& example) {
      const double from_s = Duration_s(example) * dice.Between(0.35, 0.7), phase = dice.Phase();
      const int order = dice.Whole(2, 6);
      return Moving(Unlisted(), &Disturbed::ex_rad, [=](const StandStop& at) {
        return at.calibration || at.t_s < from_s ? 0.0 : std::cos(order * at.target_rad + phase);
      });
    }},
    {"temperature squared", [](Dice& dice, const StandRun& example) {
      double mean_degC = 0.0;
      for (const StandStop& at : example) mean_degC += at.temperature_degC / static_cast<double>(example.size());
      const double about_degC = mean_degC + dice.Between(-0.1, 0.1);
      return Moving(Unlisted(), &Disturbed::ex_rad, [=](const StandStop& at) {
        const double x_K = at.temperature_degC - about_degC;
        return x_K * x_K;
      });
    }},
    // A converter without some codes: what falls among them becomes the upper one.
    {"missing codes", [](Dice& dice, const StandRun&) -> StandFault {
      const int channel = dice.Whole(0, 3);
      const double code_m = dice.Between(-20e-6, 20e-6);
      const auto missing = [=](const StandRun&, double size, Eigen::MatrixX4d& shown_m) {
        for (double& value : shown_m.col(channel)) value = std::abs(value - code_m) < size ? code_m + size : value;
      };
      return {Unlisted({"adc_step " + ChannelName(channel)}), {}, missing, 1e-8, 60e-6};
    }},
    {"drift then rest", [](Dice& dice, const StandRun& example) {
      const double until_s = Duration_s(example) * dice.Between(0.3, 0.7);
      return Shining(Unlisted({"laser_drift pitch"}), &Light::laser_pitch_rad,
                     [=](const StandStop& at) { return std::min(at.t_s, until_s) / until_s; });
    }},
    // Friction of the target that remembers its last reversal.
    {"remembered reversal", [](Dice& dice, const StandRun&) {
      const double over = dice.Between(4.0, 12.0);
      return Moving(Unlisted({"backlash"}), &Disturbed::ez_rad, [=](const StandStop& at) {
        if (at.calibration) return 0.0;
        const double moved = at.direction > 0 ? at.position : 35.0 - at.position;
        const bool goes_on = at.pass == 2;  // passes + - - +: the third one does not reverse
        return -at.direction * (goes_on ? 1.0 : 1.0 - 2.0 / std::sqrt(1.0 + moved / over));
      });
    }},
    // Amplifier noise that grows away from the centre.
    {"noise of spot", [](Dice& dice, const StandRun&) -> StandFault {
      const int channel = dice.Whole(0, 3);
      const auto seed = static_cast<std::uint64_t>(dice.Whole(1, 1 << 30));
      Truth truth = Unlisted({"outliers"});
      truth.only_noise = true;
      truth.repeats = false;
      return {truth, {}, [=](const StandRun&, double size, Eigen::MatrixX4d& shown_m) {
                Dice noise(seed, "noise of spot");
                for (double& value : shown_m.col(channel)) value += size * std::abs(value) / 100e-6 * noise.Normal();
              }};
    }}};

const std::vector<StandKind> kListedOfStand = {
    {"psd_gain", [](Dice& dice, const StandRun&) {
      const int channel = dice.Whole(0, 3);
      const double sign = dice.Sign();
      return OnChannel(Listed({"psd_gain " + ChannelName(channel)}), channel,
                       [=](const StandStop&, double shown_m) { return sign * shown_m; });
    }},
    // What the channel scanned before it left behind.
    {"crosstalk", [](Dice& dice, const StandRun&) -> StandFault {
      const int channel = dice.Whole(0, 3), before = (channel + 3) % 4;
      const auto of_before = [=](const StandRun&, double size, Eigen::MatrixX4d& shown_m) {
        shown_m.col(channel) += size * (shown_m.col(before) - shown_m.col(channel));
      };
      return {Listed({"crosstalk " + ChannelName(channel)}), {}, of_before};
    }},
    // Between two readings of a set-up: what happens while it is re-mounted is its own constant.
    {"slip", [](Dice& dice, const StandRun& example) {
      std::vector<double> times_s;
      for (const StandStop& at : example) {
        if (!at.calibration && (at.pass == 1 || at.pass == 2)) times_s.push_back(at.t_s);
      }
      const double from_s = dice.OneOf(times_s);
      Truth truth = Listed({"slip tilt"});
      truth.repeats = false;
      return Moving(truth, &Disturbed::ex_rad, [=](const StandStop& at) { return at.t_s < from_s ? 0.0 : 1.0; });
    }},
    {"laser_drift", [](Dice&, const StandRun&) {
      return Shining(Listed({"laser_drift pitch"}), &Light::laser_pitch_rad,
                     [](const StandStop& at) { return at.t_s; });
    }},
    {"tone", [](Dice& dice, const StandRun& example) {
      const double frequency_Hz = dice.Between(40.0, 150.0) / Duration_s(example), phase = dice.Phase();
      return Moving(Listed({"tone tilt"}), &Disturbed::ex_rad,
                    [=](const StandStop& at) { return std::cos(2.0 * M_PI * frequency_Hz * at.t_s + phase); });
    }},
    // Nothing tells which of two tables that turn together stays behind, until one is turned alone.
    {"backlash", [](Dice& dice, const StandRun&) {
      const double sign = dice.Sign();
      return Moving(Listed({"backlash"}), &Disturbed::ez_rad,
                    [=](const StandStop& at) { return at.calibration ? 0.0 : sign * at.direction; });
    }},
    {"thermal_tilt", [](Dice& dice, const StandRun&) -> StandFault {
      const double lag_s = dice.Between(300.0, 1500.0);
      return {Listed({"thermal_tilt tilt"}), [=](const StandRun& run, double size, std::vector<Disturbed>& all) {
                double body_degC = run.front().temperature_degC, last_s = run.front().t_s;
                for (std::size_t i = 0; i < run.size(); ++i) {
                  const double keep = std::exp(-(run[i].t_s - last_s) / lag_s);
                  body_degC = keep * body_degC + (1.0 - keep) * run[i].temperature_degC;
                  last_s = run[i].t_s;
                  all[i].ex_rad += size * (body_degC - 20.0);
                }
              }};
    }},
    {"wavelength_temperature", [](Dice&, const StandRun&) {
      return Shining(Listed({"wavelength_temperature"}), &Light::wavelength_m,
                     [](const StandStop& at) { return at.temperature_degC - 20.0; });
    }}};

}  // namespace

const std::vector<StandKind>& UnlistedStandKinds() {
  return kUnlistedOfStand;
}

const std::vector<StandKind>& ListedStandKinds() {
  return kListedOfStand;
}

StandFault Moving(Truth truth, double Disturbed::*member, std::function<double(const StandStop&)> shape) {
  return {std::move(truth), [=](const StandRun& run, double size, std::vector<Disturbed>& all) {
            for (std::size_t i = 0; i < run.size(); ++i) all[i].*member += size * shape(run[i]);
          }};
}

StandFault Shining(Truth truth, double Light::*member, std::function<double(const StandStop&)> shape) {
  return {std::move(truth), [=](const StandRun& run, double size, std::vector<Disturbed>& all) {
            for (std::size_t i = 0; i < run.size(); ++i) all[i].light.*member += size * shape(run[i]);
          }};
}

StandFault OnChannel(Truth truth, int channel, std::function<double(const StandStop&, double shown_m)> shape) {
  return {std::move(truth), {}, [=](const StandRun& run, double size, Eigen::MatrixX4d& shown_m) {
            for (std::size_t i = 0; i < run.size(); ++i) {
              double& value = shown_m(static_cast<Eigen::Index>(i), channel);
              value += size * shape(run[i], value);
            }
          }};
}

std::string ChannelName(int channel) {
  return kChannelNames[static_cast<std::size_t>(channel)];
}

}  // namespace twinbench::foreign
