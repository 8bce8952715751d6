#pragma once

#include "twin/diagnose/engine/search.h"

/// Whether a term of the search holds as what its family is called.
namespace twinbench::diagnose {

/// What a term is judged beside.
struct Beside {
  const LinearRun& run;
  const NoiseModel& noise;
  const Projector& projector;
  const Deflation& others;
  const Projected& data;  // one run, projected, with `others` taken out
};

/// No shape that has to be is on its bound.
bool IsInside(const Family& family, const Eigen::VectorXd& shape);

/// The size of a named cause is some standard uncertainties from zero, with its shape free: what is left without
/// the amplitudes, the slopes of the shape kept, beside what is left with them.
bool IsThere(const Family& family, const Term& term, const Beside& beside);

/// A single event in time; many of them are the pieces of a course.
bool IsEvent(const Family& family);

/// A step happens from one reading to the next: one that goes on over several of them explains no more. True too of what
/// is no step.
bool IsSudden(const Family& family, const Term& term, const Beside& beside);

}  // namespace twinbench::diagnose
