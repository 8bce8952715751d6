#pragma once

#include <Eigen/Core>
#include <vector>

/// What repeats where a place is visited again: that much a function of the place explains, and no course in time may
/// take it.
namespace twinbench::diagnose {

/// The place of each reading, counted from 0; the same where an error that depends on the angle alone is the same.
///
/// @param angle_rad  One a reading; whole turns are one place.
/// @param setup      Mountings are told apart.
/// @return empty if hardly any place is visited again: one pass says nothing about what repeats.
///
/// Targets are places. Readings on the move are gathered in bins of a few neighbours: what changes inside a bin counts
/// as not repeating, which never says too little of that.
std::vector<int> PlacesOf(const Eigen::VectorXd& angle_rad, const std::vector<int>& setup);

/// Power of what is not the same at every visit; what changes slowly with time is expected to have so much in all.
/// @param place  By row, as above.
double PowerNotRepeating(const std::vector<int>& place, const Eigen::VectorXd& rows);

}  // namespace twinbench::diagnose
