#pragma once

#include <array>
#include <span>

#include "twin/core/bench_format.h"
#include "twin/core/scenario.h"
#include "twin/core/units.h"

namespace twinbench::model {

/// What a twin knows at the instant of a reading and a signal may depend on.
struct Instant {
  double time_s = 0.0;
  double averaged_s = 0.0;  // over which a mean about time_s is asked for; 0: that very instant
  double lag_s = 0.0;       // of a pole that all has passed; time_s is earlier by as much
  int reading = 0;
  double direction = 0.0;             // +1, -1: sense of the motion, at rest of the last one
  double velocity_rad_s = 0.0;        // while it is read
  double above_K = 0.0;               // temperature above environment.reference_degC
  std::array<double, 2> angle_rad{};  // of the bench's angles (BenchFormat::angles), unwrapped
};

/// An [[effect]] block "signal": what it adds to one channel at any instant. Without a memory, so that the live
/// twin and the one that follows a record agree whatever came before.
class Product {
 public:
  /// @param effect  Checked by the scenario's loader.
  Product(const EffectSettings& effect, const BenchFormat& bench);

  /// Index in BenchFormat::points.
  int Channel() const { return channel_; }

  /// Period of a tone; infinite for what changes with the bench alone.
  double Shortest_s() const;

  /// SI of the channel.
  /// @param shown  What each channel shows without signals, SI.
  double At(const Instant& instant, std::span<const double> shown) const;

 private:
  double Course(const Instant& instant, std::span<const double> shown) const;
  double Factor(const Instant& instant) const;
  double Of(const char* parameter) const;

  EffectSettings effect_;
  int channel_, by_ = 0;
};

}  // namespace twinbench::model
