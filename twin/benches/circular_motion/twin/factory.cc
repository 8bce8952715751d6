#include "twin/benches/circular_motion/twin/factory.h"

#include <nlohmann/json.hpp>

#include "twin/benches/circular_motion/twin/follow.h"
#include "twin/benches/circular_motion/twin/live.h"
#include "twin/core/run_record.h"
#include "twin/procedure/options.h"

namespace twinbench::benches::circular {
namespace {

class Twin : public BenchTwin {
 public:
  explicit Twin(const Scenario& scenario) : run_(scenario) {}
  nlohmann::json Truth() const override { return run_.Truth(); }

  void CarryOut(RunRecord& record, const procedure::ProgressCallback& progress) override {
    constexpr int kTogether = 256;  // in motion readings come too fast to be waited for one by one
    std::vector<Reading> taken;
    for (int k = 0; k < run_.Readings(); ++k) {
      taken.push_back(run_.Take(k));
      if (taken.size() < kTogether && k + 1 < run_.Readings()) continue;
      record.AppendAll(taken);
      if (progress) progress({k + 1, run_.Readings(), taken.back().phase, taken.back().time});
      taken.clear();
    }
  }

 private:
  sim::CircleRun run_;
};

}  // namespace

std::unique_ptr<BenchTwin> MakeTwin(const Scenario& scenario) {
  return std::make_unique<Twin>(scenario);
}

std::unique_ptr<model::Follow> FollowRecord(const Scenario& scenario, const std::vector<Reading>& record) {
  return sim::FollowCircles(scenario, record, std::make_shared<sim::BodiesOnce>());
}

model::FollowMaker FollowOften() {
  return
      [bodies = std::make_shared<sim::BodiesOnce>()](const Scenario& scenario, const std::vector<Reading>& record) {
        return sim::FollowCircles(scenario, record, bodies);
      };
}

}  // namespace twinbench::benches::circular
