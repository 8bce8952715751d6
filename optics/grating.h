#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "optics/grating_form.h"
#include "optics/surface.h"

/// Diffraction by a plane grating at any incidence and any orientation (conical diffraction included).
namespace twinbench::optics {

enum class OrderStatus { kOk, kEvanescent };

struct OrderDirection {
  Eigen::Vector3d direction = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  OrderStatus status = OrderStatus::kEvanescent;
};

/// Direction of one order: the component across the grooves grows by m lambda rho, the one along them stays.
///
/// @param d       Unit direction of the incident light.
/// @param normal  Unit normal, either sign.
/// @param across  Unit vector in the grating plane, across the grooves; m > 0 deflects towards it. Another length
///                stands for grooves that are denser by it.
/// @param order_lambda_rho  m * wavelength (in the medium around) * groove density, dimensionless.
/// @return kEvanescent with NaN if the order does not propagate.
inline OrderDirection Diffract(const Eigen::Vector3d& d, const Eigen::Vector3d& normal,
                               const Eigen::Vector3d& across, double order_lambda_rho) {
  const double toward = d.dot(normal);
  const Eigen::Vector3d k = d - toward * normal + order_lambda_rho * across;
  const double q = 1.0 - k.squaredNorm();
  if (!(q > 0.0)) return {};
  return {k + (toward < 0.0 ? std::sqrt(q) : -std::sqrt(q)) * normal, OrderStatus::kOk};
}

/// Power of each order as a share of the incident power.
struct OrderEfficiencies {
  int lowest_order = 0;
  std::vector<double> share;  // of lowest_order, lowest_order + 1, ...

  double Of(int order) const;
  double Sum() const;
};

/// One line of a measured or computed table: the shares at one incidence.
struct EfficiencyRow {
  double sin_incidence = 0.0;  // component of the incident direction across the grooves
  OrderEfficiencies orders;
};

/// A plane grating: x across the grooves, y its normal, z along the grooves (frame G), aperture centred on G.
struct Grating {
  double lines_per_m = std::numeric_limits<double>::quiet_NaN();
  double width_m = std::numeric_limits<double>::quiet_NaN();   // x
  double height_m = std::numeric_limits<double>::quiet_NaN();  // z
  double reflectance = 1.0;                                    // upper bound of what all orders carry together
  std::vector<EfficiencyRow> table;                            // ascending in sin_incidence; one row: no dependence
  std::optional<GratingForm> form;  // none: a plane with straight grooves. Ghosts and the
                                    // shares of the orders know no form
};

/// Pose of the surface frame (x across, y along the grooves reversed, z normal) for a grating at X_WG.
Eigen::Isometry3d SurfacePoseOfGrating(const Eigen::Isometry3d& X_WG);

/// Shares of the orders for a ray: the table, with the power of evanescent orders given to the others in
/// proportion, at most `reflectance` in all. (Scalar: the redistribution of a Rayleigh anomaly is not modelled.)
///
/// @param d_G  Unit direction of the light in G.
OrderEfficiencies EfficienciesAt(const Grating& grating, double wavelength_m, const Eigen::Vector3d& d_G);

/// The share of one order, EfficienciesAt(...).Of(order), without a temporary: the hot path.
double EfficiencyOf(const Grating& grating, double wavelength_m, const Eigen::Vector3d& d_G, int order);

/// @throws std::invalid_argument naming the field that is missing or out of range.
void Validate(const Grating& grating);

}  // namespace twinbench::optics
