#include "twin/benches/encoder_comparison/diagnosis/families.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>

#include "twin/benches/encoder_comparison/diagnosis/family_parts.h"
#include "twin/core/distributions.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"
#include "twin/diagnose/aliased_orders.h"
#include "twin/diagnose/tuning.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::encoder {
namespace {

constexpr double kPlausible_rad = 0.01 * units::deg;
constexpr double kRest_rad = 1e-9;
constexpr int kMostTeeth = 720;  // of a worm wheel; poles of a motor

bool Has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Typical distance of neighbouring readings in each pass; passes at rest are left out.
std::vector<double> Spacings_rad(const SignalContext& c) {
  std::map<int, std::vector<double>> steps;
  for (Eigen::Index i = 1; i < c.Readings(); ++i) {
    const double step_rad = std::abs(c.reference_rad[i] - c.reference_rad[i - 1]);
    if (c.pass[i] == c.pass[i - 1] && step_rad > kRest_rad) steps[c.pass[i]].push_back(step_rad);
  }
  std::vector<double> spacings;
  for (const auto& [pass, step_rad] : steps) spacings.push_back(Median(step_rad));
  return spacings;
}

/// Uneven positions show orders above half of their number, too: as many that no two of them are one wave.
int LargestToldApart(const Eigen::VectorXd& angle_rad, int by_spacing, int most) {
  const Eigen::VectorXd uneven = UnevennessOfOrders(2 * most, angle_rad);
  for (int sum = by_spacing + 1; sum <= 2 * most; ++sum) {
    if (uneven[sum] < kUneven) return std::max(by_spacing, (sum - 1) / 2);
  }
  return most;
}

/// How much of what is left, in units of noise, columns explain that the free unknowns cannot.
double ExplainedBy(const EncoderRun& encoder, const Eigen::MatrixXd& columns) {
  const Eigen::MatrixXd free = encoder.run.nuisance.jacobian.toDense();
  const auto without = [&free](const Eigen::MatrixXd& rows) {
    return Eigen::MatrixXd(rows - free * SolveShortest(free, rows));
  };
  const Eigen::MatrixXd own = without(columns);
  const Eigen::VectorXd left = without(encoder.run.residual);
  return (own * SolveShortest(own, left)).squaredNorm() /
         std::pow(encoder.run.sigma.mean(), 2);
}

/// A clock that runs fast shows in proportion to the speed and to the time. What goes with the speed alone, however
/// it does, or with another power of either is none, however much it looks like one.
bool IsNoClock(const EncoderRun& encoder) {
  constexpr double kClearly = 25.0;  // power, so many units of noise: no chance
  const SignalContext& c = encoder.context;
  if (!c.Moves()) return true;
  const Eigen::ArrayXd v = c.velocity_rad_s / c.velocity_rad_s.cwiseAbs().maxCoeff(), t = c.time_s;
  Eigen::MatrixXd of_speed(v.size(), 3);
  of_speed << v.matrix(), (v * v.abs()).matrix(), v.sign().matrix();
  double others = ExplainedBy(encoder, of_speed);
  for (const Eigen::ArrayXd& other :
       {Eigen::ArrayXd(v * v.abs() * t), Eigen::ArrayXd(v.abs() * t), Eigen::ArrayXd(v * t * t)})
    others = std::max(others, ExplainedBy(encoder, other.matrix()));
  return others > ExplainedBy(encoder, (v * c.since_start_s.array()).matrix()) + kClearly;
}

}  // namespace

double FinestSpacing_rad(const SignalContext& context) {
  const std::vector<double> spacings_rad = Spacings_rad(context);
  return spacings_rad.empty() ? 0.0 : *std::min_element(spacings_rad.begin(), spacings_rad.end());
}

double RangeOfSetUp_rad(const SignalContext& c) {
  std::map<int, std::pair<double, double>> ends_rad;  // least and largest angle
  for (Eigen::Index i = 0; i < c.Readings(); ++i) {
    auto& [least, largest] = ends_rad.try_emplace(c.setup[i], c.reference_rad[i], c.reference_rad[i]).first->second;
    least = std::min(least, c.reference_rad[i]);
    largest = std::max(largest, c.reference_rad[i]);
  }
  double range_rad = 0.0;
  for (const auto& [setup, ends] : ends_rad) range_rad = std::max(range_rad, ends.second - ends.first);
  return range_rad;
}

int LeastOrder(const SignalContext& context) {
  constexpr int kLastWithReason = 2;                  // a scale off its axis, out of round or tilted
  constexpr double kLeast = 0.6, kWithoutReason = 0.9;  // of a period; less is a curve like any other
  const double range_rad = RangeOfSetUp_rad(context);
  if (!(range_rad > 0.0)) return 1;
  const auto of = [&](double periods) { return static_cast<int>(std::ceil(periods * units::turn / range_rad)); };
  return of(kLeast) <= kLastWithReason ? std::max(1, of(kLeast)) : std::max(kLastWithReason + 1, of(kWithoutReason));
}

double OrdersApart(const SignalContext& context) {
  constexpr double kOfPeriod = 0.5;
  return std::max(1.0, kOfPeriod * units::turn / RangeOfSetUp_rad(context));
}

std::vector<int> WholeOrders(const SignalContext& context, int first) {
  const int last = LargestOrder(context), step = std::max(1, static_cast<int>(0.5 * OrdersApart(context)));
  std::vector<int> orders;
  for (int k = std::max(first, LeastOrder(context)); k <= last; k += k < kMostTeeth ? 1 : step) orders.push_back(k);
  return orders;
}

int LargestOrder(const SignalContext& context) {
  // Of a part of a turn as many that it tells apart, which reach as much farther.
  constexpr double kLeastPart = 0.05;
  const double range_rad = context.reference_rad.maxCoeff() - context.reference_rad.minCoeff();
  const double part = std::clamp(range_rad / units::turn, kLeastPart, 1.0);
  constexpr double kDimmed =
      6.4;  // times as wide a step has the Nyquist order that means over it lower by a hundredth
  const double step_rad = (context.has_means ? kDimmed : 1.0) * FinestSpacing_rad(context);
  const int most = static_cast<int>(kMostTeeth / part), by_spacing = model::HighestOrder(step_rad, most);
  // On the move the reference's own steps would look like such an order.
  const bool has_more = part == 1.0 && !context.Moves() && by_spacing > 0 && by_spacing < most;
  return has_more ? LargestToldApart(context.reference_rad, by_spacing, most) : by_spacing;
}

std::vector<Family> Families(const EncoderRun& encoder, const std::vector<std::string>& excluded) {
  const auto context = std::make_shared<const SignalContext>(encoder.context);
  const double plausible_rad = std::max(kPlausible_rad, 3.0 * encoder.run.sigma.mean());
  const TimeSeries series =
      TimeSeriesOf(encoder.run.schedule, std::vector<int>(encoder.context.reading.size(), 0), 1);
  std::vector<Family> families = NamedFamilies(context, series, plausible_rad);
  std::erase_if(families, [&](const Family& family) { return Has(excluded, family.effect); });
  if (Has(excluded, kGradualPlay))
    std::erase_if(families, [](const Family& f) { return f.effect == "backlash" && std::ranges::find(f.shapes, "crossed_over", &Shape::name) != f.shapes.end(); });
  if (IsNoClock(encoder))
    std::erase_if(families, [](const Family& family) { return family.effect == "clock_rate"; });
  // One mounting cannot tell a fault of the device from the same order of the reference.
  const std::vector<std::string> doubled = {"eccentricity",       "signal_offset",    "ellipticity",
                                            "amplitude_mismatch", "quadrature_error", "periodic"};
  for (Family& family : families) {
    if (Has(doubled, family.effect)) family.listed = tuning::kListedDoubled;
  }
  std::vector<Family> unknown = UnknownFamilies(encoder, series, plausible_rad);
  if (Has(excluded, "harmonic")) std::erase_if(unknown, [](const Family& family) { return family.effect == "harmonic"; });
  std::ranges::move(unknown, std::back_inserter(families));
  return families;
}

}  // namespace twinbench::diagnose::encoder
