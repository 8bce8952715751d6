#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "optics/bench_bundle.h"
#include "optics/bench_parameters.h"
#include "optics/landing.h"
#include "optics/power_map.h"

namespace twinbench::optics {
namespace {

/// One order of a beam on one detector.
struct BeamOnDetector {
  const PsdParameters& psd;
  Eigen::Isometry3d X_LP;
  Eigen::Vector3d incident;  // of the chief ray, at the grating
  Eigen::Vector3d grating_normal;
  Eigen::Vector3d order;  // of the chief ray, behind the grating
  Eigen::Vector2d pixel_m;
  double wavelength_m;
};

/// A pixel's light behind a window whose faces interfere.
PowerPatch ThroughEtalon(const BeamOnDetector& beam, const Landing& landing, const Eigen::Vector2d& half_m,
                         PowerPatch patch) {
  const Window& window = *beam.psd.window;
  const Eigen::Vector3d direction_P = beam.X_LP.linear().transpose() * landing.direction;
  const auto [phase, gradient] =
      EtalonPhase(window, beam.wavelength_m, direction_P, patch.u_m, Eigen::Matrix2d::Zero());
  const Eigen::Matrix2d cov_m2 = (half_m.array().square() / 3.0).matrix().asDiagonal();
  const Etalon etalon = Interfere(window.reflectance, phase, gradient, cov_m2);
  // Both faces were passed with 1 - R already.
  patch.power_W *= etalon.transmission / std::pow(1.0 - window.reflectance, 2);
  patch.u_m += etalon.shift_m.x();
  patch.v_m += etalon.shift_m.y();
  return patch;
}

/// Half sides along u and v of the rectangle with the second moments that a pixel of the beam has on the detector:
/// the parallel projection of the beam along its direction on to the grating, and along the order on to the plane.
Eigen::Vector2d HalfPixelOn(const BeamOnDetector& beam) {
  const BeamAxes axes = AxesAcross(beam.incident);
  const Eigen::Vector3d facing = beam.X_LP.linear().col(2);
  const auto projected = [&](const Eigen::Vector3d& across) -> Eigen::Vector2d {
    const Eigen::Vector3d on_grating =
        across - across.dot(beam.grating_normal) / beam.incident.dot(beam.grating_normal) * beam.incident;
    const Eigen::Vector3d on_plane = on_grating - on_grating.dot(facing) / beam.order.dot(facing) * beam.order;
    return beam.X_LP.linear().leftCols<2>().transpose() * on_plane;
  };
  const Eigen::Vector2d x = beam.pixel_m.x() * projected(axes.x), y = beam.pixel_m.y() * projected(axes.y);
  return 0.5 * (x.array().square() + y.array().square()).sqrt();
}

/// Gathers the rays of the beam as rectangles of light, each with its power behind the window. Where the window's
/// faces interfere, each rectangle has the transmission and the shift of its own place and direction.
class MapMaker {
 public:
  /// @param rays     Expected. @param power_W  Of the whole beam in this order.
  MapMaker(const BeamOnDetector& beam, std::size_t rays, double power_W)
      : beam_(beam), power_W_(power_W), interferes_(beam.psd.window && beam.psd.window->coherent) {
    map_.half_m = HalfPixelOn(beam);
    map_.patches.reserve(rays);
  }

  /// A ray that arrives, with its share of the beam.
  void Add(double weight, const Landing& landing) {
    arrived_ += weight;
    const double absorbed = landing.transmission * (1.0 - beam_.psd.silicon_reflectance);
    const PowerPatch patch{landing.u_m, landing.v_m, power_W_ * weight * absorbed};
    map_.patches.push_back(interferes_ ? ThroughEtalon(beam_, landing, map_.half_m, patch) : patch);
  }

  /// What has not been added is lost.
  PowerMap Take() {
    map_.lost_share = 1.0 - arrived_;
    return std::move(map_);
  }

 private:
  BeamOnDetector beam_;
  double power_W_;
  bool interferes_;
  double arrived_ = 0.0;
  PowerMap map_;
};

/// Share of a normal patch between two coordinates.
double ShareBetween(double mean, double sigma, double low, double high) {
  if (!(sigma > 0.0)) return mean >= low && mean < high ? 1.0 : 0.0;
  const double scale = 1.0 / (sigma * std::sqrt(2.0));
  return 0.5 * (std::erf((high - mean) * scale) - std::erf((low - mean) * scale));
}

/// Adds a patch to a map, each pixel the integral over its area (axes of the patch taken parallel to u and v).
void Paint(const Spot& spot, IrradianceMap& map) {
  const double area = map.pitch_m * map.pitch_m, half = 0.5 * map.pitch_m;
  const double su = std::sqrt(spot.cov_m2(0, 0)), sv = std::sqrt(spot.cov_m2(1, 1));
  std::vector<double> along_u(static_cast<std::size_t>(map.width));
  for (int i = 0; i < map.width; ++i) {
    along_u[static_cast<std::size_t>(i)] = ShareBetween(spot.u_m, su, map.U(i) - half, map.U(i) + half);
  }
  for (int row = 0; row < map.height; ++row) {
    const double along_v = ShareBetween(spot.v_m, sv, map.V(row) - half, map.V(row) + half);
    for (int i = 0; i < map.width && along_v > 0.0; ++i) {
      const double share = along_v * along_u[static_cast<std::size_t>(i)];
      map.irradiance_W_m2[static_cast<std::size_t>(row * map.width + i)] +=
          static_cast<float>(spot.power_W * share / area);
    }
  }
  map.power_W += spot.power_W;
}

}  // namespace

std::array<RotaryOptics::Measured, 2> RotaryOptics::MeasuredLight(const Eigen::Isometry3d& X_LG,
                                                                  const SourceState& source) const {
  const Ray chief = ChiefRay(source);
  const std::vector<Deposit> deposits = split_ ? Deposits(X_LG, chief, source) : std::vector<Deposit>{};
  const Eigen::Vector3d normal = X_LG.linear().col(1);
  std::array<std::optional<MapMaker>, 2> makers;
  for (int i = 0; i < 2; ++i) {
    const auto n = static_cast<std::size_t>(i);
    const double power_W = OrderPower(X_LG, chief, source, i);
    const double shift = kOrderOfPsd[n] * source.wavelength_m * parameters_.grating.lines_per_m;
    const BeamOnDetector beam{.psd = psd(i),
                              .X_LP = X_LP_[n],
                              .incident = chief.direction,
                              .grating_normal = normal,
                              .order = Diffract(chief.direction, normal, X_LG.linear().col(0), shift).direction,
                              .pixel_m = ProfileBlock_m(*parameters_.beam.profile, ProfilePositions(parameters_)),
                              .wavelength_m = source.wavelength_m};
    makers[n].emplace(beam, nodes_.size(), power_W);
  }
  std::array<Moments, 2> moments;
  VisitLandings(nodes_, X_LG, chief, source.wavelength_m,
                [&](int i, std::size_t begin, std::span<const Landing> landings) {
                  const auto n = static_cast<std::size_t>(i);
                  for (std::size_t k = 0; k < landings.size(); ++k) {
                    if (!landings[k].arrives) continue;
                    const double weight = nodes_[begin + k].weight;
                    makers[n]->Add(weight, landings[k]);
                    if (split_) moments[n].Add(weight, landings[k], X_LP_[n].linear());
                  }
                });
  std::array<Measured, 2> light;
  for (int i = 0; i < 2; ++i) {
    const auto n = static_cast<std::size_t>(i);
    light[n].map = makers[n]->Take();
    if (!split_) continue;
    light[n].others = SpotsOn(i, moments[n].Summary(nodes_.size() == 1), deposits, 0.0, source.wavelength_m);
    light[n].others.erase(light[n].others.begin());  // the direct light, which is the map
  }
  return light;
}

PsdSignals RotaryOptics::TraceMeasured(const Eigen::Isometry3d& X_LG, const SourceState& source) const {
  const std::array<Measured, 2> light = MeasuredLight(X_LG, source);
  return {Respond(parameters_.psd_a, light[0].map, light[0].others),
          Respond(parameters_.psd_b, light[1].map, light[1].others)};
}

IrradianceMap RotaryOptics::DarkPicture(int i, const SourceState& source, int pixels) const {
  const auto n = static_cast<std::size_t>(i);
  IrradianceMap map;
  map.name = i == 0 ? "psd.p1" : "psd.m1";
  map.width = pixels;
  map.pitch_m = psd(i).width_m / pixels;
  map.height = static_cast<int>(std::lround(psd(i).height_m / map.pitch_m));
  map.irradiance_W_m2.assign(static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height), 0.0f);
  map.X_LP = X_LP_[n];
  map.wavelength_m = source.wavelength_m;
  map.order = kOrderOfPsd[n];
  return map;
}

std::vector<IrradianceMap> RotaryOptics::Irradiance(const Eigen::Isometry3d& X_LG, const SourceState& source,
                                                    int pixels) const {
  if (pixels < 1) throw std::invalid_argument("irradiance: at least one pixel");
  std::vector<IrradianceMap> maps = {DarkPicture(0, source, pixels), DarkPicture(1, source, pixels)};
  if (measured_) {
    const std::array<Measured, 2> light = MeasuredLight(X_LG, source);
    for (std::size_t i = 0; i < 2; ++i) {
      optics::Paint(light[i].map, maps[i]);
      for (const Spot& spot : light[i].others) Paint(spot, maps[i]);
    }
    return maps;
  }
  const auto spots = Spots(X_LG, source);
  for (std::size_t i = 0; i < 2; ++i) {
    for (const Spot& spot : spots[i]) Paint(spot, maps[i]);
  }
  return maps;
}

}  // namespace twinbench::optics
