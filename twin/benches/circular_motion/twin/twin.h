#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "twin/benches/circular_motion/columns.h"
#include "twin/benches/circular_motion/twin/bodies.h"
#include "twin/benches/circular_motion/twin/machine.h"
#include "twin/core/reading.h"
#include "twin/model/follow.h"
#include "twin/model/product.h"
#include "twin/sim/empirical_signal.h"

namespace twinbench::sim {

/// What is added to one reading: by its set-up, by disturbances, by chance.
struct CircleExtra {
  double offset_x_m = 0.0, offset_y_m = 0.0;  // of the commanded centre, as bar or grid sees it
  double rotation_rad = 0.0;                  // of the encoder's zero, or of the grid
  double length_m = 0.0;                      // of the bar
  double x_m = 0.0, y_m = 0.0;                // of the spindle against the table
  double radial_m = 0.0, tangential_m = 0.0;  // of what is shown
};

/// What the twin needs of a reading: taken from its columns once.
struct CircleStep {
  CircleInstant at;
  int reading = 0, setup = 0, pass = 0;
  double time_s = 0.0, velocity_rad_s = 0.0;
  bool is_bar = true;
};

/// The machine on the course of a run and the instruments on it, without noise. What is shown is the radial and
/// tangential deviation from the commanded point (see columns.h).
class CircleTwin {
 public:
  /// @param course   With angles, in order.
  /// @param above_K  One temperature a reading, above that of reference.
  /// @param bodies   Runs the axes where they are bodies.
  CircleTwin(const Scenario& scenario, const std::vector<Reading>& course, const Eigen::VectorXd& above_K,
             BodiesOnce& bodies);

  /// One reading more at the end of the course.
  void Append(const Reading& reading, double above_K, BodiesOnce& bodies);

  benches::circular::Deviation At(std::size_t i, const CircleExtra& extra) const;

  /// Where the spindle was, from the commanded centre.
  Eigen::Vector2d Position_m(std::size_t i, double latency_s = 0.0) const;

 private:
  void Follow(BodiesOnce& bodies);
  benches::circular::Deviation Bar(std::size_t i, const CircleExtra& extra) const;
  benches::circular::Deviation Grid(std::size_t i, const CircleExtra& extra) const;
  void AddSignals(std::size_t i, benches::circular::Deviation& shown) const;

  CircularSettings settings_;
  AxisPair later_s_ = {};  // by effects: axes that are bodies are then found where they were so much earlier
  CircleMachine machine_;
  std::shared_ptr<const CircleBodies> bodies_;
  std::vector<CircleStep> steps_;
  std::vector<EffectSettings> tones_, moving_;  // moving_: those that make moved_m_
  Eigen::Matrix2Xd moved_m_;  // by effects that follow time or the reading's number
  std::vector<model::Product> signals_;
  EmpiricalSignal radial_, tangential_;
};

/// The circles' twin on the course of a record; the prediction is the radial and tangential deviation from the
/// commanded point [m]. Points: offset_x, offset_y (of the centre, as bar or grid sees it), rotation (of the
/// encoder's zero, or of the grid), length (of the bar), x, y (of the spindle), radial, tangential (of what is
/// shown).
/// @param bodies  Axes that are bodies are run anew only if they are not in it.
std::unique_ptr<model::Follow> FollowCircles(const Scenario& scenario, const std::vector<Reading>& record,
                                             const std::shared_ptr<BodiesOnce>& bodies);

}  // namespace twinbench::sim
