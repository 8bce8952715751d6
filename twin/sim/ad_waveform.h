#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "twin/core/stream_kernel_math.h"
#include "twin/sim/ad_sampler.h"

namespace twinbench::sim {

/// The channel whose conversion comes before that of `channel`.
constexpr std::size_t ChannelBefore(std::size_t channel) {
  return (channel + kChannels - 1) % kChannels;
}

/// The voltages of one block before noise, conversion by conversion. Private to ad_sampler.cc. Refers to `input`.
class Waveform {
 public:
  Waveform(const AdcSettings& adc, const AdInput& input);

  /// @return whether every scan of the block is the same.
  bool IsConstant() const { return is_constant_; }

  /// Fills `y_V`, whole scans, with v + crosstalk * v of the conversion before, from conversion `first` on, which
  /// opens a scan.
  void Fill(std::int64_t first, std::span<double> y_V) const;

 private:
  using PerChannel = std::array<double, kChannels>;

  portable::Rotation HumAt(std::int64_t conversion) const;
  double BeforeScan(std::int64_t first) const;
  void FillRamps(std::int64_t first, std::span<double> v_V) const;
  void AddHum(std::int64_t first, std::span<double> v_V) const;
  void AddExtra(std::int64_t first, std::span<double> v_V) const;
  void AddCrosstalk(double before_V, std::span<double> v_V) const;

  const AdInput& input_;
  double dt_s_;
  PerChannel level_V_, slope_V_s_, crosstalk_;
  bool has_extra_ = false;
  bool is_constant_ = false;
};

}  // namespace twinbench::sim
