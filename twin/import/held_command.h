#pragma once

#include <cstddef>
#include <vector>

#include "twin/import/course.h"

/// A command that is sent less often than it is recorded, or a reference that is read less often: every value is held for
/// a few rows while the device goes on. No such row is a rest.
namespace twinbench::imports {

/// The rows in which a held value is new; of a true rest between them as many as a held value has. Empty: nothing is held
/// so, or the device settles in each.
///
/// Held values are rests of one length, nearly all of them, that go on in one sense for most of the time, and in whose last third the device still goes a fifth of the way
/// that it goes in the whole.
/// @param shown  What the device shows [rad], whole turns aside where `turn_rad` is positive.
std::vector<std::size_t> FreshRows(const Course& course, const std::vector<double>& shown, double turn_rad);

}  // namespace twinbench::imports
