#include "twin/diagnose/rotary/unknown_collector.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "twin/diagnose/rotary/signals.h"

namespace twinbench::diagnose::rotary {
namespace {

using units::um;

/// "psd_b_y" or "psd_a_y, psd_b_y in phase (tilt pattern)".
std::string OnWhat(const std::string& place) {
  if (place == "yaw") return "psd_a_x, psd_b_x in phase (yaw pattern)";
  if (place == "tilt") return "psd_a_y, psd_b_y in phase (tilt pattern)";
  if (place == "roll") return "psd_a_y, psd_b_y in antiphase (roll pattern)";
  if (place == "lateral") return "psd_a_x, psd_b_x in antiphase (lateral pattern)";
  if (place == "all") return "all channels";
  return place;
}

Amplitude Disturbance(double plausible_m) {
  return {"amplitude", "um", um, plausible_m};
}

void Describe(Family& family, const Words& words) {
  family.describe = [where = family.where, words](int g, const Eigen::VectorXd& x) {
    return fmt::format("{}, on {}, amplitude {:.2g} um", words(g), OnWhat(where), x.norm() / um);
  };
}

}  // namespace

Family& Collector::New(const std::string& where, const std::string& sort, const Amplitude& amplitude,
                       Eigen::Index count) {
  Family& family = families_.emplace_back();
  family.kind = Kind::kUnknown;
  family.effect = family.group = sort;
  family.where = where;
  family.amplitudes.assign(static_cast<std::size_t>(count), amplitude);
  return family;
}

void Collector::AddAt(const std::string& where, const std::string& sort, const std::shared_ptr<const Base>& base,
                      const Eigen::MatrixXd& map, const Words& words) {
  Family& family = New(where, sort, Disturbance(kPlausible_m), map.cols());
  family.grid = base->grid;
  family.base = base;
  family.map = map;
  Describe(family, words);
}

std::shared_ptr<const Base> Collector::AddOnPlaces(const std::string& sort, int grid, const Signals& signals,
                                                   const Words& words) {
  const auto base = std::make_shared<Base>();
  base->grid = grid;
  base->channels = kChannels;
  base->series = signals;
  const auto k = static_cast<int>(signals(0).cols());
  for (const Place& place : places_) AddAt(place.name, sort, base, PatternMap(place.weight, k), words);
  return base;
}

void Collector::Add(const std::string& sort, int grid, const Signals& signals, const Words& words) {
  const auto base = AddOnPlaces(sort, grid, signals, words);
  const Eigen::Index columns = kChannels * signals(0).cols();
  AddAt("all", sort, base, Eigen::MatrixXd::Identity(columns, columns), words);
}

void Collector::Add(const std::string& sort, const Eigen::MatrixXd& signals, const std::string& words) {
  Add(
      sort, 1, [signals](int) { return signals; }, [words](int) { return words; });
}

void Collector::AddOnChannel(int channel, const std::string& sort, int grid, double plausible_m,
                             const Signals& signals, const Words& words) {
  const char* const where = kChannelNames[static_cast<std::size_t>(channel)];
  Family& family = New(where, sort, Disturbance(plausible_m), signals(0).cols());
  family.grid = grid;
  family.columns = [signals, channel](int g) { return OnChannels(signals(g), Eigen::Vector4d::Unit(channel)); };
  Describe(family, words);
}

void Collector::AddOnChannel(int channel, const std::string& sort, double plausible_m,
                             const Eigen::MatrixXd& signals, const std::string& words) {
  AddOnChannel(
      channel, sort, 1, plausible_m, [signals](int) { return signals; }, [words](int) { return words; });
}

Eigen::VectorXd Unit(Eigen::VectorXd signal) {
  const double rms =
      std::sqrt(signal.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(1, signal.size())));
  return rms > 0.0 ? Eigen::VectorXd(signal / rms) : signal;
}

Eigen::MatrixXd Indicators(const std::vector<int>& label, const Eigen::VectorXd& factor) {
  const std::set<int> values(label.begin(), label.end());
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(factor.size(), std::ssize(values));
  Eigen::Index k = 0;
  for (const int value : values) {
    for (Eigen::Index i = 0; i < factor.size(); ++i) {
      if (label[static_cast<std::size_t>(i)] == value) columns(i, k) = factor[i];
    }
    ++k;
  }
  return columns;
}

Eigen::MatrixXd Wave(const Eigen::VectorXd& angle_rad, const Eigen::VectorXd& factor) {
  Eigen::MatrixXd wave(angle_rad.size(), 2);
  wave.col(0) = angle_rad.array().cos() * factor.array();
  wave.col(1) = angle_rad.array().sin() * factor.array();
  return wave;
}

}  // namespace twinbench::diagnose::rotary
