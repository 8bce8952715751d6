#pragma once

#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "twin/benches/circular_motion/columns.h"
#include "twin/benches/circular_motion/twin/machine.h"
#include "twin/core/reading.h"
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

/// The machine on the course of a run and the instruments on it, without noise. What is shown is the radial and
/// tangential deviation from the commanded point (see columns.h).
class CircleTwin {
 public:
  /// @param course   With angles, in order.
  /// @param above_K  One temperature a reading, above that of reference.
  CircleTwin(const Scenario& scenario, const std::vector<Reading>& course, const Eigen::VectorXd& above_K);

  benches::circular::Deviation At(std::size_t i, const CircleExtra& extra) const;

  /// Where the spindle was, from the commanded centre.
  Eigen::Vector2d Position_m(std::size_t i, double latency_s = 0.0) const;

 private:
  bool IsBar(const Reading& r) const;
  CircleInstant InstantOf(std::size_t i) const;
  Eigen::Vector2d Moved_m(std::size_t i) const;
  benches::circular::Deviation Bar(std::size_t i, const CircleExtra& extra) const;
  benches::circular::Deviation Grid(std::size_t i, const CircleExtra& extra) const;
  void AddSignals(std::size_t i, benches::circular::Deviation& shown) const;

  Scenario scenario_;
  CircularSettings settings_;
  CircleMachine machine_;
  std::vector<Reading> course_;
  Eigen::VectorXd above_K_;
  std::map<std::size_t, Eigen::VectorXd> lagged_K_;  // by number of the effect: temperature that it follows
  std::vector<model::Product> signals_;
  EmpiricalSignal radial_, tangential_;
};

}  // namespace twinbench::sim
