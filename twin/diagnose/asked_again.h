#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "twin/core/effect_catalogue.h"
#include "twin/core/scenario.h"
#include "twin/diagnose/diagnosis.h"
#include "twin/diagnose/engine/projector.h"

/// Large causes are no sum of signatures: a late reading of clipped signals errs by neither alone. What the search
/// found to first order is therefore fitted once more, all of it together, by asking the twin.
namespace twinbench::diagnose {

/// What the twin shows more than without any of these effects, by row [SI].
using Shows = std::function<Eigen::VectorXd(const std::vector<EffectSettings>& effects)>;

/// Effects whose parameters are moved until the twin shows the readings.
struct AskedAgain {
  std::vector<EffectSettings> effects;
  Eigen::VectorXd left;    // of the rows, the free unknowns not yet taken out
  Eigen::MatrixXd slopes;  // rows x free parameters
  Eigen::VectorXd sd;      // by free parameter: what was thought of it beforehand, SI
  double power = 0.0;      // of what is left, whitened and projected; rows far off do not count
  int far = 0;             // rows that do not
};

/// A parameter that may move: which effect, and its name.
struct Movable {
  std::size_t effect;
  std::string parameter;
  double sd;  // SI, of its first guess
};

/// @param effects    As guessed, all their parameters filled in.
/// @param movable    Values stay within the bounds of `catalogue`.
/// @param rows       What the effects have to show, SI.
/// @param sigma      Of the rows.
/// @param projector  Takes the free unknowns out of rows divided by sigma.
/// Fills in `finding.u` of the effects.
AskedAgain AskAgain(const Shows& shows, std::vector<EffectSettings> effects, const std::vector<Movable>& movable,
                    const std::vector<EffectEntry>& catalogue, const Eigen::VectorXd& rows,
                    const Eigen::VectorXd& sigma, const Projector& projector);

}  // namespace twinbench::diagnose
