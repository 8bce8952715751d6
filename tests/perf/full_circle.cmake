# bench_full_circle: whole full-circle tests a second at every fidelity; see the comment at the top of its source.
add_executable(bench_full_circle ${CMAKE_CURRENT_LIST_DIR}/full_circle_bench.cc)
target_link_libraries(bench_full_circle PRIVATE twinbench_procedure twinbench_rotary_4dof_twin benchmark::benchmark)
