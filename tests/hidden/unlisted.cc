#include "tests/hidden/unlisted.h"

#include <memory>

#include "tests/hidden/placements.h"
#include "tests/hidden/unlisted_cause.h"
#include "twin/benches/names.h"

namespace twinbench::hidden {
namespace {

/// Adds the signal at the size that gives it the length `rho`.
void AddWithLength(double rho, const std::string& bench, const Eigen::MatrixXd& signal, const SignatureScale& scale,
                   std::uint64_t seed, std::vector<Reading>& readings) {
  constexpr double kUnit = 1e-6;
  std::vector<Reading> with = readings;
  AddTo(bench, kUnit * signal, with);
  AddTo(bench, kUnit * rho / scale.Rho(with, readings, seed) * signal, readings);
}

Case MakeUnlisted(Design design, const UnlistedCause& cause, double rho, std::uint64_t seed,
                  const SignatureScale& scale) {
  Case made;
  made.scenario = Believed(design);
  made.readings = TakeReadings(Drawn(design, seed));
  Stream stream(seed, "hidden.unlisted");
  const UnlistedSignal drawn = cause.draw({made.readings, stream, stream});
  AddWithLength(rho, BenchOf(design), drawn.signal, scale, seed, made.readings);
  made.hidden.unlisted = cause.name;
  made.hidden.locks = drawn.locks;
  made.hidden.channels = drawn.channels;
  made.hidden.rho = rho;
  return made;
}

}  // namespace

const std::vector<UnlistedCause>& UnlistedCausesOf(const std::string& bench) {
  if (bench == kRotaryBench) return RotaryUnlistedCauses();
  if (bench == kTurntableBench) return TurntableUnlistedCauses();
  if (bench == kCircularBench) return CircularUnlistedCauses();
  if (bench == kFreeformBench) return FreeformUnlistedCauses();
  return bench == kHobBench ? HobUnlistedCauses() : EncoderUnlistedCauses();
}

std::vector<Plan> UnlistedPlans(const std::string& bench, const TwinOptions& options) {
  std::vector<Plan> plans;
  std::uint64_t seed = 400000 + options.first_seed;
  for (const Design design : PlainDesigns(bench)) {
    const auto scale = std::make_shared<const SignatureScale>(design, options.cache_folder);
    for (const UnlistedCause& cause : UnlistedCausesOf(bench)) {
      for (int k = 0; k < options.magnitudes * options.seeds; ++k) {
        ++seed;
        const double rho = options.RhoOf(k);
        plans.push_back({"unlisted " + bench, std::to_string(seed),
                         [=] { return MakeUnlisted(design, cause, rho, seed, *scale); }});
      }
    }
  }
  return plans;
}

}  // namespace twinbench::hidden
