#pragma once

#include <string>
#include <vector>

#include "twin/core/compensation_table.h"

/// A compensation in the form in which controllers read one.
namespace twinbench::report {

struct ControllerForm {
  std::string name;     // "linuxcnc"
  std::string meaning;  // one line
  int most_points = 0;  // entries that it takes, both ends of the turn among them; 0: no limit that is known
};

/// plain (our own), linuxcnc, twincat, heidenhain.
const std::vector<ControllerForm>& ControllerForms();

/// @throws InputError if there is none of that name; it names those there are.
const ControllerForm& ControllerFormNamed(const std::string& name);

/// @param axis      What the controller calls the axis: "C".
/// @param comments  Lines that say where the table is from.
/// @throws InputError if the form takes fewer entries than the table has.
///
/// linuxcnc: triplets of nominal, actual forward and actual backward position [deg], COMP_FILE_TYPE = 0. twincat:
/// the array of positions and additive compensations [deg] of MC_TableBasedPositionCompensation as Structured Text,
/// modulo. heidenhain: columns NR, AXISPOS, BACKLASH and the axis of a .COM table [deg], no reversal error. All go
/// from 0 to 360 degrees with both ends, since they do not close the turn by themselves.
/// References: LinuxCNC documentation, INI configuration, [JOINT_n] COMP_FILE; Beckhoff Information System,
/// Tc2_MC2; Heidenhain technical manuals, non-linear axis-error compensation.
std::string ControllerTable(const std::string& form, const CompensationTable& table, const std::string& axis,
                            const std::vector<std::string>& comments);

}  // namespace twinbench::report
