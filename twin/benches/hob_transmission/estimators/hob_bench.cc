#include "twin/benches/hob_transmission/estimators/hob_bench.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "twin/benches/hob_transmission/estimators/hob_orders.h"
#include "twin/benches/hob_transmission/estimators/rounding_orders.h"
#include "twin/benches/hob_transmission/settings.h"
#include "twin/core/distributions.h"
#include "twin/core/rounding.h"

namespace twinbench::separate::hob {
namespace {

constexpr int kHighestOrder = 100;

TransmissionOptions OptionsOf(const Scenario& scenario) {
  TransmissionOptions options;
  options.table_turns_per_hob_turn = HobOf(scenario).transmission.Ratio();
  options.zero = HobOf(scenario).hob_procedure.encoder_zero == "table_origin" ? EncoderZero::kTableOrigin
                                                                              : EncoderZero::kReferenceMark;
  options.max_order =
      std::min(kHighestOrder, HobOf(scenario).hob_procedure.samples_per_turn / 2 - 1);  // with some to spare
  const RingEncoderSettings& hob = HobOf(scenario).hob_encoder;
  options.hob_step_rad = options.table_turns_per_hob_turn * units::turn / hob.lines / hob.interpolation;
  return options;
}

/// From sample to sample; NaN if nothing moves.
double UsualWay_rad(const std::vector<HobSample>& samples, double HobSample::*angle_rad) {
  std::vector<double> ways_rad;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (samples[i].setup == samples[i - 1].setup && samples[i].pass == samples[i - 1].pass)
      ways_rad.push_back(std::abs(samples[i].*angle_rad - samples[i - 1].*angle_rad));
  }
  std::erase_if(ways_rad, [](double way_rad) { return !(way_rad > 0.0); });
  return ways_rad.empty() ? kNaN : Median(std::move(ways_rad));
}

/// Of readings that are farther apart than the procedure's: so many orders as they still tell, regular or not.
int OrdersThatShow(const std::vector<HobSample>& samples, const TransmissionOptions& options) {
  constexpr double kOrdersASample = 0.4;
  const double way_rad = UsualWay_rad(samples, &HobSample::table_encoder_rad);
  if (!std::isfinite(way_rad)) return options.max_order;
  const double a_turn = units::turn / way_rad;
  if (a_turn > 2.0 * options.max_order) return options.max_order;
  return std::max(1, static_cast<int>(kOrdersASample * a_turn));
}

/// Of the hob's turn, those that the orders of the table's are not, as far as the samples tell them.
std::vector<int> HobOrdersBeside(const TransmissionSettings& t, const std::vector<HobSample>& samples, int highest) {
  constexpr int kMost = 4;
  constexpr double kWaysOfAPeriod = 2.5;
  const double way_rad = UsualWay_rad(samples, &HobSample::hob_encoder_rad);
  std::vector<int> orders;
  for (int k = 1; k <= kMost && kWaysOfAPeriod * k * way_rad < units::turn; ++k) {
    const double of_table = k * t.HobOrder();
    if (of_table != std::round(of_table) || of_table > highest) orders.push_back(k);
  }
  return orders;
}

bool HasTurns(const PositionError& position) {
  return position.status == PositionStatus::kOk;
}

std::optional<TwoPositions> Published(const std::vector<PositionError>& positions) {
  const std::vector<const PositionError*> two = FirstTwoOf(positions);
  if (two.empty()) return std::nullopt;
  return SeparateTwoPositions(*two[0], *two[1]);
}

/// Orders that mean something on this machine and that were fitted.
std::vector<int> OrdersToCompare(const TransmissionSettings& t, int highest) {
  std::vector<int> orders;
  for (const double order : {1.0, 2.0, t.HobOrder(), static_cast<double>(t.gear_teeth), t.WormOrder()}) {
    const bool whole = order == std::floor(order);
    const int k = static_cast<int>(order);
    if (whole && k >= 1 && k <= highest && std::ranges::find(orders, k) == orders.end()) orders.push_back(k);
  }
  return orders;
}

/// Of as many samples in every turn.
std::map<int, int> FoldedOrders(const TransmissionSettings& t, const std::vector<PositionError>& positions,
                                int highest) {
  std::map<int, int> folded;
  const PositionError& first = *std::ranges::find_if(positions, HasTurns);
  const int a_turn = first.samples / first.turns;
  for (const PositionError& p : positions)
    if (p.samples != p.turns * a_turn) return {};
  for (const double once : {t.HobOrder(), static_cast<double>(t.gear_teeth), t.WormOrder()}) {
    for (const double order : {once, 2.0 * once}) {
      const int seen = static_cast<int>(std::lround(std::abs(std::remainder(order, static_cast<double>(a_turn)))));
      if (order == std::floor(order) && order > highest && seen >= 1 && seen <= highest)
        folded.try_emplace(seen, static_cast<int>(order));
    }
  }
  return folded;
}

bool HasInterferometer(const std::vector<HobSample>& samples) {
  return std::ranges::any_of(samples, [](const HobSample& s) { return std::isfinite(s.interferometer_rad); });
}

bool IsAtRest(const HobSample& s) {
  return s.is_at_rest;
}

TransmissionOptions Uncounted(TransmissionOptions options) {
  options.hob_step_rad = 0.0;
  options.hob_orders.clear();
  return options;
}

/// Stops fold what repeats with hob and teeth onto other orders: only the lowest are the encoder's.
TransmissionOptions OptionsAtRest(TransmissionOptions options, const InterferometerSettings& interferometer) {
  constexpr int kHighestAtRest = 4;
  options.max_order = std::clamp((interferometer.stops - 1) / 3, 1, kHighestAtRest);
  return options;
}

HarmonicSeries WithCalibrator(HarmonicSeries series, double u_calibrator_rad) {
  for (Coefficient& order : series.orders)
    order.cov += u_calibrator_rad * u_calibrator_rad * Eigen::Matrix2d::Identity();
  return series;
}

/// Adds what the steps of both encoders repeat whenever a stop is read: the stops are the same in every turn. Where
/// an encoder stood between its steps, the other one and the interferometer say.
void AddRoundingAtStops(const std::vector<HobSample>& at_rest, const TransmissionOptions& options,
                        const RingEncoderSettings& ring, HobAnalysis& analysis) {
  Eigen::VectorXd th_rad(std::ssize(at_rest)), table_rad = th_rad, hob_rad = th_rad;
  Eigen::Index rows = 0;
  for (const HobSample& s : at_rest) {
    if (!std::isfinite(s.interferometer_rad)) continue;
    const double at_rad = RingAngle_rad(s, options.zero == EncoderZero::kTableOrigin);
    // What the ring errs there its heads have told.
    const double deviation_rad = s.interferometer_rad + ValueAt(analysis.encoder, at_rad);
    th_rad[rows] = at_rad;
    table_rad[rows] = options.table_turns_per_hob_turn * s.hob_encoder_rad + deviation_rad;
    hob_rad[rows++] = s.table_encoder_rad - deviation_rad;
  }
  const Eigen::MatrixXd of_table =
      RoundingWaves(table_rad.head(rows), units::turn / ring.lines / ring.interpolation, 0.0);
  const Eigen::MatrixXd of_hob = RoundingWaves(hob_rad.head(rows), options.hob_step_rad, 0.0);
  Eigen::MatrixXd waves(rows, of_table.cols() + of_hob.cols());
  waves << of_table, of_hob;
  analysis.encoder_rounding_rad2 = AddRounding(th_rad.head(rows), waves, analysis.encoder_by_interferometer);
}

/// Mean over the places of the head: those that noise would not show.
std::vector<HobOrder> HobOrdersOf(const std::vector<PositionError>& positions, int direction) {
  constexpr double kFalseAlarm = 0.01;
  std::vector<std::vector<HobOrder>> all;
  for (const PositionError& p : positions)
    if (p.direction == direction && HasTurns(p)) all.push_back(p.of_hob);
  std::vector<HobOrder> orders = MeanOf(all);
  const double chance = kFalseAlarm / static_cast<double>(std::max<std::size_t>(1, orders.size()));
  std::erase_if(orders, [chance](const HobOrder& o) { return !(ChanceOf(o.wave, o.dof) < chance); });
  return orders;
}

void AddDirections(const std::vector<HobSample>& samples, const TransmissionOptions& options,
                   const std::vector<int>& orders, HobAnalysis& analysis) {
  std::vector<PositionError>& seen = analysis.transmission_by_interferometer;
  if (HasInterferometer(samples)) seen = MeasurePositions(samples, Uncounted(options), Signal::kInterferometer);
  for (const int direction : analysis.separation->directions) {
    DirectionResult result;
    result.direction = direction;
    result.transmission = TransmissionSeries(*analysis.separation, direction);
    result.lines = FindLines(result.transmission);
    result.of_hob = HobOrdersOf(analysis.positions, direction);
    const HarmonicSeries reference = TransmissionByInterferometer(seen, direction);
    if (!reference.orders.empty())
      result.against_interferometer = CompareTransmission(*analysis.separation, direction, reference, orders);
    analysis.directions.push_back(result);
  }
}

void AddEncoder(const std::vector<HobSample>& samples, const TransmissionOptions& options,
                const std::vector<int>& orders, const HobSettings& own, HobAnalysis& analysis) {
  if (!HasInterferometer(samples)) return;
  const double u_calibrator_rad = own.interferometer.u_calibrator_rad;
  std::vector<PositionError> seen = MeasurePositions(samples, Uncounted(options), Signal::kEncodersMinusInterferometer);
  analysis.encoder_by_interferometer = WithCalibrator(EncoderByInterferometer(seen), u_calibrator_rad);
  if (analysis.is_interferometer_at_rest) AddRoundingAtStops(samples, options, own.table_encoder, analysis);
  analysis.by_interferometer = seen;
  analysis.encoder_against_interferometer =
      CompareEncoder(*analysis.separation, analysis.encoder_by_interferometer, orders);
  if (analysis.is_interferometer_at_rest) return;
  std::erase_if(seen, [first = samples.front().setup](const PositionError& p) { return p.setup != first; });
  analysis.encoder_by_one_place = WithCalibrator(EncoderByInterferometer(seen), u_calibrator_rad);
  analysis.by_one_place = std::move(seen);
  analysis.encoder_against_one_place = CompareEncoder(*analysis.separation, analysis.encoder_by_one_place, orders);
}

}  // namespace

std::vector<const PositionError*> FirstTwoOf(const std::vector<PositionError>& positions) {
  for (const int direction : {1, -1}) {
    std::vector<const PositionError*> found;
    for (const PositionError& position : positions) {
      if (position.direction == direction && HasTurns(position)) found.push_back(&position);
    }
    if (found.size() >= 2) return {found[0], found[1]};
  }
  return {};
}

std::vector<HobSample> SamplesOf(const std::vector<Reading>& readings) {
  std::vector<HobSample> samples;
  for (const Reading& r : readings) {
    if (r.status != ReadingStatus::kOk || r.direction == 0) continue;
    samples.push_back({r.setup, r.pass, r.direction, r.measured_rad, r.reference_rad, r.head_rad,
                       r.interferometer_rad, r.velocity_rad_s == 0.0});
  }
  return samples;
}

HobAnalysis AnalyseHob(const std::vector<Reading>& readings, const Scenario& scenario, Estimator estimator) {
  HobAnalysis analysis;
  analysis.estimator = estimator;
  std::vector<HobSample> samples = SamplesOf(readings), at_rest;
  analysis.used = static_cast<int>(samples.size());
  analysis.left_out = static_cast<int>(readings.size()) - analysis.used;
  std::ranges::copy_if(samples, std::back_inserter(at_rest), IsAtRest);
  std::erase_if(samples, IsAtRest);
  TransmissionOptions options = OptionsOf(scenario);
  options.max_order = OrdersThatShow(samples, options);
  options.hob_orders = HobOrdersBeside(HobOf(scenario).transmission, samples, options.max_order);
  analysis.positions = MeasurePositions(samples, options);
  if (std::ranges::none_of(analysis.positions, HasTurns)) {
    analysis.not_separated = "no head position has a complete turn";
    return analysis;
  }
  analysis.two_positions = Published(analysis.positions);
  analysis.separation = SeparateHeads(analysis.positions);
  analysis.folded = FoldedOrders(HobOf(scenario).transmission, analysis.positions, options.max_order);
  for (SeparatedOrder& order : analysis.separation->orders) {
    if (!analysis.folded.contains(order.order)) continue;
    order.status = OrderStatus::kSumOnly;
    order.encoder = {};
  }
  if (analysis.folded.contains(1)) analysis.two_positions.reset();
  const std::vector<int> orders = OrdersToCompare(HobOf(scenario).transmission, options.max_order);
  AddDirections(samples, options, orders, analysis);
  analysis.encoder = EncoderSeries(*analysis.separation);
  analysis.is_interferometer_at_rest = HasInterferometer(at_rest);
  const InterferometerSettings& interferometer = HobOf(scenario).interferometer;
  AddEncoder(analysis.is_interferometer_at_rest ? at_rest : samples,
             analysis.is_interferometer_at_rest ? OptionsAtRest(options, interferometer) : options, orders,
             HobOf(scenario), analysis);
  return analysis;
}

}  // namespace twinbench::separate::hob
