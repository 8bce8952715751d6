#pragma once

#include <array>
#include <vector>

#include "twin/core/reading.h"
#include "twin/core/time.h"

namespace twinbench::sim {

/// What reaches the A/D converter in the course of one block: the channels' voltages at equally spaced knots,
/// cubics through four neighbouring knots between them.
///
/// With 16 knots a period a sine is met to 6e-4 of its amplitude (error of cubic interpolation,
/// 3/128 (omega h)^4).
class BlockCourse {
 public:
  using Voltages = std::array<double, kChannels>;

  static constexpr double kKnotsAPeriod = 16.0;

  /// @param step   Between knots; positive.
  /// @param knots  How many are expected.
  explicit BlockCourse(Duration step, int knots = 0) : step_s_(ToSeconds(step)) {
    knots_V_.reserve(static_cast<std::size_t>(knots));
  }
  /// Nothing changes.
  explicit BlockCourse(const Voltages& level_V) : step_s_(1.0) { Add(level_V); }

  void Add(const Voltages& knot_V) { knots_V_.push_back(knot_V); }

  /// @param t_s  Since the first knot; may lie a little outside of the knots.
  double At_V(std::size_t channel, double t_s) const;

  /// Mean of the knots, with half the weight for the first and the last one.
  double Mean_V(std::size_t channel) const;

  Voltages Means_V() const;

  /// Slope of the chord from the first knot to the last one.
  double Slope_V_s(std::size_t channel) const;

  /// Root mean square of the slope.
  double RmsSlope_V_s(std::size_t channel) const;

  /// Every voltage becomes `curve(voltage)`.
  template <class Curve>
  void Bend(Curve curve) {
    for (Voltages& knot_V : knots_V_) {
      for (double& voltage_V : knot_V) voltage_V = curve(voltage_V);
    }
  }

  /// Comes to the knots, one after the other: `added(channel)`.
  template <class Added>
  void Stir(Added added) {
    for (Voltages& knot_V : knots_V_) {
      for (std::size_t c = 0; c < kChannels; ++c) knot_V[c] += added(c);
    }
  }

  /// Whether no channel is anywhere further than this from its mean or, for IsStraight, from its chord.
  bool IsLevel(double within_V) const;
  bool IsStraight(double within_V) const;

  int Steps() const { return static_cast<int>(knots_V_.size()) - 1; }
  double Duration_s() const { return step_s_ * Steps(); }

 private:
  double step_s_;
  std::vector<Voltages> knots_V_;
};

/// How many steps a block is cut into where its fastest content has this period (infinite: nothing is fast), and no
/// more than `most`.
int StepsOf(Duration block, double shortest_s, int most);

}  // namespace twinbench::sim
