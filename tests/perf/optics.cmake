add_executable(bench_optics ${CMAKE_CURRENT_LIST_DIR}/optics_bench.cc)
target_link_libraries(bench_optics PRIVATE twinbench_optics embree benchmark::benchmark)
