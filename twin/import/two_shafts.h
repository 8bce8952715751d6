#pragma once

#include <string>
#include <vector>

/// Angles of two shafts that a train joins [deg], as columns of a file; the functions of formulas that are called so.
namespace twinbench::imports {

/// A column that stays within a turn starts again at its end; one that goes on is as it is.
std::vector<double> Unwrapped(std::vector<double> x, const std::string& where);

/// How far a goes with b.
std::vector<double> Ratio(const std::vector<double>& a, const std::vector<double>& b, const std::string& where);

/// The ratio that a file states, of input to output or the other way round, where the angles go like that.
/// @throws InputError if they do not.
std::vector<double> StatedRatio(const std::vector<double>& stated, const std::vector<double>& found, const std::string& where);

/// a less b where it goes along with b, one to one; else a: deviations of b as such, or in sums with it.
std::vector<double> Beside(const std::vector<double>& a, const std::vector<double>& b, const std::string& where);

/// The smallest number of turns of a that is one of b as well, as near as their errors let it be told.
/// @throws InputError if the two do not go together.
std::vector<double> WholeTurns(const std::vector<double>& a, const std::vector<double>& b, const std::string& where);

}  // namespace twinbench::imports
