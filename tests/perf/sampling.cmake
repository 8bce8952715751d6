# bench_sampling: normals, events and A/D blocks a second; see the comment at the top of sampling_bench.cc.
add_executable(bench_sampling ${CMAKE_CURRENT_LIST_DIR}/sampling_bench.cc)
target_link_libraries(bench_sampling PRIVATE twinbench_sim benchmark::benchmark)
