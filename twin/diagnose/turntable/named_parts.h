#pragma once

#include <memory>
#include <string>
#include <vector>

#include "twin/diagnose/engine/catalogue_parts.h"
#include "twin/diagnose/engine/time_series.h"
#include "twin/diagnose/turntable/families.h"

/// Building blocks of families that are named after an effect of the catalogue.
namespace twinbench::diagnose::turntable {

using Context = std::shared_ptr<const SignalContext>;
using Signal = std::function<Eigen::MatrixXd(const Eigen::VectorXd& shape)>;  // readings x amplitudes, of one axis

/// An amplitude with unit, bounds and plausible size of the catalogue.
Amplitude AmplitudeOf(const std::string& effect, const std::string& parameter);
/// Between the least and the largest of `values`: beyond them it is another cause, or none that this run can show.
Shape ShapeOf(const std::string& effect, const std::string& parameter, std::vector<double> values_SI);
/// A parameter of the catalogue as fitted [SI].
ParameterEstimate Estimate(const std::string& effect, const std::string& parameter, double value, double u);

/// A family without a shape.
Family Linear(const std::string& effect, const std::string& where, const std::string& parameter,
              const Eigen::MatrixXd& rows);

/// One axis with a signal that has a shape, on its grid and between.
Family Shaped(const std::string& effect, int axis, std::vector<Amplitude> amplitudes, const Shape& shape,
              const Signal& signal);

/// Of cosine and sine; together they are the catalogue's amplitude and phase.
std::vector<Amplitude> WaveAmplitudes(const std::string& effect);
/// @param shape  The catalogue's name of the family's shape.
void ReportWave(const std::string& effect, const std::string& shape, Family& family);

/// The columns of one axis, or of both, of signals that Base has on each: base columns * map.
Eigen::MatrixXd MapOfAxis(int axis, int signals);

// Families of one kind of cause each; `families` grows.
void AddInstrument(const Context& context, double sigma_rad, std::vector<Family>& families);
void AddTime(const Context& context, const TimeSeries& series, std::vector<Family>& families);
void AddBody(const Context& context, std::vector<Family>& families);

/// Structure without a name.
std::vector<Family> UnknownFamilies(const TurntableRun& turntable, const TimeSeries& series);

}  // namespace twinbench::diagnose::turntable
