#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "twin/core/scenario.h"
#include "twin/diagnose/diagnosis.h"
#include "twin/diagnose/engine/analysis.h"

namespace twinbench::diagnose {

/// A cause of the catalogue as readings of one design would show it, beside all that is free there.
struct ShownCause {
  std::string effect, where;
  ParameterEstimate smallest;   // that would be found (kBaarda); value NaN: none of plausible size would be
  double plausible_SI = kNaN;   // standard deviation of what is thought of its size before
  double largest_SI = kNaN;     // size up to which it is looked at
  std::vector<ParameterEstimate> at_smallest = {};  // of the catalogue, at that size; empty: there is none
};

/// The cause at its smallest size as the twin can carry it out; other parameters as the catalogue has them.
/// @param cause  With a smallest size.
EffectSettings AsEffect(const ShownCause& cause, const std::string& bench);

/// If one cause is at work another may be blamed for it.
struct Confusable {
  std::size_t present = 0, blamed = 0;  // of `causes`
  /// Size from which the present one is told from the other, in its own smallest sizes; infinite: no plausible one;
  /// 0: any that is found.
  double told_from = 0.0;
  /// The same in the shape (period, time constant) in which they are most alike, in smallest sizes of that shape; of
  /// several runs, in the one that tells least. Never less.
  double surely_told_from = 0.0;
};

/// What readings of one design could tell: of each cause, and of each two of them.
struct Isolability {
  std::vector<ShownCause> causes;
  std::vector<Confusable> confusable;
  Eigen::MatrixXd information;  // causes x causes: s_k' W s_l of signatures in their plausible sizes; white, no unit
};

/// Readings as each cause alone would make them, in sizes from the smallest that would be found to the largest
/// plausible one, are weighed against the whole catalogue as a diagnosis does (Scanner::Scan), the noise by its
/// expectation. Evidence of a difference D in favour of what is there comes out as D - 1.645 sqrt(2 D) or better in
/// 95 of 100 runs; below log odds of tuning::kNamedFrom the other cause may share the answer, if it explains a tenth of
/// what is there at all. Done for the shape of each cause that shows most, and for some others of its grid.
///
/// Not included: shapes are not refined; structure without a name is not counted as a rival.
Isolability IsolabilityOf(const LinearRun& run, const Analysis& analysis);

/// Counts a pair as told apart only where other runs of the same design, under other chance (another course of the
/// room's temperature), tell it apart too: `surely_told_from` becomes the largest of all.
void KeepSurelyTold(const Isolability& other, Isolability& isolability);

/// Causes that no plausible size tells apart: sets of two or more in which each may be taken for another,
/// neighbours of neighbours too.
std::vector<std::vector<std::size_t>> NeverTold(const Isolability& isolability);

}  // namespace twinbench::diagnose
