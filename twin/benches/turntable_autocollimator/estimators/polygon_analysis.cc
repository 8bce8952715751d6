#include "twin/benches/turntable_autocollimator/estimators/polygon_analysis.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "twin/benches/turntable_autocollimator/estimators/one_axis.h"
#include "twin/benches/turntable_autocollimator/estimators/polygon_means.h"
#include "twin/benches/turntable_autocollimator/settings.h"

namespace twinbench::separate::turntable {
namespace {

std::vector<StatedScatter> StatedOf(const TurntableSettings& own) {
  constexpr std::size_t kEz = static_cast<std::size_t>(Component::kEz);
  std::vector<StatedScatter> stated = {
      {"encoder.noise_arcsec", "noise", own.encoder.noise_rad},
      {"encoder.step_arcsec", "quantisation", own.encoder.step_rad / std::sqrt(12.0)},
      {"autocollimator.noise_arcsec", "noise", own.ReadingNoise_rad()},
      {"turntable.repeatability.ez_arcsec", "repeatability", own.turntable.repeatability_sd[kEz]}};
  std::erase_if(stated, [](const StatedScatter& s) { return s.u_rad == 0.0; });
  return stated;
}

/// What an order differs by from the rigorous one is a standard deviation of both its phases together.
void AddBias(const HarmonicModel& rigorous, HarmonicModel& published) {
  published.terms.clear();
  for (int k = 1; k <= published.highest_order; ++k) {
    const Eigen::Index at = 2 * k - 1;
    const Eigen::Vector2d off_rad =
        published.coefficients_rad.segment<2>(at) - rigorous.coefficients_rad.segment<2>(at);
    published.cov_rad2.diagonal().segment<2>(at).array() += 0.5 * off_rad.squaredNorm();
    published.terms.push_back(
        TermOf(k, published.coefficients_rad.segment<2>(at), published.cov_rad2.block<2, 2>(at, at)));
  }
}

void NoteScatter(const PolygonClosure& closure, PolygonAnalysis& analysis) {
  const double unmodelled_rad = closure.encoder.u_unmodelled_rad;
  analysis.turntable_rad2 = closure.turntable.cov_rad2.diagonal().array() - unmodelled_rad * unmodelled_rad;
  analysis.polygon_rad2 = closure.polygon.cov_rad2.diagonal();
  analysis.coefficients_rad2 = closure.encoder.cov_rad2.diagonal();
}

/// The published estimate of the rigorous one's readings; what both differ by, and orders above, are in its uncertainties.
void TakePublished(const std::vector<FaceReading>& faces, const TurntableSettings& own, PolygonAnalysis& analysis) {
  PolygonClosure published = ClosePolygonByMeans(faces, own.polygon.faces, own.turntable_procedure.highest_order);
  const PolygonClosure& rigorous = *analysis.closure;
  NoteScatter(published, analysis);
  analysis.method_bias_rad = ClosureBias_rad(published.turntable, rigorous.turntable);
  AddBias(rigorous.encoder, published.encoder);
  published.encoder.u_unmodelled_rad = rigorous.encoder.u_unmodelled_rad;
  published.turntable = CurveAt(published.encoder, published.turntable.position_rad);
  const double bias_rad2 = std::pow(ClosureBias_rad(published.polygon, rigorous.polygon), 2);
  for (Eigen::Index face = 0; face < published.polygon.value_rad.size(); ++face)
    published.polygon.cov_rad2.AddVariance(face, bias_rad2);
  published.hidden = rigorous.hidden;
  published.notes.insert(published.notes.begin(), rigorous.notes.begin(), rigorous.notes.end());
  analysis.closure = std::move(published);
}

}  // namespace

double PolygonAnalysis::Stated_rad() const {
  double squares_rad2 = 0.0;
  for (const StatedScatter& s : stated) squares_rad2 += s.u_rad * s.u_rad;
  return std::sqrt(squares_rad2);
}

PolygonAnalysis AnalysePolygon(const std::vector<Reading>& readings, const Scenario& scenario,
                               Estimator estimator) {
  const TurntableSettings& own = TurntableOf(scenario);
  const std::vector<FaceReading> faces = FaceReadings(WithTilt(readings), scenario);
  PolygonAnalysis analysis;
  analysis.estimator = estimator;
  analysis.used = static_cast<int>(faces.size());
  analysis.left_out = static_cast<int>(readings.size() - faces.size());
  analysis.stated = StatedOf(own);
  std::set<int> clampings;
  for (const FaceReading& r : faces) clampings.insert(r.clamping);
  analysis.clampings = static_cast<int>(clampings.size());
  if (faces.empty()) {
    analysis.not_separated = "there are no usable readings of the polygon";
    return analysis;
  }
  PolygonClosure rigorous = ClosePolygon(faces, own.polygon.faces, own.turntable_procedure.highest_order);
  if (rigorous.turntable.position_rad.empty()) {
    analysis.not_separated =
        "no order of the encoder's error is separable from the polygon's faces: more clampings at "
        "other offsets would separate them";
    return analysis;
  }
  NoteScatter(rigorous, analysis);
  analysis.closure = std::move(rigorous);
  if (estimator == Estimator::kPublished) TakePublished(faces, own, analysis);
  return analysis;
}

}  // namespace twinbench::separate::turntable
