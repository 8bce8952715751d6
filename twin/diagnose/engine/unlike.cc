#include "twin/diagnose/engine/unlike.h"

#include "twin/core/linear_algebra.h"
#include "twin/diagnose/engine/answer.h"
#include "twin/diagnose/engine/posterior.h"

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

}  // namespace

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

}  // namespace twinbench::diagnose
