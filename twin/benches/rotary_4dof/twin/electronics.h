#pragma once

#include "twin/benches/rotary_4dof/settings.h"
#include "twin/benches/rotary_4dof/twin/effect.h"
#include "twin/benches/rotary_4dof/twin/light.h"
#include "twin/core/sampled_curve.h"
#include "twin/core/scenario.h"
#include "twin/core/stream.h"
#include "twin/sim/ad_sampler.h"
#include "twin/sim/block_course.h"
#include "twin/sim/flicker_noise.h"

namespace twinbench::sim {

/// From spots to A/D blocks: amplifiers with gain, offset, noise and hum, then the multiplexed converter.
class Electronics {
 public:
  Electronics(const Scenario& actual, const SamplingState& sampling);

  /// Amplifier outputs for spot coordinates [m] in channel order.
  std::array<double, kChannels> Amplify(const std::array<double, kChannels>& spots_m) const;

  /// Period of the fastest thing that the amplifiers add beside noise and hum; infinite if there is none.
  double Shortest_s() const;
  /// The amplifiers' 1 / f noise.
  void AddFlicker(Time now, std::array<double, kChannels>& signal_V) const;

  /// Of the light itself, one sample, standard deviation at the amplifiers' outputs (psd_noise.h).
  std::array<double, kChannels> LightNoise_V(const Spots& spots) const;

  /// Converts one block. What changes in it by less than a thousandth of a code step counts as steady, what is that
  /// near to a straight line as one: then samples need not be asked one by one. `reading` enters the noise stream,
  /// so that a reading's noise does not depend on how many samples the readings before it took.
  /// @param light_noise_V  Of each channel; comes to the amplifiers' own.
  Acquisition Convert(BlockCourse course, const std::array<double, kChannels>& light_noise_V, Time start,
                      int reading, int n_samples, bool keep_raw);

  /// The mean that such a block would have if it were taken again and again: hum and crosstalk as they fall into
  /// it, a step of the converter blurred by the samples' noise, no quantisation. NaN at the ends of the range.
  /// @param noise_V  Standard deviation of one sample.
  std::array<double, kChannels> Expect(std::array<double, kChannels> signal_V, Time start, int n_samples,
                                       double noise_V) const;

 private:
  double AsConverted_V(double voltage_V) const;
  double JitterNoise_V(const BlockCourse& course, std::size_t channel) const;
  int Arriving(int n_samples, int reading) const;
  AdInput InScanOrder(const std::array<double, kChannels>& level_V, Time start) const;
  void Follow(const BlockCourse& course, AdInput& input) const;
  Acquisition InChannelOrder(const Acquisition& scanned) const;

  std::array<PsdSettings, 2> psd_;
  AdcSettings adc_;
  AmplifierSettings amplifier_;
  std::array<double, kChannels> sensitivity_V_m_;
  SamplingState sampling_;
  std::array<std::size_t, kChannels> scan_;  // channel of each place in the scan
  bool noise_free_;
  std::uint64_t seed_;
  Stream noise_;
  std::vector<FlickerNoise> flicker_;  // one a channel
  SampledCurve non_linearity_V_;       // what the converter adds, over the voltage
};

}  // namespace twinbench::sim
