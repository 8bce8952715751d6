#include "twin/benches/turntable_autocollimator/estimators/model_check.h"

#include <cmath>
#include <map>

#include "twin/core/units.h"
#include "twin/separate/mean.h"

namespace twinbench::separate::turntable {
namespace {

/// One usable check reading.
struct Checked {
  int setup = 0;
  long long place = 0;  // turntable angle in millionths of a turn
  double error_rad = kNaN;
  double curve_rad = kNaN;
};

long long PlaceOf(double turntable_rad) {
  constexpr long long kPlaces = 1000000;
  const long long place = std::llround(turntable_rad / (2.0 * units::kPi) * kPlaces) % kPlaces;
  return place < 0 ? place + kPlaces : place;
}

std::vector<Checked> Correct(const HarmonicModel& model, const std::vector<TurntableStop>& stops,
                             const Roll& roll) {
  std::vector<Checked> checked;
  for (const TurntableStop& s : stops) {
    const double x_rad = roll.Correct(s.x_rad, s.y_rad);
    if (std::isfinite(x_rad) && std::isfinite(s.turntable_rad))
      checked.push_back({s.setup, PlaceOf(s.turntable_rad), x_rad, model.At(s.turntable_rad).value_rad});
  }
  return checked;
}

/// Means by place, in its order, of values less the mean of their set-up.
template <typename Value>
std::map<long long, Mean> MeansByPlace(const std::vector<Checked>& checked, const Value& value) {
  std::map<int, Mean> by_setup;
  for (const Checked& c : checked) by_setup[c.setup].Add(value(c));
  std::map<long long, Mean> by_place;
  for (const Checked& c : checked) by_place[c.place].Add(value(c) - by_setup[c.setup].Value());
  return by_place;
}

Eigen::VectorXd Values(const std::map<long long, Mean>& means) {
  Eigen::VectorXd values(std::ssize(means));
  Eigen::Index i = 0;
  for (const auto& [place, mean] : means) values[i++] = mean.Value();
  return values;
}

}  // namespace

ErrorSize DescribeErrors(const Eigen::VectorXd& error_rad) {
  std::vector<double> finite_rad;
  for (const double e : error_rad) {
    if (std::isfinite(e)) finite_rad.push_back(e);
  }
  if (finite_rad.empty()) return {};
  const Eigen::Map<const Eigen::ArrayXd> e(finite_rad.data(), std::ssize(finite_rad));
  const Eigen::ArrayXd deviation_rad = e - e.mean();
  return {static_cast<int>(e.size()), e.maxCoeff() - e.minCoeff(), std::sqrt(deviation_rad.square().mean()),
          deviation_rad.abs().maxCoeff(), (e - e[0]).abs().maxCoeff()};
}

ModelCheck CheckModel(const HarmonicModel& model, const std::vector<TurntableStop>& stops, const Roll& roll,
                      const CheckUncertainty& u) {
  const std::vector<Checked> checked = Correct(model, stops, roll);
  const auto errors = MeansByPlace(checked, [](const Checked& c) { return c.error_rad; });
  const auto rests = MeansByPlace(checked, [](const Checked& c) { return c.error_rad - c.curve_rad; });
  ModelCheck check;
  Mean variance_rad2;
  for (const auto& [place, mean] : errors) {
    check.position_rad.push_back(static_cast<double>(place) * 1e-6 * 2.0 * units::kPi);
    variance_rad2.Add(std::pow(model.At(check.position_rad.back()).u_rad, 2) + std::pow(u.u_multitooth_rad, 2) +
                      std::pow(u.u_reading_rad, 2) / mean.count);
  }
  check.error_rad = Values(errors);
  check.rest_rad = Values(rests);
  check.before = DescribeErrors(check.error_rad);
  check.after = DescribeErrors(check.rest_rad);
  check.expected_rms_rad = std::sqrt(variance_rad2.Value());
  return check;
}

}  // namespace twinbench::separate::turntable
