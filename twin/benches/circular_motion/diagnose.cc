#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <utility>

#include "twin/benches/circular_motion/analysis.h"
#include "twin/benches/circular_motion/bench.h"
#include "twin/benches/circular_motion/columns.h"
#include "twin/benches/circular_motion/settings.h"
#include "twin/benches/circular_motion/twin/factory.h"
#include "twin/core/errors.h"
#include "twin/core/reading_clock.h"
#include "twin/diagnose/part_of_readings.h"
#include "twin/diagnose/products.h"

namespace twinbench::benches::circular {
namespace {

Eigen::VectorXd Shown_m(const Reading& r) {
  const Deviation deviation = DeviationOf(r);
  return Eigen::Vector2d(deviation.radial_m, deviation.tangential_m);
}

bool HasAngles(const std::vector<Reading>& readings) {
  return std::ranges::any_of(readings, [](const Reading& r) { return std::isfinite(DeviationOf(r).tangential_m); });
}

BenchFormat MadeOfRadii() {
  BenchFormat f = Format();
  f.channels = f.points = {f.channels.front()};
  std::erase_if(f.effects, [](const EffectEntry& e) {
    return e.name == "ball_form" || e.name == "bar_gain" || e.name == "bar_nonlinearity" || e.name == "servo_lag";
  });
  constexpr double kLongestSpike_s = 1.0;  // one as long as the way to the next reversal would be backlash and more
  for (EffectEntry& e : f.effects) {
    for (EffectParameter& p : e.parameters) {
      if (e.name == "reversal_spike" && p.name == "time") p.upper_SI = kLongestSpike_s;
    }
  }
  return f;
}

/// What one way round, one feed and one plane leave open.
std::vector<std::string> LeftOpen(const std::vector<Reading>& readings) {
  std::vector<std::string> open = {
      "the radius alone does not separate mean scale of both axes from the bar's length, squareness, scales and straightness from form of the balls and gain of the "
      "bar (taken as the scenario states them), nor lag that both axes share; one plane shows nothing of the third axis"};
  std::set<int> directions;
  std::set<double> feeds_m_s;
  for (const Reading& r : readings) {
    directions.insert(r.direction);
    feeds_m_s.insert(kFeed_m_s(r));
  }
  if (directions.size() < 2) open.push_back("one way round does not separate squareness from servo mismatch: measure the other way round too");
  if (feeds_m_s.size() < 2) open.push_back("one feed does not separate what goes with speed from what does not: measure at another feed too");
  return open;
}

/// The bench where its readings show the radius alone. Gain and balls are the instrument's, which users have certified, and
/// no shape of their own; lag of both axes alike turns the circle, and what little a radius has of it by its square is anything small.
const BenchFormat& OfRadii() {
  static const BenchFormat format = MadeOfRadii();
  return format;
}

/// The twin's radius alone.
class FollowRadii : public model::Follow {
 public:
  explicit FollowRadii(std::unique_ptr<model::Follow> whole) : whole_(std::move(whole)) {}
  const std::vector<model::Point>& Points() const override { return whole_->Points(); }
  Eigen::Index Readings() const override { return whole_->Readings(); }
  Eigen::MatrixXd Predict(const std::vector<model::Disturbance>& at) const override { return whole_->Predict(at).leftCols(1); }
  std::vector<std::string> Unfixed() const override { return whole_->Unfixed(); }

 private:
  std::unique_ptr<model::Follow> whole_;
};

Eigen::VectorXd Noise_m(const Scenario& scenario, const Reading& r) {
  const StatedNoise noise = StatedNoiseOf(CircularOf(scenario), IsOfBar(r), Radius_m(r));
  return Eigen::Vector2d(noise.radial_m, noise.tangential_m);
}

/// Slopes of the twin at the spindle's place: what has a shape on a fine grid need not be asked point by point.
std::vector<diagnose::TwinComparison::Product> ProductsOf(const Scenario& scenario) {
  constexpr double kShortest_m = 2.0 * units::mm, kLongest_m = 40.0 * units::mm;  // of screws and scales
  std::vector<diagnose::TwinComparison::Product> products;
  for (const std::string axis : {"x", "y"}) {
    const Quantity& commanded_m = axis == "x" ? kCommandedX_m : kCommandedY_m;
    products.push_back(diagnose::WaveAlong("cyclic", axis, axis, "pitch", commanded_m, kShortest_m, kLongest_m));
    products.push_back(diagnose::SlipAt(axis, axis));
    products.push_back(
        diagnose::FollowsTemperature("drift", axis, axis, "drift", scenario.environment.reference_degC));
  }
  return products;
}

diagnose::TwinComparison Comparison(const Scenario& scenario) {
  diagnose::TwinComparison comparison;
  comparison.format = &Format();
  comparison.follow = FollowOften();
  comparison.together = true;
  comparison.unit = "um";
  comparison.to_SI = units::um;
  comparison.free_points = {"offset_x", "offset_y", "rotation", "length"};
  comparison.angles = {{"commanded", &Reading::target_rad}};
  comparison.plausible = 0.5 * units::um;
  comparison.shown = Shown_m;
  comparison.noise_of = Noise_m;
  comparison.products = ProductsOf(scenario);
  comparison.tones = {{"", Eigen::Vector2d(1.0, 0.0)}};
  return comparison;
}

/// Readings that come so soon behind a reversal that the play is still being taken up, by the play that fits: there a reading is not
/// in proportion to it, and a diagnosis takes every cause for proportional to its size.
std::set<int> TakingUpPlay(const std::vector<Reading>& readings, const Scenario& scenario) {
  constexpr double kBeyond = 1.2;
  std::set<int> numbers;
  std::vector<ErrorValue> errors;
  try {
    errors = ErrorsOf(Analyse(scenario, readings, Estimator::kRigorous).fit);
  } catch (const InputError&) {
    return numbers;  // too few to fit, and too few for any play to be named
  }
  for (const auto& [key, quarters] : {std::pair{"machine.backlash_x_um", 0}, {"machine.backlash_y_um", 1}}) {
    const auto play = std::ranges::find(errors, key, &ErrorValue::key);
    if (play == errors.end() || !(std::abs(play->value) > 2.0 * play->u)) continue;
    for (const Reading& r : readings) {
      const double along_rad = std::remainder(r.direction * (r.target_rad - 0.5 * units::kPi * quarters), units::kPi);
      const double since_m = Radius_m(r) * (1.0 - std::cos(along_rad < 0.0 ? along_rad + units::kPi : along_rad));
      if (since_m < kBeyond * std::abs(play->value) * units::um) numbers.insert(r.reading);
    }
  }
  return numbers;
}

bool AreSame(const std::vector<Reading>& a, const std::vector<Reading>& b) {
  const auto is_same = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
  return std::ranges::equal(a, b, [&](const Reading& x, const Reading& y) {
    return x.reading == y.reading && is_same(x.target_rad, y.target_rad) &&
           std::ranges::equal(x.quantities, y.quantities, [&](const auto& p, const auto& q) { return p.first == q.first && is_same(p.second, q.second); });
  });
}

/// An investigation compares the readings of its few runs with hundreds of causes, which the estimator does not look at: it is
/// asked once of each.
std::set<int> TakingUpPlayAskedOnce(const std::vector<Reading>& readings, const Scenario& scenario) {
  constexpr std::size_t kMost = 16;
  struct Asked {
    std::vector<Reading> readings;
    std::string scenario;
    std::set<int> numbers;
  };
  thread_local std::vector<Asked> asked;
  Scenario known = scenario;
  known.effects.clear();
  const std::string text = WriteScenario(known);
  const auto found = std::ranges::find_if(asked, [&](const Asked& a) { return a.scenario == text && AreSame(a.readings, readings); });
  if (found != asked.end()) return found->numbers;
  if (asked.size() == kMost) asked.erase(asked.begin());
  asked.push_back({readings, text, TakingUpPlay(readings, known)});
  return asked.back().numbers;
}

/// Of the radius alone: what turns the circle is not free, for it is not seen. Waves of order 1 are the centre, of order 2
/// squareness and scales, of order 3 straightness.
diagnose::TwinComparison OfRadiiAlone(diagnose::TwinComparison comparison, const std::vector<Reading>& readings) {
  comparison.format = &OfRadii();
  comparison.angles.front().lowest_order = 4;
  comparison.follow = [whole = comparison.follow](const Scenario& believed, const std::vector<Reading>& record) {
    return std::make_unique<FollowRadii>(whole(believed, record));
  };
  comparison.free_points = {"offset_x", "offset_y", "length"};
  comparison.shown = [whole = comparison.shown](const Reading& r) { return Eigen::VectorXd(whole(r).head(1)); };
  comparison.noise_of = [](const Scenario& stated, const Reading& r) { return Eigen::VectorXd(Noise_m(stated, r).head(1)); };
  comparison.tones.clear();
  if (HasClock(readings)) comparison.tones = {{"", Eigen::VectorXd::Ones(1)}};
  return comparison;
}

bool AreDrives(const Scenario& scenario) {
  return std::ranges::all_of(CircularOf(scenario).procedure.setups, &CircularSetup::IsDrive);
}

diagnose::TwinComparison Comparison(const Scenario& scenario, const std::vector<Reading>& readings) {
  diagnose::TwinComparison comparison = Comparison(scenario);
  comparison.shown = [left_out = TakingUpPlayAskedOnce(readings, scenario)](const Reading& r) {
    return left_out.contains(r.reading) ? Eigen::VectorXd::Constant(2, kNaN) : Shown_m(r);
  };
  if (AreDrives(scenario)) comparison.free_points = {"offset_x", "offset_y"};  // nothing is mounted: what turns the circle is a lag or a squareness
  return HasAngles(readings) ? comparison : OfRadiiAlone(std::move(comparison), readings);
}

/// As drives lag by their own readings.
Scenario WithKindOfLag(Scenario scenario, const std::vector<Reading>& readings, std::vector<std::string>& notes) {
  if (!AreDrives(scenario)) return scenario;
  std::string kind;
  try {
    kind = Analyse(scenario, readings, Estimator::kRigorous).lag_kind;
  } catch (const InputError&) {
    return scenario;  // too few to fit
  }
  if (kind == "ambiguous")
    notes.push_back("at one feed a lag of first order and a fixed delay are indistinguishable: scales hold for " +
                    std::string(CircularOf(scenario).machine.lag_kind == "first_order" ? "the first" : "the second") + "; measure at another feed too");
  else if (!kind.empty())
    CircularOf(scenario).machine.lag_kind = kind;
  return scenario;
}

constexpr std::size_t kManyReadings = 4500;

/// Reading numbers at which an axis turns round.
std::vector<double> ReversalsIn(const std::vector<Reading>& with_angles) {
  const auto quadrant = [](const Reading& r) { return std::floor(r.target_rad / (0.5 * units::kPi)); };
  std::vector<double> numbers;
  for (std::size_t i = 1; i < with_angles.size(); ++i) {
    const Reading &before = with_angles[i - 1], &r = with_angles[i];
    if (before.setup == r.setup && before.pass == r.pass && quadrant(before) != quadrant(r)) numbers.push_back(r.reading);
  }
  return numbers;
}

/// Of a controller's log of many readings those that a search needs: what axes do where they turn round is over in a few of them.
std::vector<Reading> LookedAt(std::vector<Reading> with_angles) {
  constexpr std::size_t kEnough = 1500, kAbout = 8;
  if (with_angles.size() <= kManyReadings) return with_angles;
  std::vector<double> reversals = ReversalsIn(with_angles);
  for (; 2 * kAbout * reversals.size() > kEnough; reversals.resize((reversals.size() + 1) / 2))
    for (std::size_t i = 1; 2 * i < reversals.size(); ++i) reversals[i] = reversals[2 * i];
  return diagnose::PartOf(with_angles, {std::move(reversals), kEnough, kAbout});
}

}  // namespace

diagnose::DiagnosisRun Diagnose(const std::vector<Reading>& readings, const Scenario& scenario,
                                const diagnose::DiagnoseOptions& options) {
  const std::vector<Reading> looked_at = LookedAt(WithAngles(readings));
  std::vector<std::string> notes;
  const Scenario believed = WithKindOfLag(scenario, looked_at, notes);
  diagnose::DiagnosisRun found = diagnose::DiagnoseByTwin(looked_at, believed, options, Comparison(believed, looked_at));
  std::ranges::move(notes, std::back_inserter(found.diagnosis.notes));
  if (!HasAngles(looked_at)) std::ranges::move(LeftOpen(looked_at), std::back_inserter(found.diagnosis.notes));
  if (looked_at.size() < readings.size())
    found.diagnosis.notes.push_back(fmt::format("{} of {} readings were looked at, in groups of neighbours and where axes turn round",
                                                looked_at.size(), readings.size()));
  return found;
}

diagnose::LinearRun Linear(const std::vector<Reading>& readings, const Scenario& scenario, Estimator) {
  const std::vector<Reading> looked_at = LookedAt(WithAngles(readings));
  return diagnose::CompareWithTwin(looked_at, scenario, Comparison(scenario, looked_at));
}

}  // namespace twinbench::benches::circular
