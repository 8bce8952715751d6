#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/core/units.h"
#include "twin/diagnose/unknown/collector.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::unknown {
namespace {

/// Monomials of degree 2 and 3 of both values, and of degree 4 and 5 of the first: samples x 9.
Eigen::MatrixXd Powers(const Eigen::VectorXd& u, const Eigen::VectorXd& v) {
  Eigen::MatrixXd p(u.size(), 9);
  const auto a = u.array(), b = v.array();
  p << a.square().matrix(), (a * b).matrix(), b.square().matrix(), a.cube().matrix(), (a.square() * b).matrix(),
      (a * b.square()).matrix(), b.cube().matrix(), a.square().square().matrix(),
      (a.square().square() * a).matrix();
  return p;
}

/// Wave numbers of fringes from one longest period to one shortest, half a cycle of phase between the ends of the
/// range from one to the next.
struct FringeGrid {
  double longest, step;
  int size;

  FringeGrid(double span, double shortest)
      : longest(std::max(span / 2.0, 1.5 * shortest)), step(0.4 / std::max(span, 3.0 * shortest)) {
    constexpr int kMost = 400;
    size = std::clamp(static_cast<int>((1.0 / shortest - 1.0 / longest) / step), 1, kMost);
  }
  double Period(int g) const { return 1.0 / (1.0 / longest + g * step); }
};

void AddFringes(Collector& collect, int channel) {
  constexpr double kShortest = 25.0;  // in plausible sizes of a disturbance
  const Design& d = collect.design();
  const Eigen::VectorXd shown = d.shown.col(channel);
  const std::string name = d.channels[static_cast<std::size_t>(channel)];
  const FringeGrid fringes(shown.maxCoeff() - shown.minCoeff(), kShortest * d.plausible);
  collect.AddRows(
      d.shown_name + " fringes", name, fringes.size,
      [design = collect.shared(), channel, fringes](int g) {
        const Eigen::VectorXd turns = design->shown.col(channel) / fringes.Period(g);
        return OnChannel(*design, model::Wave(units::turn * turns), channel);
      },
      [=, what = d.shown_name, unit = d.unit, to_SI = d.to_SI](int g) {
        return fmt::format("periodic in the {0} of {1}, period {2:.1f} {3}, locked to {0}", what, name,
                           fringes.Period(g) / to_SI, unit);
      });
}

/// The other channel of the same detector.
int Partner(int channel) {
  return channel ^ 1;
}

void AddOnChannel(Collector& collect, int channel, const Eigen::MatrixXd& share) {
  const Design& d = collect.design();
  const std::string name = d.channels[static_cast<std::size_t>(channel)];
  collect.AddRows(d.shown_name, name,
                  OnChannel(d, Powers(share.col(channel), share.col(Partner(channel))), channel),
                  fmt::format("smooth function of the {0} of {1}, locked to {0}", d.shown_name, name));
  collect.AddRows("linear map", name, OnChannel(d, share, channel),
                  fmt::format("proportional to all {0}s, locked to {0} of {1}", d.shown_name, name));
  AddFringes(collect, channel);
}

/// Channels that have something in common, and what they are called.
struct Group {
  std::string name;
  std::vector<int> channels;
};

std::vector<Group> GroupsOf(const Design& d) {
  std::vector<Group> groups;
  std::vector<int> all;
  for (int c = 0; c < std::ssize(d.channels); ++c) all.push_back(c);
  for (const std::vector<int>& detector : d.detectors) {
    const std::string first = d.channels[static_cast<std::size_t>(detector.front())];
    groups.push_back({first.substr(0, first.rfind('_')), detector});  // "psd_a" of "psd_a_x"
  }
  if (all.size() > 2) groups.push_back({"all", all});
  return groups;
}

Eigen::MatrixXd Beside(const Eigen::MatrixXd& left, const Eigen::MatrixXd& right) {
  Eigen::MatrixXd both(right.rows(), left.cols() + right.cols());
  if (left.cols() > 0) both.leftCols(left.cols()) = left;
  both.rightCols(right.cols()) = right;
  return both;
}

/// Wrong scales and turned axes of a detector; wrong scales of all channels at once.
void AddLinearMap(Collector& collect, const Group& group, const Eigen::MatrixXd& share) {
  const Design& d = collect.design();
  const bool axes_too = group.name != "all";
  Eigen::MatrixXd columns;
  for (const int on : group.channels) {
    for (const int of : group.channels) {
      if (on == of || axes_too) columns = Beside(columns, OnChannel(d, share.col(of), on));
    }
  }
  collect.AddRows("linear map", group.name, columns,
                  fmt::format("scales{0} of {1}, proportional to the {2}s, locked to {2}",
                              axes_too ? " and axes" : "", group.name, d.shown_name));
}

/// Above its mean in the calibration: the gains were right there, whatever they followed. Of a run without one: above
/// its first value.
Eigen::VectorXd SinceCalibration(const Design& d, const Eigen::VectorXd& signal) {
  const Eigen::VectorXd still = 1.0 - d.moved.array();
  const double count = still.sum();
  return model::Unit((signal.array() - (count > 0.0 ? still.dot(signal) / count : signal[0])).matrix());
}

/// Name and course of something that a gain may follow.
using Followed = std::pair<std::string, Eigen::VectorXd>;

std::vector<Followed> WhatIsFollowed(const Design& d) {
  constexpr double kWarmUps = 3.0;  // time constants in a run, of something that warms up and stays
  const Eigen::VectorXd time = model::ElapsedShare(d.course);
  const Eigen::VectorXd warm = 1.0 - (-kWarmUps * time.array()).exp();
  std::vector<Followed> followed = {{"time", model::Unit((time.array() - time.mean()).matrix())},
                                    {"time", SinceCalibration(d, time)},
                                    {"time", SinceCalibration(d, warm)},
                                    {"direction", d.senses.front().cwiseProduct(d.moved)}};
  if (d.above_K.size() == 0) return followed;
  followed.emplace_back("temperature", model::Unit((d.above_K.array() - d.above_K.mean()).matrix()));
  followed.emplace_back("temperature", SinceCalibration(d, d.above_K));
  followed.emplace_back("temperature", model::Unit(d.above_K));  // nothing at the reference temperature
  return followed;
}

/// Gains of channels that follow something: one each, one of all that a detector has, or one of each together.
void AddGains(Collector& collect, const Eigen::MatrixXd& share) {
  const Design& d = collect.design();
  for (const auto& [what, signal] : WhatIsFollowed(d)) {
    const std::string words = fmt::format("gain of {{}} follows {0}, locked to {0} and {1}", what, d.shown_name);
    const auto add = [&](const std::string& where, const Eigen::MatrixXd& rows) {
      collect.AddRows("gain changes", where, rows, fmt::format(fmt::runtime(words), where));
    };
    std::vector<Eigen::MatrixXd> of_channel;
    for (int c = 0; c < std::ssize(d.channels); ++c)
      of_channel.push_back(OnChannel(d, model::Times(share.col(c), signal), c));
    for (std::size_t c = 0; c < of_channel.size(); ++c) add(d.channels[c], of_channel[c]);
    for (const Group& group : GroupsOf(d)) {
      const bool each = group.name == "all";
      Eigen::MatrixXd columns;
      for (const int c : group.channels) {
        const Eigen::MatrixXd& own = of_channel[static_cast<std::size_t>(c)];
        columns = each || columns.size() == 0 ? Beside(columns, own) : Eigen::MatrixXd(columns + own);
      }
      add(group.name, columns);
    }
  }
}

}  // namespace

void AddByReading(Collector& collect) {
  const Design& d = collect.design();
  if (d.shown.size() == 0) return;
  const Eigen::MatrixXd share = d.shown / std::max(d.shown.cwiseAbs().maxCoeff(), 2.0 * d.plausible);
  for (int c = 0; c < std::ssize(d.channels); ++c) AddOnChannel(collect, c, share);
  for (const Group& group : GroupsOf(d)) AddLinearMap(collect, group, share);
  AddGains(collect, share);
}

}  // namespace twinbench::diagnose::unknown
