#include "optics/bench.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "optics/measured_beam.h"

namespace twinbench::optics {
namespace {

constexpr int kNodesPerAxis = 2;         // 16 rays: centroid to 1e-9 um (moments of a nearly linear map)
constexpr int kDensePerAxis = 24;        // 2304 rays for a beam over an edge
constexpr int kProfilePositions = 1024;  // closed: enough for second moments

int ProfilePositions(const RotaryOpticsParameters& p) {
  return p.fidelity == Fidelity::kTraced ? p.beam.profile_rays : kProfilePositions;
}

BeamNodes NodesOf(const RotaryOpticsParameters& p) {
  const BeamParameters& beam = p.beam;
  if (beam.kind == BeamKind::kGaussian) return GaussianBundle(beam.radius_m, beam.divergence_rad, kNodesPerAxis);
  if (beam.kind == BeamKind::kProfile)
    return ProfileBundle(*beam.profile, beam.divergence_rad, ProfilePositions(p));
  return {BeamNode{}};
}

void ValidateBeam(const BeamParameters& beam) {
  if (beam.kind == BeamKind::kGaussian && !(beam.radius_m > 0.0)) {
    throw std::invalid_argument("beam: radius_m must be positive");
  }
  if (beam.kind == BeamKind::kProfile && !beam.profile) throw std::invalid_argument("beam: the profile is missing");
  if (!(beam.divergence_rad >= 0.0)) throw std::invalid_argument("beam: divergence_rad must not be negative");
  if (beam.profile_rays < 1) throw std::invalid_argument("beam: profile_rays must be positive");
}

void ValidateAll(const RotaryOpticsParameters& p) {
  Validate(p.grating);
  Validate(p.psd_a);
  Validate(p.psd_b);
  ValidateBeam(p.beam);
  if (!p.laser_position_m.allFinite()) throw std::invalid_argument("laser_position_m is not set");
  const double sine = p.nominal_wavelength_m * p.grating.lines_per_m;
  if (!(sine > 0.0 && sine < 1.0))
    throw std::invalid_argument("orders +-1 do not propagate at nominal_wavelength_m");
}

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

/// The direct light of the detector's own order, if it arrived.
const Deposit* FindDirect(const std::vector<Deposit>& deposits, int detector) {
  const auto found = std::ranges::find_if(deposits, [detector](const Deposit& d) {
    return d.detector == detector && d.reflections == 0 &&
           d.order == kOrderOfPsd[static_cast<std::size_t>(detector)];
  });
  return found == deposits.end() ? nullptr : &*found;
}

}  // namespace

struct RotaryOptics::Bundle {
  double share = 0.0;                                  // of the power that arrives
  Eigen::Vector2d mean_m = Eigen::Vector2d::Zero();    // in the plane
  double transmission = 1.0;                           // of the window
  Eigen::Vector2d offset_m = Eigen::Vector2d::Zero();  // from the chief ray; closed only
  Eigen::Matrix2d cov_m2 = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d slopes_per_m = Eigen::Matrix2d::Zero();  // of the direction, by regression on position
};

RotaryOptics::RotaryOptics(const RotaryOpticsParameters& parameters) : parameters_(parameters) {
  ValidateAll(parameters_);
  const double angle = std::asin(parameters_.nominal_wavelength_m * parameters_.grating.lines_per_m);
  for (int i = 0; i < 2; ++i) {
    const auto n = static_cast<std::size_t>(i);
    X_LP_[n] = PsdPose(psd(i), kOrderOfPsd[n] * angle);
    split_ |= psd(i).window.has_value() || psd(i).silicon_reflectance > 0.0;
  }
  nodes_ = NodesOf(parameters_);
  const BeamParameters& beam = parameters_.beam;
  if (beam.kind == BeamKind::kGaussian)
    dense_nodes_ = DenseBundle(beam.radius_m, beam.divergence_rad, kDensePerAxis);
  if (parameters_.fidelity == Fidelity::kTraced) {
    traced_.emplace(parameters_, X_LP_);
  } else {
    closed_.emplace(parameters_, X_LP_);
  }
  measured_ = traced_ && beam.kind == BeamKind::kProfile;
}

Ray RotaryOptics::ChiefRay(const SourceState& source) const {
  const double c = std::cos(source.pitch_rad);
  return {parameters_.laser_position_m,
          {c * std::sin(source.yaw_rad), -c * std::cos(source.yaw_rad), std::sin(source.pitch_rad)}};
}

Frame RotaryOptics::GratingFrame(const Eigen::Isometry3d& X_LG) const {
  return MakeFrame(
      RectangularPlane(SurfacePoseOfGrating(X_LG), parameters_.grating.width_m, parameters_.grating.height_m));
}

PsdSignal RotaryOptics::ChiefSignal(const Frame& grating, const Ray& chief, const SourceState& source,
                                    const Landing& landing, int i) const {
  if (!landing.arrives) return {};
  const Eigen::Vector3d& d = chief.direction;
  const Eigen::Vector3d d_G(d.x() * grating.xx + d.y() * grating.xy + d.z() * grating.xz, 0.0,
                            -(d.x() * grating.yx + d.y() * grating.yy + d.z() * grating.yz));
  const double share =
      EfficiencyOf(parameters_.grating, source.wavelength_m, d_G, kOrderOfPsd[static_cast<std::size_t>(i)]);
  return RespondToPoint(psd(i), landing.u_m, landing.v_m, source.power_W * share);
}

PsdSignals RotaryOptics::TraceChief(const Eigen::Isometry3d& X_LG, const SourceState& source) const {
  const Ray chief = ChiefRay(source);
  const Frame grating = GratingFrame(X_LG);
  if (closed_) {
    return {ChiefSignal(grating, chief, source, closed_->Reach(grating, chief, source.wavelength_m, 0), 0),
            ChiefSignal(grating, chief, source, closed_->Reach(grating, chief, source.wavelength_m, 1), 1)};
  }
  const std::array<Landing, 2> landings = traced_->Trace(X_LG, chief, source.wavelength_m);
  return {ChiefSignal(grating, chief, source, landings[0], 0), ChiefSignal(grating, chief, source, landings[1], 1)};
}

/// Tile by tile, so that a beam of many rays stays in the cache on its way.
void RotaryOptics::VisitLandings(const BeamNodes& nodes, const Eigen::Isometry3d& X_LG, const Ray& chief,
                                 double wavelength_m, const Visit& visit) const {
  constexpr std::size_t kTile = 256;
  const BeamAxes axes = AxesAcross(chief.direction);
  const Frame grating = GratingFrame(X_LG);
  const GratingPoses poses({&X_LG, 1});
  RayBatch rays;
  DirectLight::Landings landings;
  for (std::size_t begin = 0; begin < nodes.size(); begin += kTile) {
    const std::size_t n = std::min(kTile, nodes.size() - begin);
    rays.Resize(n);
    for (std::size_t k = 0; k < n; ++k) rays.Set(k, NodeRay(chief, axes, nodes[begin + k]));
    if (traced_) traced_->Trace(poses, rays, {&wavelength_m, 1}, landings);
    for (int i = 0; i < 2; ++i) {
      auto& on = landings.on[static_cast<std::size_t>(i)];
      on.resize(n);
      for (std::size_t k = 0; closed_ && k < n; ++k)
        on[k] = closed_->Trace(grating, X_LG, rays.At(k), wavelength_m, i);
      visit(i, begin, on);
    }
  }
}

struct RotaryOptics::Moments {
  double share = 0.0, transmission = 0.0;
  Eigen::Vector2d on_silicon = Eigen::Vector2d::Zero();
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  Eigen::Matrix4d squares = Eigen::Matrix4d::Zero();  // of (u, v, direction u, direction v) in air

  void Add(double weight, const Landing& hit, const Eigen::Matrix3d& R_LP) {
    const Eigen::Vector4d state(hit.in_air_m.x(), hit.in_air_m.y(), R_LP.col(0).dot(hit.direction),
                                R_LP.col(1).dot(hit.direction));
    share += weight;
    transmission += weight * hit.transmission;
    on_silicon += weight * Eigen::Vector2d(hit.u_m, hit.v_m);
    sum += weight * state;
    squares += weight * state * state.transpose();
  }

  Bundle Summary(bool is_chief_ray) const {
    Bundle bundle{.share = share};
    if (!(share > 0.0)) return bundle;
    const Eigen::Vector4d mean = sum / share;
    const Eigen::Matrix4d cov = squares / share - mean * mean.transpose();
    bundle.mean_m = on_silicon / share;
    bundle.transmission = transmission / share;
    if (is_chief_ray) return bundle;
    bundle.cov_m2 = cov.topLeftCorner<2, 2>();
    bundle.slopes_per_m = cov.bottomLeftCorner<2, 2>() * bundle.cov_m2.inverse();
    return bundle;
  }
};

std::array<RotaryOptics::Bundle, 2> RotaryOptics::Bundles(const BeamNodes& nodes, const Eigen::Isometry3d& X_LG,
                                                          const Ray& chief, double wavelength_m) const {
  std::array<Moments, 2> moments;
  VisitLandings(nodes, X_LG, chief, wavelength_m, [&](int i, std::size_t begin, std::span<const Landing> landings) {
    const auto n = static_cast<std::size_t>(i);
    for (std::size_t k = 0; k < landings.size(); ++k) {
      if (landings[k].arrives) moments[n].Add(nodes[begin + k].weight, landings[k], X_LP_[n].linear());
    }
  });
  const bool alone = nodes.size() == 1;
  std::array<Bundle, 2> bundles = {moments[0].Summary(alone), moments[1].Summary(alone)};
  if (!closed_) return bundles;
  const Frame grating = GratingFrame(X_LG);
  for (int i = 0; i < 2; ++i) {
    Bundle& bundle = bundles[static_cast<std::size_t>(i)];
    const Landing centre = closed_->Reach(grating, chief, wavelength_m, i);
    if (bundle.share > 0.0 && centre.arrives) bundle.offset_m = bundle.mean_m - centre.in_air_m;
  }
  return bundles;
}

/// The few rays of a smooth rule; for an order that loses one of them, the many of a rule for hard edges.
std::array<RotaryOptics::Bundle, 2> RotaryOptics::BundlesOf(const Eigen::Isometry3d& X_LG, const Ray& chief,
                                                            double wavelength_m) const {
  const auto is_whole = [](const Bundle& b) { return b.share > 1.0 - 1e-9; };
  std::array<Bundle, 2> bundles = Bundles(nodes_, X_LG, chief, wavelength_m);
  if (dense_nodes_.empty() || (is_whole(bundles[0]) && is_whole(bundles[1]))) return bundles;
  const std::array<Bundle, 2> dense = Bundles(dense_nodes_, X_LG, chief, wavelength_m);
  for (std::size_t i = 0; i < 2; ++i) {
    if (!is_whole(bundles[i])) bundles[i] = dense[i];
  }
  return bundles;
}

std::vector<Deposit> RotaryOptics::Deposits(const Eigen::Isometry3d& X_LG, const Ray& chief,
                                            const SourceState& source) const {
  GhostBench bench{.X_LG = X_LG,
                   .grating = &parameters_.grating,
                   .wavelength_m = source.wavelength_m,
                   .psd = {&parameters_.psd_a, &parameters_.psd_b},
                   .X_LP = X_LP_,
                   .blocked = {},
                   .scenes = traced_ ? &traced_->scenes() : nullptr};
  if (closed_ && !parameters_.blockers.empty()) {
    bench.blocked = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
      return closed_->Blocked(X_LG, from, to);
    };
  }
  return TraceGhosts(bench, chief, source.power_W, parameters_.ghosts);
}

double RotaryOptics::OrderPower(const Eigen::Isometry3d& X_LG, const Ray& chief, const SourceState& source,
                                int i) const {
  const Eigen::Vector3d d_G = X_LG.linear().transpose() * chief.direction;
  return source.power_W *
         EfficiencyOf(parameters_.grating, source.wavelength_m, d_G, kOrderOfPsd[static_cast<std::size_t>(i)]);
}

std::vector<Spot> RotaryOptics::SpotsOn(int i, const Bundle& bundle, const std::vector<Deposit>& deposits,
                                        double power_W, double wavelength_m) const {
  const Deposit* direct = FindDirect(deposits, i);
  Spot main{bundle.mean_m.x(), bundle.mean_m.y(), power_W * bundle.share, bundle.cov_m2, 1.0 - bundle.share};
  if (traced_) {
    main.power_W *= bundle.transmission * (1.0 - psd(i).silicon_reflectance);
  } else if (direct) {
    main.u_m = direct->u_m + bundle.offset_m.x();
    main.v_m = direct->v_m + bundle.offset_m.y();
    main.power_W = direct->power_W * bundle.share;
  }
  const std::optional<Window>& window = psd(i).window;
  if (direct && window && window->coherent) {
    const auto [phase, gradient] =
        EtalonPhase(*window, wavelength_m, direct->direction_P, direct->u_m, bundle.slopes_per_m);
    const Etalon etalon = Interfere(window->reflectance, phase, gradient, bundle.cov_m2);
    // The two faces were passed with (1 - R)^2 already.
    main.power_W *= etalon.transmission / std::pow(1.0 - window->reflectance, 2);
    main.u_m += etalon.shift_m.x();
    main.v_m += etalon.shift_m.y();
  }
  std::vector<Spot> spots{main};
  for (const Deposit& deposit : deposits) {
    if (deposit.detector != i || &deposit == direct) continue;
    spots.push_back({deposit.u_m, deposit.v_m, deposit.power_W, bundle.cov_m2});
  }
  return spots;
}

std::array<std::vector<Spot>, 2> RotaryOptics::Spots(const Eigen::Isometry3d& X_LG,
                                                     const SourceState& source) const {
  const Ray chief = ChiefRay(source);
  const std::vector<Deposit> deposits = split_ ? Deposits(X_LG, chief, source) : std::vector<Deposit>{};
  const std::array<Bundle, 2> bundles = BundlesOf(X_LG, chief, source.wavelength_m);
  std::array<std::vector<Spot>, 2> spots;
  for (int i = 0; i < 2; ++i) {
    const auto n = static_cast<std::size_t>(i);
    const double power_W = OrderPower(X_LG, chief, source, i);
    spots[n] = SpotsOn(i, bundles[n], deposits, power_W, source.wavelength_m);
  }
  return spots;
}

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

PsdSignals RotaryOptics::Trace(const Eigen::Isometry3d& X_LG, const SourceState& source) const {
  // Alone, the chief ray meets the fixtures on its own way; closed, their shadows are asked for below.
  const bool alone = parameters_.beam.kind == BeamKind::kChiefRay && !split_;
  if (alone && (traced_ || parameters_.blockers.empty())) return TraceChief(X_LG, source);
  if (measured_) return TraceMeasured(X_LG, source);
  const auto spots = Spots(X_LG, source);
  return {Respond(parameters_.psd_a, spots[0]), Respond(parameters_.psd_b, spots[1])};
}

std::vector<PsdSignals> RotaryOptics::Trace(std::span<const Eigen::Isometry3d> X_LG,
                                            std::span<const SourceState> sources) const {
  if (X_LG.size() != sources.size()) throw std::invalid_argument("as many sources as poses of the grating");
  std::vector<PsdSignals> signals;
  signals.reserve(X_LG.size());
  if (!traced_ || parameters_.beam.kind != BeamKind::kChiefRay || split_ || X_LG.size() == 1) {
    for (std::size_t k = 0; k < X_LG.size(); ++k) signals.push_back(Trace(X_LG[k], sources[k]));
    return signals;
  }
  RayBatch chiefs;
  std::vector<double> wavelength_m;
  for (const SourceState& source : sources) {
    chiefs.Add(ChiefRay(source));
    wavelength_m.push_back(source.wavelength_m);
  }
  DirectLight::Landings landings;
  traced_->Trace(GratingPoses(X_LG), chiefs, wavelength_m, landings);
  for (std::size_t k = 0; k < X_LG.size(); ++k) {
    const Frame grating = GratingFrame(X_LG[k]);
    const Ray chief = chiefs.At(k);
    signals.push_back({ChiefSignal(grating, chief, sources[k], landings.on[0][k], 0),
                       ChiefSignal(grating, chief, sources[k], landings.on[1][k], 1)});
  }
  return signals;
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
