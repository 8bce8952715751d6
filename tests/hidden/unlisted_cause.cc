#include "tests/hidden/unlisted_cause.h"

namespace twinbench::hidden {
namespace {

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

std::vector<std::string> ChannelsOf(const Eigen::RowVector4d& pattern) {
  std::vector<std::string> channels;
  for (int c = 0; c < kChannels; ++c) {
    if (pattern[c] != 0.0) channels.emplace_back(kChannelNames[static_cast<std::size_t>(c)]);
  }
  return channels;
}

/// Adds the signal at the size that gives it the length `rho`.
void AddWithLength(double rho, const std::string& bench, const Eigen::MatrixXd& signal, const SignatureScale& scale,
                   std::uint64_t seed, std::vector<Reading>& readings) {
  constexpr double kUnit = 1e-6;
  std::vector<Reading> with = readings;
  AddTo(bench, kUnit * signal, with);
  AddTo(bench, kUnit * rho / scale.Rho(with, readings, seed) * signal, readings);
}

Case MakeUnlisted(Design design, const UnlistedCause& cause, double rho, std::uint64_t seed,
                  const SignatureScale& scale) {
  Case made{.scenario = Believed(design), .readings = TakeReadings(Drawn(design, seed))};
  Stream stream(seed, "hidden.unlisted");
  const UnlistedSignal drawn = cause.draw({made.readings, stream, stream});
  AddWithLength(rho, BenchOf(design), drawn.signal, scale, seed, made.readings);
  made.hidden.unlisted = cause.name;
  made.hidden.locks = drawn.locks;
  made.hidden.channels = drawn.channels;
  made.hidden.rho = rho;
  return made;
}

/// A series times what one channel shows. It begins at zero: the calibration saw the right gain, or else this would
/// be a wrong gain and hardly more.
UnlistedSignal Gain(const Draw& draw, const std::string& lock, const Draw::Value& excess) {
  const std::size_t c = draw.Channel();
  return OnChannel(c, {lock}, draw.Series([&](std::size_t i) { return excess(i) * draw.Spot_m(i, c); }));
}

const std::vector<UnlistedCause> kOfRotary = {
    {"offset per pass", [](const Draw& draw) {
      std::map<std::pair<int, int>, double> offset;
      const auto of_pass = [&](std::size_t i) {
        const std::pair pass{draw.readings[i].setup, draw.readings[i].pass};
        if (!offset.contains(pass)) offset[pass] = draw.of_run.Normal();
        return offset[pass];
      };
      const Eigen::VectorXd series = draw.FullCircleSeries(of_pass);
      return OnChannel(draw.Channel(), {"pass"}, series);
    }},
    {"gain follows temperature", [](const Draw& draw) {
      return Gain(draw, "temperature",
                  [&](std::size_t i) { return draw.readings[i].temperature_degC - draw.readings[0].temperature_degC; });
    }},
    // A gain that grows with time and with its square.
    {"gain warms up", [](const Draw& draw) {
      const double duration_h = draw.Hours(draw.readings.size() - 1);
      return Gain(draw, "time", [&](std::size_t i) {
        const double x = draw.Hours(i) / duration_h;
        return x * (2.0 - x);
      });
    }},
    {"interharmonic tilt", [](const Draw& draw) {
      // Of equal orders only the shift would be left, which is a constant of the set-up.
      const int a = draw.Whole(1, 4), b = (a + draw.Whole(0, 2)) % 4 + 1;
      const double phase = draw.Phase();
      const auto wave = [&](std::size_t i) {
        return std::cos(a * draw.readings[i].target_rad + b * draw.readings[i].reference_rad + phase);
      };
      return OnPattern("tilt", {"both angles"}, draw.FullCircleSeries(wave));
    }},
    {"directed roll harmonic", [](const Draw& draw) {
      const Draw::Value map = draw.DirectionMap(&Reading::target_rad, 1, 5);
      return OnPattern("roll", {"direction"}, draw.FullCircleSeries(map));
    }},
    {"fringes in spot position", [](const Draw& draw) {
      const std::size_t c = draw.Channel();
      const double period_m = LogUniformIn(draw.stream, 25e-6, 150e-6), phase = draw.Phase();
      const auto fringe = [&](std::size_t i) {
        return std::cos(2.0 * units::kPi * draw.Spot_m(i, c) / period_m + phase);
      };
      return OnChannel(c, {"spot"}, draw.Series(fringe));
    }},
    {"random walk of tilt", [](const Draw& draw) {
      double at = 0.0;
      const auto walk = [&](std::size_t i) { return at += std::sqrt(draw.StepHours(i)) * draw.of_run.Normal(); };
      return OnPattern("tilt", {"time"}, draw.Series(walk));
    }},
    // Sum of first-order processes whose time constants are spaced evenly in their logarithm: 1/f between them.
    {"1/f drift of a channel", [](const Draw& draw) {
      const Eigen::VectorXd constants_h{{0.005, 0.02, 0.08, 0.32, 1.3}};
      Eigen::VectorXd state(constants_h.size());
      for (double& s : state) s = draw.of_run.Normal();
      const Eigen::VectorXd series = draw.Series([&](std::size_t i) {
        for (Eigen::Index k = 0; k < state.size(); ++k) {
          const double keep = std::exp(-draw.StepHours(i) / constants_h[k]);
          state[k] = keep * state[k] + std::sqrt(1.0 - keep * keep) * draw.of_run.Normal();
        }
        return state.sum();
      });
      return OnChannel(draw.Channel(), {"time"}, series);
    }},
    // Bending by a gradient: follows how fast the temperature changes, smoothed over some minutes.
    {"tilt follows heating", [](const Draw& draw) {
      constexpr double kSmoothing_h = 0.1;
      double rate_K_h = 0.0;
      const auto smoothed = [&](std::size_t i) {
        if (i == 0) return 0.0;
        const double step_h = draw.StepHours(i);
        const double slope_K_h = (draw.readings[i].temperature_degC - draw.readings[i - 1].temperature_degC) / step_h;
        return rate_K_h += (1.0 - std::exp(-step_h / kSmoothing_h)) * (slope_K_h - rate_K_h);
      };
      return OnPattern("tilt", {"time", "temperature"}, draw.Series(smoothed));
    }},
    // A direction-dependent pull of the cable that builds up over a pass.
    {"wind-up roll", [](const Draw& draw) {
      const auto pull = [&](std::size_t i) {
        const Reading& r = draw.readings[i];
        const double along = r.direction > 0 ? r.position / 36.0 : 1.0 - r.position / 36.0;
        return r.direction * (1.0 - std::exp(-5.0 * along));
      };
      return OnPattern("roll", {"direction"}, draw.FullCircleSeries(pull));
    }}};

}  // namespace

double Draw::Hours(std::size_t i) const { return ToSeconds(readings[i].time - readings[0].time) / units::hour; }

double Draw::StepHours(std::size_t i) const { return i == 0 ? 0.0 : Hours(i) - Hours(i - 1); }

double Draw::Spot_m(std::size_t i, std::size_t channel) const {
  return readings[i].mean_V[channel] / kSensitivity_V_m;
}

Draw::Value Draw::DirectionMap(Angle angle, int first_order, int last_order) const {
  const int order = Whole(first_order, last_order);
  return [this, angle, order, phase = Phase()](std::size_t i) {
    return readings[i].direction * std::cos(order * readings[i].*angle + phase);
  };
}

Draw::Value Draw::LineBetween(Angle angle, int first_order, int last_order) const {
  const int whole = Whole(first_order, last_order);
  const double order = whole + UniformIn(stream, 0.3, 0.7);
  return
      [this, angle, order, phase = Phase()](std::size_t i) { return std::cos(order * readings[i].*angle + phase); };
}

Draw::Value Draw::Wander(double from_min, double to_min) const {
  const double minutes = UniformIn(stream, from_min, to_min);
  std::vector<double> levels;
  for (int k = 0; k < 200; ++k) levels.push_back(of_run.Normal());
  return [this, minutes, levels](std::size_t i) {
    const double at = 60.0 * Hours(i) / minutes;
    const auto k = static_cast<std::size_t>(at) % (levels.size() - 1);
    return levels[k] + (at - std::floor(at)) * (levels[k + 1] - levels[k]);
  };
}

Eigen::VectorXd Draw::Series(const Value& value) const {
  Eigen::VectorXd series(static_cast<Eigen::Index>(readings.size()));
  for (std::size_t i = 0; i < readings.size(); ++i) series[static_cast<Eigen::Index>(i)] = value(i);
  return series;
}

Eigen::VectorXd Draw::FullCircleSeries(const Value& value) const {
  return Series([&](std::size_t i) { return readings[i].phase == Phase::kFullCircle ? value(i) : 0.0; });
}

UnlistedSignal OnPattern(const std::string& pattern, const std::vector<std::string>& locks,
                         const Eigen::VectorXd& series) {
  return {locks, ChannelsOf(Pattern(pattern)), series * Pattern(pattern)};
}

UnlistedSignal OnChannel(std::size_t channel, const std::vector<std::string>& locks,
                         const Eigen::VectorXd& series) {
  return OnPattern(kChannelNames[channel], locks, series);
}

UnlistedSignal OnColumn(Eigen::Index channel, Eigen::Index channels, const std::vector<std::string>& locks,
                        const Eigen::VectorXd& series) {
  return {locks, {}, series * Eigen::RowVectorXd::Unit(channels, channel)};
}

std::vector<Plan> UnlistedPlans(const std::string& bench, const TwinOptions& options) {
  std::vector<Plan> plans;
  std::uint64_t seed = 400000 + options.first_seed;
  for (const Design design : PlainDesigns(bench)) {
    for (const UnlistedCause& cause : UnlistedCausesOf(bench)) {
      for (int k = 0; k < options.magnitudes * options.seeds; ++k) {
        ++seed;
        const double rho = options.RhoOf(k);
        plans.push_back({"unlisted " + bench, std::to_string(seed),
                         [=] { return MakeUnlisted(design, cause, rho, seed, ScaleOf(design)); }});
      }
    }
  }
  return plans;
}

const std::vector<UnlistedCause>& RotaryUnlistedCauses() {
  return kOfRotary;
}

}  // namespace twinbench::hidden
