#include "twin/diagnose/engine/time_series.h"

#include <algorithm>
#include <map>

#include "twin/core/distributions.h"
#include "twin/core/units.h"
#include "twin/diagnose/tuning.h"
#include "twin/model/signals.h"
#include "twin/model/wave_grid.h"

namespace twinbench::diagnose {
namespace {

/// Of all readings from the onset on.
class SumsOfSteps : public SeriesSums {
 public:
  /// @param from  By onset: the first reading that has the step.
  explicit SumsOfSteps(std::vector<Eigen::Index> from) : from_(std::move(from)) {}

  Eigen::MatrixXd Products(const Eigen::MatrixXd& Y) const override {
    Eigen::MatrixXd products(std::ssize(from_), Y.cols());
    for (Eigen::Index j = 0; j < Y.cols(); ++j) {
      double sum = 0.0;
      Eigen::Index next = Y.rows();
      for (Eigen::Index g = products.rows() - 1; g >= 0; --g) {
        const Eigen::Index from = from_[static_cast<std::size_t>(g)];
        sum += Y.col(j).segment(from, next - from).sum();
        products(g, j) = sum;
        next = from;
      }
    }
    return products;
  }

  std::vector<Eigen::MatrixXd> Squares(const Banded& T) const override {
    Eigen::MatrixXd with_later = T.diagonal;
    for (const Eigen::VectorXd& beside : T.beside) with_later += 2.0 * beside;
    const Eigen::MatrixXd squares = Products(with_later);
    std::vector<Eigen::MatrixXd> by_point;
    for (const double square : squares.reshaped()) by_point.push_back(Eigen::MatrixXd::Constant(1, 1, square));
    return by_point;
  }

 private:
  std::vector<Eigen::Index> from_;
};

/// Steps (model::Step) at each of `onsets`, on the one channel of a bench: their sums are running sums.
/// @param reading  Numbers of the readings, ascending.
/// @param onsets   Numbers of readings at which something may begin.
std::shared_ptr<const Base> StepBase(const std::vector<int>& reading, const std::vector<double>& onsets) {
  if (onsets.empty()) return nullptr;
  std::vector<Eigen::Index> from;
  for (const double onset : onsets) from.push_back(std::ranges::lower_bound(reading, onset) - reading.begin());
  return std::make_shared<const Base>(Base{static_cast<int>(std::ssize(onsets)), 1,
                                           [reading, onsets](int g) {
                                             return Eigen::MatrixXd(
                                                 model::Step(reading, onsets[static_cast<std::size_t>(g)]));
                                           },
                                           [from] { return std::make_unique<const SumsOfSteps>(from); }});
}

/// A little closer than the longest stretch can tell apart, from where a wander ends to one of two usual rows.
std::vector<double> FrequenciesOf(double longest_s, const Eigen::VectorXd& rows_time_s) {
  if (rows_time_s.size() < 3) return {};
  std::vector<double> steps_s;
  for (Eigen::Index i = 1; i < rows_time_s.size(); ++i) steps_s.push_back(rows_time_s[i] - rows_time_s[i - 1]);
  const double usual_s = std::max(Median(std::move(steps_s)), 1e-6);
  const double width_Hz = tuning::kToneSpacing / std::max(longest_s, usual_s), last_Hz = 0.5 / usual_s;
  const double first_Hz = tuning::kFirstTone * width_Hz,
               step_Hz = std::max(width_Hz, (last_Hz - first_Hz) / tuning::kMostTones);
  std::vector<double> frequencies_Hz;
  for (int k = 0; first_Hz + k * step_Hz < last_Hz; ++k) frequencies_Hz.push_back(first_Hz + k * step_Hz);
  return frequencies_Hz;
}

std::shared_ptr<const Base> BaseOf(std::size_t grid, int channels, const ToRows& rows,
                                   const std::function<Eigen::MatrixXd(int)>& series) {
  if (grid == 0) return nullptr;
  auto base = std::make_shared<Base>();
  base->grid = static_cast<int>(grid);
  base->channels = channels;
  base->series = series;
  if (rows) base->series = [rows, series](int g) { return rows(series(g)); };
  return base;
}

/// On the grid of frequencies, in each stretch.
std::shared_ptr<const Base> TonesOf(const TimeSeries& series, int channels, const ToRows& rows) {
  const std::vector<double>& f_Hz = series.frequencies_Hz;
  if (f_Hz.size() < 2) return nullptr;
  const auto count = static_cast<int>(std::ssize(f_Hz));
  const Eigen::VectorXd phase_rad = units::turn * series.time_s;
  const Eigen::MatrixXd stretches = model::Indicators(series.stretch);
  if (stretches.cols() == 1) {
    const WaveSeries waves{phase_rad, f_Hz[0], f_Hz[1] - f_Hz[0], NumbersTo(count)};
    return diagnose::BaseOf(waves, channels, rows);
  }
  const auto waves = std::make_shared<const model::WaveGrid>(phase_rad, f_Hz[0], f_Hz[1] - f_Hz[0], count);
  return BaseOf(f_Hz.size(), channels, rows,
                [waves, stretches](int g) -> Eigen::MatrixXd { return model::InEach(waves->At(g), stretches); });
}

}  // namespace

Onsets OnsetsOf(const model::Course& course) {
  std::vector<double> all;
  for (std::size_t i = 1; i < course.reading.size(); ++i) {
    if (course.setup[i] == course.setup[i - 1] && course.phase[i] == course.phase[i - 1])
      all.push_back(course.reading[i]);
  }
  const std::size_t every = 1 + all.size() / tuning::kMostSteps;
  Onsets onsets{{}, every > 1};
  for (std::size_t k = every / 2; k < all.size(); k += every) onsets.at_reading.push_back(all[k]);
  return onsets;
}

Shape TimeSeries::Frequency(const std::string& name) const {
  return {name, "Hz", 1.0, 0.5 * frequencies_Hz.front(), 1.1 * frequencies_Hz.back(), frequencies_Hz};
}

Eigen::MatrixXd TimeSeries::ToneAt(double frequency_Hz) const {
  return model::InEach(model::Tone(time_s, frequency_Hz), model::Indicators(stretch));
}

Eigen::MatrixXd TimeSeries::StepAt(double at_reading) const {
  return model::Step(reading, at_reading);
}

TimeSeries TimeSeriesOf(const model::Course& course, const std::vector<int>& stretch, int channels,
                        const ToRows& rows, const Eigen::VectorXd& rows_time_s) {
  TimeSeries series;
  series.time_s = course.time_s;
  series.reading = course.reading;
  series.stretch = stretch;
  const Onsets onsets = OnsetsOf(course);
  series.onsets = onsets.at_reading;
  series.are_thinned = onsets.are_thinned;
  const double longest_s = SinceBegin_s(course.time_s, stretch).maxCoeff();
  series.frequencies_Hz = FrequenciesOf(longest_s, rows_time_s.size() > 0 ? rows_time_s : course.time_s);
  series.tones = TonesOf(series, channels, rows);
  const bool is_one = channels == 1 && !rows && std::ranges::is_sorted(course.reading);
  series.steps =
      is_one
          ? StepBase(course.reading, series.onsets)
          : BaseOf(series.onsets.size(), channels, rows, [reading = course.reading, onsets = series.onsets](int g) {
              return Eigen::MatrixXd(model::Step(reading, onsets[static_cast<std::size_t>(g)]));
            });
  return series;
}

Eigen::VectorXd SinceBegin_s(const Eigen::VectorXd& time_s, const std::vector<int>& label) {
  std::map<int, double> begin_s;
  Eigen::VectorXd since_s(time_s.size());
  for (Eigen::Index i = 0; i < time_s.size(); ++i)
    since_s[i] = time_s[i] - begin_s.try_emplace(label[static_cast<std::size_t>(i)], time_s[i]).first->second;
  return since_s;
}

}  // namespace twinbench::diagnose
