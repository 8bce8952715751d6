#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "twin/core/errors.h"
#include "twin/diagnose/engine/series_sums.h"
#include "twin/diagnose/tuning.h"
#include "twin/diagnose/unknown/collector.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::unknown {
namespace {

/// From 0 to 1 over the longest stretch, beginning anew in each.
Eigen::VectorXd ShareOfStretch(const Design& d) {
  const Eigen::VectorXd since_s = SinceBegin_s(d.course.time_s, d.series.stretch);
  return since_s / std::max(since_s.maxCoeff(), 1e-6);
}

/// Single modes of few periods (those of more are tones), some together, and a random walk: its cosine modes with
/// amplitudes that fall as 1 / k are the generic form of any slow wander.
void AddWander(Collector& collect) {
  const Design& d = collect.design();
  const Eigen::MatrixXd stretches = model::Indicators(d.series.stretch);
  const Eigen::VectorXd share = ShareOfStretch(d);
  const auto modes = [&](int count, bool falling) {
    return model::InEach(model::CosineModes(share, count, falling), stretches);
  };
  collect.Add(
      "wander", tuning::kWanderModes,
      [share, stretches](int g) {
        return model::InEach(model::CosineModes(share, g + 1, false).rightCols(1), stretches);
      },
      [](int g) { return fmt::format("slow drift, function of time, {} half periods per run", g + 1); });
  collect.TakeAnyCourse();
  collect.Add("wander", modes(tuning::kWanderTogether, false), "slow drift, function of time");
  collect.TakeAnyCourse();
  collect.Add(
      "wander",
      modes(std::max(tuning::kWanderTogether + 1, tuning::kWalkModes / static_cast<int>(stretches.cols())), true),
      "random walk, function of time");
  collect.TakeAnyCourse();
  const Eigen::MatrixXd setups = model::Times(model::Indicators(d.course.setup), d.moved);
  if (stretches.cols() > 1 || setups.cols() < 2) return;
  collect.Add("wander", model::Times(setups, model::ElapsedShare(d.course)),
              "drift that differs from mounting to mounting, function of time");
  collect.GoByTime();
}

void AddTones(Collector& collect) {
  const TimeSeries& series = collect.design().series;
  if (!series.tones) return;
  const Shape frequency = series.Frequency("frequency");
  collect.AddShared(
      "tone", series.tones,
      [values = frequency.value](int g) {
        return fmt::format("tone at {:.4g} Hz, function of time", values[static_cast<std::size_t>(g)]);
      },
      &frequency,
      [design = collect.shared()](const Eigen::VectorXd& f_Hz) { return design->series.ToneAt(f_Hz[0]); });
  collect.GoByTime();
  if (model::Indicators(series.stretch).cols() > 1) return;
  collect.Are([](const Eigen::VectorXd& f_Hz, int) {
    return WaveOf(SignalOf("tone", "", {{"frequency", f_Hz[0]}}));
  });
}

void AddSteps(Collector& collect) {
  const TimeSeries& series = collect.design().series;
  collect.AddShared("step", series.steps, [onsets = series.onsets](int g) {
    return fmt::format("step at reading {:.0f}, function of time", onsets[static_cast<std::size_t>(g)]);
  });
  collect.Are([onsets = series.onsets](const Eigen::VectorXd&, int g) {
    return ColumnOf(SignalOf("step", "", {{"at_reading", onsets[static_cast<std::size_t>(g)]}}));
  });
  collect.GoByTime();
}

/// A stretch of readings in which something touches, and over how many it fades away behind them.
struct Touch {
  int first, end;
  double fades_over;
};

/// Of lengths in ratios of two, each begun at every quarter of its length.
std::vector<Touch> Touches(int readings) {
  std::vector<Touch> touches;
  constexpr int kShortest = 2, kFinest = 256;  // readings; parts of the run
  constexpr double kFadesOver = 2.0;           // of its length
  for (int length = std::max(kShortest, readings / kFinest); length <= readings / 4; length *= 2) {
    for (int first = 1; first + length < readings; first += std::max(1, length / 4))
      touches.push_back({first, first + length, kFadesOver * length});
  }
  return touches;
}

/// While it touches, and what is left of it: readings x 2.
Eigen::MatrixXd CourseOf(const Touch& touch, int readings) {
  Eigen::MatrixXd course = Eigen::MatrixXd::Zero(readings, 2);
  course.col(0).segment(touch.first, touch.end - touch.first).setOnes();
  for (int i = touch.end; i < readings; ++i) course(i, 1) = std::exp(-(i - touch.end) / touch.fades_over);
  return course;
}

/// What each reading and all behind it sum up to, those behind falling by `left` from one to the next.
Eigen::VectorXd FadingSums(const Eigen::VectorXd& values, double left) {
  Eigen::VectorXd sums(values.size() + 1);
  sums[values.size()] = 0.0;
  for (Eigen::Index i = values.size() - 1; i >= 0; --i) sums[i] = values[i] + left * sums[i + 1];
  return sums;
}

/// What each reading of a fading series has in common with itself and with those behind it.
Eigen::VectorXd WithLater(const Banded& T, double left) {
  Eigen::VectorXd all = T.diagonal;
  double share = 2.0;
  for (const Eigen::VectorXd& beside : T.beside) all += (share *= left) * beside;
  return all;
}

/// What joins a touch and what is left of it, of readings `apart`.
double AcrossEnd(const Eigen::VectorXd& beside, Eigen::Index from, Eigen::Index end, Eigen::Index apart, double left) {
  double sum = 0.0;
  for (Eigen::Index i = from; i < end && i + apart < beside.size(); ++i)
    sum += beside[i] * std::pow(left, static_cast<double>(i + apart - end));
  return sum;
}

/// Running sums, once for all touches that fade alike.
class SumsOfTouches : public SeriesSums {
 public:
  /// @param touches  Those that fade over the same number of readings follow each other.
  explicit SumsOfTouches(std::vector<Touch> touches) : touches_(std::move(touches)) {}

  Eigen::MatrixXd Products(const Eigen::MatrixXd& Y) const override {
    Eigen::MatrixXd products(2 * std::ssize(touches_), Y.cols());
    for (Eigen::Index j = 0; j < Y.cols(); ++j) {
      const Eigen::VectorXd behind = FadingSums(Y.col(j), 1.0);
      Eigen::VectorXd fading;
      ForEach([&](Eigen::Index g, const Touch& touch, double left, bool is_new) {
        if (is_new) fading = FadingSums(Y.col(j), left);
        products(2 * g, j) = behind[touch.first] - behind[touch.end];
        products(2 * g + 1, j) = fading[touch.end];
      });
    }
    return products;
  }

  std::vector<Eigen::MatrixXd> Squares(const Banded& T) const override {
    const Eigen::VectorXd behind = FadingSums(T.diagonal, 1.0);
    std::vector<Eigen::VectorXd> pairs;
    for (const Eigen::VectorXd& beside : T.beside) pairs.push_back(FadingSums(beside, 1.0));
    Eigen::VectorXd fading;
    std::vector<Eigen::MatrixXd> squares;
    ForEach([&](Eigen::Index, const Touch& touch, double left, bool is_new) {
      if (is_new) fading = FadingSums(WithLater(T, left), left * left);
      double on = behind[touch.first] - behind[touch.end], both = 0.0;
      for (std::size_t k = 0; k < pairs.size(); ++k) {
        const Eigen::Index from = std::max<Eigen::Index>(touch.first, touch.end - 1 - static_cast<Eigen::Index>(k));
        on += 2.0 * (pairs[k][touch.first] - pairs[k][from]);
        both += AcrossEnd(T.beside[k], from, touch.end, static_cast<Eigen::Index>(k) + 1, left);
      }
      squares.push_back(Eigen::Matrix2d{{on, both}, {both, fading[touch.end]}});
    });
    return squares;
  }

 private:
  /// @param visit  Gets the number of a touch, what is left of it from one reading to the next, and whether that is
  /// another share than of the touch before.
  void ForEach(const std::function<void(Eigen::Index, const Touch&, double, bool)>& visit) const {
    for (std::size_t g = 0; g < touches_.size(); ++g) {
      const Touch& touch = touches_[g];
      visit(static_cast<Eigen::Index>(g), touch, std::exp(-1.0 / touch.fades_over),
            g == 0 || touches_[g - 1].fades_over != touch.fades_over);
    }
  }

  std::vector<Touch> touches_;
};

std::shared_ptr<const Base> BaseOf(const std::vector<Touch>& touches, int readings) {
  return std::make_shared<const Base>(
      Base{static_cast<int>(std::ssize(touches)), 1,
           [readings, touches](int g) { return CourseOf(touches[static_cast<std::size_t>(g)], readings); },
           [touches] { return std::make_unique<const SumsOfTouches>(touches); }});
}

void AddTouches(Collector& collect) {
  const Design& d = collect.design();
  const int readings = d.course.Readings();
  const std::vector<Touch> touches = Touches(readings);
  if (!d.may_be_touched || touches.empty()) return;
  Require(d.channels.size() == 1 && !d.rows, "touches are of an angle device: one channel, a row a reading");
  collect.AddShared("touch", BaseOf(touches, readings), [touches, numbers = d.course.reading](int g) {
    const Touch& touch = touches[static_cast<std::size_t>(g)];
    return fmt::format("offset from reading {} to {} that fades away, function of time",
                       numbers[static_cast<std::size_t>(touch.first)],
                       numbers[static_cast<std::size_t>(touch.end - 1)]);
  });
  collect.TakeAnyCourse();
}

/// What dies out behind every mounting, or creeps on as a logarithm.
void AddRestarts(Collector& collect) {
  const std::vector<double> times_s = {10.0, 30.0, 100.0, 300.0, 1000.0, 3000.0};
  const auto count = static_cast<int>(std::ssize(times_s));
  const Eigen::VectorXd since_s = model::SinceFirst_s(collect.design().course);
  collect.Add(
      "restart", 2 * count,
      [since_s, times_s, count](int g) {
        const Eigen::ArrayXd share = since_s.array() / times_s[static_cast<std::size_t>(g % count)];
        return Eigen::MatrixXd(model::Unit(g < count ? Eigen::VectorXd((-share).exp()) : share.log1p()));
      },
      [times_s, count](int g) {
        return fmt::format("{} that begins again with every mounting, about {:.0f} s, function of time",
                           g < count ? "decay" : "creep", times_s[static_cast<std::size_t>(g % count)]);
      });
  collect.GoByTime();
}

void AddTemperature(Collector& collect) {
  const Design& d = collect.design();
  if (d.above_K.size() == 0) return;
  const std::vector<double> lags_s = {0.0, 300.0, 900.0, 2700.0};
  collect.Add(
      "temperature", static_cast<int>(std::ssize(lags_s)),
      [design = collect.shared(), lags_s](int g) {
        return Eigen::MatrixXd(model::Unit(
            model::Lagged(design->course.time_s, design->above_K, lags_s[static_cast<std::size_t>(g)])));
      },
      [lags_s](int g) {
        return fmt::format("function of temperature with a lag of {:.0f} s", lags_s[static_cast<std::size_t>(g)]);
      });
  collect.GoByTime();
  if (d.twin_is_warm)
    collect.Are([per_K = model::Rms(d.above_K)](const Eigen::VectorXd&, int g) -> std::vector<Product> {
      if (g > 0) return {};  // a lag has a memory
      return ColumnOf(Following(SignalOf("constant"), "temperature", 0.0, per_K));
    });
  constexpr double kLag_s = 600.0;
  collect.Add("temperature rate", model::Unit(d.above_K - model::Lagged(d.course.time_s, d.above_K, kLag_s)),
              "function of the rate of the temperature");
  collect.GoByTime();
}

/// A size that follows the elapsed share of the run, of rms one.
EffectSettings OfTime(const Design& d) {
  const double begin_s = d.course.time_s.minCoeff(), duration_s = d.course.time_s.maxCoeff() - begin_s;
  return Following({}, "time", begin_s, duration_s * model::Rms(model::ElapsedShare(d.course)));
}

/// Waves that grow with something.
void AddGrowing(Collector& collect) {
  const Design& d = collect.design();
  if (d.angles.empty()) return;
  const Angle& angle = d.angles.front();
  const auto add = [&](const Eigen::VectorXd& growing, const std::string& what) {
    collect.AddModulated("growing harmonic", angle, tuning::kModulatedOrders, model::Unit(growing),
                         "order {} synchronous with " + angle.name + " that grows with " + what);
  };
  add(model::ElapsedShare(d.course), "time");
  collect.AreHarmonics(angle, OfTime(d));
  if (d.above_K.size() == 0) return;
  const Eigen::VectorXd about_mean_K = d.above_K.array() - d.above_K.mean();
  add(about_mean_K, "temperature");
  if (d.twin_is_warm)
    collect.AreHarmonics(angle, Following({}, "temperature", d.above_K.mean(), model::Rms(about_mean_K)));
}

void AddTrends(Collector& collect) {
  const Design& d = collect.design();
  collect.Add("trend", model::Unit(model::ElapsedShare(d.course)), "linear trend, function of time");
  collect.Are([factor = OfTime(d)](const Eigen::VectorXd&, int) {
    EffectSettings signal = SignalOf("constant", "", factor.parameters);
    signal.times = factor.times;
    return ColumnOf(signal);
  });
  collect.GoByTime();
  if (!d.angles.empty() && d.angles.front().first_unfree > 0)
    collect.Add("slope", model::Unit(d.angles.front().rad),
                "linear trend synchronous with " + d.angles.front().name + ", same in both directions");
}

}  // namespace

bool TimeFollowsAngle(const Design& d) {
  if (d.angles.empty()) return false;
  const Eigen::VectorXd t = d.course.time_s.array() - d.course.time_s.mean(),
                        a = d.angles.front().rad.array() - d.angles.front().rad.mean();
  return std::abs(t.dot(a)) > 0.999 * t.norm() * a.norm();
}

double TurnsOf(const Design& d) {
  return (d.continued_rad.maxCoeff() - d.continued_rad.minCoeff()) / units::turn;
}

void AddInTime(Collector& collect) {
  AddTrends(collect);
  AddSteps(collect);
  AddTemperature(collect);
  if (TimeFollowsAngle(collect.design())) {
    // Several turns tell what comes back at the same angle from what does not.
    if (TurnsOf(collect.design()) >= tuning::kFewestTurns) AddWander(collect);
    return;
  }
  AddTouches(collect);
  AddWander(collect);
  AddRestarts(collect);
  AddGrowing(collect);
  AddTones(collect);
}

}  // namespace twinbench::diagnose::unknown
