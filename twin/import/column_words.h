#pragma once

#include <string>
#include <vector>

#include "twin/import/recording.h"

/// What the names that people give to columns speak of.
namespace twinbench::imports {

enum class Speaks { kReference, kDevice };

/// "probe 1" of "Probe_1_um".
std::string BareName(const std::string& name);

/// How clearly a name speaks of a reference or of a device under test: by its clearest word, then by how many there are; 0:
/// not at all.
int Clearness(const std::string& name, Speaks of);

/// What a controller told an axis, and no other reference.
bool IsCalledCommand(const std::string& name);

/// "motor_roll" and "imu_pitch": each name has a word for an axis, and not the same.
bool AreOfTwoAxes(const std::string& a, const std::string& b);

/// "Angle (deg)", "position": whose it is no word says.
bool SaysOnlyPlace(const std::string& name);

/// "column 3", "Channel 1": a number that somebody gave, and nothing of what is in it.
bool SaysNothing(const std::string& name);

/// One word that says which side of a comparison a column is, or that it is a place, but not of which axis.
bool SpeaksOfSide(const std::string& word);

/// "error", "deviation", "offset", "Abweichung", "correction": not where the device stands, but by how much it is off.
bool IsCalledError(const std::string& name);

/// "correction": what has to be added to what the device shows, the error with the other sign.
bool IsCalledCorrection(const std::string& name);

/// "direction", "approach", "Richtung", "side".
bool IsCalledDirection(const std::string& name);

/// "setup", "session", "mounting": behind which everything stands elsewhere.
bool IsCalledSetup(const std::string& name);

/// +1, -1, or 0 for a word that is no direction: "forward", "down", "cw", "+".
int DirectionOfWord(std::string_view word);

/// The way round that a text speaks of, seen against the axis: +1 counter-clockwise, -1 clockwise, 0 for none, or for both. "Run 2 CW",
/// "gegen den Uhrzeigersinn", "G02".
int TurnIn(const std::string& text);

/// How clearly a name speaks of a quantity by these words, the clearest first; 0: not at all. Of "cmd x" it has to have both parts.
int ClearnessBy(const std::string& name, const std::vector<std::string>& words);

/// "Temp. [°C]", "T_air", "Temperatur".
bool IsCalledTemperature(const std::string& name);

/// A speed, a current, a temperature by its name or unit: neither where the axis should stand nor where it does.
bool IsOtherQuantity(const Column& column);

/// A speed, by its unit or where it has none by its name: nothing that it is read beside is an angle of.
bool IsRate(const Column& column);

/// "q", "actual_q_2": a joint's coordinate, which robots count in rad.
bool IsCalledJoint(const std::string& name);

/// "position", "pos", "angle", "encoder", "q": a place, whatever else the name says.
bool IsCalledPlace(const std::string& name);

/// "distance", "stroke", "displacement": a length, whatever its unit.
bool IsCalledLength(const std::string& name);

/// A unit that says that there is none: "", "-", "1", "none".
bool IsNoUnit(const std::string& unit);

}  // namespace twinbench::imports
