#include "mechanics/encoder_signal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/mechanics/test_units.h"

namespace twinbench::mechanics {
namespace {

SignalState Faults() {
  return {.offset_sin = 0.1, .offset_cos = -0.15, .ratio = 0.2, .quadrature_rad = 0.3};
}

TEST(EncoderSignal, FindsThePhaseThatShowsAnAngle) {
  for (const double clip : {HUGE_VAL, 1.0, 0.8}) {
    SignalState state = Faults();
    state.clip_level = clip;
    for (double p = -20.0; p < 20.0; p += 0.317) {
      const double shown = p + SignalError_rad(state, p);
      const double found = PhaseShowing_rad(state, shown);
      // Where both are clipped many phases show the same; elsewhere slopes reach 3, and phases 20.
      EXPECT_NEAR(found + SignalError_rad(state, found), shown, 1e-13) << p << " clipped at " << clip;
      if (clip == HUGE_VAL) {
        EXPECT_NEAR(found, p, 1e-13);
      }
    }
  }
}

TEST(InterpolatedSignal, OfGoodSignalsCutsALineIntoEqualSteps) {
  const InterpolatedSignal signal({}, 1000, 20);
  EXPECT_DOUBLE_EQ(signal.Step_rad(), 2.0 * kPi / 20000.0);
  for (const int step : {-20001, -1, 0, 7, 20000, 123456}) {
    EXPECT_EQ(signal.Steps((step + 0.01) * signal.Step_rad()), step);
    EXPECT_EQ(signal.Steps((step + 0.99) * signal.Step_rad()), step);
    EXPECT_NEAR(signal.FallingEdge_rad(step, 1), (step + 0.5) * signal.Step_rad(), 1e-14);
    EXPECT_NEAR(signal.FallingEdge_rad(step, -1), step * signal.Step_rad(), 1e-14);
  }
}

TEST(InterpolatedSignal, FallsWhereHighGivesWayToLowInEitherDirection) {
  const InterpolatedSignal signal(Faults(), 500, 8);
  // High in the first half of a step, by what the signals show.
  const auto high = [&](double scale) {
    const double steps = signal.Shown_rad(scale) / signal.Step_rad();
    return steps - std::floor(steps) < 0.5;
  };
  const double little = 1e-9 * signal.Step_rad();
  for (int step = -40; step < 40; ++step) {
    for (const int way : {1, -1}) {
      const double edge = signal.FallingEdge_rad(step, way);
      EXPECT_TRUE(high(edge - way * little)) << step;
      EXPECT_FALSE(high(edge + way * little)) << step;
    }
  }
}

TEST(InterpolatedSignal, EdgesOfWholeLinesAreRegularWhateverTheFaults) {
  const InterpolatedSignal signal(Faults(), 500, 1);
  const double first = signal.FallingEdge_rad(0, 1);
  EXPECT_GT(std::abs(first - 0.5 * signal.Step_rad()), 1e-4 * signal.Step_rad());
  // The faults repeat with the lines: an output of one period a line has them in its zero only.
  for (int step = 1; step < 2000; step += 37)
    EXPECT_NEAR(signal.FallingEdge_rad(step, 1) - first, step * signal.Step_rad(), 1e-13) << step;
}

TEST(InterpolatedSignal, NextEdgeLiesAheadAndNoneIsLeftOut) {
  const InterpolatedSignal signal(Faults(), 500, 8);
  for (const int way : {1, -1}) {
    double scale = -0.02;
    std::int64_t step = signal.NextFallingStep(scale, way);
    for (int i = 0; i < 100; ++i) {
      const double edge = signal.FallingEdge_rad(step, way);
      EXPECT_GT(way * (edge - scale), 0.0);
      EXPECT_LE(way * (signal.FallingEdge_rad(step - way, way) - scale), 0.0);
      scale = edge;  // exactly on an edge: the next one
      EXPECT_EQ(signal.NextFallingStep(scale, way), step + way);
      step += way;
    }
  }
}

TEST(InterpolatedSignal, RefusesSignalsThatDoNotGoRoundTheOrigin) {
  for (const SignalState& state : {SignalState{.ratio = -1.0}, SignalState{.quadrature_rad = 1.6},
                                   SignalState{.offset_sin = 0.8}, SignalState{.offset_cos = std::nan("")},
                                   SignalState{.clip_level = 0.0}})
    EXPECT_THROW(InterpolatedSignal(state, 100, 1), std::invalid_argument);
  EXPECT_THROW(InterpolatedSignal({}, 0, 1), std::invalid_argument);
  EXPECT_THROW(InterpolatedSignal({}, 100, 0), std::invalid_argument);
}

}  // namespace
}  // namespace twinbench::mechanics
