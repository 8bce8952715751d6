#pragma once

#include "tests/hidden/twin_cases.h"
#include "twin/diagnose/isolability.h"

/// What a plan claims, held against runs of the twin: for the tests, and for the score that is run by hand.
namespace twinbench::plan {

/// Two causes that a diagnosis did not tell apart, or took for each other.
struct BlamedPair {
  std::string present, blamed;
  bool foretold = false;  // by the plan, at the size that was hidden
};

/// One cause hidden in a twin and diagnosed.
struct TieCase {
  std::string truth;
  std::vector<BlamedPair> pairs;  // empty: named alone, not found, or said to have no name
  std::string verdict;
};

/// @param foretold  Of the believed scenario's own run.
TieCase DiagnoseHidden(const hidden::Placement& at, std::uint64_t seed, double rho, const hidden::SignatureScale& scale,
                       const diagnose::Isolability& foretold);

/// Whether `blamed` may be taken for `present` in whatever shape, of so many times the smallest size that is found in
/// that shape.
bool MayBeBlamed(const diagnose::Isolability& foretold, std::size_t present, std::size_t blamed, double times);

/// Isolability of what is believed of a design, on the quickest twin.
diagnose::Isolability ForetoldOf(hidden::Design design);

/// The size of a cause that is found in 80 % of runs at a test of 0.1 %, by many runs of the twin, over the one that the
/// plan says.
struct SizeCheck {
  std::string cause;
  double ratio = 0.0;  // NaN: the twin shows nothing of it
};

/// With noise of so many runs each: t = s'Wy / sqrt(s'Ws) of the twin's own signature s in the size of the plan has a
/// mean of sqrt(s'Ws) and some standard deviation; a size that is found so often makes the mean 4.13 of those. Constants
/// that the diagnosis of rotary_4dof allows for (gains, distances, wavelength) are drawn in every run as it believes them.
/// @param effects  Of these alone; empty: of all.
std::vector<SizeCheck> CheckSizes(const Scenario& scenario, int runs, const std::vector<std::string>& effects = {});

}  // namespace twinbench::plan
