#pragma once

#include <functional>
#include <string>

namespace twinbench::optics {

/// What an OpenEXR file may ask memory for. Its header says how large everything is, and a header is written in no time, so it is looked
/// through before the library takes it at its word: no attribute is longer than the file, and all pictures together are no larger than
/// the file can hold.
///
/// The limits, beside that of the file's length times 1032 bytes, the most that deflate leaves of a picture of one value (zlib, Technical Details):
inline constexpr int kMostExrSide = 16384;       // pixels
inline constexpr int kMostExrPixels = 1 << 26;   // of all pictures: 8192 x 8192
inline constexpr int kMostExrTile = 1 << 20;     // pixels of a tile
inline constexpr int kMostExrChannels_B = 2048;  // of the list of channels, some 20 a channel

/// @throws std::runtime_error if the file is no OpenEXR, ends within its header or says more than it can hold.
///
/// Reference: OpenEXR File Layout (magic number, version field, headers of attributes: name, type, size, value).
void RequirePlausibleExr(const std::string& path);

/// Lets `write` make a file beside its place and renames it, so that a reader sees a whole file or none. What has no place of its own
/// (a device, an open file of /proc) is written itself.
void WriteExrBeside(const std::string& path, const std::function<void(const char* to)>& write);

}  // namespace twinbench::optics
