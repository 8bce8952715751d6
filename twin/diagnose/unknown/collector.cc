#include "twin/diagnose/unknown/collector.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/signal_effect.h"
#include "twin/diagnose/tuning.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::unknown {
namespace {

Eigen::MatrixXd AsRows(const Design& design, const Eigen::MatrixXd& samples) {
  return design.rows ? design.rows(samples) : samples;
}

/// Of a pattern: where it shows most.
int ShowsMostOn(const Eigen::MatrixXd& pattern, Eigen::Index column) {
  int channel = 0;
  pattern.col(column).cwiseAbs().maxCoeff(&channel);
  return channel;
}

/// -1: it is no channel's name.
int ChannelNamed(const Design& design, const std::string& name) {
  const auto found = std::ranges::find(design.channels, name);
  return found == design.channels.end() ? -1 : static_cast<int>(found - design.channels.begin());
}

/// Rows over the scale of their channels.
Eigen::MatrixXd Scaled(const Design& design, Eigen::MatrixXd rows) {
  const Eigen::Index channels = std::ssize(design.channels);
  for (Eigen::Index c = 0; c < channels; ++c)
    rows(Eigen::seq(c, Eigen::last, channels), Eigen::all) /= design.ScaleOf(c);
  return rows;
}

/// Of the column that is seen best.
double LargestRms(const Eigen::MatrixXd& columns) {
  const double rows = static_cast<double>(std::max<Eigen::Index>(1, columns.rows()));
  return std::sqrt(columns.colwise().squaredNorm().maxCoeff() / rows);
}

/// Coefficients of many columns say nothing by themselves: their amplitude is told as that of a wave that goes as far from its mean
/// in the readings. The mean may be that of a zero which is free.
void TellAsShown(Family& family) {
  family.describe = [words = family.describe, base = family.base](int g, const Eigen::VectorXd& x, const Eigen::VectorXd& shape) {
    const Eigen::MatrixXd series = base->series(g);
    const Eigen::MatrixXd shown = series * x.reshaped(series.cols(), x.size() / series.cols());
    const double amplitude = std::sqrt(2.0 / static_cast<double>(shown.rows())) * (shown.rowwise() - shown.colwise().mean()).norm();
    return words(g, Eigen::VectorXd::Constant(1, amplitude), shape);
  };
}

}  // namespace

double Design::RangeOf(int channel) const {
  if (shown.size() == 0) return 0.0;
  if (units.empty()) return shown.cwiseAbs().maxCoeff();
  double range = 0.0;
  for (std::size_t c = 0; c < units.size(); ++c) {
    if (units[c].name == units[static_cast<std::size_t>(channel)].name)
      range = std::max(range, shown.col(static_cast<Eigen::Index>(c)).cwiseAbs().maxCoeff());
  }
  return range;
}

Eigen::MatrixXd OnChannel(const Design& design, const Eigen::MatrixXd& samples, int channel) {
  const Eigen::MatrixXd values = AsRows(design, samples);
  const Eigen::Index channels = std::ssize(design.channels);
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(values.rows() * channels, values.cols());
  for (Eigen::Index i = 0; i < values.rows(); ++i) rows.row(i * channels + channel) = values.row(i);
  return rows;
}

Family& Collector::New(const std::string& sort, const std::string& where, const std::string& on, int channel,
                       const AnyWords& words) {
  Family& family = families_.emplace_back();
  family.kind = Kind::kUnknown;
  family.effect = family.group = sort;
  family.where = where;
  if (const auto named = design_->named.find(sort); named != design_->named.end()) {
    family.prior_weight = tuning::kSameShape;
    family.same_as = named->second;
  }
  const bool is_mixed = !design_->units.empty();
  if (is_mixed && channel < 0) {
    family.describe = [on, words](int g, const Eigen::VectorXd&, const Eigen::VectorXd& shape) { return fmt::format("{}, on {}", words(g, shape), on); };
    return family;
  }
  const ChannelUnit unit =
      is_mixed ? design_->units[static_cast<std::size_t>(channel)] : ChannelUnit{design_->unit, design_->to_SI};
  family.describe = [on, words, unit](int g, const Eigen::VectorXd& x, const Eigen::VectorXd& shape) {
    return fmt::format("{}, on {}, amplitude {:.2g} {}", words(g, shape), on, x.norm() / unit.to_SI, unit.name);
  };
  return family;
}

std::shared_ptr<const Base> Collector::BaseOf(int grid, const Series& series) const {
  auto base = std::make_shared<Base>();
  base->grid = grid;
  base->channels = static_cast<int>(std::ssize(design_->channels));
  base->series = [design = design_, series](int g) { return AsRows(*design, series(g)); };
  return base;
}

void Collector::AddShared(const std::string& sort, const std::shared_ptr<const Base>& base, const Words& words,
                          const Shape* shape, const SeriesAt& at) {
  AddOnPlaces(sort, base, [words](int g, const Eigen::VectorXd&) { return words(g); }, shape, at);
}

void Collector::AddOnPlaces(const std::string& sort, const std::shared_ptr<const Base>& base, const AnyWords& words,
                            const Shape* shape, const SeriesAt& at) {
  last_ = families_.size();
  if (!base || base->grid < 1) return;
  const Eigen::MatrixXd middle = base->series(base->grid / 2);
  const double rms = LargestRms(middle);
  if (!(rms > 0.0)) return;
  for (const Place& place : design_->places) {
    Family& family = New(sort, place.name, place.words, ShowsMostOn(place.pattern, 0), words);
    family.grid = base->grid;
    family.base = base;
    family.map = PatternMap(place.pattern, middle.cols());
    for (Eigen::Index k = 0; k < family.map.cols(); ++k) {
      const double scale = design_->ScaleOf(ShowsMostOn(place.pattern, k / middle.cols()));
      family.amplitudes.push_back({"amplitude", design_->unit, design_->to_SI, scale * design_->plausible / rms});
    }
    if (middle.cols() > 2) TellAsShown(family);
    if (!shape) continue;
    family.shapes = {*shape};
    family.at = [design = design_, at, map = family.map](const Eigen::VectorXd& value) -> Eigen::MatrixXd {
      return OnEachChannel(AsRows(*design, at(value)), static_cast<int>(std::ssize(design->channels))) * map;
    };
  }
}

void Collector::Add(const std::string& sort, int grid, const Series& series, const Words& words) {
  last_ = families_.size();
  if (grid > 0) AddShared(sort, BaseOf(grid, series), words);
}

void Collector::Add(const std::string& sort, const Eigen::MatrixXd& series, const std::string& words) {
  last_ = families_.size();
  if (series.cols() == 0) return;
  Add(
      sort, 1, [series](int) { return series; }, [words](int) { return words; });
}

void Collector::AddOver(const std::string& sort, const Shape& shape, const SeriesAt& at, const Words& words) {
  last_ = families_.size();
  if (shape.value.empty()) return;
  const Series on_grid = [at, values = shape.value](int g) {
    return at(Eigen::VectorXd::Constant(1, values[static_cast<std::size_t>(g)]));
  };
  AddShared(sort, BaseOf(static_cast<int>(std::ssize(shape.value)), on_grid), words, &shape, at);
}

void Collector::AddWaves(const std::string& sort, const WaveSeries& waves, const Words& words, const Shape* shape,
                         const SeriesAt& at) {
  AddShared(sort, diagnose::BaseOf(waves, static_cast<int>(std::ssize(design_->channels)), design_->rows), words,
            shape, at);
}

void Collector::AddWaves(const std::string& sort, const WaveSeries& waves, const WordsOfShape& words, const Shape& shape,
                         const SeriesAt& at) {
  AddOnPlaces(sort, diagnose::BaseOf(waves, static_cast<int>(std::ssize(design_->channels)), design_->rows),
              [words](int, const Eigen::VectorXd& value) { return words(value); }, &shape, at);
}

void Collector::AddModulated(const std::string& sort, const Angle& angle, int last, const Eigen::VectorXd& factor,
                             const std::string& words) {
  const int count = std::min(last, angle.last_order);
  AddWaves(sort, {angle.rad, 1.0, 1.0, NumbersTo(std::max(0, count)), factor.cwiseProduct(design_->moved)},
           [words](int g) { return fmt::format(fmt::runtime(words), g + 1); });
}

void Collector::AddRows(const std::string& sort, const std::string& where, int grid, const Series& rows,
                        const Words& words) {
  last_ = families_.size();
  const Eigen::MatrixXd middle = rows(grid / 2);
  const double channel_rms =
      LargestRms(Scaled(*design_, middle)) * std::sqrt(static_cast<double>(std::ssize(design_->channels)));
  if (!(channel_rms > 0.0)) return;
  const int channel = ChannelNamed(*design_, where), first = std::max(0, channel);
  Family& family = New(sort, where, where == "all" ? "all channels" : where, channel,
                       [words](int g, const Eigen::VectorXd&) { return words(g); });
  family.grid = grid;
  family.columns = rows;
  const double range = design_->RangeOf(first) / design_->ScaleOf(first);
  const double plausible = std::max(design_->plausible, design_->plausible_share * range);
  family.amplitudes.assign(static_cast<std::size_t>(middle.cols()),
                           {"amplitude", design_->unit, design_->to_SI, plausible / channel_rms});
}

void Collector::AddRows(const std::string& sort, const std::string& where, const Eigen::MatrixXd& rows,
                        const std::string& words) {
  AddRows(
      sort, where, 1, [rows](int) { return rows; }, [words](int) { return words; });
}

void Collector::Are(const Products& products) {
  for (std::size_t k = last_; k < families_.size(); ++k) families_[k].products = products;
}

void Collector::GoByTime() {
  for (std::size_t k = last_; k < families_.size(); ++k) families_[k].goes_by_time = true;
}

void Collector::TakeAnyCourse() {
  GoByTime();
  for (std::size_t k = last_; k < families_.size(); ++k) families_[k].takes_any_course = true;
}

void Collector::AreHarmonics(const Angle& angle, const EffectSettings& factor) {
  if (angle.by.empty()) return;
  Are([by = angle.by, factor](const Eigen::VectorXd&, int g) {
    EffectSettings signal = SignalOf("harmonic", by, factor.parameters);
    signal.parameters["order"] = g + 1;
    signal.times = factor.times;
    return WaveOf(signal);
  });
}

EffectSettings SignalOf(const std::string& kind, const std::string& by,
                        const std::map<std::string, double>& parameters) {
  EffectSettings signal;
  signal.name = kSignalEffect;
  signal.signal = kind;
  signal.by = by;
  signal.parameters = parameters;
  return signal;
}

EffectSettings Following(EffectSettings signal, const std::string& times, double about, double per) {
  signal.times = times;
  if (times == "direction") return signal;
  signal.parameters["about"] = about;
  signal.parameters["per"] = per;
  return signal;
}

std::vector<Product> WaveOf(const EffectSettings& signal) {
  return {{signal, 0, true, 1.0}};
}

std::vector<Product> ColumnOf(const EffectSettings& signal, double scale) {
  return {{signal, 0, false, scale}};
}

}  // namespace twinbench::diagnose::unknown
