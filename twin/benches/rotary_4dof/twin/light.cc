#include "twin/benches/rotary_4dof/twin/light.h"

#include <algorithm>

#include "optics/stl.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/core/csv.h"
#include "twin/core/errors.h"

namespace twinbench::sim {
namespace {

/// Places of a measured beam that are told apart where many questions are asked. On a detector that is linear the
/// centroid does not depend on it; one that is not knows the size of each place (PowerMap): less than a nanometre.
constexpr int kQuickProfileRays = 256;

/// Lengths grow by parts in a million: places of spots between two temperatures lie on a straight line to 1e-9.
constexpr double kWarm_K = 10.0;

/// Of the pictures that Twin::WriteIrradiance makes: 20 um pixels on a 10 mm detector.
constexpr int kIrradiancePixels = 500;

optics::PsdParameters OpticalPsd(const PsdSettings& s) {
  optics::PsdParameters psd;
  psd.distance_m = s.distance_m;
  psd.roll_rad = s.roll_rad;
  psd.tilt_u_rad = s.tilt_u_rad;
  psd.tilt_v_rad = s.tilt_v_rad;
  psd.width_m = s.width_m;
  psd.height_m = s.height_m;
  psd.cubic_per_m2 = s.cubic_per_m2;
  psd.stray_fraction = s.stray_fraction;
  psd.silicon_reflectance = s.silicon_reflectance;
  if (s.window) {
    psd.window = optics::Window{s.window_thickness_m, s.window_index,     s.window_gap_m,
                                s.window_reflectance, s.window_wedge_rad, s.window_coherent};
  }
  return psd;
}

constexpr std::array<const char*, 5> kOrderColumns = {"m-2", "m-1", "m0", "m+1", "m+2"};

double NeededNumber(const CsvTable& table, const CsvTable::Row& row, const char* name) {
  return CsvNumber(table, row, NeededColumn(table, name, "sin_incidence,m-2,m-1,m0,m+1,m+2"), 1.0);
}

optics::EfficiencyRow EfficiencyRowOf(const CsvTable& table, const CsvTable::Row& row) {
  optics::EfficiencyRow efficiency{NeededNumber(table, row, "sin_incidence"), {-2, {}}};
  for (const char* order : kOrderColumns) {
    efficiency.orders.share.push_back(NeededNumber(table, row, order));
    if (efficiency.orders.share.back() < 0.0)
      throw InputError(table.Where(row), std::string(order) + " is negative", "shares of the power from 0 to 1");
  }
  if (efficiency.orders.Sum() > 1.0)
    throw InputError(table.Where(row), "the orders carry more than the light", "shares that sum up to 1 at most");
  return efficiency;
}

std::vector<optics::EfficiencyRow> EfficienciesFrom(const std::string& path) {
  const CsvTable table = ReadCsv(path);
  std::vector<optics::EfficiencyRow> efficiencies;
  for (const CsvTable::Row& row : table.rows) {
    efficiencies.push_back(EfficiencyRowOf(table, row));
    const std::size_t n = efficiencies.size();
    if (n > 1 && efficiencies[n - 1].sin_incidence <= efficiencies[n - 2].sin_incidence)
      throw InputError(table.Where(row), "sin_incidence does not increase", "rows in its order");
  }
  if (efficiencies.empty()) throw InputError(path, "holds no rows", "a row for each incidence");
  return efficiencies;
}

std::optional<optics::HeightMap> MapFrom(const std::string& key, const std::string& path) {
  if (path.empty()) return std::nullopt;
  try {
    return optics::ReadHeightMap(path);
  } catch (const std::runtime_error& error) {
    throw InputError(key, error.what(), "an OpenEXR file with a channel Y in um and a pixel pitch");
  }
}

optics::GratingForm FormOf(const GratingSettings& s) {
  optics::GratingForm form{
      0.5 * s.width_m, s.sphere_m, s.astigmatism_m, s.ruling_chirp_per_m, s.ruling_fan_rad_m, {}, {}};
  form.flatness_um = MapFrom("grating.flatness_file", s.flatness_file);
  form.ruling_um = MapFrom("grating.ruling_file", s.ruling_file);
  return form;
}

optics::Grating GratingOf(const GratingSettings& s) {
  optics::Grating grating;
  grating.lines_per_m = s.lines_per_m;
  grating.width_m = s.width_m;
  grating.height_m = s.height_m;
  grating.table = {{0.0, {-2, {s.efficiency.begin(), s.efficiency.end()}}}};
  if (!s.efficiency_file.empty()) grating.table = EfficienciesFrom(s.efficiency_file);
  if (const optics::GratingForm form = FormOf(s); !form.IsPlain()) grating.form = form;
  return grating;
}

optics::BeamParameters BeamOf(const LaserSettings& s) {
  optics::BeamParameters beam;
  beam.radius_m = s.beam_radius_m;
  beam.divergence_rad = s.divergence_rad;
  if (s.beam == "gaussian") beam.kind = optics::BeamKind::kGaussian;
  if (s.beam != "profile") return beam;
  beam.kind = optics::BeamKind::kProfile;
  try {
    beam.profile = optics::ReadIrradianceMaps(s.profile_file).at(0);
  } catch (const std::exception& error) {
    throw InputError("laser.profile_file", error.what(), "an OpenEXR file with a channel Y and a pixel pitch");
  }
  return beam;
}

optics::TriangleMesh MeshOf(const FixtureSettings& s) {
  if (s.mesh_file.empty()) return optics::BoxMesh(-0.5 * s.box_m, 0.5 * s.box_m);
  try {
    return optics::ReadStl(s.mesh_file, s.mesh_unit_m);
  } catch (const std::runtime_error& error) {
    throw InputError(s.location.empty() ? "fixture " + s.name : s.location,
                     std::string("fixture.mesh_file: ") + error.what(), "an STL file, binary or text");
  }
}

optics::Blocker BlockerOf(const FixtureSettings& s) {
  Pose pose = Pose::Identity();
  pose.translation() = s.position_m;
  pose.rotate(Eigen::AngleAxisd(s.yaw_rad, Vector3::UnitZ()));
  return {MeshOf(s), pose, s.rides_on_grating};
}

/// The closed form knows no measured beam but its second moments; such a beam is always traced if it is to be.
optics::Fidelity FidelityOf(const RotarySettings& s, LightAsked asked) {
  const bool traced = s.optics.fidelity == "traced";
  const bool must = asked == LightAsked::kAsStated || s.laser.beam == "profile";
  return traced && must ? optics::Fidelity::kTraced : optics::Fidelity::kClosed;
}

optics::RotaryOptics OpticsOf(const Scenario& actual, double nominal_wavelength_m, LightAsked asked) {
  optics::RotaryOpticsParameters parameters;
  parameters.fidelity = FidelityOf(RotaryOf(actual), asked);
  parameters.nominal_wavelength_m = nominal_wavelength_m;
  parameters.laser_position_m = RotaryOf(actual).laser.position_m;
  parameters.grating = GratingOf(RotaryOf(actual).grating);
  parameters.psd_a = OpticalPsd(RotaryOf(actual).psd_a);
  parameters.psd_b = OpticalPsd(RotaryOf(actual).psd_b);
  parameters.beam = BeamOf(RotaryOf(actual).laser);
  parameters.beam.profile_rays = RotaryOf(actual).optics.profile_rays;
  if (asked == LightAsked::kQuickly)
    parameters.beam.profile_rays = std::min(parameters.beam.profile_rays, kQuickProfileRays);
  for (const FixtureSettings& fixture : actual.fixtures) parameters.blockers.push_back(BlockerOf(fixture));
  if (nominal_wavelength_m * RotaryOf(actual).grating.lines_per_m >= 1.0)
    throw InputError("laser.wavelength_nm, grating.lines_per_mm", "the orders +1 and -1 cannot leave the grating",
                     "a wavelength below the distance of two grooves");
  return optics::RotaryOptics(parameters);
}

bool Grows(const RotarySettings& s) {
  return s.grating.expansion_per_K != 0.0 || s.psd_a.distance_expansion_per_K != 0.0 ||
         s.psd_b.distance_expansion_per_K != 0.0 || s.laser.post_growth_m_K != 0.0;
}

/// As it is `kWarm_K` above the temperature for which its lengths are stated. The PSDs stay in the directions in
/// which they were placed.
Scenario Warmed(Scenario actual) {
  RotarySettings& s = RotaryOf(actual);
  s.grating.lines_per_m /= 1.0 + s.grating.expansion_per_K * kWarm_K;
  for (PsdSettings* psd : {&s.psd_a, &s.psd_b}) psd->distance_m *= 1.0 + psd->distance_expansion_per_K * kWarm_K;
  s.laser.position_m.z() += s.laser.post_growth_m_K * kWarm_K;
  return actual;
}

/// For which the PSDs stand where they do, with other grooves.
double SamePlaces_m(double nominal_wavelength_m, const Scenario& actual, const Scenario& warm) {
  return nominal_wavelength_m * RotaryOf(actual).grating.lines_per_m / RotaryOf(warm).grating.lines_per_m;
}

ReadingStatus StatusOf(optics::PsdStatus status) {
  switch (status) {
    case optics::PsdStatus::kOk:
      return ReadingStatus::kOk;
    case optics::PsdStatus::kClipped:
      return ReadingStatus::kClippedSpot;
    case optics::PsdStatus::kMissed:
    case optics::PsdStatus::kNoLight:
      return ReadingStatus::kNoLight;
  }
  return ReadingStatus::kMissing;
}

/// Of the light that makes the same current.
double BackgroundOf_W(const PsdSettings& psd) {
  return psd.background_A / psd.responsivity_A_W;
}

}  // namespace

Light::Light(const Scenario& actual, double nominal_wavelength_m, LightAsked asked)
    : laser_(RotaryOf(actual).laser),
      low_light_fraction_(RotaryOf(actual).amplifier.low_light_fraction),
      post_growth_m_K_{RotaryOf(actual).psd_a.post_growth_m_K, RotaryOf(actual).psd_b.post_growth_m_K},
      background_W_{BackgroundOf_W(RotaryOf(actual).psd_a), BackgroundOf_W(RotaryOf(actual).psd_b)},
      speckle_(RotaryOf(actual).grating, actual.seed),
      optics_(OpticsOf(actual, nominal_wavelength_m, asked)) {
  if (Grows(RotaryOf(actual))) {
    const Scenario warm = Warmed(actual);
    warm_optics_.emplace(OpticsOf(warm, SamePlaces_m(nominal_wavelength_m, actual, warm), asked));
  }
  // Without fixtures: what they take away is missing from the nominal power. A power needs no traced light.
  optics::RotaryOpticsParameters unobstructed = optics_.parameters();
  unobstructed.fidelity = optics::Fidelity::kClosed;
  unobstructed.blockers.clear();
  const optics::PsdSignals nominal =
      optics::RotaryOptics(unobstructed).Trace(Pose::Identity(), SourceOf(Nominal(0.0)));
  nominal_power_W_ = {nominal.a.power_W, nominal.b.power_W};
}

LightState Light::Nominal(double temperature_K) const {
  const double hops = laser_.mode_hop_K > 0.0 ? std::floor(temperature_K / laser_.mode_hop_K + 0.5) : 0.0;
  return {laser_.wavelength_m + laser_.wavelength_per_kelvin_m * temperature_K + hops * laser_.mode_spacing_m,
          laser_.yaw_rad + laser_.pointing_yaw_per_kelvin_rad * temperature_K,
          laser_.pitch_rad + laser_.pointing_pitch_per_kelvin_rad * temperature_K, temperature_K};
}

optics::SourceState Light::SourceOf(const LightState& light) const {
  return {light.wavelength_m, light.yaw_rad, light.pitch_rad, laser_.power_W * (1.0 + light.power_change)};
}

Spots Light::Trace(const Pose& X_LG, const LightState& light) const {
  return SpotsOf(optics_.Trace(X_LG, SourceOf(light)), X_LG, light);
}

std::vector<Spots> Light::Trace(const std::vector<Pose>& X_LG, const std::vector<LightState>& lights) const {
  std::vector<optics::SourceState> sources;
  sources.reserve(lights.size());
  for (const LightState& light : lights) sources.push_back(SourceOf(light));
  std::vector<Spots> spots;
  spots.reserve(lights.size());
  const std::vector<optics::PsdSignals> signals = optics_.Trace(X_LG, sources);
  for (std::size_t k = 0; k < signals.size(); ++k) spots.push_back(SpotsOf(signals[k], X_LG[k], lights[k]));
  return spots;
}

Spots Light::SpotsOf(const optics::PsdSignals& signals, const Pose& X_LG, const LightState& light) const {
  const std::array<const optics::PsdSignal*, 2> psd = {&signals.a, &signals.b};
  Spots spots;
  for (std::size_t p = 0; p < 2; ++p) {
    spots.uv_m[2 * p] = psd[p]->u_m;
    spots.uv_m[2 * p + 1] = psd[p]->v_m;
    spots.power_W[p] = psd[p]->power_W;
    const bool dark = psd[p]->power_W < low_light_fraction_ * nominal_power_W_[p];
    const ReadingStatus status = dark ? ReadingStatus::kNoLight : StatusOf(psd[p]->status);
    if (spots.status == ReadingStatus::kOk) spots.status = status;
  }
  if (light.above_K != 0.0) Warm(signals, X_LG, light, spots);
  speckle_.Move(X_LG, spots.uv_m);
  for (std::size_t p = 0; p < 2; ++p) Dilute(p, spots);
  return spots;
}

/// A background that counts as signal lies about the detector's middle and draws the place there.
void Light::Dilute(std::size_t p, Spots& spots) const {
  if (background_W_[p] == 0.0) return;
  const double share = spots.power_W[p] / (spots.power_W[p] + background_W_[p]);
  spots.uv_m[2 * p] *= share;
  spots.uv_m[2 * p + 1] *= share;
}

/// Moves the spots to where they are with the lengths as they have grown.
void Light::Warm(const optics::PsdSignals& cold, const Pose& X_LG, const LightState& light, Spots& spots) const {
  for (std::size_t p = 0; p < 2; ++p) spots.uv_m[2 * p + 1] -= post_growth_m_K_[p] * light.above_K;
  if (!warm_optics_) return;
  const optics::PsdSignals warm = warm_optics_->Trace(X_LG, SourceOf(light));
  const double share = light.above_K / kWarm_K;
  spots.uv_m[0] += share * (warm.a.u_m - cold.a.u_m);
  spots.uv_m[1] += share * (warm.a.v_m - cold.a.v_m);
  spots.uv_m[2] += share * (warm.b.u_m - cold.b.u_m);
  spots.uv_m[3] += share * (warm.b.v_m - cold.b.v_m);
}

void Light::WriteIrradiance(const std::string& path, const Pose& X_LG, const LightState& light) const {
  try {
    optics::WriteIrradianceMaps(path, optics_.Irradiance(X_LG, SourceOf(light), kIrradiancePixels));
  } catch (const std::runtime_error& error) {
    throw BenchError(error.what());
  }
}

}  // namespace twinbench::sim
