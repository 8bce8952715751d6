#include "optics/bench.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace twinbench::optics {
namespace {

constexpr std::array<int, 2> kOrder = {+1, -1};
constexpr int kNodesPerAxis = 2;   // 16 rays: centroid to 1e-9 um (moments of a nearly linear map)
constexpr int kDensePerAxis = 24;  // 2304 rays for a beam over an edge
constexpr int kProfilePositions = 1024;

Scene BlockerScene(const std::vector<Blocker>& blockers, bool riding) {
  Scene scene;
  for (const Blocker& blocker : blockers) {
    if (blocker.rides_on_grating == riding) scene.AddMesh(blocker.mesh, blocker.pose);
  }
  scene.Commit();
  return scene;
}

bool Any(const std::vector<Blocker>& blockers, bool riding) {
  return std::ranges::any_of(blockers, [riding](const Blocker& b) { return b.rides_on_grating == riding; });
}

BeamNodes NodesOf(const BeamParameters& beam) {
  if (beam.kind == BeamKind::kGaussian) return GaussianBundle(beam.radius_m, beam.divergence_rad, kNodesPerAxis);
  if (beam.kind == BeamKind::kProfile) return ProfileBundle(*beam.profile, beam.divergence_rad, kProfilePositions);
  return {BeamNode{}};
}

void ValidateBeam(const BeamParameters& beam) {
  if (beam.kind == BeamKind::kGaussian && !(beam.radius_m > 0.0)) {
    throw std::invalid_argument("beam: radius_m must be positive");
  }
  if (beam.kind == BeamKind::kProfile && !beam.profile) throw std::invalid_argument("beam: the profile is missing");
  if (!(beam.divergence_rad >= 0.0)) throw std::invalid_argument("beam: divergence_rad must not be negative");
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
}

/// The direct light of the detector's own order, if it arrived.
const Deposit* FindDirect(const std::vector<Deposit>& deposits, int detector) {
  const auto found = std::ranges::find_if(deposits, [detector](const Deposit& d) {
    return d.detector == detector && d.reflections == 0 && d.order == kOrder[static_cast<std::size_t>(detector)];
  });
  return found == deposits.end() ? nullptr : &*found;
}

}  // namespace

struct RotaryOptics::OnPlane {
  bool arrives = false;
  double u_m = 0.0, v_m = 0.0;
  Eigen::Vector3d on_grating_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d on_plane_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
};

struct RotaryOptics::Bundle {
  double share = 0.0;                                  // of the power that arrives
  Eigen::Vector2d mean_m = Eigen::Vector2d::Zero();    // in the plane
  Eigen::Vector2d offset_m = Eigen::Vector2d::Zero();  // from the chief ray
  Eigen::Matrix2d cov_m2 = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d slopes_per_m = Eigen::Matrix2d::Zero();  // of the direction, by regression on position
};

RotaryOptics::RotaryOptics(const RotaryOpticsParameters& parameters) : parameters_(parameters) {
  ValidateAll(parameters_);
  const double angle = std::asin(parameters_.nominal_wavelength_m * parameters_.grating.lines_per_m);
  for (int i = 0; i < 2; ++i) {
    const auto n = static_cast<std::size_t>(i);
    X_LP_[n] = PsdPose(psd(i), kOrder[n] * angle);
    planes_[n] = MakeFrame(RectangularPlane(X_LP_[n], psd(i).width_m, psd(i).height_m));
    split_ |= psd(i).window.has_value() || psd(i).silicon_reflectance > 0.0;
  }
  nodes_ = NodesOf(parameters_.beam);
  const BeamParameters& beam = parameters_.beam;
  if (beam.kind == BeamKind::kGaussian)
    dense_nodes_ = DenseBundle(beam.radius_m, beam.divergence_rad, kDensePerAxis);
  if (Any(parameters_.blockers, false)) fixed_blockers_ = BlockerScene(parameters_.blockers, false);
  if (Any(parameters_.blockers, true)) riding_blockers_ = BlockerScene(parameters_.blockers, true);
  chief_only_ = beam.kind == BeamKind::kChiefRay && !split_ && parameters_.blockers.empty();
}

Ray RotaryOptics::ChiefRay(const SourceState& source) const {
  const double c = std::cos(source.pitch_rad);
  return {parameters_.laser_position_m,
          {c * std::sin(source.yaw_rad), -c * std::cos(source.yaw_rad), std::sin(source.pitch_rad)}};
}

RotaryOptics::OnPlane RotaryOptics::TraceOrder(const Frame& g, const Ray& ray, double wavelength_m, int i) const {
  OnPlane result;
  const auto& o = ray.origin_m;
  const auto& d = ray.direction;
  double t, x, y;
  MeetPlane(g, o.x(), o.y(), o.z(), d.x(), d.y(), d.z(), t, x, y);
  const Eigen::Vector3d normal(g.zx, g.zy, g.zz);
  if (!(t > 0.0) || !InAperture(g, x, y) || !(d.dot(normal) < 0.0)) return result;
  const auto n = static_cast<std::size_t>(i);
  const double shift = kOrder[n] * wavelength_m * parameters_.grating.lines_per_m;
  const OrderDirection out = Diffract(d, normal, {g.xx, g.xy, g.xz}, shift);
  if (out.status != OrderStatus::kOk) return result;
  const Eigen::Vector3d p = o + t * d;
  MeetPlane(planes_[n], p.x(), p.y(), p.z(), out.direction.x(), out.direction.y(), out.direction.z(), t, x, y);
  if (!(t > 0.0)) return result;
  return {true, x, y, p, p + t * out.direction, out.direction};
}

PsdSignal RotaryOptics::TraceChief(const Frame& grating, const Ray& chief, const SourceState& source, int i) const {
  const OnPlane hit = TraceOrder(grating, chief, source.wavelength_m, i);
  if (!hit.arrives) return {};
  const Eigen::Vector3d& d = chief.direction;
  const Eigen::Vector3d d_G(d.x() * grating.xx + d.y() * grating.xy + d.z() * grating.xz, 0.0,
                            -(d.x() * grating.yx + d.y() * grating.yy + d.z() * grating.yz));
  const double share =
      EfficiencyOf(parameters_.grating, source.wavelength_m, d_G, kOrder[static_cast<std::size_t>(i)]);
  return RespondToPoint(psd(i), hit.u_m, hit.v_m, source.power_W * share);
}

bool RotaryOptics::Blocked(const Eigen::Isometry3d& X_LG, const Eigen::Vector3d& from_m,
                           const Eigen::Vector3d& to_m) const {
  if (fixed_blockers_ && fixed_blockers_->Occluded(from_m, to_m)) return true;
  if (!riding_blockers_) return false;
  const Eigen::Isometry3d X_GL = X_LG.inverse();
  return riding_blockers_->Occluded(X_GL * from_m, X_GL * to_m);
}

RotaryOptics::Bundle RotaryOptics::TraceBundle(const BeamNodes& nodes, const Eigen::Isometry3d& X_LG,
                                               const Ray& chief, double wavelength_m, int i) const {
  const Frame grating = MakeFrame(
      RectangularPlane(SurfacePoseOfGrating(X_LG), parameters_.grating.width_m, parameters_.grating.height_m));
  const BeamAxes axes = AxesAcross(chief.direction);
  const Eigen::Matrix3d& R_LP = X_LP_[static_cast<std::size_t>(i)].linear();
  const bool blockers = !parameters_.blockers.empty();
  double share = 0.0;
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  Eigen::Matrix4d squares = Eigen::Matrix4d::Zero();  // of (u, v, direction u, direction v)
  for (const BeamNode& node : nodes) {
    const Ray ray = NodeRay(chief, axes, node);
    const OnPlane hit = TraceOrder(grating, ray, wavelength_m, i);
    if (!hit.arrives) continue;
    if (blockers &&
        (Blocked(X_LG, ray.origin_m, hit.on_grating_m) || Blocked(X_LG, hit.on_grating_m, hit.on_plane_m))) {
      continue;
    }
    const Eigen::Vector4d state(hit.u_m, hit.v_m, R_LP.col(0).dot(hit.direction), R_LP.col(1).dot(hit.direction));
    share += node.weight;
    sum += node.weight * state;
    squares += node.weight * state * state.transpose();
  }
  Bundle bundle{.share = share};
  if (!(share > 0.0)) return bundle;
  const Eigen::Vector4d mean = sum / share;
  const Eigen::Matrix4d cov = squares / share - mean * mean.transpose();
  bundle.mean_m = mean.head<2>();
  if (nodes.size() > 1) {
    bundle.cov_m2 = cov.topLeftCorner<2, 2>();
    bundle.slopes_per_m = cov.bottomLeftCorner<2, 2>() * bundle.cov_m2.inverse();
  }
  const OnPlane centre = TraceOrder(grating, chief, wavelength_m, i);
  if (centre.arrives) bundle.offset_m = bundle.mean_m - Eigen::Vector2d(centre.u_m, centre.v_m);
  return bundle;
}

/// The few rays of a smooth rule; if one of them is lost, the many of a rule for hard edges.
RotaryOptics::Bundle RotaryOptics::BundleOn(const Eigen::Isometry3d& X_LG, const Ray& chief, double wavelength_m,
                                            int i) const {
  const Bundle smooth = TraceBundle(nodes_, X_LG, chief, wavelength_m, i);
  if (dense_nodes_.empty() || smooth.share > 1.0 - 1e-9) return smooth;
  return TraceBundle(dense_nodes_, X_LG, chief, wavelength_m, i);
}

std::vector<Deposit> RotaryOptics::Deposits(const Eigen::Isometry3d& X_LG, const Ray& chief,
                                            const SourceState& source) const {
  GhostBench bench{.X_LG = X_LG,
                   .grating = &parameters_.grating,
                   .wavelength_m = source.wavelength_m,
                   .psd = {&parameters_.psd_a, &parameters_.psd_b},
                   .X_LP = X_LP_,
                   .blocked = {}};
  if (!parameters_.blockers.empty()) {
    bench.blocked = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) { return Blocked(X_LG, from, to); };
  }
  return TraceGhosts(bench, chief, source.power_W, parameters_.ghosts);
}

double RotaryOptics::OrderPower(const Eigen::Isometry3d& X_LG, const Ray& chief, const SourceState& source,
                                int i) const {
  const Eigen::Vector3d d_G = X_LG.linear().transpose() * chief.direction;
  return source.power_W *
         EfficiencyOf(parameters_.grating, source.wavelength_m, d_G, kOrder[static_cast<std::size_t>(i)]);
}

std::vector<Spot> RotaryOptics::SpotsOn(int i, const Bundle& bundle, const std::vector<Deposit>& deposits,
                                        double power_W, double wavelength_m) const {
  const Deposit* direct = FindDirect(deposits, i);
  Spot main{bundle.mean_m.x(), bundle.mean_m.y(), power_W * bundle.share, bundle.cov_m2, 1.0 - bundle.share};
  if (direct) {
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
  std::array<std::vector<Spot>, 2> spots;
  for (int i = 0; i < 2; ++i) {
    const Bundle bundle = BundleOn(X_LG, chief, source.wavelength_m, i);
    const double power_W = OrderPower(X_LG, chief, source, i);
    spots[static_cast<std::size_t>(i)] = SpotsOn(i, bundle, deposits, power_W, source.wavelength_m);
  }
  return spots;
}

PsdSignals RotaryOptics::Trace(const Eigen::Isometry3d& X_LG, const SourceState& source) const {
  if (chief_only_) {
    const Ray chief = ChiefRay(source);
    const Frame grating = MakeFrame(
        RectangularPlane(SurfacePoseOfGrating(X_LG), parameters_.grating.width_m, parameters_.grating.height_m));
    return {TraceChief(grating, chief, source, 0), TraceChief(grating, chief, source, 1)};
  }
  const auto spots = Spots(X_LG, source);
  return {Respond(parameters_.psd_a, spots[0]), Respond(parameters_.psd_b, spots[1])};
}

std::vector<IrradianceMap> RotaryOptics::Irradiance(const Eigen::Isometry3d& X_LG, const SourceState& source,
                                                    int pixels) const {
  if (pixels < 1) throw std::invalid_argument("irradiance: at least one pixel");
  const auto spots = Spots(X_LG, source);
  std::vector<IrradianceMap> maps;
  for (int i = 0; i < 2; ++i) {
    const auto n = static_cast<std::size_t>(i);
    IrradianceMap map;
    map.name = i == 0 ? "psd.p1" : "psd.m1";
    map.width = pixels;
    map.pitch_m = psd(i).width_m / pixels;
    map.height = static_cast<int>(std::lround(psd(i).height_m / map.pitch_m));
    map.irradiance_W_m2.assign(static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height), 0.0f);
    map.X_LP = X_LP_[n];
    map.wavelength_m = source.wavelength_m;
    map.order = kOrder[n];
    for (const Spot& spot : spots[n]) {
      Paint(spot, map);
      map.power_W += spot.power_W;
    }
    maps.push_back(std::move(map));
  }
  return maps;
}

}  // namespace twinbench::optics
