#include "optics/psd.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace twinbench::optics {
namespace {

/// Less than a millionth of the light is dark for any amplifier; its centroid would be that of the far tail.
constexpr double kDarkShare = 1e-6;

struct Cut {
  double share = 1.0;
  double shift_m = 0.0;      // of the mean
  double variance_m2 = 0.0;  // what remains
};

double Density(double z) {
  return std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
}

/// Probability of a < z < b without cancellation in the tails.
double Between(double a, double b) {
  const double r = std::numbers::sqrt2;
  if (a > 0.0) return 0.5 * (std::erfc(a / r) - std::erfc(b / r));
  if (b < 0.0) return 0.5 * (std::erfc(-b / r) - std::erfc(-a / r));
  return 1.0 - 0.5 * (std::erfc(-a / r) + std::erfc(b / r));
}

/// A normal distribution cut to |x| <= half.
Cut CutNormal(double mean_m, double variance_m2, double half_m) {
  if (!(variance_m2 > 0.0)) return {.share = std::abs(mean_m) <= half_m ? 1.0 : 0.0};
  const double sigma = std::sqrt(variance_m2);
  const double a = (-half_m - mean_m) / sigma, b = (half_m - mean_m) / sigma;
  const double share = Between(a, b);
  if (share < 1e-300) return {.share = 0.0};
  const double pull = (Density(a) - Density(b)) / share;
  const double spread = 1.0 + (a * Density(a) - b * Density(b)) / share - pull * pull;
  return {.share = share, .shift_m = sigma * pull, .variance_m2 = variance_m2 * std::max(spread, 0.0)};
}

struct Sum {
  double power = 0.0, u = 0.0, v = 0.0;

  void Add(const PsdParameters& psd, double u_m, double v_m, double power_W) {
    const double stretch = 1.0 + psd.cubic_per_m2 * (u_m * u_m + v_m * v_m);
    power += power_W;
    u += power_W * stretch * u_m;
    v += power_W * stretch * v_m;
  }

  /// The same for an even patch with variances along u and v: the mean of the cubic over it.
  void AddPatch(const PsdParameters& psd, const PowerPatch& patch, const Eigen::Vector2d& variance_m2) {
    const double r2 = patch.u_m * patch.u_m + patch.v_m * patch.v_m + variance_m2.sum();
    power += patch.power_W;
    u += patch.power_W * patch.u_m * (1.0 + psd.cubic_per_m2 * (r2 + 2.0 * variance_m2.x()));
    v += patch.power_W * patch.v_m * (1.0 + psd.cubic_per_m2 * (r2 + 2.0 * variance_m2.y()));
  }

  PsdSignal Signal(const PsdParameters& psd, PsdStatus status) const {
    const double diluted = power * (1.0 + psd.stray_fraction);
    return {.u_m = u / diluted, .v_m = v / diluted, .power_W = diluted, .status = status};
  }
};

/// What falls on a PSD, light by light.
struct Response {
  double incident_W = 0.0;
  Sum seen;

  /// Returns what the area leaves of it.
  Spot Add(const PsdParameters& psd, const Spot& spot) {
    const Spot cut = Truncate(spot, psd.width_m, psd.height_m);
    incident_W += spot.power_W;
    if (cut.power_W > 0.0) seen.Add(psd, cut.u_m, cut.v_m, cut.power_W);
    return cut;
  }

  void Add(const PsdParameters& psd, const PowerMap& map) {
    incident_W += map.power_W();
    const Eigen::Vector2d variance_m2 = map.half_m.array().square() / 3.0;
    for (const PowerPatch& patch : map.patches) {
      const PowerPatch cut = CutToArea(patch, map.half_m, psd.width_m, psd.height_m);
      if (cut.power_W > 0.0) seen.AddPatch(psd, cut, variance_m2);
    }
  }

  PsdSignal Signal(const PsdParameters& psd, bool clipped) const {
    if (!(incident_W > 0.0)) return {};
    if (!(seen.power > kDarkShare * incident_W)) return {.status = PsdStatus::kMissed};
    return seen.Signal(psd, clipped ? PsdStatus::kClipped : PsdStatus::kOk);
  }
};

}  // namespace

Eigen::Isometry3d PsdPose(const PsdParameters& psd, double order_angle_rad) {
  const double s = std::sin(order_angle_rad), c = std::cos(order_angle_rad);
  Eigen::Isometry3d X_LP = Eigen::Isometry3d::Identity();
  X_LP.translation() = psd.distance_m * Eigen::Vector3d(s, c, 0.0);
  X_LP.linear().col(0) = Eigen::Vector3d(c, -s, 0.0);
  X_LP.linear().col(1) = Eigen::Vector3d::UnitZ();
  X_LP.linear().col(2) = Eigen::Vector3d(-s, -c, 0.0);
  X_LP.rotate(Eigen::AngleAxisd(psd.roll_rad, Eigen::Vector3d::UnitZ()));
  X_LP.rotate(Eigen::AngleAxisd(psd.tilt_u_rad, Eigen::Vector3d::UnitX()));
  X_LP.rotate(Eigen::AngleAxisd(psd.tilt_v_rad, Eigen::Vector3d::UnitY()));
  return X_LP;
}

Spot Truncate(const Spot& spot, double width_m, double height_m) {
  const Cut u = CutNormal(spot.u_m, spot.cov_m2(0, 0), width_m / 2.0);
  const Cut v = CutNormal(spot.v_m, spot.cov_m2(1, 1), height_m / 2.0);
  Spot cut = spot;
  cut.power_W *= u.share * v.share;
  // A cut in v also moves u by the regression of u on v.
  const double cross = spot.cov_m2(0, 1);
  cut.u_m += u.shift_m + (cross != 0.0 ? cross / spot.cov_m2(1, 1) * v.shift_m : 0.0);
  cut.v_m += v.shift_m + (cross != 0.0 ? cross / spot.cov_m2(0, 0) * u.shift_m : 0.0);
  cut.cov_m2(0, 0) = u.variance_m2;
  cut.cov_m2(1, 1) = v.variance_m2;
  return cut;
}

PsdSignal Respond(const PsdParameters& psd, std::span<const Spot> spots) {
  if (spots.empty()) return {};
  const Spot& signal = spots.front();
  Response response;
  const Spot cut = response.Add(psd, signal);
  for (const Spot& other : spots.subspan(1)) response.Add(psd, other);
  const bool at_edge = cut.power_W < (1.0 - kClippedShare) * signal.power_W;
  return response.Signal(psd, at_edge || signal.lost_share > kClippedShare);
}

PsdSignal Respond(const PsdParameters& psd, const PowerMap& signal, std::span<const Spot> others) {
  Response response;
  response.Add(psd, signal);
  const bool at_edge = response.seen.power < (1.0 - kClippedShare) * response.incident_W;
  for (const Spot& other : others) response.Add(psd, other);
  return response.Signal(psd, at_edge || signal.lost_share > kClippedShare);
}

PsdSignal RespondToPoint(const PsdParameters& psd, double u_m, double v_m, double power_W) {
  if (!(power_W > 0.0)) return {};
  if (2.0 * std::abs(u_m) > psd.width_m || 2.0 * std::abs(v_m) > psd.height_m)
    return {.status = PsdStatus::kMissed};
  Sum sum;
  sum.Add(psd, u_m, v_m, power_W);
  return sum.Signal(psd, PsdStatus::kOk);
}

void Validate(const PsdParameters& psd) {
  const auto require = [](bool good, const char* what) {
    if (!good) throw std::invalid_argument(std::string("psd: ") + what);
  };
  require(psd.distance_m > 0.0, "distance_m must be positive");
  require(psd.width_m > 0.0 && psd.height_m > 0.0, "width_m and height_m must be positive");
  require(psd.stray_fraction >= 0.0, "stray_fraction must not be negative");
  require(psd.silicon_reflectance >= 0.0 && psd.silicon_reflectance < 1.0, "silicon_reflectance must be in [0, 1)");
  require(std::isfinite(psd.roll_rad + psd.tilt_u_rad + psd.tilt_v_rad + psd.cubic_per_m2),
          "an angle is not finite");
  if (psd.window) Validate(*psd.window);
}

}  // namespace twinbench::optics
