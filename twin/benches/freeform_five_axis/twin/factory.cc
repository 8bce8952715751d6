#include "twin/benches/freeform_five_axis/twin/factory.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/benches/freeform_five_axis/columns.h"
#include "twin/benches/freeform_five_axis/procedure.h"
#include "twin/benches/freeform_five_axis/twin/follow.h"
#include "twin/benches/freeform_five_axis/twin/twin.h"
#include "twin/core/run_record.h"
#include "twin/core/stream.h"
#include "twin/procedure/options.h"
#include "twin/sim/environment.h"
#include "twin/sim/silence.h"

namespace twinbench::benches::freeform {
namespace {

class Twin : public BenchTwin {
 public:
  explicit Twin(const Scenario& scenario) : scenario_(scenario), twin_(scenario, sim::Draw(scenario)) {
    if (scenario_.noise_free) sim::Silence(scenario_.environment);
  }

  nlohmann::json Truth() const override { return sim::FreeformTruth(scenario_, twin_.drawn()); }

  void CarryOut(RunRecord& record, const procedure::ProgressCallback& progress) override {
    sim::Environment room(scenario_.environment, scenario_.seed);
    const std::vector<Reading> schedule = procedure::FreeformSchedule(scenario_);
    constexpr std::size_t kTogether = 50;  // five minutes of the bench; a transaction takes milliseconds
    std::vector<Reading> taken;
    for (Reading reading : schedule) {
      Take(room, schedule.back().time, reading);
      taken.push_back(reading);
      if (taken.size() < kTogether && reading.reading != schedule.back().reading) continue;
      record.AppendAll(taken);
      if (progress) progress({reading.reading + 1, static_cast<int>(schedule.size()), reading.phase, reading.time});
      taken.clear();
    }
  }

 private:
  void Take(sim::Environment& room, Time last, Reading& reading) {
    const double run_s = ToSeconds(last);
    reading.temperature_degC = room.Temperature_degC(reading.time);
    const sim::ProbeSignals shown = twin_.Show(reading, run_s > 0.0 ? ToSeconds(reading.time) / run_s : 0.0);
    reading.temperature_degC = room.Measure_degC(reading.time);
    const FreeformSettings& own = FreeformOf(scenario_);
    kQpdX_V(reading) = shown.qpd_x_V + own.qpd.noise_V * Noise("qpd_x.noise", reading);
    kQpdY_V(reading) = shown.qpd_y_V + own.qpd.noise_V * Noise("qpd_y.noise", reading);
    kQpdSum_V(reading) = shown.qpd_sum_V + own.qpd.noise_V * Noise("qpd_sum.noise", reading);
    if (!std::isfinite(shown.ccd_px)) reading.status = ReadingStatus::kNoLight;
    kCcd_px(reading) = shown.ccd_px + own.ccd.noise_px * Noise("ccd.noise", reading);
  }

  /// It follows from the reading's number alone.
  double Noise(const char* cause, const Reading& reading) const {
    if (scenario_.noise_free) return 0.0;
    Stream stream(scenario_.seed, cause);
    stream.Seek(static_cast<std::uint64_t>(reading.reading));
    return stream.Normal();
  }

  Scenario scenario_;
  sim::FreeformTwin twin_;
};

}  // namespace

std::unique_ptr<BenchTwin> MakeTwin(const Scenario& scenario) {
  return std::make_unique<Twin>(scenario);
}

std::unique_ptr<model::Follow> FollowRecord(const Scenario& scenario, const std::vector<Reading>& record) {
  return sim::FollowFreeform(scenario, record);
}

}  // namespace twinbench::benches::freeform
