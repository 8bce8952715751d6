#pragma once

#include <string>
#include <vector>

/// Functions of a map's formulas.
namespace twinbench::imports {

// The circle on which most rows of a log lie, whatever stands before and behind it: functions of a map's formulas.

/// How far its rows usually lie off it, in radii; NaN if there is no such circle, or they go round less than a sixth of it.
double AwayFromCircle(const std::vector<double>& x, const std::vector<double>& y);

/// Its middle in the direction of x.
/// @throws InputError if there is no such circle.
std::vector<double> CircleMiddle(const std::vector<double>& x, const std::vector<double>& y, const std::string& where);

/// To six digits.
/// @throws InputError if there is no such circle.
std::vector<double> CircleRadius(const std::vector<double>& x, const std::vector<double>& y, const std::string& where);

// Functions of a map's formulas about speeds that are kept.

/// The middle of all, to three digits.
std::vector<double> Whole(std::vector<double> x, const std::string& where);

/// Each row's level: of those at which a twentieth of the rows stays, to a few percent, the nearest one.
std::vector<double> Levels(std::vector<double> x, const std::string& where);

/// 1 in rows whose speed is not at its level, or no number, or has come to it so lately that an axis which lags has yet to take that up;
/// 0 in all others.
/// @param time_s  Of each row.
std::vector<double> Unsteady(const std::vector<double>& speed, const std::vector<double>& time_s, const std::string& where);

/// The angle of what gives a pulse a turn [deg], even from one rise of it to the next; before the first and behind the last at the speed of the
/// turn beside.
/// @throws InputError if there are fewer than two turns.
std::vector<double> ByIndex(const std::vector<double>& pulse, const std::vector<double>& time_s, const std::string& where);

// Angles of two shafts that a train joins [deg], as columns of a file; the functions of formulas that are called so.

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
