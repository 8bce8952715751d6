#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/benches/registry.h"
#include "twin/core/effect_entries.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/run_record.h"
#include "twin/core/schema_table.h"
#include "twin/core/stream.h"
#include "twin/diagnose/by_twin.h"
#include "twin/model/product.h"
#include "twin/report/evaluation.h"
#include "twin/sim/empirical_signal.h"
#include "twin/sim/pointwise_follow.h"

// A bench that this program does not ship: one length gauge against a shaft that turns by hand. It shows what a
// bench has to bring along, and that nothing else has to change for it.
namespace twinbench {
namespace {

using units::um;

struct RunoutSettings {
  double x_m = 5.0 * um, y_m = 0.0;  // [shaft] of its centre from the axis, at angle 0
  double noise_m = 0.1 * um;         // [gauge] of one reading, standard deviation
  int stops = 36;                    // [runout_procedure] a turn
  std::vector<int> passes = {1, -1, 1, -1};
  double interval_s = 5.0;
};
RunoutSettings& RunoutOf(Scenario& s) {
  return s.own.As<RunoutSettings>();
}
const RunoutSettings& RunoutOf(const Scenario& s) {
  return s.own.As<RunoutSettings>();
}

const Quantity kGauge_m{"gauge_um"};  // what a reading shows

void AddKeys(schema::Keys& keys, Scenario& scenario) {
  using namespace schema;
  RunoutSettings& s = RunoutOf(scenario);
  Table shaft(keys, "shaft"), gauge(keys, "gauge"), procedure(keys, "runout_procedure");
  shaft.Add("x", kUm, Within(1000), &s.x_m, "its centre from the axis along the gauge, at angle 0");
  shaft.Add("y", kUm, Within(1000), &s.y_m, "likewise a quarter of a turn on");
  gauge.Add("noise", kUm, UpTo(100), &s.noise_m, "of one reading, standard deviation");
  procedure.Add("stops_per_turn", kPure, {3, 10000}, &s.stops, "evenly spaced");
  procedure.Add("passes", kPure, {-1, 1}, &s.passes, "directions: 1 or -1");
  procedure.Add("interval", kSecond, Positive(3600), &s.interval_s, "between readings");
}

std::vector<EffectEntry> Effects() {
  return {{"off_centre",
           "the shaft is not clamped where the scenario says",
           {},
           {Signed("x", "um", 1.0, 1000.0, "along the gauge at angle 0"),
            Signed("y", "um", 1.0, 1000.0, "a quarter of a turn on")}},
          {"warm_up",
           "the gauge grows while it warms up",
           {},
           {Signed("size", "um", 1.0, 1000.0, "in the end"),
            Parameter("time_constant", "s", 200.0, 1.0, 1e5, "of the exponential")}},
          {"reversal", "the gauge's tip gives way", {}, {Signed("width", "um", 1.0, 100.0, "between directions")}}};
}

const BenchFormat& Format() {
  static const BenchFormat format = [] {
    BenchFormat f;
    f.name = "runout";
    f.title = "a length gauge against a turning shaft";
    f.add_keys = AddKeys;
    f.columns = Joined(
        {CommonColumns(false),
         {NumberColumn(
              "shaft_deg", units::deg, ColumnRole::kRequired, [](auto& r) -> auto& { return r.reference_rad; }),
          ShownColumn("gauge_um", um, "um", kGauge_m)}});
    f.smallest_addition = [](int) { return std::string("a second pass"); };
    f.effects = Effects();
    f.channels = f.points = {"gauge"};
    f.angles = {"shaft"};
    f.signal = SignalKind::kPosition;
    return f;
  }();
  return format;
}

std::vector<Reading> Schedule(const Scenario& scenario) {
  const RunoutSettings& s = RunoutOf(scenario);
  std::vector<Reading> readings;
  for (std::size_t pass = 0; pass < s.passes.size(); ++pass) {
    for (int k = 0; k < s.stops; ++k) {
      Reading& r = readings.emplace_back();
      r.reading = static_cast<int>(readings.size()) - 1;
      r.time = Time(FromSeconds(r.reading * s.interval_s));
      r.pass = static_cast<int>(pass);
      r.direction = s.passes[pass];
      r.position = r.direction > 0 ? k : s.stops - 1 - k;
      r.reference_rad = r.position * units::turn / s.stops;
    }
  }
  return readings;
}

double ShownByEffect_m(const EffectSettings& effect, const Reading& r, double shown_m) {
  const auto of = [&](const char* parameter) { return effect.parameters.at(parameter); };
  if (effect.name == "off_centre") return of("x") * std::cos(r.reference_rad) + of("y") * std::sin(r.reference_rad);
  if (effect.name == "warm_up") return of("size") * -std::expm1(-ToSeconds(r.time) / of("time_constant"));
  if (effect.name == "reversal") return 0.5 * r.direction * of("width");
  const model::Instant now{.time_s = ToSeconds(r.time),
                           .reading = r.reading,
                           .direction = static_cast<double>(r.direction),
                           .angle_rad = {r.reference_rad, 0.0}};
  return model::Product(effect, Format()).At(now, std::array{shown_m});
}

/// Without noise.
double Shown_m(const Scenario& scenario, const Reading& r) {
  const RunoutSettings& s = RunoutOf(scenario);
  const double centred_m = s.x_m * std::cos(r.reference_rad) + s.y_m * std::sin(r.reference_rad);
  double shown_m = centred_m + sim::EmpiricalSignal(scenario.empiricals, "gauge").At(r.reading, ToSeconds(r.time));
  for (const EffectSettings& effect : scenario.effects) shown_m += ShownByEffect_m(effect, r, centred_m);
  return shown_m;
}

class Twin : public BenchTwin {
 public:
  explicit Twin(const Scenario& scenario) : scenario_(scenario) {}

  nlohmann::json Truth() const override {
    return {{"x_um", RunoutOf(scenario_).x_m / um}, {"y_um", RunoutOf(scenario_).y_m / um}};
  }

  void CarryOut(ReadingSink& sink, const std::function<void(const procedure::Progress&)>&, RunLog*) override {
    Stream noise(scenario_.seed, "gauge.noise");
    std::vector<Reading> readings = Schedule(scenario_);
    for (Reading& r : readings) {
      kGauge_m(r) = Shown_m(scenario_, r);
      if (!scenario_.noise_free) kGauge_m(r) += RunoutOf(scenario_).noise_m * noise.Normal();
    }
    sink.AppendAll(readings);
  }

 private:
  Scenario scenario_;
};

const std::vector<sim::BenchPoint<double>> kPoints = {
    {{"gauge", "um", um, 0.1 * um}, [](double& extra_m) -> double& { return extra_m; }}};

class Follow : public sim::PointwiseFollow<double> {
 public:
  Follow(const Scenario& stated, const std::vector<Reading>& record)
      : PointwiseFollow(sim::Foreseeable(stated, record), record, kPoints) {}

 protected:
  Eigen::MatrixXd Shown(const std::vector<double>& extra_m) const override {
    Eigen::MatrixXd shown_m(Readings(), 1);
    for (std::size_t i = 0; i < extra_m.size(); ++i)
      shown_m(static_cast<Eigen::Index>(i), 0) = Shown_m(scenario(), record()[i]) + extra_m[i];
    return shown_m;
  }
  std::unique_ptr<model::Follow> On(const Scenario& changed) const override {
    return std::make_unique<Follow>(changed, record());
  }
};

std::unique_ptr<model::Follow> FollowRecord(const Scenario& scenario, const std::vector<Reading>& record) {
  return std::make_unique<Follow>(scenario, record);
}

/// Zero, x and y of the shaft's centre by least squares, SI.
Eigen::Vector3d Fit(std::vector<Reading> readings) {
  std::erase_if(readings, [](const Reading& r) { return r.status != ReadingStatus::kOk; });
  Eigen::MatrixXd columns(std::ssize(readings), 3);
  Eigen::VectorXd shown_m(std::ssize(readings));
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const double angle_rad = readings[i].reference_rad;
    columns.row(static_cast<Eigen::Index>(i)) << 1.0, std::cos(angle_rad), std::sin(angle_rad);
    shown_m[static_cast<Eigen::Index>(i)] = kGauge_m(readings[i]);
  }
  return SolveLeastSquares(columns, shown_m);
}

report::Evaluation Evaluate(const Scenario&, const std::vector<Reading>& readings, Estimator) {
  const Eigen::Vector3d fit = Fit(readings);
  const nlohmann::json centre = {{"x_um", fit[1] / um}, {"y_um", fit[2] / um}};
  return {{{"shaft", centre}},
          centre,
          "",
          fmt::format("the shaft's centre is {:.3f} um, {:.3f} um from the axis\n", fit[1] / um, fit[2] / um)};
}

report::ScoredRun Score(const Scenario&, const std::vector<Reading>& readings, const nlohmann::json& truth,
                        Estimator) {
  const Eigen::Vector3d fit = Fit(readings);
  const double error_um =
      std::hypot(fit[1] / um - truth.at("x_um").get<double>(), fit[2] / um - truth.at("y_um").get<double>());
  return {{{"error_um", error_um}}, fmt::format("off the truth by {:.3f} um\n", error_um), ""};
}

diagnose::TwinComparison Comparison(const Scenario& scenario) {
  return {.format = &Format(),
          .follow = FollowRecord,
          .unit = "um",
          .to_SI = um,
          .noise = RunoutOf(scenario).noise_m,
          .free_points = {"gauge"},
          .angles = {{"shaft", &Reading::reference_rad}},
          .plausible = um};
}

diagnose::DiagnosisRun Diagnose(const std::vector<Reading>& readings, const Scenario& scenario,
                                const diagnose::DiagnoseOptions& options) {
  return diagnose::DiagnoseByTwin(readings, scenario, options, Comparison(scenario));
}

}  // namespace

const std::vector<const BenchFormat*>& BenchFormats() {
  static const std::vector<const BenchFormat*> formats = {&Format()};
  return formats;  // constant
}

const std::vector<const Bench*>& Benches() {
  static const Bench bench{
      .format = &Format(),
      .make_twin = [](const Scenario& s) -> std::unique_ptr<BenchTwin> { return std::make_unique<Twin>(s); },
      .follow = FollowRecord,
      .planned_readings = [](const Scenario& s) { return static_cast<int>(Schedule(s).size()); },
      .evaluate = Evaluate,
      .score = Score,
      .diagnose = Diagnose,
      .linear_run = [](const std::vector<Reading>& readings, const Scenario& scenario, Estimator) {
        return diagnose::CompareWithTwin(readings, scenario, Comparison(scenario));
      }};
  static const std::vector<const Bench*> benches = {&bench};
  return benches;  // constant
}

}  // namespace twinbench
