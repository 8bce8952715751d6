#include "twin/diagnose/to_readings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/linear_algebra.h"
#include "twin/diagnose/conclusion.h"
#include "twin/diagnose/engine/candidates.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose {
namespace {

/// Those that the rows resolve.
std::vector<TwinComparison::TabulatedOrder> Resolved(const Compared& c, const TwinComparison& comparison) {
  const Schedule& rows = c.run.schedule;
  const int last = model::HighestOrder(model::TypicalStep_rad(rows, rows.target_rad));
  std::vector<TwinComparison::TabulatedOrder> orders = comparison.orders;
  std::erase_if(orders, [last](const auto& tabulated) { return tabulated.order > last; });
  return orders;
}

/// Waves of the orders, then the constants of the set-ups: groups of readings x columns.
Eigen::MatrixXd ColumnsOf(const Compared& c, const std::vector<TwinComparison::TabulatedOrder>& orders) {
  const Eigen::MatrixXd setups = model::Indicators(c.readings.setup);
  Eigen::MatrixXd columns(c.readings.Readings(), 2 * std::ssize(orders) + setups.cols());
  Eigen::Index at = 0;
  for (const auto& tabulated : orders)
    columns.middleCols(2 * at++, 2) = model::Wave(tabulated.order * c.readings.target_rad);
  columns.rightCols(setups.cols()) = setups;
  return c.groups.Mean(columns);
}

/// The comparison's orders by turns of its first angle: amplitude and phase of the first channel in one fit beside the
/// constants of the set-ups, what is stated taken off, what the run leaves free not. Uncertainty: the noise model's,
/// scaled by what the fit leaves over. Not included: what is not harmonic.
std::vector<Harmonic> TabulateOrders(const Compared& c, const TwinComparison& comparison, const NoiseModel& noise) {
  const std::vector<TwinComparison::TabulatedOrder> orders = Resolved(c, comparison);
  if (orders.empty()) return {};
  const auto of_first = Eigen::seq(0, Eigen::last, c.run.Channels());
  const Eigen::VectorXd sigma = noise.sigma(of_first),
                        left = (c.run.residual + c.free.columns * c.free.values)(of_first);
  const Eigen::MatrixXd X = sigma.cwiseInverse().asDiagonal() * ColumnsOf(c, orders);
  const Eigen::VectorXd y = left.cwiseQuotient(sigma);
  const Eigen::MatrixXd inverse = GeneralInverseOf(X.transpose() * X);
  const Eigen::VectorXd x = inverse * (X.transpose() * y);
  const double scale2 = (y - X * x).squaredNorm() / std::max<double>(1.0, static_cast<double>(X.rows() - X.cols()));
  std::vector<Harmonic> table;
  Eigen::Index first = 0;
  for (const auto& tabulated : orders) {
    const Polar polar = PolarOf(x.segment<2>(first), scale2 * inverse.block<2, 2>(first, first));
    table.push_back(
        {tabulated.order, polar.size, polar.u_size, polar.phase_rad, polar.u_phase_rad, tabulated.meaning});
    first += 2;
  }
  return table;
}

bool IsOfOutliers(const Cause& cause) {
  return cause.effect == "outliers";
}

bool Continues(const Schedule& s, std::size_t a, std::size_t b) {
  return b < s.pass.size() && s.setup[a] == s.setup[b] && s.pass[a] == s.pass[b] &&
         s.direction[a] == s.direction[b];
}

/// The number of the reading in the middle of each group.
Eigen::VectorXd Middles(const Compared& c) {
  return c.groups.Mean(
      Eigen::Map<const Eigen::VectorXi>(c.readings.reading.data(), c.groups.Samples()).cast<double>());
}

/// One value a group at every reading: on straight lines between the groups of a pass, and on beyond the outermost.
Eigen::VectorXd AtReadings(const Compared& c, const Eigen::VectorXd& of_groups) {
  const Schedule& rows = c.run.schedule;
  const Eigen::VectorXd middle = Middles(c);
  Eigen::VectorXd values(c.groups.Samples());
  for (Eigen::Index g = 0; g < of_groups.size(); ++g) {
    const auto at = static_cast<std::size_t>(g);
    const int first = c.groups.start[at];
    for (int i = first; i < first + c.groups.Size(g); ++i) {
      const double number = c.readings.reading[static_cast<std::size_t>(i)];
      const bool later = number > middle[g];
      const bool has = later ? Continues(rows, at, at + 1) : g > 0 && Continues(rows, at - 1, at);
      const Eigen::Index other = has ? (later ? g + 1 : g - 1) : g;
      const double part = has ? (number - middle[g]) / (middle[other] - middle[g]) : 0.0;
      values[i] = of_groups[g] + part * (of_groups[other] - of_groups[g]);
    }
  }
  return values;
}

void SpreadUnnamed(const Compared& c, Accepted& accepted) {
  const Eigen::VectorXd rows = accepted.columns * accepted.amplitudes;
  accepted.readings = c.readings.reading;
  accepted.times_s = c.readings.time_s;
  accepted.at_readings = AtReadings(c, rows(Eigen::seq(0, Eigen::last, c.run.Channels())));
}

Cause OutliersOf(const TwinComparison& comparison, double count, double size, double log_bayes, double of) {
  Cause cause = DecidedCause("outliers", "", log_bayes);
  const Catalogue catalogue(comparison.format->effects);
  cause.parameters = {catalogue.Estimate("outliers", "fraction", count / of, std::sqrt(count) / of),
                      catalogue.Estimate("outliers", "size", size, size / std::sqrt(2.0 * count))};
  return cause;
}

/// Outliers of groups are outliers of one of their readings, which is farther out by the size of a group.
void MergeOutliers(const Compared& c, const TwinComparison& comparison, Diagnosis& diagnosis) {
  if (std::ranges::count_if(diagnosis.causes, IsOfOutliers) == 0) return;
  const double rows = static_cast<double>(c.groups.Groups()), readings = c.outliers.of;
  double count = 0.0, square = 0.0, log_bayes = 0.0;
  for (const Cause& cause : diagnosis.causes) {
    if (!IsOfOutliers(cause)) continue;
    const bool of_readings = cause.log_evidence == c.outliers.log_bayes;
    const double n = cause.parameters[0].value * (of_readings ? readings : rows);
    count += n;
    square += n * std::pow(cause.parameters[1].value * (of_readings ? 1.0 : readings / rows), 2);
    log_bayes += cause.log_evidence;
  }
  std::erase_if(diagnosis.causes, IsOfOutliers);
  diagnosis.causes.insert(diagnosis.causes.begin(),
                          OutliersOf(comparison, count, std::sqrt(square / count), log_bayes, readings));
}

}  // namespace

std::vector<Cause> OutliersLeftOut(const Compared& c, const TwinComparison& comparison,
                                   const std::vector<std::string>& excluded) {
  if (c.outliers.readings.empty() || std::ranges::count(excluded, std::string("outliers")) > 0) return {};
  return {OutliersOf(comparison, static_cast<double>(c.outliers.readings.size()), c.outliers.size,
                     c.outliers.log_bayes, c.outliers.of)};
}

void ToReadings(const Compared& c, const TwinComparison& comparison, DiagnosisRun& result) {
  Diagnosis& d = result.diagnosis;
  for (Accepted& accepted : result.accepted) {
    if (accepted.family.kind == Kind::kUnknown) SpreadUnnamed(c, accepted);
  }
  MergeOutliers(c, comparison, d);
  d.readings = c.readings.Readings();
  d.harmonics = TabulateOrders(c, comparison, result.noise);
  const double size = static_cast<double>(c.groups.Samples()) / static_cast<double>(c.groups.Groups());
  if (size > 1.5)
    d.notes.push_back(fmt::format("the search and its gain are over means of {:.0f} neighbouring readings", size));
}

}  // namespace twinbench::diagnose
