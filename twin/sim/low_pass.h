#pragma once

#include <optional>

#include "twin/core/stream.h"
#include "twin/sim/block_course.h"

/// An amplifier of one pole between the light and the A/D converter.
namespace twinbench::sim {

/// Response 1 / (1 + i f / corner): a step is followed as 1 - exp(-t / lag), a tone keeps
/// 1 / sqrt(1 + (f / corner)^2) of its amplitude.
class LowPass {
 public:
  /// @param corner_Hz  0: all passes.
  explicit LowPass(double corner_Hz) : corner_Hz_(corner_Hz) {}

  bool PassesAll() const { return corner_Hz_ == 0.0; }
  /// Time constant; 0 where all passes.
  double Lag_s() const;
  /// Of the rectangular band that lets as much white noise through: pi / 2 of the corner.
  double NoiseBand_Hz() const;

  /// After which e^-30 is left of whatever was before.
  double Memory_s() const { return kLongAgo_lags * Lag_s(); }

  /// What comes out in the course of a block, at knots this far apart; exact where the input is straight between
  /// them.
  /// @param steps   Of the output, positive.
  /// @param before  What came in until the block begins, its last knot; where it begins the pole is where the mean
  ///                of it is. Without: the block's own course turned about its first value is taken for it, which
  ///                is right for what is level or straight; of a tone of amplitude 1 the output then begins up to
  ///                2 x^2 / (1 + x^2) beside where it was, x = f / corner, and the block's mean is wrong by lag
  ///                over block of that.
  BlockCourse Passed(const BlockCourse& course, Duration step, int steps,
                     const std::optional<BlockCourse>& before = std::nullopt) const;

 private:
  static constexpr double kLongAgo_lags = 30.0;

  double corner_Hz_;
};

/// White noise behind one pole, at equally spaced instants: normal, correlated by exp(-step / lag) from one to the
/// next, stationary from the first on.
class PoledNoise {
 public:
  PoledNoise(double standard_deviation, double step_s, double lag_s);
  double Next(Stream& stream);

 private:
  double standard_deviation_, kept_;
  double now_ = kNaN;
};

}  // namespace twinbench::sim
