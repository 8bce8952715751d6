#include "twin/sim/follow_bench.h"

#include <map>

#include "twin/core/errors.h"
#include "twin/sim/encoder/follow.h"
#include "twin/sim/hob/follow.h"
#include "twin/sim/rotary_follow.h"
#include "twin/sim/turntable/follow.h"

namespace twinbench::sim {
namespace {

using Maker = std::unique_ptr<model::Follow> (*)(const Scenario&, const std::vector<Reading>&);

const std::map<std::string, Maker>& Makers() {
  static const std::map<std::string, Maker> makers = {{kRotaryBench, FollowRotary},
                                                     {kEncoderBench, FollowEncoder},
                                                     {kTurntableBench, FollowTurntable},
                                                     {kHobBench, FollowHob}};
  return makers;
}

}  // namespace

bool CanFollow(const Scenario& scenario) {
  return Makers().contains(scenario.bench);
}

std::unique_ptr<model::Follow> FollowBench(const Scenario& scenario, const std::vector<Reading>& record) {
  const auto found = Makers().find(scenario.bench);
  Require(found != Makers().end(), "the bench's twin cannot follow a record");
  return found->second(scenario, record);
}

}  // namespace twinbench::sim
