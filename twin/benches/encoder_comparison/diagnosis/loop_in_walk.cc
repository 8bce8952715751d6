#include "twin/benches/encoder_comparison/diagnosis/loop_in_walk.h"

#include "twin/benches/encoder_comparison/diagnosis/means.h"

namespace twinbench::diagnose::encoder {
namespace {

constexpr double kVeryStrongly = 6.0;  // log Bayes factor; Kass and Raftery, Bayes factors (1995)

}  // namespace

std::vector<LargeCause> LoopsInWalk(const Searched& searched, const Projector& projector) {
  const LinearRun& run = searched.encoder.run;
  const std::vector<double> steps = MeansOf(run.residual, run.schedule.setup, kInMean).Steps();
  std::vector<LargeCause> loops;
  for (const Family& family : searched.families) {
    if (family.kind != Kind::kNamed || !IsLoop(family.effect)) continue;
    int place = -1;
    double most = kVeryStrongly;
    for (int g = 0; g < family.grid; ++g) {
      const double evidence = EvidenceOfSteps(steps, MeansOf(family.ColumnsAt(g).col(0), run.schedule.setup, kInMean).Steps());
      if (evidence <= most) continue;
      most = evidence;
      place = g;
    }
    if (place >= 0) loops.push_back(LedBy({CauseFrom(family, place, run.residual, run.sigma, projector)}, 0, run.bench));
  }
  return loops;
}

bool IsSeenInWalk(const Eigen::VectorXd& left, const Eigen::VectorXd& shown, const std::vector<int>& setup) {
  return EvidenceOfSteps(MeansOf(left + shown, setup, kInMean).Steps(), MeansOf(shown, setup, kInMean).Steps()) > kVeryStrongly;
}

}  // namespace twinbench::diagnose::encoder
