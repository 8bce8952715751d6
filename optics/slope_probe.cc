#include "optics/slope_probe.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "optics/window.h"

namespace twinbench::optics {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;

// Where things stand along the beam [m]: a probe's length of 0.2 m.
constexpr double kLaser = 0.200, kOuterLens = 0.180, kInnerLens = 0.120, kSplitter = 0.080;
constexpr double kPlate = SlopeProbeSizes::plate, kClear = SlopeProbeSizes::clear;
constexpr double kSideways = SlopeProbeSizes::lens - kSplitter;  // from the splitter to lens and dump
constexpr double kOuterFocal = 0.050, kInnerFocal = 0.010;       // the reducer: five to one
constexpr double kBore = 0.006;                                  // radius on the laser's side
constexpr double kDetector = SlopeProbeSizes::detector;
constexpr double kWeakest = 1e-7;  // share of the power that is still followed
constexpr int kMostReturns = 8;

Isometry3d AtHeight(double z_m) {
  return Isometry3d(Eigen::Translation3d(0.0, 0.0, z_m));
}

/// The frame behind the splitter: light that comes back along +z of T runs along +y there. Its x and y are T's as
/// the splitter mirrors them, its z is against the light.
Isometry3d BehindSplitter(double distance_m) {
  Isometry3d pose = Isometry3d::Identity();
  pose.linear() << Vector3d::UnitX(), Vector3d::UnitZ(), -Vector3d::UnitY();
  pose.translation() = Vector3d(0.0, distance_m, kSplitter);
  return pose;
}

void CheckProbe(const SlopeProbeParameters& p) {
  if (!(p.lens_m > 0.0)) throw std::invalid_argument("slope probe: the focal length must be set and positive");
  if (!(p.beam_radius_m > 0.0) || !(p.wavelength_m > 0.0))
    throw std::invalid_argument("slope probe: beam radius and wavelength must be positive");
}

CoatedPlate PlateOf(const SlopeProbeParameters& p) {
  const double azimuth_rad = 0.25 * std::numbers::pi + p.plate_azimuth_error_rad;
  const WavePlate plate{Vector3d(std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0),
                        0.5 * std::numbers::pi + p.plate_retardance_error_rad};
  return {plate, p.plate_reflected, p.plate_reflected};
}

}  // namespace

SlopeProbe::SlopeProbe(const SlopeProbeParameters& parameters) : parameters_(parameters) {
  const SlopeProbeParameters& p = parameters_;
  CheckProbe(p);
  outer_lens_ = elements_.Add(CircularPlane(AtHeight(kOuterLens), kBore), ThinLens{kOuterFocal});
  inner_lens_ = elements_.Add(CircularPlane(AtHeight(kInnerLens), kBore), ThinLens{kInnerFocal});
  const Isometry3d slanted = AtHeight(kSplitter) * AngleAxisd(0.25 * std::numbers::pi, Vector3d::UnitX());
  splitter_ = elements_.Add(CircularPlane(slanted, std::numbers::sqrt2 * kClear), p.splitter);
  const Isometry3d tilted = AtHeight(kPlate) * AngleAxisd(p.plate_tilt_rad.x(), Vector3d::UnitX()) *
                            AngleAxisd(p.plate_tilt_rad.y(), Vector3d::UnitY());
  plate_ = elements_.Add(CircularPlane(tilted, kClear), PlateOf(p));
  lens_ = elements_.Add(CircularPlane(BehindSplitter(kSideways), kClear), ThinLens{p.lens_m});
  detector_ = elements_.Add(RectangularPlane(BehindSplitter(kSideways + p.lens_m), kDetector, kDetector), Sink{});
  elements_.Add(CircularPlane(AtHeight(kLaser + 1e-3), kBore), Sink{});           // the laser's housing
  elements_.Add(CircularPlane(BehindSplitter(-kSideways), 2.0 * kBore), Sink{});  // what the splitter sends away
  elements_.Commit();
  LaunchBeam();
}

double SlopeProbe::divergence_rad() const {
  return parameters_.wavelength_m / (std::numbers::pi * parameters_.beam_radius_m);
}

/// The rays of a waist at T, sent backwards through the reducer: those that the laser must send.
void SlopeProbe::LaunchBeam() {
  constexpr int kNodes = 3;
  nodes_ = GaussianBundle(parameters_.beam_radius_m, divergence_rad(), kNodes);
  const Ray backwards{Vector3d::Zero(), Vector3d::UnitZ()};
  const BeamAxes axes{Vector3d::UnitX(), Vector3d::UnitY()};
  for (const BeamNode& node : nodes_) launched_.Add(NodeRay(backwards, axes, node));
  HitBatch hits;
  elements_.FollowWay({{plate_}, {splitter_}, {inner_lens_}, {outer_lens_}}, launched_, hits);
  for (std::size_t i = 0; i < launched_.size(); ++i) {
    if (hits.surface[i] != outer_lens_)
      throw std::invalid_argument("slope probe: the beam is too wide for its reducer");
    const Ray back = launched_.At(i);
    const double way_m = (kLaser - back.origin_m.z()) / back.direction.z();
    launched_.Set(i, {back.origin_m + way_m * back.direction, -back.direction});
  }
}

void SlopeProbe::Reflect(const PolarisedLight& light, const ProbedSurface& surface,
                         std::vector<PolarisedLight>& onwards, ProbeView& view) const {
  RayBatch ray;
  ray.Add(light.ray);
  SurfacePoints points;
  surface(ray, points);
  if (!points.is_met[0]) return;
  const Vector3d &point_m = points.point_m[0], &normal = points.normal[0];
  // The strongest light is the first that is there: whatever goes another way is sent on behind it.
  if (light.returns == 0 && !view.is_met) view.spot_m = point_m, view.is_met = true;
  onwards.push_back(
      {{point_m, optics::Reflect(light.ray.direction, normal)}, OnMirror(light.field, normal), light.returns + 1});
}

ProbeView SlopeProbe::Look(const ProbedSurface& surface) const {
  const Vector3d down = -Vector3d::UnitZ();
  ProbeView view;
  std::vector<PolarisedLight> onwards{
      {{kLaser * Vector3d::UnitZ(), down}, LinearField(down, Vector3d::UnitY(), 1.0), 0}};
  Followed followed;
  while (!onwards.empty()) {
    const PolarisedLight light = onwards.back();
    onwards.pop_back();
    followed.leaving.clear();
    elements_.Follow(light, kWeakest, followed);
    for (const PolarisedLight& out : followed.leaving) {
      if (out.ray.direction.z() < 0.0 && out.returns < kMostReturns) Reflect(out, surface, onwards, view);
    }
  }
  for (const Arrival& a : followed.arrivals) {
    if (a.element == detector_) view.patches.push_back({a.x_m, a.y_m, a.power, a.returns});
  }
  return view;
}

Spot SlopeProbe::BeamOnDetector(const ProbedSurface& surface) const {
  RayBatch rays = launched_;
  HitBatch hits;
  elements_.FollowWay({{outer_lens_}, {inner_lens_}, {splitter_}, {plate_}}, rays, hits);
  SurfacePoints points;
  surface(rays, points);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (points.is_met[i]) rays.Set(i, {points.point_m[i], optics::Reflect(rays.At(i).direction, points.normal[i])});
  }
  elements_.FollowWay({{plate_}, {splitter_, true}, {lens_}, {detector_}}, rays, hits);
  Spot spot;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!points.is_met[i] || hits.surface[i] != detector_) continue;
    const Eigen::Vector2d at(hits.x_m[i], hits.y_m[i]);
    spot.power_W += nodes_[i].weight;
    sum += nodes_[i].weight * at;
    squares += nodes_[i].weight * at * at.transpose();
  }
  const Eigen::Vector2d mean = sum / spot.power_W;
  spot.u_m = mean.x();
  spot.v_m = mean.y();
  spot.cov_m2 = squares / spot.power_W - mean * mean.transpose();
  spot.lost_share = 1.0 - spot.power_W;
  return spot;
}

}  // namespace twinbench::optics
