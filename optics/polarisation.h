#pragma once

#include <Eigen/Core>

/// Polarised light as a field vector in space, so that no axes have to be carried from element to element.
///
/// Yun, Crabtree, Chipman, Applied Optics 50 (2011) 2855-2865: the three-dimensional form of Jones' calculus.
namespace twinbench::optics {

/// Complex amplitude across the ray; its squared norm is the power.
using Field = Eigen::Vector3cd;

/// Fully polarised along `axis` as far as that lies across the ray.
/// @throws std::invalid_argument if the axis lies along the ray.
Field LinearField(const Eigen::Vector3d& direction, const Eigen::Vector3d& axis, double power);

/// What a mirror does to the field of light that it reflects: a perfect conductor, whose surface has none.
Field OnMirror(const Field& field, const Eigen::Vector3d& normal);

/// A surface that ideally lets p through and reflects s. Extinction ratio of the transmitted light:
/// (1 - p_reflected) / s_transmitted; of the reflected light (1 - s_transmitted) / p_reflected.
struct PolarisingSplitter {
  double p_reflected = 0.0;    // share of the power
  double s_transmitted = 0.0;  // likewise
  /// Zero: a stack of layers, whose s lies across each ray's own plane of incidence, so that rays askew by an angle
  /// leak its square. Else the direction of a grid's wires, in the surface: s is along them.
  Eigen::Vector3d wires = Eigen::Vector3d::Zero();
};

struct SplitFields {
  Field transmitted, reflected;
};

/// Without loss. Phases of the two ways are not modelled: what meets again adds its power.
SplitFields OnSplitter(const PolarisingSplitter& splitter, const Field& field, const Eigen::Vector3d& direction,
                       const Eigen::Vector3d& normal);

/// A retarder whose thickness does not count.
struct WavePlate {
  Eigen::Vector3d fast_axis = Eigen::Vector3d::UnitX();  // in its plane
  double retardance_rad = 0.0;                           // of the slow axis behind the fast one
};

/// For light close to the plate's normal: the fast axis is taken as it looks along the ray.
Field Retard(const WavePlate& plate, const Field& field, const Eigen::Vector3d& direction);

}  // namespace twinbench::optics
