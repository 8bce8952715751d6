#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/units.h"
#include "twin/diagnose/turntable/collector.h"

namespace twinbench::diagnose::turntable {
namespace {

/// Monomials of degree 2 and 3 of both readings, and of degree 4 and 5 of the first: readings x 9.
Eigen::MatrixXd Powers(const Eigen::VectorXd& u, const Eigen::VectorXd& v) {
  Eigen::MatrixXd p(u.size(), 9);
  const auto a = u.array(), b = v.array();
  p << a.square().matrix(), (a * b).matrix(), b.square().matrix(), a.cube().matrix(), (a.square() * b).matrix(),
      (a * b.square()).matrix(), b.cube().matrix(), a.square().square().matrix(),
      (a.square().square() * a).matrix();
  return p;
}

/// A gain that follows something: what is shown times that.
void AddGain(Collector& collect, const std::string& what, const Eigen::VectorXd& followed,
             const Eigen::MatrixXd& shown) {
  for (const int axis : {kX, kY}) {
    collect.AddOn(axis, "gain changes", Times(shown.col(axis), Unit(followed.array() - followed.mean())),
                  fmt::format("gain follows {0}, locked to {0} and reading", what));
  }
}

void AddGains(Collector& collect, const Eigen::MatrixXd& shown) {
  AddGain(collect, "time", Fraction(collect.schedule()), shown);
  AddGain(collect, "direction", DirectionSignal(*collect.context()), shown);
  if (collect.context()->HasTemperature()) AddGain(collect, "temperature", collect.context()->above_K, shown);
}

}  // namespace

void AddByReading(Collector& collect) {
  const Eigen::MatrixXd& shown_rad = collect.context()->shown_rad;
  const double range_rad = std::max(shown_rad.cwiseAbs().maxCoeff(), 1.0 * units::arcsec);
  const Eigen::MatrixXd shown = shown_rad / range_rad;
  for (const int axis : {kX, kY}) {
    const Eigen::VectorXd own = shown.col(axis), other = shown.col(kAxes - 1 - axis);
    const char* const name = kAxisNames[static_cast<std::size_t>(axis)];
    collect.AddOn(axis, "reading", Powers(own, other),
                  fmt::format("smooth function of the readings, locked to reading of {}", name));
    collect.AddOn(axis, "linear map", shown,
                  fmt::format("proportional to the readings, locked to reading of {}", name));
  }
  AddGains(collect, shown);
}

}  // namespace twinbench::diagnose::turntable
