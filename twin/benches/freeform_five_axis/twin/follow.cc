#include "twin/benches/freeform_five_axis/twin/twin.h"

#include <utility>

#include "twin/core/time.h"
#include "twin/sim/pointwise_follow.h"

namespace twinbench::sim {
namespace {

using FreeformPoint = BenchPoint<FreeformExtra>;

model::Point PointOf(const std::string& name, bool is_rotation) {
  if (is_rotation) return {name, "arcsec", units::arcsec, units::arcsec};
  return {name, "um", units::um, units::um};
}

template <std::size_t kIndex>
double& MachineError(FreeformExtra& e) {
  return e.machine.body[kIndex / kBodyErrors][kIndex % kBodyErrors];
}
template <std::size_t kIndex>
double& SquarenessError(FreeformExtra& e) {
  return e.machine.squareness_rad[kIndex];
}
template <std::size_t kIndex>
double& MountingError(FreeformExtra& e) {
  return e.mounting[kIndex];
}

std::string MachineErrorName(std::size_t index) {
  return std::string(kAxisNames[index / kBodyErrors]) + "." + kBodyErrorNames[index % kBodyErrors];
}

template <std::size_t... kIndex>
std::vector<FreeformPoint> OfMachine(std::index_sequence<kIndex...>) {
  return {{PointOf(MachineErrorName(kIndex), IsRotation(kIndex % kBodyErrors)), MachineError<kIndex>}...};
}
template <std::size_t... kIndex>
std::vector<FreeformPoint> OfSquareness(std::index_sequence<kIndex...>) {
  return {{PointOf(kSquarenessNames[kIndex], true), SquarenessError<kIndex>}...};
}
template <std::size_t... kIndex>
std::vector<FreeformPoint> OfMountings(std::index_sequence<kIndex...>) {
  return {{PointOf(std::string("mount.") + kBodyErrorNames[kIndex], IsRotation(kIndex)), MountingError<kIndex>}...};
}

std::vector<FreeformPoint> OfProbe() {
  using E = FreeformExtra;
  return {{{"spot.x", "um", units::um, units::um}, [](E& e) -> double& { return e.spot_m.x(); }},
          {{"spot.y", "um", units::um, units::um}, [](E& e) -> double& { return e.spot_m.y(); }},
          {{"cell.height", "um", units::um, units::um}, [](E& e) -> double& { return e.cell_height_m; }},
          {{"qpd_x", "V", 1.0, 1e-3}, [](E& e) -> double& { return e.qpd_x_V; }},
          {{"qpd_y", "V", 1.0, 1e-3}, [](E& e) -> double& { return e.qpd_y_V; }},
          {{"ccd", "px", 1.0, 1e-3}, [](E& e) -> double& { return e.ccd_px; }}};
}

const std::vector<FreeformPoint>& FreeformPoints() {
  static const std::vector<FreeformPoint> points = [] {
    std::vector<FreeformPoint> all = OfMachine(std::make_index_sequence<kMachineAxes * kBodyErrors>());
    for (const auto& part : {OfSquareness(std::make_index_sequence<kSquarenesses>()),
                             OfMountings(std::make_index_sequence<kBodyErrors>()), OfProbe()})
      all.insert(all.end(), part.begin(), part.end());
    return all;
  }();
  return points;
}

class FreeformFollow : public PointwiseFollow<FreeformExtra> {
 public:
  FreeformFollow(const Scenario& stated, const std::vector<Reading>& its_record)
      : PointwiseFollow(Foreseeable(stated, its_record), its_record, FreeformPoints()) {
    if (!record().empty()) run_s_ = ToSeconds(record().back().time);
  }

  std::vector<std::string> Unfixed() const override {
    return {"errors of the machine beyond those stated, and how the artefact stands in each mounting: free"};
  }

 protected:
  Eigen::MatrixXd Shown(const std::vector<FreeformExtra>& extra) const override {
    FreeformTwin twin(scenario(), {FreeformOf(scenario()).machine, {}},
                      LightAsked::kQuickly);  // its effects have memories
    Eigen::MatrixXd shown(std::ssize(extra), 3);
    for (std::size_t i = 0; i < extra.size(); ++i) {
      const double share = run_s_ > 0.0 ? ToSeconds(record()[i].time) / run_s_ : 0.0;
      const ProbeSignals signals = twin.Show(record()[i], share, extra[i]);
      shown.row(static_cast<Eigen::Index>(i)) << signals.qpd_x_V, signals.qpd_y_V, signals.ccd_px;
    }
    return shown;
  }

  std::unique_ptr<model::Follow> On(const Scenario& changed) const override {
    return std::make_unique<FreeformFollow>(changed, record());
  }

 private:
  double run_s_ = 0.0;
};

}  // namespace

std::unique_ptr<model::Follow> FollowFreeform(const Scenario& scenario, const std::vector<Reading>& record) {
  return std::make_unique<FreeformFollow>(scenario, record);
}

}  // namespace twinbench::sim
