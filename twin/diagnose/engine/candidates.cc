#include "twin/diagnose/engine/candidates.h"

#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/core/units.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose {

std::vector<double> Ratios(double first, double last, int count) {
  std::vector<double> values;
  for (int k = 0; k < count; ++k) values.push_back(first * std::pow(last / first, k / std::max(1.0, count - 1.0)));
  return values;
}

std::vector<double> Even(double first, double last, int count) {
  std::vector<double> values;
  for (int k = 0; k < count; ++k) values.push_back(first + (last - first) * k / std::max(1.0, count - 1.0));
  return values;
}

Polar PolarOf(const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
  const double size = x.head<2>().norm(), safe = std::max(size, 1e-300);
  const Eigen::Vector2d along = x.head<2>() / safe, across(-along[1], along[0]);
  const Eigen::Matrix2d c = cov.topLeftCorner<2, 2>();
  const double phase_rad = -std::atan2(x[1], x[0]);
  return {size, phase_rad < 0.0 ? phase_rad + 2.0 * units::kPi : phase_rad, std::sqrt(along.dot(c * along)),
          std::sqrt(across.dot(c * across)) / safe};
}

double DeviationAt(const Eigen::MatrixXd& cov, Eigen::Index at) {
  return at < cov.cols() ? std::sqrt(cov(at, at)) : kNaN;
}

const EffectEntry& Catalogue::EntryOf(const std::string& effect) const {
  const auto entry = std::ranges::find(*entries_, effect, &EffectEntry::name);
  Require(entry != entries_->end(), "a family names an effect that the catalogue has not");
  return *entry;
}

const EffectParameter& Catalogue::Entry(const std::string& effect, const std::string& parameter) const {
  const std::vector<EffectParameter>& parameters = EntryOf(effect).parameters;
  const auto found = std::ranges::find(parameters, parameter, &EffectParameter::name);
  Require(found != parameters.end(), "a family names a parameter that the catalogue has not");
  return *found;
}

Amplitude Catalogue::AmplitudeOf(const std::string& effect, const std::string& parameter) const {
  const EffectParameter& p = Entry(effect, parameter);
  return {parameter, p.unit, p.to_SI, EntryOf(effect).Plausible(p), p.lower_SI, p.upper_SI};
}

Shape Catalogue::ShapeOf(const std::string& effect, const std::string& parameter,
                         std::vector<double> values) const {
  const EffectParameter& p = Entry(effect, parameter);
  const auto [least, most] = std::ranges::minmax(values);
  return {parameter, p.unit, p.to_SI, std::max(p.lower_SI, least), std::min(p.upper_SI, most), std::move(values)};
}

ParameterEstimate Catalogue::Estimate(const std::string& effect, const std::string& parameter, double value,
                                      double u) const {
  const EffectParameter& p = Entry(effect, parameter);
  return {p.name, p.unit, p.to_SI, value, u, p.lower_SI, p.upper_SI};
}

namespace {

Eigen::MatrixXd AsRows(const Eigen::MatrixXd& samples, const Eigen::MatrixXd& pattern, const ToRows& rows) {
  if (pattern.size() == 0) return samples;
  const auto channels = static_cast<int>(pattern.rows());
  return OnEachChannel(rows ? rows(samples) : samples, channels) * PatternMap(pattern, samples.cols());
}

double Wrapped(double phase_rad) {
  return phase_rad - units::turn * std::floor(phase_rad / units::turn);
}

/// The mean size over the stretches, the phase in the first: where time began.
Polar MeanOfStretches(const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
  const Eigen::Index stretches = x.size() / 2;
  Polar mean = PolarOf(x.head<2>(), cov.topLeftCorner<2, 2>());
  double size = 0.0, variance = 0.0;
  for (Eigen::Index k = 0; k < stretches; ++k) {
    const Polar own = PolarOf(x.segment<2>(2 * k), cov.block<2, 2>(2 * k, 2 * k));
    size += own.size / static_cast<double>(stretches);
    variance += std::pow(own.u_size / static_cast<double>(stretches), 2);
  }
  mean.size = size;
  mean.u_size = std::sqrt(variance);
  return mean;
}

}  // namespace

std::shared_ptr<const Base> Candidates::BaseOf(int grid, const Series& series) const {
  auto base = std::make_shared<Base>();
  base->grid = grid;
  base->channels = channels_;
  base->series = series;
  if (rows_) base->series = [rows = rows_, series](int g) { return rows(series(g)); };
  return base;
}

Family& Candidates::New(const Showing& showing, const std::vector<std::string>& parameters) {
  Family& family = families_.emplace_back();
  family.kind = Kind::kNamed;
  family.effect = family.group = showing.effect;
  family.where = showing.where;
  for (const std::string& parameter : parameters)
    family.amplitudes.push_back(catalogue_.AmplitudeOf(showing.effect, parameter));
  return family;
}

Family& Candidates::Add(const Showing& showing, const std::vector<std::string>& parameters,
                        const Eigen::MatrixXd& columns) {
  Family& family = New(showing, parameters);
  family.columns = [rows = AsRows(columns, showing.pattern, rows_)](int) { return rows; };
  return family;
}

Family& Candidates::AddOver(const Showing& showing, const std::vector<std::string>& parameters,
                            const std::vector<Shape>& shapes, const SeriesAt& at) {
  Family& family = New(showing, parameters);
  family.shapes = shapes;
  family.grid = static_cast<int>(std::ssize(shapes.front().value));
  family.at = [pattern = showing.pattern, rows = rows_, at](const Eigen::VectorXd& shape) {
    return AsRows(at(shape), pattern, rows);
  };
  std::vector<Eigen::VectorXd> grid;
  for (int g = 0; g < family.grid; ++g) grid.push_back(family.ShapeAt(g));
  family.columns = [rows_at = family.at, grid](int g) { return rows_at(grid[static_cast<std::size_t>(g)]); };
  return family;
}

Family& Candidates::AddShared(const Showing& showing, const std::vector<std::string>& parameters,
                              const std::shared_ptr<const Base>& base) {
  Family& family = New(showing, parameters);
  family.grid = base->grid;
  family.base = base;
  family.map = PatternMap(showing.pattern, std::ssize(parameters) / showing.pattern.cols());
  return family;
}

Family& Candidates::AddWave(const Showing& showing, const Eigen::VectorXd& phase_rad) {
  return AddOrders(showing, BaseOf(1, [wave = model::Wave(phase_rad)](int) { return wave; }), "", {});
}

Family& Candidates::AddOrders(const Showing& showing, const std::shared_ptr<const Base>& base,
                              const std::string& order, const std::vector<double>& orders) {
  Family& family = AddShared(showing, {"amplitude", "amplitude"}, base);
  if (!order.empty()) family.shapes = {catalogue_.ShapeOf(showing.effect, order, orders)};
  MakeOrders(family);
  return family;
}

void Candidates::MakeOrders(Family& family) const {
  family.at = nullptr;
  MakeWaves(family);
}

void Candidates::MakeWaves(Family& family) const {
  family.amplitudes[0].name = "cosine";
  family.amplitudes[1].name = "sine";
  const std::string shape_name = family.shapes.empty() ? "" : family.shapes.front().name;
  const bool is_whole = !family.at;
  family.parameters = [catalogue = catalogue_, effect = family.effect, shape_name, is_whole](
                          const Eigen::VectorXd& shape, const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
    const Polar polar = PolarOf(x, cov);
    std::vector<ParameterEstimate> estimates = {
        catalogue.Estimate(effect, "amplitude", polar.size, polar.u_size),
        catalogue.Estimate(effect, "phase", polar.phase_rad, polar.u_phase_rad)};
    const double u_shape = is_whole ? 0.0 : DeviationAt(cov, x.size());
    if (!shape_name.empty())
      estimates.insert(estimates.begin(), catalogue.Estimate(effect, shape_name, shape[0], u_shape));
    return estimates;
  };
}

void Candidates::AddDrift(const Showing& showing, const std::string& rate, const Eigen::VectorXd& time_s) {
  AddStraightAndBent(showing, rate, model::Drift_s(time_s));
}

void Candidates::AddStraightAndBent(const Showing& showing, const std::string& rate,
                                    const Eigen::MatrixXd& straight_and_bend) {
  Family& steady = Add(showing, {rate}, straight_and_bend.leftCols(1));
  const auto estimate = [catalogue = catalogue_, effect = showing.effect](const std::string& name, double value,
                                                                          double u) {
    return catalogue.Estimate(effect, name, value, u);
  };
  steady.parameters = [=](const Eigen::VectorXd&, const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
    return std::vector{estimate(rate, x[0], std::sqrt(cov(0, 0))), estimate("curvature", 0.0, kNaN)};
  };
  AddBent(showing, rate, straight_and_bend);
}

void Candidates::AddBent(const Showing& showing, const std::string& size, const Eigen::MatrixXd& straight_and_bend) {
  Family& bent = Add(showing, {size, size}, straight_and_bend);
  bent.amplitudes[1].name = "bend";
  bent.parameters = [catalogue = catalogue_, effect = showing.effect, size](
                        const Eigen::VectorXd&, const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
    const double curvature = x[1] / x[0];
    const Eigen::Vector2d slope(-curvature / x[0], 1.0 / x[0]);
    const double u = std::sqrt(slope.dot(cov.topLeftCorner<2, 2>() * slope));
    return std::vector{catalogue.Estimate(effect, size, x[0], std::sqrt(cov(0, 0))),
                       catalogue.Estimate(effect, "curvature", curvature, u)};
  };
}

void Candidates::AddStep(const Showing& showing, const std::string& parameter, const TimeSeries& series) {
  if (!series.steps) return;
  Family& family = AddShared(showing, {parameter}, series.steps);
  family.shapes = {catalogue_.ShapeOf(showing.effect, "at_reading", series.onsets)};
  if (!series.are_thinned) return;
  family.at = [series, pattern = showing.pattern, rows = rows_](const Eigen::VectorXd& at_reading) {
    return AsRows(series.StepAt(at_reading[0]), pattern, rows);
  };
  family.parameters = [catalogue = catalogue_, effect = showing.effect, parameter](
                          const Eigen::VectorXd& shape, const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
    return std::vector{catalogue.Estimate(effect, parameter, x[0], std::sqrt(cov(0, 0))),
                       catalogue.Estimate(effect, "at_reading", std::round(shape[0]), DeviationAt(cov, 1))};
  };
}

void Candidates::AddSettling(const Showing& showing, double soonest_s, const SeriesAt& at) {
  constexpr double kShortest = 0.125, kLongest_s = 30.0;  // of soonest_s: e^-8 is left; slower is a drift
  const std::vector<double> times_s = Ratios(kShortest * soonest_s, std::max(kLongest_s, soonest_s), 14);
  const auto grown = [soonest_s](double tau_s) { return std::exp(soonest_s / tau_s); };
  Family& family = AddOver(showing, {"amplitude"}, {catalogue_.ShapeOf(showing.effect, "time_constant", times_s)},
                           [at, grown](const Eigen::VectorXd& tau_s) -> Eigen::MatrixXd {
                             return grown(tau_s[0]) * at(tau_s);
                           });
  family.parameters = [catalogue = catalogue_, effect = showing.effect, soonest_s, grown](
                          const Eigen::VectorXd& shape, const Eigen::VectorXd& x, const Eigen::MatrixXd& cov) {
    const double tau_s = shape[0], scale = grown(tau_s);
    const Eigen::Vector2d slope(scale, -x[0] * scale * soonest_s / (tau_s * tau_s));
    const bool has_shape = cov.rows() > 1;
    const double variance = has_shape ? slope.dot(cov.topLeftCorner<2, 2>() * slope) : scale * scale * cov(0, 0);
    return std::vector{catalogue.Estimate(effect, "amplitude", scale * x[0], std::sqrt(variance)),
                       catalogue.Estimate(effect, "time_constant", tau_s, DeviationAt(cov, x.size()))};
  };
}

void Candidates::AddTone(const Showing& showing, const TimeSeries& series, bool sine) {
  if (!series.tones) return;
  const auto columns = static_cast<std::size_t>(series.tones->series(0).cols() * showing.pattern.cols());
  Family& family = AddShared(showing, std::vector<std::string>(columns, "amplitude"), series.tones);
  Shape frequency = catalogue_.ShapeOf(showing.effect, "frequency", series.frequencies_Hz);
  frequency.lower = series.Frequency("").lower;
  frequency.upper = series.Frequency("").upper;
  family.shapes = {frequency};
  family.at = [series, pattern = showing.pattern, rows = rows_](const Eigen::VectorXd& frequency_Hz) {
    return AsRows(series.ToneAt(frequency_Hz[0]), pattern, rows);
  };
  family.parameters = [catalogue = catalogue_, effect = showing.effect, sine, lower = frequency.lower,
                       upper = frequency.upper](const Eigen::VectorXd& shape, const Eigen::VectorXd& x,
                                                const Eigen::MatrixXd& cov) {
    const Polar polar = MeanOfStretches(x, cov);
    ParameterEstimate told_Hz = catalogue.Estimate(effect, "frequency", shape[0], DeviationAt(cov, x.size()));
    told_Hz.lower = lower;
    told_Hz.upper = upper;
    const double phase_rad = Wrapped(polar.phase_rad + (sine ? 0.25 * units::turn : 0.0));
    return std::vector{catalogue.Estimate(effect, "amplitude", polar.size, polar.u_size),
                       told_Hz, catalogue.Estimate(effect, "phase", phase_rad, polar.u_phase_rad)};
  };
}

void SetSizesByTrace(int channels, double plausible, Family& family) {
  const Eigen::MatrixXd columns = family.ColumnsAt(family.grid / 2);
  for (std::size_t j = 0; j < family.amplitudes.size(); ++j) {
    const Eigen::VectorXd column = columns.col(static_cast<Eigen::Index>(j));
    const Eigen::Map<const Eigen::MatrixXd> by_channel(column.data(), channels, column.size() / channels);
    const double rms =
        std::sqrt(by_channel.rowwise().squaredNorm().maxCoeff() / static_cast<double>(by_channel.cols()));
    family.amplitudes[j].prior_sd = plausible / std::max(rms, 1e-12);
  }
}

}  // namespace twinbench::diagnose
