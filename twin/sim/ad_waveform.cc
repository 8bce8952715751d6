#include "twin/sim/ad_waveform.h"

#include <cmath>

#include "twin/core/errors.h"

namespace twinbench::sim {
namespace {

double Extra(const ChannelInput& channel, double t_s) {
  const double extra_V = channel.extra_V ? channel.extra_V(t_s) : 0.0;
  Require(std::isfinite(extra_V), "an A/D channel's extra voltage is finite");
  return extra_V;
}

}  // namespace

Waveform::Waveform(const AdcSettings& adc, const AdInput& input) : input_(input), dt_s_(1.0 / adc.rate_Hz) {
  bool has_slope = false;
  for (std::size_t k = 0; k < kChannels; ++k) {
    const ChannelInput& channel = input.channel[k];
    level_V_[k] = channel.level_V;
    slope_V_s_[k] = channel.slope_V_s;
    crosstalk_[k] = channel.crosstalk;
    has_slope = has_slope || channel.slope_V_s != 0.0;
    has_extra_ = has_extra_ || channel.extra_V;
  }
  is_constant_ = input.hum.amplitude_V == 0.0 && !has_slope && !has_extra_;
}

portable::Rotation Waveform::HumAt(std::int64_t conversion) const {
  const double t_s = static_cast<double>(conversion) * dt_s_;
  return portable::Turn(input_.hum.frequency_Hz * t_s + input_.hum.phase_rad / (2.0 * portable::kPi));
}

/// v of the last channel just before the scan that `first` opens.
double Waveform::BeforeScan(std::int64_t first) const {
  const ChannelInput& last = input_.channel[kChannels - 1];
  const double t_s = static_cast<double>(first - 1) * dt_s_;
  const double hum_V = input_.hum.amplitude_V == 0.0 ? 0.0 : input_.hum.amplitude_V * HumAt(first - 1).sine;
  return last.level_V + last.slope_V_s * t_s + hum_V + Extra(last, t_s);
}

void Waveform::FillRamps(std::int64_t first, std::span<double> v_V) const {
  for (std::size_t i = 0; i < v_V.size(); i += kChannels) {
    const double scan = static_cast<double>(first + static_cast<std::int64_t>(i));
    for (std::size_t k = 0; k < kChannels; ++k) {
      v_V[i + k] = level_V_[k] + slope_V_s_[k] * ((scan + static_cast<double>(k)) * dt_s_);
    }
  }
}

/// One phasor a channel, turned on from scan to scan; starting afresh with every call keeps them exact.
void Waveform::AddHum(std::int64_t first, std::span<double> v_V) const {
  const portable::Rotation turn = portable::Turn(input_.hum.frequency_Hz * kChannels * dt_s_);
  PerChannel cosine, sine;
  for (std::size_t k = 0; k < kChannels; ++k) {
    const portable::Rotation start = HumAt(first + static_cast<std::int64_t>(k));
    cosine[k] = input_.hum.amplitude_V * start.cosine;
    sine[k] = input_.hum.amplitude_V * start.sine;
  }
  for (std::size_t i = 0; i < v_V.size(); i += kChannels) {
    for (std::size_t k = 0; k < kChannels; ++k) {
      v_V[i + k] += sine[k];
      const double next = sine[k] * turn.cosine + cosine[k] * turn.sine;
      cosine[k] = cosine[k] * turn.cosine - sine[k] * turn.sine;
      sine[k] = next;
    }
  }
}

void Waveform::AddExtra(std::int64_t first, std::span<double> v_V) const {
  for (std::size_t i = 0; i < v_V.size(); ++i) {
    const double t_s = static_cast<double>(first + static_cast<std::int64_t>(i)) * dt_s_;
    v_V[i] += Extra(input_.channel[i % kChannels], t_s);
  }
}

/// From the end to the start, so that the conversion before is still without its own crosstalk.
void Waveform::AddCrosstalk(double before_V, std::span<double> v_V) const {
  for (std::size_t i = v_V.size() - kChannels; i > 0; i -= kChannels) {
    for (std::size_t k = kChannels; k-- > 0;) v_V[i + k] += crosstalk_[k] * v_V[i + k - 1];
  }
  for (std::size_t k = kChannels - 1; k > 0; --k) v_V[k] += crosstalk_[k] * v_V[k - 1];
  v_V[0] += crosstalk_[0] * before_V;
}

void Waveform::Fill(std::int64_t first, std::span<double> y_V) const {
  FillRamps(first, y_V);
  if (input_.hum.amplitude_V != 0.0) AddHum(first, y_V);
  if (has_extra_) AddExtra(first, y_V);
  const bool has_crosstalk = crosstalk_ != PerChannel{};
  if (has_crosstalk) AddCrosstalk(BeforeScan(first), y_V);
}

}  // namespace twinbench::sim
