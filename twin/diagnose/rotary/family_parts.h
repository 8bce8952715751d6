#pragma once

#include <string>
#include <vector>

#include "twin/diagnose/rotary/families.h"

/// What the named families of the rotary bench are put together from.
namespace twinbench::diagnose::rotary {

/// A parameter of the catalogue with its plausible size and what is physically possible.
Amplitude AmplitudeOf(const std::string& effect, const std::string& parameter);
Shape ShapeOf(const std::string& effect, const std::string& parameter, std::vector<double> values);

/// From `lower` to `upper`, evenly in the logarithm or as they are.
std::vector<double> Logarithmic(double lower, double upper, int count);
std::vector<double> Even(double lower, double upper, int count);

/// A family without signature.
Family Named(const std::string& effect, const std::string& where, std::vector<Amplitude> amplitudes);

/// Gives a family the signature `at`, on its grid and between.
void SetSignal(Family& family, const std::function<Eigen::MatrixXd(const Eigen::VectorXd&)>& at);

/// An additive effect as EffectSignal has it. The context must outlive the family.
Family SignalFamily(const std::string& effect, const std::string& where, std::vector<Amplitude> amplitudes,
                    std::vector<Shape> shapes, const SignalContext& context);

/// Amplitude of a pair of columns (amplitude x cos, amplitude x sin of the phase).
/// @param cov  Of the pair, and of any others after it.
ParameterEstimate LengthOf(const Amplitude& a, const Eigen::Vector2d& pair, const Eigen::MatrixXd& cov);
/// A shape parameter as it stands.
ParameterEstimate Plain(const Shape& shape, double value, double u);

/// Causes that are a wrong property of the bench; causes that are heard on top of any signal.
void AddBenchFamilies(const RotaryRun& rotary, const Scenario& scenario, std::vector<Family>& families);
void AddTones(const RotaryRun& rotary, const TimeSeries& series, std::vector<Family>& families);
void AddSlips(const RotaryRun& rotary, const TimeSeries& series, std::vector<Family>& families);

}  // namespace twinbench::diagnose::rotary
