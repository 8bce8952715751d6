#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "twin/benches/hob_transmission/bench.h"
#include "twin/benches/hob_transmission/settings.h"
#include "twin/benches/hob_transmission/told_orders.h"
#include "twin/benches/hob_transmission/twin/factory.h"
#include "twin/core/errors.h"
#include "twin/core/reading_clock.h"
#include "twin/core/units.h"
#include "twin/diagnose/by_twin.h"
#include "twin/diagnose/tuning.h"
#include "twin/model/signals.h"

namespace twinbench::benches::hob {
namespace {

using diagnose::TwinComparison;
using AngleOf = std::function<double(const Reading&)>;

/// Of the table's rotation and of the hob's, as their encoders show them.
struct Angles {
  AngleOf table_rad;  // counted from the table's origin
  AngleOf ring_rad;   // the same from the reading head: the table ring's own angle
  AngleOf hob_rad;
};

Angles AnglesOf(const Scenario& scenario) {
  const bool from_origin = HobOf(scenario).hob_procedure.encoder_zero == "table_origin";
  return {[from_origin](const Reading& r) { return r.measured_rad + (from_origin ? 0.0 : r.head_rad); },
          [from_origin](const Reading& r) { return r.measured_rad - (from_origin ? r.head_rad : 0.0); },
          [](const Reading& r) { return r.reference_rad; }};
}

Eigen::VectorXd OfEach(const std::vector<Reading>& readings, const AngleOf& rad) {
  Eigen::VectorXd values(std::ssize(readings));
  for (std::size_t i = 0; i < readings.size(); ++i) values[static_cast<Eigen::Index>(i)] = rad(readings[i]);
  return values;
}

/// Stops of the interferometer are no samples of a turn.
bool IsSample(const Reading& r) {
  return r.velocity_rad_s != 0.0 && std::isfinite(r.measured_rad) && std::isfinite(r.reference_rad);
}

/// Whether the interferometer saw the table in motion, often enough to be worth a channel.
bool IsWatched(const std::vector<Reading>& readings, const Scenario& scenario) {
  constexpr double kWatched = 0.9;  // of the samples
  const InterferometerSettings& i = HobOf(scenario).interferometer;
  const auto seen = [](const Reading& r) { return IsSample(r) && std::isfinite(r.interferometer_rad); };
  return i.used && !i.IsReadAtRest() &&
         static_cast<double>(std::ranges::count_if(readings, seen)) >
             kWatched * static_cast<double>(std::ranges::count_if(readings, IsSample));
}

/// Of one sample of table - ratio x hob; 0 if no encoder states its noise.
double EncoderNoise_rad(const HobSettings& own) {
  const double ratio = own.transmission.Ratio();
  const double noise_rad = std::hypot(own.table_encoder.noise_rad, ratio * own.hob_encoder.noise_rad);
  if (noise_rad == 0.0) return 0.0;
  const double step_rad =
      units::turn / (static_cast<double>(own.hob_encoder.lines) * own.hob_encoder.interpolation);
  return std::hypot(noise_rad, ratio * step_rad / std::sqrt(12.0));
}

/// The table's angle as its encoder shows it is off by the encoder's error; as the hob drives it, it is that by
/// which gears err.
Eigen::VectorXd DrivenTable_rad(const std::vector<Reading>& readings, const Angles& angles, double ratio) {
  const Eigen::VectorXd driven_rad = ratio * OfEach(readings, angles.hob_rad);
  const Eigen::MatrixXd setups = model::Indicators(model::CourseOf(readings).setup);
  const Eigen::VectorXd m_rad = OfEach(readings, angles.table_rad) - driven_rad;
  const Eigen::VectorXd mean_rad = (setups.transpose() * m_rad).cwiseQuotient(setups.colwise().sum().transpose());
  return driven_rad + setups * mean_rad;
}

/// The transmission's error of orders that an evaluation takes as unknown, by turns of the table.
std::vector<TwinComparison::FreeCourses> FreeOrders(const TransmissionSettings& train, const Angles& angles) {
  std::vector<TwinComparison::FreeCourses> free;
  for (int k = 1; k <= train.free_orders; ++k) {
    const auto wave = [k, angles, ratio = train.Ratio()](const std::vector<Reading>& readings) {
      return model::Wave(k * DrivenTable_rad(readings, angles, ratio));
    };
    free.push_back({"transmission", wave, fmt::format("order {}", k)});
  }
  return free;
}

/// Errors of the table are large for the hob, by the gearbox's ratio: they bend its waves, and by which of the two angles a
/// wave is a pure one no drive and no ring is good enough to tell.
diagnose::BentWaves BentWavesOf(const std::vector<Reading>& readings, const Angles& angles, double ratio) {
  constexpr double kOne = 0.99;
  constexpr int kOrder = 2;  // ellipticity: higher ones are small
  std::vector<Reading> samples;
  std::ranges::copy_if(readings, std::back_inserter(samples), IsSample);
  if (samples.empty()) return {};
  const Eigen::VectorXd error_rad = OfEach(samples, angles.table_rad) - DrivenTable_rad(samples, angles, ratio);
  const double hob_rad = std::sqrt(2.0) * model::Rms(error_rad) / std::abs(ratio);
  return {kOne, std::min(1.0 - kOne, std::pow(kOrder * hob_rad, 2))};
}

/// Travel of the table since its last reversal: before one it runs out over the way of a ramp, and comes back over
/// it.
Eigen::VectorXd Travel_rad(const std::vector<Reading>& readings, const AngleOf& table_rad, double ramp_s) {
  const Eigen::VectorXd at_rad = OfEach(readings, table_rad),
                        sense = model::HeldDirection(model::CourseOf(readings));
  const auto beyond_rad = [&](Eigen::Index i) {
    const double velocity_rad_s = readings[static_cast<std::size_t>(i)].velocity_rad_s;
    return std::isfinite(velocity_rad_s) ? 0.5 * ramp_s * std::abs(velocity_rad_s) : 0.0;
  };
  Eigen::VectorXd travel_rad = Eigen::VectorXd::Constant(at_rad.size(), beyond_rad(0));
  for (Eigen::Index i = 1; i < at_rad.size(); ++i) {
    const double way_rad = sense[i] * (at_rad[i] - at_rad[i - 1]);
    travel_rad[i] = sense[i] == sense[i - 1] ? travel_rad[i - 1] + std::max(way_rad, 0.0)
                                             : std::max(beyond_rad(i - 1) + way_rad, 0.0);
  }
  return travel_rad;
}

/// Most samples are taken together, but the lines of worm and mesh stay, and so do the folded ones of the hob's
/// signals as far as they can.
TwinComparison::Sampled SampledOf(const HobSettings& own, const Angles& angles) {
  constexpr double kLowOrders = 60.0;
  const double highest =
      std::max({own.transmission.WormOrder(), static_cast<double>(own.transmission.gear_teeth), kLowOrders});
  const auto times = [](double factor, const AngleOf& rad) {
    return [=](const std::vector<Reading>& readings) -> Eigen::VectorXd { return factor * OfEach(readings, rad); };
  };
  return {times(highest, angles.table_rad), times(2.0 * own.hob_encoder.lines, angles.hob_rad),
          [table_rad = angles.table_rad, ramp_s = own.hob_procedure.ramp_s](const std::vector<Reading>& readings) {
            return Travel_rad(readings, table_rad, ramp_s);
          }};
}

/// Errors of a ring's lines, by whole orders of its own angle: 1 and 2 have other names.
TwinComparison::Product LinesOf(const std::string& ring, const AngleOf& rad) {
  const auto orders = [rad](const std::vector<Reading>& readings) {
    const int last = model::HighestOrder(model::TypicalStep_rad(model::CourseOf(readings), OfEach(readings, rad)));
    std::vector<double> values;
    for (int k = 3; k <= std::max(last, 3); ++k) values.push_back(k);
    return values;
  };
  const auto wave = [rad](const std::vector<Reading>& readings, double order) {
    return model::Wave(order * OfEach(readings, rad));
  };
  return {"periodic", ring, ring + "_encoder", {"amplitude", "amplitude"}, "order", orders, wave, true, true};
}

/// An order alone names no cause.
std::string MeaningOf(int order, const TransmissionSettings& train) {
  const auto is = [order](double other) { return std::abs(order - other) < 1e-9; };
  if (order <= 2)
    return order == 1
               ? "once per turn: the table's drive, or its ring off centre; another place of ring and head tells"
               : "twice per turn: the table's drive, or its ring out of round or tilted; heads that are not "
                 "opposite to each other tell";
  if (is(train.HobOrder())) return "once per turn of the hob: its drive, or its encoder off centre";
  if (is(train.gear_teeth))
    return "once a tooth of the gear: the mesh, or the hob's encoder out of round or tilted";
  if (is(train.WormOrder())) return "once per turn of the table's worm";
  return "gears, screws or copying errors of this number, of the table or of its ring";
}

/// Low ones, and those of hob, mesh and worm where they are whole, ascending.
std::vector<TwinComparison::TabulatedOrder> OrdersOf(const TransmissionSettings& train) {
  constexpr int kLowOrders = 12;
  std::map<int, std::string> meanings;
  const auto add = [&](int order) { meanings[order] = MeaningOf(order, train); };
  for (int k = 1; k <= kLowOrders; ++k) add(k);
  for (const double k : {train.HobOrder(), static_cast<double>(train.gear_teeth), train.WormOrder()})
    if (k >= 1.0 && k == std::round(k)) add(static_cast<int>(k));
  std::vector<TwinComparison::TabulatedOrder> orders;
  for (const auto& [order, meaning] : meanings) orders.push_back({order, meaning});
  return orders;
}

/// With one or two heads and no interferometer, a ring that sits otherwise in another mounting looks the same.
double Listed(const std::string& effect, const std::string& where, bool is_doubled) {
  const bool is_of_ring = where == "table" && effect != "slip";
  return is_of_ring && is_doubled ? diagnose::tuning::kListedDoubled : diagnose::tuning::kListed;
}

int Heads(const std::vector<Reading>& readings) {
  return static_cast<int>(model::Indicators(model::CourseOf(readings).setup).cols());
}

/// What both encoders show against each other, and, where it was recorded, what the interferometer saw: it knows
/// the table's true motion, but nothing of the encoders.
void Compare(const std::vector<Reading>& readings, const Scenario& scenario, TwinComparison& comparison) {
  const HobSettings& own = HobOf(scenario);
  const double ratio = own.transmission.Ratio();
  const bool is_watched = IsWatched(readings, scenario);
  comparison.channels = {"transmission"};
  comparison.free_points = {"table_encoder"};
  if (is_watched) {
    comparison.channels.emplace_back("interferometer");
    comparison.free_points.emplace_back("interferometer");
  }
  const Eigen::Index channels = std::ssize(comparison.channels);
  comparison.is_used = IsSample;
  comparison.shown = [ratio, channels](const Reading& r) -> Eigen::VectorXd {
    return Eigen::Vector2d(r.measured_rad - ratio * r.reference_rad, r.interferometer_rad).head(channels);
  };
  comparison.show = [ratio](Reading& r, const Eigen::VectorXd& shown_rad) {
    r.reference_rad = (r.measured_rad - shown_rad[0]) / ratio;
  };
  comparison.noise_of = [channels](const Scenario& s, const Reading&) -> Eigen::VectorXd {
    return Eigen::Vector2d(EncoderNoise_rad(HobOf(s)), HobOf(s).interferometer.noise_rad).head(channels);
  };
  const auto on_encoders = [channels](double share) {
    return Eigen::MatrixXd(share * Eigen::VectorXd::Unit(channels, 0));
  };
  comparison.tones = {{"", Eigen::VectorXd::Ones(channels)}};
  comparison.steps = {{"table", on_encoders(1.0)}, {"hob", on_encoders(-ratio)}};
  comparison.listed = [is_doubled = !is_watched && Heads(readings) < 3](const std::string& effect,
                                                                        const std::string& where) {
    return Listed(effect, where, is_doubled);
  };
}

TwinComparison Comparison(const std::vector<Reading>& readings, const Scenario& scenario) {
  const TransmissionSettings& train = HobOf(scenario).transmission;
  const Angles angles = AnglesOf(scenario);
  TwinComparison comparison;
  comparison.format = &Format();
  comparison.follow = FollowRecord;
  comparison.unit = "arcsec";
  comparison.to_SI = units::arcsec;
  comparison.plausible = 0.3 * units::arcsec;
  comparison.sizes_by_trace = true;
  Compare(readings, scenario, comparison);
  comparison.free_courses = FreeOrders(train, angles);
  // Low orders of the table are free as far as nobody else sees them.
  const int first_unfree = comparison.channels.size() > 1 ? 1 : train.free_orders + 1;
  comparison.angles = {{"table", angles.table_rad, "", "harmonic", first_unfree},
                       {"", angles.ring_rad, "the table's ring and head", "ring harmonic", 1, false},
                       {"", angles.hob_rad, "hob angle", "hob harmonic", 1, false}};
  comparison.products = {LinesOf("table", angles.ring_rad), LinesOf("hob", angles.hob_rad)};
  comparison.is_alike_on_all = true;
  comparison.shows_errors = true;
  comparison.remounting_ends_tones = true;
  comparison.sampled = SampledOf(HobOf(scenario), angles);
  comparison.orders = OrdersOf(train);
  comparison.named = {{"ring harmonic", ""}, {"hob harmonic", ""}, {"direction offset", ""}, {"transition", ""},
                      {"speed", ""},         {"trend", ""}, {"slope", ""},        {"step", "slip"},         {"tone", "tone"}};
  comparison.most_causes = 6;
  if (!HasClock(readings)) comparison.unrecorded = {"latency"};
  comparison.bends = true;
  comparison.bent = BentWavesOf(readings, angles, train.Ratio());
  comparison.next_measurement = NextMeasurement;
  return comparison;
}

void RequireHeads(const std::vector<Reading>& readings) {
  for (const Reading& r : readings) {
    if (r.status == ReadingStatus::kOk && IsSample(r) && !std::isfinite(r.head_rad))
      throw InputError("readings", fmt::format("reading {} has no head angle", r.reading),
                       "head_deg in every mounting");
  }
}

}  // namespace

diagnose::DiagnosisRun Diagnose(const std::vector<Reading>& readings, const Scenario& scenario,
                                const diagnose::DiagnoseOptions& options) {
  RequireHeads(readings);
  diagnose::DiagnosisRun result = diagnose::DiagnoseByTwin(readings, scenario, options, Comparison(readings, scenario));
  DoubtOrdersOfRounding(readings, result.run, HobOf(scenario).transmission.HobOrder(), result.diagnosis);
  if (!IsWatched(readings, scenario)) TellGearsBesideRing(result.diagnosis);
  if (!HasClock(readings)) return result;
  std::vector<Reading> samples;
  std::ranges::copy_if(readings, std::back_inserter(samples), IsSample);
  TellOrdersOfTones(samples, scenario, result.diagnosis);
  return result;
}

diagnose::LinearRun Linear(const std::vector<Reading>& readings, const Scenario& scenario, Estimator) {
  RequireHeads(readings);
  return diagnose::CompareWithTwin(readings, scenario, Comparison(readings, scenario));
}

}  // namespace twinbench::benches::hob
