#pragma once

#include <vector>

#include "tests/foreign/dice.h"

/// Courses of an angle comparison, off every grid.
namespace twinbench::foreign {

inline constexpr double kDegree = M_PI / 180.0;

/// One reading of an angle device and where the shaft is.
struct Instant {
  double t_s = 0.0, angle_deg = 0.0, speed_deg_s = 0.0;
  int direction = 1, pass = 0, position = 0;
  double temperature_degC = 20.0;
  double travelled_deg = 0.0;  // since the start, either way
  double since_reversal_deg = 0.0,
         since_reversal_s = 0.0;  // travel and time; before the first one: since the start
  int sense = 1;                  // of the last motion, at rest too
};
using Track = std::vector<Instant>;

/// What two runs of one machine have in common.
struct AngleDesign {
  bool in_motion = false;
  double stops_per_turn = 60.0, turns = 2.0, start_deg = 0.0;
  std::vector<int> passes = {1, -1, -1, 1};
  double interval_s = 4.0;                          // between readings, on average
  std::vector<double> speeds_deg_s = {40.0, 15.0};  // of the passes in turn
  double jitter = 0.3;                              // of stops and intervals, share of a step
};
AngleDesign DrawStops(Dice& dice);
AngleDesign DrawMotion(Dice& dice);

/// One run: another seed, other stops and times, and a little more or less of them.
Track DrawTrack(const AngleDesign& design, Dice& dice);

double Duration_s(const Track& track);

}  // namespace twinbench::foreign
