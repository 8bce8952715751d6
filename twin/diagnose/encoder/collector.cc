#include "twin/diagnose/encoder/collector.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/units.h"

namespace twinbench::diagnose::encoder {

Family& Collector::Add(const std::string& sort, int grid, const Columns& columns, const Words& words) {
  Family family;
  family.kind = Kind::kUnknown;
  family.effect = family.group = sort;
  family.where = "angle";
  family.amplitudes.assign(static_cast<std::size_t>(columns(0).cols()),
                           {"amplitude", "deg", units::deg, kPriorToBeSet});
  family.grid = grid;
  family.columns = columns;
  family.describe = [words](int g, const Eigen::VectorXd& x) {
    return fmt::format("{}, on angle, amplitude {:.2g} deg", words(g), x.norm() / units::deg);
  };
  families_.push_back(std::move(family));
  return families_.back();
}

void Collector::Add(const std::string& sort, const Eigen::MatrixXd& columns, const std::string& words) {
  Add(
      sort, 1, [columns](int) { return columns; }, [words](int) { return words; });
}

void Collector::AddOver(const std::string& sort, const Shape& shape, const ColumnsAt& at, const Words& words,
                        const Columns& columns) {
  const auto on_grid = [at, values = shape.value](int g) {
    return at(Eigen::VectorXd::Constant(1, values[static_cast<std::size_t>(g)]));
  };
  Family& family = Add(sort, static_cast<int>(shape.value.size()), columns ? columns : on_grid, words);
  family.shapes = {shape};
  family.at = at;
}

Eigen::VectorXd Unit(const Eigen::VectorXd& signal) {
  const double rms = std::sqrt(signal.squaredNorm() / static_cast<double>(signal.size()));
  return rms > 0.0 ? Eigen::VectorXd(signal / rms) : signal;
}

Eigen::VectorXd Fraction(const SignalContext& c) {
  return c.time_s / Duration_s(c);
}

void AddModulated(Collector& collect, const std::string& sort, int last, const Eigen::VectorXd& factor,
                  const std::string& words) {
  if (last < 1 || factor.cwiseAbs().maxCoeff() == 0.0) return;
  const Eigen::VectorXd angle_rad = collect.context().device_rad;
  collect.Add(
      sort, last, [=](int g) { return Times(Wave((g + 1) * angle_rad), factor); },
      [=](int g) { return fmt::format(fmt::runtime(words), g + 1); });
}

}  // namespace twinbench::diagnose::encoder
