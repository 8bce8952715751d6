#include "twin/core/input_text.h"

#include <fmt/format.h>

#include <fstream>

#include "twin/core/errors.h"
#include "twin/core/nearest_file.h"

namespace twinbench {

std::string InputText(const std::string& path, const std::string& expected, const std::string& where) {
  constexpr std::size_t kPiece_B = 1 << 16;
  const std::string named = where.empty() ? path : where, what = where.empty() ? "the file" : path;
  std::ifstream in(path, std::ios::binary);
  std::string text, piece(kPiece_B, '\0');
  while (in && text.size() <= kLargestInput_B) {
    in.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    text.append(piece, 0, static_cast<std::size_t>(in.gcount()));
  }
  if (text.size() > kLargestInput_B)
    throw InputError(named, fmt::format("{} is larger than {} MB", what, kLargestInput_B >> 20), expected);
  if (in.bad() || text.empty()) throw NothingToRead(path, expected, where);
  return text;
}

}  // namespace twinbench
