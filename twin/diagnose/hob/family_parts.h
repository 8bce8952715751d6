#pragma once

#include <memory>
#include <string>
#include <vector>

#include "twin/diagnose/engine/catalogue_parts.h"
#include "twin/diagnose/engine/time_series.h"
#include "twin/diagnose/hob/hob_run.h"

/// What the makers of families have in common; only they need it.
namespace twinbench::diagnose::hob {

using Context = std::shared_ptr<const SignalContext>;
using Series = std::function<Eigen::MatrixXd(int grid_point)>;  // samples x k
using SeriesAt = std::function<Eigen::MatrixXd(const Eigen::VectorXd& shape)>;
using Parameters = std::function<std::vector<ParameterEstimate>(
    const Eigen::VectorXd& shape, const Eigen::VectorXd& amplitudes, const Eigen::MatrixXd& cov)>;

/// Prior size of an amplitude that Families sets from the plausible trace.
inline constexpr double kPriorToBeSet = -1.0;

/// Rows of the run from series of samples; families with the same one share its columns.
using SharedBase = std::shared_ptr<const Base>;
SharedBase BaseOf(const Context& context, int grid, const Series& series);

/// Waves of `count` whole orders from `first` on of an angle, times a factor of each sample unless that is empty.
SharedBase OrdersOf(const Context& context, const Eigen::VectorXd& angle_rad, int first, int count,
                    const Eigen::VectorXd& factor = {});

/// From the columns of a base with `columns` series: those that see it, times a factor.
Eigen::MatrixXd Shown(const SignalContext& context, Eigen::Index columns, Seen seen, double factor = 1.0);

/// Everything that a family of one place needs besides its amplitudes.
struct Source {
  SharedBase base;
  Seen seen = Seen::kByBoth;
  double factor = 1.0;
};
void Use(const Context& context, const Source& source, Family& family);

/// The signature at any shape from series of samples.
std::function<Eigen::MatrixXd(const Eigen::VectorXd&)> RowsAt(const Context& context, const SeriesAt& at, Seen seen,
                                                              double factor = 1.0);

// --- named after an effect of the catalogue ---

/// An amplitude with unit and bounds of the catalogue; its prior is set later.
Amplitude AmplitudeOf(const std::string& effect, const std::string& parameter);
Shape ShapeOf(const std::string& effect, const std::string& parameter, std::vector<double> values_SI);

/// A parameter of the catalogue as fitted [SI].
ParameterEstimate Estimate(const std::string& effect, const std::string& parameter, double value, double u);

/// Amplitudes of cosine and sine; together they are the catalogue's amplitude and phase.
std::vector<Amplitude> WaveAmplitudes(const std::string& effect);

/// Amplitude and phase of the catalogue from those; before them the shape, if it is named.
Parameters WaveParameters(const std::string& effect, const std::string& shape_name = "");

/// Columns that named and unknown families share.
struct Common {
  Context context;
  SharedBase ring_orders, table_orders, hob_orders;  // orders 1, 2, ... of each angle
  TimeSeries series;                                 // nothing swings on through a mounting
};
Common CommonOf(const Context& context, int largest_order);

// Families of one kind of cause each; `families` grows.
void AddRings(const Common& common, std::vector<Family>& families);
void AddHobSignals(const Context& context, std::vector<Family>& families);
void AddChain(const Common& common, std::vector<Family>& families);
void AddTime(const Common& common, std::vector<Family>& families);

/// Structure without a name.
std::vector<Family> UnknownFamilies(const HobRun& hob, const Common& common, double plausible_rad);

}  // namespace twinbench::diagnose::hob
