#include "twin/diagnose/engine/asked_effects.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "twin/core/signal_effect.h"
#include "twin/diagnose/engine/followed.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose {
namespace {

using Values = std::map<std::string, double>;

/// What all effects are compared with: asked once.
struct Baseline {
  BelievedRecord believed;
  Eigen::VectorXd shown;  // by row
};

/// One effect at one place, and how the record answers to it.
class AskedEffect {
 public:
  AskedEffect(const std::shared_ptr<const Baseline>& baseline, const EffectEntry& entry, const std::string& place)
      : baseline_(baseline), entry_(entry) {
    effect_.name = entry.name;
    effect_.where = place;
    for (const EffectParameter& p : entry.parameters) {
      if (p.BelongsTo(place)) parameters_.push_back(p);
      effect_.parameters[p.name] = p.default_SI;
    }
    if (!parameters_.empty()) SortParameters();
  }

  const std::vector<EffectParameter>& Sizes() const { return sizes_; }
  const std::vector<EffectParameter>& Shapes() const { return shapes_; }

  /// What the rows show more with these parameters; the others keep their plausible values.
  Eigen::VectorXd More(const Values& values) const {
    EffectSettings effect = effect_;
    for (const auto& [name, value] : values) effect.parameters[name] = value;
    return baseline_->believed.ShownWith(effect) - baseline_->shown;
  }

  /// d rows / d size about no effect: rows x sizes.
  Eigen::MatrixXd Columns(const Eigen::VectorXd& shape) const {
    Eigen::MatrixXd columns(baseline_->shown.size(), std::ssize(sizes_));
    for (std::size_t j = 0; j < sizes_.size(); ++j) {
      Values values;
      for (const EffectParameter& p : sizes_) values[p.name] = 0.0;
      for (std::size_t k = 0; k < shapes_.size(); ++k)
        values[shapes_[k].name] = shape[static_cast<Eigen::Index>(k)];
      const double above = tuning::kAskedStep * Typical(sizes_[j]), below = sizes_[j].lower_SI < 0.0 ? -above : 0.0;
      values[sizes_[j].name] = above;
      Eigen::VectorXd column = More(values);
      values[sizes_[j].name] = below;
      column -= More(values);
      columns.col(static_cast<Eigen::Index>(j)) = column / (above - below);
    }
    return columns;
  }

  double Typical(const EffectParameter& p) const { return entry_.Plausible(p); }

 private:
  void SortParameters() {
    sizes_ = {parameters_.front()};
    for (std::size_t k = 1; k < parameters_.size(); ++k)
      (IsSize(parameters_[k]) ? sizes_ : shapes_).push_back(parameters_[k]);
  }

  /// Whether the answer is linear in it alone and adds to that of the sizes so far. What an effect shows at sizes
  /// of zero (the height that a tilt needs) is no part of either.
  bool IsSize(const EffectParameter& p) const {
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
    return (2.0 * (More(half) - without) - own).norm() < scale &&
           (More(together) - More(sizes) - own).norm() < scale;
  }

  std::shared_ptr<const Baseline> baseline_;
  EffectEntry entry_;
  EffectSettings effect_;
  std::vector<EffectParameter> parameters_, sizes_, shapes_;
};

/// Evenly chosen, at most `most`.
std::vector<double> Thinned(const std::vector<double>& values, std::size_t most) {
  const std::size_t every = 1 + (values.size() - 1) / most;
  std::vector<double> thinned;
  for (std::size_t k = every / 2; k < values.size(); k += every) thinned.push_back(values[k]);
  return thinned;
}

/// `count` values about the plausible one: in equal ratios where the sign is fixed, else in equal steps.
std::vector<double> GridOf(const EffectParameter& p, double typical, const std::vector<double>& onsets, int count) {
  if (p.name == "at_reading" && !onsets.empty()) return Thinned(onsets, tuning::kAskedOnsets);
  if (p.lower_SI >= 0.0)
    return Ratios(std::max(p.lower_SI, typical / tuning::kAskedRatio),
                  std::min(p.upper_SI, typical * tuning::kAskedRatio), count);
  return Even(std::max(p.lower_SI, -tuning::kAskedSide * typical),
              std::min(p.upper_SI, tuning::kAskedSide * typical), count);
}

/// Every combination of the values of all shapes.
std::vector<Shape> ShapesOf(const Catalogue& catalogue, const AskedEffect& asked, const std::string& effect,
                            const std::vector<double>& onsets) {
  const auto count =
      static_cast<int>(std::pow(tuning::kAskedPoints, 1.0 / static_cast<double>(asked.Shapes().size())));
  std::vector<std::vector<double>> combined = {{}};
  for (const EffectParameter& p : asked.Shapes()) {
    std::vector<std::vector<double>> longer;
    for (const std::vector<double>& before : combined) {
      for (const double value : GridOf(p, asked.Typical(p), onsets, count)) {
        longer.push_back(before);
        longer.back().push_back(value);
      }
    }
    combined = std::move(longer);
  }
  std::vector<Shape> shapes;
  for (std::size_t k = 0; k < asked.Shapes().size(); ++k) {
    std::vector<double> values;
    for (const std::vector<double>& point : combined) values.push_back(point[k]);
    shapes.push_back(catalogue.ShapeOf(effect, asked.Shapes()[k].name, std::move(values)));
  }
  return shapes;
}

std::vector<std::string> NamesOf(const std::vector<EffectParameter>& parameters) {
  std::vector<std::string> names;
  for (const EffectParameter& p : parameters) names.push_back(p.name);
  return names;
}

}  // namespace

Eigen::VectorXd BelievedRecord::ShownUnder(const Scenario& believed) const {
  return ByRow(Followed(follow, believed, record, used).Predict(free));
}

Eigen::VectorXd BelievedRecord::ShownWith(const EffectSettings& effect) const {
  Scenario with = scenario;
  with.effects.push_back(effect);
  return ShownUnder(with);
}

std::vector<Invisible> AddAskedEffects(const BelievedRecord& believed, const std::vector<EffectEntry>& entries,
                                       Candidates& named) {
  const auto baseline = std::make_shared<const Baseline>(Baseline{believed, believed.Shown()});
  std::vector<Invisible> invisible;
  for (const EffectEntry& entry : entries) {
    for (const std::string& place : entry.places.empty() ? std::vector<std::string>{""} : entry.places) {
      const auto asked = std::make_shared<const AskedEffect>(baseline, entry, place);
      const Showing showing{entry.name, place, {}};
      if (asked->Sizes().empty() || asked->More({}).isZero())
        invisible.push_back({entry.name, place, "nothing: this run shows nothing of it"});
      else if (asked->Shapes().empty())
        named.Add(showing, NamesOf(asked->Sizes()), asked->Columns({}));
      else
        named.AddOver(showing, NamesOf(asked->Sizes()),
                      ShapesOf(named.catalogue(), *asked, entry.name, believed.onsets),
                      [asked](const Eigen::VectorXd& shape) { return asked->Columns(shape); });
    }
  }
  return invisible;
}

}  // namespace twinbench::diagnose
