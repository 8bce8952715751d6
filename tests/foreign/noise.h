#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "tests/foreign/dice.h"

namespace twinbench::foreign {

/// What the noise of a run is like, and what happens to readings behind it.
struct NoiseShape {
  std::string name;
  double size = 1.0;                // over what the bench states, or its usual size
  double degrees_of_freedom = 0.0;  // of Student's t; 0: Gaussian
  double correlation = 0.0;         // of neighbouring readings
  double step = 0.0;                // of a quantiser, in usual sizes; 0: none
  double missing = 0.0;             // share of the readings that are lost
};

/// The ways in which runs with nothing wrong are put under stress.
inline std::vector<NoiseShape> Stresses() {
  std::vector<NoiseShape> all = {{"noise x 0.5", 0.5},
                                 {"noise x 2", 2.0},
                                 {"Student t, 3 dof", 1.0, 3.0},
                                 {"AR(1) 0.5", 1.0, 0.0, 0.5},
                                 {"rows missing", 1.0, 0.0, 0.0, 0.0, 0.15}};
  for (const double step : {0.5, 2.0, 5.0, 20.0})
    all.push_back(
        {"quantised at " + std::to_string(step).substr(0, step < 10.0 ? 3 : 4) + " sigma", 1.0, 0.0, 0.0, step});
  return all;
}

/// One channel's noise, in usual sizes, reading by reading.
class NoiseSeries {
 public:
  NoiseSeries(NoiseShape shape, Dice dice) : shape_(std::move(shape)), dice_(std::move(dice)), last_(Fresh()) {}
  double Next() {
    const double r = shape_.correlation;
    last_ = r * last_ + std::sqrt(1.0 - r * r) * Fresh();
    return shape_.size * last_;
  }

 private:
  /// Student's t as it is, not brought to a variance of one: its middle is as wide as that of the normal noise.
  double Fresh() {
    return shape_.degrees_of_freedom > 0.0 ? dice_.Student(shape_.degrees_of_freedom) : dice_.Normal();
  }
  NoiseShape shape_;
  Dice dice_;
  double last_;
};

inline double Quantised(double value, double step) {
  return step > 0.0 ? step * std::round(value / step) : value;
}

}  // namespace twinbench::foreign
