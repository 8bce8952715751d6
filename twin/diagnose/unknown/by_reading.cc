#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "twin/core/units.h"
#include "twin/diagnose/engine/base.h"
#include "twin/diagnose/tuning.h"
#include "twin/diagnose/unknown/collector.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::unknown {
namespace {

struct Exponents {
  int own, partner;
};

/// Monomials of degree 2 and 3 of a channel and its partner, and of degree 4 and 5 of the channel.
std::vector<Exponents> ExponentsOf(bool has_partner) {
  if (!has_partner) return {{2, 0}, {3, 0}, {4, 0}, {5, 0}};
  return {{2, 0}, {1, 1}, {0, 2}, {3, 0}, {2, 1}, {1, 2}, {0, 3}, {4, 0}, {5, 0}};
}

/// Samples x exponents.
Eigen::MatrixXd Powers(const Eigen::VectorXd& own, const Eigen::VectorXd& partner,
                       const std::vector<Exponents>& exponents) {
  Eigen::MatrixXd powers(own.size(), std::ssize(exponents));
  for (std::size_t k = 0; k < exponents.size(); ++k)
    powers.col(static_cast<Eigen::Index>(k)) =
        own.array().pow(exponents[k].own) * partner.array().pow(exponents[k].partner);
  return powers;
}

/// Wave numbers of fringes from one longest period to one shortest, half a cycle of phase between the ends of the
/// range from one to the next.
struct FringeGrid {
  double longest, step;
  int size;

  FringeGrid(double span, double shortest)
      : longest(std::max(span / 2.0, 1.5 * shortest)), step(0.4 / std::max(span, 3.0 * shortest)) {
    size = std::clamp(static_cast<int>((1.0 / shortest - 1.0 / longest) / step), 1, tuning::kMostFringes);
  }
  double Period(int g) const { return 1.0 / (1.0 / longest + g * step); }
};

EffectSettings At(const std::string& channel, EffectSettings signal) {
  signal.where = channel;
  return signal;
}

/// Powers as signals.
std::vector<Product> ProductsOfPowers(const std::string& channel, double range,
                                      const std::vector<Exponents>& exponents) {
  std::vector<Product> products;
  for (const auto& [own, partner] : exponents) {
    const auto column = static_cast<int>(products.size());
    products.push_back(
        {At(channel, SignalOf("power", "", {{"exponent", own}, {"partner_exponent", partner}, {"range", range}})),
         column});
  }
  return products;
}

/// What counts as one of what a channel shows.
double RangeOf(const Design& d, int channel) {
  return std::max(d.RangeOf(channel), 2.0 * d.plausible * d.ScaleOf(channel));
}

/// A channel that shows a share of another's, or of its own, value.
struct Leak {
  int on, of;
};

/// One column a leak, in shares of the range.
std::vector<Product> ProductsOfLeaks(const Design& d, const std::vector<Leak>& leaks) {
  std::vector<Product> products;
  for (const auto& [on, of] : leaks) {
    const auto column = static_cast<int>(products.size());
    const auto name = [&d](int c) { return d.channels[static_cast<std::size_t>(c)]; };
    products.push_back({At(name(on), SignalOf("share", name(of))), column, false, 1.0 / RangeOf(d, of)});
  }
  return products;
}

void AddFringes(Collector& collect, int channel) {
  const Design& d = collect.design();
  const Eigen::VectorXd shown = d.shown.col(channel);
  const std::string name = d.channels[static_cast<std::size_t>(channel)];
  const FringeGrid fringes(shown.maxCoeff() - shown.minCoeff(),
                           tuning::kShortestFringe * d.plausible * d.ScaleOf(channel));
  const ChannelUnit unit =
      d.units.empty() ? ChannelUnit{d.unit, d.to_SI} : d.units[static_cast<std::size_t>(channel)];
  collect.AddRows(
      d.shown_name + " fringes", name, fringes.size,
      [design = collect.shared(), channel, fringes](int g) {
        const Eigen::VectorXd turns = design->shown.col(channel) / fringes.Period(g);
        return OnChannel(*design, model::Wave(units::turn * turns), channel);
      },
      [=, what = d.shown_name](int g) {
        return fmt::format("periodic in the {0} of {1}, period {2:.3g} {3}, function of {0}", what, name,
                           fringes.Period(g) / unit.to_SI, unit.name);
      });
  collect.Are([name, fringes](const Eigen::VectorXd&, int g) {
    return WaveOf(At(name, SignalOf("fringes", "", {{"period", fringes.Period(g)}})));
  });
}

/// The other channel of the same detector; itself if there is none.
int Partner(const Design& d, int channel) {
  const int other = channel ^ 1;
  return other < std::ssize(d.channels) ? other : channel;
}

void AddOnChannel(Collector& collect, int channel, const Eigen::MatrixXd& share) {
  const Design& d = collect.design();
  const std::string name = d.channels[static_cast<std::size_t>(channel)];
  const int partner = Partner(d, channel);
  const std::vector<Exponents> exponents = ExponentsOf(partner != channel);
  collect.AddRows(d.shown_name, name,
                  OnChannel(d, Powers(share.col(channel), share.col(partner), exponents), channel),
                  fmt::format("smooth function of the {0} of {1}, function of {0}", d.shown_name, name));
  collect.Are([products = ProductsOfPowers(name, RangeOf(d, channel), exponents)](const Eigen::VectorXd&, int) {
    return products;
  });
  collect.AddRows("linear map", name, OnChannel(d, share, channel),
                  fmt::format("proportional to all {0}s, function of {0} of {1}", d.shown_name, name));
  std::vector<Leak> leaks;
  for (int of = 0; of < std::ssize(d.channels); ++of) leaks.push_back({channel, of});
  collect.Are([products = ProductsOfLeaks(d, leaks)](const Eigen::VectorXd&, int) { return products; });
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

/// Wrong scales and turned axes of a detector; wrong scales of all channels at once.
void AddLinearMap(Collector& collect, const Group& group, const Eigen::MatrixXd& share) {
  const Design& d = collect.design();
  const bool axes_too = group.name != "all";
  Eigen::MatrixXd columns;
  std::vector<Leak> leaks;
  for (const int on : group.channels) {
    for (const int of : group.channels) {
      if (on != of && !axes_too) continue;
      columns = HStack(columns, OnChannel(d, share.col(of), on));
      leaks.push_back({on, of});
    }
  }
  collect.AddRows("linear map", group.name, columns,
                  fmt::format("scales{0} of {1}, proportional to the {2}s, function of {2}",
                              axes_too ? " and axes" : "", group.name, d.shown_name));
  collect.Are([products = ProductsOfLeaks(d, leaks)](const Eigen::VectorXd&, int) { return products; });
}

/// Something that a gain may follow.
struct Followed {
  std::string name;
  Eigen::VectorXd course;  // of rms about one
  EffectSettings factor;   // the same as a twin does it; without `times`: it cannot
};

/// (quantity - about) / per, with `per` such that its rms is one.
Followed LinearIn(const std::string& name, const Eigen::VectorXd& quantity, double about, bool twin_knows) {
  const Eigen::VectorXd beside = quantity.array() - about;
  Followed followed{name, model::Unit(beside), {}};
  if (twin_knows && model::Rms(beside) > 0.0) followed.factor = Following({}, name, about, model::Rms(beside));
  return followed;
}

/// Its mean in the calibration: the gains were right there, whatever they followed. Of a run without one: its first
/// value.
double InCalibration(const Design& d, const Eigen::VectorXd& quantity) {
  const Eigen::VectorXd still = 1.0 - d.moved.array();
  const double count = still.sum();
  return count > 0.0 ? still.dot(quantity) / count : quantity[0];
}

std::vector<Followed> WhatIsFollowed(const Design& d) {
  const Eigen::VectorXd& time_s = d.course.time_s;
  const Eigen::VectorXd warm = 1.0 - (-tuning::kWarmUps * model::ElapsedShare(d.course).array()).exp();
  std::vector<Followed> followed = {LinearIn("time", time_s, time_s.mean(), true),
                                    LinearIn("time", time_s, InCalibration(d, time_s), true),
                                    LinearIn("time", warm, InCalibration(d, warm), false),
                                    {"direction", d.senses.front().cwiseProduct(d.moved), {}}};
  if (d.above_K.size() == 0) return followed;
  for (const double about_K : {d.above_K.mean(), InCalibration(d, d.above_K), 0.0})
    followed.push_back(LinearIn("temperature", d.above_K, about_K, d.twin_is_warm));
  return followed;
}

/// Gains of channels, each with a column of its own or all with one.
std::vector<Product> ProductsOfGains(const Design& d, const std::vector<int>& channels, bool each,
                                     const EffectSettings& factor) {
  std::vector<Product> products;
  for (const int c : channels) {
    const std::string& name = d.channels[static_cast<std::size_t>(c)];
    EffectSettings gain = At(name, SignalOf("share", name, factor.parameters));
    gain.times = factor.times;
    products.push_back({gain, each ? static_cast<int>(products.size()) : 0, false, 1.0 / RangeOf(d, c)});
  }
  return products;
}

/// Gains of channels that follow something: one each, one of all that a detector has, or one of each together.
void AddGains(Collector& collect, const Eigen::MatrixXd& share) {
  const Design& d = collect.design();
  std::vector<Group> groups;
  for (int c = 0; c < std::ssize(d.channels); ++c) groups.push_back({d.channels[static_cast<std::size_t>(c)], {c}});
  for (Group& group : GroupsOf(d)) groups.push_back(std::move(group));
  for (const Followed& followed : WhatIsFollowed(d)) {
    for (const Group& group : groups) {
      const bool each = group.name == "all";
      Eigen::MatrixXd columns;
      for (const int c : group.channels) {
        const Eigen::MatrixXd own = OnChannel(d, model::Times(share.col(c), followed.course), c);
        columns = each || columns.size() == 0 ? HStack(columns, own) : Eigen::MatrixXd(columns + own);
      }
      collect.AddRows(
          "gain changes", group.name, columns,
          fmt::format("gain of {0} follows {1}, function of {1} and {2}", group.name, followed.name, d.shown_name));
      if (followed.factor.times.empty()) continue;
      collect.Are([products = ProductsOfGains(d, group.channels, each, followed.factor)](const Eigen::VectorXd&,
                                                                                         int) { return products; });
    }
  }
}

}  // namespace

void AddByReading(Collector& collect) {
  const Design& d = collect.design();
  if (d.shown.size() == 0) return;
  Eigen::MatrixXd share = d.shown;
  for (int c = 0; c < std::ssize(d.channels); ++c) share.col(c) /= RangeOf(d, c);
  for (int c = 0; c < std::ssize(d.channels); ++c) AddOnChannel(collect, c, share);
  for (const Group& group : GroupsOf(d)) AddLinearMap(collect, group, share);
  AddGains(collect, share);
}

}  // namespace twinbench::diagnose::unknown
