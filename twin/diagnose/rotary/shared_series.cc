#include <algorithm>
#include <cmath>
#include <string>

#include "twin/core/units.h"
#include "twin/diagnose/rotary/family_parts.h"
#include "twin/diagnose/rotary/signals.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::rotary {
namespace {

using units::um;

/// A tone with an amplitude and a phase of its own on every channel.
Family FreeTone(const RotaryRun& rotary, const TimeSeries& series) {
  const Amplitude amplitude = AmplitudeOf("tone", "amplitude");
  Family family = Named("tone", "all", std::vector<Amplitude>(2 * kChannels, amplitude));
  family.shapes = {ShapeOf("tone", "frequency", series.frequencies_Hz)};
  family.grid = series.tones->grid;
  family.base = series.tones;
  family.map = Eigen::MatrixXd::Identity(2 * kChannels, 2 * kChannels);
  family.at = [&rotary](const Eigen::VectorXd& shape) {
    return OnEachChannel(model::Tone(rotary.run.schedule.time_s, shape[0]), kChannels);
  };
  family.parameters = [amplitude, f = family.shapes[0]](const Eigen::VectorXd& shape, const Eigen::VectorXd& x,
                                                        const Eigen::MatrixXd& cov) {
    const Eigen::Index last = x.size();
    const double rms = x.norm() / std::sqrt(static_cast<double>(kChannels)),
                 u = std::sqrt(x.dot(cov.topLeftCorner(last, last) * x) / (x.squaredNorm() * kChannels));
    return std::vector<ParameterEstimate>{Plain(f, shape[0], std::sqrt(cov(last, last))),
                                          {"amplitude", "um", um, rms, u, 0.0, amplitude.upper}};
  };
  return family;
}

}  // namespace

std::vector<Place> PlacesOf(const Eigen::Matrix4d& shown_by_motion) {
  std::vector<Place> places;
  for (const char* name : {"yaw", "tilt", "roll", "lateral"}) {
    const Eigen::Vector4d weight = WeightOf(name, shown_by_motion);
    places.push_back({name, weight / weight.cwiseAbs().maxCoeff()});
  }
  for (int c = 0; c < kChannels; ++c) {
    places.push_back({kChannelNames[static_cast<std::size_t>(c)], Eigen::Vector4d::Unit(c)});
  }
  return places;
}

void AddTones(const RotaryRun& rotary, const TimeSeries& series, std::vector<Family>& families) {
  const auto add = [&](const std::string& where, const Eigen::Vector4d& weight) {
    const Amplitude amplitude = AmplitudeOf("tone", "amplitude");
    Family family = Named("tone", where, {amplitude, amplitude});
    family.shapes = {ShapeOf("tone", "frequency", series.frequencies_Hz)};
    family.grid = series.tones->grid;
    family.base = series.tones;
    family.map = PatternMap(weight, 2);
    family.at = [&rotary, weight](const Eigen::VectorXd& shape) {
      return OnChannels(model::Tone(rotary.run.schedule.time_s, shape[0]), weight);
    };
    family.parameters = [amplitude, f = family.shapes[0]](const Eigen::VectorXd& shape, const Eigen::VectorXd& x,
                                                          const Eigen::MatrixXd& cov) {
      // x [cos, sin] = amplitude sin(2 pi f t + phase)
      const Eigen::Vector2d across = Eigen::Vector2d(x[1], -x[0]) / x.squaredNorm();
      const double u_phase = std::sqrt(across.dot(cov.topLeftCorner<2, 2>() * across));
      return std::vector<ParameterEstimate>{
          Plain(f, shape[0], std::sqrt(cov(2, 2))),
          LengthOf(amplitude, x, cov),
          {"phase", "deg", units::deg, std::atan2(x[0], x[1]), u_phase, kNaN, kNaN}};
    };
    families.push_back(std::move(family));
  };
  for (int c = 0; c < kChannels; ++c) add(kChannelNames[static_cast<std::size_t>(c)], Eigen::Vector4d::Unit(c));
  add("yaw", {1.0, 0.0, 1.0, 0.0});
  add("tilt", {0.0, 1.0, 0.0, 1.0});
  add("all", Eigen::Vector4d::Ones());
  families.push_back(FreeTone(rotary, series));
}

/// A step at any reading that shows in the channels by `weight`.
Family Step(const std::string& effect, const std::string& where, const std::string& size,
            const Eigen::Vector4d& weight, const TimeSeries& series) {
  Family family = Named(effect, where, {AmplitudeOf(effect, size)});
  family.shapes = {ShapeOf(effect, "at_reading", {series.onsets.begin(), series.onsets.end()})};
  family.grid = series.steps->grid;
  family.base = series.steps;
  family.map = PatternMap(weight, 1);
  return family;
}

void AddSlips(const RotaryRun& rotary, const TimeSeries& series, std::vector<Family>& families) {
  for (const char* where : {"yaw", "tilt", "lateral"}) {
    const char* const size = std::string(where) == "lateral" ? "shift" : "angle";
    families.push_back(Step("slip", where, size, WeightOf(where, rotary.shown_by_motion), series));
  }
  families.push_back(Step("mode_hop", "", "wavelength_step", ShownByWavelength(rotary.bench), series));
}

}  // namespace twinbench::diagnose::rotary
