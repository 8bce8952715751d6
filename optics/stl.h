#pragma once

#include <string>

#include "optics/mesh.h"

namespace twinbench::optics {

/// Reads the triangles of an STL file, binary or text; which of both it is follows from its size and content.
/// Normals and attributes are ignored: a mesh here blocks light from both sides.
///
/// @param unit_m  What the number 1 in the file means; the format itself has no unit.
/// @throws std::runtime_error "FILE: what is wrong" (with the line for text): not there, cut off, no triangle, a
///         coordinate that is not finite, a facet that is no triangle.
///
/// Reference: 3D Systems, StereoLithography Interface Specification (1989): 80 bytes of header, a little-endian
/// count, and 50 bytes a triangle; or `solid`, `facet`, `outer loop`, `vertex` lines.
TriangleMesh ReadStl(const std::string& path, double unit_m);

}  // namespace twinbench::optics
