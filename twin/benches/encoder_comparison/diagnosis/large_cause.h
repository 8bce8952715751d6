#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "twin/benches/encoder_comparison/diagnosis/encoder_run.h"
#include "twin/diagnose/asked_again.h"
#include "twin/diagnose/diagnose.h"
#include "twin/diagnose/engine/analysis.h"

/// A cause that is too large for first order, found in a search and asked of the twin.
namespace twinbench::diagnose::encoder {

/// Length of a signature in units of noise from which it is large: a hundredth of it, which is what first order may
/// well miss, is then half a deviation.
inline constexpr double kLarge = 50.0;

/// A run with its candidates and what the search makes of them; the analysis points into the others.
struct Searched {
  EncoderRun encoder;
  std::vector<Family> families;
  Analysis analysis;
};

std::unique_ptr<Searched> SearchIn(EncoderRun encoder, const std::vector<std::string>& excluded,
                                   const AnalysisOptions& how);

/// A large cause.
struct LargeCause {
  std::vector<Cause> causes;  // the first is in the twin, with its parameters; the others tie with it
  EffectSettings effect;
  double explained = 0.0;  // power beyond what those before it explain, in units of the first noise
  Eigen::VectorXd shown;   // by row: what the twin shows more with it than with those before it, SI
};

bool IsOf(const Cause& cause, const Family& family);

/// Of a wave, as the catalogue counts it; nothing if the effect has no such parameter.
std::optional<double> WaveOrderOf(const EffectSettings& effect);

/// A family at a point of its grid as a cause, from rows that it has to explain alone.
/// @param sigma  Of every row.
Cause CauseFrom(const Family& family, int grid_point, const Eigen::VectorXd& rows, const Eigen::VectorXd& sigma,
                const Projector& projector);

/// A tie whose member number `leader` is the one in the twin.
LargeCause LedBy(std::vector<Cause> causes, std::size_t leader, const std::string& bench);

/// The largest of what has a name, the one that was fitted first.
std::optional<LargeCause> LargestNamed(const Searched& searched);

/// Waves of one effect whose orders are not told apart.
/// @param apart  OrdersApart.
bool AreOneWave(const LargeCause& a, const LargeCause& b, double apart);

/// The larger of two waves that were found at once and whose orders are not told apart: there is one, of an order about theirs.
/// @param apart  OrdersApart.
std::optional<LargeCause> OneOfTwoWaves(const Searched& searched, double apart);

/// Follows the direction, and stays behind on a reversal with a course of its own behind it, as play and hysteresis do.
bool IsLoop(const std::string& effect);

/// A loop in which the device leads, beside a latency by which it is behind: each takes away what the other makes too much.
/// @param size  Of what the catalogue calls width or lag.
bool LeadsBesideLatency(const std::string& effect, double size, const std::vector<LargeCause>& causes);

/// A large shape without a name may be a cause whose signature bends: those that explain nearly as much alone.
/// @return their numbers among the families, one that explains the same as the first behind it; empty if there is none.
std::vector<int> NamedLikeUnnamed(const Searched& searched);

/// What may be asked for other values: not a whole number, nor how stops were reached, which a longer crossing
/// imitates.
std::vector<Movable> MovableOf(const std::vector<LargeCause>& causes);

std::vector<EffectSettings> EffectsOf(const std::vector<LargeCause>& causes);

/// Those of which a bench has no second one. What is not left when it is in the twin was never there twice.
/// @param signal_periods  Of the device, a turn.
std::vector<std::string> ThatAreOnce(const std::vector<LargeCause>& causes, int signal_periods);

/// How many of its uncertainties the size of a cause is away from nothing: from zero, or from signals that are
/// whole.
double Deviations(const EffectSettings& effect);

/// How sure a size is that it is one, by how many of its uncertainties it is away from nothing and how many places it was chosen from.
double ChanceOfSize(double deviations, double log_places);

/// What was asked, in the words of the causes.
void TakeOver(const AskedAgain& asked, std::vector<LargeCause>& causes);

}  // namespace twinbench::diagnose::encoder
