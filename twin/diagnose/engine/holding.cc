#include "twin/diagnose/engine/holding.h"

#include <algorithm>
#include <cmath>

#include "twin/diagnose/engine/refine.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose {
namespace {

Explained ExplainedBy(const Eigen::MatrixXd& columns, const Beside& beside) {
  return Explain(beside.noise.Whiten(beside.run, columns), beside.projector, beside.others, beside.data.rows.col(0));
}

/// More power than that is no chance.
double Chance(double left, const Beside& beside) {
  const double noise = std::max(1.0, left / beside.projector.DegreesOfFreedom());
  return tuning::kHeadline * tuning::kHeadline * noise;
}

/// The same that goes on from `width` onsets before to as many behind the g-th, evenly.
Eigen::MatrixXd Gradual(const Family& family, int g, int width) {
  const int first = std::max(0, g - width), last = std::min(family.grid - 1, g + width);
  Eigen::MatrixXd sum = family.ColumnsAt(first);
  for (int k = first + 1; k <= last; ++k) sum += family.ColumnsAt(k);
  return sum / (last - first + 1);
}

/// Where the shape says how large it is, it is not a wave of another size that happens to be like it.
bool IsOfItsStrength(const Amplitude& amplitude, double fitted) {
  return amplitude.name != "strength" || (fitted > amplitude.lower && fitted < amplitude.upper);
}

}  // namespace

bool IsInside(const Family& family, const Eigen::VectorXd& shape) {
  constexpr double kOnBound = 0.02;  // of the distance to the next point of the grid and beyond
  for (std::size_t k = 0; k < family.shapes.size(); ++k) {
    const Shape& s = family.shapes[k];
    const double value = shape[static_cast<Eigen::Index>(k)];
    if (s.is_inside && (value < s.lower * (1.0 + kOnBound) || value > s.upper * (1.0 - kOnBound))) return false;
  }
  return true;
}

bool IsThere(const Family& family, const Term& term, const Beside& beside) {
  if (family.kind != Kind::kNamed || !family.at || family.amplitudes.size() != 1) return true;
  const Explained alone = ExplainedBy(term.columns, beside);
  if (!IsOfItsStrength(family.amplitudes.front(), alone.amplitudes[0])) return false;
  if (family.size_is_of_trace) return true;  // size and shape may stand for each other: what they leave together is seen
  const Eigen::MatrixXd all = WithShapeSlopes(family, term.shape, term.columns, alone.amplitudes);
  const double with = ExplainedBy(all, beside).power, without = ExplainedBy(all.rightCols(term.shape.size()), beside).power;
  return with - without > Chance(beside.data.power[0] - with, beside);
}

bool IsEvent(const Family& family) {
  return std::ranges::count(family.shapes, "at_reading", &Shape::name) > 0;
}

bool IsSudden(const Family& family, const Term& term, const Beside& beside) {
  if (!IsEvent(family) || family.shapes.size() > 1) return true;
  const double sudden = ExplainedBy(term.columns, beside).power;
  for (int width = 2; width <= family.grid / 4; width *= 2) {
    const double gradual = ExplainedBy(Gradual(family, term.grid_point, width), beside).power;
    if (gradual - sudden > Chance(beside.data.power[0] - gradual, beside)) return false;
  }
  return true;
}

}  // namespace twinbench::diagnose
