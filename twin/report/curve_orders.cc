#include "twin/report/curve_orders.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/core/units.h"

namespace twinbench::report {

std::complex<double> OrderOf(const nlohmann::json& curve, int order) {
  const auto values = curve.at("ez_arcsec").get<std::vector<double>>(), at_deg = curve.at("position_deg").get<std::vector<double>>();
  if (2 * order >= static_cast<int>(values.size())) return 0.0;
  std::complex<double> sum = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) sum += values[i] * std::polar(1.0, -order * at_deg[i] * units::deg);
  return 2.0 / static_cast<double>(values.size()) * sum;
}

void AddOrder(int order, std::complex<double> wave, nlohmann::json& curve) {
  auto values = curve.at("ez_arcsec").get<std::vector<double>>();
  const auto at_deg = curve.at("position_deg").get<std::vector<double>>();
  for (std::size_t i = 0; i < values.size(); ++i) values[i] += (wave * std::polar(1.0, order * at_deg[i] * units::deg)).real();
  curve["ez_arcsec"] = values;
}

double TakeOutOrders(const std::vector<int>& orders, nlohmann::json& curve) {
  double squares = 0.0;
  for (const int order : orders) {
    const std::complex<double> wave = OrderOf(curve, order);
    AddOrder(order, -wave, curve);
    squares += 0.5 * std::norm(wave);
  }
  return std::sqrt(squares);
}

}  // namespace twinbench::report
