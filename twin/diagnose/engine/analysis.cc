#include "twin/diagnose/engine/analysis.h"

#include <algorithm>
#include <vector>

#include "twin/core/linear_algebra.h"
#include "twin/diagnose/engine/answer.h"
#include "twin/diagnose/engine/estimate.h"
#include "twin/diagnose/engine/posterior.h"
#include "twin/diagnose/engine/prior.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose {
namespace {

/// In units of noise, without what the free unknowns take of it.
class Seen {
 public:
  Seen(const LinearRun& run, const NoiseModel& noise, const Projector& projector)
      : run_(run), noise_(noise), projector_(projector) {}

  /// Share of what is shown that these columns show as well, in any size.
  double Likeness(const Eigen::VectorXd& shown, const Eigen::MatrixXd& columns) const {
    const Eigen::MatrixXd s = noise_.Whiten(run_, Eigen::MatrixXd(shown)), c = noise_.Whiten(run_, columns),
                          left = projector_.Apply(c);
    const Eigen::VectorXd common = left.transpose() * s.col(0);
    const double power = s.col(0).dot(projector_.Apply(s).col(0));
    return power > 0.0 ? common.dot(SolveShortest(c.transpose() * left, common)) / power : 1.0;
  }

 private:
  const LinearRun& run_;
  const NoiseModel& noise_;
  const Projector& projector_;
};

bool IsLike(const Seen& seen, const Eigen::VectorXd& shown, const Family& family, int first) {
  if (seen.Likeness(shown, family.ColumnsAt(first)) > kAlike) return true;
  for (int g = 0; g < family.grid; ++g) {
    if (g != first && seen.Likeness(shown, family.ColumnsAt(g)) > kAlike) return true;
  }
  return false;
}

/// Notes of every term which causes of its place are like nothing of it (Term::unlike): what explains as much by another
/// structure that is there too is looked at by itself, later. Likeness is that of what the free unknowns leave.
/// @param families  Of the search.
void NoteUnlike(const LinearRun& run, const NoiseModel& noise, const Projector& projector,
                const std::vector<Family>& families, SearchResult& found) {
  const Seen seen(run, noise, projector);
  for (Term& term : found.terms) {
    const std::vector<Share> place = CredibleSet(PosteriorOf(term, families));
    if (place.size() < 2) continue;
    const Eigen::VectorXd shown = term.columns * term.amplitudes;
    for (const auto& [key, probability] : place) {
      bool is_like = false;
      for (int k = 0; k < std::ssize(families) && !is_like; ++k) {
        const Family& family = families[static_cast<std::size_t>(k)];
        if (family.kind != Kind::kNamed || CauseKey{family.effect, family.where} != key) continue;
        is_like = k == term.family || IsLike(seen, shown, family, found.alone.grid_point(k, 0));
      }
      if (!is_like) term.unlike.push_back(key);
    }
  }
}

void Prepare(const LinearRun& run, const std::vector<Family>& families, int threads, Analysis& analysis) {
  analysis.projector = std::make_unique<Projector>(analysis.noise.Whiten(run, run.nuisance.jacobian), run.nuisance);
  analysis.redundancy = analysis.projector->Redundancy();
  analysis.scanner = std::make_unique<Scanner>(run, analysis.noise, *analysis.projector, families, threads);
}

/// What the noise alone would explain, before and after the terms.
struct NoiseView {
  std::vector<NoiseCause> before, after;
  std::vector<NoiseCause> but_courses;  // after those that do not follow nearly anything
  double of_courses = 0.0;              // evidence of the others beside them
};

/// What is left when neither unknowns nor terms see some of the rows.
Rest RestWithoutRows(const LinearRun& run, const Projector& projector, const Eigen::MatrixXd& white,
                     const Eigen::MatrixXd& terms, const std::vector<int>& left_out) {
  Eigen::VectorXd kept = Eigen::VectorXd::Ones(run.Rows());
  kept(left_out).setZero();
  const Projector others(kept.asDiagonal() * projector.Jacobian(), run.nuisance);
  const Deflation deflation(others, kept.asDiagonal() * terms);
  Rest rest{Project(others, deflation, kept.asDiagonal() * white).rows.col(0), others.Redundancy()};
  rest.redundancy -= deflation.BasisOf(run.Rows()).rowwise().squaredNorm();
  rest.redundancy(left_out).setZero();
  return rest;
}

NoiseView LookAtNoise(const LinearRun& run, const Analysis& analysis) {
  const Projector& projector = *analysis.projector;
  const Eigen::VectorXd white = analysis.noise.Whiten(run, Eigen::MatrixXd(run.residual));
  const auto look = [&](const Eigen::MatrixXd& terms) {
    const auto without = [&](const std::vector<int>& rows) {
      return RestWithoutRows(run, projector, white, terms, rows);
    };
    const Deflation deflation(projector, terms);
    const Rest rest{Project(projector, deflation, white).rows.col(0), analysis.redundancy};
    return FindNoiseCauses(run, analysis.noise, rest, without);
  };
  const Eigen::MatrixXd none(run.Rows(), 0);
  const auto after = [&](const std::vector<Term>& terms) { return look(analysis.noise.Whiten(run, Signatures(run, terms))); };
  NoiseView view{look(none), after(analysis.found.terms), {}};
  std::vector<Term> with_form;
  for (const Term& term : analysis.found.terms) {
    if (!analysis.scanner->Families()[static_cast<std::size_t>(term.family)].takes_any_course) {
      with_form.push_back(term);
    } else {
      view.of_courses += term.statistic;
    }
  }
  if (with_form.size() < analysis.found.terms.size()) view.but_courses = after(with_form);
  // A cause that shows on one channel makes that channel look noisy: only what remains can say so.
  std::erase_if(view.before, [](const NoiseCause& c) { return c.kind == NoiseCause::Kind::kChannelScale; });
  return view;
}

/// Many readings of which a cause of the catalogue explains most are not each disturbed by itself.
bool HaveOneReason(const Analysis& analysis, const NoiseCause& cause) {
  constexpr double kMost = 0.8;
  constexpr std::size_t kReadingsOfACause = 3;
  const SearchResult& found = analysis.found;
  const auto is_named = [&](const Term& term) {
    return analysis.scanner->Families()[static_cast<std::size_t>(term.family)].kind == Kind::kNamed;
  };
  return cause.kind == NoiseCause::Kind::kOutliers && cause.outliers.size() >= kReadingsOfACause * found.terms.size() &&
         found.joint_evidence > kMost * cause.log_bayes && std::ranges::all_of(found.terms, is_named);
}

/// The repair that has to come before any cause is believed, if there is one.
const NoiseCause* NextRepair(const Analysis& analysis, const NoiseView& view) {
  const bool picked = !analysis.found.terms.empty();
  // A cause that leaves clean noise behind needs no other explanation; one that does not may be noise itself.
  const bool clean = view.after.empty() || view.after.front().log_bayes < tuning::kRefuted;
  if (picked && !clean && !view.before.empty() && view.before.front().log_bayes > analysis.found.joint_evidence &&
      !HaveOneReason(analysis, view.before.front())) {
    return &view.before.front();
  }
  // What follows nearly anything leaves clean noise of any kind: readings that remember each other say as much by less.
  const auto remembers = std::ranges::find(view.but_courses, NoiseCause::Kind::kCorrelation, &NoiseCause::kind);
  if (remembers != view.but_courses.end() && remembers->log_bayes > view.of_courses) return &*remembers;
  // One step up and another one down leave clean noise as well, and are a single disturbed value.
  const auto disturbed = std::ranges::find(view.before, NoiseCause::Kind::kOutliers, &NoiseCause::kind);
  if (picked && disturbed != view.before.end() && disturbed->log_bayes > analysis.found.joint_evidence &&
      !HaveOneReason(analysis, *disturbed))
    return &*disturbed;
  for (const NoiseCause& cause : view.after) {
    // Single disturbed values are an effect of their own; other faults of the noise matter only if something was
    // chosen.
    const bool single = cause.kind == NoiseCause::Kind::kOutliers;
    const bool again = cause.kind == NoiseCause::Kind::kCorrelation && !analysis.noise.memory.IsWhite();
    const double limit = single ? tuning::kRefutedBySingle : again ? tuning::kRefutedAgain : tuning::kRefuted;
    if ((single || picked) && cause.log_bayes > limit) return &cause;
  }
  return nullptr;
}

/// As if nothing had been found, by thresholds that nobody passes.
void FindNothing(Analysis& analysis) {
  constexpr int kFewest = 10;
  const auto families = std::ssize(analysis.scanner->Families());
  analysis.design_only = true;
  analysis.null = {std::vector<double>(kFewest, 0.0)};
  analysis.found.alone = {Eigen::MatrixXd::Zero(families, 1), Eigen::MatrixXi::Zero(families, 1),
                          Eigen::MatrixXd::Zero(families, 1)};
}

}  // namespace

Analysis Analyse(const LinearRun& run, const std::vector<Family>& families, const AnalysisOptions& options) {
  Analysis analysis;
  analysis.noise = {run.sigma, {}};
  if (options.design_only) {
    Prepare(run, families, options.threads, analysis);
    FindNothing(analysis);
    return analysis;
  }
  const Eigen::VectorXd log_priors = LogPriors(families);
  for (int repairs = 0;; ++repairs) {
    Prepare(run, families, options.threads, analysis);
    if (repairs == 0) {
      analysis.null = options.null
                          ? *options.null
                          : CalibrateCached(run, *analysis.scanner, *analysis.projector, log_priors, options.null_runs,
                                            options.cache_folder, DesignKey(run, families, options.null_runs));
      // Nothing that is less likely than no cause at all is claimed, however rare it may be in noise.
      analysis.threshold = std::max(0.0, analysis.null.Threshold(tuning::kAlarmProbability));
      const Eigen::MatrixXd white = analysis.noise.Whiten(run, Eigen::MatrixXd(run.residual));
      analysis.power = Project(*analysis.projector, {}, white).power[0];
    }
    analysis.found = Search(run, analysis.noise, *analysis.projector, *analysis.scanner, log_priors, analysis.threshold,
                            {options.most_causes, options.most_orders, options.largest_only, options.bent, options.together});
    const NoiseView view = LookAtNoise(run, analysis);
    const NoiseCause* repair = repairs < tuning::kMostRepairs ? NextRepair(analysis, view) : nullptr;
    // What else is there yet looks like noise of another kind.
    if (options.largest_only && repair && repair->kind != NoiseCause::Kind::kOutliers) repair = nullptr;
    if (!repair) {
      NoteUnlike(run, analysis.noise, *analysis.projector, families, analysis.found);
      analysis.observations = view.after;
      return analysis;
    }
    analysis.noise = repair->repaired;
    analysis.repairs.push_back(*repair);
  }
}

}  // namespace twinbench::diagnose
