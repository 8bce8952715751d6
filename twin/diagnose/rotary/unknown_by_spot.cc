#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "twin/diagnose/rotary/signals.h"
#include "twin/diagnose/rotary/unknown_collector.h"

namespace twinbench::diagnose::rotary {
namespace {

using units::um;

/// Predicted spot coordinates: readings x channels.
Eigen::MatrixXd SpotSeries_m(const LinearRun& run) {
  const Eigen::VectorXd shown_m = run.Predicted();
  Eigen::MatrixXd spots_m(run.schedule.Readings(), kChannels);
  for (Eigen::Index i = 0; i < spots_m.rows(); ++i) spots_m.row(i) = shown_m.segment<4>(4 * i).transpose();
  return spots_m;
}

std::string NameOf(int channel) {
  return kChannelNames[static_cast<std::size_t>(channel)];
}

/// Monomials of degree 2 and 3 of both positions, and of degree 4 and 5 of the first: readings x 9.
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
  double longest_m, step_per_m;
  int size;

  explicit FringeGrid(double span_m)
      : longest_m(std::max(span_m / 2.0, 20.0 * um)), step_per_m(0.4 / std::max(span_m, 40.0 * um)) {
    constexpr double kShortest_m = 12.0 * um;
    constexpr int kMost = 400;
    size = std::clamp(static_cast<int>((1.0 / kShortest_m - 1.0 / longest_m) / step_per_m), 1, kMost);
  }
  double WaveNumber_rad_m(int g) const { return 2.0 * units::kPi * (1.0 / longest_m + g * step_per_m); }
  double Period_m(int g) const { return 2.0 * units::kPi / WaveNumber_rad_m(g); }
};

void AddFringes(Collector& collect, int channel, const Eigen::VectorXd& spot_m) {
  const FringeGrid fringes(spot_m.maxCoeff() - spot_m.minCoeff());
  collect.AddOnChannel(
      channel, "spot fringes", fringes.size, kPlausible_m,
      [spot_m, fringes](int g) {
        return Wave(fringes.WaveNumber_rad_m(g) * spot_m, Eigen::VectorXd::Ones(spot_m.size()));
      },
      [channel, fringes](int g) {
        return fmt::format("periodic in spot position of {}, period {:.1f} um, locked to spot", NameOf(channel),
                           fringes.Period_m(g) / um);
      });
}

/// What the position of a channel's own spot decides, and what is proportional to any of the positions.
void AddOnOneChannel(Collector& collect, int channel, const Eigen::MatrixXd& spots_m) {
  const double range_m = std::max(spots_m.cwiseAbs().maxCoeff(), 1.0 * um);
  const int other_axis = channel ^ 1;
  collect.AddOnChannel(channel, "spot", 2.0 * kPlausible_m,
                       Powers(spots_m.col(channel) / range_m, spots_m.col(other_axis) / range_m),
                       "smooth function of the spot position of " + NameOf(channel) + ", locked to spot");
  collect.AddOnChannel(channel, "linear map", kPlausibleShare * range_m, spots_m / range_m,
                       "proportional to the spot positions, locked to spot, on " + NameOf(channel));
  AddFringes(collect, channel, spots_m.col(channel));
}

/// A channel that shows a share of another's (or its own) spot position.
struct Leak {
  int on, of;
};

/// Wrong scales and turned axes of several channels at once.
void AddLinearMap(Collector& collect, const std::string& where, const std::string& what,
                  const Eigen::MatrixXd& spots_m, const std::array<Leak, 4>& leaks) {
  Eigen::MatrixXd columns(kChannels * spots_m.rows(), std::ssize(leaks));
  Eigen::Index k = 0;
  for (const auto& [on, of] : leaks) columns.col(k++) = OnChannels(spots_m.col(of), Eigen::Vector4d::Unit(on));
  Family& family = collect.New(where, "linear map", {"share", "1", 1.0, kPlausibleShare}, columns.cols());
  family.columns = [columns](int) { return columns; };
  family.describe = [what](int, const Eigen::VectorXd& x) {
    return fmt::format("{}, proportional to the spot positions, locked to spot, {:.2g} rms", what, x.norm());
  };
}

}  // namespace

void AddBySpot(Collector& collect) {
  const Eigen::MatrixXd spots_m = SpotSeries_m(collect.rotary().run);
  for (int c = 0; c < kChannels; ++c) AddOnOneChannel(collect, c, spots_m);
  AddLinearMap(collect, "all", "scales of all channels", spots_m, {{{0, 0}, {1, 1}, {2, 2}, {3, 3}}});
  AddLinearMap(collect, "psd_a", "scales and axes of psd_a", spots_m, {{{0, 0}, {0, 1}, {1, 0}, {1, 1}}});
  AddLinearMap(collect, "psd_b", "scales and axes of psd_b", spots_m, {{{2, 2}, {2, 3}, {3, 2}, {3, 3}}});
}

}  // namespace twinbench::diagnose::rotary
