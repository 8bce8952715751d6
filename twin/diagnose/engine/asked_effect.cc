#include "twin/diagnose/engine/asked_effect.h"

#include "twin/core/signal_effect.h"
#include "twin/core/units.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose {

AskedEffect::AskedEffect(const std::shared_ptr<const Baseline>& baseline, const EffectEntry& entry,
                         const std::string& place)
    : baseline_(baseline), entry_(entry) {
  effect_.name = entry.name;
  effect_.where = place;
  for (const EffectParameter& p : entry.parameters) {
    if (p.BelongsTo(place)) parameters_.push_back(p);
    effect_.parameters[p.name] = p.default_SI;
  }
  if (!parameters_.empty()) SortParameters();
  is_odd_ = !shapes_.empty() && sizes_.size() == 1 && IsOdd(sizes_.front());
}

Eigen::VectorXd AskedEffect::More(const Values& values) const {
  EffectSettings effect = effect_;
  for (const auto& [name, value] : values) effect.parameters[name] = value;
  return baseline_->believed.ShownWith(effect) - baseline_->shown;
}

Eigen::MatrixXd AskedEffect::Columns(const Eigen::VectorXd& shape) const {
  Values values;
  for (const EffectParameter& p : sizes_) values[p.name] = 0.0;
  for (std::size_t k = 0; k < shapes_.size(); ++k) values[shapes_[k].name] = shape[static_cast<Eigen::Index>(k)];
  const auto with = [&](const char* name, double value) {
    values[name] = value;
    return Column(sizes_.front(), values);
  };
  Eigen::MatrixXd columns(baseline_->shown.size(), is_wave_ || is_bent_ ? 2 : std::ssize(sizes_));
  if (is_wave_) {
    columns << with("phase", 0.0), with("phase", 0.75 * units::turn);
  } else if (is_bent_) {
    columns.col(0) = with("curvature", 0.0);
    columns.col(1) = with("curvature", 1.0) - columns.col(0);
  } else {
    for (std::size_t j = 0; j < sizes_.size(); ++j)
      columns.col(static_cast<Eigen::Index>(j)) = Column(sizes_[j], values);
  }
  return columns;
}

void AskedEffect::SortParameters() {
  sizes_ = {parameters_.front()};
  const std::string only = parameters_.size() == 2 ? parameters_.back().name : "";
  is_wave_ = only == "phase";
  is_bent_ = only == "curvature";
  if (is_wave_ || is_bent_) return;
  for (std::size_t k = 1; k < parameters_.size(); ++k)
    (IsSize(parameters_[k]) ? sizes_ : shapes_).push_back(parameters_[k]);
}

Eigen::VectorXd AskedEffect::Column(const EffectParameter& size, Values values) const {
  const double above = tuning::kAskedStep * Typical(size), below = size.lower_SI < 0.0 ? -above : 0.0;
  values[size.name] = above;
  Eigen::VectorXd column = More(values);
  if (is_odd_) return column / above;
  values[size.name] = below;
  column -= More(values);
  return column / (above - below);
}

bool AskedEffect::IsOdd(const EffectParameter& size) const {
  constexpr double kRounding = 1e-6;
  const double step = tuning::kAskedStep * Typical(size);
  if (size.lower_SI > -step) return false;
  const Eigen::VectorXd above = More({{size.name, step}});
  return (above + More({{size.name, -step}})).norm() < kRounding * above.norm();
}

bool AskedEffect::IsSize(const EffectParameter& p) const {
  constexpr double kTolerance = 1e-3;
  if (p.lower_SI > 0.0 || p.upper_SI < 0.0) return false;
  Values none = {{p.name, 0.0}}, sizes = none;
  for (const EffectParameter& size : sizes_) {
    none[size.name] = 0.0;
    sizes[size.name] = tuning::kAskedStep * Typical(size);
  }
  Values alone = none, half = none, together = sizes;
  alone[p.name] = together[p.name] = tuning::kAskedStep * Typical(p);
  half[p.name] = 0.5 * tuning::kAskedStep * Typical(p);
  const Eigen::VectorXd without = More(none), own = More(alone) - without;
  if (own.isZero()) return false;
  const double scale = kTolerance * own.norm();
  return (2.0 * (More(half) - without) - own).norm() < scale && (More(together) - More(sizes) - own).norm() < scale;
}

}  // namespace twinbench::diagnose
