#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "twin/plan/next_run.h"

namespace twinbench::plan {

/// Results of one kind when another run has been made as well.
struct Gain {
  std::string name;    // "separation.target.ez_arcsec"
  double ratio = 1.0;  // rms u of both runs together over that of the first
  double precision = 0.0;        // that is added to what is not shared by all runs, in units of 1 / u^2 of the first
  double precision_before = 0.0; // that the first has of it; 0: all its uncertainty is shared
};

/// Of the kinds that both documents determine. At each place the inverse variances of runs add up, of what each has anew (uncertainty::OwnShare);
/// what all runs share (a standard's own error) stays. Results of one mounting are others in another run and are no
/// kind; what only all readings together would tell is left out.
/// @param wanted  Kinds whose name ends so ("target.ez", with or without its unit); empty: all.
std::vector<Gain> GainsOf(const nlohmann::json& before, const nlohmann::json& more, const std::string& wanted);
/// The same when several others have been made: of the kinds that any of them determines.
std::vector<Gain> GainsOf(const nlohmann::json& before, const std::vector<const nlohmann::json*>& more, const std::string& wanted);

/// -log2 of the ratio, the mean over all kinds [bit]; 0 without any.
double MeanGain_bit(const std::vector<Gain>& gains);

/// A run that could be made after (or instead of) the scenario's own, and what that buys.
struct Advice {
  NextRun run;
  int readings = 0;
  double minutes = 0.0;
  std::vector<Gain> gains;           // of results
  std::vector<std::string> mended;   // what the scenario's own run cannot separate, and this one can
  std::vector<std::string> broken;   // "psd_roll at psd_a | psd_roll at psd_b": told apart here in some plausible size
  std::vector<std::string> shown;    // causes that only this run would find in a plausible size
  double of_results_bit = 0.0;       // MeanGain_bit
  double of_causes_bit = 0.0;        // about the sizes of all causes, beyond the scenario's own run
  double closest = 0.0;              // T-optimality: distance of the two causes that are most alike [sigma], both runs
  std::string causes_unknown = {};   // why nothing is known of what it tells of causes; empty: it is

  /// What counts as bought: bits of both kinds, and a bit for each thing that could not be told at all before.
  double BoughtOfResults_bit() const { return of_results_bit + static_cast<double>(mended.size()); }
  double Bought_bit() const {
    return BoughtOfResults_bit() + of_causes_bit + static_cast<double>(broken.size() + shown.size());
  }
  /// Whether what it buys is known whole.
  bool IsWhole() const { return causes_unknown.empty(); }
};

/// Of what a run buys [bit/min]: all, or of results alone where that is all that is known of some run, so that none is put
/// behind another for what was not computed.
double RateOf(const Advice& one, const std::vector<Advice>& among);

/// Those that buy most per minute first.
void Rank(std::vector<Advice>& advice);

}  // namespace twinbench::plan
