#pragma once

#include <memory>
#include <string>
#include <vector>

#include "twin/benches/encoder_comparison/diagnosis/large_causes.h"

/// Large causes fitted together by asking the twin, beside what the run leaves free.
namespace twinbench::diagnose::encoder {

/// What a cause has to explain beside the others, in units of noise: no chance.
inline constexpr double kBetter = 25.0;
/// Share of what a cause explains to which no device is as its formula: less does not tell one cause from another.
inline constexpr double kAsExact = 1e-4;

/// Causes with their sizes as fitted, and what they leave.
struct FittedCauses {
  std::vector<LargeCause> causes;
  AskedAgain asked;
  double power = 0.0;

  double Costs(double noise) const { return power / noise + kBetter * static_cast<double>(causes.size()); }
};

/// It is there with the others as they are now.
bool IsHeld(const EffectSettings& effect);

std::vector<EffectSettings> EffectsWithout(std::size_t k, const std::vector<EffectSettings>& effects);

/// The parameters of what is in the twin stay free: rows x (what was free, slopes).
void LeaveFree(const AskedAgain& asked, Nuisance& nuisance);

class TwinFit {
 public:
  /// @param large  Whose first search has been made; it may be searched on.
  TwinFit(const LargeCauses& large, const Scenario& scenario, const model::FollowMaker& follow);

  const EncoderRun& Run() const { return large_.first->encoder; }
  const std::vector<Family>& Families() const { return large_.first->families; }
  const Projector& projector() const { return *projector_; }

  Scenario With(const std::vector<EffectSettings>& effects) const;
  /// What the twin shows more with these effects, by row.
  Eigen::VectorXd Shown(const std::vector<EffectSettings>& effects) const;

  /// Whitened, without what the free unknowns take up.
  Eigen::VectorXd WhiteOf(const Eigen::VectorXd& rows) const;
  double PowerOf(const Eigen::VectorXd& rows) const { return WhiteOf(rows).squaredNorm(); }
  /// How many readings say as much as one would of white noise (memory.h).
  double Memory(const Eigen::VectorXd& rows) const;
  /// Of what the twin shows less without the k-th effect.
  double PowerWithout(std::size_t k, const AskedAgain& asked) const;

  /// @param rows  That the causes have to explain; if left out, all.
  AskedAgain Ask(const std::vector<LargeCause>& causes, const Eigen::VectorXd& rows) const;
  /// @param beside  What is free beside them.
  AskedAgain Ask(const std::vector<LargeCause>& causes, const Eigen::VectorXd& rows, const Nuisance& beside) const;
  AskedAgain Ask(const std::vector<LargeCause>& causes) const { return Ask(causes, Run().run.residual); }
  /// Causes that the fit makes needless are dropped.
  FittedCauses Fit(std::vector<LargeCause> causes) const;

 private:
  AskedAgain Ask(const std::vector<LargeCause>& causes, const Eigen::VectorXd& rows, const Projector& projector) const;

  const LargeCauses& large_;
  const Scenario& scenario_;
  const model::FollowMaker& follow_;
  std::unique_ptr<Projector> projector_;  // with no more than the noise of the readings
  Eigen::VectorXd nothing_;
  mutable Eigen::VectorXd offset_rad_;  // where the device stood when it was last asked: the next time it stands nearly there
};

}  // namespace twinbench::diagnose::encoder
