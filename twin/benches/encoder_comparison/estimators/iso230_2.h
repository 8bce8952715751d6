#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "twin/core/reading.h"
#include "twin/core/units.h"

/// How well an axis positions, in the terms of ISO 230-2:2014. Rotary or linear: every number here has the unit of
/// the deviations that were put in, rad or m, so these names carry none. Forward is the positive direction of
/// approach (the standard's arrow up, here also +), backward the negative one (-).
///
/// The formulas are those in common use, confirmed on a published set of data; the text of the standard was not at
/// hand.
namespace twinbench::measure {

/// The deviations at one target position, one a run; as many runs as there are, a direction may have none.
struct PositioningTarget {
  double position = kNaN;
  std::vector<double> forward;
  std::vector<double> backward;
};

/// The runs to one target from one side. The mean needs one run, the rest two.
struct ApproachPositioning {
  int runs = 0;               // n
  double mean = kNaN;         // of the deviations
  double u_mean = kNaN;       // s / sqrt(n), and rounding
  double deviation = kNaN;    // s, standard deviation of one run
  double rounding = 0.0;      // of it, what steps round alike in all runs
  double u_deviation = kNaN;  // s / sqrt(2 (n - 1)), of normal scatter; rounding is no scatter, but hides as much

  double Repeatability() const { return 4.0 * deviation; }  // R_i+ or R_i-
};

/// A value of the axis and what the scatter of the runs does to it.
struct ScatteredValue {
  double value = kNaN;
  double u = kNaN;     // standard uncertainty
  double bias = kNaN;  // about what the scatter adds to a largest or takes from a smallest value; not taken off
};

struct TargetPositioning {
  double position = kNaN;
  ApproachPositioning forward;
  ApproachPositioning backward;
  double mean = kNaN;  // bidirectional
  double u_mean = kNaN;
  double reversal = kNaN;  // B_i, forward - backward
  double u_reversal = kNaN;
  ScatteredValue repeatability;  // R_i, bidirectional
};

/// What the standard states of an axis: reversal B (largest |B_i|) and its mean, repeatability R, systematic error
/// E, mean bidirectional systematic error M, accuracy A.
enum class AxisValue {
  kB,
  kMeanB,
  kRForward,
  kRBackward,
  kR,
  kEForward,
  kEBackward,
  kE,
  kM,
  kAForward,
  kABackward,
  kA
};
inline constexpr int kAxisValues = 12;
inline constexpr std::array<const char*, kAxisValues> kAxisValueNames = {"B",  "mean B", "R+", "R-", "R",  "E+",
                                                                         "E-", "E",      "M",  "A+", "A-", "A"};

struct AxisPositioning {
  std::vector<TargetPositioning> targets;  // in the order they were given
  std::array<ScatteredValue, kAxisValues> axis;

  const ScatteredValue& operator[](AxisValue value) const { return axis[static_cast<std::size_t>(value)]; }
};

/// How the uncertainty of the axis values is found; 2000 replicas give it to 2 %. No replicas: it stays NaN.
struct PositioningBootstrap {
  int replicas = 2000;
  std::uint64_t seed = 1;
};

/// How much a target is out because the device shows steps: alike in all its runs, other at the next target.
/// @param at_once  Readings whose mean a deviation is; `step` is that of one.
struct RunRounding {
  double repeated = 0.0;   // standard uncertainty by what all runs repeat
  double scattered = 0.0;  // and of one run, by what they do not: no less, even if a few runs agree by chance
};
RunRounding RoundingOfTargets(const std::vector<PositioningTarget>& targets, double step, double at_once);

/// Evaluates a test of the axis.
///
/// @param targets   Deviations (actual - commanded position) in one unit, any order, all finite.
/// @param rounding  By steps of the device (RoundingOfTargets).
/// @return every value that the runs give; NaN what needs a direction that some target lacks, or two runs where
///         some target has one.
/// @throws std::logic_error if a deviation is not finite.
///
/// Uncertainty: of means and reversals by propagation. R_i and the axis values are largest and smallest values,
/// which no derivative describes: the test is repeated with random numbers, each target with normal runs about its
/// mean and with its standard deviation; u is the standard deviation of what comes out, bias its mean - value.
/// Where several targets could be the largest, u is on the safe side: with five runs and 8 to 144 targets that
/// scatter alike R has 1.4 to 2.6 times the scatter of real repetitions, A 1.0 to 1.8, B and E 0.9 to 1.6; bias
/// finds half to all of what there is. Not included: all that does not scatter (reference, alignment, temperature:
/// ISO/TR 230-9); runs that drift as a whole, as every target scatters on its own here; that s itself is poorly
/// known from a few runs.
AxisPositioning EvaluatePositioning(const std::vector<PositioningTarget>& targets,
                                    const PositioningBootstrap& bootstrap = {}, const RunRounding& rounding = {});

/// The stops of one set-up of an angle comparison.
struct PositioningStops {
  std::vector<PositioningTarget> targets;  // by rising position; in rad
  int left_out = 0;                        // readings of the set-up in motion, without direction or without a value
  std::vector<std::string> notes;          // stops that are not at one target
};

/// Takes device - reference (turns as in CompareAngles) at each `position`: one run a pass and direction, the mean
/// if a pass has several readings there. The target is where the reference stood in the mean. Positions at one
/// angle are one target (some files number the readings instead of the stops).
PositioningStops PositioningOf(const std::vector<Reading>& readings, int setup);

/// The units of a table for people: of targets, and of what they are missed by.
struct ToldIn {
  std::string coarse_name = "deg";
  double coarse = units::deg;
  std::string fine_name = "arcsec";
  double fine = units::arcsec;
};

/// What a test of a rotary axis lacks of the standard: at least 3 targets for a travel up to 90 deg, 5 up to 180
/// deg and 8 above, and five runs to each target from both sides. Empty: nothing.
///
/// Not checked: uneven spacing of the targets, which the standard wants against periodic errors; more than one
/// turn.
std::vector<std::string> MissingForRotaryAxis(const std::vector<PositioningTarget>& targets, double travel_rad);

/// The same of a linear axis: 5 targets, and 5 a metre up to 2 m of travel.
/// @param told  How the targets are told in messages.
std::vector<std::string> MissingForLinearAxis(const std::vector<PositioningTarget>& targets, double travel_m,
                                              const ToldIn& told);

/// The evaluation as a table for people; "-" is not available.
std::string PositioningText(const AxisPositioning& positioning, const ToldIn& told = {});
/// Of it, the values of the axis alone: for a test with very many targets.
std::string AxisText(const AxisPositioning& positioning, const ToldIn& told = {});

}  // namespace twinbench::measure
