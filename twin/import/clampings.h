#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "twin/core/reading.h"
#include "twin/import/map.h"
#include "twin/import/recording.h"

/// Polygons (or tables) that were turned against each other between clampings.
namespace twinbench::imports {

/// What a column's name or a line of text says of a clamping: "clamping 2", "reading at 30 deg", "Aufspannung 3: um
/// 60° verdreht".
struct ClampingSaid {
  double number = kNaN;
  double turned_deg = kNaN;
  bool ends_in_angle = false;  // it is the last thing that is said

  bool Any() const { return number == number || turned_deg == turned_deg; }
  bool operator==(const ClampingSaid& other) const;
};
ClampingSaid ClampingIn(std::string_view text);

/// The same of a column; "x 30 deg", of which the unit was taken off, included.
ClampingSaid ClampingOf(const Column& column);

bool SeeksClampings(const Map& map);

/// Gives rows below lines that say a clamping the columns "clamping" and "offset", of a map that seeks clampings.
void TakeClampingLines(const Map& map, Track& track);

/// Of a map that seeks clampings, once the quantities are found: rows by clamping, which are numbered, and the
/// columns table_deg and face_deg, the angle of the table and that of the face that was seen, both in the sense of
/// nominal_deg.
///
/// Where a column names the faces nothing is left to find. Else what is the same in all rows of a nominal angle (a
/// certified deviation, a face) says that the rows are faces, and nothing says that they are angles of the table.
/// The sense in which the polygon was turned, and by how many steps where that is not said, is that of which table,
/// faces and a constant a clamping leave least of the readings; where that is not clear the sense is the nominal
/// angles', and clampings without an offset count as not turned. What was taken is put into `remarks`.
/// @throws InputError if a stated offset is no whole number of the steps from face to face.
void PlaceClampings(const Map& map, Recording& recording, Track& track);

}  // namespace twinbench::imports
