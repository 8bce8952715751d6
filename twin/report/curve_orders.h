#pragma once

#include <complex>
#include <nlohmann/json_fwd.hpp>
#include <vector>

/// Orders of a true curve, to score an estimate by what its design can see: {"position_deg", "ez_arcsec"} at even
/// positions of a whole turn.
namespace twinbench::report {

/// C of Re C exp(j order position) [arcsec]; 0 for an order that the positions do not tell.
std::complex<double> OrderOf(const nlohmann::json& curve, int order);

/// Adds Re wave exp(j order position).
void AddOrder(int order, std::complex<double> wave, nlohmann::json& curve);

/// @return root mean square of what was taken out.
double TakeOutOrders(const std::vector<int>& orders, nlohmann::json& curve);

}  // namespace twinbench::report
