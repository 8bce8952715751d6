#pragma once

#include <vector>

#include "twin/diagnose/engine/linear_run.h"

/// Which readings are held out together, and which are drawn together.
namespace twinbench::diagnose {

/// Which readings are predicted together from all others.
///
/// Fold k leaves out the k-th full-circle pass of every set-up that has more than one, so that tables and mountings
/// stay determined and neighbours, which share their drift, stay together. Of the other phases, and of full circles
/// where no set-up has a second pass, it leaves out every fourth (n-th, of n folds) block of six consecutive
/// readings: what a sweep shows is predicted from the rest of the sweeps. Of a calibration in which the
/// target itself moves, by fewer than 24 steps, it leaves out every fourth reading by itself. Circles that follow
/// each other begin with different folds, so that none leaves out the same positions as the one before.
struct Folds {
  std::vector<int> of_reading;  // one a reading; -1: always in the fit
  int count = 0;
};
Folds MakeFolds(const Schedule& schedule);

/// Every fourth block of six consecutive readings, whatever pass they belong to.
Folds FoldsOfTime(const Schedule& schedule);

/// The number of the block that each reading belongs to, from 0 without gaps: six consecutive readings of a set-up
/// and pass, whose noise may be alike; of such a short sweep each reading alone.
std::vector<int> BlocksOfReadings(const Schedule& schedule);

}  // namespace twinbench::diagnose
