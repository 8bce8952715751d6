#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "twin/benches/freeform_five_axis/bench.h"
#include "twin/benches/freeform_five_axis/displacement_results.h"
#include "twin/benches/freeform_five_axis/evaluated.h"
#include "twin/benches/freeform_five_axis/settings.h"
#include "twin/benches/freeform_five_axis/tables.h"
#include "twin/report/json_units.h"

namespace twinbench::benches::freeform {
namespace {

using namespace estimators;

/// Machine and mountings of a truth, as unknowns.
Eigen::VectorXd TruthOf(const nlohmann::json& truth, const Identification& found) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(found.unknowns.size());
  const nlohmann::json& machine = truth.at("machine");
  for (int axis = 0; axis < kMachineAxes; ++axis) {
    for (int error = 0; error < kBodyErrors; ++error) {
      const std::string name = std::string(kAxisNames[static_cast<std::size_t>(axis)]) + "." +
                               kBodyErrorNames[static_cast<std::size_t>(error)];
      for (int term = 0; term < kCubicTerms; ++term)
        x[CubicAt(axis, error, term)] =
            machine.at("errors").at(name).at("coefficients").at(static_cast<std::size_t>(term)).get<double>();
    }
  }
  for (int k = 0; k < kSquarenesses; ++k)
    x[SquarenessAt(k)] =
        machine.at("squareness_arcsec").at(kSquarenessNames[static_cast<std::size_t>(k)]).get<double>();
  for (int setup = 0; setup < found.setups; ++setup) {
    const nlohmann::json& mounting = truth.at("mountings").at(static_cast<std::size_t>(setup));
    for (int error = 0; error < kBodyErrors; ++error)
      x[MountingAt(setup, error)] = mounting
                                        .at(std::string(kBodyErrorNames[static_cast<std::size_t>(error)]) +
                                            (IsRotation(error) ? "_arcsec" : "_um"))
                                        .get<double>();
  }
  return x;
}

/// What the estimate and the truth differ by in the readings, over their noise: squares as many as are identified.
double Chi2OverRank(const FreeformSettings& bench, const std::vector<PoseRead>& seen, const Identification& found,
                    const Eigen::VectorXd& truth) {
  const Eigen::Vector3d noise(bench.qpd.noise_V, bench.qpd.noise_V, bench.ccd.noise_px);
  double chi2 = 0.0;
  for (const PoseRead& pose : seen) {
    const Eigen::Vector3d off =
        Predicted(bench, pose, InputsAt(pose, found.unknowns)) - Predicted(bench, pose, InputsAt(pose, truth));
    chi2 += off.cwiseQuotient(noise).squaredNorm();
  }
  return chi2 / static_cast<double>(found.rank);
}

/// Deviation over u of the unknowns that the readings decide, rms.
double PullsOf(const Identification& found, const Eigen::VectorXd& truth) {
  double sum = 0.0;
  int count = 0;
  for (int k = 0; k < kOfMachine; ++k) {
    if (!found.identified[static_cast<std::size_t>(k)]) continue;
    sum += std::pow((found.unknowns[k] - truth[k]) / found.u[k], 2);
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : kNaN;
}

/// What the machine errs at some poses and what the estimate leaves of it, best rigid motion taken out.
struct Compensated {
  Eigen::Matrix3Xd actual_um;
  VolumetricErrors left;
};

/// Published: with what the equations are wrong by in the uncertainty.
VolumetricErrors PredictBy(const FreeformSettings& bench, const std::vector<PoseRead>& seen,
                           const std::vector<PoseRead>& poses, const Identification& found, Estimator estimator) {
  if (estimator == Estimator::kPublished)
    return PredictPublished(bench, poses, found, Identify(bench, seen)).errors;
  return PredictErrors(bench, poses, found, estimator);
}

/// @param estimated  At these poses.
Compensated CompensatedAt(const FreeformSettings& bench, const std::vector<PoseRead>& poses, const VolumetricErrors& estimated,
                          const Eigen::VectorXd& truth) {
  Compensated at{{}, estimated};
  const Eigen::Matrix3Xd& nominal = at.left.nominal_um;
  at.actual_um = WithoutRigidMotion(nominal, Tips_um(bench, poses, truth, Estimator::kRigorous) - nominal);
  at.left.error_um = WithoutRigidMotion(nominal, at.actual_um - at.left.error_um);
  return at;
}

/// The first poses, one by one: `error_um` of `left` is actual less estimated.
std::vector<report::ScoredValue> ValuesOf(const Compensated& at) {
  constexpr Eigen::Index kPoses = 100;
  std::vector<report::ScoredValue> values;
  for (Eigen::Index k = 0; k < std::min(kPoses, at.actual_um.cols()); ++k) {
    for (Eigen::Index c = 0; c < 3; ++c)
      values.push_back({fmt::format("error_map.{}_um[{}]", std::array{"dx", "dy", "dz"}[static_cast<std::size_t>(c)], k),
                        at.actual_um(c, k) - at.left.error_um(c, k), at.left.u_um(c, k), at.actual_um(c, k)});
  }
  return values;
}

/// On grids over X, Y and Z: before, and after.
struct ScoredGrids {
  nlohmann::json json = nlohmann::json::array();
  std::string text;
};

ScoredGrids ScoreGrids(const FreeformSettings& bench, const std::vector<PoseRead>& seen,
                       const Identification& found, const Eigen::VectorXd& truth, Estimator estimator) {
  const std::vector<Grid> grids = GridsOf(seen, bench, kGridNodes);
  const std::vector<PoseRead> poses = PosesOnGrids(grids);
  const Compensated all = CompensatedAt(bench, poses, PredictErrorsAlone(bench, poses, found, estimator), truth);
  ScoredGrids scored;
  Eigen::Index from = 0;
  for (const Grid& grid : grids) {
    const auto columns = Eigen::seqN(from, std::ssize(grid.poses));
    const double before = RmsLength(all.actual_um(Eigen::all, columns));
    const double left = RmsLength(all.left.error_um(Eigen::all, columns));
    const double a_deg = grid.a_rad / units::deg, b_deg = grid.b_rad / units::deg;
    scored.json.push_back({{"a_deg", a_deg}, {"b_deg", b_deg}, {"machine_rms", before}, {"left_rms", left}});
    scored.text += fmt::format("on a grid at A {:.2f}, B {:.2f} deg: {:.3f} um before, {:.3f} um left, rms\n",
                               a_deg, b_deg, before, left);
    from += std::ssize(grid.poses);
  }
  return scored;
}

}  // namespace

report::ScoredRun ScoreOf(const FreeformSettings& bench, const std::vector<PoseRead>& seen, const Identification& found,
                          const nlohmann::json& truth, Estimator estimator) {
  constexpr int kPoses = 1000;
  const std::vector<PoseRead> unseen = UnseenPoses(seen, bench, kPoses);
  const Eigen::VectorXd true_x = TruthOf(truth, found);
  const Compensated at = CompensatedAt(bench, unseen, PredictBy(bench, seen, unseen, found, estimator), true_x);
  const Eigen::Matrix3Xd& actual = at.actual_um;
  const VolumetricErrors& left = at.left;
  const ScoredGrids grids = ScoreGrids(bench, seen, found, true_x, estimator);
  const double pulls = PullsOf(found, true_x), most = left.error_um.colwise().norm().maxCoeff();
  return {
      {{"volumetric_um",
        {{"machine_rms", RmsLength(actual)},
         {"left_rms", RmsLength(left.error_um)},
         {"left_max", most},
         {"u_rms", RmsLength(left.u_um)}}},
       {"volumetric_grid_um", grids.json},
       {"identified_pull_rms", report::In(1.0, pulls)},
       {"chi2_over_rank", report::In(1.0, Chi2OverRank(bench, seen, found, true_x))},
       {"poses", unseen.size()}},
      fmt::format("volumetric error at {} poses that the run had not, best rigid motion taken out\n"
                  "of the machine         {:.3f} um rms\nleft by the estimate   {:.3f} um rms, {:.3f} um at "
                  "most; noise explains {:.3f} um rms\n"
                  "what is identified by itself is off by {:.2f} of its uncertainty, rms\n",
                  unseen.size(), RmsLength(actual), RmsLength(left.error_um), most, RmsLength(left.u_um), pulls) +
          grids.text,
      VolumetricCsv(unseen, left), ValuesOf(at)};
}

report::ScoredRun ScoreRun(const Scenario& scenario, const std::vector<Reading>& readings,
                           const nlohmann::json& truth, Estimator estimator) {
  RefuseDisplacements(scenario, "truth");
  const FreeformSettings& bench = FreeformOf(scenario);
  const std::vector<PoseRead> seen = SeenPoses(scenario, readings);
  return ScoreOf(bench, seen, IdentifyBy(bench, seen, estimator), truth, estimator);
}

}  // namespace twinbench::benches::freeform
