#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "twin/diagnose/engine/base.h"
#include "twin/diagnose/engine/family.h"
#include "twin/diagnose/engine/wave_series.h"
#include "twin/model/course.h"

/// Tones and steps, on grids by what a course can tell: the largest families of a search, which named causes and
/// structure without a name share.
namespace twinbench::diagnose {

/// Numbers of readings at which something may begin: within a set-up and phase, because a step at its first reading
/// is a constant of it. Thinned evenly where there are very many.
struct Onsets {
  std::vector<double> at_reading;
  bool are_thinned = false;
};
Onsets OnsetsOf(const model::Course& course);

struct TimeSeries {
  Eigen::VectorXd time_s;
  std::vector<int> reading;  // its number
  std::vector<int> stretch;  // a label: within one value something in time goes on undisturbed
  std::vector<double> frequencies_Hz, onsets;
  bool are_thinned = false;           // there are more onsets
  std::shared_ptr<const Base> tones;  // [cos, sin] in each stretch; null if there is no room
  std::shared_ptr<const Base> steps;  // null if there is none

  Shape Frequency(const std::string& name) const;
  /// Between the points of the grid: samples x (2 x stretches).
  Eigen::MatrixXd ToneAt(double frequency_Hz) const;
  Eigen::MatrixXd StepAt(double at_reading) const;
};

/// @param rows_time_s  Times of the rows, where they are not the samples: they say how fast a tone may be.
TimeSeries TimeSeriesOf(const model::Course& course, const std::vector<int>& stretch, int channels,
                        const ToRows& rows = {}, const Eigen::VectorXd& rows_time_s = {});

/// Time since the first sample with the same label [s].
Eigen::VectorXd SinceBegin_s(const Eigen::VectorXd& time_s, const std::vector<int>& label);

}  // namespace twinbench::diagnose
