#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "twin/core/units.h"
#include "twin/diagnose/rotary/families.h"
#include "twin/diagnose/rotary/signals.h"

namespace twinbench::diagnose::rotary {
namespace {

using units::um;

constexpr double kPlausible_m = 0.5 * um;  // of a disturbance on a PSD
constexpr double kPlausibleShare = 0.005;  // of a wrong scale

/// "psd_b_y" or "psd_a_y, psd_b_y (tilt pattern)".
std::string OnWhat(const std::string& place) {
  if (place == "yaw") return "psd_a_x, psd_b_x in phase (yaw pattern)";
  if (place == "tilt") return "psd_a_y, psd_b_y in phase (tilt pattern)";
  if (place == "roll") return "psd_a_y, psd_b_y in antiphase (roll pattern)";
  if (place == "lateral") return "psd_a_x, psd_b_x in antiphase (lateral pattern)";
  if (place == "all") return "all channels";
  return place;
}

std::string Size(const Eigen::VectorXd& amplitudes) {
  return fmt::format("amplitude {:.2g} um", amplitudes.norm() / um);
}

using Describe = std::function<std::string(int grid_point)>;

/// Collects families of one sort: the same signals on every place.
struct Collector {
  const std::vector<Place>& places;
  std::vector<Family>& families;

  /// @param signals  Grid point -> readings x k, each of rms about one.
  void Add(const std::string& sort, int grid, int k, const std::function<Eigen::MatrixXd(int)>& signals,
           const Describe& describe) const {
    auto base = std::make_shared<Base>();
    base->grid = grid;
    base->columns = [signals](int g) { return OnEachChannel(signals(g), kChannels); };
    for (const Place& place : places) Add(sort, place.name, base, PatternMap(place.weight, k), describe);
    Add(sort, "all", base, Eigen::MatrixXd::Identity(kChannels * k, kChannels * k), describe);
  }
  /// A random walk by its cosine modes, amplitudes falling as 1 / k; the generic form of any slow wander.
  void AddRandomWalk(const Eigen::VectorXd& phase) const {
    constexpr int kModes = 24;
    Eigen::MatrixXd modes(phase.size(), kModes);
    for (int k = 0; k < kModes; ++k) modes.col(k) = ((k + 1) * phase.array()).cos() / (k + 1);
    auto base = std::make_shared<Base>();
    base->columns = [modes](int) { return OnEachChannel(modes, kChannels); };
    for (const Place& place : places) {
      Add("wander", place.name, base, PatternMap(place.weight, kModes),
          [](int) { return std::string("random wander locked to time"); });
    }
  }
  void Add(const std::string& sort, const std::string& where, const std::shared_ptr<const Base>& base,
           const Eigen::MatrixXd& map, const Describe& describe) const {
    Family family;
    family.kind = Kind::kUnknown;
    family.effect = family.group = sort;
    family.where = where;
    family.amplitudes.assign(static_cast<std::size_t>(map.cols()), {"amplitude", "um", um, kPlausible_m});
    family.grid = base->grid;
    family.base = base;
    family.map = map;
    family.describe = [where, describe](int g, const Eigen::VectorXd& x) {
      return fmt::format("{}, on {}, {}", describe(g), OnWhat(where), Size(x));
    };
    families.push_back(std::move(family));
  }
};

Eigen::VectorXd Unit(Eigen::VectorXd signal) {
  const double rms =
      std::sqrt(signal.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(1, signal.size())));
  return rms > 0.0 ? Eigen::VectorXd(signal / rms) : signal;
}

/// Indicator columns of the values that a label takes in full circles.
Eigen::MatrixXd Indicators(const std::vector<int>& label, const Eigen::VectorXd& in_circle) {
  const std::set<int> values(label.begin(), label.end());
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(in_circle.size(), std::ssize(values));
  Eigen::Index k = 0;
  for (const int value : values) {
    for (Eigen::Index i = 0; i < in_circle.size(); ++i) {
      if (label[static_cast<std::size_t>(i)] == value) columns(i, k) = in_circle[i];
    }
    ++k;
  }
  return columns;
}

Eigen::MatrixXd Wave(const Eigen::VectorXd& angle, const Eigen::VectorXd& factor) {
  Eigen::MatrixXd wave(angle.size(), 2);
  wave.col(0) = angle.array().cos() * factor.array();
  wave.col(1) = angle.array().sin() * factor.array();
  return wave;
}

void AddPasses(const Schedule& s, const Collector& add) {
  const Eigen::VectorXd in = InCircle(s);
  const Eigen::MatrixXd passes = Indicators(s.pass, in);
  add.Add(
      "pass offset", 1, static_cast<int>(passes.cols()), [passes](int) { return passes; },
      [](int) { return std::string("offset per pass, locked to the pass (time)"); });
  std::vector<int> both;
  for (std::size_t i = 0; i < s.pass.size(); ++i) both.push_back(1000 * s.setup[i] + s.pass[i]);
  const Eigen::MatrixXd visits = Indicators(both, in);
  add.Add(
      "pass offset", 1, static_cast<int>(visits.cols()), [visits](int) { return visits; },
      [](int) { return std::string("offset per pass of each set-up, locked to the pass (time)"); });
  for (int h = 1; h <= 3; ++h) {
    Eigen::MatrixXd waves(s.Readings(), 2 * passes.cols());
    for (Eigen::Index p = 0; p < passes.cols(); ++p)
      waves.middleCols(2 * p, 2) = Wave(h * s.target_rad, passes.col(p));
    add.Add(
        "pass harmonic", 1, static_cast<int>(waves.cols()), [waves](int) { return waves; },
        [h](int) { return fmt::format("order {} of the target angle that differs from pass to pass", h); });
  }
}

void AddDirections(const Schedule& s, const Collector& add) {
  constexpr int kOrders = 12;
  const Eigen::VectorXd direction = DirectionSignal(s);
  add.Add(
      "direction offset", 1, 1, [direction](int) { return Eigen::MatrixXd(direction); },
      [](int) { return std::string("offset locked to direction (odd)"); });
  add.Add(
      "direction harmonic", kOrders, 2, [&s, direction](int g) { return Wave((g + 1) * s.target_rad, direction); },
      [](int g) { return fmt::format("direction times order {} of target angle, odd in direction", g + 1); });
  add.Add(
      "direction harmonic", kOrders, 2,
      [&s, direction](int g) { return Wave((g + 1) * s.reference_rad, direction); },
      [](int g) { return fmt::format("direction times order {} of reference angle, odd in direction", g + 1); });
}

/// Orders a of the target and b of the reference together; pure orders of either are in the tables.
void AddInteractions(const Schedule& s, const Collector& add) {
  constexpr int kMost = 8;
  std::vector<std::pair<int, int>> orders;
  for (int a = 1; a <= kMost; ++a) {
    for (int b = -kMost; b <= kMost; ++b) {
      if (b != 0 && b != a) orders.emplace_back(a, b);  // a = b is a constant of the set-up
    }
  }
  const Eigen::VectorXd in = InCircle(s);
  add.Add(
      "interaction", static_cast<int>(std::ssize(orders)), 2,
      [&s, in, orders](int g) {
        const auto [a, b] = orders[static_cast<std::size_t>(g)];
        return Wave(a * s.target_rad + b * s.reference_rad, in);
      },
      [orders](int g) {
        const auto [a, b] = orders[static_cast<std::size_t>(g)];
        return fmt::format(
            "order {} target {} {} reference, locked to both angles (interaction), same in both directions", a,
            b > 0 ? '+' : '-', std::abs(b));
      });
}

void AddLines(const Schedule& s, const Collector& add) {
  std::vector<double> orders;
  for (int k = 2; k <= 240; ++k) {
    if (k % 20 != 0) orders.push_back(0.05 * k);
  }
  const Eigen::VectorXd angle = ContinuedTarget_rad(s, false), in = InCircle(s);
  add.Add(
      "line", static_cast<int>(std::ssize(orders)), 2,
      [angle, in, orders](int g) { return Wave(orders[static_cast<std::size_t>(g)] * angle, in); },
      [orders](int g) {
        return fmt::format("line at {:.3g} per turn, locked to the continued target angle",
                           orders[static_cast<std::size_t>(g)]);
      });
}

void AddTimes(const Schedule& s, const SignalContext& context, const Collector& add) {
  constexpr int kOrders = 10;
  const double begin_s = s.time_s.minCoeff(), duration_s = std::max(1.0, s.time_s.maxCoeff() - begin_s);
  const Eigen::VectorXd phase = units::kPi * (s.time_s.array() - begin_s) / duration_s;
  add.Add(
      "wander", kOrders, 1, [phase](int g) { return Eigen::MatrixXd(((g + 1) * phase.array()).cos().matrix()); },
      [](int g) { return fmt::format("slow wander locked to time, {} half periods a run", g + 1); });
  Eigen::MatrixXd together(s.Readings(), 6);
  for (int k = 0; k < 6; ++k) together.col(k) = ((k + 1) * phase.array()).cos();
  add.Add(
      "wander", 1, 6, [together](int) { return together; },
      [](int) { return std::string("slow wander locked to time"); });
  add.AddRandomWalk(phase);
  Eigen::MatrixXd slopes = Indicators(s.setup, InCircle(s)).array().colwise() * phase.array();
  add.Add(
      "wander", 1, static_cast<int>(slopes.cols()), [slopes](int) { return slopes; },
      [](int) { return std::string("drift that differs from set-up to set-up, locked to time"); });
  const std::vector<double> restarts_s = {10.0, 30.0, 100.0, 300.0, 1000.0, 3000.0};
  add.Add(
      "restart", static_cast<int>(std::ssize(restarts_s)), 1,
      [&s, restarts_s](int g) {
        return Eigen::MatrixXd(Unit(CreepSignal(s, restarts_s[static_cast<std::size_t>(g)])));
      },
      [restarts_s](int g) {
        return fmt::format("creep that restarts with every set-up, about {:.0f} s, locked to time",
                           restarts_s[static_cast<std::size_t>(g)]);
      });
  if (!s.temperature_degC.array().isFinite().any()) return;
  const std::vector<double> lags_s = {0.0, 300.0, 900.0, 2700.0};
  add.Add(
      "temperature", static_cast<int>(std::ssize(lags_s)), 1,
      [&s, &context, lags_s](int g) {
        return Eigen::MatrixXd(
            Unit(LaggedTemperature(s, context.reference_degC, lags_s[static_cast<std::size_t>(g)])));
      },
      [lags_s](int g) {
        return fmt::format("locked to temperature with a lag of {:.0f} s", lags_s[static_cast<std::size_t>(g)]);
      });
}

void AddDwells(const Schedule& s, const Collector& add) {
  const Eigen::VectorXd direction = DirectionSignal(s);
  std::set<double> levels;
  for (const double d : s.dwell_s) {
    if (std::isfinite(d)) levels.insert(std::round(d * 10.0) / 10.0);
  }
  if (levels.size() < 2 || levels.size() > 8) return;
  Eigen::MatrixXd by_level = Eigen::MatrixXd::Zero(s.Readings(), std::ssize(levels));
  for (Eigen::Index i = 0; i < by_level.rows(); ++i) {
    const auto found = levels.find(std::round(s.dwell_s[i] * 10.0) / 10.0);
    if (found != levels.end()) by_level(i, std::distance(levels.begin(), found)) = 1.0;
  }
  const auto k = static_cast<int>(by_level.cols());
  add.Add(
      "dwell", 1, k, [by_level](int) { return by_level; }, [](int) { return std::string("depends on the dwell"); });
  const Eigen::MatrixXd directed = by_level.array().colwise() * direction.array();
  add.Add(
      "dwell", 1, k, [directed](int) { return directed; },
      [](int) { return std::string("direction times a function of the dwell, odd in direction"); });
}

/// A scale of each channel that follows a signal.
void AddGains(const RotaryRun& rotary, const SignalContext& context, const Collector& collect) {
  const Schedule& s = rotary.run.schedule;
  std::vector<std::pair<std::string, Eigen::MatrixXd>> followed = {
      {"time", Unit((s.time_s.array() - s.time_s.mean()).matrix())}, {"direction", DirectionSignal(s)}};
  if (s.temperature_degC.array().isFinite().any()) {
    const Eigen::VectorXd T = LaggedTemperature(s, context.reference_degC, 0.0);
    followed.emplace_back("temperature", Unit((T.array() - T.mean()).matrix()));
    followed.emplace_back("temperature", Unit(T));  // nothing at the reference temperature
  }
  for (const auto& [what, signal] : followed) {
    auto base = std::make_shared<Base>();
    base->columns = [shown = context.shown_m, signal = signal](int) {
      Eigen::MatrixXd rows = OnEachChannel(signal, kChannels);
      return Eigen::MatrixXd(rows.array().colwise() * shown.array());
    };
    const std::size_t first = collect.families.size();
    const Describe describe = [what = what](int) { return fmt::format("gain follows {}", what); };
    for (int c = 0; c < kChannels; ++c) {
      const Eigen::Vector4d weight = Eigen::Vector4d::Unit(c);
      collect.Add("gain follows " + what, kChannelNames[static_cast<std::size_t>(c)], base, weight, describe);
    }
    for (const char* psd : {"psd_a", "psd_b"}) {
      collect.Add("gain follows " + what, psd, base, WeightOf(psd, context.shown_by_motion), describe);
    }
    collect.Add("gain follows " + what, "all", base, Eigen::MatrixXd::Identity(kChannels, kChannels), describe);
    for (std::size_t k = first; k < collect.families.size(); ++k) {
      Family& family = collect.families[k];
      for (Amplitude& a : family.amplitudes) a = {"scale", "1", 1.0, kPlausibleShare};
      family.group = "gain changes";  // whatever it follows
      family.describe = [where = family.where, what = what](int, const Eigen::VectorXd& x) {
        return fmt::format("gain of {} follows {}, locked to {} and spot, {:.2g} rms", where, what, what, x.norm());
      };
    }
  }
}

/// Spot coordinates of reading i in units of the largest in the run: a function of them stays of order one.
Eigen::MatrixXd SpotSeries(const RotaryRun& rotary) {
  const Eigen::VectorXd shown_m = rotary.run.Predicted();
  Eigen::MatrixXd spots(rotary.run.schedule.Readings(), kChannels);
  for (Eigen::Index i = 0; i < spots.rows(); ++i) spots.row(i) = shown_m.segment<4>(4 * i).transpose();
  return spots;
}

Eigen::MatrixXd Powers(const Eigen::VectorXd& u, const Eigen::VectorXd& v) {
  Eigen::MatrixXd p(u.size(), 9);
  const auto a = u.array(), b = v.array();
  p << a.square().matrix(), (a * b).matrix(), b.square().matrix(), a.cube().matrix(), (a.square() * b).matrix(),
      (a * b.square()).matrix(), b.cube().matrix(), a.square().square().matrix(),
      (a.square().square() * a).matrix();
  return p;
}

/// Families of one channel only: rows of the others are zero.
void AddOnChannel(const std::string& sort, int channel, int grid, int k, double plausible,
                  const std::function<Eigen::MatrixXd(int)>& signals, const Describe& describe,
                  std::vector<Family>& families) {
  Family family;
  family.kind = Kind::kUnknown;
  family.effect = family.group = sort;
  family.where = kChannelNames[static_cast<std::size_t>(channel)];
  family.amplitudes.assign(static_cast<std::size_t>(k), {"amplitude", "um", um, plausible});
  family.grid = grid;
  family.columns = [signals, channel](int g) { return OnChannels(signals(g), Eigen::Vector4d::Unit(channel)); };
  family.describe = [where = family.where, describe](int g, const Eigen::VectorXd& x) {
    return fmt::format("{}, on {}, {}", describe(g), where, Size(x));
  };
  families.push_back(std::move(family));
}

void AddSpots(const RotaryRun& rotary, std::vector<Family>& families) {
  const Eigen::MatrixXd spots = SpotSeries(rotary);
  const double range_m = std::max(spots.cwiseAbs().maxCoeff(), 1.0 * um);
  for (int c = 0; c < kChannels; ++c) {
    const Eigen::VectorXd u = spots.col(c), v = spots.col(c ^ 1);
    const std::string name = kChannelNames[static_cast<std::size_t>(c)];
    const Eigen::MatrixXd powers = Powers(u / range_m, v / range_m);
    AddOnChannel(
        "spot", c, 1, 9, 2.0 * kPlausible_m, [powers](int) { return powers; },
        [name](int) { return "smooth function of the spot position of " + name + ", locked to spot"; }, families);
    const Eigen::MatrixXd linear = spots / range_m;
    AddOnChannel(
        "linear map", c, 1, 4, kPlausibleShare * range_m, [linear](int) { return linear; },
        [name](int) { return "proportional to the spot positions, locked to spot, on " + name; }, families);
    // Half a cycle of phase between the ends of the range from one period to the next.
    const double span_m = u.maxCoeff() - u.minCoeff();
    const double longest_m = std::max(span_m / 2.0, 20.0 * um), shortest_m = 12.0 * um;
    const double step_per_m = 0.4 / std::max(span_m, 40.0 * um);
    const int grid = std::clamp(static_cast<int>((1.0 / shortest_m - 1.0 / longest_m) / step_per_m), 1, 400);
    const auto wave_number = [=](int g) { return 2.0 * units::kPi * (1.0 / longest_m + g * step_per_m); };
    AddOnChannel(
        "spot fringes", c, grid, 2, kPlausible_m,
        [u, wave_number](int g) { return Wave(wave_number(g) * u, Eigen::VectorXd::Ones(u.size())); },
        [name, wave_number](int g) {
          return fmt::format("periodic in spot position of {}, period {:.1f} um, locked to spot", name,
                             2.0 * units::kPi / wave_number(g) / um);
        },
        families);
  }
}

/// Wrong scales and turned axes of several channels at once.
void AddLinearMaps(const RotaryRun& rotary, std::vector<Family>& families) {
  const Eigen::MatrixXd spots = SpotSeries(rotary);
  const auto add = [&](const std::string& where, const std::string& text,
                       const std::function<Eigen::MatrixXd()>& columns) {
    Family family;
    family.kind = Kind::kUnknown;
    family.effect = family.group = "linear map";
    family.where = where;
    const Eigen::MatrixXd fixed = columns();
    family.amplitudes.assign(static_cast<std::size_t>(fixed.cols()), {"share", "1", 1.0, kPlausibleShare});
    family.columns = [fixed](int) { return fixed; };
    family.describe = [text](int, const Eigen::VectorXd& x) {
      return fmt::format("{}, proportional to the spot positions, locked to spot, {:.2g} rms", text, x.norm());
    };
    families.push_back(std::move(family));
  };
  const auto product = [spots](int on, int of) { return OnChannels(spots.col(of), Eigen::Vector4d::Unit(on)); };
  const auto beside = [product](const std::vector<std::pair<int, int>>& pairs) {
    Eigen::MatrixXd columns(product(0, 0).rows(), std::ssize(pairs));
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      columns.col(static_cast<Eigen::Index>(k)) = product(pairs[k].first, pairs[k].second);
    }
    return columns;
  };
  add("all", "scales of all channels", [&] { return beside({{0, 0}, {1, 1}, {2, 2}, {3, 3}}); });
  add("psd_a", "scales and axes of psd_a", [&] { return beside({{0, 0}, {0, 1}, {1, 0}, {1, 1}}); });
  add("psd_b", "scales and axes of psd_b", [&] { return beside({{2, 2}, {2, 3}, {3, 2}, {3, 3}}); });
}

void AddSharedSeries(const SharedSeries& series, const Collector& collect) {
  const auto frequency = [f = series.frequency_Hz](int g) {
    return fmt::format("tone at {:.4g} Hz, locked to time", f[static_cast<std::size_t>(g)]);
  };
  const auto onset = [o = series.onset](int g) {
    return fmt::format("step at reading {}, locked to time", o[static_cast<std::size_t>(g)]);
  };
  const int tone = 2 * kChannels;
  collect.Add("tone of another pattern", "all", series.tone, Eigen::MatrixXd::Identity(tone, tone), frequency);
  collect.Add("step of another pattern", "all", series.step, Eigen::MatrixXd::Identity(kChannels, kChannels),
              onset);
  for (const Place& place : collect.places) {
    if (place.name == "roll" || place.name == "lateral") {
      collect.Add("tone of another pattern", place.name, series.tone, PatternMap(place.weight, 2), frequency);
    }
    if (place.name == "roll" || place.name.starts_with("psd")) {
      collect.Add("step of another pattern", place.name, series.step, PatternMap(place.weight, 1), onset);
    }
  }
}

}  // namespace

std::vector<Family> UnknownFamilies(const RotaryRun& rotary, const SignalContext& context,
                                    const SharedSeries& series) {
  const std::vector<Place> places = PlacesOf(rotary.shown_by_motion);
  std::vector<Family> families;
  const Collector collect{places, families};
  const Schedule& s = rotary.run.schedule;
  AddPasses(s, collect);
  AddDirections(s, collect);
  AddInteractions(s, collect);
  AddLines(s, collect);
  AddTimes(s, context, collect);
  AddDwells(s, collect);
  AddGains(rotary, context, collect);
  AddSpots(rotary, families);
  AddLinearMaps(rotary, families);
  AddSharedSeries(series, collect);
  return families;
}

}  // namespace twinbench::diagnose::rotary
