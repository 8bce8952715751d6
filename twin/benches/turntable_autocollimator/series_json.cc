#include "twin/benches/turntable_autocollimator/series_json.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>

#include "twin/core/units.h"
#include "twin/core/written_number.h"
#include "twin/report/json_units.h"

namespace twinbench::benches::turntable {
namespace {

/// Index of the entry that is nearest on the circle.
std::size_t NearestAngle(const std::vector<double>& ascending_deg, double angle_deg) {
  const auto after = std::ranges::lower_bound(ascending_deg, angle_deg);
  const auto next = static_cast<std::size_t>(after - ascending_deg.begin()) % ascending_deg.size();
  const std::size_t before = (next + ascending_deg.size() - 1) % ascending_deg.size();
  const auto away = [&](std::size_t k) { return std::abs(std::remainder(ascending_deg[k] - angle_deg, 360.0)); };
  return away(before) < away(next) ? before : next;
}

}  // namespace

nlohmann::json ToJson(const separate::turntable::AngleSeries& series) {
  nlohmann::json json = {{"position_deg", nlohmann::json::array()},
                         {"ez_arcsec", nlohmann::json::array()},
                         {"u_ez_arcsec", nlohmann::json::array()}};
  for (std::size_t k = 0; k < series.position_rad.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    json["position_deg"].push_back(WrittenNumber(series.position_rad[k], units::deg));
    json["ez_arcsec"].push_back(report::Arcsec(series.value_rad[i]));
    json["u_ez_arcsec"].push_back(report::Arcsec(series.U_rad(i)));
  }
  return json;
}

nlohmann::json ToJson(const separate::turntable::HarmonicModel& model) {
  nlohmann::json terms = nlohmann::json::array();
  for (const auto& term : model.terms) {
    terms.push_back({{"order", term.order},
                     {"amplitude_arcsec", report::Arcsec(term.amplitude_rad)},
                     {"u_amplitude_arcsec", report::Arcsec(term.u_amplitude_rad)},
                     {"phase_deg", report::In(units::deg, term.phase_rad)},
                     {"u_phase_deg", report::In(units::deg, term.u_phase_rad)}});
  }
  return {{"form", "sum of amplitude sin(order angle + phase)"},
          {"highest_order", model.highest_order},
          {"terms", terms},
          {"residual_rms_arcsec", report::Arcsec(model.residual_rms_rad)},
          {"u_unmodelled_arcsec", report::Arcsec(model.u_unmodelled_rad)}};
}

std::vector<double> TruthAt(const nlohmann::json& table, const std::vector<double>& position_rad) {
  const auto angles_deg = table.at("position_deg").get<std::vector<double>>();
  const auto ez_arcsec = table.at("ez_arcsec").get<std::vector<double>>();
  std::vector<double> truth;
  double mean = 0.0;
  for (const double angle_rad : position_rad) {
    truth.push_back(ez_arcsec[NearestAngle(angles_deg, angle_rad / units::deg)]);
    mean += truth.back() / static_cast<double>(position_rad.size());
  }
  for (double& value : truth) value -= mean;
  return truth;
}

report::CurveScore CurveOf(const std::string& name, const separate::turntable::AngleSeries& series,
                           const nlohmann::json& table) {
  report::CurveScore curve{
      .name = name, .value = "ez_arcsec", .position = {}, .estimate = {}, .u = {}, .truth = {}};
  for (std::size_t k = 0; k < series.position_rad.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    curve.position.push_back(series.position_rad[k] / units::deg);
    curve.estimate.push_back(series.value_rad[i] / units::arcsec);
    curve.u.push_back(series.U_rad(i) / units::arcsec);
  }
  curve.truth = TruthAt(table, series.position_rad);
  return curve;
}

void TakeOutLost(const std::vector<int>& orders, int positions, report::CurveScore& curve) {
  std::map<long, std::vector<std::size_t>> rows;  // by the place within a step
  const double step_deg = 360.0 / positions;
  for (std::size_t i = 0; i < curve.position.size(); ++i) {
    const double steps = curve.position[i] / step_deg;
    rows[std::lround((steps - std::floor(steps + 1e-6)) * 1e4)].push_back(i);
  }
  for (const auto& at_place : rows) {
    const std::vector<std::size_t>& row = at_place.second;
    const auto wave = [&](int order, std::size_t i) { return std::polar(1.0, order * curve.position[i] * units::deg); };
    const auto take_out = [&](int order) {
      std::complex<double> sum = 0.0;
      for (const std::size_t i : row) sum += curve.truth[i] * std::conj(wave(order, i));
      sum *= (order == 0 || 2 * order == positions ? 1.0 : 2.0) / static_cast<double>(row.size());
      for (const std::size_t i : row) curve.truth[i] -= (sum * wave(order, i)).real();
    };
    take_out(0);
    std::ranges::for_each(orders, take_out);
  }
}

}  // namespace twinbench::benches::turntable
