#include "twin/diagnose/engine/asked_effects.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "twin/diagnose/engine/asked_effect.h"
#include "twin/diagnose/engine/followed.h"
#include "twin/diagnose/tuning.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose {
namespace {

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
  family.size_is_of_trace = true;
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
