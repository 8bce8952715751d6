#pragma once

#include <Eigen/Core>
#include <vector>

#include "twin/diagnose/diagnose.h"

namespace twinbench::diagnose {

/// Two waves whose orders have a sum or a difference less uneven than this are one wave, whatever their size is thought to be.
inline constexpr double kUneven = 0.2;

/// By how much waves of the orders 0 to `most` are not the same at all readings, each as a share of its size.
Eigen::VectorXd UnevennessOfOrders(int most, const Eigen::VectorXd& angle_rad);

/// Orders that these readings do not tell from a cause's own, ascending: at N even stops a turn k, N - k and N + k are one wave.
/// Empty of a cause without an order, and where the stops are uneven enough for its size.
std::vector<int> AliasesOf(const Cause& cause, const LinearRun& run);

/// Names the first aliases of each cause as its rivals, with what tells them apart; a cause that has some improves the same stops
/// only, and no other run. One that is about as likely as the order that was named leaves that open: the verdict is a tie.
void TellAliases(const LinearRun& run, Diagnosis& diagnosis);

}  // namespace twinbench::diagnose
