#include "twin/core/digest.h"

#include <fmt/format.h>
#include <openssl/sha.h>

#include <array>

namespace twinbench {

std::string Sha256(const std::string& bytes) {
  std::array<unsigned char, SHA256_DIGEST_LENGTH> digest{};
  SHA256(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), digest.data());
  return fmt::format("{:02x}", fmt::join(digest, ""));
}

}  // namespace twinbench
