#pragma once

namespace twinbench::test {

/// Whether the address sanitizer looks on, which takes its time and memory.
#if defined(__has_feature)  // clang says it so, g++ by a macro
inline constexpr bool kSanitized = __has_feature(address_sanitizer);
#elif defined(__SANITIZE_ADDRESS__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace twinbench::test
