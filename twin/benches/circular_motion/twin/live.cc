#include "twin/benches/circular_motion/twin/live.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/benches/circular_motion/procedure.h"
#include "twin/core/scenario_schema.h"
#include "twin/core/stream.h"
#include "twin/sim/truth.h"

namespace twinbench::sim {
namespace {

using namespace benches::circular;

Environment RoomOf(const Scenario& scenario) {
  return {scenario.environment, scenario.RunSeed()};
}

/// With the room's temperature, as the bench's thermometer shows it.
Reading FeltIn(Environment& room, Reading r, bool noise_free) {
  r.temperature_degC = noise_free ? room.Temperature_degC(r.time) : room.Measure_degC(r.time);
  return r;
}

std::vector<Reading> CourseOf(const Scenario& scenario) {
  std::vector<Reading> course = WithAngles(procedure::CircleSchedule(CircularOf(scenario).procedure));
  Environment room = RoomOf(scenario);
  for (Reading& r : course) r = FeltIn(room, std::move(r), scenario.noise_free);
  return course;
}

Eigen::VectorXd Above_K(const Scenario& scenario, const std::vector<Reading>& course) {
  Environment room = RoomOf(scenario);
  Eigen::VectorXd above_K(std::ssize(course));
  for (std::size_t i = 0; i < course.size(); ++i)
    above_K[static_cast<Eigen::Index>(i)] = room.AboveReference_K(course[i].time);
  return above_K;
}

/// What every set-up draws anew.
std::vector<CircleExtra> MountedOf(const Scenario& scenario) {
  const CircularSettings& s = CircularOf(scenario);
  Stream stream(scenario.seed, "circular.mounting");
  const auto draw = [&](double half_width) { return half_width * (2.0 * stream.Uniform() - 1.0); };
  std::vector<CircleExtra> mounted;
  for (const CircularSetup& setup : s.procedure.setups) {
    CircleExtra& m = mounted.emplace_back();
    const double offset_m = setup.IsDrive() ? 0.0 : s.mounting.offset_m;
    m.offset_x_m = draw(offset_m);
    m.offset_y_m = draw(offset_m);
    m.rotation_rad = draw(setup.IsBar() ? s.mounting.zero_rad : setup.IsDrive() ? 0.0 : s.mounting.grid_rotation_rad);
    m.length_m = draw(setup.ShowsAngle() ? s.mounting.length_m : 0.0);
  }
  return mounted;
}

double Quantised(double value, double step) {
  return step > 0.0 ? step * std::round(value / step) : value;
}

/// What the instrument shows of a deviation.
void Show(const Deviation& shown, const CircularSetup& setup, Reading& r) {
  const double radius_m = Radius_m(r), c = std::cos(r.target_rad), s = std::sin(r.target_rad);
  if (setup.IsBar()) {
    kBar_m(r) = shown.radial_m;
    if (setup.ShowsAngle()) kEncoder_rad(r) = r.target_rad + shown.tangential_m / radius_m;
    return;
  }
  kGridX_m(r) = kCommandedX_m(r) + c * shown.radial_m - s * shown.tangential_m;
  kGridY_m(r) = kCommandedY_m(r) + s * shown.radial_m + c * shown.tangential_m;
}

}  // namespace

CircleRun::CircleRun(const Scenario& scenario)
    : scenario_(scenario),
      course_(CourseOf(scenario)),
      above_K_(Above_K(scenario, course_)),
      twin_(scenario, course_, above_K_, bodies_),
      mounted_(MountedOf(scenario)) {
  for (const EffectSettings& effect : scenario.effects) {
    if (effect.name == "outliers") outliers_.emplace_back(effect, scenario.RunSeed());
  }
}

const CircularSetup& CircleRun::SetupOf(const Reading& r) const {
  return CircularOf(scenario_).procedure.setups[static_cast<std::size_t>(r.setup)];
}

/// The mounting, and chance where there is any.
CircleExtra CircleRun::Chance(const Reading& r) const {
  CircleExtra extra = mounted_[static_cast<std::size_t>(r.setup)];
  if (scenario_.noise_free) return extra;
  const CircularSettings& s = CircularOf(scenario_);
  Stream stream(scenario_.RunSeed(), "circular.noise");
  stream.Seek(2 * static_cast<std::uint64_t>(r.reading));  // a block has two normal numbers
  const bool is_bar = SetupOf(r).IsBar();
  extra.x_m = s.machine.noise_m * stream.Normal();
  extra.y_m = s.machine.noise_m * stream.Normal();
  extra.radial_m = (is_bar ? s.bar.noise_m : s.grid.noise_m) * stream.Normal();
  extra.tangential_m = (is_bar ? Radius_m(r) * s.encoder.noise_rad : s.grid.noise_m) * stream.Normal();
  for (const OutlierDraw& outliers : outliers_) {
    const OutlierDraw::Drawn drawn = outliers.At(r.reading);
    (drawn.uniform < 0.5 ? extra.radial_m : extra.tangential_m) += drawn.size;
  }
  return extra;
}

Deviation CircleRun::Digitised(const Reading& r, Deviation shown) const {
  if (scenario_.noise_free || !SetupOf(r).IsBar()) return shown;
  const CircularSettings& s = CircularOf(scenario_);
  const double step_rad = units::turn / s.encoder.lines / s.encoder.interpolation;
  const double angle_rad = r.target_rad + shown.tangential_m / Radius_m(r);
  shown.radial_m = Quantised(shown.radial_m, s.bar.resolution_m);
  shown.tangential_m = Radius_m(r) * (Quantised(angle_rad, step_rad) - r.target_rad);
  return shown;
}

Reading CircleRun::Shown(const Reading& r, const CircleTwin& twin, std::size_t at) const {
  Reading shown = r;
  Show(Digitised(r, twin.At(at, Chance(r))), SetupOf(r), shown);
  return shown;
}

Reading CircleRun::Take(int reading) const {
  const auto i = static_cast<std::size_t>(reading);
  return Shown(course_[i], twin_, i);
}

Environment CircleRun::Room() const {
  return RoomOf(scenario_);
}

Reading CircleRun::Felt(Reading r, Environment& room) const {
  return FeltIn(room, std::move(r), scenario_.noise_free);
}

CircleTwin CircleRun::TwinOf(const std::vector<Reading>& course, BodiesOnce& bodies) const {
  return {scenario_, course, Above_K(scenario_, course), bodies};
}

namespace {

/// With bodies: in the words of the closed form, as far as these say it. Behind a reversal bodies follow a curve of
/// their own: what they lose and lag depends on the feed, and no one number of either is true to an uncertainty ("nearly").
void TakeFromDrives(const FeedDrivesSettings& drives, nlohmann::json& truth) {
  const DrivesInClosedForm form = InClosedForm(drives);
  nlohmann::json& errors = truth["errors"];
  for (std::size_t k = 0; k < 2; ++k) {
    const std::string axis = k == 0 ? "x" : "y";
    const std::string lag = "machine.lag_" + axis + "_s", backlash = "machine.backlash_" + axis + "_um";
    errors[lag] = form.lag_s[k];
    errors[backlash] = form.backlash_m[k] / units::um;
    errors.erase("machine.spike_" + axis + "_um");
    for (const std::string& key : {lag, backlash}) truth["nearly"].push_back(key);
  }
}

/// Every number of the bench's own tables, by its key.
nlohmann::json Errors(Scenario scenario) {
  nlohmann::json errors = nlohmann::json::object();
  for (const ScenarioKey& key : KeysOf(scenario)) {
    const auto* const* number = std::get_if<double*>(&key.field);
    if (number && (key.table == "machine" || key.table == "bar" || key.table == "encoder" || key.table == "grid"))
      errors[key.Path()] = **number / key.unit.to_SI;
  }
  return errors;
}

nlohmann::json SetupJson(int number, const CircularSetup& setup, const CircularSettings& s, const CircleExtra& m) {
  using units::um;
  const bool is_bar = setup.IsBar();
  const AxisPair& offset_m = is_bar ? s.bar.offset_m : s.grid.offset_m;
  nlohmann::json json = {{"setup", number},
                         {"instrument", setup.instrument},
                         {"radius_mm", setup.radius_m / units::mm},
                         {"offset_x_um", (offset_m[0] + m.offset_x_m) / um},
                         {"offset_y_um", (offset_m[1] + m.offset_y_m) / um}};
  if (is_bar) {
    if (setup.ShowsAngle()) json["encoder_zero_deg"] = (s.encoder.zero_rad + m.rotation_rad) / units::deg;
    json["length_error_um"] = (s.bar.length_error_m + m.length_m) / um;
  } else {
    json["rotation_arcsec"] = (s.grid.rotation_rad + m.rotation_rad) / units::arcsec;
  }
  return json;
}

}  // namespace

nlohmann::json CircleRun::Truth() const {
  const CircularSettings& s = CircularOf(scenario_);
  nlohmann::json json = {{"errors", Errors(scenario_)},
                         {"setups", nlohmann::json::array()},
                         {"path", nlohmann::json::array()},
                         {"effects", ToJson(scenario_.effects)},
                         {"seed", scenario_.seed}};
  if (s.mechanics.HasBodies()) TakeFromDrives(s.drives, json);
  for (std::size_t k = 0; k < mounted_.size(); ++k)
    json["setups"].push_back(SetupJson(static_cast<int>(k), s.procedure.setups[k], s, mounted_[k]));
  for (std::size_t i = 0; i < course_.size(); ++i) {
    const Reading& r = course_[i];
    if (json["path"].empty() || json["path"].back()["setup"] != r.setup || json["path"].back()["pass"] != r.pass)
      json["path"].push_back({{"setup", r.setup}, {"pass", r.pass}});
    nlohmann::json& path = json["path"].back();
    const Eigen::Vector2d p_m = twin_.Position_m(i);
    path["commanded_deg"].push_back(r.target_rad / units::deg);
    path["dx_um"].push_back((p_m.x() - kCommandedX_m(r)) / units::um);
    path["dy_um"].push_back((p_m.y() - kCommandedY_m(r)) / units::um);
  }
  return json;
}

}  // namespace twinbench::sim
