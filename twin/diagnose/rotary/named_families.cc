#include <algorithm>

#include "twin/diagnose/rotary/family_parts.h"
#include "twin/diagnose/rotary/signals.h"

namespace twinbench::diagnose::rotary {
namespace {

void AddTimeFamilies(const SignalContext& context, const Schedule& s, std::vector<Family>& families) {
  for (const char* where : {"yaw", "pitch"}) {
    families.push_back(SignalFamily("laser_drift", where, {AmplitudeOf("laser_drift", "drift")},
                                    {ShapeOf("laser_drift", "curvature", Even(-1.0, 1.0, 9))}, context));
  }
  for (const char* where : {"yaw", "tilt"}) {
    for (const bool calibration_too : {true, false}) {
      Family creep = SignalFamily("mount_creep", where, {AmplitudeOf("mount_creep", "amplitude")},
                                  {ShapeOf("mount_creep", "time_constant", Logarithmic(5.0, 1500.0, 7))}, context);
      SetSignal(creep, [&context, calibration_too, where](const Eigen::VectorXd& shape) {
        return OnChannels(CreepSignal(context.run.schedule, shape[0], calibration_too),
                          WeightOf(where, context.shown_by_motion));
      });
      families.push_back(std::move(creep));
    }
    if (!s.temperature_degC.array().isFinite().any()) continue;
    families.push_back(SignalFamily(
        "thermal_tilt", where, {AmplitudeOf("thermal_tilt", "tilt_per_kelvin")},
        {ShapeOf("thermal_tilt", "lag", {0.0, 150.0, 300.0, 600.0, 900.0, 1350.0, 2000.0, 3000.0})}, context));
  }
}

Family HalfFrequency(const SignalContext& context, const Whirling& whirling) {
  const Amplitude tilt = AmplitudeOf("bearing_half_frequency", "tilt");
  Family half = SignalFamily("bearing_half_frequency", "", {tilt, tilt},
                             {ShapeOf("bearing_half_frequency", "order", Even(0.35, 0.65, 61))}, context);
  SetSignal(half, [&context, whirling](const Eigen::VectorXd& shape) {
    return HalfFrequencySignal(shape[0], whirling, context);
  });
  half.parameters = [a = half.amplitudes[0], o = half.shapes[0]](
                        const Eigen::VectorXd& shape, const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
    ParameterEstimate size = LengthOf(a, x, cov);  // the catalogue's has no phase, but a sign
    size.value = std::copysign(size.value, x[0]);
    size.lower = a.lower;
    return std::vector<ParameterEstimate>{Plain(o, shape[0], std::sqrt(cov(2, 2))), size};
  };
  return half;
}

void AddTravelFamilies(const SignalContext& context, const Schedule& s, std::vector<Family>& families) {
  for (const char* where : {"target", "reference"}) {
    families.push_back(SignalFamily("backlash", where, {AmplitudeOf("backlash", "half_width")}, {}, context));
  }
  if (s.dwell_s.array().isFinite().any()) {
    families.push_back(SignalFamily("settling", "", {AmplitudeOf("settling", "amplitude")},
                                    {ShapeOf("settling", "time_constant", Logarithmic(0.3, 4.0, 8))}, context));
  }
  for (const Turning turning : {Turning::kContinued, Turning::kThroughSetups, Turning::kTravelled}) {
    for (const double lever_m : {context.target_height_m, 0.0}) {
      for (const double sense : {1.0, -1.0}) families.push_back(HalfFrequency(context, {turning, lever_m, sense}));
    }
  }
}

/// Levels at which a step would part the readings of a channel, as finely as they lie.
std::vector<double> StepLevels_V(const SignalContext& context, int channel) {
  constexpr int kLevels = 160;
  Eigen::VectorXd volts = Eigen::Map<const Eigen::VectorXd, 0, Eigen::InnerStride<>>(
      context.shown_m.data() + channel, context.run.schedule.Readings(), Eigen::InnerStride<>(kChannels));
  volts *= context.sensitivity_V_m[static_cast<std::size_t>(channel / 2)];
  std::sort(volts.begin(), volts.end());
  std::vector<double> levels = {0.0};
  for (int k = 1; k < kLevels; ++k) levels.push_back(volts[k * (volts.size() - 1) / kLevels]);
  return levels;
}

/// @param blur_V  Width of the step in block means: the noise of a sample, or nearly nothing if the means jump.
Family StepFamily(const SignalContext& context, int channel, double blur_V) {
  const std::string where = kChannelNames[static_cast<std::size_t>(channel)];
  Family family = SignalFamily("adc_step", where, {AmplitudeOf("adc_step", "step")},
                               {ShapeOf("adc_step", "at_voltage", StepLevels_V(context, channel))}, context);
  SetSignal(family, [&context, channel, blur_V](const Eigen::VectorXd& shape) {
    return AdcStepSignal(channel, shape[0], blur_V, context);
  });
  return family;
}

void AddElectronicFamilies(const SignalContext& context, std::vector<Family>& families) {
  constexpr double kSharp_V = 0.2e-3;
  for (int c = 0; c < kChannels; ++c) {
    const std::string where = kChannelNames[static_cast<std::size_t>(c)];
    families.push_back(SignalFamily("crosstalk", where, {AmplitudeOf("crosstalk", "fraction")}, {}, context));
    for (const double blur_V : {std::max(kSharp_V, context.sample_noise_V), kSharp_V}) {
      families.push_back(StepFamily(context, c, blur_V));
    }
  }
}

}  // namespace

std::vector<Family> NamedFamilies(const RotaryRun& rotary, const SignalContext& context, const Scenario& scenario,
                                  const TimeSeries& series) {
  std::vector<Family> families;
  AddBenchFamilies(rotary, scenario, families);
  AddTimeFamilies(context, rotary.run.schedule, families);
  AddTravelFamilies(context, rotary.run.schedule, families);
  AddElectronicFamilies(context, families);
  AddTones(rotary, series, families);
  AddSlips(rotary, series, families);
  return families;
}

}  // namespace twinbench::diagnose::rotary
