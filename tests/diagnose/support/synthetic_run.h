#pragma once

#include "twin/diagnose/engine/projector.h"
#include "twin/diagnose/screen/screen.h"

/// Small runs whose truth is known because they are made here: no bench, no optics.
namespace twinbench::diagnose {

struct SyntheticDesign {
  int positions = 12;
  std::vector<int> shifts = {0, 1, 5};       // one set-up each, in steps
  std::vector<int> passes = {1, -1, -1, 1};  // directions
  double sigma_m = 0.3e-6;
  bool free_tables = true;  // free functions of target and reference position, channel by channel
  int channels = 4;
  int calibration = 0;  // readings before, which see a constant of their own alone
};

/// One pass of one set-up, all in order, times and angles not known.
Schedule PlainSchedule(int readings);

/// Four channels of two spots (names and patterns; of another count they are the caller's); nuisance: the free tables
/// and a constant a set-up, channel by channel. The spots are spread over +-150 um, dwells over 0.5 to 4 s, the
/// temperature wanders by 1 K. Residual zero.
LinearRun SyntheticRun(const SyntheticDesign& design);

/// Normal deviates.
Eigen::MatrixXd RandomMatrix(const std::string& name, Eigen::Index rows, Eigen::Index columns);

/// Adds white Gaussian noise of the stated deviations.
void AddNoise(LinearRun& run, std::uint64_t seed);

/// Adds f(reading) * weight of the channel to residual and observation.
void AddEffect(LinearRun& run, const Eigen::VectorXd& weight, const std::function<double(int)>& f);

/// One channel of angles against a reference that turns forth and back twice at two speeds, without a stop.
/// Nuisance: a constant. Stated noise 1 arcsec.
LinearRun SyntheticSweep(int readings);

/// The residual tests with the noise as stated.
std::vector<ResidualTest> TestsAsStated(const LinearRun& run, int null_runs, std::uint64_t seed);

Projector ProjectorOf(const LinearRun& run, const NoiseModel& noise);

/// @return nullptr if there is no test with that name.
const ResidualTest* Find(const std::vector<ResidualTest>& tests, const std::string& name);

}  // namespace twinbench::diagnose
