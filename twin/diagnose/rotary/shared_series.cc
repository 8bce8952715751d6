#include <algorithm>
#include <cmath>
#include <string>

#include "twin/core/units.h"
#include "twin/diagnose/rotary/family_parts.h"
#include "twin/diagnose/rotary/signals.h"

namespace twinbench::diagnose::rotary {
namespace {

using units::um;

/// A tone with an amplitude and a phase of its own on every channel.
Family FreeTone(const RotaryRun& rotary, const SharedSeries& series) {
  const Amplitude amplitude = AmplitudeOf("tone", "amplitude");
  Family family = Named("tone", "all", std::vector<Amplitude>(2 * kChannels, amplitude));
  family.shapes = {ShapeOf("tone", "frequency", series.frequency_Hz)};
  family.grid = series.tone->grid;
  family.base = series.tone;
  family.map = Eigen::MatrixXd::Identity(2 * kChannels, 2 * kChannels);
  family.at = [&rotary](const Eigen::VectorXd& shape) {
    return OnEachChannel(ToneSignal(rotary.run.schedule, shape[0]), kChannels);
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

/// About two grid points within the width of a line, up to the frequency of the readings.
std::vector<double> ToneGrid(const Schedule& s) {
  constexpr int kMostFrequencies = 1200;
  const double duration_s = s.time_s.maxCoeff() - s.time_s.minCoeff();
  std::vector<double> steps_s;
  for (Eigen::Index i = 1; i < s.time_s.size(); ++i) steps_s.push_back(s.time_s[i] - s.time_s[i - 1]);
  std::nth_element(steps_s.begin(), steps_s.begin() + std::ssize(steps_s) / 2, steps_s.end());
  const double usual_s = steps_s[steps_s.size() / 2];
  const double width_Hz = 0.6 / duration_s, top_Hz = 0.5 / usual_s;
  const int count = std::clamp(static_cast<int>(top_Hz / width_Hz), 1, kMostFrequencies);
  return Even(3.0 * width_Hz, std::max(top_Hz, 4.0 * width_Hz), std::max(2, count));
}

}  // namespace

SharedSeries MakeSharedSeries(const RotaryRun& rotary) {
  const Schedule& s = rotary.run.schedule;
  SharedSeries series;
  series.frequency_Hz = ToneGrid(s);
  // Within a set-up only: a step at its first reading is a constant.
  for (std::size_t i = 1; i < s.reading.size(); ++i) {
    if (s.setup[i] == s.setup[i - 1] && s.phase[i] == s.phase[i - 1]) series.onset.push_back(s.reading[i]);
  }
  constexpr std::size_t kMostOnsets = 1000;
  if (series.onset.size() > kMostOnsets) {
    std::vector<int> thinned;
    for (std::size_t k = 0; k < kMostOnsets; ++k)
      thinned.push_back(series.onset[k * series.onset.size() / kMostOnsets]);
    series.onset = thinned;
  }
  auto tone = std::make_shared<Base>();
  tone->grid = static_cast<int>(std::ssize(series.frequency_Hz));
  tone->channels = kChannels;
  tone->series = [&s, f = series.frequency_Hz](int g) { return ToneSignal(s, f[static_cast<std::size_t>(g)]); };
  series.tone = tone;
  auto step = std::make_shared<Base>();
  step->grid = static_cast<int>(std::ssize(series.onset));
  step->channels = kChannels;
  step->series = [&s, onset = series.onset](int g) {
    return Eigen::MatrixXd(StepSignal(s, onset[static_cast<std::size_t>(g)]));
  };
  series.step = step;
  return series;
}

Eigen::MatrixXd PatternMap(const Eigen::VectorXd& weight, int signals) {
  Eigen::MatrixXd map = Eigen::MatrixXd::Zero(weight.size() * signals, signals);
  for (Eigen::Index c = 0; c < weight.size(); ++c) {
    map.middleRows(c * signals, signals) = weight[c] * Eigen::MatrixXd::Identity(signals, signals);
  }
  return map;
}

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

void AddTones(const RotaryRun& rotary, const SharedSeries& series, std::vector<Family>& families) {
  const auto add = [&](const std::string& where, const Eigen::Vector4d& weight) {
    const Amplitude amplitude = AmplitudeOf("tone", "amplitude");
    Family family = Named("tone", where, {amplitude, amplitude});
    family.shapes = {ShapeOf("tone", "frequency", series.frequency_Hz)};
    family.grid = series.tone->grid;
    family.base = series.tone;
    family.map = PatternMap(weight, 2);
    family.at = [&rotary, weight](const Eigen::VectorXd& shape) {
      return OnChannels(ToneSignal(rotary.run.schedule, shape[0]), weight);
    };
    family.parameters = [amplitude, f = family.shapes[0]](const Eigen::VectorXd& shape, const Eigen::VectorXd& x,
                                                          const Eigen::MatrixXd& cov) {
      const Eigen::Vector2d across = Eigen::Vector2d(-x[1], x[0]) / x.squaredNorm();
      const double u_phase = std::sqrt(across.dot(cov.topLeftCorner<2, 2>() * across));
      return std::vector<ParameterEstimate>{
          Plain(f, shape[0], std::sqrt(cov(2, 2))),
          LengthOf(amplitude, x, cov),
          {"phase", "deg", units::deg, std::atan2(x[1], x[0]), u_phase, kNaN, kNaN}};
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
            const Eigen::Vector4d& weight, const SharedSeries& series) {
  Family family = Named(effect, where, {AmplitudeOf(effect, size)});
  family.shapes = {ShapeOf(effect, "at_reading", {series.onset.begin(), series.onset.end()})};
  family.grid = series.step->grid;
  family.base = series.step;
  family.map = PatternMap(weight, 1);
  return family;
}

void AddSlips(const RotaryRun& rotary, const SharedSeries& series, std::vector<Family>& families) {
  for (const char* where : {"yaw", "tilt", "lateral"}) {
    const char* const size = std::string(where) == "lateral" ? "shift" : "angle";
    families.push_back(Step("slip", where, size, WeightOf(where, rotary.shown_by_motion), series));
  }
  families.push_back(Step("mode_hop", "", "wavelength_step", ShownByWavelength(rotary.bench), series));
}

}  // namespace twinbench::diagnose::rotary
