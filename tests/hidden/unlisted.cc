#include "tests/hidden/unlisted.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>

#include "twin/core/errors.h"

namespace twinbench::hidden {
namespace {

using units::kPi;

constexpr double kSensitivity_V_m = 2000.0;

/// Readings with the random stream of one case.
struct Draw {
  const std::vector<Reading>& readings;
  Stream& stream;

  int Whole(int first, int last) const { return first + static_cast<int>(stream.Uniform() * (last - first + 1)); }
  double Phase() const { return 2.0 * kPi * stream.Uniform(); }
  std::size_t size() const { return readings.size(); }
  double Hours(std::size_t i) const { return ToSeconds(readings[i].time - readings[0].time) / units::hour; }
  double DurationHours() const { return Hours(size() - 1); }
  bool InCircle(std::size_t i) const { return readings[i].phase == Phase::kFullCircle; }
};

Eigen::VectorXd Series(const Draw& draw, const std::function<double(std::size_t)>& value, bool circle_only) {
  Eigen::VectorXd series = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(draw.size()));
  for (std::size_t i = 0; i < draw.size(); ++i) {
    if (!circle_only || draw.InCircle(i)) series[static_cast<Eigen::Index>(i)] = value(i);
  }
  return series;
}

/// Weights of a pattern of motion on psd_a_x, psd_a_y, psd_b_x, psd_b_y.
Eigen::RowVector4d Pattern(const std::string& name) {
  if (name == "yaw") return {1, 0, 1, 0};
  if (name == "tilt") return {0, 1, 0, 1};
  if (name == "roll") return {0, 1, 0, -1};
  Eigen::RowVector4d one = Eigen::RowVector4d::Zero();
  for (int c = 0; c < kChannels; ++c) {
    if (name == kChannelNames[static_cast<std::size_t>(c)]) one[c] = 1.0;
  }
  return one;
}

std::vector<std::string> ChannelsOf(const std::string& pattern) {
  std::vector<std::string> channels;
  for (int c = 0; c < kChannels; ++c) {
    if (Pattern(pattern)[c] != 0.0) channels.emplace_back(kChannelNames[static_cast<std::size_t>(c)]);
  }
  return channels;
}

std::string AnyChannel(const Draw& draw) {
  return kChannelNames[static_cast<std::size_t>(draw.Whole(0, kChannels - 1))];
}

Unlisted On(const std::string& pattern, const std::vector<std::string>& locks, const Eigen::VectorXd& series) {
  return {"", locks, ChannelsOf(pattern), series * Pattern(pattern)};
}

/// A series times what one channel shows. It begins at zero: the calibration saw the right gain, or else this would
/// be a wrong gain and hardly more.
Unlisted Gain(const Draw& draw, const std::vector<std::string>& locks, const Eigen::VectorXd& series) {
  const int c = draw.Whole(0, kChannels - 1);
  const std::string channel = kChannelNames[static_cast<std::size_t>(c)];
  Eigen::VectorXd shown = series;
  for (std::size_t i = 0; i < draw.size(); ++i)
    shown[static_cast<Eigen::Index>(i)] *= draw.readings[i].mean_V[static_cast<std::size_t>(c)] / kSensitivity_V_m;
  return On(channel, locks, shown);
}

Unlisted PassOffset(const Draw& draw) {
  std::map<std::pair<int, int>, double> offset;
  return On(AnyChannel(draw), {"pass"},
            Series(
                draw,
                [&](std::size_t i) {
                  const std::pair key{draw.readings[i].setup, draw.readings[i].pass};
                  if (!offset.contains(key)) offset[key] = draw.stream.Normal();
                  return offset[key];
                },
                true));
}

Unlisted GainOfTemperature(const Draw& draw) {
  return Gain(
      draw, {"temperature"},
      Series(
          draw,
          [&](std::size_t i) { return draw.readings[i].temperature_degC - draw.readings[0].temperature_degC; },
          false));
}

/// A gain that grows with time and with its square.
Unlisted WarmingGain(const Draw& draw) {
  return Gain(draw, {"time"},
              Series(
                  draw,
                  [&](std::size_t i) {
                    const double x = draw.Hours(i) / draw.DurationHours();
                    return x * (2.0 - x);
                  },
                  false));
}

Unlisted Interharmonic(const Draw& draw) {
  // Of equal orders only the shift would be left, which is a constant of the set-up.
  const int a = draw.Whole(1, 4), b = (a + draw.Whole(0, 2)) % 4 + 1;
  const double phase = draw.Phase();
  return On("tilt", {"both angles"},
            Series(
                draw,
                [&](std::size_t i) {
                  return std::cos(a * draw.readings[i].target_rad + b * draw.readings[i].reference_rad + phase);
                },
                true));
}

Unlisted DirectionHarmonic(const Draw& draw) {
  const int order = draw.Whole(1, 5);
  const double phase = draw.Phase();
  return On("roll", {"direction"},
            Series(
                draw,
                [&](std::size_t i) {
                  return draw.readings[i].direction * std::cos(order * draw.readings[i].target_rad + phase);
                },
                true));
}

Unlisted Fringe(const Draw& draw) {
  const int c = draw.Whole(0, kChannels - 1);
  const double period_m = LogUniformIn(draw.stream, 25e-6, 150e-6), phase = draw.Phase();
  return On(kChannelNames[static_cast<std::size_t>(c)], {"spot"},
            Series(
                draw,
                [&](std::size_t i) {
                  const double spot_m = draw.readings[i].mean_V[static_cast<std::size_t>(c)] / kSensitivity_V_m;
                  return std::cos(2.0 * kPi * spot_m / period_m + phase);
                },
                false));
}

Unlisted RandomWalk(const Draw& draw) {
  double at = 0.0;
  return On("tilt", {"time"},
            Series(
                draw,
                [&](std::size_t i) {
                  const double step_h = i == 0 ? 0.0 : draw.Hours(i) - draw.Hours(i - 1);
                  return at += std::sqrt(step_h) * draw.stream.Normal();
                },
                false));
}

/// Sum of first-order processes whose time constants are spaced evenly in their logarithm: 1/f between them.
Unlisted Flicker(const Draw& draw) {
  const std::vector<double> constants_h = {0.005, 0.02, 0.08, 0.32, 1.3};
  Eigen::VectorXd state = Eigen::VectorXd::NullaryExpr(5, [&](Eigen::Index) { return draw.stream.Normal(); });
  return On(AnyChannel(draw), {"time"},
            Series(
                draw,
                [&](std::size_t i) {
                  const double step_h = i == 0 ? 0.0 : draw.Hours(i) - draw.Hours(i - 1);
                  for (Eigen::Index k = 0; k < 5; ++k) {
                    const double keep = std::exp(-step_h / constants_h[static_cast<std::size_t>(k)]);
                    state[k] = keep * state[k] + std::sqrt(1.0 - keep * keep) * draw.stream.Normal();
                  }
                  return state.sum();
                },
                false));
}

/// Bending by a gradient: follows how fast the temperature changes, smoothed over some minutes.
Unlisted TiltOfHeating(const Draw& draw) {
  constexpr double kSmoothing_h = 0.1;
  double rate = 0.0;
  return On("tilt", {"time", "temperature"},
            Series(
                draw,
                [&](std::size_t i) {
                  if (i == 0) return 0.0;
                  const double step_h = draw.Hours(i) - draw.Hours(i - 1);
                  const double slope =
                      (draw.readings[i].temperature_degC - draw.readings[i - 1].temperature_degC) / step_h;
                  return rate += (1.0 - std::exp(-step_h / kSmoothing_h)) * (slope - rate);
                },
                false));
}

/// A direction-dependent pull of the cable that builds up over a pass.
Unlisted WindUp(const Draw& draw) {
  return On("roll", {"direction"},
            Series(
                draw,
                [&](std::size_t i) {
                  const Reading& r = draw.readings[i];
                  const double along = r.direction > 0 ? r.position / 36.0 : 1.0 - r.position / 36.0;
                  return r.direction * (1.0 - std::exp(-5.0 * along));
                },
                true));
}

Unlisted OnAngle(const std::vector<std::string>& locks, const Eigen::VectorXd& series) {
  return {"", locks, {}, series};
}

Unlisted NonIntegerLine(const Draw& draw) {
  const double order = draw.Whole(2, 12) + UniformIn(draw.stream, 0.3, 0.7), phase = draw.Phase();
  return OnAngle(
      {"per turn"},
      Series(
          draw, [&](std::size_t i) { return std::cos(order * draw.readings[i].reference_rad + phase); }, false));
}

Unlisted DirectionMap(const Draw& draw) {
  const int order = draw.Whole(2, 6);
  const double phase = draw.Phase();
  return OnAngle({"direction"}, Series(
                                    draw,
                                    [&](std::size_t i) {
                                      return draw.readings[i].direction *
                                             std::cos(order * draw.readings[i].reference_rad + phase);
                                    },
                                    false));
}

Unlisted AngleTone(const Draw& draw) {
  const double frequency_Hz = LogUniformIn(draw.stream, 0.01, 0.1), phase = draw.Phase();
  return OnAngle(
      {"time"},
      Series(
          draw, [&](std::size_t i) { return std::cos(2.0 * kPi * frequency_Hz * 3600.0 * draw.Hours(i) + phase); },
          false));
}

using Maker = std::function<Unlisted(const Draw&)>;
const std::vector<std::pair<std::string, Maker>>& Makers(const std::string& bench) {
  static const std::vector<std::pair<std::string, Maker>> rotary = {{"offset per pass", PassOffset},
                                                                    {"gain follows temperature", GainOfTemperature},
                                                                    {"gain warms up", WarmingGain},
                                                                    {"interharmonic tilt", Interharmonic},
                                                                    {"directed roll harmonic", DirectionHarmonic},
                                                                    {"fringes in spot position", Fringe},
                                                                    {"random walk of tilt", RandomWalk},
                                                                    {"1/f drift of a channel", Flicker},
                                                                    {"tilt follows heating", TiltOfHeating},
                                                                    {"wind-up roll", WindUp}};
  static const std::vector<std::pair<std::string, Maker>> encoder = {
      {"non-integer line", NonIntegerLine}, {"direction times order", DirectionMap}, {"tone in time", AngleTone}};
  return bench == kRotaryBench ? rotary : encoder;
}

void AddTo(std::vector<Reading>& readings, const Eigen::MatrixXd& signal) {
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (signal.cols() == 1) {
      readings[i].measured_rad += signal(row, 0);
      continue;
    }
    for (Eigen::Index c = 0; c < kChannels; ++c)
      readings[i].mean_V[static_cast<std::size_t>(c)] += kSensitivity_V_m * signal(row, c);
  }
}

Case MakeCase(Design design, const std::string& name, double rho, std::uint64_t seed, const SignatureScale& scale) {
  Case made;
  made.scenario = Believed(design);
  made.readings = TakeReadings(Drawn(design, seed));
  const Unlisted cause = DrawUnlisted(name, made.readings, seed);
  // Only its shape is drawn; the size follows from the length it is to have.
  std::vector<Reading> with = made.readings;
  const double unit = 1e-6;
  AddTo(with, unit * cause.signal);
  AddTo(made.readings, unit * rho / scale.Rho(with, made.readings) * cause.signal);
  made.hidden.unlisted = name;
  made.hidden.locks = cause.locks;
  made.hidden.channels = cause.channels;
  made.hidden.rho = rho;
  return made;
}

}  // namespace

Unlisted DrawUnlisted(const std::string& name, const std::vector<Reading>& readings, std::uint64_t seed) {
  Stream stream(seed, "hidden.unlisted");
  const auto& makers = Makers(BenchOf(readings));
  const auto found = std::ranges::find(makers, name, &std::pair<std::string, Maker>::first);
  Require(found != makers.end(), "there is no such unlisted cause");
  Unlisted cause = found->second({readings, stream});
  cause.name = name;
  return cause;
}

std::vector<std::string> UnlistedNames(const std::string& bench) {
  std::vector<std::string> names;
  for (const auto& [name, maker] : Makers(bench)) names.push_back(name);
  return names;
}

std::vector<Plan> UnlistedPlans(const std::string& bench, const TwinOptions& options) {
  const std::vector<Design> designs =
      bench == kRotaryBench ? std::vector{Design::kRotary} : std::vector{Design::kStops, Design::kSweep};
  std::vector<Plan> plans;
  std::uint64_t seed = 400000 + options.first_seed;
  for (const Design design : designs) {
    const auto scale = std::make_shared<const SignatureScale>(design, options.cache_folder);
    for (const std::string& name : UnlistedNames(bench)) {
      for (int k = 0; k < options.magnitudes * options.seeds; ++k) {
        ++seed;
        const double at = (k / options.seeds + 0.5) / options.magnitudes;
        const double rho = options.rho_from * std::pow(options.rho_to / options.rho_from, at);
        plans.push_back(
            {"unlisted " + bench, std::to_string(seed), [=] { return MakeCase(design, name, rho, seed, *scale); }});
      }
    }
  }
  return plans;
}

}  // namespace twinbench::hidden
