#include "optics/grating.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>

namespace twinbench::optics {
namespace {

/// Two rows of the table and the weight of the second.
struct Bracket {
  const OrderEfficiencies* a;
  const OrderEfficiencies* b;
  double weight;

  double Share(std::size_t i) const { return (1.0 - weight) * a->share[i] + weight * b->share[i]; }
};

Bracket Find(const std::vector<EfficiencyRow>& table, double sin_incidence) {
  std::size_t i = 0;
  while (i + 1 < table.size() && table[i + 1].sin_incidence <= sin_incidence) ++i;
  if (i + 1 == table.size() || sin_incidence <= table[i].sin_incidence)
    return {&table[i].orders, &table[i].orders, 0.0};
  const double span = table[i + 1].sin_incidence - table[i].sin_incidence;
  return {&table[i].orders, &table[i + 1].orders, (sin_incidence - table[i].sin_incidence) / span};
}

/// Factor from tabulated to real shares, and which orders propagate.
struct Budget {
  Bracket bracket;
  double order_step;  // lambda rho
  Eigen::Vector3d d_G;

  bool Propagates(int order) const {
    const double k = d_G.x() + order * order_step;
    return k * k + d_G.z() * d_G.z() < 1.0;
  }

  double Scale(double reflectance) const {
    double total = 0.0, propagating = 0.0;
    for (std::size_t i = 0; i < bracket.a->share.size(); ++i) {
      const double share = bracket.Share(i);
      total += share;
      propagating += Propagates(bracket.a->lowest_order + static_cast<int>(i)) ? share : 0.0;
    }
    return propagating > 0.0 ? reflectance * std::min(total, 1.0) / propagating : 0.0;
  }
};

}  // namespace

double OrderEfficiencies::Of(int order) const {
  const int i = order - lowest_order;
  return i >= 0 && i < static_cast<int>(share.size()) ? share[static_cast<std::size_t>(i)] : 0.0;
}

double OrderEfficiencies::Sum() const {
  return std::accumulate(share.begin(), share.end(), 0.0);
}

Eigen::Isometry3d SurfacePoseOfGrating(const Eigen::Isometry3d& X_WG) {
  Eigen::Isometry3d X_WS = X_WG;
  X_WS.linear().col(1) = -X_WG.linear().col(2);
  X_WS.linear().col(2) = X_WG.linear().col(1);
  return X_WS;
}

OrderEfficiencies EfficienciesAt(const Grating& grating, double wavelength_m, const Eigen::Vector3d& d_G) {
  const Budget budget{Find(grating.table, d_G.x()), wavelength_m * grating.lines_per_m, d_G};
  const double scale = budget.Scale(grating.reflectance);
  OrderEfficiencies orders = *budget.bracket.a;
  for (std::size_t i = 0; i < orders.share.size(); ++i) {
    const bool propagates = budget.Propagates(orders.lowest_order + static_cast<int>(i));
    orders.share[i] = propagates ? scale * budget.bracket.Share(i) : 0.0;
  }
  return orders;
}

double EfficiencyOf(const Grating& grating, double wavelength_m, const Eigen::Vector3d& d_G, int order) {
  const Budget budget{Find(grating.table, d_G.x()), wavelength_m * grating.lines_per_m, d_G};
  const int i = order - budget.bracket.a->lowest_order;
  if (i < 0 || i >= static_cast<int>(budget.bracket.a->share.size()) || !budget.Propagates(order)) return 0.0;
  return budget.Scale(grating.reflectance) * budget.bracket.Share(static_cast<std::size_t>(i));
}

void Validate(const Grating& grating) {
  const auto require = [](bool good, const char* what) {
    if (!good) throw std::invalid_argument(std::string("grating: ") + what);
  };
  require(grating.lines_per_m > 0.0, "lines_per_m must be positive");
  require(grating.width_m > 0.0 && grating.height_m > 0.0, "width_m and height_m must be positive");
  require(grating.reflectance >= 0.0 && grating.reflectance <= 1.0, "reflectance must be within 0..1");
  require(!grating.table.empty(), "an efficiency table is needed");
  for (std::size_t i = 0; i < grating.table.size(); ++i) {
    const OrderEfficiencies& orders = grating.table[i].orders;
    require(std::ranges::all_of(orders.share, [](double s) { return s >= 0.0; }), "an efficiency is negative");
    require(orders.share.size() == grating.table[0].orders.share.size() &&
                orders.lowest_order == grating.table[0].orders.lowest_order,
            "all rows of the efficiency table need the same orders");
    require(i == 0 || grating.table[i].sin_incidence > grating.table[i - 1].sin_incidence,
            "rows of the efficiency table must ascend in sin_incidence");
  }
}

}  // namespace twinbench::optics
