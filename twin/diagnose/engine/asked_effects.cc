#include "twin/diagnose/engine/asked_effects.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "twin/core/signal_effect.h"
#include "twin/core/units.h"
#include "twin/diagnose/engine/followed.h"
#include "twin/diagnose/tuning.h"
#include "twin/model/signals.h"

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
    is_odd_ = !shapes_.empty() && sizes_.size() == 1 && IsOdd(sizes_.front());
  }

  const std::vector<EffectParameter>& Sizes() const { return sizes_; }
  const std::vector<EffectParameter>& Shapes() const { return shapes_; }
  /// The size is that of a wave with a "phase"; it has a "curvature".
  bool IsWave() const { return is_wave_; }
  bool IsBent() const { return is_bent_; }

  /// What the rows show more with these parameters; the others keep their plausible values.
  Eigen::VectorXd More(const Values& values) const {
    EffectSettings effect = effect_;
    for (const auto& [name, value] : values) effect.parameters[name] = value;
    return baseline_->believed.ShownWith(effect) - baseline_->shown;
  }

  /// d rows / d size about no effect: rows x sizes; of a wave its cosine and sine, of what has a curvature what is
  /// straight and what the curvature adds.
  Eigen::MatrixXd Columns(const Eigen::VectorXd& shape) const {
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

  double Typical(const EffectParameter& p) const { return entry_.Plausible(p); }

 private:
  void SortParameters() {
    sizes_ = {parameters_.front()};
    const std::string only = parameters_.size() == 2 ? parameters_.back().name : "";
    is_wave_ = only == "phase";
    is_bent_ = only == "curvature";
    if (is_wave_ || is_bent_) return;
    for (std::size_t k = 1; k < parameters_.size(); ++k)
      (IsSize(parameters_[k]) ? sizes_ : shapes_).push_back(parameters_[k]);
  }

  Eigen::VectorXd Column(const EffectParameter& size, Values values) const {
    const double above = tuning::kAskedStep * Typical(size), below = size.lower_SI < 0.0 ? -above : 0.0;
    values[size.name] = above;
    Eigen::VectorXd column = More(values);
    if (is_odd_) return column / above;
    values[size.name] = below;
    column -= More(values);
    return column / (above - below);
  }

  /// Whether a size shows as much one way as the other: then one way tells the slope.
  bool IsOdd(const EffectParameter& size) const {
    constexpr double kRounding = 1e-6;
    const double step = tuning::kAskedStep * Typical(size);
    if (size.lower_SI > -step) return false;
    const Eigen::VectorXd above = More({{size.name, step}});
    return (above + More({{size.name, -step}})).norm() < kRounding * above.norm();
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
  bool is_wave_ = false, is_bent_ = false, is_odd_ = false;
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
                            const BelievedRecord& believed) {
  const auto count = static_cast<int>(std::pow(believed.points, 1.0 / static_cast<double>(asked.Shapes().size())));
  std::vector<std::vector<double>> combined = {{}};
  for (const EffectParameter& p : asked.Shapes()) {
    std::vector<std::vector<double>> longer;
    for (const std::vector<double>& before : combined) {
      for (const double value : GridOf(p, asked.Typical(p), believed.onsets, count)) {
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

/// How much larger than at its plausible shape a size is that leaves the same trace.
class Traces {
 public:
  explicit Traces(const std::shared_ptr<const AskedEffect>& asked) : asked_(asked) {
    Eigen::VectorXd plausible(std::ssize(asked->Shapes()));
    for (std::size_t k = 0; k < asked->Shapes().size(); ++k)
      plausible[static_cast<Eigen::Index>(k)] = asked->Typical(asked->Shapes()[k]);
    usual_ = model::Rms(asked->Columns(plausible));
  }

  double ScaleOf(const Eigen::VectorXd& column) const {
    constexpr double kLeast = 1e-4;  // of the usual one: less is rounding
    return usual_ / std::max(model::Rms(column), kLeast * usual_);
  }
  double ScaleAt(const Eigen::VectorXd& shape) const { return ScaleOf(asked_->Columns(shape)); }
  /// d scale / d shape.
  Eigen::VectorXd SlopesAt(const Eigen::VectorXd& shape) const {
    constexpr double kStep = 1e-3;
    Eigen::VectorXd slopes(shape.size());
    for (Eigen::Index k = 0; k < shape.size(); ++k) {
      const Eigen::VectorXd step = kStep * shape[k] * Eigen::VectorXd::Unit(shape.size(), k);
      slopes[k] = (ScaleAt(shape + step) - ScaleAt(shape - step)) / (2.0 * kStep * shape[k]);
    }
    return slopes;
  }

 private:
  std::shared_ptr<const AskedEffect> asked_;
  double usual_;
};

/// The size that is fitted is that of the plausible shape with the same trace.
void TellByTrace(const Traces& traces, const Catalogue& catalogue, Family& family) {
  const std::string size = family.amplitudes.front().name;
  family.parameters = [=, effect = family.effect, shapes = family.shapes](
                          const Eigen::VectorXd& shape, const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
    Eigen::VectorXd slopes = Eigen::VectorXd::Constant(1, traces.ScaleAt(shape));
    if (cov.rows() > shape.size()) {
      slopes.conservativeResize(1 + shape.size());
      slopes.tail(shape.size()) = x[0] * traces.SlopesAt(shape);
    }
    const double variance = slopes.dot(cov.topLeftCorner(slopes.size(), slopes.size()) * slopes);
    std::vector<ParameterEstimate> told = {catalogue.Estimate(effect, size, slopes[0] * x[0], std::sqrt(variance))};
    for (std::size_t k = 0; k < shapes.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(k);
      told.push_back(catalogue.Estimate(effect, shapes[k].name, shape[at], DeviationAt(cov, 1 + at)));
    }
    return told;
  };
}

/// The twin is asked once at each point of the grid.
void RememberGrid(Family& family) {
  const auto known = std::make_shared<std::vector<Eigen::MatrixXd>>(static_cast<std::size_t>(family.grid));
  family.columns = [ask = family.columns, known](int grid_point) {
    Eigen::MatrixXd& columns = (*known)[static_cast<std::size_t>(grid_point)];
    if (columns.size() == 0) columns = ask(grid_point);
    return columns;
  };
}

void AddAskedOver(const std::shared_ptr<const AskedEffect>& asked, const Showing& showing,
                  const BelievedRecord& believed, Candidates& named) {
  const std::vector<std::string> sizes = NamesOf(asked->Sizes());
  const std::vector<Shape> shapes = ShapesOf(named.catalogue(), *asked, showing.effect, believed);
  if (!believed.alike_by_trace || sizes.size() > 1)
    return RememberGrid(named.AddOver(showing, sizes, shapes,
                                      [asked](const Eigen::VectorXd& shape) { return asked->Columns(shape); }));
  const Traces traces(asked);
  Family& family = named.AddOver(showing, sizes, shapes, [asked, traces](const Eigen::VectorXd& shape) {
    const Eigen::MatrixXd columns = asked->Columns(shape);
    return Eigen::MatrixXd(traces.ScaleOf(columns) * columns);
  });
  TellByTrace(traces, named.catalogue(), family);
  RememberGrid(family);
}

void AddAsked(const std::shared_ptr<const AskedEffect>& asked, const Showing& showing,
              const BelievedRecord& believed, Candidates& named) {
  std::vector<std::string> sizes = NamesOf(asked->Sizes());
  if (!asked->Shapes().empty()) return AddAskedOver(asked, showing, believed, named);
  const Eigen::MatrixXd columns = asked->Columns({});
  if (asked->IsBent()) return named.AddStraightAndBent(showing, sizes.front(), columns);
  if (asked->IsWave()) sizes.assign(2, sizes.front());
  Family& family = named.Add(showing, sizes, columns);
  if (asked->IsWave()) named.MakeOrders(family);
}

}  // namespace

Eigen::VectorXd BelievedRecord::ShownUnder(const Scenario& believed) const {
  const Eigen::MatrixXd shown = Followed(follow, believed, record, used, channels).Predict(free);
  return ByRow(groups.start.empty() ? shown : groups.Mean(shown));
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
      if (asked->Sizes().empty() || asked->More({}).isZero())
        invisible.push_back({entry.name, place, "nothing: this run shows nothing of it"});
      else
        AddAsked(asked, {entry.name, place, {}}, believed, named);
    }
  }
  return invisible;
}

}  // namespace twinbench::diagnose
