#pragma once

#include "tests/contract/rotary_bench.h"

namespace twinbench::test {

/// The bench of tests/python/closed_form_bench.py, driven through the package that users have.
BenchBackend PythonBackend();

}  // namespace twinbench::test
