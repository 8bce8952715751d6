#include <cmath>

#include "tests/foreign/stand_fault.h"

// Causes that the catalogue has, each written down anew.
namespace twinbench::foreign {
namespace {

StandFault Gain(Dice& dice, const StandRun&) {
  const int channel = dice.Whole(0, 3);
  const double sign = dice.Sign();
  return OnChannel(Listed({"psd_gain " + ChannelName(channel)}), channel,
                   [=](const StandStop&, double shown_m) { return sign * shown_m; });
}

/// What the channel scanned before it left behind.
StandFault Crosstalk(Dice& dice, const StandRun&) {
  const int channel = dice.Whole(0, 3), before = (channel + 3) % 4;
  const auto of_before = [=](const StandRun&, double size, Eigen::MatrixX4d& shown_m) {
    shown_m.col(channel) += size * (shown_m.col(before) - shown_m.col(channel));
  };
  return {Listed({"crosstalk " + ChannelName(channel)}), {}, of_before};
}

/// Between two readings of a set-up: what happens while it is re-mounted is its own constant.
StandFault Slip(Dice& dice, const StandRun& example) {
  std::vector<double> times_s;
  for (const StandStop& at : example) {
    if (!at.calibration && (at.pass == 1 || at.pass == 2)) times_s.push_back(at.t_s);
  }
  const double from_s = dice.OneOf(times_s);
  Truth truth = Listed({"slip tilt"});
  truth.repeats = false;
  return Moving(truth, &Disturbed::ex_rad, [=](const StandStop& at) { return at.t_s < from_s ? 0.0 : 1.0; });
}

StandFault LaserDrift(Dice&, const StandRun&) {
  return Shining(Listed({"laser_drift pitch"}), &Light::laser_pitch_rad,
                 [](const StandStop& at) { return at.t_s; });
}

StandFault Tone(Dice& dice, const StandRun& example) {
  const double frequency_Hz = dice.Between(40.0, 150.0) / Duration_s(example), phase = dice.Phase();
  return Moving(Listed({"tone tilt"}), &Disturbed::ex_rad,
                [=](const StandStop& at) { return std::cos(2.0 * M_PI * frequency_Hz * at.t_s + phase); });
}

/// Nothing tells which of two tables that turn together stays behind, until one is turned alone.
StandFault Backlash(Dice& dice, const StandRun&) {
  const double sign = dice.Sign();
  return Moving(Listed({"backlash"}), &Disturbed::ez_rad,
                [=](const StandStop& at) { return at.calibration ? 0.0 : sign * at.direction; });
}

StandFault ThermalTilt(Dice& dice, const StandRun&) {
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
}

StandFault WavelengthOfTemperature(Dice&, const StandRun&) {
  return Shining(Listed({"wavelength_temperature"}), &Light::wavelength_m,
                 [](const StandStop& at) { return at.temperature_degC - 20.0; });
}

}  // namespace

const std::vector<StandKind>& ListedStandKinds() {
  static const std::vector<StandKind> kinds = {
      {"psd_gain", Gain}, {"crosstalk", Crosstalk}, {"slip", Slip}, {"laser_drift", LaserDrift}, {"tone", Tone},
      {"backlash", Backlash}, {"thermal_tilt", ThermalTilt},
      {"wavelength_temperature", WavelengthOfTemperature}};
  return kinds;
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
