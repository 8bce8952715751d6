add_executable(bench_mechanics ${CMAKE_CURRENT_LIST_DIR}/mechanics_bench.cc)
target_link_libraries(bench_mechanics PRIVATE twinbench_mechanics benchmark::benchmark)
