#pragma once

#include <string>
#include <vector>

#include "twin/benches/rotary_4dof/diagnosis/families.h"
#include "twin/benches/rotary_4dof/diagnosis/rotary_run.h"
#include "twin/diagnose/diagnosis.h"

namespace twinbench::diagnose::rotary {

/// A run of the rotary bench with its candidates. Families point into it, so it does not move.
class RotaryCase {
 public:
  /// @param about  Effects of known bench properties, one parameter each: the run and its candidates are linearised
  ///               with them in the model, and the residual is what their tangents there leave without them. So an
  ///               amplitude of theirs still counts from zero, however much the model bends on the way.
  RotaryCase(const std::vector<Reading>& readings, const Scenario& scenario, const ForwardModel& model,
             const std::vector<std::string>& excluded, const std::vector<EffectSettings>& about = {});
  RotaryCase(const RotaryCase&) = delete;
  RotaryCase& operator=(const RotaryCase&) = delete;

  const RotaryRun& Rotary() const { return rotary_; }
  const std::vector<Family>& Families() const { return families_; }

 private:
  void TakeOut(const EffectSettings& effect);

  RotaryRun rotary_;
  std::vector<Family> families_;
};

/// Which separated error moves most if a signature of this size hides in the data: "target ez up to 0.4 arcsec
/// rms".
/// @param unknowns  Change of the unknowns.
std::string BiasInWords(const separate::Design& design, const Eigen::VectorXd& unknowns);

}  // namespace twinbench::diagnose::rotary
