#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "twin/diagnose/isolability.h"

namespace twinbench::diagnose {

/// Information of one run about causes in the order of another's: a cause that it does not show has none.
/// Causes are in their plausible sizes of `order`, so that 1 stands for what is thought of them before.
Eigen::MatrixXd InformationInOrder(const Isolability& run, const Isolability& order);

/// How far the two causes that are most alike are from each other, each in its plausible size and the other fitted to
/// it [sigma]: min over k, l of sqrt(I_kk - I_kl^2 / I_ll) (T-optimality: Atkinson & Fedorov, Biometrika 62 (1975) 57).
/// Causes without information are left out; NaN if fewer than two are left.
double ClosestCauses(const Eigen::MatrixXd& information);

/// Information gained about the sizes of all causes [bit]: half log2 det(1 + information).
double InformationGain_bit(const Eigen::MatrixXd& information);

/// Pairs that the first run never tells apart in a plausible size, and the second does in some: "a | b".
std::vector<std::string> BrokenTies(const Isolability& before, const Isolability& after);

/// Causes that the second run would find in a plausible size, and the first would not.
std::vector<std::string> NewlyShown(const Isolability& before, const Isolability& after);

}  // namespace twinbench::diagnose
