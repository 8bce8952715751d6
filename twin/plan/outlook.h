#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "twin/uncertainty/quantities.h"

namespace twinbench::plan {

/// Results of one kind: "separation.target.ez_arcsec", at all positions.
struct Certainty {
  std::string name;
  std::size_t values = 0;
  double rms_u = 0.0, worst_u = 0.0;
};

/// How well the orders of one curve would be known, whatever their phase.
struct HarmonicCertainty {
  std::string name;  // "separation.target.ez_arcsec"
  std::vector<int> orders;
  std::vector<double> u;  // in the unit of the name; NaN: not determined
};

/// What a run would give.
struct Outlook {
  int readings = 0;
  double minutes = 0.0;  // by the procedure's own clock
  double dof = 0.0;      // that are left when all is fitted; NaN if the bench does not say
  std::vector<Certainty> results;
  std::vector<HarmonicCertainty> harmonics;  // of those results that are curves
  std::vector<std::string> not_separable;    // in words: what, and why
  std::vector<std::string> lost;             // what alone: "target dy"
  bool separates = false;                    // there is something to be separated in such a run
};

/// From the results of a run of the twin, which has the noise that the scenario states.
/// @param last_s  Time of its last reading.
Outlook OutlookOf(const nlohmann::json& results, int readings, double last_s);

/// The first, with the mean variances of several runs of the same scenario: where an evaluation takes the noise from
/// the readings, one run's uncertainties scatter by themselves.
Outlook MeanOf(const std::vector<Outlook>& runs);

/// The largest relative difference of rms uncertainties between two runs of the same scenario. Phases do not count, here and below: theirs go with
/// amplitudes that may be mere noise, and never settle.
double LargestDifference(const Outlook& a, const Outlook& b);

/// How well MeanOf is known by the scatter of the runs: the largest relative standard deviation of the mean of a result's rms uncertainty.
/// @param runs  Two at least.
double UncertaintyOfMean(const std::vector<Outlook>& runs);

}  // namespace twinbench::plan
