#include "tests/diagnose/encoder_fit.h"

// Each named family, where a cause shows times its course, against what the twin shows when the cause is at work:
// two implementations that share no code. Benches whose candidates the twin makes itself are not here: what their twins
// follow, tests/sim has.
namespace twinbench::diagnose::slopes {
namespace {

using Strings = std::vector<std::string>;
using Values = std::map<std::string, double>;

struct Design {
  std::string name;
  Strings changes;
  std::set<std::string> without;  // effects that such a run does not show, or that are no signature
};

const std::vector<Design>& Designs() {
  static const Strings sweep = {"encoder_procedure.kind=sweep", "encoder_procedure.mounting_deg=[0.0, 90.0]",
                                "encoder_procedure.interval_s=0.16", "device.lines_per_turn=20", "device.teeth=44",
                                "device.signal_periods=3", "device.signal_zero_deg=17",
                                "device.signal_zero_known=true"};
  static const std::set<std::string> not_at_stops = {"outliers", "interpolation", "gear_mesh", "reference_fault",
                                                     "latency",  "clock_rate",    "settling", "acceleration_error", "friction"};
  static const std::vector<Design> designs = {{"stops", {}, not_at_stops},
                                              {"sweep", sweep, {"outliers", "settling"}}};
  return designs;
}

/// Without noise and in a room that swings.
Scenario ScenarioOf(const Design& design) {
  Scenario scenario = LoadScenario(twinbench::test::ScenarioPath("encoder_comparison.toml"), design.changes);
  scenario.noise_free = true;
  scenario.environment.swing_K = 0.4;
  scenario.environment.swing_period_s = 4000.0;
  return scenario;
}

/// A run with its candidates.
struct Candidates {
  LinearRun run;
  std::vector<Family> families;
};

Candidates CandidatesOf(const Scenario& scenario, const std::vector<Reading>& readings,
                        const Strings& struck = {}) {
  const encoder::EncoderRun encoder = encoder::RunOf(readings, scenario);
  return {encoder.run, Families(encoder, struck)};
}

std::vector<Reading> ReadingsOf(const Scenario& scenario) {
  return twinbench::test::RunEncoderTwin(scenario).readings;
}

const Candidates& CleanOf(const Design& design) {
  static std::map<std::string, Candidates> clean;
  const Scenario scenario = ScenarioOf(design);
  if (!clean.contains(design.name)) clean[design.name] = CandidatesOf(scenario, ReadingsOf(scenario));
  return clean.at(design.name);
}

/// Sizes a tenth of the plausible ones, so that second orders are small, and other shapes than the catalogue's
/// zeros.
EffectSettings EffectAt(const EffectEntry& entry, const std::string& where) {
  const Values set = {{"phase", 0.7}, {"curvature", 0.4}, {"start", 0.4}};
  const std::set<std::string> shapes = {"order",     "teeth", "time_constant", "settles_over", "at_reading",
                                        "frequency", "level", "zero",          "period",       "warm_up"};
  EffectSettings effect{entry.name, where, {}, ""};
  for (const EffectParameter& p : entry.parameters) {
    const double value = set.contains(p.name) ? set.at(p.name) : (shapes.contains(p.name) ? 1.0 : 0.1) * p.default_SI;
    if (p.BelongsTo(where)) effect.parameters[p.name] = value;
  }
  if (entry.name == "signal_offset") effect.parameters["offset_cos"] = -0.5 * effect.parameters.at("offset_sin");
  return effect;
}

struct Slope {
  const Design* design;
  EffectSettings effect;
};

/// Every effect at every place.
std::vector<Slope> Slopes() {
  std::vector<Slope> slopes;
  for (const Design& design : Designs()) {
    for (const EffectEntry& entry : EffectCatalogue(kEncoderBench)) {
      if (design.without.contains(entry.name)) continue;
      for (const std::string& where : entry.places.empty() ? Strings{""} : entry.places)
        slopes.push_back({&design, EffectAt(entry, where)});
    }
    using twinbench::test::EncoderEffect;
    slopes.push_back({&design, EncoderEffect("drift", {{"rate", 1e-8}, {"warm_up", 300.0}})});
    slopes.push_back({&design, EncoderEffect("backlash", {{"width", 25.0 * units::deg}, {"start", 0.4}})});
  }
  return slopes;
}

/// What a family may leave at the effect's own shape, and at the nearest points of its grid.
struct Limit {
  double own = 1e-5, grid = 0.02;
};
Limit LimitOf(const Slope& slope) {
  static const std::map<std::string, Limit> limits = {
      {"amplitude_mismatch", {3e-4}},
      {"backlash", {1e-9, 0.2}},  // gaps of the grid differ by a factor 1.3
      {"clock_rate", {0.02}},
      {"drift", {1e-5, 0.08}},       // times by 1.36
      {"hysteresis", {1e-5, 0.05}},  // ways by 1.37
      {"latency", {3e-5}},           // in the ramps the speed changes meanwhile
      {"quadrature_error", {3e-4}},
      {"signal_clipping", {4e-4, 0.16}},  // depths by 1.65
      {"signal_offset", {3e-4}},
      {"slip", {1e-5, 0.11}},
      {"tone", {1e-5, 0.35}}};  // up to a quarter of a cycle over the run
  const auto of_effect = limits.find(slope.effect.name);
  return of_effect == limits.end() ? Limit{} : of_effect->second;
}

/// How far a grid point is from the effect's own shape, and that shape; what no catalogue names stays as it is.
std::pair<double, Eigen::VectorXd> FromOwn(const Family& family, int grid_point, const Values& parameters) {
  Eigen::VectorXd shape = family.ShapeAt(grid_point);
  double distance = 0.0;
  for (std::size_t k = 0; k < family.shapes.size(); ++k) {
    const std::string& name = family.shapes[k].name;
    const auto own = parameters.find(name == "crossed_over" ? "width" : name);  // a gap is crossed over its width
    if (own == parameters.end()) continue;
    double& value = shape[static_cast<Eigen::Index>(k)];
    distance += std::abs(value - own->second) / (std::abs(own->second) + 1e-6);
    value = own->second;
  }
  return {distance, shape};
}

struct Match {
  const Family* family = nullptr;
  test::Fit own;
  Eigen::VectorXd own_shape;
  double left_at_grid = Amplitude::kInfinity;
};

Match MatchOf(const Family& family, const Values& parameters, const LinearRun& run) {
  double nearest = Amplitude::kInfinity;
  for (int g = 0; g < family.grid; ++g) nearest = std::min(nearest, FromOwn(family, g, parameters).first);
  Match best{&family, {}, {}};
  for (int g = 0; g < family.grid; ++g) {
    const auto [distance, shape] = FromOwn(family, g, parameters);
    if (distance > 2.0 * nearest + 1e-9) continue;
    const test::Fit grid = test::FitAt(family, g, run), own = family.at ? test::FitOf(family.at(shape), run) : grid;
    best.left_at_grid = std::min(best.left_at_grid, grid.left);
    if (own.left < best.own.left) best.own = own, best.own_shape = shape;
  }
  return best;
}

void ExpectParameters(const Match& match, const Values& truth, double within) {
  const Eigen::VectorXd& x = match.own.amplitudes;
  std::vector<ParameterEstimate> found;
  for (Eigen::Index j = 0; j < x.size(); ++j)
    found.push_back({match.family->amplitudes[static_cast<std::size_t>(j)].name, "", 1.0, x[j], 0.0});
  if (match.family->parameters)
    found = match.family->parameters(match.own_shape, x, Eigen::MatrixXd::Identity(x.size(), x.size()));
  for (const ParameterEstimate& p : found) {
    if (!truth.contains(p.name) || p.name == "crossed_over") continue;
    const double off = p.value - truth.at(p.name),
                 error = p.name == "phase" ? std::remainder(off, units::turn) : off;
    EXPECT_LE(std::abs(error), within * std::max(std::abs(truth.at(p.name)), 1e-6)) << p.name << " " << p.value;
  }
}

TEST(NamedFamilies, AreWhatTheTwinShowsOfTheirEffectsNearlySoOnTheirGrids) {
  for (const Slope& slope : Slopes()) {
    const auto& [design, effect] = slope;
    SCOPED_TRACE(fmt::format("{} {} {}", design->name, effect.name, effect.where));
    const Scenario stated = ScenarioOf(*design);
    Scenario actual = stated;
    actual.effects = {effect};
    // Candidates are made of readings that have the effect in them.
    const Candidates candidates = CandidatesOf(stated, ReadingsOf(actual));
    Match best;
    for (const Family& family : candidates.families) {
      if (family.kind != Kind::kNamed || family.effect != effect.name || family.where != effect.where) continue;
      const Match match = MatchOf(family, effect.parameters, candidates.run);
      if (match.own.left < best.own.left) best = match;
    }
    ASSERT_NE(best.family, nullptr);
    const Limit limit = LimitOf(slope);
    EXPECT_LT(best.own.left, limit.own);
    EXPECT_LT(best.left_at_grid, std::max(limit.own, limit.grid));
    ExpectParameters(best, effect.parameters, std::min(limit.own, 0.02));
  }
}

TEST(NamedFamilies, AreAllOfTheCatalogueThatTheRunCanShowWithGroupsOfTheirEffectsAndPriors) {
  for (const Design& design : Designs()) {
    std::set<std::string> named, expected;
    for (const EffectEntry& entry : EffectCatalogue(kEncoderBench)) {
      if (!design.without.contains(entry.name)) expected.insert(entry.name);
    }
    for (const Family& family : CleanOf(design).families) {
      if (family.kind != Kind::kNamed) continue;
      named.insert(family.effect);
      EXPECT_EQ(family.group, family.effect);
      for (const Amplitude& a : family.amplitudes) EXPECT_GT(a.prior_sd, 0.0) << family.effect;
      for (const Shape& s : family.shapes) EXPECT_EQ(std::ssize(s.value), family.grid) << family.effect;
    }
    EXPECT_EQ(named, expected) << design.name;
  }
}

Strings UnknownOf(const Candidates& candidates) {
  Strings names;
  for (const Family& family : candidates.families) {
    if (family.kind == Kind::kUnknown) names.push_back(family.effect + " on " + family.where);
  }
  return names;
}

TEST(UnknownFamilies, AreTheSameWhateverIsStruckWhichIsGone) {
  const Strings struck = {"backlash", "slip", "drift", "scale", "latency", "tone"};
  for (const Design& design : Designs()) {
    const Scenario scenario = ScenarioOf(design);
    const Candidates left = CandidatesOf(scenario, ReadingsOf(scenario), struck);
    EXPECT_EQ(UnknownOf(left), UnknownOf(CleanOf(design))) << design.name;
    EXPECT_GT(UnknownOf(left).size(), 5u) << design.name;
    for (const Family& family : left.families)
      EXPECT_TRUE(family.kind == Kind::kUnknown || !std::ranges::count(struck, family.effect)) << family.effect;
  }
}

}  // namespace
}  // namespace twinbench::diagnose::slopes
