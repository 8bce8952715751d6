#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/target.h"

/// `fuzz_forever <target> [options of libFuzzer] [folders of inputs]`
namespace {

void (*chosen)(std::string_view bytes) = nullptr;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  for (const auto& target : twinbench::fuzz::Targets()) {
    if (*argc > 1 && std::string_view(target.name) == (*argv)[1]) chosen = target.read;
  }
  if (!chosen) {
    std::fprintf(stderr, "expected a target:");
    for (const auto& target : twinbench::fuzz::Targets()) std::fprintf(stderr, " %s", target.name);
    std::fprintf(stderr, "\n");
    std::exit(2);
  }
  for (int k = 1; k < *argc; ++k) (*argv)[k] = (*argv)[k + 1];  // the last is null
  --*argc;
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  chosen({reinterpret_cast<const char*>(bytes), size});
  return 0;
}
