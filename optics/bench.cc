#include "optics/bench.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "optics/bench_bundle.h"

namespace twinbench::optics {
namespace {

constexpr int kNodesPerAxis = 2;         // 16 rays: centroid to 1e-9 um (moments of a nearly linear map)
constexpr int kDensePerAxis = 24;        // 2304 rays for a beam over an edge

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

/// The direct light of the detector's own order, if it arrived.
const Deposit* FindDirect(const std::vector<Deposit>& deposits, int detector) {
  const auto found = std::ranges::find_if(deposits, [detector](const Deposit& d) {
    return d.detector == detector && d.reflections == 0 &&
           d.order == kOrderOfPsd[static_cast<std::size_t>(detector)];
  });
  return found == deposits.end() ? nullptr : &*found;
}

}  // namespace

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

}  // namespace twinbench::optics
