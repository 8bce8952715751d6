#include "twin/core/secret_token.h"

#include <fmt/format.h>
#include <sys/random.h>

#include <array>

#include "twin/core/errors.h"

namespace twinbench {

std::string NewToken() {
  std::array<unsigned char, 32> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw BenchError("the system gives no random numbers for a token");
  std::string token;
  for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

bool IsToken(std::string_view asked, std::string_view token) {
  unsigned char differs = asked.size() == token.size() ? 0 : 1;
  for (std::size_t k = 0; k < token.size(); ++k) {
    const volatile unsigned char given = k < asked.size() ? static_cast<unsigned char>(asked[k]) : 0;
    differs |= static_cast<unsigned char>(given ^ static_cast<unsigned char>(token[k]));
  }
  return differs == 0;
}

}  // namespace twinbench
