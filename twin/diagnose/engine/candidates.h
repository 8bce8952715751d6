#pragma once

#include <functional>
#include <string>
#include <vector>

#include "twin/core/effect_catalogue.h"
#include "twin/diagnose/engine/family.h"
#include "twin/diagnose/engine/time_series.h"

/// Candidates that are named after an effect of a bench's catalogue: cause = where it shows x signal.
namespace twinbench::diagnose {

using Series = std::function<Eigen::MatrixXd(int grid_point)>;  // samples x amplitudes
using SeriesAt = std::function<Eigen::MatrixXd(const Eigen::VectorXd& shape)>;
using Parameters = std::function<std::vector<ParameterEstimate>(
    const Eigen::VectorXd& shape, const Eigen::VectorXd& amplitudes, const Eigen::MatrixXd& cov)>;

/// `count` values from `first` to `last` in equal ratios, or in equal steps.
std::vector<double> Ratios(double first, double last, int count);
std::vector<double> Even(double first, double last, int count);

/// Of a cos + b sin = size cos(angle + phase): size, phase and their standard uncertainties. The same wave has many
/// sizes and phases; this is the one with size >= 0 and 0 <= phase <= 2 pi.
struct Polar {
  double size, phase_rad, u_size, u_phase_rad;
};
Polar PolarOf(const Eigen::VectorXd& x, const Eigen::MatrixXd& cov);

/// Of a parameter whose place in `cov` (amplitudes, then shapes) is `at`; NaN if it has none there.
double DeviationAt(const Eigen::MatrixXd& cov, Eigen::Index at);

/// A cause and how it shows.
struct Showing {
  std::string effect, where;
  Eigen::MatrixXd pattern;  // channels x 1: what each shows of the signal; empty: signatures are rows already
};

/// Units, bounds and plausible sizes of a bench's effects.
class Catalogue {
 public:
  /// @param entries  Outlive this.
  explicit Catalogue(const std::vector<EffectEntry>& entries) : entries_(&entries) {}

  /// @throws std::logic_error if there is no such effect or parameter.
  const EffectParameter& Entry(const std::string& effect, const std::string& parameter) const;
  Amplitude AmplitudeOf(const std::string& effect, const std::string& parameter) const;
  /// @param values  SI. It may be refined between the least and the largest.
  Shape ShapeOf(const std::string& effect, const std::string& parameter, std::vector<double> values) const;
  ParameterEstimate Estimate(const std::string& effect, const std::string& parameter, double value, double u) const;

 private:
  const EffectEntry& EntryOf(const std::string& effect) const;

  const std::vector<EffectEntry>* entries_;
};

/// Makes the named candidates of one bench.
class Candidates {
 public:
  /// @param rows  From samples to rows of one channel; empty: they are the same.
  Candidates(const Catalogue& catalogue, int channels, const ToRows& rows = {})
      : catalogue_(catalogue), channels_(channels), rows_(rows) {}

  const Catalogue& catalogue() const { return catalogue_; }

  /// One column a parameter; a parameter may come twice, as the cosine and the sine of a wave.
  Family& Add(const Showing& showing, const std::vector<std::string>& parameters, const Eigen::MatrixXd& columns);
  /// With shapes, each with one value a grid point; refined between its bounds.
  Family& AddOver(const Showing& showing, const std::vector<std::string>& parameters, const std::vector<Shape>& shapes,
                  const SeriesAt& at);
  /// Sharing the columns of others.
  Family& AddShared(const Showing& showing, const std::vector<std::string>& parameters,
                    const std::shared_ptr<const Base>& base);

  /// "amplitude" cos(phase + "phase").
  Family& AddWave(const Showing& showing, const Eigen::VectorXd& phase_rad);
  /// The same of several whole orders. @param order  The catalogue's name for it; empty: there is one only.
  Family& AddOrders(const Showing& showing, const std::shared_ptr<const Base>& base, const std::string& order,
                    const std::vector<double>& orders);
  /// Of waves, their cosine and sine, makes "amplitude" and "phase".
  void MakeWaves(Family& family) const;
  /// The same of whole orders: none lies between two.
  void MakeOrders(Family& family) const;
  /// `rate` along time, with "curvature" and without: two families.
  void AddDrift(const Showing& showing, const std::string& rate, const Eigen::VectorXd& time_s);
  /// `size` of the first column, with "curvature" as the share of the second and without: two families.
  void AddStraightAndBent(const Showing& showing, const std::string& size, const Eigen::MatrixXd& straight_and_bend);
  /// `size` of the first column, with "curvature" as the share of the second.
  void AddBent(const Showing& showing, const std::string& size, const Eigen::MatrixXd& straight_and_bend);
  /// A step of size `parameter` at any reading; nothing if there is no room.
  void AddStep(const Showing& showing, const std::string& parameter, const TimeSeries& series);
  /// What a body still has to go after a move: `at` times "amplitude" on arrival, at a "time_constant".
  ///
  /// Sizes are thought of as what is left at the soonest reading: with a short time constant that is little of what the
  /// catalogue's amplitude, on arrival, may be.
  /// @param soonest_s  From arrival to the first reading that any stop has.
  void AddSettling(const Showing& showing, double soonest_s, const SeriesAt& at);
  /// "amplitude" cos(2 pi "frequency" t + "phase"), with a size and phase of its own in each stretch; nothing if
  /// there is no room. @param sine  The catalogue counts the phase of a sine.
  void AddTone(const Showing& showing, const TimeSeries& series, bool sine = false);

  std::shared_ptr<const Base> BaseOf(int grid, const Series& series) const;
  std::vector<Family> Take() { return std::move(families_); }

 private:
  Family& New(const Showing& showing, const std::vector<std::string>& parameters);

  Catalogue catalogue_;
  int channels_;
  ToRows rows_;
  std::vector<Family> families_;
};

/// Sizes such that each amplitude leaves a trace of `plausible` rms in the channel that sees it best, in the middle of
/// the grid: where a device may be of any quality.
void SetSizesByTrace(int channels, double plausible, Family& family);

}  // namespace twinbench::diagnose
