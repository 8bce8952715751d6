set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")  # -O3 for the KERNELS of a room only: half the build time

# Same seed, same bits on every x86-64: no fused multiply-add unless a kernel writes it, no -ffast-math.
add_compile_options(-ffp-contract=off -fno-math-errno -fno-trapping-math)
add_compile_options(-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  add_compile_options(-Wno-restrict)  # false alarms in std::string at -O3 (GCC bug 105651)
endif()
if(TWINBENCH_WERROR)
  add_compile_options(-Werror)
endif()

# Instrumented for libFuzzer, every fault an end: tests/fuzz.
if(TWINBENCH_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "TWINBENCH_FUZZ needs clang: cmake --preset fuzz")
  endif()
  add_compile_options(-fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer
    -fsanitize-ignorelist=${CMAKE_CURRENT_LIST_DIR}/sanitizer_ignores.txt)
  add_link_options(-fsanitize=address,undefined)
endif()

# Most of a source's time goes into its headers: thirty-two sources read them once.
set(CMAKE_UNITY_BUILD ${TWINBENCH_UNITY})
set(CMAKE_UNITY_BUILD_BATCH_SIZE 32)
if(TWINBENCH_UNITY AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # A tenth of the compiler's time went into collecting what it needs again at once; the largest source takes 2.2 GB.
  add_compile_options("SHELL:--param ggc-min-heapsize=400000")
endif()

# Some eighty programs are linked: in a quarter of the time.
find_program(MOLD mold)
if(MOLD)
  add_link_options(-fuse-ld=mold)
endif()

# ccache keeps nothing of a source with a precompiled header unless told that it may.
find_program(CCACHE ccache)
if(CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
  add_compile_options($<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
endif()
