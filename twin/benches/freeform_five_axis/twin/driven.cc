#include "twin/benches/freeform_five_axis/twin/twin.h"

#include <algorithm>
#include <cmath>

#include "twin/benches/freeform_five_axis/columns.h"
#include "twin/benches/freeform_five_axis/procedure.h"
#include "twin/benches/freeform_five_axis/twin/chain.h"
#include "twin/core/happened_once.h"
#include "twin/core/stream.h"
#include "twin/sim/environment.h"
#include "twin/sim/silence.h"

namespace twinbench::sim {
namespace {

using namespace benches::freeform;

constexpr double kSamePlace = 1e-9;  // m or rad
constexpr double kRoomBeyond = 1.5;  // of half the travel over which errors are stated

Scenario WithItsRoom(Scenario scenario) {
  if (scenario.noise_free) Silence(scenario.environment);
  return scenario;
}

class FreeformPhysics : public DrivenPhysics {
 public:
  explicit FreeformPhysics(const Scenario& scenario)
      : begun_(WithItsRoom(scenario)), scenario_(begun_), plan_(procedure::FreeformSchedule(scenario)) {
    for (int axis = 0; axis < kMachineAxes; ++axis)
      axes_.push_back({kAxisNames[static_cast<std::size_t>(axis)], IsRotaryAxis(axis)});
    Restart();
  }

  const std::vector<MachineAxis>& Axes() const override { return axes_; }
  int Setups() const override { return static_cast<int>(own().freeform_procedure.mounts.size()); }

  /// Wide enough for the plan, whatever it is.
  std::vector<AxisLimits> Travel() const override {
    std::vector<AxisLimits> travel(kMachineAxes);
    for (std::size_t k = 0; k < kMachineAxes; ++k) {
      const double centre = own().machine.centre[k], half = kRoomBeyond * own().machine.half[k];
      travel[k] = {.lower = centre - half, .upper = centre + half};
      for (const Reading& r : plan_) {
        travel[k].lower = std::min(travel[k].lower, kCommanded[k](r));
        travel[k].upper = std::max(travel[k].upper, kCommanded[k](r));
      }
    }
    return travel;
  }

  std::vector<double> Start() const override { return PlaceOf(plan_.front()); }

  std::optional<Time> Planned(const DrivenInstant& at) const override {
    if (at.sample >= static_cast<int>(plan_.size())) return std::nullopt;
    const Reading& planned = plan_[static_cast<std::size_t>(at.sample)];
    bool same = planned.setup == at.setup && at.feed_m_s == 0.0;
    for (std::size_t k = 0; k < kMachineAxes; ++k)
      same = same && std::abs(kCommanded[k](planned) - at.commanded[k]) <= kSamePlace;
    return same ? std::optional(planned.time) : std::nullopt;
  }

  Reading Show(const DrivenInstant& at) override {
    const bool planned = Planned(at).has_value();
    Reading r = planned ? plan_[static_cast<std::size_t>(at.sample)] : BesidePlan(at);
    r.time = at.time;
    r.temperature_degC = room_->Temperature_degC(r.time);
    const double run_s = ToSeconds(plan_.back().time);
    const ProbeSignals shown = twin_->Show(r, run_s > 0.0 ? ToSeconds(r.time) / run_s : 0.0);
    r.temperature_degC = room_->Measure_degC(r.time);
    kQpdX_V(r) = shown.qpd_x_V + own().qpd.noise_V * Noise("qpd_x.noise", r);
    kQpdY_V(r) = shown.qpd_y_V + own().qpd.noise_V * Noise("qpd_y.noise", r);
    kQpdSum_V(r) = shown.qpd_sum_V + own().qpd.noise_V * Noise("qpd_sum.noise", r);
    kCcd_px(r) = shown.ccd_px + own().ccd.noise_px * Noise("ccd.noise", r);
    if (!std::isfinite(shown.qpd_sum_V) || !std::isfinite(shown.ccd_px)) r.status = ReadingStatus::kNoLight;
    return r;
  }

  void Restart() override {
    room_ = std::make_unique<Environment>(scenario_.environment, scenario_.RunSeed());
    twin_ = std::make_unique<FreeformTwin>(scenario_, Draw(scenario_));
  }
  void BeRun(int repeat) override { scenario_ = InRun(begun_, repeat); }

 private:
  const FreeformSettings& own() const { return FreeformOf(scenario_); }

  static std::vector<double> PlaceOf(const Reading& r) {
    std::vector<double> place;
    for (const Quantity& axis : kCommanded) place.push_back(axis(r));
    return place;
  }

  /// At another planned place of the mounting the plan says which cell it is: near a rim the beam may meet another first.
  Reading BesidePlan(const DrivenInstant& at) const {
    const auto is_there = [&](const Reading& p) {
      const std::vector<double> place = PlaceOf(p);
      bool same = p.setup == at.setup;
      for (std::size_t k = 0; k < kMachineAxes; ++k) same = same && std::abs(place[k] - at.commanded[k]) <= kSamePlace;
      return same;
    };
    const auto planned = std::ranges::find_if(plan_, is_there);
    Reading r;
    r.reading = at.sample;
    r.setup = at.setup;
    r.direction = at.direction;
    for (std::size_t k = 0; k < kMachineAxes; ++k) kCommanded[k](r) = at.commanded[k];
    const Eigen::Vector2i cell = CellUnderBeam(at);
    if (planned != plan_.end()) return kCellI(r) = kCellI(*planned), kCellJ(r) = kCellJ(*planned), r;
    kCellI(r) = cell.x();
    kCellJ(r) = cell.y();
    return r;
  }

  /// Where the ideal machine's beam meets the plane of the vertices. Beyond the array it is the cell at its rim:
  /// its paraboloid goes on.
  Eigen::Vector2i CellUnderBeam(const DrivenInstant& at) const {
    MachineCommand command{};
    std::ranges::copy(at.commanded, command.begin());
    const MountSettings& mount = own().freeform_procedure.mounts[static_cast<std::size_t>(at.setup)];
    const Pose X_FT = (X_MS(command, {}) * X_SF(mount, {})).inverse() * X_MT(command, {}, own().machine.pivot_m);
    const Vector3 tip = X_FT.translation(), beam = -X_FT.linear().col(2);
    const Vector3 met = tip - tip.z() / beam.z() * beam;
    const auto cell = [&](double place_m) {
      return std::clamp(static_cast<int>(std::lround(place_m / own().artefact.pitch_m)), -own().artefact.cells,
                        own().artefact.cells);
    };
    return {cell(met.x()), cell(met.y())};
  }

  /// It follows from the reading's number alone.
  double Noise(const char* cause, const Reading& reading) const {
    if (scenario_.noise_free) return 0.0;
    Stream stream(scenario_.RunSeed(), cause);
    stream.Seek(static_cast<std::uint64_t>(reading.reading));
    return stream.Normal();
  }

  Scenario begun_, scenario_;  // as it is, in the run that it makes
  std::vector<Reading> plan_;
  std::vector<MachineAxis> axes_;
  std::unique_ptr<Environment> room_;
  std::unique_ptr<FreeformTwin> twin_;
};

}  // namespace

std::unique_ptr<DrivenPhysics> MakeFreeformPhysics(const Scenario& scenario) {
  return std::make_unique<FreeformPhysics>(scenario);
}

}  // namespace twinbench::sim
