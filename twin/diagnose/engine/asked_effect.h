#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "twin/core/effect_catalogue.h"
#include "twin/diagnose/engine/asked_effects.h"

namespace twinbench::diagnose {

/// What all effects are compared with: asked once.
struct Baseline {
  BelievedRecord believed;
  Eigen::VectorXd shown;  // by row
};

/// One effect at one place, and how the record answers to it.
class AskedEffect {
 public:
  using Values = std::map<std::string, double>;

  AskedEffect(const std::shared_ptr<const Baseline>& baseline, const EffectEntry& entry, const std::string& place);

  const std::vector<EffectParameter>& Sizes() const { return sizes_; }
  const std::vector<EffectParameter>& Shapes() const { return shapes_; }
  /// The size is that of a wave with a "phase"; it has a "curvature".
  bool IsWave() const { return is_wave_; }
  bool IsBent() const { return is_bent_; }

  /// What the rows show more with these parameters; the others keep their plausible values.
  Eigen::VectorXd More(const Values& values) const;

  /// d rows / d size about no effect: rows x sizes; of a wave its cosine and sine, of what has a curvature what is
  /// straight and what the curvature adds.
  Eigen::MatrixXd Columns(const Eigen::VectorXd& shape) const;

  double Typical(const EffectParameter& p) const { return entry_.Plausible(p); }

 private:
  void SortParameters();
  Eigen::VectorXd Column(const EffectParameter& size, Values values) const;
  /// Whether a size shows as much one way as the other: then one way tells the slope.
  bool IsOdd(const EffectParameter& size) const;
  /// Whether the answer is linear in it alone and adds to that of the sizes so far. What an effect shows at sizes
  /// of zero (the height that a tilt needs) is no part of either.
  bool IsSize(const EffectParameter& p) const;

  std::shared_ptr<const Baseline> baseline_;
  EffectEntry entry_;
  EffectSettings effect_;
  std::vector<EffectParameter> parameters_, sizes_, shapes_;
  bool is_wave_ = false, is_bent_ = false, is_odd_ = false;
};

}  // namespace twinbench::diagnose
